// wide/collapse.h  4  which branches of a binary tree become the children of wide nodes
#pragma once
#include "wide/build.h"

namespace penumbra::wide {

// Of a node.
struct Children {
    std::array<uint32_t, lane_count> branch;
    size_t count = 0;
    void add(uint32_t index) { branch[count++] = index; }
};

// The wide BVH of least surface-area cost that a binary one contains (Ylitie, Karras, Laine 2017,
// "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", section 4.1): the cost
// of a branch with up to n children of a node is the minimum over the number of them on the left.
// Time and memory O(n).
class Collapse {
public:
    Collapse(const BinaryTree& tree, size_t largest_leaf)
        : tree_(tree), largest_leaf_(largest_leaf), cost_(tree.branches.size()) {
        const double whole = area(0);
        // Children follow their parents.
        for (uint32_t i = uint32_t(cost_.size()); i-- > 0;)
            cost_[i] = costs(i, whole > 0 ? float(area(i) / whole) : 0);
    }

    bool is_leaf(uint32_t i) const { return cost_[i].leaf; }

    // Those of the node that a branch becomes: 1 if it is itself a leaf, otherwise 2 to 8.  The
    // largest come first: they are the likeliest to stop a ray that asks for any hit.
    Children children(uint32_t i) const {
        Children list;
        if (is_leaf(i)) {
            list.add(i);
            return list;
        }
        const uint32_t left = tree_.branches[i].left;
        const size_t in_left = share(left, lane_count);
        collect(left, in_left, list);
        collect(left + 1, lane_count - in_left, list);
        const auto first = list.branch.begin(), end = first + ptrdiff_t(list.count);
        std::sort(first, end, [&](uint32_t a, uint32_t b) {
            return area(a) != area(b) ? area(a) > area(b) : a < b;
        });
        return list;
    }

private:
    // As up to n + 1 children: costs in units of a visit to the root's node.
    struct Costs {
        std::array<float, lane_count - 1> as;
        bool leaf;
    };
    // Measured: a visit to a leaf takes half as long as to a node, a little more for each shape,
    // and more for a second vector of shapes.
    static constexpr float leaf_cost = 0.5f, shape_cost = 0.05f, second_cost = 0.2f;

    const BinaryTree& tree_;
    size_t largest_leaf_;
    std::vector<Costs> cost_;

    double area(uint32_t i) const { return half_area(tree_.branches[i].box); }

    float as(uint32_t i, size_t n) const { return cost_[i].as[n - 1]; }

    // Number of the n children that belong to the left of two branches.
    size_t share(uint32_t left, size_t n) const {
        size_t best = 1;
        for (size_t k = 2; k < n; ++k)
            if (as(left, k) + as(left + 1, n - k) < as(left, best) + as(left + 1, n - best))
                best = k;
        return best;
    }

    Costs costs(uint32_t i, float visits) const {
        const Branch& branch = tree_.branches[i];
        const bool may_be_leaf = branch.count <= largest_leaf_ && !(i == 0 && tree_.mixed);
        float leaf = leaf_cost + shape_cost * float(branch.count);
        if (branch.count > real_lanes) leaf += second_cost;
        leaf = may_be_leaf ? visits * leaf : HUGE_VALF;
        Costs own;
        if (branch.leaf()) {
            own.as.fill(leaf);
            own.leaf = true;
            return own;
        }
        auto shared = [&](size_t n) {
            const size_t in_left = share(branch.left, n);
            return as(branch.left, in_left) + as(branch.left + 1, n - in_left);
        };
        const float node = visits + shared(lane_count);
        own.leaf = leaf <= node;
        own.as[0] = std::min(leaf, node);
        for (size_t n = 2; n < lane_count; ++n) own.as[n - 1] = std::min(own.as[n - 2], shared(n));
        return own;
    }

    void collect(uint32_t i, size_t n, Children& list) const {
        while (n > 1 && as(i, n) == as(i, n - 1)) --n;
        if (n == 1) return list.add(i);
        const uint32_t left = tree_.branches[i].left;
        const size_t in_left = share(left, n);
        collect(left, in_left, list);
        collect(left + 1, n - in_left, list);
    }
};

}  // namespace penumbra::wide
