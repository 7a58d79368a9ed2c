// course/judge_5.cpp  judges week 5: estimators of shadowed light
#include <numeric>

#include "course/judge.h"

using namespace penumbra;
using namespace course;

namespace {

constexpr double digit = 0x1p-53;  // moments are double, whatever `real` is

// ---- Samples, and their moments in two passes ---------------------------------------------------

struct LightSample {
    double U, w, wV;
};
using Samples = std::vector<LightSample>;

template <class Of>
long double mean_of(const Samples& samples, Of of) {
    long double sum = 0;
    for (const LightSample& s : samples) sum += of(s);
    return samples.empty() ? 0 : sum / (long double)(samples.size());
}
template <class F, class G>
long double comoment(const Samples& samples, F f, G g) {
    const long double f0 = mean_of(samples, f), g0 = mean_of(samples, g);
    long double sum = 0;
    for (const LightSample& s : samples) sum += (f(s) - f0) * (g(s) - g0);
    return sum;
}
constexpr auto of_U = [](const LightSample& s) { return (long double)(s.U); };
constexpr auto of_w = [](const LightSample& s) { return (long double)(s.w); };
constexpr auto of_wV = [](const LightSample& s) { return (long double)(s.wV); };
constexpr auto of_b = [](const LightSample& s) { return (long double)(s.w) - s.U; };

// n, U, w, wV, bb, b_wV, b_U: what the exercises are asked with.
Out moments_of(const Samples& s) {
    return {double(s.size()),
            double(mean_of(s, of_U)),
            double(mean_of(s, of_w)),
            double(mean_of(s, of_wV)),
            double(comoment(s, of_b, of_b)),
            double(comoment(s, of_b, of_wV)),
            double(comoment(s, of_b, of_U))};
}

// U differs from sample to sample; some light is hidden.
Samples pixel(int n, double nothing_hidden_below = 0.3) {
    Samples samples;
    for (int i = 0; i < n; ++i) {
        const double U = 1 + 0.5 * (i % 3), w = U + 0.125 * ((7 * i) % 11) - 0.5,
                     at = (5 * i % 8) / 8.0;
        samples.push_back({U, w, at < nothing_hidden_below ? 0 : w});
    }
    return samples;
}

Samples changed(Samples samples, const std::function<void(LightSample&)>& change) {
    for (LightSample& s : samples) change(s);
    return samples;
}
void light_up(LightSample& s) { s.wV = s.w; }
void darken(LightSample& s) { s.wV = 0; }

// Integrals over [0,1]: w = 2x, half of the interval hidden, W = 1, S = 1/4.
LightSample ramp(oracle::Random& random) {
    const double x = random();
    return {1, 2 * x, x < 0.5 ? 2 * x : 0};
}
// w = 3x^2, visible below 4/5: W = 1, S = .512.
LightSample parabola(oracle::Random& random) {
    const double x = random();
    return {1, 3 * x * x, x < 0.8 ? 3 * x * x : 0};
}

// `trials` estimates, each of n samples of the ramp.
Out estimates(Judge& j, const std::string& question, size_t n, size_t trials) {
    Rows rows;
    Samples samples(n);
    for (size_t t = 0; t < trials; ++t) {
        for (LightSample& s : samples) s = ramp(j.random);
        rows.add(moments_of(samples));
    }
    return j.ask(question, rows).numbers;
}

// Means of 32, whose tails are shorter.
Out in_groups(const Out& numbers) {
    Out means;
    for (size_t i = 0; i + 32 <= numbers.size(); i += 32)
        means.push_back(
            std::accumulate(numbers.begin() + long(i), numbers.begin() + long(i) + 32, 0.0) / 32);
    return means;
}
Out squared_errors(const Out& numbers, double truth, double factor) {
    Out squares;
    for (double x : numbers) squares.push_back((x - truth) * (x - truth) * factor);
    return squares;
}

double itself(double x) { return x; }

// Greatest difference of two lists, in units of the greater, or of 1.
double apart(const Out& a, const Out& b) {
    double most = 0;
    for (size_t i = 0; i < b.size(); ++i)
        most = worse(most, i < a.size() ? std::abs(a[i] - b[i]) / std::max(1.0, std::abs(b[i]))
                                        : oracle::infinity);
    for (double x : a) most = worse(most, 0 * x);
    return std::isnan(most) ? oracle::infinity : most;
}
// `names` are those of the numbers, if they have any.
void same(Judge& j, const std::string& what, const Out& came, const Out& expected, double tolerance,
          const std::vector<const char*>& names = {}) {
    size_t at = 0;
    for (size_t i = 0; i < expected.size(); ++i)
        if (apart({came.at(i)}, {expected[i]}) > apart({came.at(at)}, {expected[at]})) at = i;
    const std::string name = names.empty() ? "" : names[at] + std::string(": ");
    j.exact(what, apart(came, expected) <= tolerance,
            name + oracle::say("%.9g expected, %.9g came", expected[at], came.at(at)));
    j.items.back().off = std::abs(came.at(at) - expected[at]);
}

// ---- 5.1 ----------------------------------------------------------------------------------------

void control_variate(Judge& j) {
    const Out p =
        j.probe("control", {{2, 5, 0}, {2, 5, 5}, {3, 1, 0.25}, {0.5, 8, 7}, {1.5, 0, 0}}).numbers;
    same(j, "control(3, 1, 1/4) = 2.25", {p[2]}, {2.25}, 8 * digit);
    same(j, "control(2, 5, 0) = -3: a sample may be negative", {p[0]}, {-3}, 8 * digit);
    Rows lit, more, unlit;
    Out U, light;
    for (int i = 0; i < 32; ++i) {
        const double w = 4 * j.random();
        U.push_back(4 * j.random());
        light.push_back(j.random());
        lit.add({U.back(), w, w});
        more.add({U.back(), w, w + light.back()});
        unlit.add({U.back(), 0, 0});
    }
    const Out is_lit = j.ask("control", lit).numbers;
    same(j, "where nothing is in the way the estimate is U", is_lit, U, 32 * digit);
    Out gained = j.ask("control", more).numbers;
    for (size_t i = 0; i < gained.size(); ++i) gained[i] -= is_lit[i];
    same(j, "light that comes through counts as it is", gained, light, 64 * digit);
    same(j, "a sample of no light, w = 0, says nothing of shadows: it is U",
         j.ask("control", unlit).numbers, U, 32 * digit);
    same(j, "colours: every channel by itself",
         j.ask("control_of_colours", Out{2, 3, 0.5, 5, 1, 0, 0, 0.25, 0}), {-3, 2.25, 0.5},
         64 * j.epsilon);
    const Rows rows = rows_of(100000, [&](size_t) {
        const LightSample s = parabola(j.random);
        return Out{s.U, s.w, s.wV};
    });
    const Out one = j.ask("control", rows).numbers;
    j.mean("w = 3x^2, visible below x = 4/5: the mean is .512", 0.512, one, itself);
    j.mean("w = 3x^2, visible below x = 4/5: the variance is .972, as computed in the sheet",
           0.972032, squared_errors(one, 0.512, 1), itself);
}

// ---- 5.2 ----------------------------------------------------------------------------------------

void ratio(Judge& j) {
    // n, U, w, wV and moments, of which ratio needs none.
    const Rows asked = {{3, 2.5, 3, 2, 3.5, 3.5, 1.5},
                        {4, 2, 5, 5, 1, 1, 0},
                        {4, 2, 5, 0, 1, 0, 0},
                        {4, 2, 0, 0, 0, 0, 0}};
    const Out visible = j.probe("visible", asked).numbers, by = j.probe("ratio", asked).numbers;
    same(j, "U = 2.5, w = 3, w V = 2: two thirds come through", {visible[0], by[0]},
         {2 / 3.0, 5 / 3.0}, 8 * digit);
    same(j, "where nothing is in the way the estimate is U", {visible[1], by[1]}, {1, 2},
         8 * digit);
    same(j, "where everything is in the way the estimate is 0", {visible[2], by[2]}, {0, 0}, 0);
    same(j, "the estimate is 0 if no sample found any light", {visible[3], by[3]}, {0, 0}, 0);
    const Out faint =
        j.ask("ratio", {{4, 2e-60, 4e-60, 1e-60, 0, 0, 0}, {4, 2e60, 4e60, 1e60, 0, 0, 0}}).numbers;
    j.remember({1e60 * faint[0], 1e-60 * faint[1]});
    same(j, "the ratio is the same in dim light and in glaring light",
         {1e60 * faint[0], 1e-60 * faint[1]}, {0.5, 0.5}, 8 * digit);
    const double scale = 1 + 9 * j.random(), U = 1 + j.random(), w = 1 + j.random(),
                 wV = j.random();
    const Out of = j.ask("ratio", {{4, U, w, wV, 1, 1, 1},
                                   {4, U, scale * w, scale * wV, 1, 1, 1},
                                   {4, scale * U, w, wV, 1, 1, 1}})
                       .numbers;
    same(j, "w and w V twice as large change nothing, U twice as large doubles it", {of[1], of[2]},
         {of[0], scale * of[0]}, 64 * digit);
    j.mean("the ratio of one sample is biased: for the sheet's w = 2x the mean is 1/2, not 1/4",
           0.5, estimates(j, "ratio", 1, 40000), itself);
    const Out many = estimates(j, "ratio", 512, 19200);
    j.mean("of 512 samples the bias is gone but for 1/6 n", 0.25 + 1 / 6.0 / 512, many, itself);
    j.mean("of 512 samples n times the variance is 1/6", 1 / 6.0,
           in_groups(squared_errors(many, 0.25, 512)), itself);
}

// ---- 5.3 ----------------------------------------------------------------------------------------

void regression(Judge& j) {
    auto of = [&](const Samples& s) { return j.ask("regression", moments_of(s))[0]; };
    const Samples sixteen = pixel(16);
    j.probe("regression", {moments_of(sixteen), moments_of(pixel(7)), moments_of(pixel(8, 0.7)),
                           moments_of(changed(sixteen, light_up)),
                           moments_of(changed(sixteen, [](LightSample& s) { s.wV = 0.3 * s.w; })),
                           moments_of(Samples(20, {2, 3, 1.5}))});
    // Where least is hidden w V falls as w rises; and below 0 at w = U.
    const Samples falling = changed(sixteen, [](LightSample&s) { s.wV = 2 - s.w / 4; }),
                  below = changed(sixteen, [](LightSample&s) {
                      s.w = 2 + (s.w - s.U), s.U = 1, s.wV = 0.5 * (s.w - 1) - 0.25;
                  });
    const Out further = j.probe("regression", {moments_of(falling), moments_of(below)}).numbers;
    double lit = 0, dark = 0, grey = 0, line = 0;
    for (int k = 0; k < 16; ++k) {
        Samples random(8 + size_t(k));
        for (LightSample& s : random)
            s.U = 1 + j.random(), s.w = s.U * (0.5 + j.random()), s.wV = s.w * j.random();
        const double U = double(mean_of(random, of_U)), part = j.random(), S = j.random(),
                     slope = 2 * j.random() - 1;
        auto of_changed = [&](auto change) { return of(changed(random, change)); };
        lit = worse(lit, apart({of_changed(light_up)}, {U}));
        dark = worse(dark, std::abs(of_changed(darken)));
        const double behind = of_changed([&](LightSample& s) { s.wV = part * s.w; });
        grey = worse(grey, apart({behind}, {part * U}));
        const double on_line =
            of_changed([&](LightSample& s) { s.U = 1.25, s.wV = S + slope * (s.w - 1.25); });
        line = worse(line, apart({on_line}, {S}));
    }
    const char* off = "it is off by %.3g";
    j.exact("where nothing is in the way the estimate is U, and 0 where everything is",
            lit < 1e-12 && dark < 1e-12, oracle::say(off, std::max(lit, dark)));
    j.below("behind grey glass the estimate is that part of U, though U varies", grey, 1e-12, off);
    j.below("points (w, w V) on a line: its value at w = U", line, 1e-11, off);
    j.number("of seven samples the estimate is what ratio says",
             j.ask("regression", Out{7, 2.5, 3, 2, 3.5, 3.5, 1.5}).at(0), 5 / 3.0, 16 * digit);
    j.number("where w does not vary the estimate is what ratio says", of(Samples(20, {2, 3, 1.5})),
             1, 16 * digit);
    j.number("if the line is below 0 at w = U, the estimate is, too", further[1], -0.25, 1e-12);
    for (const auto& [what, scale] : {std::pair("dim light scales the estimate", 0x1p-50),
                                      {"glaring light scales the estimate", 0x1p50}}) {
        const double there = of(
            changed(sixteen, [by = scale](LightSample& s) { s.U *= by, s.w *= by, s.wV *= by; }));
        j.number(what, there / scale, of(sixteen), 1e-12);
        j.limit();
        j.remember({there / scale});
    }
    const Out many = estimates(j, "regression", 1024, 19200);
    j.mean("of 1024 samples of w = 2x the bias is gone but for 1/8 n", 0.25 + 1 / 8.0 / 1024, many,
           itself);
    j.mean("of 1024 samples n times the variance is 1/12, half of what ratio has", 1 / 12.0,
           in_groups(squared_errors(many, 0.25, 1024)), itself);
}

// ---- 5.4 ----------------------------------------------------------------------------------------

Out flat(const Samples& samples) {
    Out numbers;
    for (const auto& [U, w, wV] : samples) numbers.insert(numbers.end(), {U, w, wV});
    return numbers;
}
// Of all samples, from the first ones and the others.
Rows merging(const Samples& samples, size_t first) { return Rows(row(first, flat(samples))); }
Out merged(Judge& j, const Samples& samples, size_t first) {
    return j.ask("merged", merging(samples, first)).numbers;
}
Out part(const Out& m, size_t from, size_t to) {
    return {m.begin() + long(from), m.begin() + long(to)};
}

void moments(Judge& j) {
    const Samples three = {{2, 1, 1}, {2, 3, 0}, {3.5, 5, 5}}, twelve = pixel(12);
    const Out by_hand = j.probe("moments", Rows(flat(three))).numbers,
              in_parts = j.probe("merged", merging(twelve, 5)).numbers;
    const std::vector<const char*> names = {"n", "U", "w", "wV", "bb", "b_wV", "b_U"};
    same(j, "three samples by hand: n and the means", part(by_hand, 0, 4), {3, 2.5, 3, 2},
         16 * digit, names);
    same(j, "three samples by hand: the moments bb = 3.5, b_wV = 3.5, b_U = 1.5",
         part(by_hand, 4, 7), {3.5, 3.5, 1.5}, 16 * digit, {"bb", "b_wV", "b_U"});
    const Out one = j.ask("moments", Out{2, 3, 1});
    same(j, "one sample is its own mean, and has no spread", one, {1, 2, 3, 1, 0, 0, 0}, 0, names);
    const Out expected = moments_of(twelve);
    same(j, "add: twelve samples agree with two passes", j.ask("moments", flat(twelve)), expected,
         1e-13, names);
    same(j, "merge: five and seven are all twelve", in_parts, expected, 1e-13, names);
    same(j, "a part without samples changes nothing, first or last",
         {apart(merged(j, twelve, 0), expected), apart(merged(j, twelve, 12), expected)}, {0, 0},
         1e-13, {"first", "last"});
    j.limit();
    same(j, "two parts without samples are none", merged(j, {}, 0), Out(7), 0, names);
    j.limit();
    // Far from 0, where sums of squares have lost all their digits.
    Samples far;
    for (int i = 0; i < 300; ++i) {
        const double U = 1e8 + i % 7, w = U + 2 * j.random() - 1;
        far.push_back({U, w, j.random() < 0.3 ? 0 : w});
    }
    const Out there = j.ask("moments", flat(far)), truth = moments_of(far);
    const double most_wV = std::sqrt(truth[4] * double(comoment(far, of_wV, of_wV))),
                 most_U = std::sqrt(truth[4] * double(comoment(far, of_U, of_U)));
    same(j, "moments of numbers near 1e8 keep six digits",
         {there[4] / truth[4], (there[5] - truth[5]) / most_wV, (there[6] - truth[6]) / most_U},
         {1, 0, 0}, 1e-6, {"bb, in parts of itself", "b_wV, off by", "b_U, off by"});
    j.limit();
    const Out lit = j.ask("moments", flat(changed(far, light_up)));
    j.exact("equal numbers have equal means, to the last bit", lit.at(2) == lit.at(3),
            oracle::say("%.17g and %.17g", lit.at(2), lit.at(3)));
    j.limit();
    // Any samples, and where they are parted.
    Worst add, merge;
    for (int k = 0; k < 40; ++k) {
        Samples any(2 + size_t(20 * j.random()));
        for (LightSample& s : any)
            s.U = j.random(), s.w = j.random(), s.wV = j.random() < 0.3 ? 0 : s.w;
        const Out two_passes = moments_of(any), added = j.ask("moments", flat(any)),
                  both = merged(j, any, 1 + size_t(double(any.size() - 1) * j.random()));
        for (size_t i = 0; i < 7; ++i) {
            const double by = apart({added[i]}, {two_passes[i]}),
                         merged_by = apart({both[i]}, {two_passes[i]});
            add.see(by, names[i] + oracle::say(" is off by %.3g", by));
            merge.see(merged_by, names[i] + oracle::say(" is off by %.3g", merged_by));
        }
    }
    j.worst("add: any samples", add, 1e-12);
    j.worst("merge: any two parts of them", merge, 1e-12);
}

// ---- 5.5 ----------------------------------------------------------------------------------------

using Vertices = std::vector<Triple>;

Out corners(const Vertices& p) {
    Out numbers;
    for (const Triple& v : p) numbers = row(numbers, v);
    return numbers;
}

// The integral of cos cos' / r^2 over a triangle's area.
double by_quadrature(const Vertices& t) {
    const Triple e = t[1] - t[0], f = t[2] - t[0];
    const double volume = std::abs(dot(t[0], cross(e, f)));  // p . (e x f) of every point p
    const oracle::Agreement digits{.tolerance = 1e-17, .noise = 1e-12};
    const auto at_s = [&](double s) {
        const auto at_u = [&](double u) {
            const Triple p = t[0] + s * ((1 - u) * e + u * f);
            return s * volume * p[2] / (dot(p, p) * dot(p, p));
        };
        return oracle::integral(at_u, 0, 1, digits);
    };
    return oracle::integral(at_s, 0, 1, digits);
}

// Multiples of 1/64, which float has exactly.
Vertices random_triangle(oracle::Random& random) {
    auto number = [&](double from, double to) {
        return std::round(64 * (from + (to - from) * random())) / 64;
    };
    const double x = number(-2, 2), y = number(-2, 2), z = number(0.5, 2);
    return {{x, y, z},
            {x + number(0.5, 1.5), y + number(-0.25, 0.25), z + number(0, 1)},
            {x + number(-0.25, 0.25), y + number(0.5, 1.5), z + number(0, 1)}};
}

void lambert(Judge& j) {
    const double digits = 64 * j.epsilon, whole = 1.7408395027342063;
    const Vertices square = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
    const Vertices wide = {{-3, 0.25, 0.5}, {3, 0.25, 0.5}, {0, 2, 1}};
    const Vertices narrow = {{1, 0.5, 1}, {2, 0.5, 1.5}, {1.5, 2, 1}};
    const double first = j.probe("lambert", Rows(corners(square))).numbers[0];
    const Out three = j.probe("lambert", {corners(wide), corners(narrow)}).numbers;
    auto of = [&](const Vertices& p) { return j.ask("lambert", corners(p)).at(0); };
    j.number("the sheet's square of side 2 at height 1", first, whole, digits);
    j.number("a triangle with an edge seen under 160 degrees", three[0], by_quadrature(wide),
             std::max(1e-9, digits));
    j.number("a square that is seen from behind sends as much",
             of({square.rbegin(), square.rend()}), first, digits);
    j.number("two halves are the whole",
             of({square[0], square[1], square[2]}) + of({square[0], square[2], square[3]}), whole,
             digits);
    j.number("a corner that is there twice changes nothing",
             of({square[0], square[0], square[1], square[2], square[3]}), whole, digits);
    Vertices far = square;
    for (size_t i = 0; i < 4; ++i) far[i] = double(i + 2) * far[i];
    j.number("only directions count: corners moved along their rays", of(far), whole, digits);
    j.number("a ceiling without end sends pi",
             of({{-1e6, -1e6, 1}, {1e6, -1e6, 1}, {1e6, 1e6, 1}, {-1e6, 1e6, 1}}), oracle::pi,
             std::max(1e-5, digits));
    double off = 0;
    for (int k = 0; k < 24; ++k) {
        const Vertices t = random_triangle(j.random);
        const double came = of(t), truth = by_quadrature(t);
        off = worse(off, std::abs(came - truth));
    }
    j.below("triangles at random are what quadrature says", off, std::max(1e-9, digits),
            "one is off by %.3g");
    // Small ones far away: of 16 digits 10 are left, of 7 in float 2.
    const double small = j.epsilon > 0x1p-50 ? 0.05 : 1e-3;
    double lost = 0;
    for (int k = 0; k < 12; ++k) {
        const Triple at = unit(any_direction(j.random) + Triple{0, 0, 1.5});
        Vertices t;
        for (int i = 0; i < 3; ++i) t.push_back(at + small * any_direction(j.random));
        const double truth = by_quadrature(t);
        if (truth > 0.1 * small * small) lost = worse(lost, std::abs(of(t) / truth - 1));
    }
    j.below("small triangles keep their digits", lost, small == 1e-3 ? 1e-8 : 0.05,
            "one is off by %.3g of itself");
    j.limit();
    // Without its short edge the long ones do not cancel.
    const double width = small == 1e-3 ? 1e-9 : 0.05;
    const Vertices needle = {{0.5, 0, 1}, {0.5 + width, width / 2, 1}, {0.25, 1, 1.5}};
    const double part = of(needle) / by_quadrature(needle);
    j.number("a needle: its short edge counts, too, in parts of the truth", part, 1,
             small == 1e-3 ? 1e-5 : 0.05);
    j.remember({std::round(8 * part)});
    j.limit();
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"5.1", control_variate},
                          {"5.2", ratio},
                          {"5.3", regression},
                          {"5.4", moments},
                          {"5.5", lambert}});
}
