// labs/illumination_wall.h  4  the cube, whose illuminance is known: maps of it by both methods
#pragma once
#include "labs/cube.h"
#include "labs/illumination.h"

namespace illumination::in_cube {

struct NamedPoint {
    const char* name;
    double x, y;  // of a face, [-1,1]^2; x >= y >= 0
};
inline constexpr std::array<NamedPoint, 6> cube_points = {
    {{"A", 0, 0}, {"B", 0.5, 0}, {"C", 0.5, 0.5}, {"D", 1, 0}, {"E", 1, 0.5}, {"F", 1, 1}}};

inline constexpr double nit_per_lux = cube::albedo / cube::pi;

// Exponent p of the distance s from an edge in E - E(edge): a right angle takes s^p to
// B(1 + p/2, (1 - p)/2) / 4 s^p, of which rho has to make s^p again.
inline double edge_exponent() {
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
        const double p = (low + high) / 2;
        const double factor =
            std::tgamma(1 + p / 2) * std::tgamma((1 - p) / 2) / std::tgamma(1.5) / 4;
        (factor * cube::albedo < 1 ? low : high) = p;
    }
    return low;
}

// The cube cut into n x n cells a face, a power of two from 4 on; and what linear maps on it would
// be if the exact E were known.
struct Walls {
    uint32_t n;
    Room room;
    IlluminationMap projection, mean;  // the functionals of particles
    double beyond = 0, square = 0;     // over a face, lx^2 m^2: of (projection - E)^2, of E^2
};

inline bool inside(const Face& f) { return dot(f.n, f.a) > 0; }  // the normals point outwards

// ---- Exact integrals ----------------------------------------------------------------------------

using Triangle = std::array<cube::Point, 3>;

// Corners of an element of the first face, as points of [-1,1]^2.
inline Triangle corners_of(const Walls& w, uint32_t element) {
    Triangle corner{};
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = w.room.mesh.corners[element][k] - w.room.mesh.faces[0].vertex;
        corner[k] = {2.0 * (v % (w.n + 1)) / w.n - 1, 2.0 * (v / (w.n + 1)) / w.n - 1};
    }
    return corner;
}

