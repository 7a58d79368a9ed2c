// voronoi/sites.h  2  sites near a place: a grid of buckets, and a tree of boxes for clusters
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "voronoi/plane.h"

namespace penumbra {

// Sites sorted by the buckets of a grid, row by row.  Keeps its memory for the next sites.
struct Buckets {
    static constexpr double per_bucket = 3;  // sites, on average
    static constexpr size_t spare = 8;       // places after the last site that may be read

    int columns = 1, rows = 1;
    std::vector<double> x, y;  // coordinates of the sites in their new order; there site k
    std::vector<uint32_t> id;  // was number id[k]

    // The sites i of the domain that have first_of[i] = i; all, if that is empty.
    void sort(std::span<const Site> sites, std::span<const uint32_t> first_of,
              const Rectangle& domain) {
        const double buckets = double(sites.size()) / per_bucket;
        const double across = std::sqrt(buckets * domain.width() / domain.height());
        columns = int(std::clamp(across, 1.0, std::max(1.0, buckets)));
        rows = std::max(1, int(buckets / columns));
        origin_ = domain.lo;
        step_ = {domain.width() / columns, domain.height() / rows};
        bucket_of_.resize(sites.size());
        // Two places late: after the sums, bucket b ends at b + 1, and is counted up from its
        // start.
        start_.assign(size_t(columns) * size_t(rows) + 2, 0);
        auto counts = [&](size_t i) { return first_of.empty() || first_of[i] == i; };
        for (size_t i = 0; i < sites.size(); ++i) {
            if (!counts(i)) continue;
            bucket_of_[i] = bucket(sites[i]);
            ++start_[bucket_of_[i] + 2];
        }
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        x.resize(start_.back() + spare);
        y.resize(start_.back() + spare);
        id.resize(start_.back());
        for (size_t i = 0; i < sites.size(); ++i) {
            if (!counts(i)) continue;
            const uint32_t at = start_[bucket_of_[i] + 1]++;
            x[at] = sites[i].x, y[at] = sites[i].y, id[at] = uint32_t(i);
        }
    }

    uint32_t size() const { return uint32_t(id.size()); }
    Site site(uint32_t k) const { return {x[k], y[k]}; }

    // The sites of bucket (i, j) are numbered start(i, j) ... start(i + 1, j).
    uint32_t start(int i, int j) const { return start_[size_t(j) * size_t(columns) + size_t(i)]; }
    // Where column i and row i begin.
    double left(int i) const { return origin_.x + i * step_.x; }
    double bottom(int j) const { return origin_.y + j * step_.y; }

private:
    Site origin_, step_;
    std::vector<uint32_t> bucket_of_, start_;

    uint32_t bucket(Site p) const {
        const int i = std::clamp(int((p.x - origin_.x) / step_.x), 0, columns - 1),
                  j = std::clamp(int((p.y - origin_.y) / step_.y), 0, rows - 1);
        return uint32_t(j * columns + i);
    }
};

// Boxes about sites, halved until few are left: where some buckets hold too many.
class SiteTree {
public:
    bool empty() const { return nodes_.empty(); }
    void clear() { nodes_.clear(); }

    void grow(const Buckets& sites) {
        order_.resize(sites.size());
        std::iota(order_.begin(), order_.end(), 0u);
        nodes_.clear();
        grow(sites, 0, sites.size());
        place_.resize(sites.size());
        for (uint32_t k = 0; k < sites.size(); ++k) place_[order_[k]] = k;
    }

    // Some sites that are likely to be near site i, which is one of them.
    std::span<const uint32_t> about(uint32_t i) const {
        const uint32_t from = place_[i] - std::min(place_[i], leaf_size),
                       to = std::min(place_[i] + leaf_size, uint32_t(order_.size()));
        return std::span(order_).subspan(from, to - from);
    }

    // The nearest site to the point c that is not `left_out`; c and its position d are relative to
    // `site`.  It maximises d c - d d / 2, which must be greater than `least`.  That is 0 where
    // both sites are equally near, and d is exact: clusters keep their digits far from the origin.
    template <class LeftOut>
    std::optional<uint32_t> nearest(const Buckets& sites, Site site, Site c, double least,
                                    LeftOut left_out) const {
        Search s{site, c, least, {}};
        search(nodes_[0], sites, s, left_out);
        return s.best;
    }

private:
    static constexpr uint32_t leaf_size = 8;
    struct Node {
        Rectangle box;
        uint32_t begin, end;  // its sites in order_
        uint32_t second = 0;  // child; the first follows its parent.  0: a leaf
    };
    std::vector<Node> nodes_;
    std::vector<uint32_t> order_, place_;  // sites as the leaves have them, and where each is

    void grow(const Buckets& sites, uint32_t begin, uint32_t end) {
        Rectangle box{{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
        for (uint32_t k = begin; k < end; ++k) {
            const Site p = sites.site(order_[k]);
            box = {{std::min(box.lo.x, p.x), std::min(box.lo.y, p.y)},
                   {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y)}};
        }
        const size_t self = nodes_.size();
        nodes_.push_back({box, begin, end});
        if (end - begin <= leaf_size) return;
        const std::vector<double>& c = box.width() > box.height() ? sites.x : sites.y;
        const uint32_t middle = (begin + end) / 2;
        const auto first = order_.begin();
        std::nth_element(first + begin, first + middle, first + end,
                         [&](uint32_t a, uint32_t b) { return c[a] < c[b]; });
        grow(sites, begin, middle);
        nodes_[self].second = uint32_t(nodes_.size());
        grow(sites, middle, end);
    }

    // A query, and the best site so far.
    struct Search {
        Site site, c;
        double least;
        std::optional<uint32_t> best;
    };

    template <class LeftOut>
    void search(const Node& node, const Buckets& sites, Search& s, LeftOut& left_out) const {
        // d c - d d / 2 = (c c - |c - d|^2) / 2, where the squares lose digits to each other: some
        // fifty roundings more, and the sites themselves decide.
        const Site c = s.c;
        const double c2 = c.x * c.x + c.y * c.y;
        if (distance2(seen_from(s.site, node.box), c) > c2 * (1 + 1e-14) - 2 * s.least) return;
        if (node.second) {
            const Site p = {s.site.x + c.x, s.site.y + c.y};
            const Node *near = &node + 1, *far = &nodes_[node.second];
            if (distance2(far->box, p) < distance2(near->box, p)) std::swap(near, far);
            search(*near, sites, s, left_out);
            search(*far, sites, s, left_out);
            return;
        }
        for (uint32_t k = node.begin; k < node.end; ++k) {
            const Site d = sites.site(order_[k]) - s.site;
            const double excess = d.x * c.x + d.y * c.y - (d.x * d.x + d.y * d.y) * 0.5;
            if (!left_out(order_[k]) && excess > s.least) s.least = excess, s.best = order_[k];
        }
    }
};

}  // namespace penumbra
