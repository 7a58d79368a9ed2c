// labs/bench.cpp  3  how many rays a second?
//
//   build/bench [--quick]
//
// Millions of rays a second, on one thread, of our tree and of Embree (Wald et al. 2014, ACM TOG
// 33(4)) where Debian's libembree-dev is installed.  Three kinds of rays:
//   primary   closest hit along jittered camera rays, row by row: neighbours take the same way;
//   bounce    closest hit from the primary hits in cosine-weighted directions: no two alike;
//   shadow    any hit between the primary hits and random points of a quad.
// Both answer the same rays in the same triangles, all rounded to float, since Embree knows nothing
// else.  They take turns, so that a busy machine slows both, and the time is that of the processor.
// A median of the rounds is followed by their least and greatest; the ratios are taken round by
// round.  Nothing here fails for being slow.
#include <ctime>
#include <numeric>

#include "base/program.h"
#include "base/rng.h"
#include "world/scene_file.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#define HAVE_EMBREE true
#else
#define HAVE_EMBREE false
#endif

namespace {

enum Kind { primary, bounce, shadow };
constexpr std::array kinds = {primary, bounce, shadow};

struct Effort {
    int width = 512, rounds = 9, builds = 3;
    double seconds = 0.1;  // of each measurement, at least
};

struct Quad {
    vec3 p, u, v;
};

struct Case {
    std::string name;
    std::vector<Shape> shapes;
    Camera camera;
    Quad light;                            // shadow rays go there
    std::array<std::vector<Ray>, 3> rays;  // of each kind
};

// ---- Scenes and their rays ----------------------------------------------------------------------

real random(Rng& rng) { return to_unit(rng.bits()); }

vec2 random2(Rng& rng) {
    const real x = random(rng), y = random(rng);
    return {x, y};
}

vec3 random3(Rng& rng) {
    const real x = random(rng), y = random(rng), z = random(rng);
    return {x, y, z};
}

// volatile: the vectoriser of g++ 12 drops a conversion to float and back.
real to_float(real x) {
    volatile float y = float(x);
    return y;
}

vec3 to_float(vec3 a) { return {to_float(a.x), to_float(a.y), to_float(a.z)}; }

Ray to_float(const Ray& r) { return {to_float(r.o), to_float(r.d), to_float(r.tmax)}; }

// A point of a surface whose error is that of float, so that no ray meets what it leaves.
Surface float_surface(Surface x) {
    x.error *= real(std::numeric_limits<float>::epsilon() / 2) / ulp;
    return x;
}

void make_rays(Case& c, int width) {
    for (Shape& s : c.shapes) s = {to_float(s.a), to_float(s.b), to_float(s.c)};
    const Bvh bvh(c.shapes);
    const vec3 light_normal = unit(cross(c.light.u, c.light.v));
    Rng rng{mix(c.shapes.size())};
    for (int y = 0; y < width; ++y)
        for (int x = 0; x < width; ++x) {
            const vec2 jitter = random2(rng), direction = random2(rng), place = random2(rng);
            const Ray ray = to_float(
                camera_ray(c.camera, {width, width}, real(x) + jitter.x, real(y) + jitter.y));
            c.rays[primary].push_back(ray);
            const auto hit = bvh.closest(ray);
            if (!hit) continue;
            Surface from = float_surface(surface(c.shapes[hit->id], ray, *hit));
            if (dot(from.n, ray.d) > 0) from.n = -from.n;
            const vec3 wi = frame(from.n).to_world(sample_cosine_hemisphere(direction));
            c.rays[bounce].push_back(to_float(spawn(from, wi)));
            const vec3 p = c.light.p + sample_quad(place, c.light.u, c.light.v);
            const Surface to{p, light_normal, rounding_error({p, p, p})};
            c.rays[shadow].push_back(to_float(spawn_to(from, float_surface(to))));
        }
}

Case cornell(int width) {
    Scene s = read_scene("scenes/cornell36.scene").scene;
    const Light& lamp = s.lights.at(0);
    Case c{"cornell36", s.shapes, s.camera, {lamp.p, lamp.u, lamp.v}, {}};
    make_rays(c, width);
    return c;
}

// 4^level triangles of the unit sphere for each face of the icosahedron; neighbours share corners.
void refine(std::vector<Shape>& out, vec3 a, vec3 b, vec3 c, int level) {
    if (level == 0) return out.push_back({a, b, c});
    const vec3 ab = unit(a + b), bc = unit(b + c), ca = unit(c + a);
    refine(out, a, ab, ca, level - 1);
    refine(out, ab, b, bc, level - 1);
    refine(out, ca, bc, c, level - 1);
    refine(out, ab, bc, ca, level - 1);
}

// The unit sphere in a box of side 4, seen from a corner; the light is a part of the ceiling.
Case icosphere(int level, int width) {
    Scene s;
    s.materials.emplace_back();
    add_box(s, {4, 4, 4}, 0, {-2, -2, -2}, 0);
    const real g = std::numbers::phi_v<real>;
    std::vector<vec3> corner;  // (0, +-1, +-g) and its rotations
    for (real y : {real(-1), real(1)})
        for (real z : {-g, g}) {
            corner.push_back({0, y, z});
            corner.push_back({y, z, 0});
            corner.push_back({z, 0, y});
        }
    auto adjacent = [](vec3 a, vec3 b) { return dot(a - b, a - b) < 5; };  // the edges have 4
    for (size_t i = 0; i < corner.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            for (size_t k = 0; k < j; ++k) {
                const vec3 a = corner[i], b = corner[j], c = corner[k];
                if (adjacent(a, b) && adjacent(b, c) && adjacent(c, a))
                    refine(s.shapes, unit(a), unit(b), unit(c), level);
            }
    Case c{"icosphere " + std::to_string(s.shapes.size()),
           s.shapes,
           look_at({real(1.7), real(1.2), real(1.9)}, {0, real(-0.1), 0}, 65),
           {{-1, real(1.99), -1}, {2, 0, 0}, {0, 0, 2}},
           {}};
    make_rays(c, width);
    return c;
}

// Corners within n^(-1/3) of a random point of the unit cube: however many, it looks as full.
Case soup(int n, int width) {
    Case c{"random " + std::to_string(n),
           {},
           look_at({real(0.5), real(0.5), 2}, {real(0.5), real(0.5), real(0.5)}, 45),
           {{0, real(1.5), 0}, {1, 0, 0}, {0, 0, 1}},
           {}};
    const real size = 1 / std::cbrt(real(n));
    Rng rng{uint64_t(n)};
    for (int i = 0; i < n; ++i) {
        const vec3 centre = random3(rng);
        auto corner = [&] { return centre + size * (2 * random3(rng) - vec3{1, 1, 1}); };
        const vec3 p = corner(), q = corner(), r = corner();
        c.shapes.push_back({p, q, r});
    }
    make_rays(c, width);
    return c;
}

// ---- The tracers --------------------------------------------------------------------------------

struct Penumbra {
    const Case& c;
    Bvh bvh;

    explicit Penumbra(const Case& source) : c(source) {}

    void build() { bvh = Bvh(c.shapes); }
    double bytes() const { return double(bvh.bytes()); }

    // Distance of the hit of ray i (any hit: 0), or infinity.
    real find(Kind kind, size_t i) const {
        const Ray& ray = c.rays[kind][i];
        if (kind == shadow) return bvh.occluded(ray) ? 0 : infinity;
        const auto hit = bvh.closest(ray);
        return hit ? hit->t : infinity;
    }
};

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
    double bytes() const { return double(held); }

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
#else
using Embree = Penumbra;  // to be compiled, never run
#endif

// ---- Measuring ----------------------------------------------------------------------------------

double seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }  // of the processor

using Column = std::vector<double>;  // a number a round

double median(Column x) {
    std::sort(x.begin(), x.end());
    return (x[(x.size() - 1) / 2] + x[x.size() / 2]) / 2;
}

void print_row(const std::string& scene, const char* tracer, const std::array<Column, 3>& columns) {
    std::printf("| %s | %s |", scene.c_str(), tracer);
    for (const Column& x : columns) {
        const auto [least, most] = std::minmax_element(x.begin(), x.end());
        std::printf(" %.2f (%.2f–%.2f) |", median(x), *least, *most);
    }
}

// A tracer in the race, built, and how it did.
template <class Tracer>
struct Runner {
    Tracer tracer;
    double build_seconds = 0, bytes = 0;  // of each triangle
    std::array<size_t, 3> hits{};
    std::array<Column, 3> speed{};  // millions of rays a second

