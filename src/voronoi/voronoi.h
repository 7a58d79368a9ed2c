// voronoi/voronoi.h  4  the areas of Voronoi cells in a window of the plane
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "voronoi/cell.h"
#include "voronoi/sites.h"
#include "voronoi/window.h"

namespace penumbra {

// Cells of sites in a window, one by one.  The border of a cell is wrapped from the bisectors with
// the sites around it, ring by ring of a grid of buckets, until no other site can reach it.  A cell
// of crowded sites is cut from the window instead, by sites that a tree finds.  Sites are rounded
// to 2^-50 of the window's greater side.  Areas are exact except for rounding, also in ties and
// near-ties; there, neighbourhood may not be symmetric.  Expected time is linear for scattered
// sites, O(n log n) for clusters, about O(n^3/2) for sites along lines and curves, but O(n^2) for n
// sites on one circle.  Keeps its memory for the next call.
class Voronoi {
public:
    bool with_neighbours = false;  // true: neighbours(i) works

    // Clipped to the window, which has all sites.  All three functions throw as WindowSites does.
    const std::vector<VoronoiCell>& clipped(std::span<const Site> sites, const Rectangle& window) {
        window_.begin(window, 0);
        window_.add(sites);
        return tessellate(sites.size(), {window_.domain()});
    }

    // The cells of the first `inner` sites; the others only bound them.  The domain has all sites.
    const std::vector<VoronoiCell>& stretched(std::span<const Site> sites, size_t inner,
                                              const Rectangle& domain) {
        if (inner > sites.size()) throw std::domain_error("voronoi: more cells than sites");
        window_.begin(domain, 0);
        window_.add(sites);
        return tessellate(inner, {grown(window_.domain(), 2), false, true});
    }

