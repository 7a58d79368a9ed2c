// course/hidden_subjects.h  the subjects by which tests of week 6 are graded: no student sees them
//
// Wrong ones are wrong by 4 % of something, or more, or by 1 % of a distance; right ones look wrong
// to a test that expects the textbook's way.
#pragma once
#include "course/practice.h"

namespace penumbra::course {
namespace {

using Pair = std::function<std::optional<vec3>(double, double)>;

constexpr double whole_turn = 2 * std::numbers::pi, one_over_pi = 1 / std::numbers::pi;

// ---- Samplers -----------------------------------------------------------------------------------

double cosine_pdf(vec3 w) { return w.z > 0 ? w.z * one_over_pi : 0; }
double uniform_pdf(vec3 w) { return w.z > 0 ? 1 / whole_turn : 0; }
vec3 cosine_sample(double u, double v) { return about_z(std::sqrt(1 - u), whole_turn * v); }
vec3 uniform_sample(double u, double v) { return about_z(1 - u, whole_turn * v); }

double power_pdf(vec3 w, double n) {
    return w.z > 0 ? (n + 1) / whole_turn * std::pow(double(w.z), n) : 0;
}
vec3 power_sample(double u, double v, double n) {
    return about_z(std::pow(1 - u, 1 / (n + 1)), whole_turn * v);
}

// z follows from the first number.
template <class Z>
Pair turned(Z z) {
    return [z](double u, double v) { return about_z(z(u), whole_turn * v); };
}

// Concentric squares become concentric circles (Shirley, Chiu 1997).
vec3 concentric_sample(double u, double v) {
    const double x = 2 * u - 1, y = 2 * v - 1;
    if (x == 0 && y == 0) return {0, 0, 1};
    const bool wide = std::abs(x) > std::abs(y);
    const double r = wide ? x : y, eighth = std::numbers::pi / 4;
    const double phi = wide ? eighth * y / x : 2 * eighth - eighth * x / y;
    return {real(r * std::cos(phi)), real(r * std::sin(phi)), real(std::sqrt(1 - r * r))};
}

// All of it in float.  At both ends of u is the horizon, which rounding may take to z = -4e-8.
vec3 float_sample(double u, double v) {
    const float r = std::sqrt(std::abs(2 * float(u) - 1)),
                phi = 2 * std::numbers::pi_v<float> * float(v);
    const float x = r * std::cos(phi), y = r * std::sin(phi);
    return {x, y, std::cos(std::asin(r))};
}

// About an axis of 45 degrees: what falls below the horizon is rejected.
constexpr vec3 tilted{real(std::numbers::sqrt2 / 2), 0, real(std::numbers::sqrt2 / 2)};
std::optional<vec3> tilted_sample(double u, double v) {
    const vec3 w = frame(tilted).to_world(power_sample(u, v, 3));
    return w.z > 0 ? std::optional(w) : std::nullopt;
}
double tilted_pdf(vec3 w) { return w.z > 0 ? power_pdf({0, 0, dot(w, tilted)}, 3) : 0; }

// Cosine with a probability, or else uniform.
Pair mixed(double share) {
    return [=](double u, double v) {
        return u < share ? cosine_sample(u / share, v)
                         : uniform_sample((u - share) / (1 - share), v);
    };
}
auto mixed_pdf(double share) {
    return [=](vec3 w) { return share * cosine_pdf(w) + (1 - share) * uniform_pdf(w); };
}

// An ellipse of the tangent plane at z = 1: x = 2 tan, y = tan / 2 of a cosine-sampled direction.
vec3 stretched_sample(double u, double v) {
    const vec3 w = cosine_sample(u, v);
    return unit({2 * w.x, w.y / 2, w.z});
}
double stretched_pdf(vec3 w) {
    const vec3 from = {w.x / 2, 2 * w.y, w.z};
    return w.z > 0 ? cosine_pdf(unit(from)) / std::pow(double(length(from)), 3) : 0;
}

Lineup<Sampler> hidden_samplers() {
    auto power = [](double n) { return [n](vec3 w) { return power_pdf(w, n); }; };
    const Pair lobe = [](double u, double v) { return power_sample(u, v, 20); };
    return {
        {{"the form of the density: the radius is u",
          {turned([](double u) { return std::sqrt(1 - u * u); }), cosine_pdf}},
         {"the form of the density: uniform under the cosine's density",
          {uniform_sample, cosine_pdf}},
         {"the form of the density: the cosine under a uniform density",
          {cosine_sample, uniform_pdf}},
         {"a factor of the density: 1 / pi forgotten",
          {cosine_sample, [](vec3 w) { return std::max(0.0, double(w.z)); }}},
         {"a factor of the density: the lobe's n + 2 for n + 1",
          {lobe, [](vec3 w) { return 22.0 / 21 * power_pdf(w, 20); }}},
         {"the form of the density: the exponent of the density is one less", {lobe, power(19)}},
         {"pairs that cover a part alone: half a turn",
          {[](double u, double v) { return cosine_sample(u, v / 2); }, cosine_pdf}},
         {"the form of the density: equal steps of the angle",
          {turned([](double u) { return std::cos(u * std::numbers::pi / 2); }), uniform_pdf}},
         {"the horizon: positive below the horizon",
          {cosine_sample, [](vec3 w) { return std::abs(w.z) * one_over_pi; }}},
         {"lengths: directions of other lengths",
          {[](double u, double v) {
               const vec3 w = cosine_sample(u, v);
               return vec3{w.x, w.y, w.z * w.z};
           },
           cosine_pdf}},
         {"lengths: directions of length 0.96",
          {[](double u, double v) { return real(0.96) * cosine_sample(u, v); }, cosine_pdf}},
         {"the borders of the square: a logarithm of 0 at the border",
          {[](double u, double v) {
               return about_z(std::exp(std::log(u) / 2), whole_turn * v + 0 * std::log(u));
           },
           cosine_pdf}},
         {"the borders of the square: near u = 1 rounding leaves the disc",
          {[](double u, double v) {
               const double r2 = u * (1 + 0x1p-22);
               return about_z(std::sqrt(1 - r2), whole_turn * v);
           },
           cosine_pdf}},
         {"the form of the density: shares exchanged", {mixed(0.6), mixed_pdf(0.4)}},
         {"a factor of the density: rejects, and does not say so",
          {tilted_sample, [](vec3 w) { return 1.2 * tilted_pdf(w); }}},
         {"pairs that cover a part alone: one number for both",
          {[](double, double v) { return cosine_sample(v, v); }, cosine_pdf}},
         {"the form of the density: stretched, without the Jacobian",
          {stretched_sample,
           [](vec3 w) {
               return w.z > 0 ? cosine_pdf(unit({w.x / 2, 2 * w.y, w.z})) : 0;
           }}},
         {"the form of the density: stretched the other way",
          {[](double u, double v) {
               const vec3 w = stretched_sample(u, v);
               return vec3{w.y, w.x, w.z};
           },
           stretched_pdf}}},
        {{"another way: concentric circles", {concentric_sample, cosine_pdf}},
         {"the rounding of float: float",
          {float_sample, [](vec3 w) { return w.z > 0 ? float(w.z) * 0.31830987f : 0.0f; }}},
         {"another way: a mixture", {mixed(0.3), mixed_pdf(0.3)}},
         {"rejected pairs: rejects what is below the horizon", {tilted_sample, tilted_pdf}},
         {"another way: the numbers exchanged and turned, in four sheets",
          {[](double u, double v) {
               return uniform_sample(2 * std::abs(v - 0.5), std::fmod(2 * u + 0.3, 1.0));
           },
           uniform_pdf}},
         {"another way: stretched", {stretched_sample, stretched_pdf}},
         {"another way: a ring, between cosines of 0.5 and 0.8",
          {turned([](double u) { return 0.8 - 0.3 * u; }),
           [](vec3 w) {
               return w.z >= real(0.5) && w.z <= real(0.8) ? 1 / (0.3 * whole_turn) : 0;
           }}},
         {"another way: a narrow lobe",
          {[](double u, double v) { return power_sample(u, v, 200); }, power(200)}}}};
}

// ---- Estimators ---------------------------------------------------------------------------------

using Estimate = std::function<double(uint64_t, int)>;

// The mean of n values f(rng, i).
template <class F>
Estimate mean_of(F f) {
    return [f](uint64_t seed, int n) {
        Rng rng{hash(seed, 4)};
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            if constexpr (std::is_invocable_v<F, Rng&>)
                sum += f(rng);
            else
                sum += f(rng, i, n);
        }
        return sum / n;
    };
}
double bump(double x) { return 1 + 4 * x * x * x; }  // its integral over [0,1] is 2
const Estimate plain = mean_of([](Rng& rng) { return bump(rng.uniform()); });

// A weighted mean of the bump over samples of a density proportional to x on [0.2, 1]: weights 1 /
// x make it uniform.
template <class Weight>
Estimate self_normalised(Weight weight) {
    return [weight](uint64_t seed, int n) {
        Rng rng{hash(seed, 5)};
        double sum = 0, weights = 0;
        for (int i = 0; i < n; ++i) {
            const double x = std::sqrt(0.04 + 0.96 * rng.uniform()), w = weight(x);
            sum += w * bump(x), weights += w;
        }
        return sum / weights;
    };
}
// The integral of the bump over [0.2, 1], and its mean there.
constexpr double above_fifth = 0.8 + 1 - 0.0016, mean_above = above_fifth / 0.8;

// sum f g / sum g times the integral of g = 1/2 + x.
double ratio(uint64_t seed, int n) {
    Rng rng{hash(seed, 6)};
    double f = 0, g = 0;
    for (int i = 0; i < n; ++i) {
        const double x = rng.uniform();
        f += bump(x), g += 0.1 + 1.8 * x * x * x * x;
    }
    return f / g * (0.1 + 0.36);
}

// Control variate x, with the coefficient that fits the samples best.
double fitted(uint64_t seed, int n) {
    Rng rng{hash(seed, 7)};
    double f = 0, x = 0, fx = 0, xx = 0;
    for (int i = 0; i < n; ++i) {
        const double at = rng.uniform(), value = bump(at);
        f += value, x += at, fx += value * at, xx += at * at;
    }
    const double spread = xx - x * x / n;
    const double slope = spread > 0 ? (fx - f * x / n) / spread : 0;
    return f / n - slope * (x / n - 0.5);
}

// Survives with probability 1/4; weighed by 1/p, or by `weight`.
Estimate roulette(double weight) {
    return mean_of([=](Rng& rng) {
        const double value = bump(rng.uniform());
        return rng.uniform() < 0.25 ? weight * value : 0;
    });
}

// Takes the first mean that is large enough.
double stops_early(uint64_t seed, int n) {
    Rng rng{hash(seed, 9)};
    double sum = 0;
    for (int i = 1; i <= n; ++i) {
        sum += bump(rng.uniform());
        if (sum / i > 2.2) return sum / i;
    }
    return sum / n;
}

Lineup<Estimator> hidden_estimators() {
    return {
        {{"the mean: the length of the interval forgotten",
          {mean_of([](Rng& rng) { return bump(0.2 + 0.8 * rng.uniform()); }), above_fifth}},
         {"the mean: a firefly is cut off",
          {mean_of([](Rng& rng) { return std::min(4.0, bump(rng.uniform())); }), 2}},
         {"the mean: roulette is not weighed", {roulette(1), 2}},
         {"the mean: roulette is weighed by the other probability", {roulette(4 / 3.0), 2}},
         {"a bias of c / n: the ratio is called unbiased", {ratio, 2, true}},
         {"a bias of c / n: the square of a mean is called unbiased",
          {[](uint64_t seed, int n) { return std::pow(plain(seed, n), 2); }, 4, true}},
         {"a bias of c / n: the fit is called unbiased", {fitted, 2, true}},
         {"the mean: zeros are left out",
          {mean_of([](Rng& rng) {
               double x = rng.uniform();
               while (x < 0.3) x = rng.uniform();
               return bump(x) - bump(0.3);
           }),
           0.7 + 1 - 0.0081 - 0.7 * (1 + 4 * 0.027)}},
         {"noise that does not fall: eight seeds, and no more",
          {[](uint64_t seed, int n) { return plain(seed % 8, n); }, 2}},
         {"noise that does not fall: n is ignored",
          {[](uint64_t seed, int) { return plain(seed, 16); }, 2, false}},
         {"noise that does not fall: a quarter of an estimate is that of two numbers",
          {[](uint64_t seed, int n) { return 0.25 * plain(~seed, 2) + 0.75 * plain(seed, n); }, 2}},
         {"the mean: it stops where it likes the mean", {stops_early, 2}},
         {"the mean: strata without jitter",
          {mean_of([](Rng&, int i, int n) { return bump(double(i) / n); }), 2}},
         {"numbers that are not finite: now and then 0 / 0",
          {mean_of([](Rng& rng) {
               const double x = std::floor(500 * rng.uniform());
               return x / x * bump(rng.uniform());
           }),
           2}},
         {"the limit of a consistent one: the ratio, 4 % off",
          {[](uint64_t seed, int n) { return 1.04 * ratio(seed, n); }, 2, false}},
         {"the limit of a consistent one: weights of another density",
          {self_normalised([](double) { return 1.0; }), mean_above, false}},
         {"the mean: all samples weigh alike, whatever the sign",
          {mean_of([](Rng& rng) { return std::abs(bump(rng.uniform()) - 2); }), 0}},
         {"a bias of c / n: the number n counts one too few",
          {[](uint64_t seed, int n) { return plain(seed, n) * n / std::max(1, n - 1); }, 2}}},
        {{"the rounding of float: float",
          {[](uint64_t seed, int n) {
               Rng rng{hash(seed, 10)};
               float sum = 0;
               for (int i = 0; i < n; ++i) sum += float(bump(float(rng.uniform())));
               return double(sum / float(n));
           },
           2}},
         {"less noise than random numbers have: strata",
          {mean_of([](Rng& rng, int i, int n) { return bump((i + rng.uniform()) / n); }), 2}},
         // By the same number for every i: rng is a copy.
         {"less noise than random numbers have: a grid, shifted",
          {mean_of([](Rng rng, int i, int n) { return bump((i + rng.uniform()) / n); }), 2}},
         {"another way: roulette", {roulette(4), 2}},
         {"a declared bias: the ratio", {ratio, 2, false}},
         {"a declared bias: 6 / n is missing",
          {[](uint64_t seed, int n) { return plain(seed, n) - 6.0 / n; }, 2, false}},
         {"a declared bias: weights that do not sum to 1",
          {self_normalised([](double x) { return 1 / x; }), mean_above, false}},
         {"a truth of 0: the truth is 0, and numbers have both signs",
          {mean_of([](Rng& rng) { return bump(rng.uniform()) - 2; }), 0}},
         {"no noise at all: always the same", {[](uint64_t, int) { return 2.0; }, 2}}}};
}

// ---- Intersectors -------------------------------------------------------------------------------

using Meeting = std::optional<double>;

// Both roots t of |o + t d - a|^2 = r^2, the nearer one first.
template <class T>
std::optional<std::pair<T, T>> roots(const Body& s, const Beam& beam) {
    const T x = T(beam.o.x - s.a.x), y = T(beam.o.y - s.a.y), z = T(beam.o.z - s.a.z);
    const T dx = T(beam.d.x), dy = T(beam.d.y), dz = T(beam.d.z), r = T(s.r);
    const T b = x * dx + y * dy + z * dz;
    // From the foot of the centre on the beam: nothing cancels from afar.
    const T fx = x - b * dx, fy = y - b * dy, fz = z - b * dz;
    const T rest = r * r - (fx * fx + fy * fy + fz * fz);
    if (!(rest >= 0)) return {};
    return std::pair{-b - std::sqrt(rest), -b + std::sqrt(rest)};
}
template <class T = double>
Meeting ball(const Body& s, const Beam& beam) {
    const auto t = roots<T>(s, beam);
    if (!t) return {};
    const T first = t->first > 0 ? t->first : t->second;
    return first > 0 && double(first) <= beam.tmax ? Meeting(double(first)) : Meeting();
}

// Distance along the beam, and the weights of b and c (Moller, Trumbore 1997).
struct Place {
    double t, v, w;
};
std::optional<Place> place(const Body& s, const Beam& beam) {
    const vec3 e = s.b - s.a, f = s.c - s.a, p = cross(beam.d, f);
    const double det = dot(e, p);
    if (det == 0) return {};
    const vec3 to = beam.o - s.a, q = cross(to, e);
    return Place{dot(f, q) / det, dot(to, p) / det, dot(beam.d, q) / det};
}
bool inside(const Place& x) { return x.v >= 0 && x.w >= 0 && x.v + x.w <= 1; }
bool ahead(const Place& x, const Beam& beam) { return x.t > 0 && x.t <= beam.tmax; }
Meeting flat(const Body& s, const Beam& beam) {
    const auto x = place(s, beam);
    return x && inside(*x) && ahead(*x, beam) ? Meeting(x->t) : Meeting();
}
Meeting sound(const Body& s, const Beam& beam) { return s.r > 0 ? ball(s, beam) : flat(s, beam); }

// Everything in float, the triangle by edge functions.
Meeting in_float(const Body& s, const Beam& beam) {
    if (s.r > 0) return ball<float>(s, beam);
    using V = std::array<float, 3>;
    auto of = [](vec3 p) { return V{float(p.x), float(p.y), float(p.z)}; };
    auto minus = [](V a, V b) { return V{a[0] - b[0], a[1] - b[1], a[2] - b[2]}; };
    auto times = [](V a, V b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    auto product = [](V a, V b) {
        return V{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const V o = of(beam.o), d = of(beam.d), a = minus(of(s.a), o), b = minus(of(s.b), o),
            c = minus(of(s.c), o);
    const float u = times(d, product(b, c)), v = times(d, product(c, a)),
                w = times(d, product(a, b));
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
    const V n = product(minus(b, a), minus(c, a));
    const double t = double(times(n, a) / times(n, d));
    return t > 0 && t <= beam.tmax ? Meeting(t) : Meeting();
}

// The plane's point, and whether the three triangles that it makes with the edges have its area.
Meeting by_areas(const Body& s, const Beam& beam) {
    if (s.r > 0) return ball(s, beam);
    const vec3 n = cross(s.b - s.a, s.c - s.a);
    const double t = dot(n, s.a - beam.o) / dot(n, beam.d);
    const vec3 p = beam.o + real(t) * beam.d;
    auto area = [&](vec3 a, vec3 b) { return double(length(cross(a - p, b - p))); };
    const double all = area(s.a, s.b) + area(s.b, s.c) + area(s.c, s.a);
    return t > 0 && t <= beam.tmax && all <= (1 + 1e-6) * length(n) ? Meeting(t) : Meeting();
}

// In the frame of the beam, whose z is d.
Meeting in_its_frame(Body s, const Beam& beam) {
    const Frame f = frame(beam.d);
    for (vec3* p : {&s.a, &s.b, &s.c}) *p = f.to_local(*p - beam.o);
    return sound(s, {{}, {0, 0, 1}, beam.tmax});
}

Lineup<Intersector> hidden_intersectors() {
    // A wrong one for spheres alone, or for triangles alone.
    auto balls = [](auto f) {
        return Intersector{
            [f](const Body& s, const Beam& b) { return s.r > 0 ? f(s, b) : flat(s, b); }};
    };
    auto flats = [](auto f) {
        return Intersector{
            [f](const Body& s, const Beam& b) { return s.r > 0 ? ball(s, b) : f(s, b); }};
    };
    auto placed = [=](auto is_met) {
        return flats([is_met](const Body& s, const Beam& b) -> Meeting {
            const auto x = place(s, b);
            return x && is_met(*x, b) ? Meeting(x->t) : Meeting();
        });
    };
    auto rooted = [=](auto choose) {
        return balls([choose](const Body& s, const Beam& b) -> Meeting {
            const auto t = roots<double>(s, b);
            const double chosen = t ? choose(t->first, t->second) : -1;
            return chosen > 0 && chosen <= b.tmax ? Meeting(chosen) : Meeting();
        });
    };
    return {
        {{"roots of a sphere: spheres: the far root",
          rooted([](double, double far) { return far; })},
         {"roots of a sphere: spheres: from within the nearer root in size",
          rooted([](double near, double far) { return near > 0 ? near : std::min(-near, far); })},
         {"roots of a sphere: spheres: the near root alone",
          rooted([](double near, double) { return near; })},
         {"roots of a sphere: spheres: the nearer in size, behind the eye",
          balls([](const Body& s, const Beam& b) -> Meeting {
              const auto t = roots<double>(s, b);
              return t && std::abs(t->first) <= b.tmax ? Meeting(std::abs(t->first)) : Meeting();
          })},
         {"the radius: spheres: 5 % too small", balls([](Body s, const Beam& b) {
              s.r *= 0.95;
              return ball(s, b);
          })},
         {"the radius: spheres: a root of what is negative is taken for 0, near the rim",
          balls([](Body s, const Beam& b) {
              const auto t = ball(s, b);
              if (ball(s, {b.o, b.d})) return t;
              s.r *= 1.04;
              return ball(s, b);
          })},
         {"tmax: spheres: no tmax", balls([](const Body& s, const Beam& b) {
              return ball(s, {b.o, b.d});
          })},
         {"the distance: spheres: distances to the centre's foot",
          balls([](const Body& s, const Beam& b) {
              return ball(s, b) ? Meeting(dot(s.a - b.o, b.d)) : Meeting();
          })},
         {"the radius: spheres: the radius is not squared", balls([](Body s, const Beam& b) {
              s.r = std::sqrt(s.r);
              return ball(s, b);
          })},
         {"coordinates: spheres: the least of the three on the way to the centre counts as 0",
          balls([](Body s, const Beam& b) {
              const auto k = least_axis(s.a - b.o);
              s.a.*k = b.o.*k;
              return ball(s, b);
          })},
         {"edges of a triangle: triangles: a parallelogram", placed([](Place x, const Beam& b) {
              return ahead(x, b) && x.v >= 0 && x.w >= 0 && x.v <= 1 && x.w <= 1;
          })},
         {"edges of a triangle: triangles: one weight may be negative",
          placed([](Place x, const Beam& b) { return ahead(x, b) && x.v >= 0 && x.v + x.w <= 1; })},
         {"what lies behind: triangles: behind the eye, too",
          placed([](Place x, const Beam& b) { return inside(x) && x.t <= b.tmax; })},
         {"tmax: triangles: no tmax",
          placed([](Place x, const Beam&) { return inside(x) && x.t > 0; })},
         {"tmax: triangles: beams end 3 % too late", flats([](const Body& s, const Beam& b) {
              return flat(s, {b.o, b.d, real(1.03) * b.tmax});
          })},
         {"numbers that are not finite: triangles: from the back the distance is 0 / 0",
          flats([](const Body& s, const Beam& b) {
              const Meeting t = flat(s, b);
              return t && dot(cross(s.b - s.a, s.c - s.a), b.d) > 0 ? Meeting(std::nan("")) : t;
          })},
         {"sides of a triangle: triangles: from one side", flats([](const Body& s, const Beam& b) {
              return dot(cross(s.b - s.a, s.c - s.a), b.d) > 0 ? Meeting() : flat(s, b);
          })},
         {"small bodies and distances: triangles: small ones are taken for edge-on",
          flats([](const Body& s, const Beam& b) {
              return std::abs(dot(cross(s.b - s.a, s.c - s.a), b.d)) < 1e-4 ? Meeting()
                                                                            : flat(s, b);
          })},
         {"edges of a triangle: triangles: 5 % within the edge", placed([](Place x, const Beam& b) {
              return ahead(x, b) && x.v >= 0.05 && x.w >= 0.05 && x.v + x.w <= 0.95;
          })},
         {"edges of a triangle: triangles: 5 % off the edge", placed([](Place x, const Beam& b) {
              return ahead(x, b) && x.v >= -0.05 && x.w >= -0.05 && x.v + x.w <= 1.05;
          })},
         {"small bodies and distances: both: nothing is nearer than 0.05",
          {[](const Body& s, const Beam& b) {
              const auto t = sound(s, b);
              return t && *t < 0.05 ? Meeting() : t;
          }}},
         {"small bodies and distances: both: distances are multiples of 1/500",
          {[](const Body& s, const Beam& b) {
              const auto t = sound(s, b);
              return t ? Meeting(std::round(500 * *t) / 500) : t;
          }}},
         {"the distance: both: 1 % too long", {[](const Body& s, const Beam& b) {
              const auto t = sound(s, b);
              return t ? Meeting(*t * 1.01) : t;
          }}}},
        {{"the rounding of float: float", {in_float}},
         {"another way: by areas", {by_areas}},
         {"another way: in the beam's frame", {in_its_frame}},
         {"another way: corners in another order", {[](const Body& s, const Beam& b) {
              return sound({s.r > 0 ? s.a : s.c, s.a, s.b, s.r}, b);
          }}},
         {"another way: edges do not belong", placed([](Place x, const Beam& b) {
              return ahead(x, b) && x.v > 0 && x.w > 0 && x.v + x.w < 1;
          })},
         {"another way: step by step",
          {[](const Body& s, const Beam& b) { return march(s, b, b.tmax); }}}}};
}

}  // namespace
}  // namespace penumbra::course
