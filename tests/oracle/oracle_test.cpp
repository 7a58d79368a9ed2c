// oracle/oracle_test.cpp  tests of the tests: false alarms as often as stated, planted errors seen
#include "oracle/oracle.h"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "oracle/expect.h"
#include "oracle/textbook.h"

namespace {

using namespace oracle;
using oracle::detail::median, oracle::detail::p_of_chi2, oracle::detail::smallest_shift;

struct Direction {
    double x, y, z;
};
using Pair = std::pair<double, double>;

// ---- Right samplers and densities ---------------------------------------------------------------

Direction direction(double z, double phi) {
    const double s = std::sqrt(std::max(0.0, 1 - z * z));
    return {s * std::cos(phi), s * std::sin(phi), z};
}
Direction cosine_direction(double u, double v) { return direction(std::sqrt(1 - u), 2 * pi * v); }
Direction uniform_direction(double u, double v) { return direction(1 - u, 2 * pi * v); }
double cosine_pdf(Direction w) { return std::max(0.0, w.z) / pi; }
double uniform_pdf(Direction w) { return w.z > 0 ? 1 / (2 * pi) : 0; }

Direction mixed_direction(double u, double v) {
    return u < 0.3 ? cosine_direction(u / 0.3, v) : uniform_direction((u - 0.3) / 0.7, v);
}
auto mixed_pdf(double share) {
    return [=](Direction w) { return share * cosine_pdf(w) + (1 - share) * uniform_pdf(w); };
}

double exponential(double u) { return -std::log1p(-u); }
double exponential_pdf(double x) { return x < 0 ? 0 : std::exp(-x); }

Pair disc(double u, double v) {
    return {std::sqrt(u) * std::cos(2 * pi * v), std::sqrt(u) * std::sin(2 * pi * v)};
}
double disc_pdf(Pair x) { return x.first * x.first + x.second * x.second < 1 ? 1 / pi : 0; }

// Nearly normal.
double normal(Random& random) {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += random();
    return sum;
}

// ---- Runs ---------------------------------------------------------------------------------------

template <class Check>
std::vector<Verdict> runs(int n, Check check) {
    const Aside aside;
    std::vector<Verdict> verdicts;
    for (int i = 0; i < n; ++i) verdicts.push_back(check());
    return verdicts;
}
size_t refused(const std::vector<Verdict>& verdicts) {
    return size_t(std::count_if(verdicts.begin(), verdicts.end(), [](auto& v) { return !v.pass; }));
}

// p-values of a right program: uniform by Kolmogorov and Smirnov's test, whose tail is 2 exp(-2 n
// D^2), and in their tails, where alarms are raised, by counting.
void check_uniform(const std::vector<Verdict>& verdicts) {
    std::vector<double> p;
    for (const Verdict& v : verdicts) p.push_back(v.p);
    std::sort(p.begin(), p.end());
    const double n = double(p.size());
    double d = 0;
    for (size_t i = 0; i < p.size(); ++i)
        d = std::max({d, p[i] - double(i) / n, double(i + 1) / n - p[i]});
    INFO("D = ", d, ", p below .01: ", std::lower_bound(p.begin(), p.end(), 0.01) - p.begin());
    CHECK(2 * std::exp(-2 * n * d * d) > 1e-6);
    for (double tail : {0.001, 0.01, 0.1}) {
        // Few or many: the normal approximation, and for rare ones Poisson's tail of 4 + 14.
        const double below = double(std::lower_bound(p.begin(), p.end(), tail) - p.begin());
        const double above = double(p.end() - std::upper_bound(p.begin(), p.end(), 1 - tail));
        const double most = n * tail + 4.9 * std::sqrt(n * tail) + 4;
        CHECK(below <= most);
        CHECK(above <= most);
    }
}

// Errors of the size that the verdicts state must be seen in 99 % of 1000 runs or more.
template <class Check>
void check_seen(int n, Check check) {
    const std::vector<Verdict> verdicts = runs(n, check);
    INFO(verdicts.front().text);
    CHECK(double(refused(verdicts)) >= 0.99 * n);
}

// check(error) is right without an error; by how much a verdict states what is seen.
template <class Check>
double check_uniform(int n, Check check) {
    const std::vector<Verdict> verdicts = runs(n, [&] { return check(0.0); });
    check_uniform(verdicts);
    return verdicts[0].delta_min;
}

}  // namespace

