// labs/cube.h  1  a room of known radiosity: a cube lit from its centre
//
//   const cube::Solution room;
//   room.luminance(0, 0);  // 892.7981 nit in the middle of a face
//
// The room is a cube of 10 m with walls of reflectance rho = 2/3 and a point light of 50 000 cd at
// its centre (Khodulev's theoretical case).  All six faces are alike.  (x, y) in [-1,1]^2 is a
// point of a face.  Solution solves the integral equation of radiosity
//
//     E(p) = E_direct(p) + rho int E(q) cos cos' / (pi r^2) dA(q)
//
// by collocation: the indirect part of E is a polynomial that satisfies it at the nodes.  At
// distance s from an edge E has a part ~ s^0.69, because the kernel of two faces at a right angle
// maps s^0.69 to 3/2 of it.  Polynomials in x approximate this part badly, those in u well, with
// x = sin(pi/2 sin(pi/2 u)): s falls as (1 - u)^4, and the part as (1 - u)^2.8.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace penumbra::cube {

inline constexpr double pi = std::numbers::pi;
inline constexpr double albedo = 2.0 / 3;
// The mean of E over a face in lx, by conservation of energy: Phi / (A (1 - rho)).
inline constexpr double mean_illuminance = 4 * pi * 50000 / (6 * 100 * (1 - albedo));

inline double direct(double x, double y) { return 2000 / std::pow(1 + x * x + y * y, 1.5); }

// ---- Nodes --------------------------------------------------------------------------------------

// Distances from an edge, in [0, 2]: s in x, w in u.  Differences from 1 would lose all digits.
inline double halfway(double w) { return 2 * std::pow(std::sin(pi / 4 * w), 2); }
inline double s_of_w(double w) { return halfway(halfway(w)); }
inline double ds_dw(double w) {
    return pi * pi / 4 * std::sin(pi / 2 * halfway(w)) * std::sin(pi / 2 * w);
}
inline double w_of_s(double s) {
    auto back = [](double d) { return 4 / pi * std::asin(std::sqrt(d / 2)); };
    return back(back(s));
}

struct Node {
    double at, weight;
};
// The n Gauss-Legendre nodes on [0, 1], ascending, by Newton's method from Tricomi's estimate.
inline std::vector<Node> gauss(int n) {
    std::vector<Node> rule;
    for (int i = 0; i < n; ++i) {
        double t = std::cos(pi * (i + 0.75) / (n + 0.5)), derivative = 1;
        for (int step = 0; step < 8; ++step) {
            double p = t, before = 1;
            for (int k = 2; k <= n; ++k) {
                const double next = ((2 * k - 1) * t * p - (k - 1) * before) / k;
                before = p, p = next;
            }
            derivative = n * (t * p - before) / (t * t - 1);
            t -= p / derivative;
        }
        rule.push_back({(1 - t) / 2, 1 / ((1 - t * t) * derivative * derivative)});
    }
    return rule;
}

// A node at distances `at` from 0 and `rest` from 1.  Nodes crowd at both ends of [0, 1] as s(w).
struct Graded {
    double at, rest, weight;
};
inline std::vector<Graded> graded(int n) {
    std::vector<Graded> rule;
    for (const Node& g : gauss(n))
        rule.push_back(
            {s_of_w(2 * g.at) / 2, s_of_w(2 - 2 * g.at) / 2, ds_dw(2 * g.at) * g.weight});
    return rule;
}

// ---- Solution -----------------------------------------------------------------------------------

// Numbers of nodes: from the middle of a face to its edge, and for integrals over a piece across a
// face and over a line along an edge.
struct Fineness {
    int nodes = 24, across = 12, along = 32;
};

class Solution {
public:
    explicit Solution(const Fineness& f = {})
        : n_(size_t(f.nodes)), across_(gauss(f.across)), along_(graded(f.along)) {
        const std::vector<Node> rule = gauss(2 * f.nodes);
        for (size_t i = 0; i < n_; ++i) {
            const double w = 2 * rule[i].at, weight = 2 * rule[i].weight;
            w_.push_back(w), s_.push_back(s_of_w(w)), weight_.push_back(weight * ds_dw(w));
            // Weights by Berrut, Trefethen 2004, times u: nodes of both signs are one node in u^2.
            barycentric_.push_back((i % 2 ? -1 : 1) * (1 - w) * std::sqrt(w * (2 - w) * weight));
        }
        solve();
    }

