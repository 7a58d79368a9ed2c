// course/practice.h  subjects to practise on in week 6: some are right, some are wrong
//
// Of every kind (kinds.h) by which tests are graded there is one: `make check` and the grader
// differ in subjects, and not in what they ask for.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "base/rng.h"
#include "course/subject.h"

namespace penumbra::course {

template <class Subject>
struct Named {
    std::string name;  // "KIND: what is wrong with it, or why it looks so"
    Subject subject;
};

// Those of an exercise.
template <class Subject>
struct Lineup {
    std::vector<Named<Subject>> wrong, right;
};

inline vec3 about_z(double z, double phi) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {real(r * std::cos(phi)), real(r * std::sin(phi)), real(z)};
}

// The bowl: z = (u + u^2) / 2 has the density 2 / sqrt(1 + 8 z) on [0,1].
inline double bowl(double u) { return (u + u * u) / 2; }
inline double bowl_pdf(vec3 w) {
    return w.z > 0 ? 1 / (std::numbers::pi * std::sqrt(1 + 8 * double(w.z))) : 0;
}

inline Lineup<Sampler> practice_samplers() {
    constexpr double turn = 2 * std::numbers::pi;
    const auto right = [](double u, double v) { return about_z(bowl(u), turn * v); };
    auto scaled = [](double by) { return [by](vec3 w) { return by * bowl_pdf(w); }; };
    // A lobe about an axis 30 degrees off z, so narrow that nothing of it is below the horizon.
    const vec3 slanted{real(0.5), 0, real(std::sqrt(0.75))};
    return {{{"a factor of the density: half of what it ought to be", {right, scaled(0.5)}},
             {"pairs that cover a part alone: the azimuth goes to 6, and not to 2 pi",
              {[](double u, double v) { return about_z(bowl(u), 6 * v); }, bowl_pdf}},
             {"a factor of the density: it is that of z, and forgets 1 / (2 pi)",
              {right, scaled(turn)}},
             {"the form of the density: one direction in twenty is the pole",
              {[](double u, double v) { return about_z(u > 0.95 ? 1 : bowl(u / 0.95), turn * v); },
               bowl_pdf}},
             {"the borders of the square: not a number in a corner",
              {[](double u, double v) { return about_z(bowl(u), turn * v * (v / v)); }, bowl_pdf}},
             {"the borders of the square: near u = 1 the root of what rounding makes negative",
              {[=](double u, double v) {
                   return about_z(1 - std::sqrt(1 - u * (1 + 0x1p-22)), turn * v);
               },
               [](vec3 w) { return w.z > 0 ? (1 - double(w.z)) / std::numbers::pi : 0; }}},
             {"the form of the density: up to 10 % off, in three sectors",
              {right,
               [](vec3 w) {
                   return (1 + 0.1 * std::cos(3 * std::atan2(double(w.y), double(w.x)))) *
                          bowl_pdf(w);
               }}},
             {"the horizon: the density is positive below it",
              {right,
               [](vec3 w) {
                   return bowl_pdf({w.x, w.y, std::abs(w.z)});
               }}},
             {"lengths: directions of length 1.05",
              {[=](double u, double v) { return real(1.05) * right(u, v); }, bowl_pdf}},
             {"a factor of the density: half of the pairs are rejected, and it integrates to 1",
              {[=](double u, double v) -> std::optional<vec3> {
                   if (v > 0.5) return {};
                   return right(u, 2 * v);
               },
               bowl_pdf}}},
            {{"the rounding of float: it begins with the other number, goes round the other way, "
              "and computes in float",
              {[](double u, double v) {
                   // Rounding takes the horizon to z = -4e-8.
                   const float angle = std::acos(float(bowl(v))), phi = float(-turn * u);
                   const float r = std::sin(angle);
                   return vec3{r * std::cos(phi), r * std::sin(phi), std::cos(angle)};
               },
               bowl_pdf}},
             {"rejected pairs: half of them, and the density integrates to 1/2",
              {[=](double u, double v) -> std::optional<vec3> {
                   if (v > 0.5) return {};
                   return right(u, 2 * v);
               },
               scaled(0.5)}},
             {"another way: the cosine, in seven sheets: the azimuth goes round seven times",
              {[](double u, double v) { return about_z(std::sqrt(u), 7 * turn * v); },
               [](vec3 w) { return std::max(0.0, double(w.z)) / std::numbers::pi; }}},
             {"another way: a narrow lobe about a slanted axis",
              {[=](double u, double v) {
                   return frame(slanted).to_world(about_z(std::pow(1 - u, 1 / 201.0), turn * v));
               },
               [=](vec3 w) {
                   const double cosine = w.z > 0 ? std::max(0.0, double(dot(w, slanted))) : 0;
                   return 201 / turn * std::pow(cosine, 200);
               }}}}};
}