TEST_CASE("means: p-values are uniform, and a bias of the stated size is seen") {
    Random random(seed_here());
    // Skewed numbers, at the smallest n that the check accepts: exponential, skewness 2.
    auto check = [&](double bias) {
        return expect_mean(1 + bias, 10000, [&] { return exponential(random()); });
    };
    const double bias = check_uniform(2000, check);
    check_seen(1000, [&] { return check(bias); });
    check_seen(1000, [&] { return check(-bias); });
    // And the size is no larger than it must be: half of it is seen in under half of the runs.
    CHECK(refused(runs(1000, [&] { return check(bias / 2); })) < 500);
}

TEST_CASE("two means: p-values are uniform, and a difference of the stated size is seen") {
    Random random(seed_here());
    auto check = [&](double bias) {
        auto narrow = [&] { return 1 + 0.1 * random() + bias; };
        return expect_equal(
            narrow, [&] { return 0.55 + random(); }, 1000);
    };
    const double bias = 1.05 * check_uniform(2000, check);
    check_seen(1000, [&] { return check(bias); });
}

TEST_CASE("replicates: p-values are uniform with 16, and a bias of the stated size is seen") {
    Random random(seed_here());
    // A randomly shifted grid of 8 points for the integral of 3 x^2.
    auto replicate = [&](int = 0) {
        const double shift = random();
        double sum = 0;
        for (int i = 0; i < 8; ++i) sum += 3 * std::pow((i + shift) / 8, 2) / 8;
        return sum;
    };
    auto check = [&](double bias) {
        return expect_replicates(1, 16, [&](int r) { return replicate(r) + bias; });
    };
    check_uniform(2000, check);
    // The stated size varies with the estimated deviation: here it is the true one.
    const double deviation = std::sqrt(draw(100000, replicate).variance());
    const double bias = smallest_shift(15) * deviation / 4;
    check_seen(1000, [&] { return check(bias); });
}

TEST_CASE("bias decay: p-values are uniform, a wrong constant is seen, a lasting bias too") {
    Random random(seed_here());
    // The square of the mean of n uniform numbers: its bias is 1 / 12 n, exactly.  The unbiased
    // estimate of the same from pairs cancels most noise.
    auto error = [&](uint64_t n) {
        double sum = 0, squares = 0;
        for (uint64_t i = 0; i < n; ++i) {
            const double x = random() - 0.5;
            sum += x;
            squares += x * x;
        }
        const double m = double(n);
        return sum * sum / (m * m) - (sum * sum - squares) / (m * (m - 1));
    };
    auto check = [&](double size, double lasting = 0) {
        return expect_bias_decay((1 + size) / 12, 8, 1000,
                                 [&](uint64_t n) { return error(n) + lasting; });
    };
    const double size = 1.05 * check_uniform(1000, check);
    check_seen(1000, [&] { return check(size); });
    check_seen(1000, [&] { return check(0, 0.01); });
}

TEST_CASE("counts: p-values are uniform, and a distortion of the stated size is seen") {
    Random random(seed_here());
    auto check = [&](double distortion) {
        std::vector<uint64_t> n(32);
        for (int i = 0; i < 6400; ++i) {
            const size_t pair = size_t(random() * 16);  // in which a cell gains what one loses
            ++n[2 * pair + (random() < 0.5 * (1 + distortion))];
        }
        return expect_counts(n, std::vector<double>(32, 1 / 32.0));
    };
    const double size = check_uniform(2000, check);
    // Of the distorted probabilities q: sum (p - q)^2 / q = d^2 / (1 - d^2).
    check_seen(1000, [&] { return check(size / std::sqrt(1 + size * size)); });
}

