// world/bvh.h  4  intersection of rays with the scene: a plain binary BVH
#pragma once
#include <array>
#include <span>
#include <vector>

#include "world/shapes.h"

namespace penumbra {

// A ray as boxes see it; inverse is 1 / d, component by component.
struct Probe {
    Ray ray;
    vec3 inverse;
    explicit Probe(const Ray& seen) : ray(seen), inverse{1 / ray.d.x, 1 / ray.d.y, 1 / ray.d.z} {}
};

// Distance at which the ray enters a box, 0 if it starts inside; nothing if it misses the box up to
// tmax.  The boxes of the BVH are wider than their contents by more than rounding, so that rays
// within a face do not matter.
inline std::optional<real> enter_box(const Box& box, const Probe& probe) {
    // exercise 1.4
    real enter = 0, leave = probe.ray.tmax;
    for (auto k : axis) {
        const real lo = (box.lo.*k - probe.ray.o.*k) * probe.inverse.*k;
        const real hi = (box.hi.*k - probe.ray.o.*k) * probe.inverse.*k;
        enter = std::max(enter, std::min(lo, hi));
        leave = std::min(leave, std::max(lo, hi));
    }
    return enter <= leave ? std::optional(enter) : std::nullopt;
    // end
}

// A leaf holds count shapes from first on; an inner node (count = 0) has the children first and
// first + 1.  The root is node 0.
struct TreeNode {
    Box box;
    uint32_t first = 0, count = 0;
    bool is_leaf() const { return count > 0; }
};

inline constexpr int tree_depth = 64;  // an upper bound; at most depth + 1 nodes wait at once

// The nearest of `best` and all hits in the leaves.  enter(box) is the distance at which the ray
// enters it, or nothing.  look(leaf, best) is the nearest of best and the leaf's own hits.
template <class Enter, class Look>
inline Hit nearest_hit(std::span<const TreeNode> nodes, Hit best, Enter enter, Look look) {
    // exercise 1.5
    struct Waiting {
        uint32_t node;
        real enter;
    };
    std::array<Waiting, tree_depth + 2> stack;
    size_t waiting = 0;
    if (const auto t = enter(nodes[0].box)) stack[waiting++] = {0, *t};
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        if (next.enter > best.t) continue;
        const TreeNode& node = nodes[next.node];
        if (node.is_leaf()) {
            best = look(node, best);
            continue;
        }
        const uint32_t left = node.first, right = left + 1;
        const auto l = enter(nodes[left].box), r = enter(nodes[right].box);
        const bool right_first = l && r && *r < *l;
        if (l && right_first) stack[waiting++] = {left, *l};
        if (r) stack[waiting++] = {right, *r};
        if (l && !right_first) stack[waiting++] = {left, *l};
    }
    return best;
    // end
}

// A row of boxes is split before number `left`.  The cost is the expected number of shapes that a
// ray through all of them tests, times half the area of their bounding box.
struct Split {
    real cost = infinity;
    size_t left = 0;
};

// The cheapest split of two or more boxes that leaves some on both sides (the surface area
// heuristic; Goldsmith, Salmon 1987, IEEE CG&A 7(5)).  Time O(n).
inline Split best_split(std::span<const Box> boxes) {
    // exercise 1.6
    std::vector<real> right(boxes.size());  // half the area about the boxes from i on
    Box box;
    for (size_t i = boxes.size(); i-- > 0;) {
        box.add(boxes[i]);
        right[i] = box.half_area();
    }
    box = {};
    Split best;
    for (size_t i = 1; i < boxes.size(); ++i) {
        box.add(boxes[i - 1]);
        const real cost = box.half_area() * real(i) + right[i] * real(boxes.size() - i);
        if (cost < best.cost) best = {cost, i};
    }
    return best;
    // end
}

// Its answers equal those of a loop over all shapes, bit for bit; of shapes hit at the same
// distance the one with the smallest index wins.
class Bvh {
public:
    Bvh() = default;

    // Shape i keeps the index i in every answer.
    explicit Bvh(const std::vector<Shape>& shapes) {
        if (shapes.empty()) return;
        std::vector<Item> items;
        for (uint32_t i = 0; i < shapes.size(); ++i) items.push_back({bounds(shapes[i]), i});
        nodes_.emplace_back();
        grow(0, items, 0);
        for (uint32_t id : ids_) shapes_.push_back(shapes[id]);
    }

