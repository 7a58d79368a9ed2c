// oracle/hints_test.cpp  the first line of a refusal leads to the mistake
#include <doctest/doctest.h>

#include <optional>

#include "oracle/expect.h"
#include "oracle/textbook.h"

using namespace oracle;
using oracle::detail::dot;

namespace {

using Pair = std::pair<double, double>;
using Words = std::pair<Verdict, const char*>;

void all_say(const std::vector<Words>& refused) {
    for (const auto& [v, words] : refused) {
        CHECK(!v.pass);
        says(v, words);
        CHECK(v.text.find(words) < v.text.find('\n'));
    }
}

Triple about_z(double z, double phi) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}
Triple unit(const Triple& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}
Triple cosine(double u, double v) { return about_z(std::sqrt(u), 2 * pi * v); }
double cosine_pdf(const Triple& w) { return std::max(0.0, w[2]) / pi; }

// The density of microfacets' normals by Trowbridge and Reitz, and its sampler.
double facets(double z, double alpha) {
    const double a2 = alpha * alpha, d = z * z * (a2 - 1) + 1;
    return a2 / (pi * d * d);
}
Triple facet(double u, double v, double alpha) {
    return about_z(std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)), 2 * pi * v);
}
Triple half_of(const Triple& a, const Triple& b) {
    return unit({a[0] + b[0], a[1] + b[1], a[2] + b[2]});
}

}  // namespace

