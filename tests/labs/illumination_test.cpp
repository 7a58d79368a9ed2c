// Of the study of illumination maps: its arithmetic, and that its eye sees what the program draws.
#include <doctest/doctest.h>

#include "labs/illumination_truth.h"

using namespace illumination;

namespace {

Image grey(std::initializer_list<float> values) {
    Image image(int(values.size()), 1);
    int x = 0;
    for (float v : values) image.at(x++, 0) = {v, v, v};
    return image;
}

// A run of which only the image and the report count.
Filled run_of(Image image, double reported) { return {std::move(image), {}, reported, 0, 0, 0}; }

}  // namespace

TEST_CASE("d_rel is the distance over the quadratic mean of the first image") {
    CHECK(d_rel(grey({3, 4}), grey({3, 4})) == 0);
    CHECK(d_rel(grey({3, 4}), grey({0, 0})) == doctest::Approx(1).epsilon(1e-12));
    CHECK(d_rel(grey({3, 4}), grey({4, 4})) == doctest::Approx(0.2).epsilon(1e-12));
    CHECK(d_rel(grey({0, 2}), grey({1, 2})) == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("a power is found again in points of it, scattered or not") {
    Curve c;
    for (double t : {0.1, 0.2, 0.5, 3.0}) c.add(t, 0.7 * std::pow(t, -0.5));
    const Power p = power_through(c);
    CHECK(p.exponent == doctest::Approx(-0.5).epsilon(1e-12));
    CHECK(p(1) == doctest::Approx(0.7).epsilon(1e-12));
    CHECK(p(4) == doctest::Approx(0.35).epsilon(1e-12));
}

TEST_CASE("the error of a reference is inferred by proportion") {
    // Errors on one pixel each, so that squares add: run i is off by 2 r_i on a pixel of its own,
    // the longer one by 2 * 0.01 and the longest by 2 * 0.005 on others: k = 2 / |f|.
    const std::vector<double> reports = {0.4, 0.2, 0.1, 0.05};
    auto image_of = [](size_t pixel, double off) {
        Image image(8, 1);
        for (int x = 0; x < 8; ++x) image.at(x, 0) = {1, 1, 1};
        for (float& v : image.at(int(pixel), 0)) v += float(off);
        return image;
    };
    std::vector<Filled> shorter;
    for (size_t i = 0; i < reports.size(); ++i)
        shorter.push_back(run_of(image_of(i, 2 * reports[i]), reports[i]));
    const Filled longer = run_of(image_of(6, 0.02), 0.01),
                 longest = run_of(image_of(7, 0.01), 0.005);
    const Proportion p = proportion(shorter, longer, longest);
    const double k = 2 / std::sqrt(8.0);
    CHECK(p.k.n == 4);
    CHECK(p.k.mean == doctest::Approx(k).epsilon(0.005));
    CHECK(p.exponent == doctest::Approx(1).epsilon(0.005));
    CHECK(p.predicted == doctest::Approx(0.01 * k).epsilon(0.005));
    CHECK(p.measured == doctest::Approx(0.01 * k).epsilon(0.005));
}

TEST_CASE("independent errors add in squares, and one is taken off so") {
    CHECK(together(3, 4) == 5);
    CHECK(without(5, 4) == 3);
    CHECK(without(3, 4) == 0);
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

TEST_CASE("cameras from which on a map is cheaper") {
    CHECK(cameras(10, 1, 3) == 5);  // 5 + 10 = 15
    CHECK(cameras(10, 1, 3.1) == 5);
    CHECK(cameras(1, 1, 100) == 1);
    CHECK(std::isinf(cameras(1, 2, 2)));
}

TEST_CASE("what remains unshot is looked at by decades") {
    const std::vector<double> wanted = {0.5, 0.2, 0.1, 0.05, 0.02, 0.01},
                              got = unshot_down_to(0.01);
    REQUIRE(got.size() == wanted.size());
    for (size_t i = 0; i < got.size(); ++i) CHECK(got[i] == doctest::Approx(wanted[i]));
    CHECK(unshot_down_to(0.02).back() == doctest::Approx(0.02));
}

TEST_CASE("the mean of two runs, and its error") {
    const Pair p = pair_of(grey({3, 4}), grey({4, 4}));
    CHECK(p.mean.at(0, 0)[0] == 3.5f);
    CHECK(p.own == doctest::Approx(0.1));
}

TEST_CASE("the eye sees what is drawn, with 16 rays a pixel") {
    const Room room = illumination::room("cornell36", 300, Size{16, 8});
    IlluminationMap map(number_of_sides(room.mesh));
    for (size_t i = 0; i < map.size(); ++i) map[i] = {real(i % 7), real(i % 11), real(i % 13)};
    const Image eye = Eye(room)(map), drawn = radiance_image(room.scene, room.mesh, map, 4, 1);
    CHECK(d_rel(drawn, eye) < 1e-6);
}
