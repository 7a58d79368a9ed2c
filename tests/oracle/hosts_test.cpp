// oracle/hosts_test.cpp  the oracle in hosts that have its names, and vectors of every kind
//
// What a host may do before the oracle is included: say whose names it uses, and have the same.
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#pragma GCC diagnostic error "-Wconversion"
#pragma GCC diagnostic error "-Wshadow"

using namespace std;
namespace host {
struct Vec {
    float x, y, z;
};
struct Random {};
struct Estimate {};
struct Point {
    double x, y;
};
}  // namespace host
using namespace host;
float alpha = 0.5f, n = 1, pi = 3.14159265f;
float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
void print(const char*) {}

#include <doctest/doctest.h>

#define ORACLE_CHECKS
#include "oracle/expect.h"

namespace {

const oracle::Options quick{.sees = 0.05};

template <class T>
array<T, 3> cosine(T u, T v) {
    const T r = sqrt(u), phi = T(2 * oracle::pi) * v;
    return {r * cos(phi), r * sin(phi), sqrt(1 - u)};
}
double cosine_pdf(double z) { return max(0.0, z) / oracle::pi; }

// x(), y(), z(), and a constructor.
class Functions {
    float a, b, c;

public:
    Functions(float x_, float y_, float z_) : a(x_), b(y_), c(z_) {}
    float x() const { return a; }
    float y() const { return b; }
    float z() const { return c; }
};
// Four floats with [] alone, as wide registers have.
struct Wide {
    float values[4];
    float operator[](size_t i) const { return values[i]; }
    float& operator[](size_t i) { return values[i]; }
};

struct Capitals {
    float X, Y, Z;
};
class Getters {
    float a, b, c;

public:
    Getters(float x, float y, float z) : a(x), b(y), c(z) {}
    float getX() const { return a; }
    float getY() const { return b; }
    float getZ() const { return c; }
};
// Functions of an index alone, and two floats with [].
class Called {
    float values[3] = {};

public:
    float operator()(int i) const { return values[i]; }
    float& operator()(int i) { return values[i]; }
};
struct Two {
    float values[2];
    float operator[](size_t i) const { return values[i]; }
};

template <class Sample, class Pdf>
void check(Sample sample, Pdf pdf) {
    oracle::Random random(seed_here());
    EXPECT(oracle::expect_density(random, sample, pdf, quick), 0.06);
    auto off = [&](auto w) { return 1.15 * double(pdf(w)); };
    const oracle::Aside aside;
    CHECK(!oracle::expect_density(random, sample, off, quick).pass);
}

// The same in floats, as a vector of another kind.
template <class V>
V made(const array<float, 3>& w) {
    if constexpr (is_same_v<V, Wide>)
        return {{w[0], w[1], w[2], 0}};
    else if constexpr (is_same_v<V, Called>) {
        V v;
        for (int i = 0; i < 3; ++i) v(i) = w[size_t(i)];
        return v;
    } else
        return {w[0], w[1], w[2]};
}
template <class V, class Z>
void check_vectors(Z z) {
    check([](float u, float v) { return made<V>(cosine(u, v)); },
          [z](const V& w) { return float(cosine_pdf(double(z(w)))); });
}

}  // namespace

TEST_CASE("directions by members, by functions, by brackets, as arrays") {
    check_vectors<Vec>([](auto& w) { return w.z; });
    check_vectors<Functions>([](auto& w) { return w.z(); });
    check_vectors<Wide>([](auto& w) { return w[2]; });
    check_vectors<Capitals>([](auto& w) { return w.Z; });
    check_vectors<Getters>([](auto& w) { return w.getZ(); });
    check_vectors<Called>([](auto& w) { return w(2); });
    check([](double u, double v) { return polar(sqrt(u), 2 * oracle::pi * v); },
          [](complex<double> z) { return norm(z) < 1 ? 1 / oracle::pi : 0; });
    check(
        [](float u, float v) {
            return Two{{sqrt(u), v}};
        },
        [](Two x) { return x[0] > 0 && x[0] < 1 && x[1] >= 0 && x[1] < 1 ? 2 * x[0] : 0; });
    check([](double u, double v) { return cosine(u, v); },
          [](const array<double, 3>& w) { return cosine_pdf(w[2]); });
}

