// keep/read_film.h  2  films come back from files
#pragma once
#include "film/weights.h"
#include "keep/film_file.h"
#include "text/program.h"

namespace penumbra {

inline Spent spent_in(const FilmReader& file) {
    return {file.number("seconds"), file.number("cpu-seconds"), uint64_t(file.number("rays"))};
}

// Reads a film but its sums, which come last in the file; throws UserError if it holds no possible
// film of this size.
inline Film film_but_sums(FilmReader& file, Size size) {
    Film f{size, 0, uint32_t(file.number("replications-per-pixel", max_replications))};
    const uint64_t n = f.pixels(), bytes_of_sums = n * f.replications * sizeof(Sum);
    if (bytes_of_sums == 0 || file.left() < bytes_of_sums) file.refuse("is too short for its size");
    f.is_pilot = file.said("weights-chosen") == "no";
    f.pilot = uint64_t(file.number("pilot", f.is_pilot ? 0 : double(pilot_samples)));
    f.taken.resize(f.blocks()), f.weight.resize(n), f.deviation.resize(f.is_pilot ? n : 0);
    f.near.resize(size_t(file.number("light-groups", 1 << 10)));
    file.read(std::as_writable_bytes(std::span(f.taken)));
    file.read(std::as_writable_bytes(std::span(f.weight)));
    file.read(std::as_writable_bytes(std::span(f.deviation)));
    file.read(std::as_writable_bytes(std::span(f.near)));
    auto impossible = [most = f.is_pilot ? 1 : max_weight](uint8_t w) {
        return !std::has_single_bit(w) || w > most;
    };
    if (std::ranges::any_of(f.weight, impossible) ||
        f.max_taken() > (f.is_pilot ? pilot_samples : max_samples))
        file.refuse("has a pixel with an impossible number of samples");
    if (file.left() != bytes_of_sums) file.refuse("its replications do not match its length");
    return f;
}

// Reads a film pixel by pixel, without holding its sums in memory.
class FilmPixels {
public:
    FilmPixels(const std::string& path, Size size)
        : file_(path), film_(film_but_sums(file_, size)) {
        if (!film_.has_samples()) file_.refuse("has no samples");
        row_.resize(size_t(size.width) * film_.replications);
    }
    const Film& film() const { return film_; }  // without its sums
    // Adds the replications of the next pixel.
    void add_next(Pixel& p) {
        const size_t K = film_.replications, x = i_ % size_t(film_.size.width);
        if (x == 0) file_.read(std::as_writable_bytes(std::span(row_)));
        for (size_t k = 0; k < K; ++k) p.add(row_[x * K + k], film_.samples(i_));
        ++i_;
    }

private:
    FilmReader file_;
    Film film_;             // without its sums
    std::vector<Sum> row_;  // those of a row
    size_t i_ = 0;
};

}  // namespace penumbra
