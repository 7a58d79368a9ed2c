// course/shuffle.h  in which order subjects stand before a test: nothing follows from their places
#pragma once
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "oracle/oracle.h"

namespace penumbra::course {

// The indices below `count`, in an order that follows from the key.
inline std::vector<size_t> shuffled(double key, size_t count) {
    oracle::Random random(uint64_t(key) * 0x9e3779b97f4a7c15u + 6);
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), size_t(0));
    for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[size_t(random() * double(i))]);
    return order;
}

}  // namespace penumbra::course
