// radiosity/tree.h  3  the parts of a face that shoot as one
#pragma once
#include "radiosity/mesh.h"

namespace penumbra {

// A triangle or parallelogram of a face: one element, or all that its children are.
struct Node {
    std::array<vec3, 4> corner;
    uint32_t corners = 3;
    uint32_t children = 0, first = 0;  // consecutive nodes; none: the element `first`
    vec3 centre;
    real area = 0, radius = 0;  // radius: distance of the corners from the centre
};

inline Node node_of(const std::array<vec3, 4>& corner, uint32_t corners) {
    Node n{corner, corners, 0, 0, {}, 0, 0};
    for (uint32_t k = 0; k < corners; ++k) n.centre += corner[k] / real(corners);
    for (uint32_t k = 0; k < corners; ++k)
        n.radius = std::max(n.radius, length(corner[k] - n.centre));
    n.area = length(cross(corner[1] - corner[0], corner[corners - 1] - corner[0])) *
             (corners == 4 ? 1 : real(0.5));
    return n;
}

// The trees of all faces; a parent comes before its children.
class Trees {
public:
    explicit Trees(const Mesh& mesh) : leaf_(mesh.elements()) {
        for (const Face& f : mesh.faces) {
            first_.push_back(uint32_t(nodes_.size()));
            nodes_.emplace_back();
            if (f.quad)
                grow_quad(f, first_.back(), {0, 0, f.columns, f.rows});
            else
                grow_triangle(f, first_.back(), {{{0, 0}, {f.rows, 0}, {0, f.rows}}});
        }
        first_.push_back(uint32_t(nodes_.size()));
    }

    const Node& operator[](uint32_t i) const { return nodes_[i]; }
    // Those of a face are first(face), its root, to first(face + 1).
    uint32_t first(size_t face) const { return first_[face]; }
    // The node that an element is.
    uint32_t leaf(uint32_t element) const { return leaf_[element]; }

    // A quad of n cells has n - 1 nodes above them, n cells and 2 n leaves.
    static constexpr double bytes_per_element = 2 * sizeof(Node) + sizeof(uint32_t);

private:
    std::vector<Node> nodes_;
    std::vector<uint32_t> first_, leaf_;

    struct Cells {
        uint32_t left, top, right, bottom;
    };
    struct Point {
        uint32_t i, j;
    };

    static vec3 at(const Face& f, Point p) { return point_at(f, real(p.i), real(p.j)); }

    // Halves the longer side, down to single cells, which are two triangles.
    void grow_quad(const Face& f, uint32_t index, Cells c) {
        const vec3 p = at(f, {c.left, c.top}), q = at(f, {c.right, c.top}),
                   r = at(f, {c.right, c.bottom}), s = at(f, {c.left, c.bottom});
        Node node = node_of({p, q, r, s}, 4);
        node.children = 2, node.first = uint32_t(nodes_.size());
        nodes_[index] = node;
        nodes_.resize(nodes_.size() + 2);
        const uint32_t wide = c.right - c.left, high = c.bottom - c.top;
        if (wide == 1 && high == 1) {
            set_leaf(node.first, node_of({p, q, r}, 3), element_at(f, c.left, c.top, 0));
            set_leaf(node.first + 1, node_of({p, r, s}, 3), element_at(f, c.left, c.top, 1));
            return;
        }
        Cells one = c, two = c;
        if (high == 1 || (wide > 1 && length(q - p) > length(s - p)))
            one.right = two.left = c.left + wide / 2;
        else
            one.bottom = two.top = c.top + high / 2;
        grow_quad(f, node.first, one);
        grow_quad(f, node.first + 1, two);
    }

    // Into quarters, down to elements, which stand upright, (i, j), (i + 1, j), (i, j + 1), or on
    // their heads, (i + 1, j + 1), (i, j + 1), (i + 1, j).
    void grow_triangle(const Face& f, uint32_t index, const std::array<Point, 3>& p) {
        Node node = node_of({at(f, p[0]), at(f, p[1]), at(f, p[2])}, 3);
        const uint32_t i = std::min(p[0].i, p[1].i), j = std::min(p[0].j, p[2].j);
        if (std::max(p[0].i, p[1].i) - i == 1) {
            set_leaf(index, node, element_at(f, i, j, p[0].i != i));
            return;
        }
        node.children = 4, node.first = uint32_t(nodes_.size());
        nodes_[index] = node;
        nodes_.resize(nodes_.size() + 4);
        auto middle = [](Point a, Point b) { return Point{(a.i + b.i) / 2, (a.j + b.j) / 2}; };
        const Point ab = middle(p[0], p[1]), bc = middle(p[1], p[2]), ca = middle(p[2], p[0]);
        grow_triangle(f, node.first, {p[0], ab, ca});
        grow_triangle(f, node.first + 1, {ab, p[1], bc});
        grow_triangle(f, node.first + 2, {ca, bc, p[2]});
        grow_triangle(f, node.first + 3, {bc, ca, ab});
    }

    void set_leaf(uint32_t index, Node node, uint32_t element) {
        node.children = 0, node.first = element;
        nodes_[index] = node;
        leaf_[element] = index;
    }
};

}  // namespace penumbra
