// voronoi/plane.h  1  sites and rectangles of the plane, in double whatever `real` is
#pragma once
#include <algorithm>

namespace penumbra {

// Areas of cells are to add up to that of the window, to 1e-12 n of it: float could not.
struct Site {
    double x = 0, y = 0;
};
inline Site operator-(Site a, Site b) { return {a.x - b.x, a.y - b.y}; }

struct Rectangle {
    Site lo, hi;

    double width() const { return hi.x - lo.x; }
    double height() const { return hi.y - lo.y; }
    double area() const { return width() * height(); }
    bool contains(Site p) const {  // false for NaN
        return lo.x <= p.x && lo.y <= p.y && p.x <= hi.x && p.y <= hi.y;
    }
    bool contains(const Rectangle& r) const { return contains(r.lo) && contains(r.hi); }
};
inline Rectangle grown(const Rectangle& r, double by) {
    return {{r.lo.x - by, r.lo.y - by}, {r.hi.x + by, r.hi.y + by}};
}
inline Rectangle seen_from(Site site, const Rectangle& r) { return {r.lo - site, r.hi - site}; }

// Square of the distance of a point from a rectangle.
inline double distance2(const Rectangle& r, Site p) {
    const double x = std::max({r.lo.x - p.x, p.x - r.hi.x, 0.0}),
                 y = std::max({r.lo.y - p.y, p.y - r.hi.y, 0.0});
    return x * x + y * y;
}

}  // namespace penumbra
