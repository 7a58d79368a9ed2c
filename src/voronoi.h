// voronoi.h  floor 2  the areas of Voronoi cells in a window of the plane
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "cell.h"
#include "sites.h"

// The points of the window that are nearer to one site than to all others.
struct VoronoiCell {
    double area = 0;
    Site rim;             // sum over its edges on the window's border: length x outward normal
    Site offset;          // of the centroid, from the site
    bool bounded = true;  // stretched: reaches not beyond twice the domain's size around it
    bool inside = true;   // stretched: is all in the domain
    bool settled = true;  // no site outside the domain could change it
    uint32_t copies = 1;  // sites at the same place share the area equally
};

namespace voronoi {

// Area and centroid by triangles (site, corner, next corner): none is negative.
inline VoronoiCell measured(Outline corners) {
    VoronoiCell cell;
    double twice = 0, six_x = 0, six_y = 0;
    Corner c = corners.back();
    for (const Corner& next : corners) {
        const double cross = c.p.x * next.p.y - next.p.x * c.p.y;
        twice += cross;
        six_x += cross * (c.p.x + next.p.x);
        six_y += cross * (c.p.y + next.p.y);
        if (c.neighbour < 0)
            cell.rim = {cell.rim.x + next.p.y - c.p.y, cell.rim.y - next.p.x + c.p.x};
        c = next;
    }
    cell.area = twice / 2;
    if (twice > 0) cell.offset = {six_x / (3 * twice), six_y / (3 * twice)};
    return cell;
}

}  // namespace voronoi

// Cells of sites in a window, each by itself: a polygon that the sites around clip, nearest first,
// until none is left that could reach it.  Areas are continuous in the sites, so rounding, ties and
// near-ties cost digits of the 16th place and nothing else.  Sites are rounded to 2^-50 of the
// window's greater side.  Linear expected time for scattered sites, by buckets; O(n log n) for
// clustered or collinear ones, by a tree.  Keeps its memory for the next call.
class Voronoi {
public:
    bool with_neighbours = false;  // whether neighbours(i) is to be had

    // Clipped to the window, in which all sites are.
    const std::vector<VoronoiCell>& clipped(std::span<const Site> sites, const Rectangle& window) {
        begin(sites, sites.size(), window, window);
        add_sites(sites);
        frame_ = domain_;
        return tessellate();
    }

    // The first `inner` of the sites; the others only bound their cells.  All are in the domain.
    const std::vector<VoronoiCell>& stretched(std::span<const Site> sites, size_t inner,
                                              const Rectangle& domain) {
        begin(sites, inner, domain, domain);
        add_sites(sites);
        frame_ = grown(domain_, 2);
        check_reach_ = true;
        return tessellate();
    }

    // The window is repeated in both directions.
    const std::vector<VoronoiCell>& torus(std::span<const Site> sites, const Rectangle& window) {
        const double w = window.width(), h = window.height(), side = std::max(w, h);
        // No flower reaches farther: a cell's corners are within half a diagonal.
        const double enough = (side + std::hypot(w, h)) / 2 * (1 + 1e-9);
        double margin = 4 * std::sqrt(window.area() / double(std::max<size_t>(sites.size(), 1)));
        for (bool settled = false; !settled; margin *= 2) {
            margin = std::min(margin, enough);
            begin(sites, sites.size(), window, grown(window, margin));
            add_sites(sites);
            add_copies(w / side, h / side);
            frame_ = {{-0.5 * w / side, -0.5 * h / side}, {0.5 * w / side, 0.5 * h / side}};
            relative_ = check_reach_ = true;
            tessellate();
            settled = margin == enough ||
                      std::all_of(cells_.begin(), cells_.end(), [](auto& c) { return c.settled; });
        }
        return cells_;
    }

    // The sites that share an edge with site i, in order; windows are left out.
    std::span<const uint32_t> neighbours(size_t i) const {
        return {neighbours_.data() + first_neighbour_[i], neighbour_count_[i]};
    }

private:
    static constexpr int most_rings = 12;  // of buckets, before the tree takes over

    std::vector<VoronoiCell> cells_;
    std::vector<uint32_t> neighbours_, first_neighbour_, neighbour_count_;

    Site origin_;  // of the window; in units of its greater side:
    double unit_ = 1;
    Rectangle domain_;          // where all sites are
    Rectangle frame_;           // every cell is cut from this,
    bool relative_ = false;     // or from this moved to its site
    bool check_reach_ = false;  // whether cells may depend on what is outside the domain
    size_t inner_ = 0;          // sites whose cells are asked for
    std::vector<Site> raw_;     // all sites
    Buckets sites_;             // all that are alone or the first at their place
    SiteTree tree_;             // of these; empty until it is needed
    HalfPlanes lines_;
    ConvexPolygon polygon_;
    std::vector<uint32_t> first_of_;  // the first site at the same place; empty: all are alone
    std::vector<uint32_t> order_, copies_;

