// oracle/exact_test.cpp  verdicts in closed form, and lumps that only one part of a check sees
#include <doctest/doctest.h>

#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "oracle/expect.h"
#include "oracle/textbook.h"

TEST_CASE("Poisson: k or more, by the sum of the terms below k") {
    for (double mean : {0.01, 1.0, 7.5}) {
        double term = std::exp(-mean), below = 0;
        for (int k = 0; k < 12; ++k) {
            CHECK(oracle::p_at_least(k, mean) == doctest::Approx(1 - below).epsilon(1e-10));
            below += term;
            term *= mean / (k + 1);
        }
    }
    CHECK(oracle::p_at_least(1, 0) == 0);
    CHECK(oracle::p_at_least(0, 0) == 1);
}

TEST_CASE("counts: two cells are one degree of freedom") {
    const std::vector<uint64_t> counts = {5100, 4900};  // 2 sigma
    const std::vector<double> half = {0.5, 0.5};
    CHECK(oracle::expect_counts(counts, half).p ==
          doctest::Approx(oracle::p_of_z(2)).epsilon(1e-9));
}

TEST_CASE("two means: one of few numbers has its degrees of freedom, one of many adds none") {
    const oracle::Estimate few{1, 0.1, 9}, many{0.5, 1e-9, 1e6}, as_few{0.5, 0.1, 9};
    CHECK(oracle::expect_equal(few, many).p == doctest::Approx(oracle::p_of_t(5, 9)).epsilon(1e-9));
    CHECK(oracle::expect_equal(few, as_few).p ==
          doctest::Approx(oracle::p_of_t(5 / std::sqrt(2.0), 18)).epsilon(1e-9));
}

TEST_CASE("images: a lump in any one of the 16 blocks is seen, which no pixel and no mean shows") {
    // 256 pixels that are off by 0.65 sigma each: 10.4 sigma of their block, 2.6 of the image.
    const oracle::Aside aside;
    const size_t size = 64;
    oracle::Random random(seed_here());
    const std::vector<double> truth(size * size, 2), errors(size * size, 0.1);
    for (size_t block : {0, 3, 6, 9, 12, 15}) {
        std::vector<double> values;
        for (size_t i = 0; i < size * size; ++i) {
            double normal = -6;  // nearly
            for (int k = 0; k < 12; ++k) normal += random();
            const size_t here = i / size / 16 * 4 + i % size / 16;
            values.push_back(2 + 0.1 * (normal + (here == block ? 0.65 : 0)));
        }
        const oracle::Verdict v = oracle::expect_image(size, size, values, errors, truth);
        INFO(v.text);
        CHECK(v.p < 1e-9);
    }
}

// ---- What a reviewer provoked -------------------------------------------------------------------

namespace {

using namespace oracle;

const Options quick{.sees = 0.03};

}  // namespace

TEST_CASE("choices: one, one that never comes, one of a million; none among whole probabilities") {
    const Aside aside;
    Random random(seed_here());
    auto choice = [&](auto choose, auto probability, int count) {
        return expect_choice(random, choose, probability, count, quick);
    };
    auto first = [](double) { return 0; };
    auto second = [](double) { return 1; };
    auto whole = [](int i) { return i == 1 ? 1.0 : 0.0; };
    CHECK(choice(
              first, [](int) { return 0.99999994f; }, 1)
              .pass);
    CHECK(choice(second, whole, 3).pass);
    // Probabilities by floats, returned as doubles.
    auto third = [](double u) { return int(3 * u); };
    CHECK(choice(
              third, [](int) { return double(1 / 3.0f); }, 3)
              .pass);
    says(choice(
             third, [](int) { return 1 / 3.0 + 1e-6; }, 3),
         "the probabilities sum to 1.000003, expected 1");
    int refused = 0;
    for (double q : {1e-8, 1e-7, 1e-6}) {
        auto rare = [q](double u) { return u < q; };
        auto probability = [q](int i) { return i ? q : 1 - q; };
        for (int k = 0; k < 100; ++k) refused += !choice(rare, probability, 2).pass;
    }
    CHECK(refused == 0);
    says(choice([](double u) { return u < 0.1 ? -1 : 0; }, [](int) { return 1.0; }, 1),
         "10 % of the choices are none, though the probabilities sum to 1");
    // Numbers of a float, which are never 1.
    auto quarter = [](float u) { return int(u * 4); };
    CHECK(expect_choice(
              random, quarter, [](int) { return 0.25; }, 4)
              .pass);
}

