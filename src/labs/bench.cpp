// labs/bench.cpp  5  rays a second of both trees and of Embree, and the time of a path
//
//   build/bench [--quick]
//
// On one thread.  All answer the same rays in the same triangles, rounded to float, since Embree
// knows nothing else.  They take turns, two at a time, so that a busy machine slows both.
#include "labs/bench_paths.h"
#include "labs/bench_rays.h"
#include "wide/wide_bvh.h"
#include "world/bvh.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#define HAVE_EMBREE true
#else
#define HAVE_EMBREE false
#endif

namespace {

using namespace bench;

struct Effort {
    int width = 512, rounds = 9, builds = 3;
    double seconds = 0.1;  // of each measurement, at least
};

// ---- The tracers --------------------------------------------------------------------------------

template <class Either>
struct Ours {
    const Case& c;
    Either tree = {};

    explicit Ours(const Case& source) : c(source) {}

    void build() { tree = Either(c.shapes); }

    // Distance of the hit of ray i (any hit: 0), or infinity.
    real find(Kind kind, size_t i) const {
        const Ray& ray = c.rays[kind][i];
        if (kind == shadow) return tree.occluded(ray) ? 0 : infinity;
        const auto hit = tree.closest(ray);
        return hit ? hit->t : infinity;
    }
};
using Wide = Ours<WideBvh>;
using Plain = Ours<Bvh>;
double bytes_of(const Wide& t) { return double(t.tree.bytes()); }

#if HAVE_EMBREE
struct Embree {
    const Case& c;
    RTCDevice device = rtcNewDevice("threads=1,verbose=0");
    RTCScene scene = nullptr;
    mutable RTCIntersectContext context;
    std::array<std::vector<RTCRay>, 3> rays;
    ssize_t held = 0;  // bytes, also of the vertices

    explicit Embree(const Case& source) : c(source) {
        if (!device) throw SystemError("embree: no device");
        rtcInitIntersectContext(&context);
        auto count = [](void* self, ssize_t n, bool) {
            static_cast<Embree*>(self)->held += n;
            return true;
        };
        rtcSetDeviceMemoryMonitorFunction(device, count, this);
        for (Kind kind : kinds)
            for (const auto& [o, d, tmax] : c.rays[kind])
                rays[kind].push_back({float(o.x), float(o.y), float(o.z), 0, float(d.x), float(d.y),
                                      float(d.z), 0, float(tmax), ~0u, 0, 0});
    }
    ~Embree() {
        if (scene) rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    void build() {
        if (scene) rtcReleaseScene(scene);
        scene = rtcNewScene(device);
        RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const size_t n = c.shapes.size();
        auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n));
        auto* index = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), n));
        for (const Shape& s : c.shapes)
            for (vec3 p : {s.a, s.b, s.c})
                for (auto a : axis) *xyz++ = float(p.*a);
        std::iota(index, index + 3 * n, 0u);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene);
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw SystemError("embree: no tree");
    }

    float find(Kind kind, size_t i) const {
        RTCRayHit hit{rays[kind][i], {}};
        if (kind == shadow) {
            rtcOccluded1(scene, &context, &hit.ray);
            return hit.ray.tfar < 0 ? 0 : HUGE_VALF;
        }
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &hit);
        return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? HUGE_VALF : hit.ray.tfar;
    }
};
double bytes_of(const Embree& t) { return double(t.held); }
#else
using Embree = Wide;  // to be compiled, never run
#endif

// ---- Measuring ----------------------------------------------------------------------------------

using Column = std::vector<double>;  // a number a round

// A tracer in the race, built, and how it did.
template <class Tracer>
struct Runner {
    Tracer tracer;
    double build_seconds = 0;
    std::array<size_t, 3> hits{};
    std::array<Column, 3> speed{};  // millions of rays a second

    Runner(const Case& c, int builds) : tracer(c) {
        Column times;
        for (int i = 0; i < builds; ++i) {
            const double start = processor_seconds();
            tracer.build();
            times.push_back(processor_seconds() - start);
        }
        build_seconds = median(times);
        for (Kind kind : kinds) hits[kind] = count_hits(kind);
    }

    size_t count_hits(Kind kind) const {
        size_t count = 0;
        for (size_t i = 0; i < tracer.c.rays[kind].size(); ++i)
            count += std::isfinite(tracer.find(kind, i));
        return count;
    }

    // That the hits are looked at keeps the compiler from dropping the work.
    void run(Kind kind, double least_seconds) {
        const double start = processor_seconds();
        double elapsed = 0, rays = 0;
        while (elapsed < least_seconds) {
            if (count_hits(kind) != hits[kind]) throw SystemError("other hits every time");
            rays += double(tracer.c.rays[kind].size());
            elapsed = processor_seconds() - start;
        }
        speed[kind].push_back(rays / elapsed / 1e6);
    }
};

// Per cent of the rays whose answers differ: hit or not, or by more than 1e-4 of the distance.
template <class First, class Second>
double disagreement(const First& a, const Second& b, Kind kind) {
    size_t count = 0;
    const size_t rays = a.c.rays[kind].size();
    for (size_t i = 0; i < rays; ++i) {
        const double s = double(a.find(kind, i)), t = double(b.find(kind, i));
        count += s != t && !(std::abs(s - t) <= 1e-4 * std::min(s, t));
    }
    return 100 * double(count) / double(rays);
}