// The square of the integral of e^x over [0,1], and the integral.
inline double mean_of_exp(uint64_t seed, int n) {
    Rng rng{hash(seed, 1)};
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += std::exp(rng.uniform());
    return sum / n;
}

inline Lineup<Estimator> practice_estimators() {
    constexpr double e = std::numbers::e, integral = e - 1;
    auto square = [](uint64_t seed, int n) { return std::pow(mean_of_exp(seed, n), 2); };
    return {
        {{"a bias of c / n: divided by n + 1",
          {[](uint64_t seed, int n) { return mean_of_exp(seed, n) * n / (n + 1); }, integral}},
         {"a bias of c / n: the square of a mean is called unbiased",
          {square, integral * integral, true}},
         {"the mean: numbers above 2.5 are cut off",
          {[](uint64_t seed, int n) {
               Rng rng{hash(seed, 2)};
               double sum = 0;
               for (int i = 0; i < n; ++i) sum += std::min(2.5, std::exp(rng.uniform()));
               return sum / n;
           },
           integral}},
         {"noise that does not fall: it never takes more than four samples",
          {[](uint64_t seed, int n) { return mean_of_exp(seed, std::min(n, 4)); }, integral}},
         {"the limit of a consistent one: 3 % off",
          {[=](uint64_t seed, int n) { return 1.03 * square(seed, n); }, integral * integral,
           false}},
         {"noise that does not fall: a quarter of an estimate is its first number",
          {[](uint64_t seed, int n) {
               return 0.25 * mean_of_exp(seed, 1) + 0.75 * mean_of_exp(seed, n);
           },
           integral, false}},
         {"numbers that are not finite: 0 / 0 for one estimate in 200",
          {[](uint64_t seed, int n) {
               Rng rng{hash(seed, 4)};
               const double x = std::floor(200 * rng.uniform());
               return x / x * mean_of_exp(seed, n);
           },
           integral}},
         {"the mean: 1/20 is added, where the truth is 0",
          {[](uint64_t seed, int n) { return mean_of_exp(seed, n) - integral + 0.05; }, 0}}},
        {{"a declared bias: the square of a mean", {square, integral * integral, false}},
         {"a declared bias: 5 / n is added",
          {[](uint64_t seed, int n) { return mean_of_exp(seed, n) + 5.0 / n; }, integral, false}},
         {"another way: pairs of x and 1 - x",
          {[](uint64_t seed, int n) {
               Rng rng{hash(seed, 3)};
               double sum = 0;
               for (int i = 0; i < n; ++i) {
                   const double x = rng.uniform();
                   sum += (std::exp(x) + std::exp(1 - x)) / 2;
               }
               return sum / n;
           },
           integral}},
         {"no noise at all: its samples are all alike",
          {[](uint64_t seed, int n) { return integral + 0 * double(seed % 2) * n; }, integral}},
         {"the rounding of float: sum and samples",
          {[](uint64_t seed, int n) {
               Rng rng{hash(seed, 5)};
               float sum = 0;
               for (int i = 0; i < n; ++i) sum += std::exp(float(rng.uniform()));
               return double(sum / float(n));
           },
           integral}},
         {"less noise than random numbers have: a number in each n-th of [0,1)",
          {[](uint64_t seed, int n) {
               Rng rng{hash(seed, 6)};
               double sum = 0;
               for (int i = 0; i < n; ++i) sum += std::exp((i + rng.uniform()) / n);
               return sum / n;
           },
           integral}},
         {"a truth of 0: numbers have both signs",
          {[](uint64_t seed, int n) { return mean_of_exp(seed, n) - integral; }, 0}}}};
}