TEST_CASE("densities: p-values are uniform, and a distortion of the stated size is seen") {
    Random random(seed_here());
    // phi with density (1 + a sin(2 phi)) / 2 pi, by rejection.
    auto check = [&](double a) {
        auto slope = [&](double u, double v) {
            double phi = 2 * pi * v;
            while (2 * random() > 1 + a * std::sin(2 * phi)) phi = 2 * pi * random();
            return direction(1 - u, phi);
        };
        return expect_density(random, slope, uniform_pdf, {.n = 6400});
    };
    // Cells are quadrants but for the noise of their borders: sin(2 phi) has 2 / pi a more in every
    // other one.  The borders are quantiles of distorted samples, which then hide part: 1.1 covers
    // it.
    const double a = 1.1 * check_uniform(200, check) * pi / 2;
    check_seen(300, [&] { return check(a); });
}

TEST_CASE("densities: the number of samples follows from the error to be seen") {
    Random random(seed_here());
    const Options rough{.alpha = 1e-3, .sees = 0.03};
    const Verdict v = expect_density(random, cosine_direction, cosine_pdf, rough);
    says(v, "n = 9");
    CHECK(v.pass);
    CHECK(v.delta_min == doctest::Approx(0.03).epsilon(1e-3));
    CHECK(expect_density(random, cosine_direction, cosine_pdf).delta_min ==
          doctest::Approx(0.01).epsilon(1e-3));
}

TEST_CASE("choices: p-values are uniform, and a distortion of the stated size is seen") {
    Random random(seed_here());
    auto check = [&](double a) {
        auto choose = [a](double u) {
            return u < 0.25 * (1 + a) ? 0 : u < 0.5 ? 1 : u < 0.75 ? 2 : 3;
        };
        return expect_choice(random, choose, [](int) { return 0.25; }, 4, {.n = 20000});
    };
    const double size = check_uniform(2000, check) * std::sqrt(2.0);  // two cells of four
    check_seen(1000, [&] { return check(size); });
}

TEST_CASE("images: right ones pass, and a bias of the stated size is seen") {
    Random random(seed_here());
    for (const size_t channels : {1, 3}) {
        const std::vector<double> truth(128 * channels, 2), errors(128 * channels, 0.1);
        auto check = [&](double bias) {
            std::vector<double> values(128 * channels);
            for (double& x : values) x = 2 * (1 + bias) + 0.1 * normal(random);
            return expect_image(16, 8, values, errors, truth);
        };
        const auto right = runs(2000, [&] { return check(0); });
        // Sidak's and Bonferroni's corrections: as often as stated, or less often.
        for (double tail : {0.01, 0.1}) {
            double below = 0;
            for (const Verdict& v : right) below += v.p < tail;
            CHECK(below <= 2000 * tail + 5 * std::sqrt(2000 * tail));
            CHECK(below >= 2000 * tail / 10);
        }
        check_seen(1000, [&] { return check(right[0].delta_min); });
    }
}

TEST_CASE("identities see an error of 10^-5 without noise") {
    Random random(seed_here());
    auto off = [](Direction w) { return (1 + 1e-5) * cosine_pdf(w); };
    // As dense as the pdf at the pole, and 10^-5 denser at the horizon.
    auto bent = [](Direction w) { return cosine_pdf(w) * (1 + 1e-5 * (w.z - 2 / 3.0)); };
    const Aside aside;
    says(expect_jacobian(random, cosine_direction, off), "pdf sqrt(det J^T J) = 1.00001");
    CHECK(!expect_density(random, cosine_direction, off).pass);
    says(expect_density(random, cosine_direction, off), "integrates to 1.00001");
    says(expect_density(random, cosine_direction, bent),
         "times as dense as the pdf says, at direction");
}

