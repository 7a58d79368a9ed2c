// world/bvh.h  2  where rays stop: a bounding volume hierarchy of triangles and spheres
#pragma once
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "world/shapes.h"

// A tree of boxes, four children a node: a binary tree by the binned surface area heuristic (Wald
// 2007, "On fast construction of SAH-based BVHs"), collapsed (Dammertz et al. 2008).  Its answers
// equal those of a loop over all shapes, bit for bit; of shapes hit at the same distance the one
// with the smallest index wins.
class Bvh {
public:
    Bvh() = default;

    // Time O(n log n).  Shape i keeps the index i in every answer.
    explicit Bvh(const std::vector<Shape>& shapes) {
        if (shapes.empty()) return;
        std::vector<Item> items;
        for (const Shape& s : shapes) items.push_back({bounds(s), uint32_t(items.size())});
        std::vector<Branch> tree;
        grow(tree, items, 0, uint32_t(items.size()), 0);
        collapse(tree, 0);
        for (const Item& item : items) {
            shapes_.push_back(shapes[item.id]);
            ids_.push_back(item.id);
        }
    }

    // The nearest hit, or nothing.
    std::optional<Hit> closest(const Ray& ray) const {
        Hit best{ray.tmax};
        walk(
            ray, best.t,
            [&](const Shape& s, uint32_t id, const Shear& k) {
                auto hit = intersect(s, ray, k, best.t);
                if (hit && (hit->t < best.t || id < best.id)) {
                    best = *hit;
                    best.id = id;
                }
                return false;
            },
            [] {});
        return best.id == UINT32_MAX ? std::nullopt : std::optional(best);
    }

    // Whether anything is hit.
    bool occluded(const Ray& ray) const {
        return walk(
            ray, ray.tmax,
            [&](const Shape& s, uint32_t, const Shear& k) {
                return intersect(s, ray, k, ray.tmax).has_value();
            },
            [] {});
    }

    // What closest(ray) costs.
    struct Work {
        int nodes = 0, shapes = 0;
    };
    Work work(const Ray& ray) const {
        Work work;
        real tmax = ray.tmax;
        walk(
            ray, tmax,
            [&](const Shape& s, uint32_t, const Shear& k) {
                ++work.shapes;
                if (auto hit = intersect(s, ray, k, tmax)) tmax = hit->t;
                return false;
            },
            [&] { ++work.nodes; });
        return work;
    }

    size_t bytes() const {
        return nodes_.size() * sizeof(Node) + shapes_.size() * (sizeof(Shape) + sizeof(uint32_t));
    }

private:
    static constexpr int width = 4;       // children a node
    static constexpr int bins = 16;       // candidate planes an axis
    static constexpr int leaf_size = 4;   // shapes a leaf holds at most
    static constexpr int sah_depth = 32;  // below, split at the median: 32 levels more
    static constexpr int stack_size = (sah_depth + 32) * (width - 1) + width;

    // A number a child, in vector registers: GCC and Clang do arithmetic with such types, but
    // neither makes them of a loop as tangled as walk's by itself.
    typedef float Floats __attribute__((vector_size(width * sizeof(float))));
    typedef real Reals __attribute__((vector_size(width * sizeof(real))));

    // Boxes are float, rounded outwards: half the memory; the answers come from the shapes.  An
    // absent child has the empty box, which no ray meets.
    struct Node {
        Floats plane[2][3];     // [lower, upper][axis][child]
        uint32_t first[width];  // child: index of a node or, in a leaf, of its first shape
        uint32_t count[width];  // shapes in a leaf; 0: a node
    };

    struct Item {
        Box box;
        uint32_t id;
        vec3 centroid() const { return (box.lo + box.hi) * real(0.5); }
    };

    std::vector<Node> nodes_;
    std::vector<Shape> shapes_;  // in the order of the leaves
    std::vector<uint32_t> ids_;  // their indices

    // ---- Traversal ----------------------------------------------------------------------------