TEST_CASE("hints: directions") {
    const Aside aside;
    Random random(seed_here());
    // The second wedge of the concentric map, turned too little, lies on the first.
    auto wedges = [](double u, double v) {
        const double a = 2 * u - 1, b = 2 * v - 1;
        const bool first = std::abs(a) > std::abs(b);
        const double r = first ? a : b, phi = first ? pi / 4 * (b / a) : pi / 4 * (1 - a / b);
        return Triple{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)};
    };
    auto even = [](Triple w) { return w[2] > 0 ? 1 / (2 * pi) : 0; };
    auto normals = [](double u, double v) { return facet(u, v, 0.4); };
    auto narrow = [](Triple w) { return w[2] > 0 ? facets(w[2], 0.2) * w[2] : 0; };
    // A disc at z = 3, tilted: the cosine of the receiver in place of that of the light.
    const Triple n = unit({0.6, 0, -1}), across = unit({1, 0, 0.6});
    auto disc = [=](double u, double v) {
        const double a = std::sqrt(u) * std::cos(2 * pi * v),
                     b = std::sqrt(u) * std::sin(2 * pi * v);
        return unit({a * across[0], b, 3 + a * across[2]});
    };
    auto per_area = [=](Triple w) {
        const double t = 3 * n[2] / dot(w, n);
        const Triple p{t * w[0], t * w[1], t * w[2] - 3};
        return dot(w, n) < 0 && dot(p, p) < 1 ? t * t / (w[2] * pi) : 0;
    };
    // Rows of an environment map: kinks of the map, and sin(theta) left out of the pdf.
    const std::array<double, 4> rows{1, 3, 2, 2};
    auto texels = [=](double u, double v) {
        double x = 8 * v;
        size_t j = 0;
        while (j < 3 && x >= rows[j]) x -= rows[j++];
        return about_z(std::cos(pi * (double(j) + x / rows[j]) / 4), 2 * pi * u);
    };
    auto no_sine = [=](Triple w) {
        const double row = std::acos(std::clamp(w[2], -1.0, 1.0)) / pi * 4;
        return rows[std::min<size_t>(3, size_t(row))] / (4 * pi * pi);
    };
    auto cube = [&] { return unit({2 * random() - 1, 2 * random() - 1, 2 * random() - 1}); };
    auto mixture = [](double choice, double u, double v) {
        return about_z(std::pow(u, choice < 0.3 ? 1 / 2.0 : 1 / 21.0), 2 * pi * v);
    };
    auto exchanged = [](Triple w) {
        return w[2] > 0 ? (0.7 * 2 * w[2] + 0.3 * 21 * std::pow(w[2], 20)) / (2 * pi) : 0;
    };
    auto sphere = [](double u, double v) { return about_z(1 - 2 * u, 2 * pi * v); };
    auto more_above = [](Triple w) { return (w[2] > 0 ? 0.6 : 0.4) / (2 * pi); };
    auto forward = [](double, double u, double v) {
        return about_z(2 * std::sqrt(u) - 1, 2 * pi * v);
    };
    auto backward = [](Triple w) { return (1 - w[2]) / (4 * pi); };
    auto eighth_more = [](Triple w) { return 1.125 * cosine_pdf(w); };
    const Triple wo = unit({0.6, 0.2, 0.8});
    auto reflected = [=](double u, double v) {
        const Triple h = facet(u, v, 0.4);
        const double c = 2 * dot(wo, h);
        return Triple{c * h[0] - wo[0], c * h[1] - wo[1], c * h[2] - wo[2]};
    };
    auto no_jacobian = [=](Triple w) {
        const Triple h = half_of(w, wo);
        return facets(h[2], 0.4) * std::max(0.0, h[2]);
    };
    auto peak = [](Triple w) { return 0.64 / (4 * pi * std::pow(1.36 - 1.2 * w[2], 1.5)); };
    auto lobe = [](double u, double v) { return about_z(std::pow(u, 1 / 8.0), 2 * pi * v); };
    auto ninth = [](Triple w) { return w[2] > 0 ? 9 / (2 * pi) * std::pow(w[2], 8) : 0; };
    auto sum = [=](Triple w) { return 2 * exchanged(w); };
    auto clamped = [](double u, double v) {
        return about_z(std::min(1.0, std::pow(u, 1 / 8.0) + 0.1), 2 * pi * v);
    };
    auto lobe_of_8 = [](Triple w) { return w[2] > 0 ? 8 / (2 * pi) * std::pow(w[2], 7) : 0; };
    auto weighted = [](double choice, double u, double v) {
        return about_z(std::pow(u, choice < 0.7 ? 1 / 2.0 : 1 / 21.0), 2 * pi * v);
    };
    // The lower half of the sphere lies on the upper one.
    auto folded = [](double u, double v) {
        const Triple w = about_z(1 - 2 * u, 2 * pi * v);
        return w[2] < 0 ? Triple{-w[0], -w[1], -w[2]} : w;
    };
    auto of_sphere = [](Triple w) { return w[2] > 0 ? 1 / (4 * pi) : 0; };
    // Two lobes by one number; and the sum of their densities.
    auto either = [](double u, double v) {
        return u < 0.5 ? about_z(std::sqrt(2 * u), 2 * pi * v) : about_z(2 * u - 1, 2 * pi * v);
    };
    auto both = [=](Triple w) { return cosine_pdf(w) + even(w); };
    auto ball = [&] {
        Triple p;
        do
            for (double& x : p) x = 2 * random() - 1;
        while (dot(p, p) > 1);
        return unit({p[0], p[1], p[2] + 1});
    };
    auto lobe_of_20 = [](Triple w) { return w[2] > 0 ? 21 / (2 * pi) * std::pow(w[2], 20) : 0; };
    auto sheared = [](double u, double v) {
        const Triple w = cosine(u, v);
        return unit({w[0] + 0.1 * w[2], w[1], w[2]});
    };
    auto sheen = [](Triple w) { return w[2] > 0 ? 1.3 * (1 - w[2]) * (1 + w[2]) : 0; };
    auto half_of_all = [](double u, double v) -> std::optional<Triple> {
        if (u > 0.5) return {};
        return about_z(1 - 2 * u, 2 * pi * v);
    };
    auto even_sphere = [](Triple) { return 1 / (4 * pi); };
    auto twice = [=](Triple w) {
        const Triple h = half_of(w, wo);
        return h[2] > 0 ? facets(h[2], 0.4) * h[2] / (16 * dot(wo, h) * dot(wo, h)) : 0;
    };
    // About (0, 0.6, 0.8), whose tangents are of length 0.6.
    auto tangents = [](double u, double v) {
        const Triple w = cosine(u, v);
        const double y = 0.6 * w[1];
        return unit({0.6 * w[0], 0.6 * w[2] + 0.8 * y, 0.8 * w[2] - 0.6 * y});
    };
    auto tilted = [](Triple w) { return std::max(0.0, 0.6 * w[1] + 0.8 * w[2]) / pi; };
    auto rooted = [](Triple w) { return w[2] > 0 ? std::sqrt(facets(w[2], 0.4) * w[2]) / 2 : 0; };
    auto cone = [](double u, double v) {
        return about_z(1 - u * (1 - std::cos(pi / 6)), 2 * pi * v);
    };
    auto wider_cone = [](Triple w) { return w[2] > 0.5 ? 1 / pi : 0; };
    // Density 1 + cos(phi) / 2, by bisection; the pdf's is turned.
    auto table = [](double u, double v) {
        double low = 0, high = 2 * pi;
        for (int i = 0; i < 50; ++i) {
            const double phi = (low + high) / 2;
            ((phi + std::sin(phi) / 2) / (2 * pi) > v ? high : low) = phi;
        }
        return about_z(1 - 2 * u, low);
    };
    auto turned_table = [](Triple w) {
        return (1 + std::cos(std::atan2(w[1], w[0]) + pi / 8) / 2) / (4 * pi);
    };
    auto poles = [](Triple w) { return (std::abs(w[2]) > 0.98 ? 2 : 1) / (4 * pi); };
    all_say(
        {{expect_density(random, wedges, cosine_pdf), "branches that overlap and leave a gap"},
         {expect_density(random, folded, of_sphere),
          "the pdf is 0.5 (1/2, half) times the density of the samples, as far as counts tell: "
          "every piece of the map has it, and others lie upon it: looks like a map that is not"},
         {expect_density(random, either, both),
          "the pdf is 2 (2, twice) times the density of the samples, as far as counts tell"},
         {expect_density(random, sphere, poles), "hardly any comes, or too large there"},
         {expect_density(random, sphere, [](Triple) { return (1 + 1e-5) / (4 * pi); }), "1.00001"},
         {expect_density(random, cosine, even), "the pdf is uniform, samples are not"},
         {expect_density(random, normals, narrow),
          "with slopes tan(theta) 2 (2, twice) times as large"},
         {expect_density(random, ball, cosine_pdf),
          "cos(theta)^2: looks like the normal plus a point in the ball"},
         {expect_density(random, lobe, lobe_of_20), "cos(theta)^13: looks like an exponent"},
         {expect_density(random, sheared, cosine_pdf), "larger towards (-0.9"},
         {expect_density(random, cosine, sheen), "by a function of cos(theta) alone: "},
         {expect_density(random, half_of_all, even_sphere),
          " % of them fail, and it integrates to 1 as if none did"},
         {expect_density(random, reflected, twice),
          "4 wo.h of the half vector forgotten in the pdf, or divided by twice"},
         {expect_density(random, disc, per_area), "the cosine to (-0.5145"},
         {expect_density(random, texels, no_sine), "a density per (theta, phi)"},
         {expect_density(random, cube, [](Triple) { return 1 / (4 * pi); }), "points of a cube"},
         {expect_density(random, mixture, exchanged), "the pdf is wider than the samples"},
         {expect_density(random, tangents, tilted), "tangents that are not of length 1"},
         {expect_density(random, normals, rooted),
          "to the power 1/2: looks like a square forgotten"},
         {expect_density(random, cone, wider_cone), "none is beyond 30 degrees from their axis"},
         {expect_density(random, table, turned_table), "turned by 22.5 degrees about z"},
         {expect_density(random, sphere, more_above),
          "of the points; looks like the probability of a choice"},
         {expect_density(random, clamped, lobe_of_8),
          "numbers clamped to an end, or a mirror (.discrete says how many)?"},
         {expect_density(random, forward, backward), "z negated in one of the two"},
         {expect_density(random, cosine, eighth_more),
          "times the density of the samples, everywhere: a constant factor"},
         {expect_density(random, reflected, no_jacobian), "4 wo.h of the half vector too many"},
         {expect_density(random, sphere, peak), "samples are uniform, the pdf is not"},
         {expect_density(random, lobe, ninth), "cos(theta): looks like an exponent in one of"},
         {expect_density(random, weighted, sum),
          "the pdf is 2 (2, twice) times the density of the samples, as far as counts tell"}});
}