TEST_CASE("densities on other domains, with jumps and with failing samples, need no option") {
    Random random(seed_here());
    const Options o{.sees = 0.03};
    auto root = [](double u) { return std::sqrt(u); };
    auto twice = [](double x) { return 2 * x; };
    // A triangle in float, whose border cuts across the coordinates.
    using Floats = std::array<float, 2>;
    auto corner_of_square = [](float u, float v) {
        return Floats{1 - std::sqrt(u), v * std::sqrt(u)};
    };
    auto below_diagonal = [](Floats x) {
        return x[0] >= 0 && x[1] >= 0 && x[0] + x[1] <= 1 ? 2.0f : 0.0f;
    };
    // A Gaussian of the plane, by Box and Muller.
    auto gauss = [](Pair u) {
        const double r = std::sqrt(-2 * std::log1p(-u.first)), phi = 2 * pi * u.second;
        return Pair{r * std::cos(phi), r * std::sin(phi)};
    };
    auto gauss_pdf = [](Pair x) {
        return std::exp(-(x.first * x.first + x.second * x.second) / 2) / (2 * pi);
    };
    // Uniform points of a triangle in space, and others.
    const Triangle<3> t{{0, 0, 1}, {2, 0, 0}, {0, 1, 0}};
    auto corner = [&](double u, double v) { return t.at({std::sqrt(u), v}); };
    auto rootless = [&](double u, double v) { return t.at({u, v}); };
    auto outside = [](double u, double v) { return Triple{u, v, 0}; };
    auto per_area = [](Triple) { return 2 / 3.0; };
    // Four dimensions, of which one follows 3 x^2.
    using Four = std::array<double, 4>;
    const Box<4> box{{0, 0, 0, 0}, {1, 1, 1, 1}};
    auto four = [](double a, double b, double c, double d) { return Four{a, b, std::cbrt(c), d}; };
    auto square = [](Four x) { return 3 * x[2] * x[2]; };
    auto cube = [](Four x) { return 4 * std::pow(x[2], 3); };
    // A piecewise constant density of 32 x 16 cells.
    auto texel = [](double x, double y) {
        return 0.25 + (int(32 * x) * 7 + int(16 * y) * 5) % 4 * 0.5;
    };
    auto rejected = [&](double u, double v, double w) {
        return 1.75 * w < texel(u, v) ? std::optional(Pair{u, v}) : std::nullopt;
    };
    auto of_texel = [&](Pair x) { return texel(x.first, x.second) / 1.75; };
    const std::pair<const char*, Verdict> right[] = {
        {"exponential", expect_density(random, exponential, exponential_pdf, o)},
        {"ramp", expect_density(random, root, twice, Interval{0, 1}, o)},
        {"disc", expect_density(random, disc, disc_pdf, o)},
        {"Gaussian", expect_density(random, gauss, gauss_pdf, o)},
        {"triangle in space", expect_density(random, corner, per_area, t, o)},
        {"four dimensions", expect_density(random, four, square, box, o)},
        {"texels", expect_density(random, rejected, of_texel, Square{}, o)},
        {"mixture", expect_density(random, mixed_direction, mixed_pdf(0.3), o)}};
    for (const auto& row : right) {
        const Verdict& v = row.second;
        INFO(row.first, ": ", v.text);
        CHECK(v.pass);
        if (row.first == std::string("texels")) says(v, "of the samples fail");
    }
    for (int i = 0; i < 5; ++i) {
        const Verdict v = expect_density(random, corner_of_square, below_diagonal, o);
        INFO("half of a square: ", v.text);
        CHECK(v.pass);
    }
    const Aside aside;
    auto denser = [](Pair x) { return 1.01 * disc_pdf(x); };
    CHECK(!expect_density(random, disc, denser, o).pass);
    CHECK(!expect_density(random, four, cube, box, o).pass);
    CHECK(!expect_density(random, mixed_direction, mixed_pdf(0.7), o).pass);
    says(expect_density(random, rootless, per_area, t, o), "without its root");
    says(expect_density(random, outside, per_area, t, o), "outside of the domain");
}