// The three hats of a triangle: barycentric coordinates.
inline rgb hats(const Triangle& t, double x, double y) {
    auto twice_area = [&](cube::Point a, cube::Point b, cube::Point c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const auto [a, b, c] = t;
    const double all = twice_area(a, b, c);
    const cube::Point p{x, y};
    return rgb(real(twice_area(p, b, c) / all), real(twice_area(a, p, c) / all),
               real(twice_area(a, b, p) / all));
}

// Of E times f(x, y) over an element, in lx m^2.  144 nodes are right to 10^-5 of the least
// discretisation error, that of 64 x 64 cells.
template <class F>
auto integral_of_E(const cube::Solution& exact, const Triangle& t, F f) {
    constexpr double square_metres = 25;  // in the unit of [-1,1]^2
    return cube::integral(exact, t, f, 12) * (square_metres / nit_per_lux);
}

// A map that is the same on all faces, inside.
inline IlluminationMap on_all(const Mesh& mesh, const Sums& face) {
    IlluminationMap map(number_of_sides(mesh));
    for (const Face& f : mesh.faces)
        for (uint32_t v = 0; v < f.vertices(); ++v) map[2 * (f.vertex + v) + inside(f)] = face[v];
    return map;
}

inline Walls walls(const cube::Solution& exact, uint32_t n) {
    Walls w{n, room("cube", std::sqrt(2.0) * 10 / n * (1 + 1e-9)), {}, {}};
    const Mesh& mesh = w.room.mesh;
    const Face& first = mesh.faces[0];
    Sums b(first.vertices());
    for (uint32_t e = 0; e < first.elements(); ++e) {
        const Triangle t = corners_of(w, e);
        const rgb part = integral_of_E(exact, t, [&](double x, double y) { return hats(t, x, y); });
        for (size_t k = 0; k < 3; ++k) b[mesh.corners[e][k]] += rgb(1, 1, 1) * (part.*axis[k]);
    }
    const Projection onto(mesh, first);
    const Sums nearest = onto(b, Functional::projection);
    for (uint32_t e = 0; e < first.elements(); ++e) {
        const Triangle t = corners_of(w, e);
        const auto& [p, q, r] = mesh.corners[e];
        const rgb corner(nearest[p].x, nearest[q].x, nearest[r].x);
        w.beyond += integral_of_E(exact, t, [&](double x, double y) {
            const double E = exact.illuminance(x, y);
            const double d = double(dot(hats(t, x, y), corner)) - E;
            return d * d / E;
        });
    }
    w.square = double(onto.square(nearest).x) + w.beyond;
    w.projection = on_all(mesh, nearest), w.mean = on_all(mesh, onto(b, Functional::mean));
    return w;
}

// ---- What a map is ------------------------------------------------------------------------------

// Of two maps: the quadratic mean of their difference, relative to that of E.
inline double distance(const Walls& w, const IlluminationMap& a, const IlluminationMap& b) {
    double sum = 0;
    for (const Face& f : w.room.mesh.faces) {
        Sums difference(f.vertices());
        for (uint32_t v = 0; v < f.vertices(); ++v) {
            const size_t side = 2 * (f.vertex + v) + inside(f);
            difference[v] = a[side] - b[side];
        }
        sum += double(Projection(w.room.mesh, f).square(difference).x);
    }
    return std::sqrt(sum / (double(w.room.mesh.faces.size()) * w.square));
}

// The same of a map and E: by Pythagoras, as the projection is the foot of the perpendicular.
inline double distance_from_exact(const Walls& w, const IlluminationMap& map) {
    return std::hypot(distance(w, map, w.projection), std::sqrt(w.beyond / w.square));
}

// Luminance in nit: over all points like A ... F on six faces, and over the walls.
struct Luminance {
    std::array<Moments, 6> at;
    double mean = 0;
};
inline Luminance luminance(const Walls& w, const IlluminationMap& map) {
    Luminance L;
    const Mesh& mesh = w.room.mesh;
    auto along = [&](uint32_t i) { return std::abs(2.0 * i / w.n - 1); };
    for (const Face& f : mesh.faces) {
        auto value = [&](uint32_t v) { return double(map[2 * v + inside(f)].x) * nit_per_lux; };
        for (uint32_t i = 0; i <= w.n; ++i)
            for (uint32_t j = 0; j <= w.n; ++j)
                for (size_t k = 0; k < cube_points.size(); ++k)
                    if (std::max(along(i), along(j)) == cube_points[k].x &&
                        std::min(along(i), along(j)) == cube_points[k].y)
                        L.at[k].add(value(vertex_at(f, i, j)));
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e)
            for (uint32_t v : mesh.corners[e]) L.mean += value(v) / (3 * double(mesh.elements()));
    }
    return L;
}

// ---- Runs ---------------------------------------------------------------------------------------

// What a method comes to at a mesh, and how it got there.
struct Solved {
    const Walls* walls;
    IlluminationMap limit;
    Luminance L;            // of the limit
    double from_exact;      // the limit's discretisation error
    IlluminationMap early;  // shooting: at 1 % unshot
    double early_unshot = 0, early_seconds = 0, seconds = 0;
};

inline Solved solved(const Walls& w, const IlluminationMap& limit) {
    return {&w, limit, luminance(w, limit), distance_from_exact(w, limit), {}};
}

// a + (a - b) * factor
inline IlluminationMap beyond(const IlluminationMap& a, const IlluminationMap& b, double factor) {
    IlluminationMap map(a.size());
    for (size_t i = 0; i < a.size(); ++i) map[i] = a[i] + real(factor) * (a[i] - b[i]);
    return map;
}

// What is missing is nearly proportional to what is not yet sent: two maps tell the limit.
inline Solved shot(const Walls& w, Shooter shooter) {
    Shooting run(w.room.scene, w.room.mesh, shooter, all_cores());
    struct Stop {
        IlluminationMap map;
        double unshot, seconds;
    };
    std::vector<Stop> stops;
    for (double unshot : {1e-2, 1e-3, 1e-4}) {
        run.run({unshot, 0, 0}, [](const Shooting&) {});
        stops.push_back({run.map(), run.unshot(), run.seconds()});
    }
    const auto& [first, second, last] = std::tie(stops[0], stops[1], stops[2]);
    Solved s = solved(w, beyond(last.map, second.map, last.unshot / (second.unshot - last.unshot)));
    s.early = first.map, s.early_unshot = first.unshot, s.early_seconds = first.seconds;
    s.seconds = last.seconds;
    return s;
}

