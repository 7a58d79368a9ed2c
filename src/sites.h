// sites.h  floor 1  sites near a place: a grid of buckets, and a tree of boxes for clusters
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "plane.h"

// Sites sorted by the buckets of a grid, row by row.  Keeps its memory for the next sites.
struct Buckets {
    static constexpr double per_bucket = 3;  // sites, on average
    static constexpr size_t spare = 8;       // places after the last site that may be read

    int columns = 1, rows = 1;
    std::vector<double> x, y;  // of the sites in their new order, in which site k
    std::vector<uint32_t> id;  // was number id[k]

    // The sites i of the domain that have first_of[i] = i; all, if that is empty.
    void sort(std::span<const Site> sites, std::span<const uint32_t> first_of,
              const Rectangle& domain) {
        const double buckets = double(sites.size()) / per_bucket;
        columns = std::max(1, int(std::sqrt(buckets * domain.width() / domain.height())));
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
    }

    // visit(k) for the sites k of every box that `meets`, those near `from` first, until it is
    // false; so is then the answer.
    template <class Meets, class Visit>
    bool each(Site from, Meets meets, Visit visit) const {
        return each(nodes_[0], from, meets, visit);
    }

private:
    static constexpr uint32_t leaf_size = 8;
    struct Node {
        Rectangle box;
        uint32_t begin, end;  // of its sites in order_
        uint32_t second = 0;  // child; the first follows its parent.  0: a leaf
    };
    std::vector<Node> nodes_;
    std::vector<uint32_t> order_;

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

    template <class Meets, class Visit>
    bool each(const Node& node, Site from, Meets& meets, Visit& visit) const {
        if (!meets(node.box)) return true;
        if (node.second) {
            const Node *near = &node + 1, *far = &nodes_[node.second];
            if (distance2(far->box, from) < distance2(near->box, from)) std::swap(near, far);
            return each(*near, from, meets, visit) && each(*far, from, meets, visit);
        }
        for (uint32_t k = node.begin; k < node.end; ++k)
            if (!visit(order_[k])) return false;
        return true;
    }
};
