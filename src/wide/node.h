// wide/node.h  2  eight boxes, intersected with a ray at once
#pragma once
#include <array>

#include "wide/lanes.h"
#include "world/shapes.h"

namespace penumbra::wide {

// Planes beyond count as infinitely far; areas of what is nearer are finite numbers in double.
inline constexpr float far_away = 0x1p120f;

// A ray as boxes see it: in float, so that it meets a box too much rather than one too few.  It
// meets a plane n at (n - o) / d.  Near planes have a smaller 1/d than far ones, and so room for
// errors that are relative to t, in units of 2^-24: a difference and a product take 2 (the
// difference of two floats has the right sign), and rounding the t of a hit 1.  What t itself may
// be off by if the ray comes from afar, 16 ulp, counts in float.  That o is rounded moves planes by
// up to 2^-24 |o| <= 2^-24 |n| + 2^-24 |t d|: boxes have room for the first.
struct Probe {
    Floats o[3], near_inverse[3], far_inverse[3];
    size_t near[3], far[3];  // where in a node these planes are

    explicit Probe(const Ray& ray) {
        constexpr real room = real(0x1p-21) + 32 * ulp;
        const Floats most = all(std::numeric_limits<float>::max());
        const real x = 1 / ray.d.x, y = 1 / ray.d.y, z = 1 / ray.d.z;
        const real less = 1 - room, more = 1 + room;
        const Floats inside{float(x * less), float(y * less), float(z * less)};
        const Floats outer{float(x * more), float(y * more), float(z * more)};
        // 1/d beyond float: the near plane is met at least there, the far one is not.
        const Floats inner = larger(smaller(inside, most), -most);
        for (size_t k = 0; k < 3; ++k) {
            o[k] = all(float(ray.o.*axis[k]));
            near_inverse[k] = all(inner[k]);
            far_inverse[k] = all(outer[k]);
            const bool down = std::signbit(ray.d.*axis[k]);
            near[k] = lane_count * (down ? k + 3 : k);
            far[k] = lane_count * (down ? k : k + 3);
        }
    }
};

// A child in 32 bits.  The last five hold the number of a leaf's triangles, or 16 plus that of its
// other shapes; the bits above them hold the index of the first.  The last five bits of a node are
// 0: the number is its offset in bytes.
struct Child {
    uint32_t bits = 16;  // a leaf of no shapes

    static constexpr size_t max_shapes = size_t(1) << 27;
    static Child leaf(uint32_t first, uint32_t count, bool others) {
        return {first << 5 | (others ? 16 : 0) | count};
    }
    bool is_leaf() const { return bits & 31; }
    uint32_t first() const { return bits >> 5; }
    uint32_t count() const { return bits & 15; }
    bool others() const { return bits & 16; }
};

// Where a ray enters and leaves eight boxes.
struct Crossing {
    Floats enter, leave;

    Lanes met() const { return Lanes(enter <= leave); }

    // Nonnegative floats have the order of their bits as integers.  The child replaces the last
    // three bits: one number holds the distance and the child.
    static constexpr int32_t none = INT32_MAX;
    Keys keys() const {
        const Keys keys = (std::bit_cast<Keys>(enter) & ~7) | Keys{0, 1, 2, 3, 4, 5, 6, 7};
        return keys | (~(enter <= leave) & none);
    }
    // The last key of a box that may hold a hit at t <= end.
    static int32_t last_key(float end) { return std::bit_cast<int32_t>(end) | 7; }
};

// The key that follows the last.
inline int32_t next(const Keys& keys, int32_t last) {
    return least(keys | (~(keys > last) & Crossing::none));
}

// Planes are float, rounded outwards: the answers come from the shapes.  An absent child has the
// empty box, which only a ray from infinitely far meets, and holds nothing.
struct Node {
    alignas(sizeof(Floats)) float plane[6 * lane_count];  // lower x, y, z, upper x, y, z
    Child child[lane_count];

    // Without children.
    Node() {
        std::fill_n(plane, 3 * lane_count, HUGE_VALF);
        std::fill_n(plane + 3 * lane_count, 3 * lane_count, -HUGE_VALF);
    }

    // The box of child i, as -lo and hi.
    void set(size_t i, const std::array<float, 6>& box) {
        for (size_t k = 0; k < 6; ++k) {
            const float x = box[k] >= far_away ? HUGE_VALF : box[k];
            plane[lane_count * k + i] = k < 3 ? -x : x;
        }
    }

    // Slabs, up to end.  A ray within a slab's plane and parallel to it makes 0 * inf = NaN, with
    // which a comparison fails and takes the second number: the interval is never too short, and
    // where the ray enters is never NaN, nor -0.
    Crossing meet(const Probe& ray, float end) const {
        Floats near[3], far[3];
        for (size_t k = 0; k < 3; ++k) {
            near[k] = (planes(ray.near[k]) - ray.o[k]) * ray.near_inverse[k];
            far[k] = (planes(ray.far[k]) - ray.o[k]) * ray.far_inverse[k];
        }
        return {larger(larger(near[0], near[1]), larger(near[2], Floats{})),
                smaller(smaller(far[0], far[1]), smaller(far[2], all(end)))};
    }

private:
    Floats planes(size_t at) const {
        Floats result;
        std::memcpy(&result, plane + at, sizeof result);
        return result;
    }
};
static_assert(sizeof(Node) % 32 == 0);

}  // namespace penumbra::wide
