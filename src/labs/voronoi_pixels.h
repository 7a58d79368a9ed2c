// labs/voronoi_pixels.h  3  pixels by samples that weigh as their Voronoi cells do, for
// voronoi_weights
#pragma once
#include <ctime>

#include "base/stats.h"
#include "keep/keep.h"
#include "labs/lab.h"
#include "path/pathtracer.h"
#include "path/start.h"
#include "voronoi/weights.h"
#include "world/scene_file.h"

namespace pixels {

// In the order of the enumeration, so that a weighting is its own index; then strata, unweighted.
inline constexpr std::array weightings = {Weighting::mc, Weighting::vor, Weighting::fvor,
                                          Weighting::cvor, Weighting::torus};
inline constexpr const char* names[] = {"mc", "vor", "fvor", "cvor", "torus", "stratified"};
inline constexpr size_t mc = 0, vor = 1, cvor = 3, stratified = 5, techniques = 6;

struct Scope {
    bool quick = false;
    Size size = {256, 256};  // as published
    uint64_t most = 256;     // samples a pixel
    int every = 1;           // of the rows, which are measured
    std::vector<std::string> scenes = {"cornell", "cornellglossy"};
};

// ---- What a pixel shows -------------------------------------------------------------------------

enum Region { light_border, ball, edge, plain, regions };
inline constexpr const char* region_names[] = {"border of the light", "ball", "other edges",
                                               "one diffuse surface"};

// By what 64 camera rays meet.
inline Region region_of(const Scene& scene, PixelSample p) {
    bool emits = false, dark = false, sphere = false, other = false;
    uint32_t first = UINT32_MAX;
    vec3 n;
    for (int k = 0; k < 64; ++k) {
        const real x = real(p.x) + (real(k % 8) + real(0.5)) / 8,
                   y = real(p.y) + (real(k / 8) + real(0.5)) / 8;
        const auto met = meet(scene, camera_ray(scene.camera, scene.size, x, y));
        const uint32_t id = met ? met->hit.id : UINT32_MAX;
        const Material m = met ? *met->material : Material{};
        emits = emits || m.emits();
        dark = dark || !m.emits();
        sphere = sphere || m.is_delta() || max_of(m.ks) > 0;
        const vec3 normal = met ? met->at.n : vec3{};
        if (k == 0) first = id, n = normal;
        other = other || (id != first && !(normal == n));
    }
    if (emits && dark) return light_border;
    return sphere ? ball : other ? edge : plain;
}

// ---- Samples ------------------------------------------------------------------------------------

inline constexpr Technique technique = {Direction::bsdf, LightMode::nee, 0};

struct Samples {
    std::vector<Site> places;
    std::vector<rgb> L;
};

inline Samples draw_samples(const Scene& scene, const Pattern& pattern, PixelSample p, uint64_t n) {
    Samples s;
    for (uint64_t i = 0; i < n; ++i) {
        const Start at = start(scene, pattern, {p.x, p.y, i});
        s.places.push_back({double(at.u.x), double(at.u.y)});
        s.L.push_back(Li(scene, technique, at.ray, at.sampler));
    }
    return s;
}

// Samples first ... first + n - 1.
struct SampleSet {
    uint64_t first = 0, n = 0;
};

using Mean = std::array<double, 3>;
inline Mean weighted_mean(const std::vector<double>& w, const rgb* L) {
    Mean m{};
    for (size_t i = 0; i < w.size(); ++i)
        for (size_t c = 0; c < 3; ++c) m[c] += w[i] * double(L[i].*axis[c]);
    return m;
}

inline Mean weighted(Weigher& weigher, size_t t, const Samples& s, SampleSet set, uint64_t key) {
    return weighted_mean(weigher(weightings[t], {s.places.data() + set.first, set.n}, key),
                         s.L.data() + set.first);
}
inline Mean by_strata(const Scene& scene, uint64_t seed, PixelSample p, uint64_t n) {
    const Pattern strata = make_pattern(SamplerKind::stratified, seed, scene.depth, n);
    const Samples s = draw_samples(scene, strata, p, n);
    return weighted_mean(std::vector<double>(n, 1 / double(n)), s.L.data());
}

// ---- References ---------------------------------------------------------------------------------

struct Reference {
    Image image, noise;  // its own squared error, expected, pixel by pixel
    Mean mean{};         // of noise, a channel each
};

// The variance of each pixel of a film.
inline Image variance_of(const std::string& path, Size size) {
    FilmPixels film(path, size);
    Image image(size.width, size.height);
    for (auto& pixel : image.pixels) {
        const Pixel p = film.next();
        for (size_t c = 0; c < 3; ++c) pixel[c] = float(p.variance(c));
    }
    return image;
}

// The image by the best that we have.  Its error: the variance of its mean, from its replications,
// is the sum over pixels; a film of fewer samples tells how pixels share in it.
inline Reference read_reference(const std::string& name, Size size) {
    const std::string options = text(" --sampler halton --roulette 0 --seed 1000 --size %dx%d",
                                     size.width, size.height),
                      stem = text("reference/%s-%d", name, size.width), file = stem + ".pfm",
                      json = stem + ".json", variance = text("out/%s-%d.film", name, size.width),
                      scene = " scenes/" + name + ".scene";
    for (const std::string& needed : {file, json, variance})
        if (!std::filesystem::exists(needed))
            throw UserError(needed + ": missing; make it by\n  build/penumbra --sets 2 --spp 8192" +
                            options + " -o " + file + " --stats " + json + scene +
                            "\n  build/penumbra --sets 2 --spp 256" + options + " --keep " +
                            variance + " -o out/" + name + ".png" + scene);
    Reference r{read_pfm(file), variance_of(variance, size)};
    if (r.image.width != size.width || r.image.height != size.height)
        throw UserError(file + ": of another size");
    const std::vector<double> of_mean = stats(read_file(json), "variance_of_mean");
    const double count = double(r.image.pixels.size());
    for (size_t c = 0; c < 3; ++c) {
        if (of_mean.size() != 3 || !(of_mean[c] > 0))
            throw UserError(json + ": variance_of_mean is not three numbers above 0");
        r.mean[c] = of_mean[c] * count;  // of a pixel, on average
        double sum = 0;
        for (const auto& pixel : r.noise.pixels) sum += double(pixel[c]) / count;
        if (!(sum > 0)) throw UserError(variance + ": no variance");
        for (auto& pixel : r.noise.pixels) pixel[c] *= float(r.mean[c] / sum);
    }
    return r;
}

// ---- Errors -------------------------------------------------------------------------------------

// Of one technique with one number of samples.
struct PixelEstimates {
    std::array<double, regions> squares{}, count{};  // of errors, over channels and pixels
    double seconds = 0, samples = 0;                 // of weights; of paths for mc and stratified
    uint64_t redraws = 0, fallbacks = 0;