    // E in lx at a point of the face or its edges.  On an edge the equation gives it, because the
    // polynomial ends at its last node, 10^-12 from the edge.
    double illuminance(double x, double y) const {
        const double s = std::max(0.0, 1 - std::abs(x)), t = std::max(0.0, 1 - std::abs(y));
        if (s == 0 || t == 0) return by_equation(x, y);
        std::vector<double> p(n_), q(n_);
        basis(w_of_s(s), p), basis(w_of_s(t), q);
        double sum = direct(x, y);
        for (size_t k = 0; k < n_ * n_; ++k) sum += p[k / n_] * q[k % n_] * indirect_[k];
        return sum;
    }
    // L in nit at a point of the face.
    double luminance(double x, double y) const { return albedo / pi * illuminance(x, y); }

    // E by the right-hand side of the equation, with the polynomial in the integral.  The
    // difference from illuminance() is the residual.
    double by_equation(double x, double y) const {
        const double s = std::max(0.0, 1 - std::abs(x)), t = std::max(0.0, 1 - std::abs(y));
        const Received r = received(s, t);
        double sum = r.direct;
        for (size_t k = 0; k < n_ * n_; ++k) sum += r.factor[k] * indirect_[k];
        return (direct(x, y) + albedo * sum) / (1 - albedo * r.own);
    }

    // The form factor from a point to everything visible.  The exact value is 1.
    double closure(double x, double y) const {
        const Received r = received(1 - std::abs(x), 1 - std::abs(y));
        double sum = r.own;
        for (double factor : r.factor) sum += factor;
        return sum;
    }

private:
    size_t n_;
    std::vector<Node> across_;
    std::vector<Graded> along_;
    std::vector<double> w_, s_, weight_, barycentric_;  // nodes in u > 0, from the edge inwards
    std::vector<double> indirect_;                      // the indirect part of E at (s_[i], s_[j])

    // The light that a point receives: per node a factor of indirect light; the share of direct
    // light; `own`, the part of its hemisphere that adjacent faces fill in the limit, 1/2 on an
    // edge and 3/4 in a corner.  They send what the point sends.
    struct Received {
        std::vector<double> factor;
        double direct = 0, own = 0;
    };

    // Evaluates, at u = 1 - w, the polynomials in u^2 that are 1 at one node and 0 at the others.
    void basis(double w, std::vector<double>& values) const {
        const double near = std::min(w, 2 - w);
        double sum = 0;
        for (size_t i = 0; i < n_; ++i) {
            const double off = (w_[i] - near) * (2 - near - w_[i]);
            if (off == 0) {
                values.assign(n_, 0);
                values[i] = 1;
                return;
            }
            sum += values[i] = barycentric_[i] / off;
        }
        for (double& value : values) value /= sum;
    }

    // Adds the light from the opposite face, at distance 2.
    void add_opposite(Received& r, double x, double y) const {
        for (size_t k = 0; k < n_ * n_; ++k) {
            const double a = 1 - s_[k / n_], b = 1 - s_[k % n_];
            double factor = 0;
            for (double dx : {x - a, x + a})
                for (double dy : {y - b, y + b})
                    factor += 4 / (pi * std::pow(4 + dx * dx + dy * dy, 2));
            factor *= weight_[k / n_] * weight_[k % n_];
            r.factor[k] += factor;
            r.direct += factor * direct(a, b);
        }
    }

