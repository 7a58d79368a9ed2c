// voronoi/voronoi.h  3  the areas of Voronoi cells in a window of the plane
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

#include "voronoi/cell.h"
#include "voronoi/sites.h"

// The points of the window that are nearer to one site than to all others; lengths and areas in
// units of the window's own.
struct VoronoiCell {
    double area = 0;
    Site rim;     // sum over its edges on the window's border: length x outward normal
    Site offset;  // of the centroid, from the site
    // In a stretched window and on a torus; where many sites are within rounding of each other,
    // they may be false for want of digits.
    bool bounded = true;  // reaches not beyond twice the domain's size around it
    bool inside = true;   // is all in the domain
    bool settled = true;  // no site outside the domain could change it
    uint32_t copies = 1;  // sites at the same place share area and rim equally
};

namespace voronoi {

// Area and centroid by triangles (site, corner, next corner).
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

// Cells of sites in a window, each by itself: its border is wrapped from the bisectors with the
// sites around, which come ring by ring of a grid of buckets, until no other site could reach it; a
// cell of crowded sites is cut from the window instead, by sites that a tree finds.  Sites are
// rounded to 2^-50 of the window's greater side, and areas are exact but for rounding, in ties and
// near-ties, too; only who is a neighbour may then depend on the side one looks from.  Linear
// expected time for scattered sites, O(n log n) for clusters, about O(n^3/2) for sites along lines
// and curves, but O(n^2) for n sites on one circle, whose cells all end at its centre.  Keeps its
// memory for the next call.
class Voronoi {
public:
    bool with_neighbours = false;  // whether neighbours(i) is to be had

    // Clipped to the window, in which all sites are: std::domain_error if not, or if the window is
    // empty or more than 1000 times as long as wide.
    const std::vector<VoronoiCell>& clipped(std::span<const Site> sites, const Rectangle& window) {
        begin(sites, sites.size(), window, window);
        add_sites(sites);
        bounds_ = domain_;
        return tessellate();
    }

    // The cells of the first `inner` sites; the others only bound them.  All are in the domain.
    const std::vector<VoronoiCell>& stretched(std::span<const Site> sites, size_t inner,
                                              const Rectangle& domain) {
        begin(sites, inner, domain, domain);
        add_sites(sites);
        bounds_ = grown(domain_, 2);
        check_reach_ = true;
        return tessellate();
    }

    // The window is repeated in both directions.  Sites on opposite borders are at the same place.
    const std::vector<VoronoiCell>& torus(std::span<const Site> sites, const Rectangle& window) {
        check(window);
        const double w = window.width(), h = window.height(), side = std::max(w, h);
        // No flower reaches farther, rounded up: a cell's corners are within half a diagonal.
        const double enough = (side + std::hypot(w, h)) / 2 * (1 + 1e-9);
        double margin = 4 * std::sqrt(window.area() / double(std::max<size_t>(sites.size(), 1)));
        for (bool settled = false; !settled; margin *= 2) {
            margin = std::min(margin, enough);
            begin(sites, sites.size(), window, grown(window, margin));
            add_sites(sites);
            add_images(w / side, h / side);
            bounds_ = {{-0.5 * w / side, -0.5 * h / side}, {0.5 * w / side, 0.5 * h / side}};
            relative_ = check_reach_ = true;
            tessellate();
            settled = margin == enough ||
                      std::all_of(cells_.begin(), cells_.end(), [](auto& c) { return c.settled; });
        }
        return cells_;
    }

    // The sites that share an edge with site i, counterclockwise, if with_neighbours was set.
    std::span<const uint32_t> neighbours(size_t i) const {
        return {neighbours_.data() + first_neighbour_[i], neighbour_count_[i]};
    }

private:
    static constexpr int most_rings = 12;  // of buckets, before the tree takes over
    static constexpr size_t most_sites = UINT32_MAX / 32;
    static_assert(cell::lanes <= int(Buckets::spare), "HalfPlanes::add reads as many places more");

    std::vector<VoronoiCell> cells_;
    std::vector<uint32_t> neighbours_, first_neighbour_, neighbour_count_;

