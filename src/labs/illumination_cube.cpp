// labs/illumination_cube.cpp  6  the cube, whose illuminance is known: maps of it by both methods
//
//   build/illumination_cube [--quick]
#include "labs/cube.h"
#include "labs/room.h"
#include "labs/rows.h"

namespace {

struct NamedPoint {
    const char* name;
    double x, y;  // of a face, [-1,1]^2; x >= y >= 0
};
constexpr NamedPoint points[] = {{"A", 0, 0}, {"B", 0.5, 0}, {"C", 0.5, 0.5},
                                 {"D", 1, 0}, {"E", 1, 0.5}, {"F", 1, 1}};

constexpr double nit_per_lux = cube::albedo / cube::pi;

// Exponent p of the distance s from an edge in E - E(edge): a right angle takes s^p to
// B(1 + p/2, (1 - p)/2) / 4 s^p, of which rho has to make s^p again.
double edge_exponent() {
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
    const cube::Solution* exact;
    uint32_t n;
    Room room;
    IlluminationMap projection = {}, mean = {};  // the functionals of particles
    double beyond = 0, square = 0;  // over a face, lx^2 m^2: of (projection - E)^2, E^2
};

bool inside(const Face& f) { return dot(f.n, f.a) > 0; }  // the normals point outwards

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

// The three hats of a triangle: barycentric coordinates.
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

// Of E times f(x, y) over an element, in lx m^2.  144 nodes are right to 10^-5 of the least
// discretisation error, that of 64 x 64 cells.
template <class F>
auto integral_of_E(const cube::Solution& exact, const Triangle& t, F f) {
    constexpr double square_metres = 25;  // in the unit of [-1,1]^2
    return cube::integral(exact, t, f, 12) * (square_metres / nit_per_lux);
}

// A map that is the same on all faces, inside.
IlluminationMap on_all(const Mesh& mesh, const Sums& face) {
    IlluminationMap map(number_of_sides(mesh));
    for (const Face& f : mesh.faces)
        for (uint32_t v = 0; v < f.vertices(); ++v) map[2 * (f.vertex + v) + inside(f)] = face[v];
    return map;
}

Walls walls(const cube::Solution& exact, uint32_t n) {
    const double H = std::sqrt(2.0) * 10 / n * (1 + 1e-9);
    Walls w{&exact, n, make_room("cube", scene_named("cube"), H)};
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

// Of two maps: the quadratic mean of their difference, relative to that of E; three channels alike.
double distance(const Walls& w, const IlluminationMap& a, const IlluminationMap& b) {
    const Mesh& mesh = w.room.mesh;
    return std::sqrt(square_of(mesh, difference(a, b)) /
                     (3 * double(mesh.faces.size()) * w.square));
}

// Of a map, with n for the count: luminance in nit over all points like A ... F on six faces, the
// relative error there ("off A"), the greatest spread among such points; the mean over the walls;
// and its distance from E by Pythagoras, as the projection is the foot of the perpendicular.
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
        r.of[std::string("off ") + p.name] = std::abs(L.mean / w.exact->luminance(p.x, p.y) - 1);
        r.of["spread"] = std::max(r.of["spread"], std::sqrt(L.variance()) / L.mean);
    }
    for (const Face& f : mesh.faces)
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e)
            for (uint32_t v : mesh.corners[e])
                r.of["mean"] += value(f, v) / (3 * double(mesh.elements()));
    r.of["off walls"] = std::hypot(distance(w, map, w.projection), std::sqrt(w.beyond / w.square));
    return r;
}

// The limit and a run to 1 % unshot.  What is missing is nearly proportional to what is not yet
// sent: two maps tell the limit.
void add_shot(Rows& rows, const Walls& w, const std::string& name, Shooter shooter, bool check) {
    Shooting run(w.room.scene, w.room.mesh, shooter, all_cores());
    std::vector<IlluminationMap> maps;
    std::vector<double> unshot, seconds;
    const double start = processor_seconds();
    for (double until : {1e-2, 1e-3, 1e-4}) {
        shoot_on(run, {until, 0, 0});
        maps.push_back(run.map()), unshot.push_back(run.unshot());
        seconds.push_back(processor_seconds() - start);
    }
    const auto limit = beyond(maps[2], maps[1], unshot[2] / (unshot[1] - unshot[2]));
    rows.push_back(row_of(w, name, limit));
    if (check) shoot_on(run, {1e-6, 0, 0}), rows.back().of["check"] = distance(w, limit, run.map());
    const double mean = rows.back()["mean"];
    rows.push_back(row_of(w, name + ": run", maps[0]));
    Row& r = rows.back();
    r.of["unshot"] = unshot[0], r.of["short by"] = (mean - r["mean"]) * 3 / 2000;
    r.of["cpu_seconds"] = seconds[0], r.of["from limit"] = distance(w, maps[0], limit);
}