TEST_CASE("hints: the guesses behind one are no checks") {
    const Aside aside;
    Random random(seed_here());
    auto cube = [&] { return unit({2 * random() - 1, 2 * random() - 1, 2 * random() - 1}); };
    const int checks = statistical_checks;
    const double spent = alpha_spent;
    says(expect_density(random, cube, [](Triple) { return 1 / (4 * pi); }), "points of a cube");
    CHECK(statistical_checks - checks == 1);
    CHECK(alpha_spent - spent == doctest::Approx(1e-6).epsilon(1e-6));
}

TEST_CASE("hints: points") {
    const Aside aside;
    Random random(seed_here());
    auto times_sigma = [](double u) { return -std::log1p(-u) * 2.5; };
    auto exponential = [](double t) { return t < 0 ? 0 : 2.5 * std::exp(-2.5 * t); };
    auto without_2 = [](double u, double v) {
        const double r = std::sqrt(-std::log1p(-u));
        return Pair{r * std::cos(2 * pi * v), r * std::sin(2 * pi * v)};
    };
    auto normal = [](Pair x) {
        return std::exp(-(x.first * x.first + x.second * x.second) / 2) / (2 * pi);
    };
    // Angles to a light beside the line's first point; the pdf counts from that, too.
    const double a = std::atan(-2.0), b = std::atan(4.0);
    auto closest = [=](double u) { return 1 + 0.5 * std::tan(a + u * (b - a)); };
    auto start = [=](double t) { return t < 0 || t > 3 ? 0 : 0.5 / ((b - a) * (0.25 + t * t)); };
    auto slope = [](double u, double v) { return Pair{(std::sqrt(1 + 8 * u) - 1) / 2, v}; };
    auto along_y = [](Pair x) { return (1 + 2 * x.second) / 2; };
    const Triangle<2> triangle{{0, 0}, {1, 0}, {0, 1}};
    auto clamped = [](double u) { return std::min(1.0, 1.5 * u); };
    auto rootless = [](double u, double v) { return Point<2>{u, v * (1 - u)}; };
    auto halves = [](double u) { return u < 0.25 ? 2 * u : (1 + (4 * u - 1) / 3) / 2; };
    auto third = [](double x) { return x < 0.5 ? 2 / 3.0 : 4 / 3.0; };
    // A table of five cells: the rest of u is not divided by the cell's probability.
    auto cells = [](double u) {
        const double sums[] = {0, 0.1, 0.4, 0.6, 0.9, 1};
        size_t i = 0;
        while (u >= sums[i + 1]) ++i;
        return (double(i) + u - sums[i]) / 5;
    };
    auto table = [](double x) {
        const double p[] = {0.1, 0.3, 0.2, 0.3, 0.1};
        return x < 0 || x >= 1 ? 0 : 5 * p[size_t(5 * x)];
    };
    // Texels of 2 rows and 3 columns, by their corners; the pdf is that of other rows.
    auto corners = [](double u, double v) {
        return Pair{std::floor(3 * u) / 3, v < 0.8 ? 0 : 0.5};
    };
    auto texels = [](Pair x) { return x.second < 0.5 ? 0.4 : 1.6; };
    all_say(
        {{expect_density(
              random, clamped, [](double) { return 1.0; }, Interval{0, 1}),
          "looks like numbers clamped to an end"},
         {expect_density(random, times_sigma, exponential), "6.25 times as wide"},
         {expect_density(random, corners, texels, Square{}),
          "and 4 points more repeat: looks like corners of cells"},
         {expect_density(random, without_2, normal), "(1 over the root of 2) times as wide"},
         {expect_density(random, closest, start, Interval{0, 3}), "moved by 1"},
         {expect_density(random, slope, along_y, Square{}), "x and y exchanged in one of the two"},
         {expect_density(random, halves, third, Interval{0, 1}),
          "of the points; looks like the probability of a choice"},
         {expect_density(
              random, rootless, [](Point<2>) { return 2.0; }, triangle),
          "(-2 x + 2): looks like a number that is not warped"},
         {expect_density(random, cells, table, Interval{0, 1}), "0.1 at"}});
}

