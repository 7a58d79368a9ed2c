// voronoi/weights.h  5  samples of a square weighted by their Voronoi cells
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "base/rng.h"
#include "voronoi/voronoi.h"

namespace penumbra {

// The mean of samples x_1 ... x_n, independent and uniform in the unit square: the sum of
// w_i f(x_i), with weights that add up to 1.  A_i is the area of the cell of x_i.
enum class Weighting {
    mc,    // 1/n.  Unbiased.
    vor,   // A_i / sum A, cells bounded by random sites in a strip around the square.  Consistent.
    fvor,  // the same without the cells that reach beyond the strip.  Consistent.
    cvor,  // A_i, clipped to the square.  Consistent: bias O(1/n), see border_correction.
    torus  // A_i, the square repeated.  Unbiased: all sites are alike.
};

// Width of the strip that leaves a cell of a Poisson process of intensity n unbounded with a
// probability of at most p: the circumscribed radius of the typical cell exceeds r with at most
// 4 u e^-u, u = pi n r^2 (Calka 2002), so that n 4 u e^-u = p or u = ln(4 n / p) + ln u.
inline double strip_width(double n, double p = 1e-3) {
    double u = std::log(4 * n / p);
    for (int k = 0; k < 60; ++k) u = std::log(4 * n / p) + std::log(u);
    return std::sqrt(u / (std::numbers::pi * n));
}

// Number of points of a Poisson process of that mean (Knuth 1969; large means in parts).
inline uint64_t poisson(double mean, Rng& random) {
    uint64_t n = 0;
    for (; mean > 0; mean -= 16) {
        const double least = std::exp(-std::min(mean, 16.0));
        for (double p = 1;; ++n) {
            p *= random.uniform();
            if (p <= least) break;
        }
    }
    return n;
}

// Gradient at site i of values given at all sites: the least-squares plane through its own value to
// those of its Voronoi neighbours.  It is 0 if they are nearly collinear: the smaller principal
// moment of their differences is less than a thousandth of the larger.  Errors grow as one over the
// angle between two neighbours; without this limit their variance would be infinite.
inline Site gradient(const Voronoi& cells, std::span<const Site> sites, std::span<const double> f,
                     size_t i) {
    double xx = 0, xy = 0, yy = 0, xf = 0, yf = 0;
    for (uint32_t j : cells.neighbours(i)) {
        const double dx = sites[j].x - sites[i].x, dy = sites[j].y - sites[i].y, df = f[j] - f[i];
        xx += dx * dx, xy += dx * dy, yy += dy * dy;
        xf += dx * df, yf += dy * df;
    }
    const double det = xx * yy - xy * xy, trace = xx + yy;
    if (!(det > 1e-3 * trace * trace)) return {};
    return {(yy * xf - xy * yf) / det, (xx * yf - xy * xf) / det};
}

// The bias of clipped cells.  Inside, the nearest site is at a mean square distance of 1/(pi n) and
// in no preferred direction: Laplacian/(4 pi n).  Near a border it is on the inner side: with
// intensity 1 in a half-plane, its displacement integrates to 1/(2 pi) per unit of border, hence
// -1/(2 pi n) times the integral of the outward derivative, which is that of the Laplacian (Gauss).
//   E cvor - integral of f = -1/(4 pi n) (integral over the border of the outward derivative)
// to first order in 1/n.  This sum over the cells at the border estimates the correction; gradients
// need only the neighbours.  The remaining bias is O(n^-3/2) for smooth f.
inline double border_correction(const Voronoi& clipped, const std::vector<VoronoiCell>& cells,
                                std::span<const Site> sites, std::span<const double> f) {
    double sum = 0;
    for (size_t i = 0; i < sites.size(); ++i) {
        const Site rim = cells[i].rim;
        if (rim.x == 0 && rim.y == 0) continue;
        const Site g = gradient(clipped, sites, f, i);
        sum += g.x * rim.x + g.y * rim.y;
    }
    return sum / (4 * std::numbers::pi * double(sites.size()));
}

// sum A_i (f_i + grad f_i . (centroid - x_i)): exact where f is linear.
inline double linear_reconstruction(const Voronoi& clipped, const std::vector<VoronoiCell>& cells,
                                    std::span<const Site> sites, std::span<const double> f) {
    double sum = 0;
    for (size_t i = 0; i < sites.size(); ++i) {
        const Site g = gradient(clipped, sites, f, i), d = cells[i].offset;
        sum += cells[i].area * (f[i] + g.x * d.x + g.y * d.y);
    }
    return sum;
}

// Keeps its memory from one square to the next.
class Weigher {
public:
    double intensity =
        0;  // the strip has a Poisson number of sites; 0: as many as the samples demand
    double unbounded = 1e-3;  // probability that the strip does not bound every cell
    bool divide = true;       // false: vor and fvor stay areas, whatever their sum
    // Number of strips that were redrawn because they left a cell unbounded.  The samples are never
    // redrawn.
    uint64_t redraws = 0;
    uint64_t fallbacks = 0;  // to 1/n: fvor left no cell, vor had 100 redraws
    uint64_t unsettled = 0;  // cells that sites beyond the strip could have changed

