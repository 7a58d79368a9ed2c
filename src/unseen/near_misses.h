// unseen/near_misses.h  1  sums over paths that met a light, or nearly did, and what it brought
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace penumbra {

// A sum of numbers >= 0, in multiples of 2^-60: it does not depend on their order.
__extension__ typedef unsigned __int128 FixedPoint;
inline FixedPoint fixed_point(double value) { return FixedPoint(std::min(value, 0x1p40) * 0x1p60); }
inline double value_of(FixedPoint sum) { return std::ldexp(double(sum), -60); }

inline constexpr size_t growths = 11;  // a light has s^2 times its area, for s = 1, 2, 4 ... 1024

// Classes of radiance and of area: three octaves each, in turns.
inline constexpr size_t classes = 8;
inline size_t class_of(double x) {
    return size_t(std::ilogb(std::min(x, 1e300)) + 3 * 1024) / 3 % classes;
}

// What lights bring to the picture by paths that aim, before a render: sums over pixels of the mean
// channel and of its square, and the variance of the first.  What of it came during the render.
struct Brought {
    double sum = 0, squares = 0, variance = 0;
    uint64_t came = 0, hits = 0;  // in 2^-40 of the sum; paths that brought it

    // It never overflows.
    void add(uint64_t more, uint64_t of_hits) {
        came = std::min(came + more, uint64_t(1) << 62), hits += of_hits;
    }
    void add_came(const Brought& other) { add(other.came, other.hits); }
};

// What a film knows of a group of lights: how the camera sees them, and near misses (src/unseen).
struct NearMisses {
    uint32_t line = 0;  // of the first light, from 1 on; 0 if unknown
    uint32_t K = 1;     // samples of a pixel of that area, over n
    double L2 = 0;      // greatest square of radiance (intensity of points), mean of the channels
    double area = 0;    // visible area in pixels
    double a = 0;       // sum over pixels of a (1 - a), for the covered part a of a pixel

    // From the light, to pixels that see no mirror or glass, by the area of the shape that it
    // lights first; from the eye, by the radiance that a path brings.  For a sum of all would hide
    // what is rare and bright.
    std::array<Brought, classes> from_light{}, from_eye{};
    // Sums of the squares of what these hits added to their pixels, in 2^-20 L2.
    std::array<FixedPoint, classes> squares{};
    // Sums of c and c^2 at each growth.
    std::array<std::array<FixedPoint, 2>, growths> sum{};

    // Adds sums of more samples.
    void add(const NearMisses& other) {
        for (size_t k = 0; k < classes; ++k) {
            from_light[k].add_came(other.from_light[k]), from_eye[k].add_came(other.from_eye[k]);
            squares[k] += other.squares[k];
        }
        for (size_t k = 0; k < 2 * growths; ++k) sum[k / 2][k % 2] += other.sum[k / 2][k % 2];
    }
    // When weights are chosen: sums of the pilot do not have the pixel's share, and go; what came
    // stays, rather too much.
    void end_pilot() { sum = {}, squares = {}; }
};
static_assert(sizeof(NearMisses) ==
                  32 + 2 * classes * sizeof(Brought) + (classes + 2 * growths) * sizeof(FixedPoint),
              "a file holds no gaps");

}  // namespace penumbra
