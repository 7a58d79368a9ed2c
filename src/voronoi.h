// voronoi.h  floor 1  the areas of Voronoi cells in a window of the plane
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>
#include <vector>

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#include <immintrin.h>
#endif

// Always double: areas are to add up to that of the window, to 1e-12 n of it.
struct Site {
    double x = 0, y = 0;
};
struct Rectangle {
    Site lo, hi;

    double width() const { return hi.x - lo.x; }
    double height() const { return hi.y - lo.y; }
    double area() const { return width() * height(); }
    bool contains(const Rectangle& r) const {
        return lo.x <= r.lo.x && lo.y <= r.lo.y && r.hi.x <= hi.x && r.hi.y <= hi.y;
    }
};
inline Rectangle grown(const Rectangle& r, double by) {
    return {{r.lo.x - by, r.lo.y - by}, {r.hi.x + by, r.hi.y + by}};
}

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

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between functions of one file only
#endif

namespace voronoi {

// Eight numbers in a vector register (or what the machine has): GCC and Clang do arithmetic with
// such types.
typedef double Lanes __attribute__((vector_size(64)));
typedef double LooseLanes __attribute__((vector_size(64), aligned(8)));
typedef int64_t Ints __attribute__((vector_size(64)));
inline constexpr int width = 8;
inline constexpr Ints iota = {0, 1, 2, 3, 4, 5, 6, 7};

inline Lanes load(const double* from) { return *reinterpret_cast<const LooseLanes*>(from); }
inline void store(double* to, Lanes v) { *reinterpret_cast<LooseLanes*>(to) = v; }

// v[from[k]] in lane k.
inline Lanes permute(Lanes v, Ints from) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    return Lanes(_mm512_maskz_permutexvar_pd(255, __m512i(from), __m512d(v)));
#else
    Lanes out;
    for (int k = 0; k < width; ++k) out[k] = v[from[k]];
    return out;
#endif
}

// Bit k: lane k of a comparison is true.
inline unsigned bits(Ints mask) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    return _mm512_movepi64_mask(__m512i(mask));
#else
    unsigned out = 0;
    for (int k = 0; k < width; ++k) out |= unsigned(mask[k] & 1) << k;
    return out;
#endif
}

inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
inline double greatest(Lanes v) {
    v = max(v, permute(v, iota ^ 4));
    v = max(v, permute(v, iota ^ 2));
    v = max(v, permute(v, iota ^ 1));
    return v[0];
}
inline double sum(Lanes v) {
    v += permute(v, iota ^ 4);
    v += permute(v, iota ^ 2);
    v += permute(v, iota ^ 1);
    return v[0];
}

// The points v with d v <= h are as near to the site, the origin, as to its neighbour at d;
// h = d d / 2.  Differences d are exact, so that both sites see the same line.
struct Bisector {
    double dx, dy, h;
    int64_t id;
};

// Corners of a polygon about the origin, counterclockwise; edge[k] leads from corner k to the next
// and is due to that neighbour (-1: the window).
struct Outline {
    const double *x, *y;
    const int64_t* edge;
    int size;
};

// Which sides of a box about the site the cell's flower crosses.  The flower is the discs about the
// corners through the site, the origin: no site outside can cut the cell (Calka 2002).  The disc
// about v crosses the line x = b > 0 where v.x + |v| > b, that is, v.y^2 + 2 b v.x > b^2.
struct Sides {
    bool left = false, right = false, below = false, above = false;
    bool any() const { return left || right || below || above; }
};
inline Sides crossed(Lanes x, Lanes y, const Rectangle& box) {
    const Lanes xx = x * x, yy = y * y;
    return {bits(yy + 2 * box.lo.x * x > box.lo.x * box.lo.x) != 0,
            bits(yy + 2 * box.hi.x * x > box.hi.x * box.hi.x) != 0,
            bits(xx + 2 * box.lo.y * y > box.lo.y * box.lo.y) != 0,
            bits(xx + 2 * box.hi.y * y > box.hi.y * box.hi.y) != 0};
}
inline Sides crossed(const Outline& o, const Rectangle& box) {
    Sides all;
    for (int at = 0; at < o.size; at += width) {
        const Sides s = crossed(load(o.x + at), load(o.y + at), box);
        all = {all.left || s.left, all.right || s.right, all.below || s.below,
               all.above || s.above};
    }
    return all;
}