TEST_CASE("narrow lobes: one that the pdf or the sampler misses, one in a hundred of a mixture") {
    Random random(seed_here());
    const Aside aside;
    const Options o{.sees = 0.03};
    // About x, 10^-4 wide.
    auto lobe = [](double u, double v) {
        const Direction w = direction(std::pow(1 - u, 1e-8), 2 * pi * v);
        return Direction{w.z, w.x, w.y};
    };
    auto lobe_pdf = [](Direction w) {
        const double off = std::log1p(-(w.y * w.y + w.z * w.z) / (1 + w.x));
        return w.x > 0 ? 1e8 / (2 * pi) * std::exp((1e8 - 1) * off) : 0;
    };
    // Positive at the opposite pole, too, where no sample comes.
    auto either_pole = [&](Direction w) { return lobe_pdf({std::abs(w.x), w.y, w.z}); };
    auto both = [&](double u, double v) {
        return u < 0.01 ? lobe(u / 0.01, v) : uniform_direction((u - 0.01) / 0.99, v);
    };
    auto both_pdf = [&](Direction w) { return 0.01 * lobe_pdf(w) + 0.99 * uniform_pdf(w); };
    auto without = [&](Direction w) { return 0.99 * uniform_pdf(w); };
    CHECK(expect_density(random, lobe, lobe_pdf, o).pass);
    CHECK(!expect_density(random, lobe, uniform_pdf, o).pass);
    CHECK(!expect_density(random, uniform_direction, lobe_pdf, o).pass);
    says(expect_density(random, lobe, either_pole, o), "integrates to 2 (2, twice)");
    CHECK(expect_density(random, both, both_pdf, o).pass);
    CHECK(!expect_density(random, both, without, o).pass);
}

// Textbook code, in float and in double.
namespace {

template <class T>
void check_textbook(const std::string& what, const std::function<textbook::Vec<T>(T, T)>& sample,
                    const std::function<T(textbook::Vec<T>)>& density) {
    const Aside aside;
    Random random(seed_here());
    const Verdict v = expect_density(random, sample, density, {.sees = 0.03});
    INFO(what, sizeof(T) == 4 ? " in float: " : " in double: ", v.text);
    CHECK(v.pass);
}

template <class T>
void check_textbooks() {
    using namespace textbook;
    using V = Vec<T>;
    check_textbook<T>("cosine", textbook::cosine_sample<T>, textbook::cosine_pdf<T>);
    for (T n : {T(1), T(50), T(1000)})
        check_textbook<T>(
            say("Phong lobe, n = %g", double(n)), [n](T u, T v) { return phong_sample(u, v, n); },
            [n](V w) { return phong_pdf(w, n); });
    for (T c : {T(0.5), T(0.99), T(0.9999)})
        check_textbook<T>(
            say("cone, cos = %g", double(c)), [c](T u, T v) { return cone_sample(u, v, c); },
            [c](V w) { return cone_pdf(w, c); });
    for (T a : {T(0.02), T(0.05), T(0.1), T(0.3), T(0.8)})
        for (T z : {T(1), T(0.7), T(0.2)}) {
            const V wo{std::sqrt(1 - z * z), 0, z};
            const std::string where = say(", alpha %g, cos %g", double(a), double(z));
            auto visible = [=](T u, T v) { return ggx_visible_sample(wo, u, v, a); };
            auto visible_pdf = [=](V w) { return ggx_visible_pdf(wo, w, a); };
            check_textbook<T>(
                "half vector" + where, [=](T u, T v) { return ggx_half_sample(wo, u, v, a); },
                [=](V w) { return ggx_half_pdf(wo, w, a); });
            check_textbook<T>("visible normal" + where, visible, visible_pdf);
            if (z != T(0.7)) continue;
            check_textbook<T>(
                "mixture" + where,
                [=](T u, T v) {
                    return u < T(0.3) ? cosine_sample(u / T(0.3), v)
                                      : visible((u - T(0.3)) / T(0.7), v);
                },
                [=](V w) { return T(0.3) * textbook::cosine_pdf(w) + T(0.7) * visible_pdf(w); });
        }
}

}  // namespace