    void add(const Mean& m, const std::array<float, 3>& truth, const std::array<float, 3>& noise,
             Region r) {
        for (size_t c = 0; c < 3; ++c) {
            const double e = m[c] - double(truth[c]);
            squares[r] += e * e - double(noise[c]);
            ++count[r];
        }
    }
    void merge(const PixelEstimates& t) {
        for (size_t r = 0; r < regions; ++r) squares[r] += t.squares[r], count[r] += t.count[r];
        seconds += t.seconds, samples += t.samples;
        redraws += t.redraws, fallbacks += t.fallbacks;
    }
    double sum() const { return std::accumulate(squares.begin(), squares.end(), 0.0); }
    double values() const { return std::accumulate(count.begin(), count.end(), 0.0); }
    double mse() const { return sum() / values(); }
    double mse(size_t region) const { return squares[region] / count[region]; }
    double time() const { return seconds / samples; }  // of one sample
};

struct Result {
    std::string name;
    Scene scene;
    Reference reference;
    std::vector<uint64_t> ns = {};
    std::vector<std::array<PixelEstimates, techniques>> of = {};  // by n
    std::array<Image, weightings.size()> variance = {};  // of 64 samples' mean, all channels

    // Squared error of mc over that of t.
    double gain(size_t k, size_t t) const { return of[k][mc].mse() / of[k][t].mse(); }
    double gain(size_t k, size_t t, size_t region) const {
        return of[k][mc].mse(region) / of[k][t].mse(region);
    }
    double time(size_t k, size_t t) const {
        return of[k][t].time() + (t == mc || t == stratified ? 0 : of[k][mc].time());
    }
};

inline double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Of `most` samples, how many sets of n are looked at.
inline uint64_t sets(uint64_t most, uint64_t n) {
    return std::min<uint64_t>(most / n, n == 64 ? 8 : n == 256 ? 4 : 1);
}

// All techniques get the same samples of a pixel, but for strata.
inline void measure_pixel(Result& r, std::vector<std::array<PixelEstimates, techniques>>& tallies,
                          Weigher& weigher, PixelSample p, uint64_t most) {
    const Region region = region_of(r.scene, p);
    const auto &truth = r.reference.image.at(p.x, p.y), &noise = r.reference.noise.at(p.x, p.y);
    double start = thread_seconds();
    const Samples s = draw_samples(r.scene, {SamplerKind::independent, 1}, p, most);
    const double a_path = (thread_seconds() - start) / double(most);
    std::array<std::array<Moments, 3>, weightings.size()> spread{};
    for (size_t k = 0; k < r.ns.size(); ++k) {
        const uint64_t n = r.ns[k];
        for (uint64_t set = 0; set < sets(most, n); ++set)
            for (size_t t = 0; t < weightings.size(); ++t) {
                PixelEstimates& tally = tallies[k][t];
                const uint64_t key = hash(hash(n, set), uint64_t(p.y) << 32 | uint32_t(p.x));
                start = thread_seconds();
                const Mean m = weighted(weigher, t, s, {set * n, n}, key);
                tally.seconds += t == mc ? a_path * double(n) : thread_seconds() - start;
                tally.samples += double(n);
                tally.redraws += std::exchange(weigher.redraws, 0);
                tally.fallbacks += std::exchange(weigher.fallbacks, 0);
                tally.add(m, truth, noise, region);
                for (size_t c = 0; c < 3 && n == 64; ++c) spread[t][c].add(m[c]);
            }
        PixelEstimates& tally = tallies[k][stratified];
        start = thread_seconds();
        tally.add(by_strata(r.scene, 2, p, n), truth, noise, region);
        tally.seconds += thread_seconds() - start;
        tally.samples += double(n);
    }
    for (size_t t = 0; t < weightings.size(); ++t)
        for (size_t c = 0; c < 3; ++c)
            r.variance[t].at(p.x, p.y)[c] = float(spread[t][c].variance());
}

inline Result measure(const std::string& name, const Scope& plan) {
    Result r{name, read_scene("scenes/" + name + ".scene").scene, read_reference(name, plan.size)};
    r.scene.size = plan.size;
    for (uint64_t n = 64; n <= plan.most; n *= 4) r.ns.push_back(n);
    r.of.resize(r.ns.size());
    r.variance.fill(Image(plan.size.width, plan.size.height));
    std::mutex mutex;
    auto row = [&](size_t y) {
        Weigher weigher;
        std::vector<std::array<PixelEstimates, techniques>> mine(r.ns.size());
        for (int x = 0; x < plan.size.width; ++x)
            measure_pixel(r, mine, weigher, {x, int(y) * plan.every}, plan.most);
        std::lock_guard lock(mutex);
        for (size_t k = 0; k < mine.size(); ++k)
            for (size_t t = 0; t < techniques; ++t) r.of[k][t].merge(mine[k][t]);
    };
    in_parallel(size_t(plan.size.height / plan.every), all_cores(), row, [](double) {});
    return r;
}

}  // namespace pixels
