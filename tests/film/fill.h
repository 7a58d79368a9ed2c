// film/fill.h  films filled as renders fill them, by one thread
#pragma once
#include <cstring>

#include "film/weights.h"

namespace penumbra {

// Brings the blocks from `first` up to `last` to n samples.
inline Tally fill_blocks(Film& f, size_t first, size_t last, uint64_t n, const SampleFunction& L) {
    Tally all;
    for (size_t b = first; b < last; ++b) {
        Tally tally;
        tally.near.resize(f.near.size());
        add_samples(f, b, n, L, tally);
        all.rays += tally.rays, all.add_bad(tally.bad, tally.first_bad);
        for (size_t g = 0; g < f.near.size(); ++g) f.near[g].add(tally.near[g]);
    }
    return all;
}
inline Tally fill(Film& f, uint64_t n, const SampleFunction& L) {
    return fill_blocks(f, 0, f.blocks(), n, L);
}

// A pilot of at most n samples, and weights chosen by it.
inline void fill_pilot(Film& f, uint64_t n, const SampleFunction& L) {
    for (uint64_t end = 1; end <= std::min(n, pilot_samples); ++end) fill(f, end, L);
    choose_weights(f);
}

// A film with n samples in each of K replications; K = 0: two, with weights.
inline Film filled(Size size, uint32_t K, uint64_t n, const SampleFunction& L) {
    Film f = make_film(size, K ? K : 2, K == 0);
    if (K == 0) fill_pilot(f, n, L);
    fill(f, n, L);
    return f;
}

// A radiance from the numbers of an independent sample.
inline SampleFunction random_radiance(uint64_t seed,
                                      std::function<rgb(const PixelSample&, vec2)> value) {
    return [=](const PixelSample& s, Tally&) {
        const uint64_t pixel = hash(uint64_t(s.y), uint64_t(s.x)),
                       bits = hash(hash(hash(seed, pixel), s.replication), s.i);
        return value(s, {to_unit(bits), to_unit(mix(bits))});
    };
}

// Compares everything in two films bit for bit.
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
inline bool same(const Film& a, const Film& b) {
    return a.size.width == b.size.width && a.first_row == b.first_row &&
           a.replications == b.replications && a.is_pilot == b.is_pilot && a.pilot == b.pilot &&
           same(a.sum, b.sum) && same(a.weight, b.weight) &&
           same(a.pilot_deviation, b.pilot_deviation) && same(a.samples_done, b.samples_done) &&
           same(a.near, b.near);
}

}  // namespace penumbra

using namespace penumbra;