// The smallest error that each check sees of so many samples, and its seconds, by default and at
// {.alpha = 1e-3, .sees = 0.03}: the table of README.md.
// build/.../oracle_test.exe -ns -tc="what checks cost"
TEST_CASE("what checks cost" * doctest::skip()) {
    using clock = std::chrono::steady_clock;
    auto row = [](const char* what, auto samples, auto check) {
        std::printf("| %s |", what);
        for (const Options& o : {Options{}, Options{.alpha = 1e-3, .sees = 0.03}}) {
            const uint64_t n = uint64_t(samples(o));
            std::vector<double> seconds;
            double seen = 0;
            for (int i = 0; i < 5; ++i) {
                const auto begin = clock::now();
                const Verdict v = check(o, n);
                seconds.push_back(std::chrono::duration<double>(clock::now() - begin).count());
                CHECK(v.pass);
                seen = v.delta_min;
            }
            std::printf(" %.2g %% at n = %g, %.2g s |", 100 * seen, double(n), median(seconds));
        }
        std::printf("\n");
    };
    auto fixed = [](double n) { return [=](const Options&) { return n; }; };
    Random random(seed_here());
    auto density = [&](const char* what, auto sample, auto pdf) {
        row(what, oracle::detail::samples_for,
            [&](const Options& o, uint64_t) { return expect_density(random, sample, pdf, o); });
    };
    using V = textbook::Vec<double>;
    const V wo{0.8, 0, 0.6};
    auto visible = [&](double a) {
        return [=](double u, double v) { return textbook::ggx_visible_sample(wo, u, v, a); };
    };
    auto visible_pdf = [&](double a) {
        return [=](V w) { return textbook::ggx_visible_pdf(wo, w, a); };
    };
    density("expect_density, cosine hemisphere", cosine_direction, cosine_pdf);
    density("GGX by visible normals, alpha = 0.3", visible(0.3), visible_pdf(0.3));
    density("GGX by visible normals, alpha = 0.02", visible(0.02), visible_pdf(0.02));
    density(
        "GGX by half vectors, alpha = 0.3, of which 6 % fail",
        [=](double u, double v) { return textbook::ggx_half_sample(wo, u, v, 0.3); },
        [=](V w) { return textbook::ggx_half_pdf(wo, w, 0.3); });
    density("mixture of cosine and uniform hemisphere", mixed_direction, mixed_pdf(0.3));
    density("exponential, on the line", exponential, exponential_pdf);
    density("disc, in the plane", disc, disc_pdf);
    row("box of three dimensions", oracle::detail::samples_for, [&](const Options& o, uint64_t) {
        auto sample = [](double a, double b, double c) { return Triple{a, b, std::cbrt(c)}; };
        auto pdf = [](Triple x) { return 3 * x[2] * x[2]; };
        return expect_density(random, sample, pdf, Box<3>{{0, 0, 0}, {1, 1, 1}}, o);
    });
    row("expect_jacobian", fixed(300), [&](const Options& o, uint64_t) {
        return expect_jacobian(random, cosine_direction, cosine_pdf, o);
    });
    row("expect_samples", fixed(1e6), [&](const Options& o, uint64_t n) {
        const auto points = oracle::points_in(random, oracle::Sphere{}, n);
        std::vector<Direction> samples;
        std::vector<double> pdfs;
        for (uint64_t i = 0; i < n; ++i) samples.push_back(cosine_direction(random(), random()));
        for (const Triple& w : points) pdfs.push_back(cosine_pdf({w[0], w[1], w[2]}));
        return expect_samples(samples, points, pdfs, oracle::Sphere{}, o);
    });
    row("expect_choice, among 16", oracle::detail::samples_for, [&](const Options& o, uint64_t) {
        auto choose = [](double u) { return int(16 * u); };
        return expect_choice(
            random, choose, [](int) { return 1 / 16.0; }, 16, o);
    });
    row("expect_counts, 32 cells", oracle::detail::samples_for, [&](const Options& o, uint64_t n) {
        std::vector<double> counts(32);
        for (uint64_t i = 0; i < n; ++i) ++counts[size_t(32 * random())];
        return expect_counts(counts, std::vector<double>(32, 1 / 32.0), o);
    });
    // Numbers that spread as much as they are large.
    auto number = [&] { return exponential(random()); };
    auto uniform = [&] { return random(); };
    auto by_t = [](const Options& o) {
        return std::pow(smallest_shift(infinity, o.alpha) / o.sees, 2);
    };
    row("expect_mean", by_t,
        [&](const Options& o, uint64_t n) { return expect_mean(1, n, number, o); });
    row("expect_equal", by_t,
        [&](const Options& o, uint64_t n) { return expect_equal(number, number, n, o); });
    row("expect_replicates, of 1000 numbers", fixed(64), [&](const Options& o, uint64_t n) {
        auto replicate = [&](int) { return draw(1000, number).mean(); };
        return expect_replicates(1, int(n), replicate, o);
    });
    row("expect_bias_decay, of 8 and 16 numbers", fixed(1e5), [&](const Options& o, uint64_t n) {
        auto error = [&](uint64_t k) { return std::pow(draw(k, uniform).mean(), 2) - 0.25; };
        return expect_bias_decay(1 / 12.0, 8, n, error, o);
    });
    row("expect_bsdf, diffuse", fixed(4), [&](const Options& o, uint64_t) {
        auto sample = [](Direction, double u, double v) { return cosine_direction(u, v); };
        auto pdf = [](Direction, Direction wi) { return cosine_pdf(wi); };
        auto eval = [](Direction out, Direction wi) {
            return out.z > 0 && wi.z > 0 ? 0.5 / oracle::pi : 0;
        };
        return expect_bsdf(random, sample, pdf, eval, o);
    });
    row("expect_image, errors of 10 %", fixed(64 * 64), [&](const Options& o, uint64_t n) {
        std::vector<double> values;
        for (uint64_t i = 0; i < n; ++i)
            values.push_back(1 + 0.1 * std::sqrt(12 * 256.0) * (draw(256, uniform).mean() - 0.5));
        const std::vector<double> errors(n, 0.1), ones(n, 1);
        return expect_image(64, 64, values, errors, ones, o);
    });
}

