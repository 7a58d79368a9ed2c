// world/bvh.h  5  where rays stop: a bounding volume hierarchy of triangles and spheres
#pragma once
#include "base/words.h"
#include "world/bvh_collapse.h"
#include "world/bvh_leaf.h"
#include "world/bvh_node.h"

// A tree of boxes, up to eight children a node.  Its answers equal those of a loop over all shapes,
// bit for bit; of shapes hit at the same distance the one with the smallest index wins.
class Bvh {
public:
    Bvh() = default;

    // Time O(n log n).  Shape i keeps the index i in every answer.
    explicit Bvh(const std::vector<Shape>& shapes) {
        if (shapes.empty()) return;
        demand_room(shapes.size() < bvh::Child::most_shapes);
        const bvh::BinaryTree tree = bvh::build(shapes);
        const bvh::Collapse collapse(tree, bvh::Leaves::largest);
        leaves_.reserve(shapes.size());
        add(shapes, tree, collapse, 0);
        leaves_.finish();
        nodes_.shrink_to_fit();
    }

    // The nearest hit, or nothing.
    std::optional<Hit> closest(const Ray& ray) const {
        Hit best{ray.tmax};
        nearest_first(
            ray, best, [] {}, [](bvh::Child) {});
        return best.id == UINT32_MAX ? std::nullopt : std::optional(best);
    }

    // Whether anything is hit.  The order of nodes does not matter: the first hit ends it all.
    bool occluded(const Ray& ray) const {
        if (nodes_.empty()) return false;
        const bvh::Probe probe(ray);
        const Shear k = shear(ray.d);
        const float end = float(ray.tmax);
        std::array<AnyOrder, bvh::BinaryTree::depth> stack;
        AnyOrder* top = stack.data();
        const bvh::Node* node = nodes_.data();
        for (;;) {
            bvh::Lanes rest = node->meet(probe, end).met();
            for (;;) {
                while (!rest.any()) {
                    if (top == stack.data()) return false;
                    --top;
                    node = top->node;
                    rest = top->rest;
                }
                const bvh::Child child = node->child[rest.first()];
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

    // What closest(ray) costs.
    struct Work {
        int nodes = 0, shapes = 0;
    };
    Work work(const Ray& ray) const {
        Work work;
        Hit best{ray.tmax};
        nearest_first(
            ray, best, [&] { ++work.nodes; },
            [&](bvh::Child leaf) { work.shapes += int(leaf.count()); });
        return work;
    }

    size_t bytes() const { return nodes_.capacity() * sizeof(bvh::Node) + leaves_.bytes(); }

private:
    std::vector<bvh::Node> nodes_;
    bvh::Leaves leaves_;

    // ---- Traversal ------------------------------------------------------------------------------

    // A node with children yet to be looked at: those left, or all and the key of the next.  There
    // is never more than one of a level.
    struct AnyOrder {
        const bvh::Node* node;
        bvh::Lanes rest;
    };
    struct Ordered {
        bvh::Keys keys;
        const bvh::Node* node;
        int32_t key;
    };

    const bvh::Node* at(bvh::Child c) const {
        const auto* first = reinterpret_cast<const std::byte*>(nodes_.data());
        return reinterpret_cast<const bvh::Node*>(first + c.bits);
    }

    // Makes best the nearest hit of it and of all shapes.  Of a node's children the nearest comes
    // first; none that begins behind the best hit so far is opened.
    template <class Open, class OpenLeaf>
    [[gnu::always_inline]] void nearest_first(const Ray& ray, Hit& best, Open open,
                                              OpenLeaf open_leaf) const {
        if (nodes_.empty()) return;
        const bvh::Probe probe(ray);
        const Shear k = shear(ray.d);
        float end = float(best.t);
        std::array<Ordered, bvh::BinaryTree::depth> stack;
        Ordered* top = stack.data();
        const bvh::Node* node = nodes_.data();
        open();
        bvh::Keys keys = node->meet(probe, end).keys();
        int32_t key = bvh::least(keys);
        for (;;) {
            while (key > bvh::Crossing::last_key(end)) {
                if (top == stack.data()) return;
                --top;
                node = top->node;
                keys = top->keys;
                key = top->key;
            }
            const bvh::Child child = node->child[key & 7];
            key = bvh::next(keys, key);
            if (child.is_leaf()) {
                open_leaf(child);
                best = leaves_.nearest(child, ray, k, best);
                end = float(best.t);
                continue;
            }
            *top = {keys, node, key};
            top += key <= bvh::Crossing::last_key(end);
            node = at(child);
            open();
            keys = node->meet(probe, end).keys();
            key = bvh::least(keys);
        }
    }

    // ---- Construction ---------------------------------------------------------------------------

    static void demand_room(bool enough) {
        if (!enough) throw UserError("so many shapes are too many for one scene");
    }

    // Adds the node that a branch becomes and all below it.
    bvh::Child add(const std::vector<Shape>& shapes, const bvh::BinaryTree& tree,
                   const bvh::Collapse& collapse, uint32_t root) {
        const size_t index = nodes_.size(), offset = index * sizeof(bvh::Node);
        demand_room(offset <= UINT32_MAX);
        nodes_.emplace_back();
        const bvh::Children children = collapse.children(root);
        for (size_t i = 0; i < children.count; ++i) {
            const bvh::Branch& b = tree.branches[children.branch[i]];
            nodes_[index].set(i, b.box);
            if (collapse.is_leaf(children.branch[i]))
                nodes_[index].child[i] = leaves_.add(shapes, {&tree.ids[b.first], b.count});
        }
        for (size_t i = 0; i < children.count; ++i)
            if (!collapse.is_leaf(children.branch[i]))
                nodes_[index].child[i] = add(shapes, tree, collapse, children.branch[i]);
        return {uint32_t(offset)};
    }
};
