// oracle/oracle_test.cpp  tests of the tests: false alarms as often as stated, planted errors seen
#include "oracle/oracle.h"

#include <doctest/doctest.h>

#include <limits>

#include "oracle/expect.h"

namespace {

using std::numbers::pi;

struct Direction {
    double x, y, z;
};

Direction direction(double z, double phi) {
    const double s = std::sqrt(std::max(0.0, 1 - z * z));
    return {s * std::cos(phi), s * std::sin(phi), z};
}
Direction cosine_direction(double u, double v) { return direction(std::sqrt(1 - u), 2 * pi * v); }
double cosine_pdf(Direction w) { return std::max(0.0, w.z) / pi; }
double uniform_pdf(Direction w) { return w.z > 0 ? 1 / (2 * pi) : 0; }

// Runs of one check that do not count among those of the suite.
template <class Check>
std::vector<Verdict> runs(int n, Check check) {
    const int before = statistical_checks;
    std::vector<Verdict> verdicts;
    for (int i = 0; i < n; ++i) verdicts.push_back(check());
    statistical_checks = before;
    return verdicts;
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
    CHECK(2 * std::exp(-2 * n * d * d) > alpha);
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
void check_seen(const std::vector<Verdict>& verdicts) {
    size_t seen = 0;
    for (const Verdict& v : verdicts) seen += !v.pass;
    INFO(verdicts.front().text);
    CHECK(double(seen) >= 0.99 * double(verdicts.size()));
}

bool says(const Verdict& v, const char* what) {
    INFO(v.text);
    const bool found = v.text.find(what) != std::string::npos;
    CHECK(found);
    return found;
}

}  // namespace

TEST_CASE("means: p-values are uniform, and a bias of the stated size is seen") {
    Random random(seed_here());
    // Skewed numbers, at the smallest n that the check accepts: exponential, skewness 2.
    auto exponential = [&] { return -std::log1p(-random()); };
    check_uniform(runs(2000, [&] { return expect_mean(1, 10000, exponential); }));
    const double bias = expect_mean(1, 10000, exponential).delta_min;
    check_seen(runs(1000, [&] { return expect_mean(1 + bias, 10000, exponential); }));
    check_seen(runs(1000, [&] { return expect_mean(1 - bias, 10000, exponential); }));
    // And the size is no larger than it must be: a third of it is seen in under half of the runs.
    size_t seen = 0;
    for (const Verdict& v :
         runs(1000, [&] { return expect_mean(1 + bias / 2, 10000, exponential); }))
        seen += !v.pass;
    CHECK(seen < 500);
}

TEST_CASE("two means: p-values are uniform, and a difference of the stated size is seen") {
    Random random(seed_here());
    auto narrow = [&] { return 1 + 0.1 * random(); };
    auto wide = [&] { return 0.55 + random(); };
    check_uniform(runs(2000, [&] { return expect_equal(narrow, wide, 1000); }));
    const double bias = expect_equal(narrow, wide, 1000).delta_min * 1.05;
    check_seen(
        runs(1000, [&] { return expect_equal([&] { return narrow() + bias; }, wide, 1000); }));
}

TEST_CASE("replicates: p-values are uniform with 16, and a bias of the stated size is seen") {
    Random random(seed_here());
    // A randomly shifted grid of 8 points for the integral of 3 x^2.
    auto replicate = [&](double bias) {
        return [&random, bias](int) {
            const double shift = random();
            double sum = 0;
            for (int i = 0; i < 8; ++i) {
                const double x = (i + shift) / 8;
                sum += 3 * x * x / 8;
            }
            return sum + bias;
        };
    };
    check_uniform(runs(2000, [&] { return expect_replicates(1, 16, replicate(0)); }));
    // The stated size varies with the estimated deviation: here it is the true one.
    const double deviation =
        std::sqrt(draw(100000, [&] { return replicate(0)(0); }).moments.variance());
    const double bias = smallest_shift(15) * deviation / 4;
    check_seen(runs(1000, [&] { return expect_replicates(1, 16, replicate(bias)); }));
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
    auto check = [&](double constant, double lasting) {
        return expect_bias_decay(constant, 8, 1000, [&](uint64_t n) { return error(n) + lasting; });
    };
    check_uniform(runs(1000, [&] { return check(1 / 12.0, 0); }));
    const double size = check(1 / 12.0, 0).delta_min * 1.05;
    check_seen(runs(1000, [&] { return check((1 + size) / 12, 0); }));
    check_seen(runs(1000, [&] { return check(1 / 12.0, 0.01); }));
}

TEST_CASE("counts: p-values are uniform, and a distortion of the stated size is seen") {
    Random random(seed_here());
    std::vector<double> p(32, 1 / 32.0);
    auto counts = [&](double distortion) {
        std::vector<uint64_t> n(32);
        for (int i = 0; i < 6400; ++i) {
            const size_t cell =
                size_t(random() * 16);  // pairs, in which a cell gains what one loses
            ++n[2 * cell + (random() < 0.5 * (1 + distortion))];
        }
        return n;
    };
    check_uniform(runs(2000, [&] { return expect_counts(counts(0), p); }));
    const double size = expect_counts(counts(0), p).delta_min;
    // Of the distorted probabilities q: sum (p - q)^2 / q = d^2 / (1 - d^2).
    const double d = size / std::sqrt(1 + size * size);
    check_seen(runs(1000, [&] { return expect_counts(counts(d), p); }));
}

TEST_CASE("densities: p-values are uniform, and a distortion of the stated size is seen") {
    Random random(seed_here());
    DensityOptions o;
    o.n = 6400;
    o.smooth = false;
    o.tolerance = 1e-4;
    auto slope = [&](double a) {
        return [&random, a](double u, double v) {
            // phi with density (1 + a cos(2 phi)) / 2 pi, by rejection.
            double phi = 2 * pi * v;
            while (2 * random() > 1 + a * std::cos(2 * phi)) phi = 2 * pi * random();
            return direction(1 - u, phi);
        };
    };
    const auto verdicts =
        runs(1000, [&] { return expect_density(random, slope(0), uniform_pdf, o); });
    check_uniform(verdicts);
    // Cells are quadrants but for the noise of their borders; in terms of cos(2 phi) each would be
    // half up, half down: turned by 45 degrees, sin(2 phi) has 2 / pi a more in every other one.
    auto turned = [&](double a) {
        return [&random, a](double u, double v) {
            double phi = 2 * pi * v;
            while (2 * random() > 1 + a * std::sin(2 * phi)) phi = 2 * pi * random();
            return direction(1 - u, phi);
        };
    };
    const double a = verdicts[0].delta_min * pi / 2;
    // The borders are quantiles of distorted samples, which then hide part: 1.1 covers it.
    check_seen(runs(300, [&] { return expect_density(random, turned(1.1 * a), uniform_pdf, o); }));
}

TEST_CASE("identities see an error of 10^-5 without noise") {
    Random random(seed_here());
    CHECK(expect_density(random, cosine_direction, cosine_pdf).pass);
    auto off = [](Direction w) { return (1 + 1e-5) * cosine_pdf(w); };
    says(expect_jacobian(random, cosine_direction, off), "pdf |dx/du x dx/dv| = 1.00001");
    DensityOptions o;
    o.smooth = false;
    says(expect_density(random, cosine_direction, off, o),
         "integral of pdf over the sphere is 1.00001");
}

TEST_CASE("classic mistakes of hemisphere samplers are seen and named") {
    Random random(seed_here());
    DensityOptions rough;
    rough.smooth = false;
    auto flat = [](double u, double v) { return direction(1 - u, 2 * pi * v); };
    auto no_root = [](double u, double v) { return direction(std::sqrt(1 - u * u), 2 * pi * v); };
    auto half = [](double u, double v) { return direction(std::sqrt(1 - u), pi * v); };
    for (const auto& wrong : {+flat, +no_root, +half}) {
        CHECK(!expect_density(random, wrong, cosine_pdf).pass);
        says(expect_density(random, wrong, cosine_pdf, rough), "chi2");
    }
    says(expect_density(random, half, cosine_pdf), "1/2");
    auto per_angle = [](Direction w) { return cosine_pdf(w) * std::hypot(w.x, w.y); };
    says(expect_density(random, cosine_direction, per_angle, rough), "ratio 0.6667, is it 2/3");
    auto below = [](double u, double v) { return direction(u < 0.001 ? -0.5 : 1 - u, 2 * pi * v); };
    says(expect_density(random, below, uniform_pdf, rough), "the density is 0 at the sample");
    // A lobe as narrow as 10^-4 that the density misses or has is seen.
    auto lobe = [](double u, double v) { return direction(std::pow(1 - u, 1e-8), 2 * pi * v); };
    auto lobe_pdf = [](Direction w) {
        return w.z > 0 ? 1e8 / (2 * pi) * std::pow(w.z, 1e8 - 1) : 0;
    };
    rough.tolerance = 1e-5;  // pow(cos, 10^8) keeps no more digits of the cosine's
    CHECK(!expect_density(random, lobe, uniform_pdf, rough).pass);
    CHECK(!expect_density(random, flat, lobe_pdf, rough).pass);
}

TEST_CASE("what cannot be judged fails, and says why") {
    Random random(seed_here());
    auto heavy = [&] { return 1 / std::sqrt(1 - random()); };  // mean 2, variance infinite
    int named = 0;
    for (const Verdict& v : runs(200, [&] { return expect_mean(2, 100000, heavy); })) {
        CHECK(!v.pass);
        named += v.text.find("infinite") != std::string::npos;
    }
    CHECK(named == 200);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    int i = 0;
    says(expect_mean(0.5, 1000, [&] { return ++i == 42 ? nan : random(); }),
         "sample 41 is nan, not finite");
    i = 0;
    says(expect_equal([&] { return random(); }, [&] { return ++i == 7 ? 1 / 0.0 * 1 : random(); },
                      1000),
         "second: sample 6 is inf");
    says(expect_mean(1, 0, [&] { return random(); }), "no sample at all");
    says(expect_mean(1, 1, [&] { return random(); }), "is constant");
    says(expect_mean(0.5, Estimate{0.5, nan}), "not finite");
    says(expect_replicates(0.5, 15, [&](int) { return random(); }), "take 16");
    says(expect_replicates(0.5, 0, [&](int) { return random(); }), "no sample at all");
    says(expect_mean(0.01, 10000, [&] { return random() < 0.01 ? 1.0 : 0.0; }),
         "too small for a skewness");
    CHECK(expect_mean(0.01, 200000, [&] { return random() < 0.01 ? 1.0 : 0.0; }).pass);
    const uint64_t few[] = {3, 4, 5}, none[] = {0, 0};
    const double third[] = {1 / 3.0, 1 / 3.0, 1 / 3.0};
    says(expect_counts(few, third), "take 300");
    says(expect_counts(none, third), "no sample at all");
    says(expect_density(random,
                        [&](double u, double v) {
                            return u < 1e-3 ? Direction{nan, 0, 0} : cosine_direction(u, v);
                        },
                        cosine_pdf, {64000, {0, 0, 1}, false, 0}),
         "at the sample (nan, 0, 0)");
}

TEST_CASE("constants are exact: equal within rounding, or wrong") {
    CHECK(expect_mean(0.3, 1000, [] { return 0.1 + 0.2; }).pass);
    CHECK(expect_mean(0.3, 1000, [] { return 0.3f; }).pass);
    CHECK(!expect_mean(0.3, 1000, [] { return 0.3 + 1e-13; }).pass);
    CHECK(!expect_mean(0.3, 1000, [] { return 0.3f + 3e-6f; }).pass);
    CHECK(!expect_mean(0, 1000, [] { return 1e-300; }).pass);
    CHECK(expect_mean(0, 1000, [] { return 0.0; }).pass);
    says(expect_mean(1, 1000, [] { return pi; }), "1/pi forgotten");
    says(expect_mean(1, 1000, [] { return 0.5; }), "probability of a choice among two");
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