Row walked(const Walls& w, const std::string& name, SamplerKind kind, uint64_t seed, uint64_t n) {
    const double start = processor_seconds();
    Particles particles(w.room.scene, w.room.mesh, Particles::pattern(kind, seed, n));
    walk(particles, n);
    const IlluminationMap map = particles.map();
    Row r = row_of(w, name, map);
    r.of["cpu_seconds"] = processor_seconds() - start, r.of["particles"] = double(n);
    r.of["reported"] = particles.error(), r.of["from limit"] = distance(w, map, w.projection);
    return r;
}

constexpr const char *elements = "shooting, elements", *faces = "shooting, faces",
                     *projection = "particles, projection", *hat_mean = "particles, hat mean";
constexpr const char* limits[] = {elements, faces, projection, hat_mean};
constexpr std::pair<const char*, SamplerKind> samplers[] = {
    {"particles, independent: run", SamplerKind::independent},
    {"particles, Halton: run", SamplerKind::halton}};

// ---- The verdicts -------------------------------------------------------------------------------

// The order p of an error like h^p, by the last meshes.
double order(const Rows& rows, const std::string& what, size_t last) {
    std::vector<double> n, e;
    for (size_t k = rows.size() - std::min(last, rows.size()); k < rows.size(); ++k)
        n.push_back(double(rows[k].count)), e.push_back(rows[k][what]);
    return -slope(n, e);
}

struct Extent {
    uint32_t finest = 64, finest_by_elements = 16;  // cells a side
    uint64_t particles = 1 << 20, most = 1 << 22;
};

// Limits and runs over meshes; then, at 16 cells, runs over particles.
std::pair<Rows, Rows> run_all(const cube::Solution& exact, const Extent& extent) {
    Rows rows, of_n;
    for (uint32_t n = 4; n <= extent.finest; n *= 2) {
        const Walls w = walls(exact, n);
        if (n <= extent.finest_by_elements) add_shot(rows, w, elements, Shooter::element, n == 8);
        add_shot(rows, w, faces, Shooter::face, false);
        rows.push_back(row_of(w, projection, w.projection));
        rows.push_back(row_of(w, hat_mean, w.mean));
        for (const auto& [name, kind] : samplers)
            rows.push_back(walked(w, name, kind, n, extent.particles));
        for (uint64_t N = 1 << 14; n == 16 && N <= extent.most; N *= 4)
            for (const auto& [name, kind] : samplers)
                of_n.push_back(walked(w, name, kind, N + 100, N));
    }
    return {rows, of_n};
}

// From the limit to the exact E.
void tell_limits(Page& page, const cube::Solution& exact, const Rows& rows, const Extent& extent) {
    const double p = edge_exponent();
    double worst = 0, off = 0;
    for (double y : {0.0, 0.5}) {
        auto rise = [&](double s) { return exact.illuminance(1 - s, y) - exact.illuminance(1, y); };
        worst = std::max(worst, std::abs(std::log10(rise(1e-3) / rise(1e-4)) - p));
    }
    page.set("edge", text("s^%.3f", p)), page.set("edge-off", text("%.4f", worst));
    page.claim("edge-ok", worst < 0.005);
    std::vector<std::vector<std::string>> lines;
    for (const char* name : limits) {
        const Rows all = by_setting(rows, name);
        const Row& at = all[std::min<size_t>(2, all.size() - 1)];
        std::vector<std::string>& line = lines.emplace_back(1, name);
        line.push_back(of_count(all.back()));
        for (const char* what : {"off A", "off D", "off F", "off walls"})
            line.push_back(text("%.2f", order(all, what, std::max<size_t>(2, all.size() - 1))));
        for (double x : {at["off walls"], at["mean"] * 3 / 2000 - 1, at["spread"]})
            line.push_back(text("%.2f %%", 100 * x));
    }
    page.set("orders", table({"limit of", "finest", "order at A", "at D", "at F", "walls",
                              "error at 16: walls", "mean", "spread"},
                             lines));
    const Rows best = by_setting(rows, projection), hats = by_setting(rows, hat_mean);
    bool nearer = true;
    std::string factors, orders;
    for (const char* what : {"off D", "off E", "off F", "off walls"}) {
        for (size_t i = 0; i < best.size(); ++i) nearer = nearer && best[i][what] < hats[i][what];
        factors += text(factors.empty() ? "%.1f" : ", %.1f", hats.back()[what] / best.back()[what]);
    }
    for (const auto& [what, wanted] : {std::pair("off D", p), {"off walls", p + 0.5}})
        for (const Rows& all : {best, hats}) {
            off = std::max(off, std::abs(order(all, what, 2) - wanted));
            orders += text(orders.empty() ? "%.2f" : ", %.2f", order(all, what, 2));
        }
    page.set("factors", factors), page.claim("projection-ok", nearer);
    page.set("last-orders", orders), page.set("wanted-orders", text("%.2f and %.2f", p, p + 0.5));
    page.set("orders-ok", extent.finest < 64 ? "not by these meshes" : page.verdict(off < 0.06));
}

