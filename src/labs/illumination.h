// labs/illumination.h  3  rooms cut into triangles, lit by either method, as their camera sees them
#pragma once
#include "labs/lab.h"
#include "radiosity/particles.h"
#include "radiosity/shooting.h"

namespace illumination {

struct Scope {
    bool quick = false, full = false;
};

// Distance of two images relative to the quadratic mean of the first (Khodulev 1996, ch. 5).
inline double d_rel(const Image& f, const Image& g) {
    double square = 0;
    for (const auto& pixel : f.pixels)
        for (float x : pixel) square += double(x) * double(x);
    return std::sqrt(mse(f, g) * 3 * double(f.pixels.size()) / square);
}

inline std::string percent(double x) { return text(x < 0.001 ? "%.3f %%" : "%.2g %%", 100 * x); }
inline std::string seconds(double s) { return text(s < 0.1 ? "%.2g s" : "%.3g s", s); }

// ---- Rooms --------------------------------------------------------------------------------------

// A scene and its triangles, no edge of them longer than H.
struct Room {
    std::string name;
    Scene scene;
    Mesh mesh;
    double H = 0;
    std::string size() const { return text("%zu", mesh.elements()); }
};

inline Room room(const std::string& name, double H, std::optional<Size> size = {}) {
    const Scene read = read_scene("scenes/" + name + ".scene").scene;
    Room r{name, faceted(read, H).scene, {}, H};
    r.scene.size = size.value_or(r.scene.size);
    r.mesh = make_mesh(r.scene, H);
    return r;
}

// What its camera sees of a map: the rays, 16 a pixel on a grid, are traced once for all maps.
class Eye {
public:
    explicit Eye(const Room& room) : size_(room.scene.size) {
        looks_.resize(size_t(size_.width) * size_t(size_.height) * rays);
        auto row = [&](size_t y) {
            Look* next = &looks_[size_t(y) * size_t(size_.width) * rays];
            for (int x = 0; x < size_.width; ++x)
                pixel_of(room.scene, x, y, side, [&](const Ray& ray) {
                    *next++ = look(room, ray);
                    return rgb{};
                });
        };
        in_parallel(size_t(size_.height), all_cores(), row, [](double) {});
    }

    Image operator()(const IlluminationMap& map) const {
        Image image(size_.width, size_.height);
        for (size_t i = 0; i < image.pixels.size(); ++i) {
            rgb sum;
            for (const Look* l = &looks_[i * rays]; l < looks_.data() + (i + 1) * rays; ++l) {
                sum += l->Le;
                for (size_t k = 0; k < 3; ++k) sum += l->rho * map[l->side[k]] * l->weight[k] / pi;
            }
            for (size_t c = 0; c < 3; ++c) image.pixels[i][c] = float(sum.*axis[c] / rays);
        }
        return image;
    }

private:
    static constexpr int side = 4, rays = side * side;
    struct Look {
        std::array<uint32_t, 3> side{};
        std::array<real, 3> weight{};
        rgb rho, Le;
    };
    const Size size_;
    std::vector<Look> looks_;

    static Look look(const Room& room, const Ray& ray) {
        const auto x = meet(room.scene, ray);
        if (!x || x->cos_o == 0) return {};
        const auto [vertex, weight] = between(room.mesh, x->hit);
        Look l{{}, weight, x->material->kd, emitted(*x->material, x->cos_o)};
        for (size_t k = 0; k < 3; ++k) l.side[k] = 2 * vertex[k] + (x->cos_o < 0);
        return l;
    }
};

// ---- Solutions ----------------------------------------------------------------------------------

struct Filled {
    Image image;
    IlluminationMap map;
    double reported = 0;  // relative error of the map, by the batches
    double seconds = 0;   // of all threads together by the clock, without the image
    uint64_t particles = 0, rays = 0;
};

// All particles, by all threads.
inline void walk(Particles& particles, uint64_t n) {
    in_parallel(
        Particles::batches, all_cores(),
        [&](size_t batch) { particles.add(batch, n / Particles::batches); }, [](double) {});
}

using Clock = std::chrono::steady_clock;
inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

inline Filled fill(const Room& room, const Eye& eye, SamplerKind kind, uint64_t seed, uint64_t n) {
    Particles particles(room.scene, room.mesh, Particles::pattern(kind, seed, n));
    const Clock::time_point start = Clock::now();
    walk(particles, n);
    IlluminationMap map = particles.map();
    const double seconds = seconds_since(start);
    Filled f{eye(map), std::move(map),        particles.error(),
             seconds,  particles.particles(), particles.rays()};
    return f;
}

struct Shot {
    Image image;
    double seconds = 0, unshot = 0;
    uint64_t shots = 0, rays = 0;
};

// One run, looked at whenever the unshot part has come down to the next of a list, and at its end;
// which is no later than `seconds`.
inline std::vector<Shot> shoot(const Room& room, const Eye& eye, Shooter shooter,
                               const std::vector<double>& unshot, double seconds) {
    Shooting run(room.scene, room.mesh, shooter, all_cores());
    std::vector<Shot> looks;
    for (double next : unshot) {
        run.run({next, seconds, 0}, [](const Shooting&) {});
        looks.push_back({eye(run.map()), run.seconds(), run.unshot(), run.shots(), run.rays()});
        if (run.unshot() > next) break;
    }
    return looks;
}

// 0.5, 0.2, 0.1, ... down to the least.
inline std::vector<double> unshot_down_to(double least) {
    std::vector<double> list;
    for (double decade = 1; decade > least * 0.99; decade /= 10)
        for (double part : {0.5, 0.2, 0.1})
            if (decade * part > least * 0.99) list.push_back(decade * part);
    return list;
}

}  // namespace illumination
