// film/fill.h  films filled as renders fill them, by one thread
#pragma once
#include <cstring>

#include "film/film.h"

// Brings the blocks from `first` up to `last` to n samples.
inline NonFinite fill_blocks(Film& f, size_t first, size_t last, uint64_t n, const Radiance& L) {
    const std::vector<size_t> at = offsets(f);
    NonFinite bad;
    Tally tally;
    for (size_t b = first; b < last; ++b) bad.add(add_samples(f, b, at[b], n, L, tally));
    return bad;
}
inline NonFinite fill(Film& f, uint64_t n, const Radiance& L) {
    return fill_blocks(f, 0, f.taken.size(), n, L);
}

// A film with n samples per replication; 0 sets: adaptive.
inline Film filled(Size size, uint32_t sets, uint64_t n, const Radiance& L) {
    Film f = make_film(size, sets);
    if (sets == 0) {
        fill(f, std::min(n, pilot_samples), L);
        choose_sets(f, INFINITY);
    }
    fill(f, n, L);
    return f;
}

// A radiance from the numbers of an independent sample.
inline Radiance random_radiance(uint64_t seed, std::function<rgb(const PixelSample&, vec2)> value) {
    return [=](const PixelSample& s, Tally&) {
        const uint64_t pixel = hash(uint64_t(s.y), uint64_t(s.x)),
                       bits = hash(hash(hash(seed, pixel), s.set), s.i);
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
    return a.pilot == b.pilot && a.first_row == b.first_row && same(a.sets, b.sets) &&
           same(a.sum, b.sum) && same(a.taken, b.taken) && same(a.spread, b.spread) &&
           same(a.evidence, b.evidence);
}