    // Calls visit(shape, id, shear) for the shapes in every leaf whose box the ray meets at
    // t <= tmax, nearest box first, and open() for every node on the way; tmax may shrink
    // meanwhile.  Stops when visit returns true.
    template <class Visit, class Open>
    bool walk(const Ray& ray, const real& tmax, Visit visit, Open open) const {
        // A ray that is not a number meets nothing.
        if (nodes_.empty() || !std::isfinite(dot(ray.o, ray.d))) return false;
        struct Entry {
            real t;
            uint32_t first, count;
        };
        std::array<Entry, stack_size> stack;
        int top = 0;
        stack[top++] = {0, 0, 0};
        const Shear k = shear(ray.d);
        const vec3 inverse{1 / ray.d.x, 1 / ray.d.y, 1 / ray.d.z};  // of -0: -inf
        const size_t down[3] = {std::signbit(ray.d.x), std::signbit(ray.d.y),
                                std::signbit(ray.d.z)};
        while (top > 0) {
            const Entry entry = stack[--top];
            if (entry.t > tmax) continue;
            if (entry.count > 0) {
                for (uint32_t i = entry.first; i < entry.first + entry.count; ++i)
                    if (visit(shapes_[i], ids_[i], k)) return true;
                continue;
            }
            const Node& node = nodes_[entry.first];
            open();
            // Slabs.  A ray within a slab's plane and parallel to it makes 0 * inf = NaN: the
            // comparisons are written so that NaN leaves the interval as it is.
            auto widen = [](const Floats& x, Reals& y) { y = Reals{x[0], x[1], x[2], x[3]}; };
            Reals t0{}, t1 = t0 + tmax, n, f;
            for (int a = 0; a < 3; ++a) {
                const real o = ray.o.*axis[a], inv = inverse.*axis[a];
                widen(node.plane[down[a]][a], n);
                widen(node.plane[1 - down[a]][a], f);
                n = (n - o) * inv;
                f = (f - o) * inv;
                t0 = n > t0 ? n : t0;
                t1 = f < t1 ? f : t1;
            }
            // Each bound is 3 roundings from the truth (Ize 2013, JCGT 2(2)), and what a shape
            // makes of a ray from afar about as many: widen by 16 on both sides.
            t0 *= 1 - 16 * ulp;
            t1 *= 1 + 16 * ulp;
            const auto met = t0 <= t1;
            const int bottom = top;
            for (int i = 0; i < width; ++i) {
                if (!met[i]) continue;
                int j = top++;
                for (; j > bottom && stack[j - 1].t < t0[i]; --j) stack[j] = stack[j - 1];
                stack[j] = {t0[i], node.first[i], node.count[i]};
            }
        }
        return false;
    }

    // ---- Construction -------------------------------------------------------------------------

    // A node of the binary tree that is built first.  It spans count items from first on; a leaf
    // has no children (the root, at 0, is nobody's child).
    struct Branch {
        Box box;
        uint32_t first, count;
        uint32_t left = 0, right = 0;
        bool leaf() const { return left == 0; }
    };

    static uint32_t grow(std::vector<Branch>& tree, std::vector<Item>& items, uint32_t first,
                         uint32_t count, int depth) {
        Branch branch{{}, first, count};
        for (uint32_t i = first; i < first + count; ++i) branch.box.add(items[i].box);
        uint32_t index = uint32_t(tree.size());
        tree.push_back(branch);
        uint32_t left = split(items, branch, depth);
        if (left == 0) return index;
        uint32_t child = grow(tree, items, first, left, depth + 1);
        tree[index].left = child;
        child = grow(tree, items, first + left, count - left, depth + 1);
        tree[index].right = child;
        return index;
    }