// The distance from p to a triangle: to its plane where p is above it, or else to an edge.
inline double distance_to_triangle(const Body& s, vec3 p) {
    const vec3 n = cross(s.b - s.a, s.c - s.a), corner[] = {s.a, s.b, s.c};
    bool above = true;
    double nearest = infinity;
    for (int i = 0; i < 3; ++i) {
        const vec3 edge = corner[(i + 1) % 3] - corner[i], to = p - corner[i];
        above = above && dot(cross(n, edge), to) >= 0;
        const real along = std::clamp(dot(edge, to) / dot(edge, edge), real(0), real(1));
        nearest = std::min(nearest, double(length(to - along * edge)));
    }
    return above ? std::abs(dot(n, p - s.a)) / length(n) : nearest;
}
inline double distance_to(const Body& s, vec3 p) {
    return s.r > 0 ? std::abs(length(p - s.a) - s.r) : distance_to_triangle(s, p);
}

// Goes on by the distance to the body, which cannot step over it (Hart 1996, sphere tracing), until
// all of the body lies behind.  The last step to a body's farthest point may be rounded beyond it.
inline std::optional<double> march(const Body& s, const Beam& beam, double tmax) {
    double t = 0, end = s.r;
    for (vec3 p : {s.a, s.r > 0 ? s.a : s.b, s.r > 0 ? s.a : s.c})
        end = std::max(end, double(length(p - beam.o) + s.r));
    const double rounding = 64 * ulp * end;
    for (int i = 0; i < 200000 && t <= std::min(tmax, end + rounding); ++i) {
        const double d = distance_to(s, beam.o + real(t) * beam.d);
        if (d <= rounding) return t;
        t += d;
    }
    return {};
}

// The axis along which v goes least, x before y before z.
inline real vec3::*least_axis(vec3 v) {
    return *std::ranges::min_element(axis, {}, [v](auto k) { return std::abs(v.*k); });
}

