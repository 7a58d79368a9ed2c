// radiosity/particles.h  5  particle tracing from the lights fills the maps
//
// A particle carries power, per channel, from a light.  It adds it to the hat functions where it
// hits, and survives with probability albedo.  Unbiased for the maps of projection.h, with any
// unbiased sampler.
#pragma once
#include "app/threads.h"
#include "film/film.h"
#include "radiosity/batches.h"
#include "radiosity/projection.h"

namespace penumbra {

// ---- One walk -----------------------------------------------------------------------------------

// Balance of the power: emitted = absorbed + escaped, except for rounding.
struct Balance {
    rgb emitted, absorbed, escaped;
    static constexpr rgb Balance::*parts[] = {&Balance::emitted, &Balance::absorbed,
                                              &Balance::escaped};
};

// The numbers of a walk: five for its start, three per bounce.  Beyond `structured` bounces they
// are independent: Halton's bases would be large, and their points no better.
class WalkNumbers {
public:
    static constexpr uint32_t which_light = 0, point = 1, direction = 3, side = 5, structured = 8;

    WalkNumbers(const SamplerSettings& settings, const SamplerSettings& independent, uint64_t batch,
                uint64_t i)
        : first_(settings, batch, i), independent_(independent), batch_(batch), i_(i) {}

    real start(uint32_t what) const { return first_.get(what); }
    vec2 start2(uint32_t what) const { return first_.get2(what); }
    real survival(uint32_t k) const { return of(k).get(6 + 3 * k); }
    vec2 scattered(uint32_t k) const { return of(k).get2(7 + 3 * k); }

private:
    const Sampler first_;
    const SamplerSettings& independent_;
    const uint64_t batch_, i_;
    Sampler of(uint32_t k) const {
        return k < structured ? first_ : Sampler(independent_, batch_, i_);
    }
};

struct Particle {
    Ray ray;
    rgb power;
};

// Lights, at least one, are chosen with probabilities in proportion to their power.  Random numbers
// are multiples of ulp, and so are the probabilities, exactly; an even share keeps each above 0.  A
// power that underflows counts as the least.
class LightsByPower {
public:
    explicit LightsByPower(const std::vector<Light>& lights) {
        const double n = double(lights.size()), even = std::min(0.5, 2 * n * double(ulp));
        constexpr double least = std::numeric_limits<double>::min();
        double total = 0, sum = 0;
        for (const Light& l : lights) total += power(l) + least;
        for (const Light& l : lights) {
            sum += power(l) + least;
            const double cdf = even * double(cdf_.size() + 1) / n + (1 - even) * (sum / total);
            cdf_.push_back(std::round(cdf / double(ulp)) * double(ulp));
        }
    }
    size_t choose(real u) const {
        const auto i = std::upper_bound(cdf_.begin(), cdf_.end(), double(u));
        return std::min(size_t(i - cdf_.begin()), cdf_.size() - 1);
    }
    // The probability of a light's choice.
    real probability_of(size_t light) const {
        return real(cdf_[light] - (light ? cdf_[light - 1] : 0));
    }

private:
    std::vector<double> cdf_;
};

// From a light chosen by its power, uniformly from its area, as Lambert's cosine law has it.  A
// polygon or a point: spheres have become facets.
inline Particle emit(const Scene& scene, const LightsByPower& lights, const WalkNumbers& u) {
    const size_t chosen = lights.choose(u.start(WalkNumbers::which_light));
    const real probability = lights.probability_of(chosen);
    const Light& l = scene.lights[chosen];
    const vec2 at = u.start2(WalkNumbers::point), d = u.start2(WalkNumbers::direction);
    if (l.is_delta()) {
        const vec3 w = sample_uniform_sphere(d);
        return {{l.p, w}, l.L / (pdf_uniform_sphere() * probability)};
    }
    Surface y = point_of(l, at);
    if (l.twosided && u.start(WalkNumbers::side) >= real(0.5)) y.n = -y.n;
    const vec3 w = frame(y.n).to_world(sample_cosine_hemisphere(d));
    const real area = real(l.ask([](const auto& kind) { return kind.intensity(1); }));
    return {spawn(y, w), pi * area * (l.twosided ? 2 : 1) * l.L / probability};
}

// White walls absorb nothing, but walks have to end: one in fifty does, and the others weigh more.
inline constexpr real white_survival = real(0.98);

// Calls hit(vertex, power) wherever the particle stops; returns the number of rays.  Random numbers
// of stop k are u.survival(k) and u.scattered(k).
template <class Hit>
uint32_t walk(const Scene& scene, const LightsByPower& lights, const WalkNumbers& u,
              Balance& balance, Hit hit) {
    auto [ray, power] = emit(scene, lights, u);
    balance.emitted += power;
    for (uint32_t k = 0;; ++k) {
        const auto x = meet(scene, ray);
        if (!x) {
            balance.escaped += power;
            return k + 1;
        }
        // exercise R.2
        hit(*x, power);
        const rgb rho = x->material->diffuse();
        const real all = max_of(rho), survival = all < 1 ? all : white_survival;
        if (u.survival(k) >= survival) {
            balance.absorbed += power;
            return k + 1;
        }
        const rgb left = power * rho / survival;
        balance.absorbed += power - left;
        power = left;
        const vec3 w = x->local.to_world(sample_cosine_hemisphere(u.scattered(k)));
        ray = spawn(x->at, w);
        // end
    }
}

// ---- All of them --------------------------------------------------------------------------------

class Particles {
public:
    // A batch is a randomisation of its own, and one thread's work at a time: the sums are the
    // same, bit for bit, for any number of threads; and the batches' spread is the error of their
    // mean.
    static constexpr int batches = 16;

