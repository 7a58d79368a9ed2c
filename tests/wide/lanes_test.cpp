// wide/lanes_test.cpp  every lane of eight numbers equals the scalar result
#include "wide/lanes.h"

#include "world/geometry.h"

namespace {

using namespace wide;

real awkward(Dice& random) {
    const real kinds[] = {0,
                          -real(0),
                          infinity,
                          -infinity,
                          std::numeric_limits<real>::quiet_NaN(),
                          std::numeric_limits<real>::denorm_min()};
    return random.below(8) == 0 ? kinds[random.below(6)] : random.sign() * random.decades(-3, 3);
}

Reals awkward_lanes(Dice& random) {
    Reals x;
    for (size_t i = 0; i < real_lanes; ++i) x[i] = awkward(random);
    return x;
}

bool same(real a, real b) { return std::isnan(a) ? std::isnan(b) : a == b; }

}  // namespace

TEST_CASE("lanes compute as single numbers do, NaN and infinities included") {
    Dice random{{1}};
    int different = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const Reals a = awkward_lanes(random), b = awkward_lanes(random), c = awkward_lanes(random),
                    d = awkward_lanes(random);
        const Reals products = difference_of_products(a, b, c, d), sum = fused(a, b, c);
        const Reals low = smaller(a, b), high = larger(a, b);
        for (size_t i = 0; i < real_lanes; ++i) {
            different += !same(products[i], ::difference_of_products(real(a[i]), real(b[i]),
                                                                     real(c[i]), real(d[i])));
            different += !same(sum[i], std::fma(real(a[i]), real(b[i]), real(c[i])));
            different += !same(low[i], a[i] < b[i] ? a[i] : b[i]);
            different += !same(high[i], a[i] > b[i] ? a[i] : b[i]);
        }
    }
    CHECK(different == 0);
}

TEST_CASE("the lanes of a comparison come one by one, and those beyond a number can be dropped") {
    Dice random{{2}};
    int wrong = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const Reals a = awkward_lanes(random), b = awkward_lanes(random);
        const size_t kept = 1 + random.below(real_lanes);
        Lanes less(a < b);
        less.keep(kept);
        for (size_t i = 0; i < kept; ++i) {
            if (!(a[i] < b[i])) continue;
            wrong += !less.any() || less.first() != i;
            less.drop_first();
        }
        wrong += less.any();
    }
    CHECK(wrong == 0);
}

TEST_CASE("the least of eight keys is found in every lane") {
    Dice random{{3}};
    int wrong = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        Keys k;
        int32_t expected = INT32_MAX;
        for (size_t i = 0; i < lane_count; ++i) {
            k[i] = int32_t(random.below(trial % 2 ? 20 : 2000000000)) - 10;
            expected = std::min(expected, int32_t(k[i]));
        }
        wrong += least(k) != expected;
    }
    CHECK(wrong == 0);
}