// A cell of up to eight corners: most of them.  Lanes that are no corners are the site itself,
// which no bisector cuts off.
class SmallPolygon {
public:
    void start(const Rectangle& r) {
        x_ = Lanes{r.lo.x, r.hi.x, r.hi.x, r.lo.x, 0, 0, 0, 0};
        y_ = Lanes{r.lo.y, r.lo.y, r.hi.y, r.hi.y, 0, 0, 0, 0};
        edge_ = Ints{} - 1;
        size_ = 4;
    }

    // False if that makes too many corners, or none.
    [[gnu::always_inline]] bool cut(const Bisector& b) {
        const Lanes s = b.dx * x_ + b.dy * y_ - b.h;
        const unsigned out = bits(s > 0);
        if (!out) return true;
        // The corners that stay are k consecutive ones from `first`; then come two new ones.
        const unsigned stay = ((1u << size_) - 1) & ~out;
        const unsigned firsts = stay & (out << 1 | out >> (size_ - 1));
        const int k = std::popcount(stay);
        if (k + 2 > width || !std::has_single_bit(firsts)) return false;
        const int first = std::countr_zero(firsts);
        // Where edges meet the line; s - s_next is not 0 where they do.
        Ints next = iota + 1;
        next = next == size_ ? Ints{} : next;
        const Lanes t = s / (s - permute(s, next));
        const Lanes x_line = x_ + t * (permute(x_, next) - x_);
        const Lanes y_line = y_ + t * (permute(y_, next) - y_);
        // New corner k is on the edge of old corner first + k - 1, k + 1 on that of first - 1.
        Ints from = iota + first;
        from = iota == k ? from - 1 : iota == k + 1 ? Ints{} + (first + size_ - 1) : from;
        from = from >= size_ ? from - size_ : from;
        const Ints old = iota < k, fresh = iota < k + 2;
        const Lanes none = {};
        x_ = old ? permute(x_, from) : fresh ? permute(x_line, from) : none;
        y_ = old ? permute(y_, from) : fresh ? permute(y_line, from) : none;
        edge_ = iota == k ? Ints{} + b.id : Ints(permute(Lanes(edge_), from));
        size_ = k + 2;
        return true;
    }

    Outline outline() {
        store(x_out_, x_);
        store(y_out_, y_);
        *reinterpret_cast<Ints*>(edge_out_) = edge_;
        return {x_out_, y_out_, edge_out_, size_};
    }

    Sides crossed(const Rectangle& box) const { return voronoi::crossed(x_, y_, box); }

private:
    Lanes x_, y_;
    Ints edge_;
    int size_ = 0;
    alignas(64) double x_out_[width], y_out_[width];
    alignas(64) int64_t edge_out_[width];
};

// Any number of corners (Sutherland, Hodgman 1974).
class LargePolygon {
public:
    void start(const Outline& o) {
        size_ = size_t(o.size);
        reserve(size_);
        std::copy_n(o.x, size_, x_.begin());
        std::copy_n(o.y, size_, y_.begin());
        std::copy_n(o.edge, size_, edge_.begin());
    }

    void cut(const Bisector& b) {
        bool any = false;
        for (size_t k = 0; k < size_; ++k) {
            s_[k] = b.dx * x_[k] + b.dy * y_[k] - b.h;
            any = any || s_[k] > 0;
        }
        if (!any) return;
        reserve(2 * size_);
        size_t n = 0;
        auto add = [&](double x, double y, int64_t edge) {
            next_x_[n] = x, next_y_[n] = y, next_edge_[n++] = edge;
        };
        for (size_t k = 0; k < size_; ++k) {
            const size_t l = k + 1 < size_ ? k + 1 : 0;
            const bool leaves = s_[l] > 0;
            if (!(s_[k] > 0)) add(x_[k], y_[k], edge_[k]);
            if (leaves == (s_[k] > 0)) continue;
            const double t = s_[k] / (s_[k] - s_[l]);
            add(x_[k] + t * (x_[l] - x_[k]), y_[k] + t * (y_[l] - y_[k]), leaves ? b.id : edge_[k]);
        }
        if (n < 3) return;  // rounding alone: the site itself stays
        size_ = n;
        x_.swap(next_x_);
        y_.swap(next_y_);
        edge_.swap(next_edge_);
    }

