// wide/collapse_test.cpp  the collapse finds the cheapest wide BVH that a binary BVH contains
#include "wide/collapse.h"

#include <functional>

#include "world/geometry.h"

namespace {

using wide::BinaryTree, wide::Branch;

constexpr double leaf_cost = 0.5, shape_cost = 0.05, second_cost = 0.2;  // measured values
constexpr uint32_t largest_leaf = 8;

// A random tree with `leaves` leaves of 1 to 4 shapes each; the boxes grow upwards.
BinaryTree random_tree(int leaves, Dice& random) {
    BinaryTree tree{};
    std::function<void(uint32_t, int, real)> grow = [&](uint32_t i, int n, real size) {
        Branch& b = tree.branches[i];
        for (float& p : b.box) p = float(size * random(real(0.2), 1));
        if (n == 1) {
            b.count = 1 + uint32_t(random.below(4));
            return;
        }
        const uint32_t left = uint32_t(tree.branches.size());
        b.left = left;
        tree.branches.resize(left + 2);
        const int half = 1 + int(random.below(size_t(n - 1)));
        grow(left, half, size * random(real(0.4), 1));
        grow(left + 1, n - half, size * random(real(0.4), 1));
        tree.branches[i].count = tree.branches[left].count + tree.branches[left + 1].count;
    };
    tree.branches.reserve(100);
    tree.branches.resize(1);
    grow(0, leaves, 1);
    return tree;
}

double area(const BinaryTree& tree, uint32_t i) { return wide::half_area(tree.branches[i].box); }

double cost_of_leaf(const BinaryTree& tree, uint32_t i) {
    const uint32_t shapes = tree.branches[i].count;
    return area(tree, i) *
           (leaf_cost + shape_cost * shapes + (shapes > wide::real_lanes ? second_cost : 0));
}

// The cost of a branch below a node with `room` more children, by trying all ways.
double least_cost(const BinaryTree& tree, uint32_t i, size_t room) {
    const Branch& b = tree.branches[i];
    double least = HUGE_VAL;
    if (b.count <= largest_leaf && !(i == 0 && tree.mixed)) least = cost_of_leaf(tree, i);
    if (b.leaf()) return least;
    auto share = [&](size_t n, double own) {
        for (size_t k = 1; k < n; ++k) {
            const double left = least_cost(tree, b.left, k);
            least = std::min(least, own + left + least_cost(tree, b.left + 1, n - k));
        }
    };
    share(wide::lane_count, area(tree, i));
    share(room, 0);
    return least;
}

// The cost of the wide BVH that Collapse chooses; NaN if it chooses no valid one.
double cost(const BinaryTree& tree, const wide::Collapse& collapse, uint32_t i) {
    const auto children = collapse.children(i);
    double sum = area(tree, i);
    uint32_t shapes = 0;
    for (size_t k = 0; k < children.count; ++k) {
        const uint32_t child = children.branch[k];
        shapes += tree.branches[child].count;
        if (collapse.is_leaf(child))
            sum += cost_of_leaf(tree, child);
        else if (child != i)
            sum += cost(tree, collapse, child);
    }
    return shapes == tree.branches[i].count ? sum : std::nan("");
}

}  // namespace

TEST_CASE("no wide tree within a binary one is cheaper than what is chosen") {
    Dice random{{1}};
    int dearer = 0, wide = 0, merged = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const BinaryTree tree = random_tree(3 + int(random.below(8)), random);
        if (tree.branches[0].count <= largest_leaf) continue;
        const wide::Collapse collapse(tree, largest_leaf);
        const double chosen = cost(tree, collapse, 0), least = least_cost(tree, 0, 1);
        dearer += !(std::abs(chosen - least) <= 1e-5 * least);
        const auto children = collapse.children(0);
        wide += children.count > 2;
        for (size_t k = 0; k < children.count; ++k)
            merged +=
                collapse.is_leaf(children.branch[k]) && !tree.branches[children.branch[k]].leaf();
    }
    CHECK(dearer == 0);
    CHECK(wide > 30);
    CHECK(merged > 10);
}

TEST_CASE("triangles and spheres share no leaf, be they ever so few") {
    const std::vector<Shape> shapes = {{{0, 0, 0}, {}, {}, 1}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const BinaryTree tree = wide::build(shapes);
    CHECK(tree.mixed);
    const wide::Collapse collapse(tree, largest_leaf);
    CHECK(!collapse.is_leaf(0));
    CHECK(collapse.children(0).count == 2);
    CHECK(tree.ids == std::vector<uint32_t>{1, 0});  // triangles come first
    CHECK(tree.branches[1].count == 1);
    CHECK(!wide::build({shapes[0]}).mixed);
    CHECK(!wide::build({shapes[1]}).mixed);
}