TEST_CASE("samples from two numbers, a pair, an array, a point; from one number and from three") {
    auto pdf = [](array<double, 3> w) { return cosine_pdf(w[2]); };
    check([](pair<double, double> u) { return cosine(u.first, u.second); }, pdf);
    check([](const array<double, 2>& u) { return cosine(u[0], u[1]); }, pdf);
    check([](host::Point u) { return cosine(u.x, u.y); }, pdf);
    check([](pair<float, float> u) { return cosine(u.first, u.second); },
          [](array<float, 3> w) { return float(cosine_pdf(double(w[2]))); });
    check([](double u) { return sqrt(u); }, [](double x) { return x > 0 && x < 1 ? 2 * x : 0; });
    auto either = [](double choice, double u, double v) {
        return choice < 0.25 ? cosine(u, v)
                             : array{cosine(u, v)[0], cosine(u, v)[1], -cosine(u, v)[2]};
    };
    check(either,
          [](array<double, 3> w) { return 0.25 * cosine_pdf(w[2]) + 0.75 * cosine_pdf(-w[2]); });
}

TEST_CASE("samples that fail, as an optional, a null pointer, or with a density of 0") {
    auto above = [](array<double, 3> w) { return w[2] > 0 ? 1 / (4 * oracle::pi) : 0; };
    auto uniform = [](double u, double v) {
        const double z = 1 - 2 * u, r = sqrt(1 - z * z);
        return array{r * cos(2 * oracle::pi * v), r * sin(2 * oracle::pi * v), z};
    };
    array<double, 3> kept{};
    auto pointer = [&](double u, double v) {
        kept = uniform(u, v);
        return kept[2] > 0 ? &kept : nullptr;
    };
    auto maybe = [&](double u, double v) {
        const auto* w = pointer(u, v);
        return w ? optional(*w) : nullopt;
    };
    check(maybe, above);
    check(uniform, above);
    check(pointer, above);
}

// What sample returns beside the direction.
struct Lobe {
    Vec wi;
    float pdf, roughness;
};

TEST_CASE("a density that comes with the sample is that of pdf, too") {
    oracle::Random random(seed_here());
    auto pdf = [](Vec w) { return float(cosine_pdf(double(w.z))); };
    auto draw = [](float u, float v) { return made<Vec>(cosine(u, v)); };
    auto times = [&](float c) {
        return [=](float u, float v) {
            const Vec w = draw(u, v);
            return u < 0.25f ? Lobe{w, c * pdf(w), 0.5f} : Lobe{w, pdf(w), 0.5f};
        };
    };
    auto maybe = [=](float u, float v) { return optional(times(1)(u, v)); };
    auto pairs = [=](float u, float v) { return pair(draw(u, v), pdf(draw(u, v))); };
    auto without_pi = [=](float u, float v) { return pair(draw(u, v), draw(u, v).z); };
    auto uniform = [=](float u, float v) { return pair(draw(u, v), 1 / (2 * pi)); };
    auto unknown = [=](float u, float v) { return Lobe{draw(u, v), float(NAN), 0.5f}; };
    EXPECT(oracle::expect_density(random, times(1), pdf, quick), 0.06);
    EXPECT(oracle::expect_density(random, maybe, pdf, quick), 0.06);
    EXPECT(oracle::expect_density(random, pairs, pdf, quick), 0.06);
    const oracle::Aside aside;
    oracle::says(oracle::expect_density(random, times(2), pdf, quick),
                 "the pdf that sample returns is 2 (2, twice) times what pdf says, in 2");
    oracle::says(oracle::expect_density(random, without_pi, pdf, quick),
                 "is 3.142 (pi) times what pdf says, in every sample");
    oracle::says(oracle::expect_density(random, uniform, pdf, quick),
                 "is 0.5 (1/2, half) cos(theta)^-1 times what pdf says");
    oracle::says(oracle::expect_density(random, unknown, pdf, quick), "sample returns is nan");
}

