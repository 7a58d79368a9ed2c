// radiosity/transfer.h  4  light from a part of a face to a vertex: form factor and visible part
#pragma once
#include "radiosity/map.h"
#include "radiosity/tree.h"
#include "shadow/irradiance.h"

namespace penumbra {

// A receiving point of a face, and the frame of one of its sides.
struct Receiver {
    Surface x;
    Frame local;
    real E = 0;  // irradiance so far
};

// The sending side of a face: its normal, and the rounding error of its points.
struct Source {
    vec3 n;
    real error = 0;
};

// Values at the corners of an element, linear between them.
struct Corners : std::array<rgb, 3> {
    rgb mean() const { return ((*this)[0] + (*this)[1] + (*this)[2]) / 3; }
};

// True if the receiver is within so many radii of a node.
inline bool near(const Receiver& to, const Node& node, real radii) {
    const vec3 d = node.centre - to.x.p;
    return dot(d, d) < sqr(radii * node.radius);
}

// pi L (r / d)^2 is about the most that a node of radius r sends.
inline real max_from(const Receiver& to, const Node& node, real L) {
    const vec3 d = node.centre - to.x.p;
    return pi * L * std::min(real(1), sqr(node.radius) / dot(d, d));
}

// True if all of a node is below the receiver's horizon.
inline bool behind(const Receiver& to, const Node& node) {
    return dot(node.centre - to.x.p, to.x.n) < -node.radius;
}

// A node as the receiver sees it.
inline Polygon seen_from(const Receiver& to, const Node& node) {
    Polygon p;
    for (uint32_t k = 0; k < node.corners; ++k) p.add(to.local.to_local(node.corner[k] - to.x.p));
    return p;
}

// Irradiance from parts of the scene; counts its shadow rays.
class Transfer {
public:
    explicit Transfer(const Scene& scene) : scene_(scene) {}
    uint64_t rays = 0;

    // I cos / d^2, unless occluded.
    rgb from_point(const Receiver& to, const Light& light) {
        const vec3 d = light.p - to.x.p;
        const real cosine = dot(d, to.x.n), d2 = dot(d, d);
        if (!(cosine > 0) || !sees(to, {light.p, {}, 0})) return {};
        return light.L * (cosine / (d2 * std::sqrt(d2)));
    }

    // An element's radiance is linear: near by it is quartered, and each part sends its mean.
    rgb from_element(const Receiver& to, const Source& from, const Node& node, const Corners& L,
                     int depth = 0) {
        constexpr int deepest = 6;
        if (behind(to, node)) return {};
        if (depth == deepest || !near(to, node, 4))
            return from_whole(to, from, node, L.mean(), depth == 0 && near(to, node, 8) ? 4 : 1);
        const auto& [a, b, c, unused] = node.corner;
        const vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
        const rgb Lab = (L[0] + L[1]) / 2, Lbc = (L[1] + L[2]) / 2, Lca = (L[2] + L[0]) / 2;
        auto part = [&](const std::array<vec3, 4>& corner, const Corners& of) {
            return from_element(to, from, node_of(corner, 3), of, depth + 1);
        };
        return part({a, ab, ca}, {{L[0], Lab, Lca}}) + part({ab, b, bc}, {{Lab, L[1], Lbc}}) +
               part({ca, bc, c}, {{Lca, Lbc, L[2]}}) + part({bc, ca, ab}, {{Lbc, Lca, Lab}});
    }

    // A node of constant radiance: its unoccluded irradiance in closed form (Lambert's theorem),
    // times its visible part by one shadow ray or four.
    rgb from_whole(const Receiver& to, const Source& from, const Node& node, rgb L,
                   int shadow_rays) {
        if (max_of(L) <= 0 || behind(to, node)) return {};
        const real visible = visible_part(to, from, node, shadow_rays);
        return visible > 0 ? L * (visible * irradiance_polygon(seen_from(to, node))) : rgb{};
    }

    // Shadow rays go to the centre, or to the centres of four quarters, if these are above the
    // horizon.  If none is, one ray goes to the centre of the part above it.
    real visible_part(const Receiver& to, const Source& from, const Node& node, int shadow_rays) {
        int above = 0, visible = 0;
        auto look_at = [&](vec3 p) {
            if (!(dot(p - to.x.p, to.x.n) > 0)) return;
            ++above;
            visible += sees(to, {p, from.n, from.error});
        };
        if (shadow_rays == 1) look_at(node.centre);
        for (uint32_t k = 0; shadow_rays == 4 && k < 4; ++k) look_at(middle_of_quarter(node, k));
        if (above == 0) look_at(middle_above(to, node));
        return above == 0 ? 0 : real(visible) / real(above);
    }

private:
    const Scene& scene_;

    bool sees(const Receiver& to, const Surface& y) {
        ++rays;
        return !scene_.bvh.occluded(spawn_to(to.x, y));
    }

    // Three quarters of a triangle have one of its corners, the fourth has its centre.
    static vec3 middle_of_quarter(const Node& n, uint32_t k) {
        return k == n.corners ? n.centre : (n.corner[k] + n.centre) / 2;
    }

    static vec3 middle_above(const Receiver& to, const Node& node) {
        const Polygon above = above_horizon(seen_from(to, node));
        vec3 sum;
        for (int k = 0; k < above.n; ++k) sum += above.at(k) / real(above.n);
        return to.x.p + to.local.to_world(sum);
    }
};

}  // namespace penumbra
