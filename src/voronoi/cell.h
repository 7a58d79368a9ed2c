// voronoi/cell.h  3  one Voronoi cell, from its bisectors with the sites around
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "voronoi/polygon.h"

namespace penumbra {

// A box around the cell's flower: the discs about its corners through the site.  No site outside
// the flower can cut the cell (Calka 2002).
inline Rectangle flower_box(Outline cell) {
    Rectangle box;
    for (const Corner& c : cell) {
        const Site p = c.p;
        const double r = std::sqrt(p.x * p.x + p.y * p.y);
        box = {{std::min(box.lo.x, p.x - r), std::min(box.lo.y, p.y - r)},
               {std::max(box.hi.x, p.x + r), std::max(box.hi.y, p.y + r)}};
    }
    return box;
}

// ---- Few neighbours: the cell is wrapped --------------------------------------------------------

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between functions of one file only
#endif

namespace cell {

// Numbers in a vector register, as many as the machine has room for: GCC and Clang do arithmetic
// with such types.
#if defined(__AVX512F__)
inline constexpr int lanes = 8;
#elif defined(__AVX__)
inline constexpr int lanes = 4;
#else
inline constexpr int lanes = 2;
#endif
typedef double Lanes __attribute__((vector_size(8 * lanes)));
typedef double LooseLanes __attribute__((vector_size(8 * lanes), aligned(8), may_alias));
typedef int64_t Ints __attribute__((vector_size(8 * lanes)));
using Indices = std::make_integer_sequence<int, lanes>;

inline Lanes load(const double* from) { return *reinterpret_cast<const LooseLanes*>(from); }
inline void store(double* to, Lanes v) { *reinterpret_cast<LooseLanes*>(to) = v; }

template <int... k>
Ints iota(std::integer_sequence<int, k...>) {
    return Ints{k...};
}
// Lane k gets what is in lane k ^ by.
template <int by, class V, int... k>
V swapped(V v, std::integer_sequence<int, k...>) {
    return __builtin_shufflevector(v, v, (k ^ by)...);
}

// Lane by lane the least value, and which that is.
struct Least {
    Lanes value = Lanes{} + INFINITY;
    Ints k = {};

    void offer(Lanes v, Ints id, Ints counts) {
        const Ints less = counts & (v < value);
        value = less ? v : value;
        k = less ? id : k;
    }

    struct OfAll {
        double value;
        int k;
    };
    OfAll of_all() {
        if constexpr (lanes > 4)
            halve<4 % lanes>();  // the remainder: fewer lanes compile this, too
        if constexpr (lanes > 2) halve<2 % lanes>();
        halve<1>();
        return {value[0], int(k[0])};
    }

private:
    template <int by>
    void halve() {
        offer(swapped<by>(value, Indices()), swapped<by>(k, Indices()), ~Ints{});
    }
};

}  // namespace cell

// Some hundred half-planes and four walls.  What they have in common is found by walking along its
// border from line to line, as a gift is wrapped (Jarvis 1973).
class HalfPlanes {
public:
    // Only the walls, of a box that holds the site.
    void start(const Rectangle& box) {
        set(0, {{-1, 0}, -box.lo.x});
        set(1, {{1, 0}, box.hi.x});
        set(2, {{0, -1}, -box.lo.y});
        set(3, {{0, 1}, box.hi.y});
        size_ = walls;
    }

    int size() const { return size_; }

    // The bisectors of `site` with the sites (x, y) numbered from ... to; some after them are read,
    // too.  False if there is no room.
    bool add(const double* x, const double* y, uint32_t from, uint32_t to, Site site) {
        using namespace cell;
        for (; from < to; from += lanes) {
            if (size_ + lanes > most) return false;
            const Lanes dx = load(x + from) - site.x, dy = load(y + from) - site.y;
            store(dx_ + size_, dx);
            store(dy_ + size_, dy);
            store(h_ + size_, (dx * dx + dy * dy) * 0.5);
            for (int k = 0; k < lanes; ++k) neighbour_[size_ + k] = int32_t(from) + k;
            size_ += std::min(lanes, int(to - from));
        }
        return true;
    }

    // As if it were not there.
    void remove(int k) { set(k, {{0, 0}, INFINITY}); }

