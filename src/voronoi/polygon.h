// voronoi/polygon.h  2  convex polygons around a site: cut by lines, and measured
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "voronoi/plane.h"

namespace penumbra {

// A corner of a cell, from its site; the edge from there to the next corner, counterclockwise, is
// due to that neighbour (-1: the window).
struct Corner {
    Site p;
    int32_t neighbour = -1;
    bool stays = false;  // no site is nearer to it
};
using Outline = std::span<const Corner>;

// Points v with d v <= h, from the site.  The neighbour at d leaves those that are not nearer to
// it, h = d d / 2.  Differences d are exact, so that both sites see the same line.
struct HalfPlane {
    Site d;
    double h = 0;
    int32_t neighbour = -1;
};
inline HalfPlane bisector(Site d, uint32_t neighbour) {
    return {d, (d.x * d.x + d.y * d.y) * 0.5, int32_t(neighbour)};
}

// ---- Cut ----------------------------------------------------------------------------------------

// Clips by one half-plane after another (Sutherland, Hodgman 1974).  Keeps its memory.
class ConvexPolygon {
public:
    void start(const Rectangle& box) {
        corners_.clear();
        corners_.push_back({box.lo});
        corners_.push_back({{box.hi.x, box.lo.y}});
        corners_.push_back({box.hi});
        corners_.push_back({{box.lo.x, box.hi.y}});
    }

    // Leaves the points with d v <= h; what was cut off has an edge due to that neighbour.
    void cut(const HalfPlane& by) {
        // exercise V.1
        excess_.clear();
        bool any = false;
        for (const Corner& c : corners_) {
            excess_.push_back(by.d.x * c.p.x + by.d.y * c.p.y - by.h);
            any = any || excess_.back() > 0;
        }
        if (!any) return;
        next_.clear();
        for (size_t k = 0; k < corners_.size(); ++k) {
            const size_t l = k + 1 < corners_.size() ? k + 1 : 0;
            const Corner &c = corners_[k], &d = corners_[l];
            const bool out = excess_[k] > 0, leaves = excess_[l] > 0;
            if (!out) next_.push_back(c);
            if (out == leaves) continue;
            const double t = excess_[k] / (excess_[k] - excess_[l]);
            next_.push_back({{c.p.x + t * (d.p.x - c.p.x), c.p.y + t * (d.p.y - c.p.y)},
                             leaves ? by.neighbour : c.neighbour});
        }
        if (next_.size() < 3) return;  // only by rounding: the site itself stays inside
        corners_.swap(next_);
        next_.reserve(corners_.capacity());  // alike, so that their memory is enough next time
        // end
    }

    Outline outline() const { return corners_; }

    // The next corner that is not known to stay, if there is one.
    Corner* open_corner() {
        const auto open = std::find_if(corners_.begin(), corners_.end(),
                                       [](const Corner& c) { return !c.stays; });
        return open == corners_.end() ? nullptr : &*open;
    }

private:
    std::vector<Corner> corners_, next_;
    std::vector<double> excess_;
};

// ---- Measured -----------------------------------------------------------------------------------

// The points of the window that are nearer to one site than to all others; lengths and areas in
// units of the window's own.
struct VoronoiCell {
    double area = 0;
    Site rim;     // sum over its edges on the window's border: length x outward normal
    Site offset;  // from the site to the centroid
    // In a stretched window and on a torus.  They may be wrong where many sites are within rounding
    // of each other.
    bool bounded = true;  // reaches not beyond twice the domain's size around it
    bool inside = true;   // is all in the domain
    bool settled = true;  // no site outside the domain could change it
    uint32_t copies = 1;  // sites at the same place share area and rim equally
};

namespace voronoi {

inline VoronoiCell measured(Outline corners) {
    VoronoiCell cell;
    Corner from = corners.back();
    for (const Corner& to : corners) {
        if (from.neighbour < 0)
            cell.rim = {cell.rim.x + to.p.y - from.p.y, cell.rim.y - to.p.x + from.p.x};
        from = to;
    }
    // exercise V.2
    // A sum over triangles (site, corner, next corner).
    double twice = 0, six_x = 0, six_y = 0;
    Corner c = corners.back();
    for (const Corner& next : corners) {
        const double cross = c.p.x * next.p.y - next.p.x * c.p.y;
        twice += cross;
        six_x += cross * (c.p.x + next.p.x);
        six_y += cross * (c.p.y + next.p.y);
        c = next;
    }
    cell.area = twice / 2;
    if (twice > 0) cell.offset = {six_x / (3 * twice), six_y / (3 * twice)};
    // end
    return cell;
}

}  // namespace voronoi

}  // namespace penumbra