    // Orders the items of a branch so that its first n go left, and returns n; 0: keep it a leaf.
    static uint32_t split(std::vector<Item>& items, const Branch& branch, int depth) {
        const auto begin = items.begin() + branch.first, end = begin + branch.count;
        Box centroids;
        for (auto i = begin; i != end; ++i) centroids.add(i->centroid());
        const vec3 extent = centroids.hi - centroids.lo;

        // Sum of (shapes x area) on both sides of each plane between bins; the least wins.
        struct Bin {
            Box box;
            uint32_t count = 0;
        };
        auto bin_of = [&](const Item& item, int a) {
            real x = (item.centroid().*axis[a] - centroids.lo.*axis[a]) / extent.*axis[a];
            return std::min(int(x * bins), bins - 1);
        };
        real best = infinity;
        int best_axis = -1, best_bin = 0;
        for (int a = 0; a < 3; ++a) {
            if (!(extent.*axis[a] > 0)) continue;
            std::array<Bin, bins> bin;
            for (auto i = begin; i != end; ++i) {
                Bin& b = bin[size_t(bin_of(*i, a))];
                b.box.add(i->box);
                ++b.count;
            }
            std::array<real, bins> above;  // cost of bins k and up
            Bin sum;
            for (int k = bins - 1; k > 0; --k) {
                sum.box.add(bin[size_t(k)].box);
                sum.count += bin[size_t(k)].count;
                above[size_t(k)] = sum.box.half_area() * real(sum.count);
            }
            sum = {};
            for (int k = 1; k < bins; ++k) {
                sum.box.add(bin[size_t(k - 1)].box);
                sum.count += bin[size_t(k - 1)].count;
                real cost = sum.box.half_area() * real(sum.count) + above[size_t(k)];
                if (sum.count > 0 && sum.count < branch.count && cost < best)
                    best = cost, best_axis = a, best_bin = k;
            }
        }
        // Visiting a node costs about as much as a shape, so a split must save one.
        const bool may_be_leaf = branch.count <= leaf_size;
        if (may_be_leaf && !(best < branch.box.half_area() * real(branch.count - 1))) return 0;
        if (best_axis >= 0 && depth < sah_depth) {
            auto middle = std::partition(
                begin, end, [&](const Item& i) { return bin_of(i, best_axis) < best_bin; });
            return uint32_t(middle - begin);
        }
        // All centroids alike, or the tree too deep: halves.
        int a = extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
        std::nth_element(begin, begin + branch.count / 2, end, [&](const Item& i, const Item& j) {
            return i.centroid().*axis[a] < j.centroid().*axis[a];
        });
        return branch.count / 2;
    }

    // Makes one wide node of a branch: opens the child with the largest box until there are four.
    uint32_t collapse(const std::vector<Branch>& tree, uint32_t root) {
        std::vector<uint32_t> children{root};
        while (children.size() < width) {
            auto area = [&](uint32_t i) { return tree[i].leaf() ? -1 : tree[i].box.half_area(); };
            auto largest = std::max_element(children.begin(), children.end(),
                                            [&](auto i, auto j) { return area(i) < area(j); });
            const Branch& branch = tree[*largest];
            if (branch.leaf()) break;
            *largest = branch.left;
            children.push_back(branch.right);
        }
        const uint32_t index = uint32_t(nodes_.size());
        nodes_.emplace_back();
        for (uint32_t i = 0; i < width; ++i) {
            const Branch branch = i < children.size() ? tree[children[i]] : Branch{{}, 0, 0};
            Node& node = nodes_[index];
            for (int a = 0; a < 3; ++a) {
                node.plane[0][a][i] = outwards(branch.box.lo.*axis[a], -HUGE_VALF);
                node.plane[1][a][i] = outwards(branch.box.hi.*axis[a], HUGE_VALF);
            }
            node.first[i] = branch.first;
            node.count[i] = branch.count;
        }
        for (uint32_t i = 0; i < children.size(); ++i) {
            if (tree[children[i]].leaf()) continue;
            const uint32_t child = collapse(tree, children[i]);
            nodes_[index].first[i] = child;
            nodes_[index].count[i] = 0;
        }
        return index;
    }

    // Rounding to the nearest float is off by half an ulp at most; one ulp outwards covers it.
    static float outwards(real x, float direction) {
        return std::isinf(x) ? float(x) : std::nextafter(float(x), direction);
    }
};