    // The window is repeated in both directions.  Sites on opposite borders are at the same place.
    const std::vector<VoronoiCell>& torus(std::span<const Site> sites, const Rectangle& window) {
        const double w = window.width(), h = window.height(), side = std::max(w, h);
        const Site half = {0.5 * w / side, 0.5 * h / side};
        // No flower reaches farther, rounded up: a cell's corners are within half a diagonal.
        const double enough = (side + std::hypot(w, h)) / 2 * (1 + 1e-9);
        double margin = 4 * std::sqrt(window.area() / double(std::max<size_t>(sites.size(), 1)));
        for (bool settled = false; !settled; margin *= 2) {
            margin = std::min(margin, enough);
            window_.begin(window, margin);
            window_.add(sites);
            window_.repeat(w, h);
            tessellate(sites.size(), {{{-half.x, -half.y}, half}, true, true});
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
    static constexpr int max_rings = 12;  // rings of buckets, before the tree takes over
    static_assert(cell::lanes <= int(Buckets::spare), "HalfPlanes::add reads as many places more");

    std::vector<VoronoiCell> cells_;
    std::vector<uint32_t> neighbours_, first_neighbour_, neighbour_count_;

    struct Start {
        Rectangle bounds;          // every cell is cut from this,
        bool relative = false;     // or from this moved to its site
        bool check_reach = false;  // true: cells may depend on sites outside the domain
    };
    Start start_;
    WindowSites window_;
    Buckets sites_;                  // sites, without copies at the same place
    SiteTree tree_;                  // the same sites; empty until it is needed
    std::vector<uint32_t> used_by_;  // the last cell that a site of the tree has cut
    HalfPlanes lines_;
    ConvexPolygon polygon_;

    // The cells of the first `inner` sites.
    const std::vector<VoronoiCell>& tessellate(size_t inner, const Start& start) {
        start_ = start;
        cells_.resize(inner);
        if (all_cells()) return cells_;
        window_.find_copies();
        all_cells();
        share();
        return cells_;
    }

    // False if two sites are at the same place.
    bool all_cells() {
        sites_.sort(window_.sites(), window_.first_of(), window_.domain());
        tree_.clear();
        neighbours_.clear();
        if (with_neighbours) {
            first_neighbour_.resize(cells_.size());
            neighbour_count_.resize(cells_.size());
        }
        for (int y = 0; y < sites_.rows; ++y)
            for (int x = 0; x < sites_.columns; ++x)
                for (uint32_t i = sites_.start(x, y); i < sites_.start(x + 1, y); ++i)
                    if (sites_.id[i] < cells_.size() && !cell(i, {x, y})) return false;
        return true;
    }

    enum class Outcome { done, duplicate, too_much };
    struct Bucket {
        int x, y;
    };

    bool cell(uint32_t i, Bucket at) {
        // Cells of neighbours are far apart in memory: fetched while this cell is computed.
        const VoronoiCell* const place = &cells_[sites_.id[i]];
        __builtin_prefetch(place, 1);
        __builtin_prefetch(place + 1, 1);
        const Outcome outcome = wrap(i, at);
        return (outcome == Outcome::too_much ? cut(i) : outcome) == Outcome::done;
    }

    Rectangle bounds(Site site) const {
        return start_.relative ? start_.bounds : seen_from(site, start_.bounds);
    }

    // Uses the sites of its bucket and around it, ring by ring as far as the flower reaches.
    Outcome wrap(uint32_t i, Bucket at) {
        using enum Outcome;
        const Site site = sites_.site(i);
        const int west = std::max(at.x - 1, 0), east = std::min(at.x + 1, sites_.columns - 1);
        lines_.start(bounds(site));
        if (at.y > 0 && !gather(site, at.y - 1, west, east)) return too_much;
        const int self = lines_.size() + int(i - sites_.start(west, at.y));
        if (!gather(site, at.y, west, east)) return too_much;
        if (at.y + 1 < sites_.rows && !gather(site, at.y + 1, west, east)) return too_much;
        lines_.remove(self);
        const int nearest = lines_.nearest();
        if (lines_.is_copy(nearest)) return duplicate;
        Outline outline = lines_.wrap(nearest);
        for (int ring = 2;; ++ring) {
            if (outline.empty()) return too_much;
            const Sides sides = reached(site, flower_box(outline), at, ring);
            if (!sides.any()) break;
            if (ring > max_rings) return too_much;
            const int before = lines_.size();
            if (!gather_ring(site, at, ring, sides)) return too_much;
            lines_.keep_cutters(before, outline);
            if (lines_.size() > before) outline = lines_.wrap(lines_.nearest());
        }
        finish(outline, i);
        return done;
    }

    // The bisectors of `site` with the sites in buckets x0 ... x1 of a row.  False: no room.
    bool gather(Site site, int row, int x0, int x1) {
        return lines_.add(sites_.x.data(), sites_.y.data(), sites_.start(x0, row),
                          sites_.start(x1 + 1, row), site);
    }

    // Sides of a ring of buckets.
    struct Sides {
        bool left, right, below, above;
        bool any() const { return left || right || below || above; }
    };

    // Those of ring `ring` about a bucket to which the flower of a site in it reaches.
    Sides reached(Site site, const Rectangle& flower, Bucket at, int ring) const {
        const auto [x, y] = at;
        return {x >= ring && site.x + flower.lo.x < sites_.left(x - ring + 1),
                x + ring < sites_.columns && site.x + flower.hi.x > sites_.left(x + ring),
                y >= ring && site.y + flower.lo.y < sites_.bottom(y - ring + 1),
                y + ring < sites_.rows && site.y + flower.hi.y > sites_.bottom(y + ring)};
    }

    // False: no room.
    bool gather_ring(Site site, Bucket at, int ring, Sides to) {
        const auto [x, y] = at;
        const int x0 = std::max(x - ring + !to.left, 0),
                  x1 = std::min(x + ring - !to.right, sites_.columns - 1),
                  y0 = std::max(y - ring + 1, 0), y1 = std::min(y + ring - 1, sites_.rows - 1);
        if (to.below && !gather(site, y - ring, x0, x1)) return false;
        if (to.above && !gather(site, y + ring, x0, x1)) return false;
        for (int row = y0; row <= y1 && (to.left || to.right); ++row) {
            if (to.left && !gather(site, row, x - ring, x - ring)) return false;
            if (to.right && !gather(site, row, x + ring, x + ring)) return false;
        }
        return true;
    }

    // While a site is nearer to a corner than site i is, the nearest one cuts the corner off.  Each
    // cuts only once, because rounding could put the new corners nearer to it again.
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
        const uint32_t id = sites_.id[i];
        VoronoiCell& cell = cells_[id];
        cell = voronoi::measured(o);
        const double unit = window_.unit();
        cell.area *= unit * unit;
        cell.offset = {cell.offset.x * unit, cell.offset.y * unit};
        cell.rim = {cell.rim.x * unit, cell.rim.y * unit};
        if (start_.check_reach) {
            const Rectangle domain = seen_from(sites_.site(i), window_.domain());
            auto is_inside = [&](const Corner& c) { return domain.contains(c.p); };
            auto is_bounded = [](const Corner& c) { return c.neighbour >= 0; };
            cell.settled = domain.contains(flower_box(o));
            cell.inside = std::all_of(o.begin(), o.end(), is_inside);
            cell.bounded = cell.inside || std::all_of(o.begin(), o.end(), is_bounded);
        }
        if (!with_neighbours) return;
        first_neighbour_[id] = uint32_t(neighbours_.size());
        for (const Corner& c : o)
            if (c.neighbour >= 0) neighbours_.push_back(sites_.id[size_t(c.neighbour)]);
        neighbour_count_[id] = uint32_t(neighbours_.size()) - first_neighbour_[id];
    }

    // Sites at the same place share the cell of the first.
    void share() {
        for (size_t i = cells_.size(); i-- > 0;) {
            const uint32_t first = window_.first_of()[i], sharing = window_.copies(first);
            cells_[i] = cells_[first];
            cells_[i].area /= sharing;
            cells_[i].rim = {cells_[i].rim.x / sharing, cells_[i].rim.y / sharing};
            cells_[i].copies = sharing;
            if (!with_neighbours) continue;
            first_neighbour_[i] = first_neighbour_[first];
            neighbour_count_[i] = neighbour_count_[first];
        }
    }
};

}  // namespace penumbra