    Voronoi cells;

    // Weights of these samples of [0,1)^2; `key` gives the strip its random numbers.
    const std::vector<double>& operator()(Weighting kind, std::span<const Site> samples,
                                          uint64_t key) {
        constexpr Rectangle square = {{0, 0}, {1, 1}};
        weights_.assign(samples.size(), 1 / double(samples.size()));
        if (kind == Weighting::mc) return weights_;
        if (kind == Weighting::vor || kind == Weighting::fvor) return by_strip(kind, samples, key);
        const auto& found =
            kind == Weighting::cvor ? cells.clipped(samples, square) : cells.torus(samples, square);
        for (size_t i = 0; i < samples.size(); ++i) weights_[i] = found[i].area;
        return weights_;
    }

private:
    std::vector<double> weights_;
    std::vector<Site> sites_;

    // Four rectangles around the square, each from one corner to beyond the next.
    static Site in_strip(double width, Rng& random) {
        const uint64_t side = random.bits() >> 62;
        const double along = random.uniform() * (1 + width), away = -width * random.uniform();
        switch (side) {
            case 0: return {along, away};
            case 1: return {1 - away, along};
            case 2: return {1 - along, 1 - away};
            default: return {away, 1 - along};
        }
    }

    const std::vector<double>& by_strip(Weighting kind, std::span<const Site> samples,
                                        uint64_t key) {
        const double n = intensity > 0 ? intensity : double(samples.size());
        const double width = strip_width(n, unbounded), mean = n * 4 * width * (1 + width);
        Rng random{key};
        for (int attempt = 0; attempt < 100; ++attempt, ++redraws) {
            sites_.assign(samples.begin(), samples.end());
            const uint64_t m = intensity > 0 ? poisson(mean, random) : uint64_t(mean + 0.5);
            for (uint64_t k = 0; k < m; ++k) sites_.push_back(in_strip(width, random));
            const auto& found =
                cells.stretched(sites_, samples.size(), {{-width, -width}, {1 + width, 1 + width}});
            double sum = 0;
            bool all_bounded = true;
            for (size_t i = 0; i < samples.size(); ++i) {
                const bool counts = kind == Weighting::vor ? found[i].bounded : found[i].inside;
                all_bounded = all_bounded && found[i].bounded;
                weights_[i] = counts ? found[i].area : 0;
                sum += weights_[i];
            }
            if (kind == Weighting::vor && !all_bounded) continue;
            for (const VoronoiCell& c : found) unsettled += !c.settled;
            if (sum > 0) {
                for (double& w : weights_) w /= divide ? sum : 1;
                return weights_;
            }
            break;
        }
        ++fallbacks;
        weights_.assign(samples.size(), 1 / double(samples.size()));
        return weights_;
    }
};

}  // namespace penumbra