    // Removes lines numbered `from` and higher that cut no corner off.
    void keep_cutters(int from, Outline outline) {
        using namespace cell;
        int kept = from;
        for (int at = from; at < size_; at += lanes) {
            const Lanes dx = load(dx_ + at), dy = load(dy_ + at), h = load(h_ + at);
            Ints cuts = {};
            for (const Corner& c : outline) cuts |= dx * c.p.x + dy * c.p.y > h;
            for (int k = 0; k < lanes && at + k < size_; ++k) {
                set(kept, {{dx[k], dy[k]}, h[k], neighbour_[at + k]});
                kept -= int(cuts[k]);
            }
        }
        size_ = kept;
    }

    // The line of the nearest neighbour; of the nearest wall if there is no neighbour.
    int nearest() {
        using namespace cell;
        store(dx_ + size_, Lanes{});
        store(dy_ + size_, Lanes{});
        store(h_ + size_, Lanes{} + INFINITY);  // no lines in the last lanes
        Least least;
        Ints id = iota(Indices());
        for (int at = 0; at < size_; at += lanes, id += lanes)
            least.offer(load(h_ + at), id, id >= walls);
        const int k = least.of_all().k;
        return k ? k : int(std::min_element(h_, h_ + walls) - h_);
    }
    // That neighbour is at the same place.
    bool is_copy(int k) const { return k >= walls && h_[k] == 0; }

    // From `first`, which is nearest() after all lines are there, both ways until they meet.  It
    // has an edge: half way to the nearest neighbour no other site is nearer.  Where lines meet in
    // one point, or nearly coincide, rounding may let the two ways pass each other, which ends the
    // walk, too; the outline may then have a spike of no width.  Empty: too many corners.
    Outline wrap(int first) {
        int a = first, b = first, begin = max_corners / 2, end = begin;
        while (begin > 0) {
            const Meeting on = next<+1>(a);
            const bool closed = on.line == b || (turns(a, b) && !turns(on.line, b));
            corners_[end++] = {on.p, neighbour_[closed ? b : on.line]};
            if (closed) return {corners_ + begin, corners_ + end};
            a = on.line;
            const Meeting back = next<-1>(b);
            corners_[--begin] = {back.p, neighbour_[b]};
            if (back.line == a || (turns(a, b) && !turns(a, back.line)))
                return {corners_ + begin, corners_ + end};
            b = back.line;
        }
        return {};
    }

private:
    static constexpr int most = 128, walls = 4, max_corners = 64;
    alignas(64) double dx_[most + cell::lanes] = {}, dy_[most + cell::lanes] = {},
                                  h_[most + cell::lanes] = {};
    int32_t neighbour_[most + cell::lanes] = {};
    Corner corners_[max_corners];
    int size_ = 0;

    void set(int k, const HalfPlane& p) {
        dx_[k] = p.d.x, dy_[k] = p.d.y, h_[k] = p.h, neighbour_[k] = p.neighbour;
    }

    struct Meeting {
        Site p;
        int line;
    };
    // Where the edge of line j ends, counterclockwise (turn = 1) or clockwise (-1), and which line
    // ends it.  Of the points foot + t (-d.y, d.x), the foot nearest to the site, line k leaves
    // those with t <= num / den, if den > 0: the least of these ends the edge.
    template <int turn>
    [[gnu::always_inline]] Meeting next(int j) const {
        using namespace cell;
        // foot = d h / d^2: d = 1 for walls, h = d^2 / 2 for bisectors.
        const double x = dx_[j], y = dy_[j], scale = j < walls ? h_[j] : 0.5;
        const Site foot = {x * scale, y * scale};
        // Fractions are compared without dividing; at first they are infinite.
        Lanes num = Lanes{} + 1, den = {};
        Ints first = {}, id = iota(Indices());
        for (int at = 0; at < size_; at += lanes, id += lanes) {
            const Lanes kx = load(dx_ + at), ky = load(dy_ + at);
            const Lanes n = load(h_ + at) - (foot.x * kx + foot.y * ky),
                        d = turn > 0 ? x * ky - y * kx : y * kx - x * ky;
            const Ints less = (d > 0) & (n * den < num * d);
            num = less ? n : num;
            den = less ? d : den;
            first = less ? id : first;
        }
        const auto [t, k] = Least{num / den, first}.of_all();
        return {{foot.x - turn * t * y, foot.y + turn * t * x}, k};
    }

    // True if line b is less than half a turn after line a.
    bool turns(int a, int b) const { return dx_[a] * dy_[b] > dy_[a] * dx_[b]; }
};

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

}  // namespace penumbra
