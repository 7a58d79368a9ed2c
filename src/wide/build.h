// wide/build.h  3  from shapes to a binary tree of boxes
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "wide/node.h"

namespace penumbra::wide {

// ---- Boxes in float -----------------------------------------------------------------------------

// The numbers -lo.x -lo.y -lo.z . hi.x hi.y hi.z . of a box: one maximum unites two.
using Bounds = Floats;
inline Bounds no_bounds() { return all(-HUGE_VALF); }

// To a float, outwards by at least two ulp; origins of rays use up one of them.
inline Bounds outwards(const Box& exact) {
    const Floats box{float(-exact.lo.x), float(-exact.lo.y), float(-exact.lo.z), 0,
                     float(exact.hi.x),  float(exact.hi.y),  float(exact.hi.z),  0};
    const Floats further = box + (larger(box, -box) * 0x1p-22f + std::numeric_limits<float>::min());
    return larger(smaller(further, all(far_away)), all(-far_away));
}

// The same without the lanes left.
using Planes = std::array<float, 6>;
inline Planes planes(const Bounds& box) { return {box[0], box[1], box[2], box[4], box[5], box[6]}; }

inline double half_area(const Planes& of) {
    const double x = double(of[3]) + of[0], y = double(of[4]) + of[1], z = double(of[5]) + of[2];
    return x * y + y * z + z * x;
}

// An item of the BVH: a shape's bounds and, in the two other lanes, both halves of its index.
struct Item {
    std::array<float, lane_count> lanes;

    static Item of(const Shape& shape, uint32_t id) {
        Item item{std::bit_cast<std::array<float, lane_count>>(outwards(bounds(shape)))};
        item.lanes[3] = float(id & 0xffff), item.lanes[7] = float(id >> 16);
        return item;
    }
    Bounds box() const { return std::bit_cast<Bounds>(lanes); }
    uint32_t id() const { return uint32_t(lanes[3]) | uint32_t(lanes[7]) << 16; }
    // The centroid, twice.
    float place(size_t k) const { return lanes[4 + k] - lanes[k]; }
    Bounds places() const {
        const float x = place(0), y = place(1), z = place(2);
        return Bounds{-x, -y, -z, 0, x, y, z, 0};
    }
};

// A set of items: their bounds and those of their places.
struct Extent {
    Bounds box = no_bounds(), places = no_bounds();
    void add(const Item& item) {
        box = larger(box, item.box());
        places = larger(places, item.places());
    }
};

// ---- Planes that could split a node -------------------------------------------------------------

// The surface area heuristic, binned (Wald 2007, "On fast construction of SAH-based BVHs"): a ray
// that meets a node meets a child's box with a probability in proportion to its area, and then all
// its shapes.
inline constexpr size_t max_bins = 32;  // an axis

// Where bins lie: as many as pay for so many items.
struct Grid {
    size_t bins;
    float low[3], scale[3];  // 0: too short an axis

    Grid(const Bounds& places, size_t items) : bins(std::min(max_bins, 4 + items / 16)) {
        for (size_t k = 0; k < 3; ++k) {
            const float extent = places[4 + k] + places[k];
            low[k] = -places[k];
            scale[k] = extent > 0x1p-100f ? below_one_float * float(bins) / extent : 0;
        }
    }
    size_t bin(const Item& item, size_t k) const {
        return size_t(int((item.place(k) - low[k]) * scale[k]));
    }
    static constexpr float below_one_float = 0.99999f;  // the last place falls into the last bin
};

struct Bins {
    Bounds box[3][max_bins];
    uint32_t items[3][max_bins];

    Bins(std::span<const Item> all_items, const Grid& grid) {
        for (size_t k = 0; k < 3; ++k) {
            std::fill_n(box[k], grid.bins, no_bounds());
            std::fill_n(items[k], grid.bins, 0);
        }
        for (const Item& item : all_items)
            for (size_t k = 0; k < 3; ++k) {
                const size_t bin = grid.bin(item, k);
                box[k][bin] = larger(box[k][bin], item.box());
                ++items[k][bin];
            }
    }
};

// Items in bins below `bin` go left.  Axis 3 means that no plane has items on both sides.
struct Plane {
    double cost = HUGE_VAL;
    size_t axis = 3, bin = 0;
};

// Takes the plane between bins of an axis with the least sum of both sides' costs, if it is better.
inline void sweep(const Bins& bins, size_t k, size_t count, Plane& best) {
    double above[max_bins];  // the cost of this bin and up
    Bounds box = no_bounds();
    uint32_t n = 0;
    for (size_t bin = count - 1; bin > 0; --bin) {
        box = larger(box, bins.box[k][bin]);
        n += bins.items[k][bin];
        above[bin] = n > 0 ? half_area(planes(box)) * n : HUGE_VAL;
    }
    box = no_bounds();
    n = 0;
    for (size_t bin = 1; bin < count; ++bin) {
        box = larger(box, bins.box[k][bin - 1]);
        n += bins.items[k][bin - 1];
        if (n == 0) continue;
        const double cost = half_area(planes(box)) * n + above[bin];
        if (cost < best.cost) best = {cost, k, bin};
    }
}

inline Plane best_plane(std::span<const Item> items, const Grid& grid) {
    const Bins bins(items, grid);
    Plane best;
    for (size_t k = 0; k < 3; ++k)
        if (grid.scale[k] > 0) sweep(bins, k, grid.bins, best);
    return best;
}

// ---- The tree -----------------------------------------------------------------------------------

// A branch spans count shapes from first on.  An inner branch has two consecutive children, a leaf
// none (0: the root, at 0, is not a child).
struct Branch {
    Planes box;
    uint32_t first, count, left = 0;
    bool leaf() const { return left == 0; }
};

struct BinaryTree {
    std::vector<Branch> branches;
    std::vector<uint32_t> ids;  // ids of the shapes, in the order of the leaves
    bool mixed;                 // the root has triangles and other shapes