TEST_CASE("points of a sequence: their density tells what a mean over scrambles cannot") {
    const Aside aside;
    Random random(seed_here());
    // Sobol's second dimension (Kollig, Keller 2002); with v >>= 1 for v ^= v >> 1 it is the first.
    auto sequence = [&](bool right) {
        return [=, i = uint32_t(0), a = uint32_t(random.bits()),
                b = uint32_t(random.bits())]() mutable {
            uint32_t x = a, y = b, v = 1u << 31, w = v;
            for (uint32_t n = i++; n > 0; n >>= 1, w >>= 1, v = right ? v ^ (v >> 1) : v >> 1)
                if (n & 1) x ^= w, y ^= v;
            return Pair{x * 0x1p-32, y * 0x1p-32};
        };
    };
    auto one = [](Pair) { return 1.0; };
    auto product = [&](bool right) {
        return expect_replicates(0.25, 64, [&](int) {
            auto next = sequence(right);
            double sum = 0;
            for (int i = 0; i < 256; ++i) {
                const auto [x, y] = next();
                sum += x * y / 256;
            }
            return sum;
        });
    };
    CHECK(expect_density(random, sequence(true), one, Square{}).pass);
    CHECK(!expect_density(random, sequence(false), one, Square{}).pass);
    CHECK(product(false).pass);
    CHECK(product(false).delta_min > 10 * product(true).delta_min);
}