    // Like that of small ones, the end is padded by the site itself.
    Outline outline() {
        reserve(size_);
        std::fill_n(x_.begin() + ptrdiff_t(size_), width, 0.0);
        std::fill_n(y_.begin() + ptrdiff_t(size_), width, 0.0);
        return {x_.data(), y_.data(), edge_.data(), int(size_)};
    }

private:
    size_t size_ = 0;
    std::vector<double> x_, y_, s_, next_x_, next_y_;
    std::vector<int64_t> edge_, next_edge_;

    void reserve(size_t n) {
        if (x_.size() >= n + width) return;
        for (auto* v : {&x_, &y_, &s_, &next_x_, &next_y_}) v->resize(2 * n + width);
        for (auto* v : {&edge_, &next_edge_}) v->resize(2 * n + width);
    }
};

// A cell in the making.
class Polygon {
public:
    explicit Polygon(LargePolygon& spare) : large_(spare) {}

    void start(const Rectangle& r) {
        small_.start(r);
        is_large_ = false;
    }
    void cut(const Bisector& b) {
        if (is_large_) [[unlikely]]
            return large_.cut(b);
        if (small_.cut(b)) [[likely]]
            return;
        grow(b);
    }
    Sides crossed(const Rectangle& box) {
        return is_large_ ? voronoi::crossed(large_.outline(), box) : small_.crossed(box);
    }
    Outline outline() { return is_large_ ? large_.outline() : small_.outline(); }

private:
    [[gnu::cold, gnu::noinline]] void grow(const Bisector& b) {
        large_.start(small_.outline());
        is_large_ = true;
        large_.cut(b);
    }
    SmallPolygon small_;
    LargePolygon& large_;  // keeps its memory
    bool is_large_ = false;
};

// Sites about one, as bisectors with it.
class Neighbours {
public:
    static constexpr int most = 128;
    int size = 0;

    // Sites from ... to; false if there is no room.
    bool add(const double* x, const double* y, uint32_t from, uint32_t to, Site site) {
        for (; from < to; from += width) {
            if (size + width > most) return false;
            const Lanes dx = load(x + from) - site.x, dy = load(y + from) - site.y;
            store(dx_ + size, dx);
            store(dy_ + size, dy);
            store(h_ + size, (dx * dx + dy * dy) * 0.5);
            for (int k = 0; k < width; ++k) id_[size + k] = from + uint32_t(k);
            size += std::min(width, int(to - from));
        }
        return true;
    }

    Bisector operator[](int k) const { return {dx_[k], dy_[k], h_[k], int64_t(id_[k])}; }

    // Numbers of all, nearest first.  Each counts those that are farther, ties broken by number in
    // the last digits: no branch to mispredict.
    const int* by_distance() {
        constexpr int64_t digits = most - 1;
        alignas(64) int64_t key[most];
        alignas(64) int64_t rank[width];
        store(h_ + size, Lanes{} + 1e300);  // what fills the last lanes comes last
        for (int at = 0; at < size; at += width) {
            const Ints k = (Ints(load(h_ + at)) & ~digits) | (iota + at);
            *reinterpret_cast<Ints*>(key + at) = k;
        }
        for (int at = 0; at < size; at += width) {
            const Ints mine = *reinterpret_cast<const Ints*>(key + at);
            Ints nearer = {};
            for (int k = 0; k < size; ++k) nearer = key[k] < mine ? nearer + 1 : nearer;
            *reinterpret_cast<Ints*>(rank) = nearer;
            for (int k = 0; k < width; ++k) order_[rank[k]] = at + k;
        }
        return order_;
    }

    // Marks those whose bisector cuts a corner off.
    void find_cutters(const Outline& o) {
        for (int at = 0; at < size; at += width) {
            const Lanes dx = load(dx_ + at), dy = load(dy_ + at);
            Lanes farthest = {};
            for (int k = 0; k < o.size; ++k) farthest = max(farthest, dx * o.x[k] + dy * o.y[k]);
            store(depth_ + at, farthest - load(h_ + at));
        }
    }
    bool cuts(int k) const { return depth_[k] > 0; }

private:
    double dx_[most], dy_[most], h_[most + width], depth_[most];
    uint32_t id_[most];
    int order_[most + width];
};

inline Rectangle bounds(const Outline& o) {
    Rectangle r;
    for (int k = 0; k < o.size; ++k)
        r = {{std::min(r.lo.x, o.x[k]), std::min(r.lo.y, o.y[k])},
             {std::max(r.hi.x, o.x[k]), std::max(r.hi.y, o.y[k])}};
    return r;
}