TEST_CASE("textbook samplers in float are right") { check_textbooks<float>(); }
TEST_CASE("textbook samplers in double are right") { check_textbooks<double>(); }

TEST_CASE("means: an infinite variance is named in every run") {
    const Aside aside;
    Random random(seed_here());
    for (int i = 0; i < 200; ++i) {
        auto heavy = [&] { return 1 / std::sqrt(1 - random()); };  // mean 2
        const Verdict v = expect_mean(2, 100000, heavy);
        CHECK(!v.pass);
        says(v, "infinite");
    }
}

TEST_CASE("constants are exact: equal within rounding, or wrong") {
    const Aside aside;
    CHECK(expect_mean(0.3, 1000, [] { return 0.1 + 0.2; }).pass);
    CHECK(expect_mean(0.3, 1000, [] { return 0.3f; }).pass);
    CHECK(!expect_mean(0.3, 1000, [] { return 0.3 + 1e-13; }).pass);
    CHECK(!expect_mean(0.3, 1000, [] { return 0.3f + 3e-6f; }).pass);
    CHECK(!expect_mean(0, 1000, [] { return 1e-300; }).pass);
    CHECK(expect_mean(0, 1000, [] { return 0.0; }).pass);
    says(expect_mean(1, 1000, [] { return pi; }), "1/pi forgotten");
    says(expect_mean(1, 1000, [] { return 0.5; }), "ratio 0.5 (1/2, half)");
    CHECK(expect_equal([] { return 0.1 + 0.2; }, [] { return 0.3; }, 10).pass);
    CHECK(!expect_equal([] { return 0.2; }, [] { return 0.3; }, 10).pass);
    // Noise within rounding is no evidence: float's last bits, one of them always up.
    Random random(seed_here());
    CHECK(expect_mean(1, 1000, [&] { return random() < 0.5 ? 1.0f : 1.0f + 0x1p-23f; }).pass);
}

TEST_CASE("seeds depend on the name and on TEST_SEED alone") {
    CHECK(seed_of("a") != seed_of("b"));
    CHECK(seed_of("a") == seed_of("a"));
    CHECK(seed_here() == seed_of("seeds depend on the name and on TEST_SEED alone"));
    const char* const before = std::getenv("TEST_SEED");
    const std::string restore = before ? before : "";
    const uint64_t old = seed_of("a");
    setenv("TEST_SEED", "123456", 1);
    CHECK(seed_of("a") != old);
    // Seeds that follow each other are not places in one stream that follow each other.
    std::vector<uint64_t> bits;
    for (const char* seed : {"0", "1", "2", "3"}) {
        setenv("TEST_SEED", seed, 1);
        Random random(seed_of("a"));
        for (int k = 0; k < 10000; ++k) bits.push_back(random.bits());
    }
    std::sort(bits.begin(), bits.end());
    CHECK(std::adjacent_find(bits.begin(), bits.end()) == bits.end());
    before ? setenv("TEST_SEED", restore.c_str(), 1) : unsetenv("TEST_SEED");
    CHECK(seed_of("a") == old);
}

