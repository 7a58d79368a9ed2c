// course/judge_1_tree.h  judges 1.5 and 1.6: the tree, and where it divides boxes
#pragma once
#include <chrono>

#include "course/judge_1_shapes.h"

namespace penumbra::course {
namespace {

// ---- 1.5  The tree ------------------------------------------------------------------------------

// A tree as the program is asked about it: of a node its first child or shape, its count, where a
// ray enters it and where it meets what is in the leaf, or -1.
struct Table {
    Out numbers{endless};
    size_t nodes = 1;

    explicit Table(double tmax = endless) : numbers{tmax, 0, 0, 0, -1} {}
    double& enter(size_t i) { return numbers[3 + 4 * i]; }
    double& hit(size_t i) { return numbers[4 + 4 * i]; }
    bool is_leaf(size_t i) const { return numbers[2 + 4 * i] > 0; }

    // Gives a node two children, and says the first of them.
    size_t divide(size_t i, double enter_left, double enter_right) {
        const size_t left = nodes;
        numbers[1 + 4 * i] = double(left);
        nodes += 2;
        for (double e : {enter_left, enter_right}) numbers.insert(numbers.end(), {0, 0, e, -1});
        return left;
    }
    void make_leaf(size_t i, double t) {
        numbers[1 + 4 * i] = 0, numbers[2 + 4 * i] = 1, hit(i) = t;
    }
};

Table two_leaves(double enter_left, double hit_left, double enter_right, double hit_right,
                 double tmax = endless) {
    Table t(tmax);
    t.divide(0, enter_left, enter_right);
    t.make_leaf(1, hit_left), t.make_leaf(2, hit_right);
    return t;
}

// Full, eight levels deep; each box is entered behind its parent's, or missed.
void grow(Judge& j, Table& t, size_t i, int levels) {
    auto wait = [&] { return -std::log(1 - j.random()); };
    const double e = t.enter(i);
    if (levels == 0) return t.make_leaf(i, e >= 0 && j.random() < 0.35 ? e + 0.5 * wait() : -1);
    const double l = e >= 0 && j.random() < 0.8 ? e + 0.4 * wait() : -1;
    const double r = e >= 0 && j.random() < 0.8 ? e + 0.4 * wait() : -1;
    const size_t left = t.divide(i, l, r);
    grow(j, t, left, levels - 1), grow(j, t, left + 1, levels - 1);
}

void random_trees(Judge& j) {
    const size_t n = 600;
    Rows trees;
    Out nearest, needed;  // the nearest hit; leaves that begin before it, which none can leave out
    for (size_t i = 0; i < n; ++i) {
        // Every fourth ray ends somewhere.
        Table t(i % 4 ? endless : between(j, 0, 3));
        grow(j, t, 0, 8);
        double best = t.numbers[0], before = 0;
        for (size_t k = 0; k < t.nodes; ++k)
            if (t.is_leaf(k) && t.hit(k) >= 0) best = std::min(best, t.hit(k));
        for (size_t k = 0; k < t.nodes; ++k)
            before += t.is_leaf(k) && t.enter(k) >= 0 && t.enter(k) <= best;
        trees.add(t.numbers);
        nearest.push_back(best < t.numbers[0] ? best : -1), needed.push_back(before);
    }
    const Rows came = j.ask("nearest_hit", trees);
    double boxes = 0, leaves = 0, least = 0;
    Several hits;
    for (size_t i = 0; i < n; ++i) {
        hits.see(std::abs(came[i][0] - nearest[i]) <= 8 * j.epsilon * (nearest[i] + 1),
                 say("t = %.6g expected, %.6g came", nearest[i], came[i][0]));
        boxes += came[i][2] / n, leaves += came[i][3] / n, least += needed[i] / n;
    }
    j.all("in 600 trees of 256 leaves the nearest hit is found", hits);
    // 1.74 times by the nearer child first, 2.4 by the left one first, 7.5 if none is skipped; and
    // 79 boxes, 145 if none is skipped, 256 by asking each leaf.
    j.exact("no more leaves than that need to be looked at", leaves < 2.05 * least,
            say("%.1f a ray, of which %.1f cannot be avoided; at most %.1f expected", leaves, least,
                2.05 * least));
    j.exact("whole subtrees are skipped, and no box is asked twice", boxes < 110,
            say("%.1f boxes a ray, at most 110 expected", boxes));
}

void tree(Judge& j) {
    Rows pairs;
    for (const Table& t :
         {two_leaves(1, 1.5, 2, 2.5), two_leaves(2, 2.5, 1, 1.5), two_leaves(1, 3, 2, 2.5),
          two_leaves(1, -1, 2, 2.5), two_leaves(1, 1.5, 2, 2.5, 0.5), two_leaves(-1, -1, 1, 2)})
        pairs.add(t.numbers);
    const Rows came = j.probe("nearest_hit", pairs);
    auto finds = [&](const std::string& what, size_t i, double t, Out order) {
        const In c = came[i];
        bool right = std::abs(c[0] - t) < 16 * j.epsilon && c[3] == double(order.size());
        for (size_t k = 0; k < order.size(); ++k) right = right && c[4 + k] == order[k];
        std::string seen = say("t = %.6g; leaves looked at:", c[0]);
        for (size_t k = 0; k < 6 && c[4 + k] >= 0; ++k) seen += c[4 + k] == 1 ? " left" : " right";
        if (!(c[4] >= 0)) seen += " none";
        j.exact(what, right, seen + say(" (t = %.6g and %zu expected)", t, order.size()));
    };
    finds("the left leaf is nearer, and its hit is before the right one: one is looked at", 0, 1.5,
          {1});
    finds("the right leaf is nearer, and its hit is before the left one: one is looked at", 1, 1.5,
          {2});
    finds("a hit behind where the other leaf begins: both are looked at, the nearer hit counts", 2,
          2.5, {1, 2});
    finds("no hit in the nearer leaf: the other one is looked at", 3, 2.5, {1, 2});
    finds("what begins beyond the end of the ray is not looked at", 4, -1, {});
    finds("a box that is missed is not looked at", 5, 2, {2});
    // Exactly; with a scale that is a power of two.
    const auto number = [&](const std::string& what, const Table& asked, double t,
                            double scale = 1) {
        const Out c = j.ask("nearest_hit", asked.numbers);
        j.number(what, c[0] / scale, t, 0);
        j.limit();
        // With what was looked at: searches that go astray in other ways may have the same hit.
        j.remember(row(c[0] / scale, Out(c.begin() + 1, c.end())));
    };
    // The left child's second leaf begins behind the hit in its first, the right leaf before it.
    Table three;
    three.divide(0, 1, 4);
    three.make_leaf(2, 4.5);
    three.divide(1, 2, 6);
    three.make_leaf(3, 5), three.make_leaf(4, -1);
    number("a box that begins behind the hit is left out, and others still wait", three, 4.5);
    number("boxes that the ray starts in, which it enters at 0, are opened",
           two_leaves(0, 0.5, 0, 0.25), 0.25);
    Table at_end(3);
    at_end.make_leaf(0, 3), at_end.enter(0) = 3;
    number("the end of the ray belongs to it: a box that begins there is opened", at_end, 3);
    const double tiny = 0x1p-24;
    number("boxes that the ray starts in are opened where all is tiny, too, in units of 2^-24",
           two_leaves(tiny, 3 * tiny, 2 * tiny, 2.5 * tiny), 2.5, tiny);
    Table single, missed;
    single.make_leaf(0, 3), missed.make_leaf(0, 3), missed.enter(0) = -1;
    j.number("a tree that is one leaf", j.ask("nearest_hit", single.numbers)[0], 3, 8 * j.epsilon);
    j.limit();
    j.number("nothing is looked at where the ray misses the root",
             j.ask("nearest_hit", missed.numbers)[3], 0, 0);
    telling_limit(j);
    // At every level a leaf has to wait; one of them is hit.
    Worst deep;
    for (int hit : {0, 1, 15, 31, 63}) {
        Table spine;
        size_t at = 0;
        for (int level = 0; level < 64; ++level) {
            const size_t left = spine.divide(at, level, level + 0.5);
            spine.make_leaf(left + 1, level == hit ? 70.0 : -1), at = left;
        }
        spine.make_leaf(at, -1);
        const double t = j.ask("nearest_hit", spine.numbers)[0];
        deep.see(std::abs(t - 70), say("t = 70 expected, %.6g came", t));
    }
    j.worst("64 levels, on each of which a leaf waits", deep, 8 * 70 * j.epsilon);
    random_trees(j);
}

// ---- 1.6  Where to divide -----------------------------------------------------------------------

// A cube of this size at a place, as six numbers.
void add_box(Out& boxes, Triple lo, Triple size) { boxes = row(boxes, lo, lo + size); }

// Edges of the box about some of a row's boxes, each with its lower and upper corner.
Triple edges_about(In boxes, size_t from, size_t to) {
    Triple lo = triple(boxes, 6 * from), hi = triple(boxes, 6 * from + 3);
    for (size_t k = from; k < to; ++k)
        for (size_t a = 0; a < 3; ++a)
            lo[a] = std::min(lo[a], boxes[6 * k + a]),
            hi[a] = std::max(hi[a], boxes[6 * k + 3 + a]);
    return hi - lo;
}
double half_area(const Triple& e) { return e[0] * e[1] + e[1] * e[2] + e[2] * e[0]; }

double half_area(In boxes, size_t from, size_t to) {
    return half_area(edges_about(boxes, from, to));
}
double cost_of(In boxes, size_t left) {
    const size_t n = boxes.size() / 6;
    return double(left) * half_area(boxes, 0, left) + double(n - left) * half_area(boxes, left, n);
}

// What a cost may be in place of A_l n_l + A_r n_r, and what it looks like.
const char* const causes[] = {
    "so much it costs, but is every division tried?",
    "looks like whole areas, where half areas belong",
    "looks like a cost that is divided by the area about all boxes",
    "looks like the cost of a renderer that counts a node, too, and divides by the area about all "
    "boxes",
    "looks like lengths of edges in place of areas",
    "looks like sums of the boxes' own areas in place of the areas about them",
    "looks like an area on the right that is all the area less the left one",
    "looks like areas about the centres of boxes, not about the boxes"};
Out costs_of(In boxes, size_t left) {
    const size_t n = boxes.size() / 6;
    const double cost = cost_of(boxes, left), all = half_area(boxes, 0, n), l = double(left),
                 r = double(n - left), of_left = half_area(boxes, 0, left);
    const auto edges = [&](size_t from, size_t to) {
        const Triple e = edges_about(boxes, from, to);
        return e[0] + e[1] + e[2];
    };
    double own[2] = {0, 0};
    Out centres;
    for (size_t k = 0; k < n; ++k) {
        own[k >= left] += half_area(boxes, k, k + 1);
        add_box(centres, 0.5 * (triple(boxes, 6 * k) + triple(boxes, 6 * k + 3)), {});
    }
    return {cost,
            2 * cost,
            cost / all,
            0.125 + cost / all,
            l * edges(0, left) + r * edges(left, n),
            l * own[0] + r * own[1],
            l * of_left + r * (all - of_left),
            cost_of(centres, left)};
}
// Of divisions that came, if one cause explains all of them.
std::string cause_of_costs(const std::vector<Out>& rows, const std::vector<Out>& came) {
    for (size_t k = 0; k < std::size(causes); ++k) {
        bool holds = true;
        for (size_t i = 0; holds && i < rows.size(); ++i) {
            const double left = came[i][1];
            holds = left >= 1 && left < double(rows[i].size() / 6) &&
                    near(came[i][0], costs_of(rows[i], size_t(left))[k], 1e-6);
        }
        if (holds) return std::string(": ") + causes[k];
    }
    return "";
}

// So many boxes in one place, and others in a place far away: cheapest is to part the two places.
void clusters(Judge& j) {
    Several heaps;
    for (int i = 0; i < 200; ++i) {
        Out boxes;
        double cost = 0;
        const size_t n[] = {1 + size_t(9 * j.random()), 1 + size_t(9 * j.random())};
        for (size_t k : {0, 1}) {
            Triple lo = in_cube(j), size;
            lo[size_t(i % 3)] += 40 * double(k);
            for (double& x : size) x = between(j, 0.1, 2);
            for (size_t m = 0; m < n[k]; ++m) add_box(boxes, lo, size);
            cost += double(n[k]) * half_area(size);
        }
        const Out d = j.ask("best_split", boxes);
        heaps.see(d[1] == double(n[0]) && std::abs(d[0] - cost) < 1024 * j.epsilon * cost,
                  say("%zu boxes here and %zu far away: cost %.6g after %zu expected, %.6g after "
                      "%.0f came",
                      n[0], n[1], cost, n[0], d[0], d[1]));
    }
    j.all("two heaps far from each other are parted, at the sum of their costs", heaps);
}

// Any boxes, flat and alike ones among them: the cheapest of all divisions, tried one by one.
void any_boxes(Judge& j) {
    Several rows;
    std::vector<Out> wrong, came;
    size_t none = 0;
    for (int i = 0; i < 300; ++i) {
        const size_t n = 2 + size_t(14 * j.random());
        Out boxes;
        for (size_t k = 0; k < n; ++k) {
            Triple lo = 4 * in_cube(j), size;
            for (double& x : size) x = j.random() < 0.1 ? 0 : between(j, 0, 2);
            if (i % 5 == 0 && k > 0) lo = triple(boxes), size = triple(boxes, 3) - lo;
            add_box(boxes, lo, size);
        }
        double best = endless;
        for (size_t left = 1; left < n; ++left) best = std::min(best, cost_of(boxes, left));
        const Out d = j.ask("best_split", boxes);
        const double off = 4096 * j.epsilon * best;
        const bool parts = d[1] >= 1 && d[1] < double(n);
        none += !parts;
        // Where two are equally cheap, rounding decides.
        const bool right =
            parts && std::abs(d[0] - best) <= off && cost_of(boxes, size_t(d[1])) <= best + off;
        rows.see(right, say("of %zu boxes the cheapest division costs %.6g, %.6g after %.0f came",
                            n, best, d[0], d[1]));
        if (!right) wrong.push_back(boxes), came.push_back(d);
    }
    if (!wrong.empty()) rows.first += cause_of_costs(wrong, came);
    j.all("300 rows of any boxes: the cheapest of all divisions", rows);
    j.none("both sides have boxes", none, "one side of %zu of 300 divisions has none");
}

// By a sweep from each end, eight times as many boxes take some eight times as long, not 64 times.
// A machine that is busy with other things may spoil one comparison, not all.
void two_sweeps(Judge& j) {
    const auto seconds = [&](size_t n) {
        Out boxes;
        for (size_t i = 0; i < n; ++i)
            add_box(boxes, {double(i), j.random(), j.random()}, {1, j.random(), j.random()});
        const auto start = std::chrono::steady_clock::now();
        j.ask("best_split", boxes);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    double least = endless;
    for (int i = 0; i < 9 && least > 24; ++i) {
        const double few = seconds(1000);
        least = std::min(least, seconds(8000) / few);
    }
    j.exact(
        "eight times as many boxes take not much more than eight times as long", least <= 24,
        say("%.0f times as long: is the box about one side made anew for every division?", least));
    j.limit();
}

void division(Judge& j) {
    // Lower and upper corners of boxes.
    const struct {
        std::string what;
        double cost, left;
        const char* boxes;
    } worked[] = {
        {"two boxes are parted, at the sum of their areas", 8, 1, "0 0 0  1 1 1  2 0 0  4 1 1"},
        {"four in a row and a distant fifth: the fifth is alone", 39, 4,
         "0 0 0  1 1 1  1 0 0  2 1 1  2 0 0  3 1 1  3 0 0  4 1 1  9 0 0  10 1 1"},
        {"a distant first one is alone", 39, 1,
         "0 0 0  1 1 1  7 0 0  8 1 1  8 0 0  9 1 1  9 0 0  10 1 1  10 0 0  11 1 1"},
        {"a large one among small ones is alone", 524, 1,
         "0 0 0  8 8 8  5 5 5  6 6 6  6 2 1  7 3 2  7 1 6  8 2 8  8 4 4  9 5 5"},
        {"boxes of all sizes, some of them flat", 210, 3,
         "0 0 0  4 4 0  1 1 1  3 3 1  0 0 2  1 1 3  2 3 3  3 5 4  0 0 5  5 5 5"},
        {"boxes that overlap", 334, 3,
         "0 3 1  2 4 2  1 0 0  2 2 6  3 1 1  4 2 2  4 4 4  7 7 5  6 0 0  7 1 1"}};
    std::vector<Out> rows, came;
    for (const auto& w : worked) {
        Out boxes;
        std::istringstream words(w.boxes);
        for (double x; words >> x;) boxes.push_back(x);
        const Rows d = j.probe("best_split", Rows(boxes));
        j.exact(w.what, std::abs(d[0][0] - w.cost) < 64 * j.epsilon * w.cost && d[0][1] == w.left,
                say("a cost of %g after %g boxes expected, %g after %g came", w.cost, w.left,
                    d[0][0], d[0][1]));
        rows.push_back(boxes), came.push_back({d[0][0], d[0][1]});
    }
    const std::string cause = cause_of_costs(rows, came);
    for (Item& i : j.items) i.seen += cause;
    any_boxes(j);
    clusters(j);
    two_sweeps(j);
}

}  // namespace
}  // namespace penumbra::course