TEST_CASE("densities: 99 % that fail hide less than 10 %; a sample at 0 lies on the line") {
    const Aside aside;
    Random random(seed_here());
    auto rare = [](double u, double v) { return v < 0.99 ? std::nullopt : std::optional(u); };
    auto pdf = [](double factor) {
        return [factor](double x) { return 0 <= x && x < 1 ? 0.01 * factor : 0; };
    };
    CHECK(expect_density(random, rare, pdf(1), quick).pass);
    CHECK(!expect_density(random, rare, pdf(1.1), quick).pass);
    // Every second sample is 0, where a density may begin.
    auto zero = [](float u) { return u < 0.5f ? 0.0f : -std::log1p(-(2 * u - 1)); };
    auto decay = [](float x) { return x < 0 ? 0 : std::exp(-x); };
    const Verdict v = expect_density(random, zero, decay, quick);
    CHECK(v.text.find("outside") == std::string::npos);
    CHECK(!v.pass);
}

TEST_CASE("densities in float: two rules agreed by chance at a kink, in one of 60 000 runs") {
    auto tent = [](float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); };
    auto height = [](float x) { return std::max(0.0f, 1 - std::abs(x)); };
    oracle::Random random(oracle::seed_of("densities of the plane: tents, float 86"));
    auto sample = [&](float u, float v) { return std::make_pair(tent(u), tent(v)); };
    auto pdf = [&](std::pair<float, float> p) { return height(p.first) * height(p.second); };
    EXPECT(oracle::expect_density(random, sample, pdf, {.sees = 0.05}), 0.06);
}

// Arvo 1995; the density is 1 / area where all three planes through edges say inside.
TEST_CASE("densities in float: a triangle of the sphere, whose borders rules of quadrature miss") {
    using V = textbook::Vec<float>;
    const V a = unit(V{1, 0.2f, 1}), b = unit(V{-0.5f, 1, 1.5f}), c = unit(V{-0.3f, -0.8f, 1});
    const V ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
    auto angle = [](V n, V m) { return std::acos(-dot(unit(n), unit(m))); };
    const float alpha = angle(ab, ca), cosine = dot(a, b),
                area = alpha + angle(ab, bc) + angle(bc, ca) - textbook::pi<float>;
    const V side = unit(c + -dot(c, a) * a);
    auto sample = [&](float u, float v) {
        const float s = std::sin(u * area - alpha), t = std::cos(u * area - alpha),
                    x = t - std::cos(alpha), y = s + std::sin(alpha) * cosine;
        const float q = std::clamp(
            ((y * t - x * s) * std::cos(alpha) - y) / ((y * s + x * t) * std::sin(alpha)), -1.0f,
            1.0f);
        const V edge = q * a + std::sqrt(1 - q * q) * side;
        const float z = 1 - v * (1 - dot(edge, b));
        return z * b + std::sqrt(1 - z * z) * unit(edge + -dot(edge, b) * b);
    };
    auto pdf = [&](V w) {
        return dot(w, ab) >= 0 && dot(w, bc) >= 0 && dot(w, ca) >= 0 ? 1 / area : 0;
    };
    for (uint64_t seed : {77000, 77019, 77022}) {
        Random random(seed);
        EXPECT(expect_density(random, sample, pdf), 0.011);
    }
}

