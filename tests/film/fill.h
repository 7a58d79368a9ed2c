// film/fill.h  films filled as renders fill them, but by one thread
#pragma once
#include "film/film.h"

// n more samples for blocks from `first` on, up to `last`: L(x, y, i, set).
template <class Pixel, class L>
void add_blocks(Film<Pixel>& film, size_t first, size_t last, uint64_t n, L sample) {
    for (size_t b = first; b < last; ++b) film.add_block(b, n, sample);
}

// n more samples for every pixel of a film.
template <class Pixel, class L>
void whole_pass(Film<Pixel>& film, uint64_t n, L sample) {
    film.begin_pass(n);
    add_blocks(film, 0, film.blocks(), n, sample);
    film.end_pass(n);
}