    Site origin_;  // of the window; in units of its greater side:
    double unit_ = 1;
    Rectangle domain_;               // where all sites are
    Rectangle bounds_;               // every cell is cut from this,
    bool relative_ = false;          // or from this moved to its site
    bool check_reach_ = false;       // whether cells may depend on what is outside the domain
    size_t inner_ = 0;               // sites whose cells are asked for
    std::vector<Site> raw_;          // all sites
    Buckets sites_;                  // all that are alone or the first at their place
    SiteTree tree_;                  // of these; empty until it is needed
    std::vector<uint32_t> used_by_;  // the last cell that a site has cut by the tree
    HalfPlanes lines_;
    ConvexPolygon polygon_;
    std::vector<uint32_t> first_of_;  // the first site at the same place; empty: all are alone
    std::vector<uint32_t> order_, copies_;

    // ---- Sites --------------------------------------------------------------------------------

    static void check(const Rectangle& window) {
        const double w = window.width(), h = window.height();
        if (!(w > 0 && h > 0 && std::isfinite(w) && std::isfinite(h)))
            throw std::domain_error("voronoi: an empty window");
        if (std::max(w, h) > 1000 * std::min(w, h))
            throw std::domain_error("voronoi: a window more than 1000 times as long as wide");
    }

    void begin(std::span<const Site> sites, size_t inner, const Rectangle& window,
               const Rectangle& domain) {
        check(domain);
        if (sites.size() > most_sites) throw std::length_error("voronoi: too many sites");
        if (inner > sites.size()) throw std::domain_error("voronoi: more cells than sites");
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

    void add_images(double w, double h) {
        w = (w + 4) - 4, h = (h + 4) - 4;
        const int columns = int(std::ceil(-domain_.lo.x / w)),
                  rows = int(std::ceil(-domain_.lo.y / h));
        for (int j = -rows; j <= rows; ++j)
            for (int i = -columns; i <= columns; ++i)
                for (size_t k = 0; k < inner_ && (i != 0 || j != 0); ++k) {
                    const Site p = {raw_[k].x + i * w, raw_[k].y + j * h};
                    if (domain_.contains(p)) raw_.push_back(p);
                    if (raw_.size() > most_sites)
                        throw std::length_error("voronoi: too many sites");
                }
    }

    // ---- Cells --------------------------------------------------------------------------------

    const std::vector<VoronoiCell>& tessellate() {
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

    Rectangle bounds(Site site) const { return relative_ ? bounds_ : seen_from(site, bounds_); }

    // By the sites of its bucket and of those around, ring by ring as far as the flower reaches.
    Outcome wrap(uint32_t i, int x, int y) {
        using enum Outcome;
        const Site site = sites_.site(i);
        const int last_x = sites_.columns - 1, last_y = sites_.rows - 1;
        auto gather = [&](int x0, int x1, int at) {
            return lines_.add(sites_.x.data(), sites_.y.data(), sites_.start(x0, at),
                              sites_.start(x1 + 1, at), site);
        };
        lines_.start(bounds(site));
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

    // As long as some site is nearer to a corner than site i is, the nearest one cuts the corner
    // off; but each only once, since rounding could put the new corners nearer to it again.
    Outcome cut(uint32_t i) {
        if (tree_.empty()) {
            tree_.grow(sites_);
            used_by_.assign(sites_.size(), UINT32_MAX);
        }
        const Site site = sites_.site(i);
        auto used = [&](uint32_t j) { return j == i || used_by_[j] == i; };
        auto use = [&](uint32_t j) {
            used_by_[j] = i;
            polygon_.cut(bisector(sites_.site(j) - site, j));
        };
        polygon_.start(bounds(site));
        if (const auto j = tree_.nearest(sites_, site, {}, -INFINITY, used)) {
            const Site d = sites_.site(*j) - site;
            if (d.x == 0 && d.y == 0) return Outcome::duplicate;
            use(*j);
        }
        for (uint32_t j : tree_.about(i))
            if (!used(j)) use(j);
        while (Corner* const corner = polygon_.open_corner()) {
            if (const auto j = tree_.nearest(sites_, site, corner->p, 0, used))
                use(*j);
            else
                corner->stays = true;
        }
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
            const uint32_t sharing = copies_[first];
            cells_[i].area /= sharing;
            cells_[i].rim = {cells_[i].rim.x / sharing, cells_[i].rim.y / sharing};
            cells_[i].copies = sharing;
            if (!with_neighbours) continue;
            first_neighbour_[i] = first_neighbour_[first];
            neighbour_count_[i] = neighbour_count_[first];
        }
    }
};