    // Both must outlive it.
    Particles(const Scene& scene, const Mesh& mesh, const SamplerSettings& settings)
        : scene_(scene),
          lights_(scene.lights),
          mesh_(mesh),
          settings_(settings),
          independent_(sampler_settings(SamplerKind::independent, settings.seed, 0)),
          batch_(batches, Batch{std::vector<Sum>(number_of_sides(mesh)), {}, 0, 0}) {}

    // Every batch has as many.
    static uint64_t of_each(uint64_t samples) { return (samples + batches - 1) / batches; }

    // Settings of a sampler of as many dimensions as a walk has numbers.
    static SamplerSettings settings(SamplerKind kind, uint64_t seed) {
        return sampler_settings(kind, seed, 5);
    }

    // Traces n more particles of a batch, or fewer after Ctrl-C.
    void add(size_t batch, uint64_t n) {
        Batch& b = batch_[batch];
        for (const uint64_t end = b.n + n; b.n < end && !interrupted; ++b.n) {
            const WalkNumbers u(settings_, independent_, uint64_t(batch), b.n);
            Balance one;
            rgb kept{1, 1, 1};  // part that the surfaces reflect
            b.rays += walk(scene_, lights_, u, one, [&](const Vertex& x, rgb power) {
                kept *= x.material->diffuse();
                const auto [vertex, weight] = between(mesh_, x.hit);
                for (size_t k = 0; k < 3; ++k)
                    add_to(b.sums[2 * vertex[k] + (x.cos_o < 0)], power * weight[k]);
            });
            for (size_t k = 0; k < 3; ++k) add_to(b.balance[k], one.*Balance::parts[k]);
            for (size_t c = 0; c < 3; ++c)
                b.lost[c] |=
                    one.emitted.*axis[c] > 0 && (one.escaped.*axis[c] > 0 || kept.*axis[c] < 1);
        }
    }

    // ---- Results --------------------------------------------------------------------------------

    // Complete particles of each batch.
    uint64_t of_each() const {
        return std::min_element(batch_.begin(), batch_.end(),
                                [](auto& a, auto& b) { return a.n < b.n; })
            ->n;
    }
    uint64_t particles() const {
        uint64_t n = 0;
        for (const Batch& b : batch_) n += b.n;
        return n;
    }
    uint64_t rays() const {
        uint64_t n = 0;
        for (const Batch& b : batch_) n += b.rays;
        return n;
    }
    // True if no light of some channel was lost: in a closed room that absorbs nothing, it has no
    // limit.
    bool is_endless() const {
        for (size_t c = 0; c < 3; ++c) {
            bool emitted = false, lost = false;
            for (const Batch& b : batch_) emitted |= b.balance[0][c] > 0, lost |= b.lost[c];
            if (emitted && !lost) return true;
        }
        return false;
    }
    // Sums over all particles, divided by their number.
    Balance balance() const {
        Balance mean;
        for (size_t k = 0; k < 3; ++k) {
            Sum sum{};
            for (const Batch& b : batch_)
                for (size_t c = 0; c < 3; ++c) sum[c] += b.balance[k][c] / double(particles());
            mean.*Balance::parts[k] = {real(sum[0]), real(sum[1]), real(sum[2])};
        }
        return mean;
    }

