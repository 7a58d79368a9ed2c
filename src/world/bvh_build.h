// world/bvh_build.h  2  from shapes to a binary tree of boxes
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "world/shapes.h"

namespace bvh {

// What the tree divides: a shape's bounds and its index.
struct Item {
    Box box;
    uint32_t id;
    vec3 centroid() const { return (box.lo + box.hi) * real(0.5); }
};

// A node spans count items from first on; a leaf has no children (the root, at 0, is nobody's
// child).
struct Branch {
    Box box;
    uint32_t first, count;
    uint32_t left = 0, right = 0;
    bool leaf() const { return left == 0; }
};

struct BinaryTree {
    std::vector<Branch> branches;
    std::vector<Item> items;  // in the order of the leaves

    static constexpr int leaf_size = 4;           // shapes a leaf holds at most
    static constexpr int sah_depth = 32;          // below, split at the median: 32 levels more
    static constexpr int depth = sah_depth + 32;  // at most
};

// ---- Planes that could split a node -------------------------------------------------------------

// The surface area heuristic, binned (Wald 2007, "On fast construction of SAH-based BVHs"): a ray
// that meets a node meets a child's box with a probability in proportion to its area, and then all
// its shapes.
struct Bin {
    Box box;
    uint32_t count = 0;
    void add(const Bin& b) {
        box.add(b.box);
        count += b.count;
    }
    real cost() const { return box.half_area() * real(count); }
};
inline constexpr size_t bin_count = 16;  // an axis
using Bins = std::array<Bin, bin_count>;

// Items in bins below `bin` go left.  No axis: no plane has items on both sides.
struct Plane {
    real cost = infinity;
    int axis = -1;
    size_t bin = 0;
};

inline size_t bin_of(const Item& item, const Box& centroids, int a) {
    const real lo = centroids.lo.*axis[a], extent = centroids.hi.*axis[a] - lo;
    const real x = (item.centroid().*axis[a] - lo) / extent;
    return std::min(size_t(x * bin_count), bin_count - 1);
}

inline Bins fill_bins(std::span<const Item> items, const Box& centroids, int a) {
    Bins bins;
    for (const Item& item : items) bins[bin_of(item, centroids, a)].add({item.box, 1});
    return bins;
}

// The sum of both sides' costs at each plane between bins; the least wins.
inline Plane sweep(const Bins& bins, int a) {
    Bins above;  // bins k and up
    Bin sum;
    for (size_t k = bin_count - 1; k > 0; --k) {
        sum.add(bins[k]);
        above[k] = sum;
    }
    Plane best;
    sum = {};
    for (size_t k = 1; k < bin_count; ++k) {
        sum.add(bins[k - 1]);
        const real cost = sum.cost() + above[k].cost();
        if (sum.count > 0 && above[k].count > 0 && cost < best.cost) best = {cost, a, k};
    }
    return best;
}

// ---- The tree -----------------------------------------------------------------------------------

// Orders the items of a node so that its first n go left, and returns n; 0: keep it a leaf.
inline uint32_t split(std::span<Item> items, const Box& box, int depth) {
    Box centroids;
    for (const Item& item : items) centroids.add(item.centroid());
    const vec3 extent = centroids.hi - centroids.lo;
    Plane best;
    for (int a = 0; a < 3; ++a) {
        if (!(extent.*axis[a] > 0)) continue;
        const Plane plane = sweep(fill_bins(items, centroids, a), a);
        if (plane.cost < best.cost) best = plane;
    }
    // Visiting a node costs about as much as a shape, so a split must save one.
    const bool may_be_leaf = items.size() <= BinaryTree::leaf_size;
    if (may_be_leaf && !(best.cost < box.half_area() * real(items.size() - 1))) return 0;
    if (best.axis >= 0 && depth < BinaryTree::sah_depth) {
        auto goes_left = [&](const Item& i) { return bin_of(i, centroids, best.axis) < best.bin; };
        return uint32_t(std::partition(items.begin(), items.end(), goes_left) - items.begin());
    }
    // All centroids alike, or the tree too deep: halves.
    const int a =
        extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    const size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(half), items.end(),
                     [&](const Item& i, const Item& j) {
                         return i.centroid().*axis[a] < j.centroid().*axis[a];
                     });
    return uint32_t(half);
}

// Adds the node of these items and all below it; returns its index.
inline uint32_t grow(BinaryTree& tree, uint32_t first, uint32_t count, int depth) {
    const std::span<Item> items(&tree.items[first], count);
    Branch branch{{}, first, count};
    for (const Item& item : items) branch.box.add(item.box);
    const uint32_t index = uint32_t(tree.branches.size());
    tree.branches.push_back(branch);
    const uint32_t left = split(items, branch.box, depth);
    if (left == 0) return index;
    uint32_t child = grow(tree, first, left, depth + 1);
    tree.branches[index].left = child;
    child = grow(tree, first + left, count - left, depth + 1);
    tree.branches[index].right = child;
    return index;
}

// Of at least one shape.  Time O(n log n).
inline BinaryTree build(const std::vector<Shape>& shapes) {
    BinaryTree tree;
    for (const Shape& s : shapes) tree.items.push_back({bounds(s), uint32_t(tree.items.size())});
    grow(tree, 0, uint32_t(shapes.size()), 0);
    return tree;
}

}  // namespace bvh