struct Outcome {
    std::array<double, 3> ratio{};  // of the first's speed to the second's
    double differ = 0;              // the most of the three, per cent
};

// Adds what of a scene's row tells of speed.  Without the second, "–" stands for it.
template <class First, class Second>
Outcome race(std::vector<std::string>& cells, Runner<First>& first,
             std::optional<Runner<Second>>& second, const Effort& effort) {
    Outcome o;
    std::array<Column, 3> ratios;
    for (int round = 0; round < effort.rounds; ++round)
        for (Kind kind : kinds) {
            first.run(kind, effort.seconds);
            if (!second) continue;
            second->run(kind, effort.seconds);
            ratios[kind].push_back(first.speed[kind].back() / second->speed[kind].back());
        }
    for (Kind kind : kinds) {
        cells.push_back(text("%.2f", median(first.speed[kind])));
        cells.push_back(second ? with_range(ratios[kind], "%.2f") : "–");
        if (!second) continue;
        o.ratio[kind] = median(ratios[kind]);
        o.differ = std::max(o.differ, disagreement(first.tracer, second->tracer, kind));
    }
    cells.push_back(text("%.2g", first.build_seconds));
    cells.push_back(second ? text("%.2g", second->build_seconds) : "–");
    return o;
}

std::vector<std::string> race_with_embree(std::vector<Outcome>& all, const Case& c,
                                          const Effort& effort) {
    Runner<Wide> ours(c, effort.builds);
    std::optional<Runner<Embree>> theirs;
    if (HAVE_EMBREE) theirs.emplace(c, effort.builds);
    std::vector<std::string> cells = {c.name};
    all.push_back(race(cells, ours, theirs, effort));
    const double n = double(c.shapes.size());
    cells.push_back(text("%.0f", bytes_of(ours.tracer) / n));
    cells.push_back(theirs ? text("%.0f", bytes_of(theirs->tracer) / n) : "–");
    return cells;
}

std::vector<std::string> race_of_trees(std::vector<Outcome>& all, const Case& c,
                                       const Effort& effort) {
    Runner<Plain> plain(c, 1);
    std::optional<Runner<Wide>> wide(std::in_place, c, 1);
    std::vector<std::string> cells = {c.name};
    all.push_back(race(cells, plain, wide, effort));
    if (all.back().differ > 0) throw SystemError("the trees' answers differ");
    return cells;
}

// ---- The report ---------------------------------------------------------------------------------

// "1.1 primary, 0.9 bounce and 1.2 shadow rays": geometric means over scenes.
std::string mean_ratio(const std::vector<Outcome>& all) {
    std::array<double, 3> mean = {1, 1, 1};
    for (const Outcome& o : all)
        for (Kind kind : kinds) mean[kind] *= std::pow(o.ratio[kind], 1 / double(all.size()));
    return text("%.2f primary, %.2f bounce and %.2f shadow rays", mean[primary], mean[bounce],
                mean[shadow]);
}

int run(bool quick, const std::string& command) {
    const Effort effort = quick ? Effort{256, 3, 1, 0.01} : Effort{};
    Page page(report_folder(quick), "bench");
    std::vector<Case> cases = {cornell(effort.width)};
    for (int level : {5, 7, 8}) cases.push_back(icosphere(level, effort.width));
    for (int n : {1000, 100000}) cases.push_back(soup(n, effort.width));
    std::vector<Outcome> embree, trees;
    std::vector<std::vector<std::string>> lines, plain;
    for (const Case& c : cases) lines.push_back(race_with_embree(embree, c, effort));
    for (const Case& c : cases) plain.push_back(race_of_trees(trees, c, effort));
    double differ = 0;
    for (const Outcome& o : embree) differ = std::max(differ, o.differ);
    page.set("embree", table({"triangles", "primary, Mrays/s", "× Embree", "bounce, Mrays/s",
                              "× Embree", "shadow, Mrays/s", "× Embree", "build, s", "Embree's",
                              "bytes a triangle", "Embree's"},
                             lines));
    page.set("plain", table({"triangles", "primary, Mrays/s", "× wide", "bounce, Mrays/s", "× wide",
                             "shadow, Mrays/s", "× wide", "build, s", "the wide one's"},
                            plain));
    page.set("paths", table({"scene", "tracer", "µs a path", "rays a path", "µs a ray",
                             "time, × textbook's"},
                            all_paths(effort.rounds)));
    page.set("verdict",
             HAVE_EMBREE
                 ? text("It traces %s per ray of Embree.  At most %.4f %% of the answers differ.",
                        mean_ratio(embree), differ)
                 : "Embree was not measured: its header is missing (Debian: libembree-dev).");
    page.set("verdict of the plain tree", mean_ratio(trees));
    page.set("width", text("%d", effort.width));
    page.set("rounds", text("%d", effort.rounds));
    page.set("bytes", text("%zu", sizeof(real)));
    page.set("made", made_by(command));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    const Lab lab{
        "bench", "Measures rays a second, beside Embree if it is installed.", {quick_flag(quick)}};
    return lab_main(argc, argv, lab, [&] { return run(quick, command_of(argc, argv)); });
}
