// app/part.h  5  the part of a picture that one run renders: some of its rows, some of its samples
#pragma once
#include "app/indirect.h"

struct Part {
    Size picture;
    int first_row = 0, rows = 0;
    uint64_t first_sample = 0, samples = 0;  // of each set; samples 0: not known before
    uint64_t total = 0;                      // samples of the picture; 0: not known before

    Size size() const { return {picture.width, rows}; }
    Range row_range() const { return {uint64_t(first_row), uint64_t(first_row + rows - 1)}; }
};

// Throws UserError if the film of a part would not fit into so many bytes of memory.
inline void check_memory(const Part& part, double memory) {
    constexpr double bytes_of_pixel = 64;  // at most, by default
    const double bytes = bytes_of_pixel * double(part.picture.width) * double(part.rows);
    if (bytes <= memory) return;
    throw UserError(std::to_string(part.picture.width) + "x" + std::to_string(part.rows) +
                    " pixels take about " + fixed(bytes * 1e-9, 0) + " GB, and this machine has " +
                    fixed(memory * 1e-9, 0) + ": render fewer rows at a time (--rows)");
}

// Throws UserError if there is no such part.
inline Part part_of(const Options& o, const Scene& scene, uint64_t total) {
    Part part{scene.size, 0, scene.size.height, 0, total, total};
    if (o.rows) {
        if (o.rows->last >= uint64_t(scene.size.height))
            throw UserError("--rows " + as_text(*o.rows) + ": the picture has rows 0-" +
                            std::to_string(scene.size.height - 1));
        part.first_row = int(o.rows->first), part.rows = int(o.rows->count());
    }
    if (o.samples) {
        if (o.samples->last >= total)
            throw UserError("--samples " + as_text(*o.samples) + ": a pixel has samples 0-" +
                            std::to_string(total - 1));
        part.first_sample = o.samples->first, part.samples = o.samples->count();
    }
    return part;
}