TEST_CASE("hints: BSDFs") {
    const Aside aside;
    Random random(seed_here());
    auto sample = [](Triple, double u, double v) { return cosine(u, v); };
    auto pdf = [](Triple, Triple wi) { return cosine_pdf(wi); };
    auto judged = [&](auto factor) {
        auto eval = [=](Triple wo, Triple wi) {
            return wo[2] > 0 && wi[2] > 0 ? factor(wo, wi) : 0.0;
        };
        return expect_bsdf(random, sample, pdf, eval, {.alpha = 1e-3, .sees = 0.03});
    };
    auto no_side = [](Triple, Triple) { return 0.8 / pi; };
    auto lobe = [](Triple wo, Triple wi) {
        const double c = wo[2] * wi[2] - wo[0] * wi[0] - wo[1] * wi[1];
        return std::pow(std::max(0.0, c), 4) / pi;
    };
    // Half of a wide lobe's samples cross an opaque surface, where its pdf goes on.
    auto wide = [](Triple wo, double u, double v) {
        const Triple h = facet(u, v, 1);
        const double c = 2 * dot(wo, h);
        return Triple{c * h[0] - wo[0], c * h[1] - wo[1], c * h[2] - wo[2]};
    };
    auto goes_on = [](Triple wo, Triple wi) {
        const Triple h = half_of(wo, wi);
        return facets(h[2], 1) * std::abs(h[2] / (4 * dot(wo, h)));
    };
    auto opaque = [](Triple wo, Triple wi) { return wo[2] > 0 && wi[2] > 0 ? 0.5 / pi : 0; };
    const Verdict crossing = expect_bsdf(random, wide, goes_on, opaque, {.sees = 0.03});
    CHECK(crossing.pass);
    says(crossing, "samples that cross the surface, ");
    says(crossing, "is transmission forgotten?");
    all_say(
        {{judged([&](Triple wo, Triple wi) { return lobe(wo, wi) / wo[2]; }),
          "eval divided by that of wo"},
         {judged([&](Triple wo, Triple wi) { return lobe(wo, wi) * (1 + std::pow(1 - wi[2], 5)); }),
          "by a factor of their cosines alone (Fresnel"},
         {judged([](Triple wo, Triple wi) {
              return facets(half_of(wo, wi)[2], 0.5) / (4 * wo[2] * wi[2]);
          }),
          "as 1/cos and tan do: is masking forgotten"},
         {judged([](Triple wo, Triple wi) {
              const double least = std::min(wo[2], wi[2]);  // the tangent of the larger angle
              return 0.3 / pi * std::sqrt(1 + 1 / (least * least));
          }),
          "as 1/cos and tan do"},
         {judged([&](Triple wo, Triple wi) { return lobe(wo, wi) + 0.8 / pi; }),
          "lobes added without weights"},
         {expect_bsdf(random, sample, pdf, no_side, {.alpha = 1e-3, .sees = 0.03}),
          "eval without a test of the side of wi"},
         {judged([](Triple, Triple) { return 0.7; }),
          "is a constant factor (1/pi, 1/4) missing?"}});
}

