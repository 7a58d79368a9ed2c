// world/bvh.h  3  where rays stop: a bounding volume hierarchy of triangles and spheres
#pragma once
#include "world/bvh_build.h"

// A tree of boxes, four children a node: a binary tree, collapsed (Dammertz et al. 2008).  Its
// answers equal those of a loop over all shapes, bit for bit; of shapes hit at the same distance
// the one with the smallest index wins.
class Bvh {
public:
    Bvh() = default;

    // Time O(n log n).  Shape i keeps the index i in every answer.
    explicit Bvh(const std::vector<Shape>& shapes) {
        if (shapes.empty()) return;
        const bvh::BinaryTree tree = bvh::build(shapes);
        collapse(tree.branches, 0);
        for (const bvh::Item& item : tree.items) {
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
    static constexpr int width = 4;  // children a node
    static constexpr int stack_size = bvh::BinaryTree::depth * (width - 1) + width;

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

    std::vector<Node> nodes_;
    std::vector<Shape> shapes_;  // in the order of the leaves
    std::vector<uint32_t> ids_;  // their indices

    // ---- Traversal ----------------------------------------------------------------------------

    // A ray as boxes see it.
    struct Probe {
        vec3 o, inverse;  // 1 / d; of -0: -inf
        size_t down[3];   // whether it meets a box's upper plane first
        explicit Probe(const Ray& ray)
            : o(ray.o),
              inverse{1 / ray.d.x, 1 / ray.d.y, 1 / ray.d.z},
              down{std::signbit(ray.d.x), std::signbit(ray.d.y), std::signbit(ray.d.z)} {}
    };

    // Children yet to be looked at, the nearest on top.
    struct Stack {
        struct Entry {
            real t;  // where the ray enters the child's box
            uint32_t first, count;
        };
        std::array<Entry, stack_size> entries;
        int top = 0;
        // Among those from bottom on, in order.
        void insert(int bottom, const Entry& e) {
            int j = top++;
            for (; j > bottom && entries[size_t(j - 1)].t < e.t; --j)
                entries[size_t(j)] = entries[size_t(j - 1)];
            entries[size_t(j)] = e;
        }
    };

    // Calls visit(shape, id, shear) for the shapes in every leaf whose box the ray meets at
    // t <= tmax, nearest box first, and open() for every node on the way; tmax may shrink
    // meanwhile.  Stops when visit returns true.
    template <class Visit, class Open>
    bool walk(const Ray& ray, const real& tmax, Visit visit, Open open) const {
        // A ray that is not a number meets nothing.
        if (nodes_.empty() || !std::isfinite(dot(ray.o, ray.d))) return false;
        const Shear k = shear(ray.d);
        const Probe probe(ray);
        Stack stack;
        stack.insert(0, {0, 0, 0});
        while (stack.top > 0) {
            const auto entry = stack.entries[size_t(--stack.top)];
            if (entry.t > tmax) continue;
            if (entry.count == 0) {
                open();
                push_children(stack, nodes_[entry.first], probe, tmax);
                continue;
            }
            for (uint32_t i = entry.first; i < entry.first + entry.count; ++i)
                if (visit(shapes_[i], ids_[i], k)) return true;
        }
        return false;
    }

    // Slabs.  A ray within a slab's plane and parallel to it makes 0 * inf = NaN: the comparisons
    // are written so that NaN leaves the interval as it is.
    static void push_children(Stack& stack, const Node& node, const Probe& ray, real tmax) {
        auto widen = [](const Floats& x, Reals& y) { y = Reals{x[0], x[1], x[2], x[3]}; };
        Reals t0{}, t1 = t0 + tmax, n, f;
        for (int a = 0; a < 3; ++a) {
            const real o = ray.o.*axis[a], inverse = ray.inverse.*axis[a];
            widen(node.plane[ray.down[a]][a], n);
            widen(node.plane[1 - ray.down[a]][a], f);
            n = (n - o) * inverse;
            f = (f - o) * inverse;
            t0 = n > t0 ? n : t0;
            t1 = f < t1 ? f : t1;
        }
        // Each bound is 3 roundings from the truth (Ize 2013, JCGT 2(2)), and what a shape makes of
        // a ray from afar about as many: widen by 16 on both sides.
        t0 *= 1 - 16 * ulp;
        t1 *= 1 + 16 * ulp;
        const auto met = t0 <= t1;
        const int bottom = stack.top;
        for (int i = 0; i < width; ++i)
            if (met[i]) stack.insert(bottom, {t0[i], node.first[i], node.count[i]});
    }

    // ---- Construction -------------------------------------------------------------------------

    // Adds the wide node of a branch and all below it; returns its index.
    uint32_t collapse(const std::vector<bvh::Branch>& tree, uint32_t root) {
        const std::vector<uint32_t> children = opened(tree, root);
        const uint32_t index = uint32_t(nodes_.size());
        nodes_.emplace_back();
        for (uint32_t i = 0; i < width; ++i) {
            const bvh::Branch branch =
                i < children.size() ? tree[children[i]] : bvh::Branch{{}, 0, 0};
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

    // The children of a branch's wide node: opens the one with the largest box until there are
    // four.
    static std::vector<uint32_t> opened(const std::vector<bvh::Branch>& tree, uint32_t root) {
        std::vector<uint32_t> children{root};
        while (children.size() < width) {
            auto area = [&](uint32_t i) { return tree[i].leaf() ? -1 : tree[i].box.half_area(); };
            auto largest = std::max_element(children.begin(), children.end(),
                                            [&](auto i, auto j) { return area(i) < area(j); });
            const bvh::Branch& branch = tree[*largest];
            if (branch.leaf()) break;
            *largest = branch.left;
            children.push_back(branch.right);
        }
        return children;
    }

    // Rounding to the nearest float is off by half an ulp at most; one ulp outwards covers it.
    static float outwards(real x, float direction) {
        return std::isinf(x) ? float(x) : std::nextafter(float(x), direction);
    }
};