// How far the limit by two maps is from a run that leaves a hundredth of what they left.
inline double error_of_limit(const Solved& s) {
    Shooting run(s.walls->room.scene, s.walls->room.mesh, Shooter::element, all_cores());
    run.run({1e-6, 0, 0}, [](const Shooting&) {});
    return distance(*s.walls, s.limit, run.map());
}

struct Walked {
    const Walls* walls;
    SamplerKind kind;
    uint64_t n;
    Luminance L;
    double reported, from_limit, from_exact, seconds;
    std::string name() const {
        return kind == SamplerKind::halton ? "particles, Halton" : "particles, independent";
    }
};
inline Walked walked(const Walls& w, SamplerKind kind, uint64_t seed, uint64_t n) {
    Particles particles(w.room.scene, w.room.mesh, Particles::pattern(kind, seed, n));
    const Clock::time_point start = Clock::now();
    walk(particles, n);
    const IlluminationMap map = particles.map();
    const double seconds = seconds_since(start);
    return {&w,
            kind,
            n,
            luminance(w, map),
            particles.error(),
            distance(w, map, w.projection),
            distance_from_exact(w, map),
            seconds};
}

// The methods whose limits are compared.
enum Method : size_t { elements, faces, projection, hat_mean };
inline constexpr std::array method_names = {"shooting, elements", "shooting, faces",
                                            "particles, projection", "particles, hat mean"};

struct CubeRuns {
    Scope plan;
    cube::Solution exact;
    std::vector<Walls> walls;                      // 4, 8, 16 ... cells
    std::array<std::vector<Solved>, 4> by_method;  // of the same cells, or the first of them
    std::vector<std::array<Walked, 2>> walked;     // independent, Halton
    uint64_t particles = 0;

    double exact_at(size_t k) const { return exact.luminance(cube_points[k].x, cube_points[k].y); }
};

inline CubeRuns run_cube(const Scope& plan) {
    CubeRuns r;
    r.plan = plan;
    r.particles = uint64_t(1) << (plan.quick ? 16 : 20);
    const uint32_t last = plan.quick ? 16 : 64, last_flat = plan.quick ? 8 : plan.full ? 32 : 16;
    for (uint32_t n = 4; n <= last; n *= 2) r.walls.push_back(walls(r.exact, n));
    for (const Walls& w : r.walls) {
        if (w.n <= last_flat) r.by_method[elements].push_back(shot(w, Shooter::element));
        r.by_method[faces].push_back(shot(w, Shooter::face));
        r.by_method[projection].push_back(solved(w, w.projection));
        r.by_method[hat_mean].push_back(solved(w, w.mean));
        r.walked.push_back({walked(w, SamplerKind::independent, w.n, r.particles),
                            walked(w, SamplerKind::halton, w.n, r.particles)});
    }
    return r;
}

// ---- Errors, point by point ---------------------------------------------------------------------

// |L / exact - 1| at point k; for k = 6, of E in the quadratic mean over the walls.
inline double discretisation(const CubeRuns& r, const Solved& s, size_t k) {
    return k < 6 ? std::abs(s.L.at[k].mean / r.exact_at(k) - 1) : s.from_exact;
}
inline std::vector<double> cells(const std::vector<Solved>& of) {
    std::vector<double> n;
    for (const Solved& s : of) n.push_back(s.walls->n);
    return n;
}
inline std::vector<double> errors(const CubeRuns& r, const std::vector<Solved>& of, size_t k) {
    std::vector<double> e;
    for (const Solved& s : of) e.push_back(discretisation(r, s, k));
    return e;
}
// The order p of an error like h^p, by the last meshes.
inline double order(const CubeRuns& r, Method m, size_t k, size_t last) {
    const auto n = cells(r.by_method[m]), e = errors(r, r.by_method[m], k);
    const auto from = std::ptrdiff_t(n.size() - std::min(last, n.size()));
    return -slope({n.begin() + from, n.end()}, {e.begin() + from, e.end()});
}

}  // namespace illumination::in_cube