inline Lineup<Intersector> practice_intersectors() {
    auto sound = [](const Body& s, const Beam& beam) { return march(s, beam, beam.tmax); };
    // Its corners moved towards its centre, by this part of the way.
    auto smaller = [](Body s, double by) {
        const vec3 centre = (s.a + s.b + s.c) / 3;
        if (s.r == 0)
            for (vec3* p : {&s.a, &s.b, &s.c}) *p = *p + real(by) * (centre - *p);
        return s;
    };
    return {
        {{"tmax: it knows none",
          {[](const Body& s, const Beam& beam) { return march(s, beam, 1e6); }}},
         {"the radius: spheres are 3 % too large", {[=](Body s, const Beam& beam) {
              s.r *= 1.03;
              return sound(s, beam);
          }}},
         {"sides of a triangle: they are met from one alone",
          {[=](const Body& s, const Beam& beam) {
              const bool back = dot(beam.d, cross(s.b - s.a, s.c - s.a)) > 0;
              return s.r == 0 && back ? std::nullopt : sound(s, beam);
          }}},
         {"roots of a sphere: from within, spheres are not met",
          {[=](const Body& s, const Beam& beam) {
              const bool within = s.r > 0 && length(beam.o - s.a) < s.r;
              return within ? std::nullopt : sound(s, beam);
          }}},
         {"small bodies and distances: nothing is nearer than 1/100",
          {[=](const Body& s, const Beam& beam) {
              const auto t = sound(s, beam);
              return t && *t < 0.01 ? std::nullopt : t;
          }}},
         {"the distance: 1 % too short", {[=](const Body& s, const Beam& beam) {
              const auto t = sound(s, beam);
              return t ? std::optional(*t * 0.99) : t;
          }}},
         {"edges of a triangle: triangles end too early, at a tenth of the way to the centre",
          {[=](const Body& s, const Beam& beam) { return sound(smaller(s, 0.1), beam); }}},
         {"edges of a triangle: they reach beyond one edge", {[=](const Body& s, const Beam& beam) {
              const auto t = sound(s, beam);
              return t || s.r > 0 ? t : sound({s.a, s.b, s.a + s.b - s.c}, beam);
          }}},
         {"what lies behind: triangles behind the eye are met",
          {[=](const Body& s, const Beam& beam) {
              const auto t = sound(s, beam);
              if (t || s.r > 0) return t;
              const auto behind = march(s, {beam.o, -beam.d}, 1e6);
              return behind ? std::optional(-*behind) : t;
          }}},
         {"the radius: beams that miss a sphere by 5 % or less graze it",
          {[=](Body s, const Beam& beam) {
              const auto t = sound(s, beam);
              if (s.r == 0 || sound(s, {beam.o, beam.d})) return t;
              s.r *= 1.05;
              return sound(s, beam);
          }}},
         {"coordinates: a sphere's centre has that of the eye along which the beam goes least",
          {[=](Body s, const Beam& beam) {
              const auto k = least_axis(beam.d);
              if (s.r > 0) s.a.*k = beam.o.*k;
              return sound(s, beam);
          }}},
         {"small bodies and distances: distances are multiples of 1/1000",
          {[=](const Body& s, const Beam& beam) {
              const auto t = sound(s, beam);
              return t ? std::optional(std::round(1000 * *t) / 1000) : t;
          }}},
         {"tmax: beams end 2 % too late", {[=](const Body& s, const Beam& beam) {
              return sound(s, {beam.o, beam.d, real(1.02) * beam.tmax});
          }}},
         {"edges of a triangle: triangles are a tenth larger all around",
          {[=](const Body& s, const Beam& beam) { return sound(smaller(s, -0.1), beam); }}},
         {"numbers that are not finite: from within a sphere the distance is 0 / 0",
          {[=](const Body& s, const Beam& beam) {
              const auto t = sound(s, beam);
              return t && length(beam.o - s.a) < s.r ? std::optional(std::nan("")) : t;
          }}},
         {"roots of a sphere: from within it is the root behind that counts, without its sign",
          {[=](const Body& s, const Beam& beam) {
              const bool within = s.r > 0 && length(beam.o - s.a) < s.r;
              return sound(s, {beam.o, within ? -beam.d : beam.d, beam.tmax});
          }}},
         {"roots of a sphere: from outside the far side is met",
          {[=](const Body& s, const Beam& beam) {
              const auto t = sound(s, beam);
              if (!t || s.r == 0 || length(beam.o - s.a) < s.r) return t;
              const double far = 2 * dot(s.a - beam.o, beam.d) - *t;
              return far <= beam.tmax ? std::optional(far) : std::nullopt;
          }}}},
        {{"another way: it goes there in steps", {sound}},
         {"the rounding of float: in units of its own, and in float", {[=](Body s, Beam beam) {
              auto in_float = [](real x) { return real(float(1000 * x)); };
              for (vec3* p : {&s.a, &s.b, &s.c, &beam.o})
                  *p = {in_float(p->x), in_float(p->y), in_float(p->z)};
              s.r = in_float(s.r), beam.tmax *= 1000;
              const auto t = sound(s, beam);
              return t ? std::optional(double(float(*t / 1000))) : t;
          }}},
         {"another way: corners in another order", {[=](const Body& s, const Beam& beam) {
              return sound(s.r > 0 ? s : Body{s.c, s.b, s.a, 0}, beam);
          }}},
         {"another way: edges do not belong to a triangle",
          {[=](const Body& s, const Beam& beam) { return sound(smaller(s, 1e-6), beam); }}}}};
}

}  // namespace penumbra::course
