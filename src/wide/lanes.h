// wide/lanes.h  1  eight numbers at once
#pragma once
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/vec.h"

namespace penumbra {

// GCC warns that such types are passed otherwise where registers are narrower.  No library of ours
// is affected: there is none.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace wide {

// GCC and Clang compute with such types lane by lane, in whatever registers the processor has, and
// round every lane as the same line rounds one number.
inline constexpr size_t lane_count = 8;
typedef float Floats __attribute__((vector_size(lane_count * sizeof(float))));
typedef int32_t Keys __attribute__((vector_size(lane_count * sizeof(int32_t))));

// As many reals as a register of AVX2 holds (SSE2, NEON: two registers), with AVX-512, too: tuned
// for Intel's processors GCC splits the fma of wider vectors into halves, and passes these through
// memory.
inline constexpr size_t real_lanes = 32 / sizeof(real);
typedef real Reals __attribute__((vector_size(real_lanes * sizeof(real))));

inline Floats all(float number) { return Floats{} + number; }

template <class Vector>
Vector smaller(const Vector& a, const Vector& b) {
    return a < b ? a : b;
}
template <class Vector>
Vector larger(const Vector& a, const Vector& b) {
    return a > b ? a : b;
}

// The lanes where a comparison holds: a byte for each, 1 or 0.
class Lanes {
public:
    Lanes() = default;
    template <class Comparison>
    explicit Lanes(const Comparison& holds) {
        typedef int8_t Bytes __attribute__((vector_size(sizeof holds)));
        constexpr size_t size = sizeof(holds[0]), n = sizeof(holds) / size;
        bytes_ = first_bytes<size>(std::bit_cast<Bytes>(holds), std::make_index_sequence<n>());
    }
    bool any() const { return bytes_ != 0; }
    size_t first() const { return size_t(std::countr_zero(bytes_)) / 8; }
    void drop_first() { bytes_ &= bytes_ - 1; }
    // Those below n, which is 1 to 8, stay.
    void keep(size_t n) { bytes_ &= ones >> (8 * (lane_count - n)); }

private:
    static constexpr uint64_t ones = 0x0101010101010101;
    uint64_t bytes_;

    // Of each lane of so many bytes, which are all alike.  (GCC 12 converts lanes one by one.)
    template <size_t size, class Bytes, size_t... lane>
    static uint64_t first_bytes(const Bytes& bytes, std::index_sequence<lane...>) {
        using Word = std::conditional_t<sizeof...(lane) == 8, uint64_t, uint32_t>;
        return std::bit_cast<Word>(__builtin_shufflevector(bytes, bytes, (lane * size)...)) & ones;
    }
};

inline Reals load(const real* from) {
    Reals result;
    std::memcpy(&result, from, sizeof result);
    return result;
}

inline Reals fused(const Reals& a, const Reals& b, const Reals& c) {
    Reals result;
    for (size_t i = 0; i < real_lanes; ++i) result[i] = std::fma(a[i], b[i], c[i]);
    return result;
}

// As of single numbers.
inline Reals difference_of_products(const Reals& a, const Reals& b, const Reals& c,
                                    const Reals& d) {
    const Reals cd = c * d;
    return fused(a, b, -cd) + fused(-c, d, cd);
}

// The least of eight: halves, quarters, and the last two.
inline int32_t least(const Keys& keys) {
    typedef int32_t Half __attribute__((vector_size(sizeof(Keys) / 2)));
    const Half four = smaller<Half>(__builtin_shufflevector(keys, keys, 0, 1, 2, 3),
                                    __builtin_shufflevector(keys, keys, 4, 5, 6, 7));
    const Half two = smaller<Half>(four, __builtin_shufflevector(four, four, 2, 3, 0, 1));
    return smaller<Half>(two, __builtin_shufflevector(two, two, 1, 0, 3, 2))[0];
}

}  // namespace wide

}  // namespace penumbra
