// labs/bench.cpp  5  rays per second of both BVHs and of Embree
//
//   build/bench [--quick]
//
// Uses one thread.  All three trace the same rays through the same triangles.  Numbers are rounded
// to float because Embree has no doubles.  The tracers take turns, so load slows them alike.
#include "base/rng.h"
#include "labs/rows.h"
#include "text/scene_file.h"
#include "wide/wide_bvh.h"
#include "world/bvh.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#define HAVE_EMBREE true
#else
#define HAVE_EMBREE false
#endif

namespace {
using namespace penumbra;

// ---- Scenes and their rays ----------------------------------------------------------------------

// primary: closest hit along jittered camera rays, row by row.  Neighbouring rays are coherent.
// bounce: closest hit from the primary hits in cosine-weighted directions.  Rays are incoherent.
// shadow: any hit between the primary hits and random points of a quad.
enum Kind { primary, bounce, shadow };
constexpr std::pair<Kind, const char*> kinds[] = {
    {primary, "primary"}, {bounce, "bounce"}, {shadow, "shadow"}};

struct Case {
    std::string name;
    std::vector<Shape> shapes;
    Camera camera;
    vec3 p, u, v;                               // shadow rays go to this quad
    std::array<std::vector<Ray>, 3> rays = {};  // by kind
};

// Draws into named variables, because C++ does not specify the evaluation order of arguments.
vec3 random3(Rng& rng) {
    const real x = to_unit(rng.bits()), y = to_unit(rng.bits()), z = to_unit(rng.bits());
    return {x, y, z};
}

// `volatile` is needed: the vectoriser of g++ 12 drops a conversion to float and back.
real to_float(real x) {
    volatile float y = float(x);
    return y;
}
vec3 to_float(vec3 a) { return {to_float(a.x), to_float(a.y), to_float(a.z)}; }
Ray to_float(const Ray& r) { return {to_float(r.o), to_float(r.d), to_float(r.tmax)}; }

Case with_rays(Case c, int width) {
    for (Shape& s : c.shapes) s = {to_float(s.a), to_float(s.b), to_float(s.c)};
    const Tree tree(c.shapes);
    const vec3 light_normal = unit(cross(c.u, c.v));
    // Error bounds of float, so that no ray hits the surface that it leaves.
    const real float_error = real(std::numeric_limits<float>::epsilon() / 2) / ulp;
    Rng rng{mix(c.shapes.size())};
    for (int y = 0; y < width; ++y)
        for (int x = 0; x < width; ++x) {
            const vec3 jitter = random3(rng), direction = random3(rng), place = random3(rng);
            const Ray ray = to_float(
                camera_ray(c.camera, {width, width}, real(x) + jitter.x, real(y) + jitter.y));
            c.rays[primary].push_back(ray);
            const auto hit = tree.closest(ray);
            if (!hit) continue;
            Surface from = surface(c.shapes[hit->id], ray, *hit);
            from.error *= float_error;
            if (dot(from.n, ray.d) > 0) from.n = -from.n;
            const vec3 wi =
                frame(from.n).to_world(sample_cosine_hemisphere({direction.x, direction.y}));
            c.rays[bounce].push_back(to_float(spawn(from, wi)));
            const vec3 p = c.p + place.x * c.u + place.y * c.v;
            const Surface to{p, light_normal, rounding_error({p, p, p}) * float_error};
            c.rays[shadow].push_back(to_float(spawn_to(from, to)));
        }
    return c;
}

// The triangles of a scene file.  Shadow rays end on the first light of the scene.
Case scene_of(const std::string& name, int width) {
    const Scene s = read_scene("scenes/" + name + ".scene").scene;
    const Light& lamp = s.lights.at(0);
    const auto& [e, f] = *lamp.as<QuadLight>();
    Case c{name, s.shapes, s.camera, lamp.p, e, f};
    std::erase_if(c.shapes, [](const Shape& x) { return !x.is_triangle(); });
    return with_rays(std::move(c), width);
}

// n triangles in the unit cube, each within n^(-1/3) of a random point: equally dense for every n.
Case soup(int n, int width) {
    const vec3 middle = {real(0.5), real(0.5), real(0.5)};
    Case c{text("%d, random", n), {},        look_at({real(0.5), real(0.5), 2}, middle, 45),
           {0, real(1.5), 0},     {1, 0, 0}, {0, 0, 1}};
    Rng rng{uint64_t(n)};
    for (int i = 0; i < n; ++i) {
        const vec3 centre = random3(rng);
        auto corner = [&] {
            return centre + (2 * random3(rng) - vec3{1, 1, 1}) / std::cbrt(real(n));
        };
        const vec3 p = corner(), q = corner(), r = corner();
        c.shapes.push_back({p, q, r});
    }
    return with_rays(std::move(c), width);
}

// ---- Tracers ------------------------------------------------------------------------------------

using Column = std::vector<double>;
using Trace = std::function<void(Kind, Column&)>;  // writes distances of all rays; occluded: 0

template <class OurTree>
Trace ours(const Case& c) {
    return [&c, tree = std::make_shared<const OurTree>(c.shapes)](Kind kind, Column& t) {
        for (size_t i = 0; i < t.size(); ++i) {
            const Ray& ray = c.rays[kind][i];
            if (kind == shadow) {
                t[i] = tree->occluded(ray) ? 0 : HUGE_VAL;
            } else {
                const auto hit = tree->closest(ray);
                t[i] = hit ? double(hit->t) : HUGE_VAL;
            }
        }
    };
}

#if HAVE_EMBREE
struct Embree {
    RTCDevice device = rtcNewDevice("threads=1,verbose=0");
    RTCScene scene = rtcNewScene(device);
    std::array<std::vector<RTCRay>, 3> rays;