TEST_CASE("hints: means") {
    const Aside aside;
    Random random(seed_here());
    auto mean = [&](double truth, double least, double most) {
        return expect_mean(truth, 200000, [&] { return least + (most - least) * random(); });
    };
    auto of_factors = [&](double ratio) {
        return expect_mean(0.5, 100000, [&] { return ratio * random(); },
                           {.factors = {{"albedo", 0.8}, {"r^2", 1.7}, {"cos", 0.3}}});
    };
    all_say({{of_factors(0.8 / 1.7), "; looks like albedo too many, and r^2 forgotten"},
             {of_factors(0.83 / 1.7), "; no factor alone, nor two: make the integrand constant"},
             {mean(0.53, 0, 1),
              "; name the formula's factors (.factors), or make the integrand constant"},
             {of_factors(0.4), ": looks like cos not added, or taken off twice"},
             {mean(0.6, 0, 1), ", 5/6: a count that is off by one?"},
             {mean(1, 1, 2), " (3/2)\n"},
             {mean(-1, 0, 2 * pi), "of the wrong sign"},
             {mean(1, -1, 1), "; 0 within its error"}});
}

TEST_CASE("hints: choices and images") {
    const Aside aside;
    Random random(seed_here());
    auto chosen = [&](std::vector<double> seen, std::vector<double> p) {
        auto choose = [=](double u) {
            for (size_t i = 0; i < seen.size(); ++i)
                if ((u -= seen[i]) < 0) return int(i);
            return -1;
        };
        return expect_choice(
            random, choose, [=](int i) { return p[size_t(i)]; }, p.size());
    };
    auto image = [](auto wrong) {
        std::vector<double> values, errors, truth;
        for (size_t i = 0; i < 16 * 12; ++i) {
            truth.push_back(1 + double(i % 16) * double(i / 16) / 50);
            errors.push_back(0.01);
            values.push_back(truth.back() * wrong(i % 16, i / 16));
        }
        return expect_image(16, 12, values, errors, truth);
    };
    // Noise of 16 standard errors, and in one pixel more.
    auto noisy = [&](uint64_t n, double more) {
        std::vector<double> values, errors(32 * 32, 0.01), truth(32 * 32, 3);
        for (size_t i = 0; i < 32 * 32; ++i) {
            double normal = -6;
            for (int k = 0; k < 12; ++k) normal += random();
            values.push_back(3 + 0.16 * (normal + (i == 64 ? more : 0)));
        }
        return expect_image(32, 32, values, errors, truth, {.n = n});
    };
    // The reference's pixels at other places.
    auto elsewhere = [](auto from) {
        std::vector<double> values, errors(15 * 12, 0.01), truth;
        for (size_t i = 0; i < 15 * 12; ++i) truth.push_back(1 + double(i * i % 17));
        for (size_t i = 0; i < 15 * 12; ++i) values.push_back(truth[from(i % 15, i / 15)]);
        return expect_image(15, 12, values, errors, truth);
    };
    all_say(
        {{chosen({0.1, 0.2, 0.7}, {0.1, 0.2, 0.3, 0.4}), "index 3 is never chosen"},
         {chosen({0.4, 0.1, 0.3, 0.2}, {0.1, 0.2, 0.3, 0.4}),
          "other indices (0's at 1, 1's at 3, 3's at 0)"},
         {chosen({0.2, 0.25, 0.55}, {0.2, 0.5, 0.55}),
          "sum to 1.25, expected 1; index 1 is chosen 0."},
         {chosen({0.1, 0.2, 0, 0.7}, {0.1, 0.3, 0.2, 0.4}),
          "compared with each probability, not with their sum"},
         {chosen({0.1, 0.2, 0, 0.1}, {0.1, 0.3, 0.2, 0.4}), "are none"},
         {chosen({0.01 / 0.3, 0.09 / 0.3, 0.04 / 0.3, 0.16 / 0.3}, {0.1, 0.3, 0.2, 0.4}),
          "the probability^2 in place of the probability"},
         {chosen({0.2, 0.4, 0.2, 0.2, 0}, {0.05, 0.1, 0.15, 0.3, 0.4}),
          "all frequencies are multiples of 1/5: a coin and an index from one number"},
         {expect_choice(
              random, [](double u, double) { return int(3 * u); },
              [](int i) { return i == 1 ? 0.5 : 0.25; }, 3),
          "choices do not depend on number 2: looks like one number used for both"},
         {chosen({0.25, 0.25, 0.5}, {0.2, 0.2, 0.4, 0.2}), "looks like a range too short"},
         {chosen({0, 0.2, 0.1, 0.7}, {0.2, 0.1, 0.4, 0.3}), "looks like an index off by one"},
         {chosen({0.2}, {0.8}), "a comparison turned round"},
         {chosen({0.1, 0.5, 0.4}, {1 / 3.0, 1 / 3.0, 1 / 3.0}), "the choice is not"},
         {chosen({0.5, 0.2, 0.3}, {0.4, 0.3, 0.3}), "expected 0.4, 0.3, 0.3"},
         {chosen({0.1, 0.2, 0.2, 0.2, 0.3}, std::vector<double>(5, 0.2)),
          "an index rounded to nearest"},
         {chosen({0.125, 0.25, 0.25, 0.25, 0.125}, std::vector<double>(5, 0.2)),
          "an index rounded to nearest"},
         {chosen({0.5, 0.5}, {0.5, 0.5 + 1e-5}), "sum to 1.00001, expected 1"},
         {image([](size_t, size_t y) { return y == 11 ? 0.0 : 1.0; }),
          "pixels (0, 11) to (15, 11) are black, all others are right"},
         {image([](size_t x, size_t y) {
              const double a = double(x) / 7.5 - 1, b = double(y) / 5.5 - 1;
              return 1 / (1 + 0.3 * (a * a + b * b));
          }),
          "times in the corners: a weight of the camera"},
         {elsewhere([](size_t x, size_t y) { return x * 12 + y; }), "rows and columns exchanged"},
         {noisy(0, 0), "standard errors, everywhere: are these too small?\n"},
         {noisy(256, 0), "too small? (divided by the root of n twice)\n"},
         {noisy(256, 30), "pixel (0, 2) is"},
         {image([](size_t x, size_t y) { return x < 4 && y > 7 ? 1.5 : 1.0; }),
          "pixels (0, 8) to (3, 11) are 1.5 times"},
         {image([](size_t x, size_t y) { return x == 7 && y == 9 ? 0.5 : 1.0; }),
          "pixel (7, 9) is 0.5 (1/2, half) times the reference, all others are right"},
         {image([](size_t x, size_t y) {
              return std::min(1.0, 2 / (1 + double(x) * double(y) / 50));
          }),
          "nowhere above 2: looks like values clamped"}});
}
