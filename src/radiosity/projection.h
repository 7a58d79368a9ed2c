// radiosity/projection.h  4  from integrals of linear basis functions to illumination maps
//
// Particles estimate b_v = integral of E h_v over a face, with the hat function h_v of vertex v: 1
// there, 0 at all others, linear between.  Two maps are linear in b, so that unbiased sums make
// unbiased maps of these functionals of E:
//   mean: b_v divided by the integral of the hat.  At a border the hat lies on one side of its
//   vertex, so the error is of first order in the mesh;
//   projection: the piecewise linear function nearest to E in the L2 norm, M x = b with M_vw the
//   integral of h_v h_w.  For a smooth E it is of second order everywhere.  Near a sharp border of
//   light, and by noise, it overshoots and may be negative; clamping it would be biased.
#pragma once
#include "radiosity/map.h"

namespace penumbra {

enum class Functional { projection, mean };

// Sums of b on one side of every vertex of a face.
using Sums = std::vector<rgb>;

class Projection {
public:
    Projection(const Mesh& mesh, const Face& face)
        : mesh_(mesh),
          face_(face),
          hat_(face.vertices()),
          part_(face.area() / real(face.elements())) {
        each([&](size_t a, size_t b, size_t c) {
            for (size_t v : {a, b, c}) hat_[v] += part_ / 3;
        });
    }

    // The projection within a part `precise` of itself.
    Sums operator()(const Sums& b, Functional f, real precise = ulp) const {
        if (f == Functional::projection) return solve(b, precise);
        Sums x = b;
        for (size_t v = 0; v < x.size(); ++v) x[v] /= hat_[v];
        return x;
    }

    // Integral of the product of two maps, per channel: x M y.
    rgb product(const Sums& x, const Sums& y) const { return dot_of(x, apply(y)); }
    rgb square(const Sums& x) const { return product(x, x); }

private:
    const Mesh& mesh_;
    const Face& face_;
    std::vector<real> hat_;  // integrals of the hats
    const real part_;        // area of an element

    template <class Visit>
    void each(Visit visit) const {
        for (uint32_t e = face_.element; e < face_.element + face_.elements(); ++e) {
            const auto& [a, b, c] = mesh_.corners[e];
            visit(a - face_.vertex, b - face_.vertex, c - face_.vertex);
        }
    }

    // M x; of an element M is its area / 12 times (2 1 1, 1 2 1, 1 1 2).
    Sums apply(const Sums& x) const {
        Sums y(x.size());
        each([&](size_t a, size_t b, size_t c) {
            const rgb sum = x[a] + x[b] + x[c];
            for (size_t v : {a, b, c}) y[v] += (sum + x[v]) * (part_ / 12);
        });
        return y;
    }

    static rgb dot_of(const Sums& a, const Sums& b) {
        rgb sum;
        for (size_t v = 0; v < a.size(); ++v) sum += a[v] * b[v];
        return sum;
    }

    // Conjugate gradients (Hestenes, Stiefel 1952), preconditioned by the hats.  The eigenvalues of
    // the preconditioned M lie in [1/4, 1] whatever the mesh (Wathen 1987): every iteration divides
    // the error by 3.
    Sums solve(const Sums& b, real precise) const {
        constexpr int iterations = std::numeric_limits<real>::digits * 2 / 3;
        auto over = [](rgb a, rgb by) {
            return rgb{by.x > 0 ? a.x / by.x : 0, by.y > 0 ? a.y / by.y : 0,
                       by.z > 0 ? a.z / by.z : 0};
        };
        Sums x(b.size()), r = b, z(b.size());
        auto precondition = [&] {
            for (size_t v = 0; v < z.size(); ++v) z[v] = r[v] / hat_[v];
        };
        precondition();
        Sums p = z;
        rgb rz = dot_of(r, z);
        const real enough = sqr(precise) * max_of(rz);
        for (int k = 0; k < iterations && max_of(rz) > enough; ++k) {
            const Sums q = apply(p);
            const rgb alpha = over(rz, dot_of(p, q));
            for (size_t v = 0; v < x.size(); ++v) x[v] += alpha * p[v], r[v] += -alpha * q[v];
            precondition();
            const rgb next = dot_of(r, z), beta = over(next, rz);
            for (size_t v = 0; v < p.size(); ++v) p[v] = z[v] + beta * p[v];
            rz = next;
        }
        return x;
    }
};

}  // namespace penumbra
