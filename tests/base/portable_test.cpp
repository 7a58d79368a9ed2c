// base/portable_test.cpp  exponentials and logarithms against long double, and bit for bit
#include "base/portable.h"

#include "base/rng.h"
#include "base/vec.h"
#include "oracle/expect.h"

namespace {
using namespace penumbra;

// The largest relative error of f over [low, high], in 2^-53; infinite where f is not a number.
double worst_error(double low, double high, double (*f)(double),
                   long double (*truth)(long double)) {
    Rng rng{seed_here()};
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const double x = low + (high - low) * double(to_unit(rng.bits())), y = f(x);
        const long double t = truth(x);
        const double error = y == t ? 0 : double(std::abs((y - t) / t)) * 0x1p53;
        worst = error <= worst ? worst : error < 1e300 ? error : HUGE_VAL;
    }
    return worst;
}

}  // namespace

TEST_CASE("log, log1p, exp and expm1 within 3 of 2^-53, where they cancel, too") {
    if (std::numeric_limits<long double>::digits < 64) return;  // no reference of higher precision
    for (double most : {1., 1e-3, 1e-300, 1e300})
        CHECK(worst_error(0, most, portable::log, std::log) < 3);
    CHECK(worst_error(0.999, 1.001, portable::log, std::log) < 3);
    for (double least : {-1., -1e-3, -1e-9, -1e-15, -1e-300})
        CHECK(worst_error(least, 0, portable::log1p, std::log1p) < 3);
    for (double least : {-708., -30., -1., 1.})
        CHECK(worst_error(least, 0, portable::exp, std::exp) < 3);
    for (double least : {-708., -30., -1., -0.3, -1e-3, -1e-15, -1e-300, 1.})
        CHECK(worst_error(least, 0, portable::expm1, std::expm1) < 3);
}

TEST_CASE("powers and exponentials where they are exact, and beyond what double holds") {
    CHECK(portable::log(1) == 0);
    CHECK(portable::exp(0) == 1);
    CHECK(portable::expm1(0) == 0);
    CHECK(portable::exp(-1e300) == portable::exp(-708));
    CHECK(portable::exp(-1000) > 0);
    CHECK(portable::exp(-1000) < 1e-307);
    CHECK(portable::expm1(-1e300) == -1);
    for (double n : {0., 1., 20., 1e6}) CHECK(portable::pow(1, n) == 1);
    for (double x : {1e-300, 0.1, 0.7}) CHECK(portable::pow(x, 0) == 1);
    CHECK(portable::pow(0.5, 10) == doctest::Approx(0x1p-10).epsilon(1e-15));
    CHECK(portable::pow(0.999, 1e5) == doctest::Approx(3.538527688343128e-44).epsilon(1e-13));
}

TEST_CASE("their bits are those of every machine") {
    Rng rng{1};
    uint64_t hash = 0;
    auto add = [&](double y) {
        hash = (hash ^ std::bit_cast<uint64_t>(y)) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 32;
    };
    for (int i = 0; i < 1000; ++i) {
        const double x = rng.uniform();
        add(portable::log(x)), add(portable::log1p(-x)), add(portable::exp(-20 * x)),
            add(portable::expm1(-x));
    }
    CHECK(hash == 0x0779bb5960e8487a);
}