    explicit Embree(const Case& c) {
        if (!device) throw SystemError("embree: no device");
        for (const auto& [kind, name] : kinds)
            for (const auto& [o, d, tmax] : c.rays[kind])
                rays[kind].push_back({float(o.x), float(o.y), float(o.z), 0, float(d.x), float(d.y),
                                      float(d.z), 0, float(tmax), ~0u, 0, 0});
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
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
};

Trace embree(const Case& c) {
    return [e = std::make_shared<const Embree>(c)](Kind kind, Column& t) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (size_t i = 0; i < t.size(); ++i) {
            RTCRayHit hit{e->rays[kind][i], {}};
            if (kind == shadow) {
                rtcOccluded1(e->scene, &context, &hit.ray);
                t[i] = hit.ray.tfar < 0 ? 0 : HUGE_VAL;
                continue;
            }
            hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(e->scene, &context, &hit);
            t[i] = hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? HUGE_VAL : double(hit.ray.tfar);
        }
    };
}
#endif

// ---- Measurements -------------------------------------------------------------------------------

struct Effort {
    int width = 512, rounds = 9;
    double seconds = 0.1;  // minimum CPU time of each measurement
};

struct Tracer {
    std::string name;
    Trace trace;
    Column answers = {};  // distances

    // Mrays/s for one kind of rays.  Throws if a repetition finds other hits.
    double run(Kind kind, double least_seconds) {
        const double start = processor_seconds();
        double elapsed = 0, rays = 0;
        while (elapsed < least_seconds) {
            Column again(answers.size());
            trace(kind, again);
            if (rays > 0 && again != answers) throw SystemError(name + ": other hits every time");
            answers = std::move(again), rays += double(answers.size());
            elapsed = processor_seconds() - start;
        }
        return rays / elapsed / 1e6;
    }
};

// The share of rays with another hit, or a distance that differs by over 1e-4.
double differ(const Column& a, const Column& b) {
    double count = 0;
    for (size_t i = 0; i < a.size(); ++i)
        count += a[i] != b[i] && !(std::abs(a[i] - b[i]) <= 1e-4 * std::min(a[i], b[i]));
    return count / double(a.size());
}

// Adds a row for each kind of rays, round and tracer.
void race(Rows& rows, const Case& c, const Effort& effort) {
    std::vector<Tracer> all = {{"wide", ours<WideBvh>(c)}, {"plain", ours<Bvh>(c)}};
#if HAVE_EMBREE
    all.push_back({"Embree", embree(c)});
#endif
    for (const auto& [kind, name] : kinds) {
        for (Tracer& t : all) t.answers.assign(c.rays[kind].size(), 0);
        for (int round = 0; round < effort.rounds; ++round)
            for (Tracer& t : all)
                rows.push_back({c.name + " | " + name,
                                t.name,
                                0,
                                uint64_t(round),
                                {{"speed", t.run(kind, effort.seconds)}}});
        if (differ(all[0].answers, all[1].answers) > 0)
            throw SystemError("the trees' answers differ");
        rows.back().of["differ"] = differ(all[0].answers, all.back().answers);
    }
}

double speed(const Rows& rows) { return mean(rows, "speed"); }

// Primary, bounce, shadow: the wide BVH's speed over another tracer's, geometric means over scenes.
std::vector<double> mean_ratios(const Rows& rows, const char* other) {
    std::vector<double> ratios;
    for (const auto& k : kinds)  // clang 14 captures no structured binding
        ratios.push_back(
            over(where(rows, [&](const Row& r) { return r.scene.ends_with(k.second); }), "wide",
                 other, speed));
    return ratios;
}
std::string told(const std::vector<double>& ratios) {
    return text("%.2f primary, %.2f bounce and %.2f shadow", ratios[0], ratios[1], ratios[2]);
}

int study(const Scope& scope) {
    if (!HAVE_EMBREE)
        return std::puts("bench: nothing is measured without Embree; install libembree-dev"), 0;
    const Effort effort = scope.quick ? Effort{256, 3, 0.01} : Effort{};
    Page page(scope, "bench");
    Rows rows;
    for (const char* name : {"cornell36", "mesh"}) race(rows, scene_of(name, effort.width), effort);
    for (int n : {1000, 100000}) race(rows, soup(n, effort.width), effort);
    Lines lines;
    for (const auto& [place, all] : grouped(rows, of_scene))
        lines.push_back({place.substr(0, place.find(" | ")), place.substr(place.find(" | ") + 3),
                         text("%.2f", speed(by_setting(all, "wide"))),
                         gain(all, "wide", "plain", speed), gain(all, "wide", "Embree", speed)});
    page.set("rays", table({"triangles", "rays", "Mrays/s", "× plain", "× Embree"}, lines));
    double differ = 0;
    for (const Row& r : rows) differ = std::fmax(differ, r["differ"]);
    page.set("differ", text("%.4f %%", 100 * differ));
    const Lines all = page.measured(mean_ratios(rows, "Embree"));
    page.set("verdict", "It traces at least " + told(least_of(all, 4)) + " rays per ray of Embree");
    page.set("processors", table({"processor", "instructions", "compiler", "commit", "primary",
                                  "bounce", "shadow"},
                                 all));
    page.set("over plain", told(mean_ratios(rows, "plain")));
    page.set("width", text("%d", effort.width));
    page.set("rounds", text("%d", effort.rounds));
    page.set("bytes", text("%zu", sizeof(real)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(
        argc, argv, {"bench", "Measures rays per second, compared with Embree if present."}, study);
}