// Area and centroid by triangles (site, corner, next corner): none is negative.
inline VoronoiCell measured(const Outline& o) {
    VoronoiCell cell;
    double twice = 0, six_x = 0, six_y = 0;
    for (int k = 0, before = o.size - 1; k < o.size; before = k++) {
        const double x = o.x[before], y = o.y[before], cross = x * o.y[k] - o.x[k] * y;
        twice += cross;
        six_x += cross * (x + o.x[k]);
        six_y += cross * (y + o.y[k]);
        if (o.edge[before] < 0) cell.rim = {cell.rim.x + o.y[k] - y, cell.rim.y - o.x[k] + x};
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
    static constexpr double per_bucket = 2;  // sites, on average
    static constexpr int most_rings = 12;    // of buckets, before the tree takes over
    static constexpr uint32_t leaf_size = 8;

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

    // Sites in the order of their buckets, and their indices; some places more, to be read only.
    int columns_ = 1, rows_ = 1;
    double x_scale_ = 1, y_scale_ = 1;  // buckets a unit
    double x_step_ = 1, y_step_ = 1;    // units a bucket
    uint32_t count_ = 0;                // sites, without copies
    std::vector<uint32_t> first_of_;    // the first site at the same place; empty: all are alone
    std::vector<uint32_t> bucket_of_, start_, id_;
    std::vector<double> x_, y_;

    voronoi::LargePolygon large_;

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
            out = out || !(p.x >= domain_.lo.x && p.x <= domain_.hi.x && p.y >= domain_.lo.y &&
                           p.y <= domain_.hi.y);
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
                    if (p.x >= domain_.lo.x && p.x <= domain_.hi.x && p.y >= domain_.lo.y &&
                        p.y <= domain_.hi.y)
                        raw_.push_back(p);
                }
    }

    int column(double x) const {
        return std::clamp(int((x - domain_.lo.x) * x_scale_), 0, columns_ - 1);
    }
    int row(double y) const { return std::clamp(int((y - domain_.lo.y) * y_scale_), 0, rows_ - 1); }
    uint32_t start(int x, int y) const { return start_[size_t(y) * size_t(columns_) + size_t(x)]; }

    // Of two sites at the same place, one is left out.
    void sort_into_buckets() {
        const double buckets = double(raw_.size()) / per_bucket, w = domain_.width(),
                     h = domain_.height();
        columns_ = std::max(1, int(std::sqrt(buckets * w / h)));
        rows_ = std::max(1, int(buckets / columns_));
        x_scale_ = columns_ / w, y_scale_ = rows_ / h;
        x_step_ = w / columns_, y_step_ = h / rows_;
        bucket_of_.resize(raw_.size());
        start_.assign(size_t(columns_) * size_t(rows_) + 2, 0);
        for (size_t i = 0; i < raw_.size(); ++i) {
            if (!first_of_.empty() && first_of_[i] != i) continue;
            bucket_of_[i] = uint32_t(row(raw_[i].y) * columns_ + column(raw_[i].x));
            ++start_[bucket_of_[i] + 2];
        }
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        count_ = start_.back();
        x_.resize(count_ + voronoi::width);
        y_.resize(count_ + voronoi::width);
        id_.resize(count_);
        for (size_t i = 0; i < raw_.size(); ++i) {
            if (!first_of_.empty() && first_of_[i] != i) continue;
            const uint32_t at = start_[bucket_of_[i] + 1]++;
            x_[at] = raw_[i].x, y_[at] = raw_[i].y, id_[at] = uint32_t(i);
        }
        tree_.clear();
    }

    // ---- Cells --------------------------------------------------------------------------------

    const std::vector<VoronoiCell>& tessellate() {
        if (!(domain_.width() > 0 && domain_.height() > 0))
            throw std::domain_error("voronoi: an empty window");
        first_of_.clear();
        sort_into_buckets();
        if (all_cells()) return cells_;
        find_copies();
        sort_into_buckets();
        all_cells();
        share();
        return cells_;
    }

    enum class Outcome { done, duplicate, too_much };

    // False if two sites are at the same place.
    bool all_cells() {
        neighbours_.clear();
        if (with_neighbours) {
            first_neighbour_.resize(inner_);
            neighbour_count_.resize(inner_);
        }
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                for (uint32_t i = start(x, y); i < start(x + 1, y); ++i)
                    if (id_[i] < inner_ && !cell(i, x, y)) return false;
        return true;
    }

    Rectangle frame(Site site) const { return relative_ ? frame_ : moved(frame_, site); }
    // As seen from a site.
    static Rectangle moved(const Rectangle& r, Site site) {
        return {{r.lo.x - site.x, r.lo.y - site.y}, {r.hi.x - site.x, r.hi.y - site.y}};
    }

    bool cell(uint32_t i, int x, int y) {
        voronoi::Polygon polygon(large_);  // a local one lives in registers
        Outcome outcome = cut_by_buckets(polygon, i, x, y);
        if (outcome == Outcome::too_much) outcome = cut_by_tree(polygon, i);
        if (outcome == Outcome::duplicate) return false;
        finish(polygon.outline(), i);
        return true;
    }

    [[gnu::always_inline]] Outcome cut_by_buckets(voronoi::Polygon& p, uint32_t i, int x, int y) {
        using enum Outcome;
        const Site site = {x_[i], y_[i]};
        voronoi::Neighbours near;
        const double *const xs = x_.data(), *const ys = y_.data();
        const uint32_t* const starts = start_.data();
        const int columns = columns_;
        auto gather = [&](int x0, int x1, int at_y) {
            const uint32_t* row = starts + size_t(at_y) * size_t(columns);
            return near.add(xs, ys, row[x0], row[x1 + 1], site);
        };
        p.start(frame(site));
        for (int at = std::max(y - 1, 0); at <= std::min(y + 1, rows_ - 1); ++at)
            if (!gather(std::max(x - 1, 0), std::min(x + 1, columns_ - 1), at)) return too_much;
        const int* order = near.by_distance();  // the first is site i
        if (near.size > 1 && near[order[1]].h == 0) return duplicate;
        const int first = std::min(near.size, 6);
        for (int k = 1; k < first; ++k) p.cut(near[order[k]]);
        near.find_cutters(p.outline());
        for (int k = first; k < near.size; ++k)
            if (near.cuts(order[k])) p.cut(near[order[k]]);
        for (int ring = 2;; ++ring) {
            // The buckets seen so far end here.
            const Rectangle seen = {{domain_.lo.x + (x - ring + 1) * x_step_ - site.x,
                                     domain_.lo.y + (y - ring + 1) * y_step_ - site.y},
                                    {domain_.lo.x + (x + ring) * x_step_ - site.x,
                                     domain_.lo.y + (y + ring) * y_step_ - site.y}};
            voronoi::Sides more = p.crossed(seen);
            more.left = more.left && x >= ring;
            more.right = more.right && x + ring < columns_;
            more.below = more.below && y >= ring;
            more.above = more.above && y + ring < rows_;
            if (!more.any()) return done;
            if (ring > most_rings) return too_much;
            near.size = 0;
            const int x0 = std::max(x - ring + !more.left, 0),
                      x1 = std::min(x + ring - !more.right, columns_ - 1),
                      y0 = std::max(y - ring + 1, 0), y1 = std::min(y + ring - 1, rows_ - 1);
            if (more.below && !gather(x0, x1, y - ring)) return too_much;
            if (more.above && !gather(x0, x1, y + ring)) return too_much;
            for (int at = y0; at <= y1 && (more.left || more.right); ++at) {
                if (more.left && !gather(x - ring, x - ring, at)) return too_much;
                if (more.right && !gather(x + ring, x + ring, at)) return too_much;
            }
            near.find_cutters(p.outline());
            for (int k = 0; k < near.size; ++k)
                if (near.cuts(k)) p.cut(near[k]);
        }
    }

    void finish(const voronoi::Outline& o, uint32_t i) {
        VoronoiCell& cell = cells_[id_[i]];
        cell = voronoi::measured(o);
        cell.area *= unit_ * unit_;
        cell.offset = {cell.offset.x * unit_, cell.offset.y * unit_};
        cell.rim = {cell.rim.x * unit_, cell.rim.y * unit_};
        if (check_reach_) {
            const Rectangle domain = moved(domain_, {x_[i], y_[i]});
            cell.settled = !voronoi::crossed(o, domain).any();
            cell.inside = domain.contains(voronoi::bounds(o));
            cell.bounded = cell.inside || std::all_of(o.edge, o.edge + o.size,
                                                      [](int64_t edge) { return edge >= 0; });
        }
        if (!with_neighbours) return;
        first_neighbour_[id_[i]] = uint32_t(neighbours_.size());
        for (int k = 0; k < o.size; ++k)
            if (o.edge[k] >= 0) neighbours_.push_back(id_[size_t(o.edge[k])]);
        neighbour_count_[id_[i]] = uint32_t(neighbours_.size()) - first_neighbour_[id_[i]];
    }

    // ---- Sites at the same place --------------------------------------------------------------

    void find_copies() {
        std::vector<uint32_t> order(raw_.size());
        std::iota(order.begin(), order.end(), 0u);
        auto key = [&](uint32_t i) { return std::tuple(raw_[i].x, raw_[i].y, i); };
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
        first_of_ = order;
        for (size_t k = 0; k < order.size(); ++k) {
            const Site p = raw_[order[k]], q = raw_[order[k ? k - 1 : 0]];
            const bool copy = k > 0 && p.x == q.x && p.y == q.y;
            first_of_[order[k]] = copy ? first_of_[order[k - 1]] : order[k];
        }
    }

    void share() {
        std::vector<uint32_t> copies(raw_.size());
        for (uint32_t first : first_of_) ++copies[first];
        for (size_t i = inner_; i-- > 0;) {
            const uint32_t first = first_of_[i];
            cells_[i] = cells_[first];
            cells_[i].area /= copies[first];
            cells_[i].copies = copies[first];
            if (!with_neighbours) continue;
            first_neighbour_[i] = first_neighbour_[first];
            neighbour_count_[i] = neighbour_count_[first];
        }
    }

    // ---- Clustered sites: a tree of boxes -----------------------------------------------------

    struct Node {
        Rectangle box;
        uint32_t from, to;    // sites in tree_sites_
        uint32_t second = 0;  // child; the first follows its parent.  0: a leaf
    };
    std::vector<Node> tree_;
    std::vector<uint32_t> tree_sites_;

    void grow(uint32_t from, uint32_t to) {
        Rectangle box{{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
        for (uint32_t k = from; k < to; ++k) {
            const double x = x_[tree_sites_[k]], y = y_[tree_sites_[k]];
            box = {{std::min(box.lo.x, x), std::min(box.lo.y, y)},
                   {std::max(box.hi.x, x), std::max(box.hi.y, y)}};
        }
        const size_t self = tree_.size();
        tree_.push_back({box, from, to});
        if (to - from <= leaf_size) return;
        const std::vector<double>& c = box.width() > box.height() ? x_ : y_;
        const uint32_t middle = (from + to) / 2;
        const auto begin = tree_sites_.begin();
        std::nth_element(begin + from, begin + middle, begin + to,
                         [&](uint32_t a, uint32_t b) { return c[a] < c[b]; });
        grow(from, middle);
        tree_[self].second = uint32_t(tree_.size());
        grow(middle, to);
    }

    Outcome cut_by_tree(voronoi::Polygon& p, uint32_t i) {
        if (tree_.empty()) {
            tree_sites_.resize(count_);
            std::iota(tree_sites_.begin(), tree_sites_.end(), 0u);
            grow(0, count_);
        }
        const Site site = {x_[i], y_[i]};
        p.start(frame(site));
        return cut_by(p, tree_[0], i, site) ? Outcome::done : Outcome::duplicate;
    }

    // Square of the distance of p from a box.
    static double distance2(const Rectangle& box, Site p) {
        const double x = std::max({box.lo.x - p.x, p.x - box.hi.x, 0.0}),
                     y = std::max({box.lo.y - p.y, p.y - box.hi.y, 0.0});
        return x * x + y * y;
    }

    // By the sites of a node, if its box meets the flower; false if one is at the place of site i.
    bool cut_by(voronoi::Polygon& p, const Node& node, uint32_t i, Site site) {
        const voronoi::Outline o = p.outline();
        bool meets = false;
        for (int k = 0; k < o.size && !meets; ++k) {
            const double x = o.x[k], y = o.y[k];
            meets = distance2(node.box, {site.x + x, site.y + y}) <= x * x + y * y;
        }
        if (!meets) return true;
        if (node.second) {
            const Node *near = &node + 1, *far = &tree_[node.second];
            if (distance2(far->box, site) < distance2(near->box, site)) std::swap(near, far);
            return cut_by(p, *near, i, site) && cut_by(p, *far, i, site);
        }
        for (uint32_t k = node.from; k < node.to; ++k) {
            const uint32_t j = tree_sites_[k];
            const double dx = x_[j] - site.x, dy = y_[j] - site.y, h = (dx * dx + dy * dy) * 0.5;
            if (j == i) continue;
            if (h == 0) return false;
            p.cut({dx, dy, h, int64_t(j)});
        }
        return true;
    }
};
