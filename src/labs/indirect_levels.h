// labs/indirect_levels.h  4  variance and cost of a sample, by when paths go on beyond maps
#pragma once
#include "labs/illumination.h"
#include "labs/indirect_paths.h"

namespace indirect {

using illumination::Room;

// ---- Ways ---------------------------------------------------------------------------------------

constexpr real roulette = real(0.25);  // of whole paths, by default

// Probabilities to go on: the same at every vertex, or at the first, after which a path is whole;
// or the throughput over a threshold.
template <int percent>
real always(const Segment&) {
    return real(percent) / 100;
}
template <int percent>
real at_first(const Segment& s) {
    const bool played = !(max_of(s.beta) > roulette);  // for the same number
    return s.k == 1 && !played ? real(percent) / 100 : 1;
}
template <int percent>
real over(const Segment& s) {
    return std::min(real(1), max_of(s.beta) / (real(percent) / 100));
}

struct Way {
    const char* name;
    GoOn go_on;              // nullptr: whole paths
    real ends = 0;           // Russian roulette of those, and of the rest after the first vertex
    bool scattered = false;  // as often as the scene says, not without end
};
inline constexpr Way ways[] = {{"whole paths, `--roulette 0.25`", nullptr, roulette, true},
                               {"whole paths, `--roulette 0`", nullptr, 0, true},
                               {"whole paths, `--roulette 1`", nullptr, 1, true},
                               {"map", never},
                               {"first vertex, q = 0.3", at_first<30>, roulette, true},
                               {"first vertex, q = 0.5", at_first<50>, roulette, true},
                               {"first vertex, q = 0.7", at_first<70>, roulette, true},
                               {"every vertex, q = 0.5", always<50>},
                               {"every vertex, q = 0.7", always<70>},
                               {"every vertex, q = throughput / 2", over<200>},
                               {"every vertex, q = throughput", over<100>},
                               {"**every vertex, q = throughput / (2/3)**", by_throughput},
                               {"every vertex, q = throughput / 0.4", over<40>},
                               {"every vertex, q = throughput / 0.25", over<25>}};
inline constexpr size_t whole = 0, map = 3, control = 11;

// ---- Measurement --------------------------------------------------------------------------------

// Of one sample: the mean of its variance over pixels and channels, core seconds.
struct Level {
    double variance = 0, seconds = 0;
    double product() const { return variance * seconds; }
};

struct Levels {
    std::vector<std::array<Level, std::size(ways)>> rounds;  // interleaved

    // f(levels) of every round.
    template <class F>
    std::vector<double> of(F f) const {
        std::vector<double> x;
        for (const auto& levels : rounds) x.push_back(f(levels));
        return x;
    }
    std::vector<double> ratio(size_t way, double Level::*x) const {
        return of([=](const auto& l) { return l[way].*x / l[whole].*x; });
    }
    std::vector<double> efficiency(size_t way) const {
        return of([way](const auto& l) { return l[whole].product() / l[way].product(); });
    }
    // Two levels, the map and what whole paths add to it: with as many samples of each as is best,
    // variance times cost is (sqrt(v1 c1) + sqrt(v2 c2))^2.
    std::vector<double> bound() const {
        return of([](const auto& l) {
            const double v2 = std::max(0.0, l[whole].variance - l[map].variance),
                         c2 = l[whole].seconds - l[map].seconds;
            const double sum = std::sqrt(l[map].product()) + std::sqrt(v2 * c2);
            return l[whole].product() / (sum * sum);
        });
    }
};

struct Setup {
    Room room;
    KnownLight known;
};

inline Setup setup(const std::string& scene, uint64_t particles) {
    const Scene read = read_scene("scenes/" + scene + ".scene").scene;
    Room room = illumination::room(scene, double(diagonal(read)) / 16);
    Particles p(room.scene, room.mesh, Particles::pattern(SamplerKind::halton, 1, particles));
    for (size_t b = 0; b < Particles::batches; ++b) p.add(b, Particles::of_each(particles));
    KnownLight known = known_light(room.scene, room.mesh, p.map());
    return {std::move(room), std::move(known)};
}

// One way to the mean of n samples of a pixel.
class Sampled {
public:
    Sampled(const Setup& setup, const Way& way)
        : way_(way), known_(setup.known), scene_(setup.room.scene) {
        if (!way.scattered) scene_.depth = std::numeric_limits<int>::max();
    }
    Size size() const { return scene_.size; }
    Technique technique() const { return {Direction::bsdf, LightMode::mis, way_.ends}; }

    rgb operator()(const Pattern& pattern, const Pattern& rest, int x, int y, uint64_t n) const {
        const Gather g{scene_, technique(), known_, way_.go_on};
        const uint64_t pixel = uint64_t(y) * uint64_t(scene_.size.width) + uint64_t(x);
        rgb sum;
        for (uint64_t i = 0; i < n; ++i) {
            const Start at = start(scene_, pattern, {x, y, i});
            sum += way_.go_on ? Li(g, at.ray, {at.sampler, Sampler(rest, pixel, i)})
                              : Li(scene_, technique(), at.ray, at.sampler);
        }
        return sum / real(n);
    }

private:
    const Way& way_;
    const KnownLight& known_;
    Scene scene_;
};

// Every sixth pixel of every sixth row, by means of n samples, 1 or 16, and their spread.
inline Level measure(const Setup& setup, const Way& way, SamplerKind kind, uint64_t round) {
    const Sampled sampled(setup, way);
    const bool independent = kind == SamplerKind::independent;
    const uint64_t n = independent ? 1 : 16, means = independent ? 16 : 3;
    Level level;
    double samples = 0, pixels = 0;
    std::vector<Pattern> patterns, rest;
    for (uint64_t k = 0; k < means; ++k) {
        patterns.push_back(make_pattern(kind, hash(round, k), setup.room.scene.depth, n));
        rest.push_back(EndlessNumbers::independent(hash(round, k)));
    }
    const double begin = processor_seconds();
    for (int y = 2; y < sampled.size().height; y += 6)
        for (int x = 2; x < sampled.size().width; x += 6, ++pixels) {
            Moments m[3];
            for (uint64_t k = 0; k < means; ++k) {
                const rgb L = sampled(patterns[k], rest[k], x, y, n);
                for (size_t c = 0; c < 3; ++c) m[c].add(double(L.*axis[c]));
                samples += double(n);
            }
            for (const Moments& channel : m) level.variance += channel.variance() / 3 * double(n);
        }
    level.seconds = (processor_seconds() - begin) / samples;
    level.variance /= pixels;
    return level;
}

inline Levels levels_of(const Setup& s, SamplerKind kind, int rounds) {
    Levels levels;
    for (int r = 0; r < rounds; ++r) {
        levels.rounds.emplace_back();
        for (size_t w = 0; w < std::size(ways); ++w)
            levels.rounds.back()[w] = measure(s, ways[w], kind, uint64_t(r));
    }
    return levels;
}

}  // namespace indirect