void tell_shooting(Page& page, const cube::Solution& exact, const Rows& rows) {
    double missing = 0;
    bool dark = true;
    for (const char* name : {elements, faces}) {
        for (const Row& r : by_setting(rows, name + std::string(": run")))
            missing = std::max(missing, std::abs(r["short by"] / r["unshot"] - 1));
        for (const Row& r : by_setting(rows, name))
            for (const NamedPoint& p : points) dark = dark && r[p.name] < exact.luminance(p.x, p.y);
    }
    const double check = by_setting(rows, elements)[1]["check"];
    page.set("missing", text("%.1f %%", 100 * missing)), page.set("check", text("%.1e", check));
    page.claim("missing-ok", missing < 0.02), page.claim("check-ok", check < 1e-5);
    page.claim("dark-ok", dark);
}

void tell_particles(Page& page, const Rows& rows, const Rows& of_n) {
    Moments ratio;
    double most = 0;
    std::string least, noise, in_n;
    for (const auto& [name, kind] : samplers) {
        const Rows runs = by_setting(rows, name), by_n = by_setting(of_n, name);
        const Row* best = &runs[0];
        for (const Row& r : runs) {
            ratio.add(r["from limit"] / r["reported"]);
            most = std::max(most, std::abs(r["from limit"] / r["reported"] - 1));
            if (r["off walls"] < (*best)["off walls"]) best = &r;
        }
        const char* separator = least.empty() ? "" : ", Halton ";
        const double falls = slope(all_of(by_n, "particles"), all_of(by_n, "from limit"));
        least += separator + of_count(*best);
        noise += text("%sn^%.2f", separator, -order(runs, "reported", runs.size()));
        in_n += text("%sN^%.2f", separator, falls);
        if (kind == SamplerKind::independent) page.claim("root-ok", std::abs(falls + 0.5) < 0.03);
    }
    page.set("least-at", least), page.set("noise", noise), page.set("in-n", in_n);
    page.set("reported", text("%.3f", ratio.mean)), page.set("most", text("%.0f %%", 100 * most));
    page.claim("reported-ok", most < 0.2 && std::abs(ratio.mean - 1) < 0.04);
}

int study(const Extent& extent, const std::string& folder, const std::string& command) {
    Page page(folder, "radiosity-cube");
    const cube::Solution exact;
    const auto [rows, of_n] = run_all(exact, extent);
    tell_limits(page, exact, rows, extent);
    tell_shooting(page, exact, rows);
    tell_particles(page, rows, of_n);
    Row known{"cube", "exact", 0, 0, {{"mean", exact.mean() * nit_per_lux}}};
    for (const NamedPoint& at : points) known.of[at.name] = exact.luminance(at.x, at.y);
    Rows all = {known};
    for (const Rows* some : {&rows, &of_n}) all.insert(all.end(), some->begin(), some->end());
    page.data("radiosity-cube",
              csv_of(all, {"A", "B", "C", "D", "E", "F", "mean", "off walls", "unshot", "short by",
                           "from limit", "reported", "particles", "cpu_seconds"}));
    const Rows shown =
        where(rows, [](const Row& r) { return r["cpu_seconds"] != r["cpu_seconds"]; });
    auto cells = [](const Rows& r) { return double(r[0].count); };
    page.plot("radiosity-cube",
              plot(
                  shown, {"cells a side", 4, double(extent.finest)}, {"error of E", 1e-4, 1},
                  of_setting, cells, [](const Rows& r) { return r[0]["off walls"]; },
                  "Discretisation: from a method's limit to the exact solution"));
    page.set("particles", text("%.0f", double(extent.particles)));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    Extent extent;
    const Lab lab{"illumination_cube",
                  "Compares illumination maps of a cube with its exact solution.",
                  {
                      {"--quick", "", "coarse meshes, into out/",
                       [&](auto&) {
                           quick = true, extent = {16, 8, 1 << 16, 1 << 18};
                       }},
                  }};
    return lab_main(argc, argv, lab,
                    [&] { return study(extent, report_folder(quick), command_of(argc, argv)); });
}
