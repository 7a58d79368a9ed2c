// whole/extremes.h  the gain from precision: configurations with bounds on their errors
//
// The extremes_*_test.cpp assert their rows in the precision of the build. `make extremes` runs
// them in both precisions and writes reference/extremes.md.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "world/geometry.h"

inline constexpr big big_pi = 3.141592653589793238462643383279502884L;
inline constexpr bool is_double = sizeof(real) == 8;
inline constexpr double d_ulp = 0x1p-53, f_ulp = 0x1p-24;  // of double and float: 1.1e-16, 6e-8
inline constexpr double any = HUGE_VAL;

struct Bounds {
    double in_double, in_float;
};
constexpr Bounds ulps(double n) { return {n * d_ulp, n * f_ulp}; }
constexpr Bounds within(double in_double, double in_float) { return {in_double, in_float}; }
inline constexpr Bounds to_the_bit = {0, 0};

// The error of a configuration with these numbers.
template <class F, class... Numbers>
std::function<double()> of(F error, Numbers... numbers) {
    return [=] { return error(numbers...); };
}

// `error` runs the configuration with this build's `real`.  A bound of `any` in float means that
// float cannot represent the configuration.
struct Row {
    const char* name;
    Bounds bounds;
    std::function<double()> error;
    bool in_suite = true;  // too long otherwise: only by `make extremes`
};

// EXTREMES=FILE appends every row, also the long ones, to that file: name, both bounds, error.
inline void check_rows(const std::vector<Row>& rows) {
    const char* path = std::getenv("EXTREMES");
    std::FILE* out = path ? std::fopen(path, "a") : nullptr;
    REQUIRE((!path || out));
    for (const Row& row : rows) {
        if (!row.in_suite && !out) continue;
        const double error = row.error();
        INFO(std::string(row.name));
        CHECK(!std::isnan(error));
        CHECK(error <= (is_double ? row.bounds.in_double : row.bounds.in_float));
        if (out)
            std::fprintf(out, "%s\t%.2g\t%.2g\t%.2g\n", row.name, row.bounds.in_double,
                         row.bounds.in_float, error);
    }
    if (out) std::fclose(out);
}

inline double relative(big value, big truth) {
    return double(std::abs(value - truth) / std::abs(truth));
}

// Visits the midpoints of n x n cells of the unit square.
template <class F>
void each_cell(int n, F f) {
    for (int i = 0; i < n * n; ++i)
        f(vec2{(real(i % n) + real(0.5)) / real(n), (real(i / n) + real(0.5)) / real(n)});
}

// The worst error that `f` finds in these cells, or in n trials.
template <class F>
double worst_of_cells(int n, F f) {
    Worst worst;
    each_cell(n, [&](vec2 u) { f(worst, u); });
    return double(worst.value);
}
template <class F>
double worst_of(const char* name, int n, F f) {
    Dice random{{oracle::seed_of(name)}};
    Worst worst;
    for (int i = 0; i < n; ++i) {
        if constexpr (std::is_invocable_v<F, Dice&, Worst&, int>)
            f(random, worst, i);
        else
            f(random, worst);
    }
    return double(worst.value);
}

// How often n trials go wrong, each as often as `f` tells.
template <class F>
double count_of(const char* name, int n, F f) {
    Dice random{{oracle::seed_of(name)}};
    int wrong = 0;
    for (int i = 0; i < n; ++i) wrong += f(random, i);
    return wrong;
}