    // ---- Sites --------------------------------------------------------------------------------

    void begin(std::span<const Site> sites, size_t inner, const Rectangle& window,
               const Rectangle& domain) {
        if (sites.size() > UINT32_MAX / 32) throw std::length_error("voronoi: too many sites");
        origin_ = window.lo;
        unit_ = std::max(window.width(), window.height());
        domain_ = {rounded(domain.lo), rounded(domain.hi)};
        relative_ = check_reach_ = false;
        inner_ = inner;
        raw_.clear();
        cells_.resize(inner);
    }

    // To 2^-50, so that differences are exact and squares of them do not vanish.
    Site rounded(Site p) const {
        return {((p.x - origin_.x) / unit_ + 4) - 4, ((p.y - origin_.y) / unit_ + 4) - 4};
    }

    void add_sites(std::span<const Site> sites) {
        bool out = false;
        for (const Site& site : sites) {
            const Site p = rounded(site);
            out = out || !domain_.contains(p);
            raw_.push_back(p);
        }
        if (out) throw std::domain_error("voronoi: a site outside the window");
    }

    void add_copies(double w, double h) {
        w = (w + 4) - 4, h = (h + 4) - 4;
        const int columns = int(std::ceil(-domain_.lo.x / w)),
                  rows = int(std::ceil(-domain_.lo.y / h));
        for (int j = -rows; j <= rows; ++j)
            for (int i = -columns; i <= columns; ++i)
                for (size_t k = 0; k < inner_ && (i != 0 || j != 0); ++k) {
                    const Site p = {raw_[k].x + i * w, raw_[k].y + j * h};
                    if (domain_.contains(p)) raw_.push_back(p);
                }
    }

    // ---- Cells --------------------------------------------------------------------------------

    const std::vector<VoronoiCell>& tessellate() {
        if (!(domain_.width() > 0 && domain_.height() > 0))
            throw std::domain_error("voronoi: an empty window");
        first_of_.clear();
        if (all_cells()) return cells_;
        find_copies();
        all_cells();
        share();
        return cells_;
    }

    // False if two sites are at the same place.
    bool all_cells() {
        sites_.sort(raw_, first_of_, domain_);
        tree_.clear();
        neighbours_.clear();
        if (with_neighbours) {
            first_neighbour_.resize(inner_);
            neighbour_count_.resize(inner_);
        }
        for (int y = 0; y < sites_.rows; ++y)
            for (int x = 0; x < sites_.columns; ++x)
                for (uint32_t i = sites_.start(x, y); i < sites_.start(x + 1, y); ++i)
                    if (sites_.id[i] < inner_ && !cell(i, x, y)) return false;
        return true;
    }

    enum class Outcome { done, duplicate, too_much };

    bool cell(uint32_t i, int x, int y) {
        // Neighbours in the plane are far apart in memory: fetched while the cell is being made.
        const VoronoiCell* const place = &cells_[sites_.id[i]];
        __builtin_prefetch(place, 1);
        __builtin_prefetch(place + 1, 1);
        Outcome outcome = wrap(i, x, y);
        if (outcome == Outcome::too_much) outcome = cut(i);
        return outcome == Outcome::done;
    }

    Rectangle frame(Site site) const { return relative_ ? frame_ : seen_from(site, frame_); }