TEST_CASE("a sampler that draws by itself") {
    oracle::Random own(oracle::seed_of("own"));
    check([&] { return cosine(own(), own()); },
          [](array<double, 3> w) { return cosine_pdf(w[2]); });
}

TEST_CASE("a mirror in a mixture, of which .discrete says how often it is") {
    oracle::Random random(seed_here());
    auto mixed = [](double choice, double u, double v) {
        return choice < 0.3 ? array{0.6, 0.0, 0.8} : cosine(u, v);
    };
    auto pdf_of = [](double part) {
        return [=](array<double, 3> w) { return part * cosine_pdf(w[2]); };
    };
    auto with = [](double part) { return oracle::Options{.sees = 0.05, .discrete = part}; };
    EXPECT(oracle::expect_density(random, mixed, pdf_of(0.7), with(0.3)), 0.06);
    const oracle::Aside aside;
    oracle::says(oracle::expect_density(random, mixed, pdf_of(0.7), quick), "looks like a mirror");
    oracle::says(oracle::expect_density(random, mixed, pdf_of(1), with(0.3)),
                 "the pdf integrates to 1, expected 0.7");
    oracle::says(oracle::expect_density(random, mixed, pdf_of(0.65), with(0.35)),
                 "of the samples are mirrors', 35 % were announced");
}

TEST_CASE("0 and the number next to 1 are always tried") {
    const oracle::Aside aside;
    oracle::Random random(seed_here());
    for (double edge : {0.0, 1 - 0x1p-53})
        for (size_t k : {size_t(0), size_t(1)}) {
            auto broken_there = [=](const array<double, 2>& u) {
                auto w = cosine(u[0], u[1]);
                if (u[k] == edge) w[1] = NAN;
                return w;
            };
            oracle::says(oracle::expect_density(
                             random, broken_there,
                             [](array<double, 3> w) { return cosine_pdf(w[2]); }, quick),
                         "is not finite, u = ");
        }
    // A pdf may be infinite at one end.
    EXPECT(oracle::expect_density(
               random, [](double u) { return u * u; },
               [](double x) { return x >= 0 && x <= 1 ? 0.5 / sqrt(x) : 0; },
               oracle::Interval{0, 1}, quick),
           0.06);
}

TEST_CASE("choices from two numbers") {
    oracle::Random random(seed_here());
    // An alias table of 1/8, 3/8, 1/2.
    auto alias = [](double u, double v) {
        const int i = int(3 * u);
        return v < array{0.375, 1.0, 1.0}[size_t(i)] ? i : 1;
    };
    auto shares = [](int i) { return array{0.125, 0.375 + 1 / 6.0, 1 / 3.0}[size_t(i)]; };
    auto table = [&](int i) { return i == 1 ? 1 - shares(0) - shares(2) : shares(i); };
    EXPECT(oracle::expect_choice(random, alias, table, 3), 0.01);
    const oracle::Aside aside;
    auto halved = [&](double u, double v) { return alias(u, v / 2); };
    CHECK(!oracle::expect_choice(random, halved, table, 3).pass);
}