TEST_CASE("densities: a second integral that ran out of evaluations does not blind the check") {
    auto sample = [](double u, double v) {
        return std::pair(std::sqrt(u) * std::cos(2 * pi * v), std::sqrt(u) * std::sin(2 * pi * v));
    };
    auto disc = [](std::pair<double, double> p) {
        return p.first * p.first + p.second * p.second <= 1 ? 1 / pi : 0;
    };
    for (uint64_t seed : {0, 5, 12}) {  // it did, in one of five: delta_min was 600 %
        Random random(seed);
        EXPECT(expect_density(random, sample, disc, {.alpha = 1e-3, .sees = 0.03}), 0.032);
    }
}

TEST_CASE("images: one pixel of eight is named, and no further ones") {
    const Aside aside;
    const std::vector<double> values = {1, 1, 1, 1, 1, 1, 1, 2}, errors(8, 0.01), ones(8, 1);
    CHECK(expect_image(4, 2, values, errors, ones).text.find("further") == std::string::npos);
}

TEST_CASE("images: each of the 24 values of 4x2 pixels in RGB is looked at, in its channel") {
    const Aside aside;
    const std::vector<double> errors(24, 0.01);
    std::vector<double> truth;
    for (int i = 0; i < 24; ++i) truth.push_back(1 + i);
    const Verdict right = expect_image(4, 2, truth, errors, truth);
    says(right, "red, worst of RGB: 4x2 pixels, mean off by 0");
    CHECK(right.pass);
    for (size_t i = 0; i < 24; ++i) {
        std::vector<double> values = truth;
        values[i] += 0.2;
        const char* const channel[] = {"red", "green", "blue"};
        const std::string pixel = say(": pixel (%zu, %zu) is ", i / 3 % 4, i / 12);
        // The same behind a pointer, and as colours.
        struct Colour {
            float r, g, b;
        };
        std::vector<Colour> colours;
        for (size_t k = 0; k < 24; k += 3)
            colours.push_back({float(values[k]), float(values[k + 1]), float(values[k + 2])});
        for (const Verdict& v :
             {expect_image(4, 2, values, errors, truth),
              expect_image(4, 2, std::span(values.data(), 24), std::span(errors.data(), 24), truth),
              expect_image(4, 2, colours, errors, truth)}) {
            INFO(v.text);
            CHECK(!v.pass);
            CHECK(v.text.starts_with(channel[i % 3] + pixel));
        }
    }
    // 5.6 sigma in one of 8 pixels of one of 3 channels, by one of 3 checks: not rare enough.
    std::vector<double> rare = truth;
    rare[5] += 0.056;
    const Verdict kept = expect_image(4, 2, rare, errors, truth);
    CHECK(kept.p / oracle::p_of_z(5.6) == doctest::Approx(9 * 8).epsilon(1e-3));
    CHECK(kept.pass);
    std::vector<double> dark = truth;
    for (size_t i = 0; i < 24; ++i) dark[i] *= i % 3 == 1 ? 1 : 0.5;
    says(expect_image(4, 2, dark, errors, truth), "red, blue: the image is 0.5 (1/2, half) times");
}

namespace {

struct WithValue {
    Triple wi;
    double pdf;
    Triple f;
};
struct WithWeight {
    std::array<float, 3> wi;
    float pdf, weight;
};
struct WithBoth {
    Triple dir;
    double prob, value;
    Triple throughput;
};
struct WithPdf {
    Triple wo;
    double pdf;
};

}  // namespace

