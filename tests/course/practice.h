// course/practice.h  subjects to practise on in week 6: some are right, some are wrong
#pragma once
#include <string>
#include <vector>

#include "base/rng.h"
#include "course/subject.h"

namespace penumbra::course {

template <class Subject>
struct Named {
    std::string name;  // what is wrong with it, or why it looks so
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
    return {{{"the density is half of what it ought to be", {right, scaled(0.5)}},
             {"a gap: the azimuth goes to 6, and not to 2 pi",
              {[](double u, double v) { return about_z(bowl(u), 6 * v); }, bowl_pdf}},
             {"the density is that of z, and forgets 1 / (2 pi)", {right, scaled(turn)}},
             {"one direction in twenty is the pole",
              {[](double u, double v) { return about_z(u > 0.95 ? 1 : bowl(u / 0.95), turn * v); },
               bowl_pdf}},
             {"not a number in a corner of the square",
              {[](double u, double v) { return about_z(bowl(u), turn * v * (v / v)); }, bowl_pdf}}},
            {{"it begins with the other number, goes round the other way, and computes in float",
              {[](double u, double v) {
                   // Rounding takes the horizon to z = -4e-8.
                   const float angle = std::acos(float(bowl(v))), phi = float(-turn * u);
                   const float r = std::sin(angle);
                   return vec3{r * std::cos(phi), r * std::sin(phi), std::cos(angle)};
               },
               bowl_pdf}},
             {"half of the pairs are rejected, and the density integrates to 1/2",
              {[=](double u, double v) -> std::optional<vec3> {
                   if (v > 0.5) return {};
                   return right(u, 2 * v);
               },
               scaled(0.5)}},
             {"seven sheets: the azimuth goes round seven times",
              {[](double u, double v) { return about_z(bowl(u), 7 * turn * v); }, bowl_pdf}}}};
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
        {{"divided by n + 1",
          {[](uint64_t seed, int n) { return mean_of_exp(seed, n) * n / (n + 1); }, integral}},
         {"the square of a mean is called unbiased", {square, integral * integral, true}},
         {"numbers above 2.5 are cut off",
          {[](uint64_t seed, int n) {
               Rng rng{hash(seed, 2)};
               double sum = 0;
               for (int i = 0; i < n; ++i) sum += std::min(2.5, std::exp(rng.uniform()));
               return sum / n;
           },
           integral}},
         {"it never takes more than four samples",
          {[](uint64_t seed, int n) { return mean_of_exp(seed, std::min(n, 4)); }, integral}},
         {"consistent, with another limit",
          {[=](uint64_t seed, int n) { return 1.03 * square(seed, n); }, integral * integral,
           false}}},
        {{"the square of a mean, consistent alone", {square, integral * integral, false}},
         {"pairs of x and 1 - x",
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
          {[](uint64_t seed, int n) { return integral + 0 * double(seed % 2) * n; }, integral}}}};
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
    for (int i = 0; i < 5000 && t <= std::min(tmax, end + rounding); ++i) {
        const double d = distance_to(s, beam.o + real(t) * beam.d);
        if (d <= rounding) return t;
        t += d;
    }
    return {};
}

inline Lineup<Intersector> practice_intersectors() {
    auto sound = [](const Body& s, const Beam& beam) { return march(s, beam, beam.tmax); };
    return {{{"it knows no tmax",
              {[](const Body& s, const Beam& beam) { return march(s, beam, 1e6); }}},
             {"spheres are 3 % too large", {[=](Body s, const Beam& beam) {
                  s.r *= 1.03;
                  return sound(s, beam);
              }}},
             {"triangles are met from one side alone", {[=](const Body& s, const Beam& beam) {
                  const bool back = dot(beam.d, cross(s.b - s.a, s.c - s.a)) > 0;
                  return s.r == 0 && back ? std::nullopt : sound(s, beam);
              }}},
             {"from within, spheres are not met", {[=](const Body& s, const Beam& beam) {
                  const bool within = s.r > 0 && length(beam.o - s.a) < s.r;
                  return within ? std::nullopt : sound(s, beam);
              }}},
             {"what is nearer than 1/100 is taken for the surface that the beam left",
              {[=](const Body& s, const Beam& beam) {
                  const auto t = sound(s, beam);
                  return t && *t < 0.01 ? std::nullopt : t;
              }}},
             {"distances are 1 % too short", {[=](const Body& s, const Beam& beam) {
                  const auto t = sound(s, beam);
                  return t ? std::optional(*t * 0.99) : t;
              }}}},
            {{"it goes there in steps", {sound}},
             {"in units of its own, and in float", {[=](Body s, Beam beam) {
                  for (vec3* p : {&s.a, &s.b, &s.c, &beam.o}) *p = real(1000) * *p;
                  s.r *= 1000, beam.tmax *= 1000;
                  const auto t = sound(s, beam);
                  return t ? std::optional(double(float(*t / 1000))) : t;
              }}},
             {"corners in another order", {[=](const Body& s, const Beam& beam) {
                  return sound(s.r > 0 ? s : Body{s.c, s.b, s.a, 0}, beam);
              }}}}};
}

}  // namespace penumbra::course
