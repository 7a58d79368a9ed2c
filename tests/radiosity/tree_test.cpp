// radiosity/tree_test.cpp  nodes contain their children, leaves are elements
#include "radiosity/tree.h"

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

struct OfFurniture {
    Scene scene = furniture();
    Mesh mesh = make_mesh(scene, 0.3);
    Trees trees{mesh};
    std::vector<uint32_t> face = face_of_element(mesh);
};

// Uses edge functions, for points in its plane.
bool contains(const Node& n, vec3 normal, vec3 p) {
    for (uint32_t k = 0; k < n.corners; ++k) {
        const vec3 a = n.corner[k], b = n.corner[(k + 1) % n.corners];
        if (dot(cross(b - a, p - a), normal) <= 0) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("every element is one leaf; every node but a root has one parent, which comes first") {
    const auto [s, mesh, trees, face] = OfFurniture{};
    for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
        CAPTURE(f);
        const uint32_t from = trees.first(f), to = trees.first(f + 1);
        std::vector<int> parents(to - from), leaves(mesh.elements());
        for (uint32_t i = from; i < to; ++i) {
            const Node& n = trees[i];
            if (n.children == 0) {
                REQUIRE(n.first < mesh.elements());
                CHECK(face[n.first] == f);
                ++leaves[n.first];
                CHECK(trees.leaf(n.first) == i);
                CHECK(n.corners == 3);
                continue;
            }
            CHECK(n.first > i);
            for (uint32_t k = n.first; k < n.first + n.children; ++k) {
                REQUIRE(k < to);
                ++parents[k - from];
            }
        }
        CHECK(parents[0] == 0);
        for (uint32_t k = 1; k < to - from; ++k) CHECK(parents[k] == 1);
        for (uint32_t e = 0; e < mesh.elements(); ++e) CHECK(leaves[e] == (face[e] == f));
        const double n = mesh.faces[f].elements();
        CHECK((to - from) * sizeof(Node) + n * sizeof(uint32_t) <= n * Trees::bytes_per_element);
    }
}

TEST_CASE("leaves have the corners of their elements, in the same order") {
    const auto [s, mesh, trees, face] = OfFurniture{};
    for (uint32_t e = 0; e < mesh.elements(); ++e) {
        const Face& f = mesh.faces[face[e]];
        const Node& n = trees[trees.leaf(e)];
        // Vertices receive a thousandth of a cell inside their face's border.
        for (size_t k = 0; k < 3; ++k)
            CHECK(length(n.corner[k] - corner_of(mesh, e, k)) <= 0.3 * 3 / 1024);
        CHECK(double(n.area) == approx(double(area_of(f)), 1e-12, 1e-4));
        CHECK(dot(cross(n.corner[1] - n.corner[0], n.corner[2] - n.corner[0]), f.n) > 0);
    }
}

TEST_CASE("children divide their parent: areas add up, each point is in one of them") {
    const auto [s, mesh, trees, face] = OfFurniture{};
    Rng rng{seed_here()};
    for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
        CHECK(double(trees[trees.first(f)].area) == approx(double(mesh.faces[f].area())));
        for (uint32_t i = trees.first(f); i < trees.first(f + 1); ++i) {
            const Node& n = trees[i];
            CAPTURE(i);
            if (n.children == 0) continue;
            CHECK((n.children == 2 || n.children == 4));
            double area = 0;
            for (uint32_t k = n.first; k < n.first + n.children; ++k) area += double(trees[k].area);
            CHECK(area == approx(double(n.area)));
            for (int point = 0; point < 4; ++point) {
                const real u = real(rng.uniform()), v = real(rng.uniform());
                const bool upper = n.corners == 3 && u + v > 1;
                const vec3 p = n.corner[0] + (upper ? 1 - u : u) * (n.corner[1] - n.corner[0]) +
                               (upper ? 1 - v : v) * (n.corner[n.corners - 1] - n.corner[0]);
                int inside = 0;
                for (uint32_t k = n.first; k < n.first + n.children; ++k)
                    inside += contains(trees[k], mesh.faces[f].n, p);
                CHECK(inside == 1);
            }
        }
    }
}

TEST_CASE("a node is within its radius of its centre, which is as small as can be") {
    const auto [s, mesh, trees, face] = OfFurniture{};
    for (uint32_t i = 0; i < trees.first(uint32_t(mesh.faces.size())); ++i) {
        const Node& n = trees[i];
        vec3 sum;
        real farthest = 0;
        for (uint32_t k = 0; k < n.corners; ++k) {
            sum += n.corner[k];
            farthest = std::max(farthest, length(n.corner[k] - n.centre));
        }
        CHECK(length(sum / real(n.corners) - n.centre) <= 32 * ulp * 10);
        CHECK(n.radius == farthest);
    }
}

TEST_CASE("nodes stay compact: none of a square face is longer than two of its widths") {
    const Mesh mesh = make_mesh(scene_of_quads({{{}, {8, 0, 0}, {0, 8, 0}}}), 1.5);
    const Trees trees(mesh);
    int depth_of_leaf = 0;
    for (uint32_t i = trees.first(0); i < trees.first(1); ++i) {
        const Node& n = trees[i];
        if (n.corners == 3) continue;
        const real a = length(n.corner[1] - n.corner[0]), b = length(n.corner[3] - n.corner[0]);
        CHECK(std::max(a, b) <= 2 * std::min(a, b) * (1 + 8 * ulp));
    }
    for (uint32_t i = trees.first(0); trees[i].children; i = trees[i].first) ++depth_of_leaf;
    CHECK(depth_of_leaf == 7);  // 8 x 8 cells, and the diagonal
}