TEST_CASE("BSDFs: the value or the weight that sample returns is that of eval") {
    const Aside aside;
    Random random(seed_here());
    // Uniform directions; a glossy lobe, so that neither pdf nor eval is a power of a cosine.
    auto uniform = [](double u, double v) {
        const double r = std::sqrt(1 - u * u), phi = 2 * pi * v;
        return Triple{r * std::cos(phi), r * std::sin(phi), u};
    };
    auto lobe = [](const auto& wo, const auto& wi) {
        if (wo[2] <= 0 || wi[2] <= 0) return 0.0;
        const double c = double(wo[2]) * double(wi[2]) - double(wo[0]) * double(wi[0]) -
                         double(wo[1]) * double(wi[1]);
        return (0.2 + 0.5 * std::max(0.0, c)) / pi;
    };
    auto pdf = [](const auto& wi) { return wi[2] > 0 ? 0.5 / pi : 0; };
    // made(w, f, weight) is what sample returns, in colours of which blue is 0.
    auto judged = [&](auto made) {
        auto colour = [&](Triple wo, Triple wi) {
            const double f = lobe(wo, wi);
            return Triple{f, 2 * f, 0};
        };
        auto sample = [=](Triple wo, double u, double v) {
            const Triple w = uniform(u, v), f = colour(wo, w);
            const double c = 2 * pi * w[2];
            return made(w, f, Triple{f[0] * c, f[1] * c, 0});
        };
        return expect_bsdf(
            random, sample, [&](Triple, Triple w) { return pdf(w); }, colour, quick);
    };
    auto scaled = [](Triple f, double by) { return Triple{f[0] * by, f[1] * by, f[2] * by}; };
    auto values = [&](auto change) {
        return judged([=](Triple w, Triple f, Triple) {
            return WithValue{w, 0.5 / pi, scaled(f, change(w))};
        });
    };
    auto both = [&](double value, double weight) {
        return judged([=](Triple w, Triple f, Triple throughput) {
            return WithBoth{w, 0.5 / pi, value * (f[0] + f[1]) / 3, scaled(throughput, weight)};
        });
    };
    auto tuples = [&](double value, double weight) {
        return judged([=](Triple w, Triple f, Triple throughput) {
            return std::tuple{w, 0.5 / pi, scaled(value == 0 ? throughput : f, value + weight)};
        });
    };
    auto pairs = [&](double by) {
        return judged([=](Triple w, Triple, Triple weight) {
            return std::pair{WithPdf{w, 0.5 / pi}, scaled(weight, by)};
        });
    };
    auto exchanged = [](Triple w, Triple f, Triple) {
        return WithValue{w, 0.5 / pi, {f[1], f[0], f[2]}};
    };
    auto clamped = [](Triple w, Triple f, Triple) {
        return WithValue{w, 0.5 / pi, {std::min(f[0], 0.1), std::min(f[1], 0.1), f[2]}};
    };
    auto half_green = [](Triple w, Triple f, Triple) {
        return WithValue{w, 0.5 / pi, {f[0], w[0] > 0 ? f[1] / 2 : f[1], f[2]}};
    };
    enum class Lobe { diffuse };
    auto flagged = [](Triple w, Triple, Triple) {
        return std::tuple{w, 0.5 / pi, false, 1, Lobe::diffuse};
    };
    auto other_pdf = [](Triple w, Triple f, Triple) { return std::tuple{w, f, 1 / pi}; };
    using floats = std::array<float, 3>;
    auto weights = [&](auto change) {
        auto sample = [&](floats wo, float u, float v) -> std::optional<WithWeight> {
            const Triple w = uniform(double(u), double(v));
            const floats wi = {float(w[0]), float(w[1]), float(w[2])};
            if (u == 0) return {};
            return WithWeight{wi, float(pdf(wi)), float(lobe(wo, wi) * change(w))};
        };
        return expect_bsdf(
            random, sample, [&](floats, floats w) { return float(pdf(w)); },
            [&](floats wo, floats w) { return float(lobe(wo, w)); }, quick);
    };
    CHECK(values([](Triple) { return 1; }).pass);
    CHECK(weights([](Triple w) { return 2 * pi * w[2]; }).pass);
    CHECK(both(1, 1).pass);
    CHECK(tuples(1, 0).pass);
    CHECK(tuples(0, 1).pass);
    CHECK(pairs(1).pass);
    CHECK(judged(flagged).pass);
    const std::pair<Verdict, const char*> refused[] = {
        {values([](Triple) { return 0.5; }),
         "the f that sample returns is 0.5 (1/2, half) times eval's value, at every direction"},
        {values([](Triple w) { return w[2]; }),
         "the f that sample returns is |cos| times eval's value, at every direction"},
        {values([](Triple w) { return w[2] * 2 * pi; }), "(2 pi) |cos| times eval's value"},
        {values([](Triple w) { return w[0] > 0 ? 2 : 1; }), " % of directions, where x > 0\n"},
        {values([](Triple w) { return w[2] < 0.3 ? 0 : 1; }), "where cos(theta) < 0.3\n"},
        {values([](Triple w) { return w[0] > 0   ? 1
                                      : w[1] > 0 ? 2
                                                 : 3; }), " % of directions"},
        {values([](Triple) { return NAN; }),
         "the f that sample returns is nan, but eval's value is "},
        {judged(clamped), "at every direction, where eval's value > 0.1\n"},
        {judged(half_green), " % of directions, where x > 0\n"},
        {judged(exchanged), "for wi = "},
        {judged(other_pdf), "the pdf that sample returns is 2 (2, twice) times what pdf says"},
        {both(0.5, 1), "the f that sample returns is 0.5 (1/2, half) times eval's value, at every"},
        {both(1, 2), "the weight that sample returns is 2 (2, twice) times eval's value |cos| / p"},
        {tuples(3, 0), "the value that sample returns is 3 times eval's value, at every direction"},
        {tuples(0, 0.5), "the value that sample returns is "},
        {pairs(0.5), "0.5 (1/2, half) times eval's value |cos| / pdf, at every direction"},
        {weights([](Triple w) { return w[2]; }),
         "the weight that sample returns is 0.1592 (1/(2 pi)) times eval's value |cos| / pdf, at "},
        {weights([](Triple) { return 2 * pi; }),
         "the weight that sample returns is |cos|^-1 times eval's value |cos| / pdf, at "}};
    for (const auto& [v, why] : refused) {
        says({false, 0, 0, v.text + "\n"}, why);
        CHECK(!v.pass);
    }
}

