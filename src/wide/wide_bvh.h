// wide/wide_bvh.h  5  where rays stop: a bounding volume hierarchy of triangles and other shapes
#pragma once
#include <new>
#include "wide/collapse.h"
#include "wide/leaf.h"
#include "wide/node.h"

namespace penumbra {

// A tree of boxes, up to eight children a node.  Its answers equal those of a loop over all shapes,
// bit for bit; of shapes hit at the same distance the one with the smallest index wins.
class WideBvh {
public:
    WideBvh() = default;

    // Time O(n log n).  Shape i keeps the index i in every answer.
    explicit WideBvh(const std::vector<Shape>& shapes) {
        if (shapes.empty()) return;
        demand_room(shapes.size() < wide::Child::max_shapes);
        const wide::BinaryTree tree = wide::build(shapes);
        const wide::Collapse collapse(tree, wide::Leaves::largest);
        leaves_.reserve(shapes.size());
        add(shapes, tree, collapse, 0);
        leaves_.finish();
        nodes_.shrink_to_fit();
    }

    // The nearest hit, or nothing.
    std::optional<Hit> closest(const Ray& ray) const {
        Hit best{ray.tmax};
        nearest_first(
            ray, best, [] {}, [](wide::Child) {});
        return best.id == UINT32_MAX ? std::nullopt : std::optional(best);
    }

    // True if anything is hit.  The order of nodes does not matter: the first hit ends the search.
    bool occluded(const Ray& ray) const {
        if (nodes_.empty()) return false;
        const wide::Probe probe(ray);
        const Shear k = shear(ray.d);
        const float end = float(ray.tmax);
        std::array<AnyOrder, wide::BinaryTree::depth> stack;
        AnyOrder* top = stack.data();
        const wide::Node* node = nodes_.data();
        for (;;) {
            wide::Lanes rest = node->meet(probe, end).met();
            for (;;) {
                while (!rest.any()) {
                    if (top == stack.data()) return false;
                    --top;
                    node = top->node;
                    rest = top->rest;
                }
                const wide::Child child = node->child[rest.first()];
                rest.drop_first();
                if (!child.is_leaf()) {
                    *top = {node, rest};
                    top += rest.any();
                    node = at(child);
                    break;
                }
                if (leaves_.any(child, ray, k)) return true;
            }
        }
    }

    // Work of closest(ray).
    struct Work {
        int nodes = 0, shapes = 0;
    };
    Work work(const Ray& ray) const {
        Work work;
        Hit best{ray.tmax};
        nearest_first(
            ray, best, [&] { ++work.nodes; },
            [&](wide::Child leaf) { work.shapes += int(leaf.count()); });
        return work;
    }

    size_t bytes() const { return nodes_.capacity() * sizeof(wide::Node) + leaves_.bytes(); }

private:
    std::vector<wide::Node> nodes_;
    wide::Leaves leaves_;

    // ---- Traversal ------------------------------------------------------------------------------

    // A node with children that are not yet visited: those left, or all and the key of the next.
    // There is at most one per level.
    struct AnyOrder {
        const wide::Node* node;
        wide::Lanes rest;
    };
    struct Ordered {
        wide::Keys keys;
        const wide::Node* node;
        int32_t key;
    };

    const wide::Node* at(wide::Child child) const {
        const auto* first = reinterpret_cast<const std::byte*>(nodes_.data());
        return reinterpret_cast<const wide::Node*>(first + child.bits);
    }

    // Makes best the nearest hit of it and of all shapes.  Of a node's children the nearest comes
    // first; none that begins behind the best hit so far is opened.
    template <class Open, class OpenLeaf>
    [[gnu::always_inline]] void nearest_first(const Ray& ray, Hit& best, Open open,
                                              OpenLeaf open_leaf) const {
        if (nodes_.empty()) return;
        const wide::Probe probe(ray);
        const Shear k = shear(ray.d);
        float end = float(best.t);
        std::array<Ordered, wide::BinaryTree::depth> stack;
        Ordered* top = stack.data();
        const wide::Node* node = nodes_.data();
        open();
        wide::Keys keys = node->meet(probe, end).keys();
        int32_t key = wide::least(keys);
        for (;;) {
            while (key > wide::Crossing::last_key(end)) {
                if (top == stack.data()) return;
                --top;
                node = top->node;
                keys = top->keys;
                key = top->key;
            }
            const wide::Child child = node->child[key & 7];
            key = wide::next(keys, key);
            if (child.is_leaf()) {
                open_leaf(child);
                best = leaves_.nearest(child, ray, k, best);
                end = float(best.t);
                continue;
            }
            *top = {keys, node, key};
            top += key <= wide::Crossing::last_key(end);
            node = at(child);
            open();
            keys = node->meet(probe, end).keys();
            key = wide::least(keys);
        }
    }

    // ---- Construction ---------------------------------------------------------------------------

    static void demand_room(bool enough) {
        if (!enough) throw std::bad_alloc();  // 2^27 shapes; a scene has at most 2^22
    }

    // Adds the node that a branch becomes and all below it.
    wide::Child add(const std::vector<Shape>& shapes, const wide::BinaryTree& tree,
                    const wide::Collapse& collapse, uint32_t root) {
        const size_t index = nodes_.size(), offset = index * sizeof(wide::Node);
        demand_room(offset <= UINT32_MAX);
        nodes_.emplace_back();
        const wide::Children children = collapse.children(root);
        for (size_t i = 0; i < children.count; ++i) {
            const wide::Branch& from = tree.branches[children.branch[i]];
            nodes_[index].set(i, from.box);
            if (collapse.is_leaf(children.branch[i]))
                nodes_[index].child[i] = leaves_.add(shapes, {&tree.ids[from.first], from.count});
        }
        for (size_t i = 0; i < children.count; ++i)
            if (!collapse.is_leaf(children.branch[i]))
                nodes_[index].child[i] = add(shapes, tree, collapse, children.branch[i]);
        return {uint32_t(offset)};
    }
};

}  // namespace penumbra
