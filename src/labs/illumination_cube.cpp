// labs/illumination_cube.cpp  6  maps of a cube of known illuminance by both methods
//
//   build/illumination_cube [--quick]
#include "labs/cube.h"
#include "labs/room.h"
#include "labs/rows.h"
#include "text/json.h"

namespace {
using namespace penumbra;

struct NamedPoint {
    const char* name;
    double x, y;  // a point of a face, [-1,1]^2; x >= y >= 0
};
constexpr NamedPoint points[] = {{"A", 0, 0}, {"B", 0.5, 0}, {"C", 0.5, 0.5},
                                 {"D", 1, 0}, {"E", 1, 0.5}, {"F", 1, 1}};

constexpr double nit_per_lux = cube::albedo / cube::pi,
                 exact_mean = cube::mean_illuminance * nit_per_lux;

constexpr const char *elements = "shooting, elements", *faces = "shooting, faces",
                     *projection = "particles, projection", *hat_mean = "particles, hat mean";
constexpr const char* limits[] = {elements, faces, projection, hat_mean};

// The cube with n x n cells per face, n >= 4 a power of two, and the linear maps that the exact E
// has on this mesh.
struct Walls {
    uint32_t n;
    Room room;
    IlluminationMap projection = {}, mean = {};  // by each Functional
    double beyond = 0, square = 0;  // integrals over a face, lx^2 m^2: (projection - E)^2, E^2
};

bool inside(const Face& f) { return dot(f.n, f.a) > 0; }  // the side that faces the room

// ---- Exact integrals ----------------------------------------------------------------------------

using Triangle = std::array<cube::Point, 3>;

// Corners of an element of the first face, as points of [-1,1]^2.
Triangle corners_of(const Walls& w, uint32_t element) {
    Triangle corner{};
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = w.room.mesh.corners[element][k] - w.room.mesh.faces[0].vertex;
        corner[k] = {2.0 * (v % (w.n + 1)) / w.n - 1, 2.0 * (v / (w.n + 1)) / w.n - 1};
    }
    return corner;
}