TEST_CASE("BSDFs: albedos take their part of alpha, and those of skewed weights are told") {
    const Aside aside;
    Random random(seed_here());
    auto uniform = [](Triple, double u, double v) {
        const double r = std::sqrt(1 - u * u), phi = 2 * pi * v;
        return Triple{r * std::cos(phi), r * std::sin(phi), u};
    };
    auto even = [](Triple, Triple wi) { return wi[2] > 0 ? 0.5 / pi : 0; };
    auto judged = [&](auto f, const Options& o) {
        return expect_bsdf(
            random, uniform, even,
            [=](Triple wo, Triple wi) { return wo[2] > 0 && wi[2] > 0 ? f(wo, wi) : 0.0; }, o);
    };
    // Weights 2 albedo u have the standard error albedo / sqrt(3 n) = 1.8e-3.
    auto grey = [](double albedo) { return [=](Triple, Triple) { return albedo / pi; }; };
    const double before = oracle::alpha_spent;
    const int checks = oracle::statistical_checks;
    CHECK(judged(grey(1), quick).pass);
    CHECK(oracle::alpha_spent - before == doctest::Approx(quick.alpha).epsilon(1e-9));
    CHECK(oracle::statistical_checks - checks == 8);
    // Off by 1e-3 + 5.2 standard errors: of 1e-3 / 8 the bound is at 3.7, of 1e-12 / 8 at 7.3.
    int refused = 0, strict = 0;
    for (int i = 0; i < 20; ++i) {
        refused += !judged(grey(1.0105), {.alpha = 1e-3, .sees = 0.1}).pass;
        strict += !judged(grey(1.0105), {.alpha = 1e-12, .sees = 0.1}).pass;
    }
    CHECK(refused >= 19);
    CHECK(strict <= 10);
    // Of uniform directions one in 20 meets a lobe, or one in 10 000.
    auto lobe = [](double part) {
        return [=](Triple wo, Triple wi) {
            const double c = wo[2] * wi[2] - wo[0] * wi[0] - wo[1] * wi[1];
            return 0.2 / pi + (c > 1 - part ? 0.1 / part : 0);
        };
    };
    auto bright = [=](Triple wo, Triple wi) { return 5 * lobe(1e-3)(wo, wi); };
    const Verdict met = judged(lobe(1 / 20.0), quick), seldom = judged(lobe(1e-4), quick);
    CHECK(met.pass);
    INFO(met.text);
    CHECK(met.text.ends_with("above the surface"));
    CHECK(seldom.pass);
    says(seldom,
         "; the albedo for wo = (0.1687, 0.2627, 0.95) is not sure: n = 110000 is too small");
    says(judged(bright, quick), "more leaves than comes");
}