    // A line at distance R from the receiver and t from the edge, with ends at distances a and b.
    struct Line {
        double R, a, b, t;
    };
    // Adds the light from the face beyond an edge at distance s, with ends at distances a and b.
    // There t is the distance from the edge, and y' runs along it.  With R^2 = s^2 + t^2 and
    // y' = y + R tan(theta), the kernel s t dy' / (pi (R^2 + (y' - y)^2)^2) is
    // s t / (pi R^3) cos^2(theta) dtheta.  It is as smooth near the edge as far from it.
    void add_adjacent(Received& r, double s, double a, double b) const {
        std::vector<double> here(n_), line(n_), value(n_);
        // The rest of the integrand is singular near t = +-i s, pi/8 off the real axis of w.
        double to = std::min(0.5, w_of_s(s) / 2);
        for (double from = 0; from < 2; from = to, to = std::min({2.0, 1.5 * to, to + 0.5}))
            for (const Node& g : across_) {
                const double w = from + (to - from) * g.at, t = s_of_w(w), R = std::hypot(s, t);
                const double k = s * t / (pi * R * R * R) * ds_dw(w) * (to - from) * g.weight;
                r.direct += k * sum_line({R, a, b, t}, line, value);
                basis(w, here);
                for (size_t i = 0; i < n_ * n_; ++i) r.factor[i] += k * here[i / n_] * line[i % n_];
            }
    }
    // Integrates each polynomial and direct light along a line, by the weight cos^2(theta) dtheta.
    double sum_line(const Line& l, std::vector<double>& line, std::vector<double>& value) const {
        const double top = std::atan2(l.a, l.R), whole = top + std::atan2(l.b, l.R);
        double of_direct = 0;
        line.assign(n_, 0);
        for (const Graded& g : along_) {
            // d = R (tan(top) - tan(theta)) is the distance from one end, without cancellation.
            const double angle = whole * g.at, c = std::cos(top - angle);
            const double d = std::min(2.0, std::sin(angle) * std::hypot(l.a, l.R) / c);
            const double weight = whole * g.weight * c * c;
            basis(w_of_s(d), value);
            for (size_t j = 0; j < n_; ++j) line[j] += weight * value[j];
            of_direct += weight * direct(1 - l.t, 1 - d);
        }
        return of_direct;
    }

    Received received(double s, double t) const {
        Received r{std::vector<double>(n_ * n_)};
        r.own = s == 0 && t == 0 ? 0.75 : s == 0 || t == 0 ? 0.5 : 0;
        add_opposite(r, 1 - s, 1 - t);
        if (s > 0) add_adjacent(r, s, t, 2 - t);
        if (t > 0) add_adjacent(r, t, s, 2 - s);
        add_adjacent(r, 2 - s, t, 2 - t);
        add_adjacent(r, 2 - t, s, 2 - s);
        return r;
    }

    // Adds bounces, each 2/3 of the one before.  Uses the symmetry E(x, y) = E(y, x).
    void solve() {
        std::vector<Received> rows;
        for (size_t i = 0; i < n_; ++i)
            for (size_t j = 0; j <= i; ++j) rows.push_back(received(s_[i], s_[j]));
        indirect_.assign(n_ * n_, 0);
        for (int bounce = 0; bounce < 90; ++bounce) {
            std::vector<double> next(n_ * n_);
            const Received* row = rows.data();
            for (size_t i = 0; i < n_; ++i)
                for (size_t j = 0; j <= i; ++j, ++row) {
                    double sum = row->direct;
                    for (size_t k = 0; k < n_ * n_; ++k) sum += row->factor[k] * indirect_[k];
                    next[i * n_ + j] = next[j * n_ + i] = albedo * sum;
                }
            indirect_ = next;
        }
    }
};

// ---- Integrals ----------------------------------------------------------------------------------

struct Point {
    double x, y;
};
// The integral of L (nit) times f(x, y), a number or rgb, over a triangle of the face (area 4).
// The n^2 nodes crowd towards the sides, which may lie on edges of the cube.  For n = 16 the error
// is 3e-5 for half a face, and below 10^-8 for triangles of a grid of 4 x 4 and finer.
template <class F>
auto integral(const Solution& room, const std::array<Point, 3>& corners, F f, int n = 16) {
    const auto [a, b, c] = corners;
    const double twice_area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    const std::vector<Graded> rule = graded(n);
    decltype(f(0.0, 0.0) * 1.0) sum{};
    for (const Graded& u : rule)
        for (const Graded& v : rule) {
            const double of_b = u.at * v.rest, of_c = u.at * v.at;
            const Point p{u.rest * a.x + of_b * b.x + of_c * c.x,
                          u.rest * a.y + of_b * b.y + of_c * c.y};
            sum += f(p.x, p.y) * (u.weight * u.at * v.weight * room.luminance(p.x, p.y));
        }
    return sum * twice_area;
}

}  // namespace penumbra::cube