// The three basis functions of a triangle: barycentric coordinates of (x, y).
rgb hats(const Triangle& t, double x, double y) {
    auto twice_area = [](cube::Point a, cube::Point b, cube::Point c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const auto [a, b, c] = t;
    const double all = twice_area(a, b, c);
    const cube::Point p{x, y};
    return {real(twice_area(p, b, c) / all), real(twice_area(a, p, c) / all),
            real(twice_area(a, b, p) / all)};
}

// The integral of E times f(x, y) over an element, in lx m^2.  With 144 nodes its error is 10^-5 of
// the least discretisation error, that of 64 x 64 cells.
template <class F>
auto integral_of_E(const cube::Solution& exact, const Triangle& t, F f) {
    constexpr double square_metres = 25;  // per unit of area in [-1,1]^2
    return cube::integral(exact, t, f, 12) * (square_metres / nit_per_lux);
}

// The map with these values on the inner sides of all faces.
IlluminationMap on_all(const Mesh& mesh, const Sums& face) {
    IlluminationMap map(number_of_sides(mesh));
    for (const Face& f : mesh.faces)
        for (uint32_t v = 0; v < f.vertices(); ++v) map[2 * (f.vertex + v) + inside(f)] = face[v];
    return map;
}

Walls walls(const cube::Solution& exact, uint32_t n) {
    const double H = std::sqrt(2.0) * 10 / n * (1 + 1e-9);
    Walls w{n, make_room("cube", scene_named("cube"), H)};
    const Mesh& mesh = w.room.mesh;
    const Face& first = mesh.faces[0];
    Sums b(first.vertices());
    for (uint32_t e = 0; e < first.elements(); ++e) {
        const Triangle t = corners_of(w, e);
        const rgb part = integral_of_E(exact, t, [&](double x, double y) { return hats(t, x, y); });
        for (size_t k = 0; k < 3; ++k) b[mesh.corners[e][k]] += rgb{1, 1, 1} * (part.*axis[k]);
    }
    const Projection onto(mesh, first);
    const Sums nearest = onto(b, Functional::projection);
    for (uint32_t e = 0; e < first.elements(); ++e) {
        const Triangle t = corners_of(w, e);
        const auto& [p, q, r] = mesh.corners[e];
        const rgb corner{nearest[p].x, nearest[q].x, nearest[r].x};
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

// ---- Maps as rows -------------------------------------------------------------------------------

// The row of a map, with n as its count: luminance in nit at A ... F, averaged over all points that
// are equivalent on six faces; the mean over the walls; the distance from E.  Pythagoras gives the
// distance, because the projection is orthogonal.
Row row_of(const Walls& w, const std::string& method, const IlluminationMap& map) {
    Row r{"cube", method, w.n, 0};
    const Mesh& mesh = w.room.mesh;
    auto along = [&](uint32_t i) { return std::abs(2.0 * i / w.n - 1); };
    auto value = [&](const Face& f, uint32_t v) {
        return double(map[2 * v + inside(f)].x) * nit_per_lux;
    };
    for (const NamedPoint& p : points) {
        Moments L;
        for (const Face& f : mesh.faces)
            for (uint32_t i = 0; i <= w.n; ++i)
                for (uint32_t j = 0; j <= w.n; ++j)
                    if (std::max(along(i), along(j)) == p.x && std::min(along(i), along(j)) == p.y)
                        L.add(value(f, vertex_at(f, i, j)));
        r.of[p.name] = L.mean;
    }
    for (const Face& f : mesh.faces)
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e)
            for (uint32_t v : mesh.corners[e])
                r.of["mean"] += value(f, v) / (3 * double(mesh.elements()));
    r.of["off"] = std::sqrt(
        (square_of(mesh, difference(map, w.projection)) / (3 * double(mesh.faces.size())) +
         w.beyond) /
        w.square);  // the three channels are equal
    return r;
}

// Adds rows of the limit, and of a run to 1 % unshot power.  The missing light is nearly
// proportional to the unshot power, so two maps give the limit.
void add_shot(Rows& rows, const Walls& w, const std::string& name, Shooter shooter) {
    Shooting run(w.room.scene, w.room.mesh, shooter, all_cores());
    std::vector<IlluminationMap> maps;
    std::vector<double> unshot;
    for (double until : {1e-2, 1e-3, 1e-4}) {
        run.run({until, 0, 0}, [](const Shooting&) {});
        maps.push_back(run.map()), unshot.push_back(run.unshot());
    }
    const auto limit = beyond(maps[2], maps[1], unshot[2] / (unshot[1] - unshot[2]));
    Row whole = row_of(w, name, limit), r = row_of(w, name + ": run", maps[0]);
    r.of["unshot"] = unshot[0], r.of["short by"] = (whole["mean"] - r["mean"]) / exact_mean;
    append(rows, {whole, r});
}

Rows run_all(const cube::Solution& exact, bool quick) {
    Rows rows;
    for (uint32_t n = 4; n <= (quick ? 16 : 64); n *= 2) {  // cells per side
        const Walls w = walls(exact, n);
        if (n <= (quick ? 8 : 16)) add_shot(rows, w, elements, Shooter::element);
        add_shot(rows, w, faces, Shooter::face);
        rows.push_back(row_of(w, projection, w.projection));
        rows.push_back(row_of(w, hat_mean, w.mean));
    }
    return rows;
}

// Reports distances from limits to the exact E.  The finest two meshes give the order.
void tell_limits(Page& page, const cube::Solution& exact, const Rows& rows) {
    Lines lines = {{"exact", "", "", ""}};
    for (const NamedPoint& p : points) lines[0].push_back(text("%.1f", exact.luminance(p.x, p.y)));
    lines[0].push_back(text("%.2f", exact_mean));
    bool dark = true;
    for (const char* name : limits) {
        const Rows all = by_setting(rows, name);
        const Row &last = all.back(), &before = all[all.size() - 2];
        lines.push_back({name, of_count(last), text("%.2f", std::log2(before["off"] / last["off"])),
                         percent(last["off"])});
        for (const NamedPoint& p : points) {
            lines.back().push_back(text("%.1f", last[p.name]));
            const bool shot = name == elements || name == faces;
            for (const Row& r : all)
                dark = dark && !(shot && r[p.name] > exact.luminance(p.x, p.y));
        }
        lines.back().push_back(text("%.2f", last["mean"]));
    }
    page.set("limits",
             table({"limit of", "cells", "order", "error", "A", "B", "C", "D", "E", "F", "mean"},
                   lines));
    const Rows best = by_setting(rows, projection), hats = by_setting(rows, hat_mean);
    bool nearer = true;
    for (size_t i = 0; i < best.size(); ++i) nearer = nearer && best[i]["off"] < hats[i]["off"];
    page.set("factor", text("%.1f", hats.back()["off"] / best.back()["off"]));
    page.claim("projection-ok", nearer), page.claim("dark-ok", dark);
}

int study(const Scope& scope) {
    Page page(scope, "radiosity-cube");
    const cube::Solution exact;
    const Rows rows = run_all(exact, scope.quick);
    tell_limits(page, exact, rows);
    double missing = 0;
    for (const Row& r : rows)
        if (r["unshot"] > 0) missing = std::max(missing, std::abs(r["short by"] / r["unshot"] - 1));
    page.set("missing", percent(missing)), page.claim("missing-ok", missing < 0.02);
    page.data("radiosity-cube",
              csv_of(rows, {"A", "B", "C", "D", "E", "F", "mean", "off", "unshot", "short by"}));
    page.plot("radiosity-cube",
              plot(where(rows, [](const Row& r) { return std::isnan(r["unshot"]); }),
                   "cells per side", "error of E", of_setting, count_of, mean_of("off"),
                   "Discretisation: from a method's limit to the exact solution"));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(
        argc, argv,
        {"illumination_cube", "Compares illumination maps of a cube with its exact solution."},
        study);
}