TEST_CASE("arrays of samples, and of the pdf at points") {
    oracle::Random random(seed_here());
    vector<Vec> samples;
    for (int i = 0; i < 40000; ++i)
        samples.push_back(made<Vec>(cosine(float(random.single()), float(random.single()))));
    const oracle::Sphere sphere;
    const auto points = oracle::points_in(random, sphere, 100000);
    auto judged = [&](double part, double side, double tried) {
        vector<float> pdfs;
        for (const auto& w : points)
            pdfs.push_back(float(part * cosine_pdf(w[2]) * (1 + (w[0] > 0 ? side : -side))));
        return oracle::expect_samples(samples, points, pdfs, sphere,
                                      {.n = uint64_t(tried * 40000)});
    };
    EXPECT(judged(1, 0, 1), 0.09);
    EXPECT(judged(0.5, 0, 2), 0.09);
    const oracle::Aside aside;
    oracle::says(judged(1, 0.1, 1), "times as dense as the pdf says, around direction");
    oracle::says(judged(1.1, 0, 1), "the pdf is 1.1 times the density of the samples");
    oracle::says(judged(1, 0, 2), "50 % of which fail");
    samples.resize(10000);
    oracle::says(judged(1, 0, 1), "take 20000 or more");
}

TEST_CASE("BSDFs that transmit, from three numbers") {
    oracle::Random random(seed_here());
    const oracle::Options o{.sees = 0.05};
    // Radiance is twice what it was above: eta^2 = 2.  0.6 go through from above, 0.3 from below.
    auto sample = [](Vec wo, float choice, float u, float v) {
        Vec w = made<Vec>(cosine(u, v));
        if ((wo.z < 0) != (choice < 0.4f)) w.z = -w.z;
        return w;
    };
    auto pdf = [](Vec wo, Vec wi) {
        return (wo.z * wi.z < 0 ? 0.4f : 0.6f) * float(cosine_pdf(double(abs(wi.z))));
    };
    auto eval = [](Vec wo, Vec wi) {
        return (wo.z * wi.z < 0 ? (wo.z > 0 ? 0.3f : 0.6f) : wo.z > 0 ? 0.35f : 0.65f) / ::pi;
    };
    EXPECT(oracle::expect_bsdf(random, sample, pdf, eval, o), 0.06);
    oracle::says(oracle::expect_bsdf(random, sample, pdf, eval, o), "scaled by 0.5");
    const oracle::Aside aside;
    auto bright = [=](Vec wo, Vec wi) { return eval(wo, wi) * (wo.z * wi.z > 0 ? 2.f : 1); };
    auto lopsided = [=](Vec wo, Vec wi) {
        return eval(wo, wi) * (wo.z * wi.z < 0 ? 0.5f + 0.5f * abs(wo.z) : 1);
    };
    auto grazing = [=](Vec wo, Vec wi) {
        return pdf(wo, wi) * (wo.z > 0 && wo.z < 0.1f ? 1.1f : 1);
    };
    oracle::says(oracle::expect_bsdf(random, sample, pdf, bright, o), "more leaves than comes");
    oracle::says(oracle::expect_bsdf(random, sample, pdf, lopsided, o),
                 "not reciprocal through the surface");
    oracle::says(oracle::expect_bsdf(random, sample, grazing, eval, o), "1.1");
}

TEST_CASE("BSDFs that are computed in float, of directions in double") {
    oracle::Random random(seed_here());
    using D = array<double, 3>;
    auto sample = [](D, double u, double v) { return cosine(u, v); };
    auto pdf = [](D, D wi) { return cosine_pdf(wi[2]); };
    auto eval = [](D wo, D wi) {  // reciprocal but for the rounding of a difference
        const float a = float(wo[2]), b = float(wi[2]);
        return a > 0 && b > 0 ? 0.3f + 100 * ((1 + a * 1e-3f) - (1 + b * 1e-3f) - (a - b) * 1e-3f)
                              : 0;
    };
    EXPECT(oracle::expect_bsdf(random, sample, pdf, eval, {.sees = 0.05}), 0.06);
}

TEST_CASE("the host's own names are as they were") {
    CHECK(dot(Vec{1, 2, 3}, Vec{1, 1, 1}) == 6);
    CHECK(alpha + n > pi - 2);
    print("");
    static_assert(!is_same_v<host::Random, oracle::Random> &&
                  !is_same_v<Estimate, oracle::Estimate>);
}