    static constexpr uint32_t leaf_size = 4;      // shapes a leaf holds at most
    static constexpr int sah_depth = 32;          // below, split at the median: 32 levels more
    static constexpr int depth = sah_depth + 32;  // at most
};

class Builder {
public:
    explicit Builder(const std::vector<Shape>& shapes)
        : from_(std::make_unique_for_overwrite<Item[]>(shapes.size())),
          to_(std::make_unique_for_overwrite<Item[]>(shapes.size())) {
        // Triangles first.
        Extent extent[2];
        uint32_t n[2] = {};
        for (bool others : {false, true})
            for (uint32_t i = 0; i < shapes.size(); ++i) {
                if (shapes[i].is_triangle() == others) continue;
                const Item item = Item::of(shapes[i], i);
                extent[others].add(item);
                from_[n[0] + n[1]] = item;
                ++n[others];
            }
        tree_.ids.resize(shapes.size());
        tree_.branches.reserve(2 * shapes.size());
        tree_.mixed = n[0] > 0 && n[1] > 0;
        add(larger(extent[0].box, extent[1].box), 0, n[0] + n[1]);
        if (tree_.mixed) {
            add_children(0, extent, n[0]);
            for (uint32_t i : {0, 1}) grow(1 + i, extent[i].places, 1, false);
        } else {
            grow(0, extent[n[0] == 0].places, 0, false);
        }
    }
    BinaryTree tree() && { return std::move(tree_); }

private:
    BinaryTree tree_;
    std::unique_ptr<Item[]> from_, to_;  // dividing a branch moves its items from one to the other

    void add(const Bounds& box, uint32_t first, uint32_t count) {
        tree_.branches.push_back({planes(box), first, count});
    }
    void add_children(uint32_t branch, const Extent* halves, uint32_t left) {
        Branch& parent = tree_.branches[branch];
        parent.left = uint32_t(tree_.branches.size());
        const uint32_t first = parent.first, right = parent.count - left;
        add(halves[0].box, first, left);
        add(halves[1].box, first + left, right);
    }

    // Adds all below a branch.  After an odd number of moves its items are in the other array.
    void grow(uint32_t index, const Bounds& places, int depth, bool moved) {
        const Branch& branch = tree_.branches[index];
        const uint32_t first = branch.first, count = branch.count;
        const std::span<Item> items(&(moved ? to_ : from_)[first], count);
        const Grid grid(places, count);
        const Plane plane =
            depth < BinaryTree::sah_depth && count > 1 ? best_plane(items, grid) : Plane{};
        // A leaf costs a ray about as much as a node and one of its shapes.
        const double area = half_area(branch.box);
        if (count <= BinaryTree::leaf_size && !(plane.cost < area * (count - 1))) {
            for (uint32_t i = 0; i < count; ++i) tree_.ids[first + i] = items[i].id();
            return;
        }
        Extent halves[2];
        uint32_t left;
        if (plane.axis < 3) {
            left = divide(items, &(moved ? from_ : to_)[first], grid, plane, halves);
            moved = !moved;
        } else {
            left = halve(items, places, halves);
        }
        add_children(index, halves, left);
        const uint32_t child = tree_.branches[index].left;
        grow(child, halves[0].places, depth + 1, moved);
        grow(child + 1, halves[1].places, depth + 1, moved);
    }

    // Moves the items, those on the left of the plane to the front; returns how many.
    static uint32_t divide(std::span<const Item> items, Item* to, const Grid& grid,
                           const Plane& plane, Extent* halves) {
        uint32_t left = 0, right = uint32_t(items.size());
        for (const Item& item : items) {
            const bool goes_right = grid.bin(item, plane.axis) >= plane.bin;
            right -= goes_right;
            to[goes_right ? right : left] = item;
            left += !goes_right;
            halves[goes_right].add(item);
        }
        return left;
    }

    // For places all alike, or a tree too deep.
    static uint32_t halve(std::span<Item> items, const Bounds& places, Extent* halves) {
        auto extent = [&](size_t k) { return places[4 + k] + places[k]; };
        const size_t longer = extent(0) > extent(1) ? 0 : 1;
        const size_t k = extent(longer) > extent(2) ? longer : 2;
        const size_t half = items.size() / 2;
        std::nth_element(items.begin(), items.begin() + ptrdiff_t(half), items.end(),
                         [&](const Item& a, const Item& b) { return a.place(k) < b.place(k); });
        for (size_t i = 0; i < items.size(); ++i) halves[i >= half].add(items[i]);
        return uint32_t(half);
    }
};

// For at least one shape.  Time O(n log n).
inline BinaryTree build(const std::vector<Shape>& shapes) { return Builder(shapes).tree(); }

}  // namespace penumbra::wide