TEST_CASE("p-values: quantiles of the normal, Student's and the chi-squared distribution") {
    CHECK(p_of_z(1.959963984540054) == doctest::Approx(0.05).epsilon(1e-12));
    CHECK(p_of_z(4.891638475698590) == doctest::Approx(1e-6).epsilon(1e-9));
    // t with 1 degree is Cauchy, with 2 closed; 30: table (Abramowitz, Stegun 26.10).
    for (double t : {0.1, 1.0, 12.0, 1e4}) {
        CHECK(p_of_t(t, 1) ==
              doctest::Approx(1 - 2 * std::atan(t) / std::numbers::pi).epsilon(1e-8));
        CHECK(p_of_t(t, 2) == doctest::Approx(1 - t / std::sqrt(2 + t * t)).epsilon(1e-8));
    }
    CHECK(p_of_t(2.042, 30) == doctest::Approx(0.05).epsilon(1e-3));
    CHECK(p_of_t(5, 1e7) == doctest::Approx(p_of_z(5)).epsilon(1e-4));
    // chi2 with 2 degrees is exponential; with 1 the square of z; odd ones by the recurrence.
    for (double x : {0.01, 1.0, 5.0, 60.0}) {
        CHECK(p_of_chi2(x, 2) == doctest::Approx(std::exp(-x / 2)).epsilon(1e-12));
        CHECK(p_of_chi2(x, 1) == doctest::Approx(p_of_z(std::sqrt(x))).epsilon(1e-10));
        CHECK(p_of_chi2(x, 4) == doctest::Approx(std::exp(-x / 2) * (1 + x / 2)).epsilon(1e-12));
    }
    CHECK(p_of_chi2(124.342, 100) == doctest::Approx(0.05).epsilon(1e-4));
}

TEST_CASE("p of t is not that of z at hundreds of degrees of freedom: in closed form, far out") {
    // For even k, with theta = atan(t / sqrt k) and c_j = (1 3 ... 2j-1) / (2 4 ... 2j), what the
    // finite sum of Abramowitz, Stegun 26.7.4 leaves of 1:
    //   p = sin(theta) (c_j cos^2j(theta) summed over j >= k/2).
    auto closed = [](double t, int k) {
        const double cos2 = k / (k + t * t);
        double term = t / std::sqrt(k + t * t), sum = 0;
        for (int j = 1; j <= k / 2; ++j) term *= cos2 * (2 * j - 1) / (2 * j);
        for (int j = k / 2; term > 1e-12 * sum; ++j, term *= cos2 * (2 * j - 1) / (2 * j))
            sum += term;
        return sum;
    };
    CHECK(closed(3, 2) == doctest::Approx(1 - 3 / std::sqrt(11.0)).epsilon(1e-9));
    for (int k : {100, 200, 1000, 10000})
        for (double t : {5.0, 6.0, 7.0, 8.0}) {
            CAPTURE(k);
            CAPTURE(t);
            CHECK(p_of_t(t, k) == doctest::Approx(closed(t, k)).epsilon(1e-6).scale(0));
        }
}

TEST_CASE("checks of several threads are all counted, with their alpha") {
    const int before = oracle::statistical_checks;
    const double spent = oracle::alpha_spent;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([] {
            for (int i = 0; i < 20000; ++i)
                (void)oracle::detail::verdict_of(1, 0, {.alpha = 0x1p-20});
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(oracle::statistical_checks - before == 80000);
    CHECK(oracle::alpha_spent - spent == doctest::Approx(80000 * 0x1p-20));
    oracle::statistical_checks = before, oracle::alpha_spent = spent;
}