    // Work of closest(ray): nodes with boxes tested, and shapes tested.
    struct Work {
        int nodes = 0, shapes = 0;
    };
    Work work(const Ray& ray) const {
        Work work;
        closest(ray, &work);
        return work;
    }

    std::optional<Hit> closest(const Ray& ray, Work* work = nullptr) const {
        if (nodes_.empty()) return {};
        const Probe probe(ray);
        const Shear k = shear(ray.d);
        const real padding = rounding(ray);
        auto enter = [&](const Box& box) {
            if (work) ++work->nodes;
            return enter_box(padded(box, padding), probe);
        };
        auto look = [&](const TreeNode& leaf, Hit best) {
            if (work) work->shapes += int(leaf.count);
            for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
                const auto hit = intersect(shapes_[i], ray, k, best.t);
                if (!hit || (hit->t == best.t && ids_[i] > best.id)) continue;
                best = *hit;
                best.id = ids_[i];
            }
            return best;
        };
        const Hit hit = nearest_hit(nodes_, Hit{ray.tmax}, enter, look);
        return hit.id == UINT32_MAX ? std::nullopt : std::optional(hit);
    }

    // True if anything is hit.  The order does not matter: the first hit ends the search.
    bool occluded(const Ray& ray) const {
        if (nodes_.empty()) return false;
        const Probe probe(ray);
        const Shear k = shear(ray.d);
        const real padding = rounding(ray);
        std::array<uint32_t, tree_depth + 2> stack{0};
        for (size_t waiting = 1; waiting > 0;) {
            const TreeNode& node = nodes_[stack[--waiting]];
            if (!enter_box(padded(node.box, padding), probe)) continue;
            for (uint32_t i = node.first; i < node.first + node.count; ++i)
                if (intersect(shapes_[i], ray, k, ray.tmax)) return true;
            if (node.is_leaf()) continue;
            stack[waiting++] = node.first;
            stack[waiting++] = node.first + 1;
        }
        return false;
    }

private:
    std::vector<TreeNode> nodes_;
    std::vector<Shape> shapes_;  // in the order of the leaves
    std::vector<uint32_t> ids_;  // their indices

    // Error of a hit and of a box's plane for a ray from far away.
    static real rounding(const Ray& ray) { return 32 * ulp * max_abs(ray.o); }
    static Box padded(const Box& b, real e) { return {b.lo - vec3{e, e, e}, b.hi + vec3{e, e, e}}; }

    // ---- Construction ---------------------------------------------------------------------------

    struct Item {
        Box box;
        uint32_t id;
        real centre(real vec3::*k) const { return box.lo.*k + box.hi.*k; }  // twice
    };
    static constexpr size_t leaf_size = 4;  // shapes at most
    static constexpr int halved_from = 32;  // from this level on the tree is balanced

    // Makes a node of these items, and all below it.
    void grow(size_t index, std::span<Item> items, int depth) {
        Box box;
        for (const Item& item : items) box.add(item.box);
        const Split cut = split(items, depth);
        // A leaf costs a ray about as much as a node and one of its shapes.
        if (items.size() <= leaf_size && !(cut.cost < box.half_area() * real(items.size() - 1))) {
            nodes_[index] = {box, uint32_t(ids_.size()), uint32_t(items.size())};
            for (const Item& item : items) ids_.push_back(item.id);
            return;
        }
        const size_t left = nodes_.size();
        nodes_[index] = {box, uint32_t(left)};
        nodes_.resize(left + 2);
        grow(left, items.first(cut.left), depth + 1);
        grow(left + 1, items.subspan(cut.left), depth + 1);
    }

    // Sorts the items along the axis of the cheapest split.
    static Split split(std::span<Item> items, int depth) {
        Split best{infinity, items.size() / 2};
        if (items.size() < 2 || depth >= halved_from) return best;
        auto best_axis = axis[0];
        auto sort = [&](real vec3::*k) {
            std::ranges::sort(items, {}, [k](const Item& item) { return item.centre(k); });
        };
        for (auto k : axis) {
            sort(k);
            if (items.front().centre(k) == items.back().centre(k)) continue;
            std::vector<Box> boxes;
            for (const Item& item : items) boxes.push_back(item.box);
            const Split cut = best_split(boxes);
            if (cut.left == 0 || cut.left >= items.size() || !(cut.cost < best.cost)) continue;
            best = cut;
            best_axis = k;
        }
        sort(best_axis);
        return best;
    }
};

}  // namespace penumbra
