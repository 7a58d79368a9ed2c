// voronoi/window.h  2  sites in a window: in its units, repeated around it, at the same place
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

#include "voronoi/plane.h"

namespace penumbra {

// Sites as cells see them: from the window's lower left corner, in units of its greater side, and
// rounded.  Keeps its memory for the next sites.
class WindowSites {
public:
    // Forgets all sites.  The next ones must be in the domain, the window plus that margin.  Throws
    // std::domain_error if the window is empty, or more than 1000 times as long as wide.
    void begin(const Rectangle& window, double margin) {
        const Rectangle domain = grown(window, margin);
        check(window);
        check(domain);
        origin_ = window.lo;
        unit_ = std::max(window.width(), window.height());
        domain_ = {rounded(domain.lo), rounded(domain.hi)};
        sites_.clear();
        first_of_.clear();
    }

    // std::domain_error if one is outside the domain, which NaN is, too.
    void add(std::span<const Site> sites) {
        if (sites.size() > most) throw std::length_error("voronoi: too many sites");
        bool out = false;
        for (const Site& site : sites) {
            const Site p = rounded(site);
            out = out || !domain_.contains(p);
            sites_.push_back(p);
        }
        if (out) throw std::domain_error("voronoi: a site outside the window");
    }

    // All sites again, moved by multiples of the window's width and height, as far as the domain
    // reaches.
    void repeat(double width, double height) {
        const double w = (width / unit_ + 4) - 4, h = (height / unit_ + 4) - 4;
        const int columns = int(std::ceil(-domain_.lo.x / w)),
                  rows = int(std::ceil(-domain_.lo.y / h));
        const size_t own = sites_.size();
        for (int j = -rows; j <= rows; ++j)
            for (int i = -columns; i <= columns; ++i)
                for (size_t k = 0; k < own && (i != 0 || j != 0); ++k) {
                    const Site p = {sites_[k].x + i * w, sites_[k].y + j * h};
                    if (domain_.contains(p)) sites_.push_back(p);
                    if (sites_.size() > most) throw std::length_error("voronoi: too many sites");
                }
    }

    double unit() const { return unit_; }
    const Rectangle& domain() const { return domain_; }
    std::span<const Site> sites() const { return sites_; }

    // ---- At the same place ----------------------------------------------------------------------

    void find_copies() {
        order_.resize(sites_.size());
        std::iota(order_.begin(), order_.end(), 0u);
        auto key = [&](uint32_t i) { return std::tuple(sites_[i].x, sites_[i].y, i); };
        std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return key(a) < key(b); });
        first_of_.resize(sites_.size());
        copies_.assign(sites_.size(), 0);
        for (size_t k = 0; k < order_.size(); ++k) {
            const Site p = sites_[order_[k]], q = sites_[order_[k ? k - 1 : 0]];
            const bool copy = k > 0 && p.x == q.x && p.y == q.y;
            first_of_[order_[k]] = copy ? first_of_[order_[k - 1]] : order_[k];
            ++copies_[first_of_[order_[k]]];
        }
    }

    // The first site at the place of each; empty: copies have not been looked for.
    std::span<const uint32_t> first_of() const { return first_of_; }
    // Number of sites at the place of a first one.
    uint32_t copies(uint32_t first) const { return copies_[first]; }

private:
    static constexpr size_t most = UINT32_MAX / 32;

    Site origin_;
    double unit_ = 1;
    Rectangle domain_;
    std::vector<Site> sites_;
    std::vector<uint32_t> first_of_, copies_, order_;

    static void check(const Rectangle& r) {
        const double w = r.width(), h = r.height();
        if (!(w > 0 && h > 0 && std::isfinite(w) && std::isfinite(h)))
            throw std::domain_error("voronoi: an empty window");
        if (std::max(w, h) > 1000 * std::min(w, h))
            throw std::domain_error("voronoi: a window more than 1000 times as long as wide");
    }

    // To 2^-50, so that differences are exact and squares of them do not vanish.
    Site rounded(Site p) const {
        return {((p.x - origin_.x) / unit_ + 4) - 4, ((p.y - origin_.y) / unit_ + 4) - 4};
    }
};

}  // namespace penumbra
