// labs/illumination_test.cpp  the arithmetic of the study of illumination maps
#include "labs/illumination.h"

#include <doctest/doctest.h>

#include "labs/grid.h"

using namespace penumbra;
using namespace illumination;

namespace {

Image grey(std::initializer_list<float> values) {
    Image image(int(values.size()), 1);
    int x = 0;
    for (float v : values) image.at(x++, 0) = {v, v, v};
    return image;
}

}  // namespace

TEST_CASE("d_rel is the distance over the quadratic mean of the first image") {
    CHECK(d_rel(grey({3, 4}), grey({3, 4})) == 0);
    CHECK(d_rel(grey({3, 4}), grey({0, 0})) == doctest::Approx(1).epsilon(1e-12));
    CHECK(d_rel(grey({3, 4}), grey({4, 4})) == doctest::Approx(0.2).epsilon(1e-12));
    CHECK(d_rel(grey({0, 2}), grey({1, 2})) == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("errors of runs over what they and the reference state, by proportion") {
    const double k = 0.7, reference = 0.005;
    Rows rows;
    for (double stated : {0.4, 0.2, 0.1, 0.05})
        rows.push_back({"",
                        "",
                        0,
                        0,
                        {{"off", k * std::hypot(stated, reference)},
                         {"stated", stated},
                         {"reference", reference}}});
    CHECK(proportion(rows).n == 4);
    CHECK(proportion(rows).mean == doctest::Approx(k).epsilon(1e-9));
}

TEST_CASE(
    "where particles are ahead: between the first and the last point of a curve above theirs") {
    Curve particles, shooting;
    for (double t : {1, 4, 16}) particles.add(t, 1 / std::sqrt(t));
    for (auto [t, e] : {std::pair(0.25, 1.0), {1.0, 1.5}, {4.0, 0.7}, {16.0, 0.1}})
        shooting.add(t, e);
    const Ahead a = ahead(particles, shooting);
    CHECK(a.ever);
    CHECK_FALSE(a.to_the_end);
    CHECK(a.from == 1);
    CHECK(a.to == 4);
    CHECK(a.worst == doctest::Approx(1));
    CHECK(a.best == doctest::Approx(0.5));
    shooting.error.back() = 0.3;
    CHECK(ahead(particles, shooting).to_the_end);
    CHECK_FALSE(ahead(shooting, particles).to_the_end);
}

TEST_CASE("an error between two points of a curve lies on a power, beyond them on 1 / sqrt(t)") {
    Curve c;
    c.add(1, 0.8), c.add(4, 0.2), c.add(16, 0.1);
    CHECK(error_at(c, 1) == doctest::Approx(0.8));
    CHECK(error_at(c, 2) == doctest::Approx(0.4));
    CHECK(error_at(c, 8) == doctest::Approx(0.1 * std::sqrt(2)));
    CHECK(error_at(c, 64) == doctest::Approx(0.05));
    CHECK(error_at(c, 0.25) == doctest::Approx(1.6));
}