    // By the sites of its bucket and of those around, ring by ring as far as the flower reaches.
    Outcome wrap(uint32_t i, int x, int y) {
        using enum Outcome;
        const Site site = sites_.site(i);
        const int last_x = sites_.columns - 1, last_y = sites_.rows - 1;
        auto gather = [&](int x0, int x1, int at) {
            return lines_.add(sites_.x.data(), sites_.y.data(), sites_.start(x0, at),
                              sites_.start(x1 + 1, at), site);
        };
        lines_.start(frame(site));
        const int west = std::max(x - 1, 0), east = std::min(x + 1, last_x);
        if (y > 0 && !gather(west, east, y - 1)) return too_much;
        const int self = lines_.size() + int(i - sites_.start(west, y));
        if (!gather(west, east, y)) return too_much;
        if (y < last_y && !gather(west, east, y + 1)) return too_much;
        lines_.remove(self);
        const int nearest = lines_.nearest();
        if (lines_.is_copy(nearest)) return duplicate;
        Outline outline = lines_.wrap(nearest);
        for (int ring = 2;; ++ring) {
            if (outline.empty()) return too_much;
            const Rectangle flower = flower_box(outline);
            const bool left = x >= ring && site.x + flower.lo.x < sites_.left(x - ring + 1),
                       right = x + ring <= last_x && site.x + flower.hi.x > sites_.left(x + ring),
                       below = y >= ring && site.y + flower.lo.y < sites_.bottom(y - ring + 1),
                       above = y + ring <= last_y && site.y + flower.hi.y > sites_.bottom(y + ring);
            if (!(left || right || below || above)) break;
            if (ring > most_rings) return too_much;
            const int before = lines_.size();
            const int x0 = std::max(x - ring + !left, 0), x1 = std::min(x + ring - !right, last_x),
                      y0 = std::max(y - ring + 1, 0), y1 = std::min(y + ring - 1, last_y);
            if (below && !gather(x0, x1, y - ring)) return too_much;
            if (above && !gather(x0, x1, y + ring)) return too_much;
            for (int at = y0; at <= y1 && (left || right); ++at) {
                if (left && !gather(x - ring, x - ring, at)) return too_much;
                if (right && !gather(x + ring, x + ring, at)) return too_much;
            }
            lines_.keep_cutters(before, outline);
            if (lines_.size() > before) outline = lines_.wrap(lines_.nearest());
        }
        finish(outline, i);
        return done;
    }

    // By the sites of all boxes of the tree that meet the flower.
    Outcome cut(uint32_t i) {
        if (tree_.empty()) tree_.grow(sites_);
        const Site site = sites_.site(i);
        polygon_.start(frame(site));
        auto meets = [&](const Rectangle& box) {
            const Rectangle seen = seen_from(site, box);
            const Outline o = polygon_.outline();
            return std::any_of(o.begin(), o.end(), [&](const Corner& c) {
                return distance2(seen, c.p) <= c.p.x * c.p.x + c.p.y * c.p.y;
            });
        };
        auto visit = [&](uint32_t j) {
            const HalfPlane half = bisector(sites_.site(j) - site, j);
            if (j != i) polygon_.cut(half);
            return j == i || half.h > 0;
        };
        if (!tree_.each(site, meets, visit)) return Outcome::duplicate;
        finish(polygon_.outline(), i);
        return Outcome::done;
    }

    void finish(Outline o, uint32_t i) {
        VoronoiCell& cell = cells_[sites_.id[i]];
        cell = voronoi::measured(o);
        cell.area *= unit_ * unit_;
        cell.offset = {cell.offset.x * unit_, cell.offset.y * unit_};
        cell.rim = {cell.rim.x * unit_, cell.rim.y * unit_};
        if (check_reach_) {
            const Rectangle domain = seen_from(sites_.site(i), domain_);
            auto is_inside = [&](const Corner& c) { return domain.contains(c.p); };
            auto is_bounded = [](const Corner& c) { return c.neighbour >= 0; };
            cell.settled = domain.contains(flower_box(o));
            cell.inside = std::all_of(o.begin(), o.end(), is_inside);
            cell.bounded = cell.inside || std::all_of(o.begin(), o.end(), is_bounded);
        }
        if (!with_neighbours) return;
        first_neighbour_[sites_.id[i]] = uint32_t(neighbours_.size());
        for (const Corner& c : o)
            if (c.neighbour >= 0) neighbours_.push_back(sites_.id[size_t(c.neighbour)]);
        neighbour_count_[sites_.id[i]] =
            uint32_t(neighbours_.size()) - first_neighbour_[sites_.id[i]];
    }

    // ---- Sites at the same place --------------------------------------------------------------

    void find_copies() {
        order_.resize(raw_.size());
        std::iota(order_.begin(), order_.end(), 0u);
        auto key = [&](uint32_t i) { return std::tuple(raw_[i].x, raw_[i].y, i); };
        std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return key(a) < key(b); });
        first_of_.resize(raw_.size());
        for (size_t k = 0; k < order_.size(); ++k) {
            const Site p = raw_[order_[k]], q = raw_[order_[k ? k - 1 : 0]];
            const bool copy = k > 0 && p.x == q.x && p.y == q.y;
            first_of_[order_[k]] = copy ? first_of_[order_[k - 1]] : order_[k];
        }
    }

    void share() {
        copies_.assign(raw_.size(), 0);
        for (uint32_t first : first_of_) ++copies_[first];
        for (size_t i = inner_; i-- > 0;) {
            const uint32_t first = first_of_[i];
            cells_[i] = cells_[first];
            cells_[i].area /= copies_[first];
            cells_[i].copies = copies_[first];
            if (!with_neighbours) continue;
            first_neighbour_[i] = first_neighbour_[first];
            neighbour_count_[i] = neighbour_count_[first];
        }
    }
};