TEST_CASE("the density or probability that comes with a point or an index is told from another") {
    const Aside aside;
    Random random(seed_here());
    auto beside = [](double part) {
        return [=](double u, double v) { return std::pair{Triple{u, v, u + v}, part}; };
    };
    auto density = [](Triple) { return 1 / std::sqrt(3.0); };
    CHECK(expect_jacobian(random, beside(1 / std::sqrt(3.0)), density).pass);
    says(expect_jacobian(random, beside(1), density),
         "the pdf that sample returns is 1.732 times what pdf says, in every sample");
    struct Index {
        int index;
        float pdf;
    };
    auto chance = [](int i) { return i == 0 ? 0.25 : 0.75; };
    auto choice = [](double part) {
        return [=](double u) { return std::pair{u < 0.25 ? 0 : 1, u < 0.25 ? 0.25 : part}; };
    };
    auto named = [](float part) {
        return [=](float u) { return u < 0.25f ? Index{0, 0.25f * part} : Index{1, 0.75f * part}; };
    };
    CHECK(expect_choice(random, choice(0.75), chance, 2).pass);
    CHECK(expect_choice(random, named(1), chance, 2).pass);
    auto said_to_be = [](double p) {
        return [p](double u) { return std::pair{size_t(u * 2000), p}; };
    };
    auto even = [](size_t) { return 1.0 / 2000; };
    CHECK(expect_choice(random, said_to_be(1.0 / 2000), even, 2000).pass);
    for (double p : {0.0, 1.002 / 2000})
        CHECK(!expect_choice(random, said_to_be(p), even, 2000).pass);
    says(expect_choice(random, choice(0.25), chance, 2),
         "the probability that choose returns is 0.3333 (1/3) times what probability says, in 7");
    says(expect_choice(random, named(2), chance, 2),
         "is 2 (2, twice) times what probability says, in every choice");
}