    IlluminationMap map(Functional functional = Functional::projection) const {
        IlluminationMap map(number_of_sides(mesh_));
        for_each_side([&](const Projection& onto, const Face& f, bool back) {
            Sums b(f.vertices());
            for (const Batch& batch : batch_) add_sums(b, batch, f, back, 1 / double(particles()));
            const Sums E = onto(b, functional);
            for (uint32_t v = 0; v < E.size(); ++v) map[2 * (f.vertex + v) + back] = E[v];
        });
        return map;
    }

    // The standard error of the map by the batches' spread, see BatchSquares.  NaN if a batch is
    // empty.
    MapError stated(Functional functional = Functional::projection) const {
        for (const Batch& batch : batch_)
            if (batch.n == 0) return {};
        BatchSquares<batches> squares;
        for_each_side([&](const Projection& onto, const Face& f, bool back) {
            constexpr auto precise = real(1e-4);  // an error needs no more digits
            Sums mean(f.vertices());
            for (const Batch& batch : batch_)
                add_sums(mean, batch, f, back, 1 / (double(batch.n) * batches));
            const Sums E = onto(mean, functional, precise);
            squares.whole += sum_of(onto.square(E));
            for (size_t k = 0; k < batches; ++k) {
                const Batch& batch = batch_[k];
                Sums difference(f.vertices());
                add_sums(difference, batch, f, back, 1 / double(batch.n));
                for (size_t v = 0; v < mean.size(); ++v) difference[v] += -mean[v];
                const Sums off = onto(difference, functional, precise);
                squares.off[k] += sum_of(onto.square(off));
                squares.along[k] += sum_of(onto.product(off, E));
            }
        });
        return squares.stated();
    }
    double error(Functional functional = Functional::projection) const {
        return stated(functional).error;
    }

    static Bytes bytes() {
        Bytes b;
        b.vertex += 2 * (batches * sizeof(Sum) + sizeof(rgb));
        return b;
    }

private:
    struct Batch {
        std::vector<Sum> sums;  // sums of power times hat, for the sides of all vertices
        std::array<Sum, 3> balance;
        uint64_t n, rays;
        std::array<bool, 3> lost{};  // per channel: light was absorbed or has escaped
    };

    const Scene& scene_;
    const LightsByPower lights_;
    const Mesh& mesh_;
    const SamplerSettings settings_, independent_;
    std::vector<Batch> batch_;

    static double sum_of(rgb x) { return double(x.x) + double(x.y) + double(x.z); }

    // Adds a batch's sums on one side of a face, times a factor.
    static void add_sums(Sums& b, const Batch& batch, const Face& f, bool back, double factor) {
        for (uint32_t v = 0; v < b.size(); ++v) {
            const Sum& sum = batch.sums[2 * (f.vertex + v) + back];
            b[v] += {real(sum[0] * factor), real(sum[1] * factor), real(sum[2] * factor)};
        }
    }

    // Calls visit(projection, face, back) for the sides that a particle has met.
    template <class Visit>
    void for_each_side(Visit visit) const {
        for (const Face& f : mesh_.faces) {
            const Projection onto(mesh_, f);
            for (const bool back : {false, true})
                if (met(f, back)) visit(onto, f, back);
        }
    }
    bool met(const Face& f, bool back) const {
        for (const Batch& batch : batch_)
            for (uint32_t v = f.vertex; v < f.vertex + f.vertices(); ++v)
                if (batch.sums[2 * v + back] != Sum{}) return true;
        return false;
    }
};

}  // namespace penumbra
