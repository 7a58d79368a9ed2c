// oracle/hosts_test.cpp  the oracle in hosts that have its names, and vectors of every kind
//
// What a host may do before the oracle is included: say whose names it uses, and have the same.
#include <array>
#include <cmath>
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
    else
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

TEST_CASE("the host's own names are as they were") {
    CHECK(dot(Vec{1, 2, 3}, Vec{1, 1, 1}) == 6);
    CHECK(alpha + n > pi - 2);
    print("");
    static_assert(!is_same_v<host::Random, oracle::Random> &&
                  !is_same_v<Estimate, oracle::Estimate>);
}