    Runner(const Case& c, int builds) : tracer(c) {
        Column times;
        for (int i = 0; i < builds; ++i) {
            const double start = seconds();
            tracer.build();
            times.push_back(seconds() - start);
        }
        build_seconds = median(times);
        bytes = tracer.bytes() / double(c.shapes.size());
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
        const double start = seconds();
        double elapsed = 0, rays = 0;
        while (elapsed < least_seconds) {
            if (count_hits(kind) != hits[kind]) throw SystemError("other hits every time");
            rays += double(tracer.c.rays[kind].size());
            elapsed = seconds() - start;
        }
        speed[kind].push_back(rays / elapsed / 1e6);
    }
};

// Per cent of the rays whose answers differ: hit or not, or by more than 1e-4 of the distance.
double disagreement(const Penumbra& a, const Embree& b, Kind kind) {
    size_t count = 0;
    const size_t rays = a.c.rays[kind].size();
    for (size_t i = 0; i < rays; ++i) {
        const double s = double(a.find(kind, i)), t = double(b.find(kind, i));
        count += s != t && !(std::abs(s - t) <= 1e-4 * std::min(s, t));
    }
    return 100 * double(count) / double(rays);
}

// Prints the rows of a scene; adds to each of `logarithms` that of our speed over Embree's.
void race(const Case& c, const Effort& effort, std::array<double, 3>& logarithms) {
    Runner<Penumbra> ours(c, effort.builds);
    std::optional<Runner<Embree>> theirs;
    if (HAVE_EMBREE) theirs.emplace(c, effort.builds);
    std::array<Column, 3> ratio;
    for (int round = 0; round < effort.rounds; ++round)
        for (Kind kind : kinds) {
            ours.run(kind, effort.seconds);
            if (!theirs) continue;
            theirs->run(kind, effort.seconds);
            ratio[kind].push_back(ours.speed[kind].back() / theirs->speed[kind].back());
        }
    print_row(c.name, "Penumbra", ours.speed);
    std::printf(" %.2g | %.0f |", ours.build_seconds, ours.bytes);
    for (Kind kind : kinds)
        std::printf(" %.1f |", 100 * double(ours.hits[kind]) / double(c.rays[kind].size()));
    std::printf("\n");
    if (theirs) {
        print_row("", "Embree", theirs->speed);
        std::printf(" %.2g | %.0f | | | |\n", theirs->build_seconds, theirs->bytes);
        print_row("", "ratio; differ", ratio);
        std::printf(" %.2f | %.2f |", ours.build_seconds / theirs->build_seconds,
                    ours.bytes / theirs->bytes);
        for (Kind kind : kinds) {
            std::printf(" %.4f |", disagreement(ours.tracer, theirs->tracer, kind));
            logarithms[kind] += std::log(median(ratio[kind]));
        }
        std::printf("\n");
    }
    std::fflush(stdout);
}

int bench(const std::vector<std::string>& words) {
    Effort effort;
    for (const std::string& word : words) {
        if (word != "--quick") throw UserError(unknown("option", word, {"--quick"}));
        effort = {256, 3, 1, 0.01};
    }
    std::printf("One thread, numbers of %zu bytes, compiler %s\n\n", sizeof(real), __VERSION__);
    std::printf(
        "| scene, triangles | tracer | primary, Mrays/s | bounce, Mrays/s | shadow, Mrays/s "
        "| build, s | bytes per triangle | primary hits, %% | bounce hits, %% | shadow hits, %% |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    std::array<double, 3> logarithms{};
    race(cornell(effort.width), effort, logarithms);
    for (int level : {5, 7, 8}) race(icosphere(level, effort.width), effort, logarithms);
    for (int n : {1000, 100000}) race(soup(n, effort.width), effort, logarithms);
    if (HAVE_EMBREE) {
        std::printf("| geometric mean | ratio |");
        for (double x : logarithms) std::printf(" %.3f |", std::exp(x / 6));
        std::printf(" | | | | |\n");
    } else {
        std::printf("\nWithout Embree: there is no <embree3/rtcore.h> (Debian: libembree-dev).\n");
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return bench({argv + 1, argv + argc}); });
}