TEST_CASE("what cannot be judged is refused: by the name that it was given, once, and why") {
    const Aside aside;
    Random random(seed_here());
    const Options o{.name = "mine"}, rough{.sees = 0.03, .name = "mine"};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    auto uniform = [&] { return random(); };
    auto broken = [&] { return nan; };
    auto once = [&](int at, double bad) {
        return [&, at, bad, i = 0]() mutable { return ++i == at ? bad : random(); };
    };
    auto rare = [&] { return random() < 0.01 ? 1.0 : 0.0; };
    auto replicate = [&](int) { return random(); };
    auto decays_not = [&](uint64_t) { return nan; };
    auto sample = [](double u, double v) {
        const double r = std::sqrt(u), phi = 2 * pi * v;
        return Triple{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)};
    };
    auto pdf = [](Triple w) { return std::max(0.0, w[2]) / pi; };
    auto always = [](double, double) { return Triple{0, 0, 1}; };
    auto everywhere = [](Triple) { return 1 / (4 * pi); };
    auto seldom = [=](double u, double v) { return u < 1e-3 ? Triple{nan, 0, 0} : sample(u, v); };
    auto sample_of = [=](Triple, double u, double v) { return sample(u, v); };
    auto pdf_of = [=](Triple, Triple w) { return pdf(w); };
    auto black = [](Triple, Triple) { return 0.0; };
    const uint64_t none[] = {0, 0}, few[] = {3, 4}, off[] = {500, 1}, one[] = {1000};
    const double halves[] = {0.5, 0.5}, all[] = {1, 0};
    const std::vector<double> nothing, value{nan}, error{nan}, number{1};
    const std::vector<double> three(3, 1), seven(7, 1), eight(8, 1), lines(20000, 1);
    const Estimate low{1, 0.1, 99}, high{2, 0.1, 99};
    const std::pair<Verdict, const char*> refused[] = {
        {expect_mean(1, 1000, broken, o), "sample 0 is nan"},
        {expect_mean(0.5, 1000, once(42, nan), o), "sample 41 is nan, not finite"},
        {expect_mean(0.5, 100, uniform, o), "n = 100 is too small"},
        {expect_mean(1, 0, uniform, o), "no sample at all"},
        {expect_mean(1, 1, uniform, o), "is constant"},
        {expect_mean(0.5, Estimate{0.5, nan}, o), "not finite"},
        {expect_mean(0.01, 10000, rare, o), "too small for a skewness"},
        {expect_equal(broken, uniform, 1000, o), "first: sample 0 is nan"},
        {expect_equal(uniform, broken, 1000, o), "second: sample 0 is nan"},
        {expect_equal(uniform, once(7, infinity), 1000, o), "second: sample 6 is inf"},
        {expect_equal(low, high, o), ""},
        {expect_replicates(1, 15, replicate, o), "take 16"},
        {expect_replicates(0.5, 0, replicate, o), "no sample at all"},
        {expect_bias_decay(1, 4, 1000, decays_not, o), "not finite"},
        {expect_counts(none, halves, o), "no sample at all"},
        {expect_counts(few, halves, o), "take 200"},
        {expect_counts(off, all, o), "where the density is 0"},
        {expect_counts(one, all, o), "2 probabilities for 1 counts"},
        {expect_counts(off, number, o), "1 probabilities for 2 counts"},
        {expect_counts(off, halves, o, number), "1 variances for 2 counts"},
        {expect_counts(one, number, o), "fewer than two cells"},
        {expect_samples(lines, lines, eight, Line{}, o), "20000 points, 8 values of the pdf"},
        {expect_samples(lines, lines, lines, Line{}, {.n = 10000, .name = "mine"}),
         "20000 samples, of 10000 drawn (.n)"},
        {expect_image(0, 0, nothing, nothing, nothing, o), "no pixel"},
        {expect_image(4, 2, seven, seven, seven, o), "7 values for 4x2 pixels, expected 8 or 24"},
        {expect_image(4, 2, eight, eight, seven, o), "7 reference values for 4x2 pixels, expected"},
        {expect_image(4, 2, eight, all, eight, o), "2 errors for 4x2 pixels, expected 8 or 24"},
        {expect_image(1, 1, three, three, number, o), "1 reference values, but 3 values"},
        {expect_image(1, 1, three, number, three, o), "1 errors, but 3 values"},
        {expect_image(1, 1, number, number, three, o), "3 reference values, but 1 values"},
        {expect_image(4, 2, std::span(eight.data(), 7), eight, eight, o), "7 values for 4x2"},
        {expect_image(1, 1, value, number, number, o), ""},
        {expect_image(1, 1, number, error, number, o), ""},
        {expect_density(random, always, everywhere, rough), "samples are all the same"},
        {expect_density(random, seldom, pdf, o), "sample (nan, 0, 0) is not finite"},
        {expect_bsdf(random, sample_of, pdf_of, black, rough), "eval is 0"}};
    for (const auto& [v, why] : refused) {
        says(v, why);
        CHECK(!v.pass);
        CHECK(v.text.rfind("mine: ", 0) == 0);
        CHECK(v.text.rfind("mine: ") == 0);
    }
    CHECK(expect_mean(0.01, 200000, rare).pass);
}
