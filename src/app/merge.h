// app/merge.h  9  parts of a picture put together: what fits, and what becomes of it
#pragma once
#include "app/checkpoints.h"
#include "app/option_checks.h"

// ---- What there is ------------------------------------------------------------------------------

// A .film file that a run has left.
struct PartFile {
    std::string path;
    FilmHeader header;
    Size picture;
    Range rows, samples;
    uint64_t spp = 0;   // of the picture
    RunStats run = {};  // what it took

    Size size() const { return {picture.width, int(rows.count())}; }
};

// Throws UserError unless it is whole and complete.
inline PartFile part_file(const std::string& path) {
    FilmReader file(path);
    file.check();
    const FilmHeader& h = file.header();
    PartFile part{path, h, {}, {}, {}};
    try {
        part.picture = option::size(h.find("size").value_or(""));
        part.rows = option::range(h.find("rows").value_or(""), uint64_t(part.picture.height) - 1);
        const std::string samples = h.find("samples").value_or("");
        const uint64_t taken = count_in(h, "taken", path);
        if (h.find("complete") != "yes")
            throw UserError("is not complete, with " + std::to_string(taken) +
                            " samples: go on by --resume " + path);
        part.spp = samples == "all" ? taken : count_in(h, "spp", path);
        if (part.spp == 0) throw UserError("has no samples");
        part.samples =
            samples == "all" ? Range{0, taken - 1} : option::range(samples, part.spp - 1);
        if (part.samples.count() != taken) throw UserError("has other samples than it says");
        if (h.find("precision") != precision)
            throw UserError("its precision is " + h.find("precision").value_or("not known") +
                            ", not " + precision);
    } catch (const UserError& e) {
        throw UserError(std::string(e.what()).starts_with(path) ? e.what()
                                                                : path + ": " + e.what());
    }
    part.run = run_in(h, path);
    return part;
}

// Of which picture they are: their heads, but for what differs from part to part.
inline FilmHeader picture_of_part(const PartFile& part) {
    FilmHeader h;
    for (const auto& [key, value] : part.header.entries) {
        if (key == "rows") break;  // and all that follows
        h.set(key, value);
    }
    h.set("pixels", part.header.find("pixels").value_or(""));
    return h;
}

// ---- Whether they fit ---------------------------------------------------------------------------

// Throws UserError unless ranges, in order, make up 0 ... n-1: of(k) is one, whose file is path(k).
template <class Of, class Path>
void check_cover(const std::string& what, size_t count, uint64_t n, Of of, Path path) {
    auto numbers = [&](uint64_t from, uint64_t end) {
        return what + " " + as_text({from, end - 1});
    };
    uint64_t next = 0;
    for (size_t k = 0; k < count; ++k) {
        const Range r = of(k);
        if (r.first > next) throw UserError(numbers(next, r.first) + " are missing");
        if (r.first < next)
            throw UserError(path(k) + ": has " + numbers(r.first, std::min(next, r.last + 1)) +
                            ", as " + path(k - 1) + " has");
        next = r.last + 1;
    }
    if (next < n) throw UserError(numbers(next, n) + " are missing");
    if (next > n)
        throw UserError(path(count - 1) + ": has " + numbers(n, next) + ", of " +
                        std::to_string(n));
}

// Parts of the same rows, in the order of their samples.
using Band = std::vector<PartFile>;

// All bands, from the top.  Throws UserError by the name of the first part that does not belong to
// the picture of the others, or of what is missing.
inline std::vector<Band> bands_of(const std::vector<std::string>& paths) {
    std::vector<PartFile> parts;
    for (const std::string& path : paths) parts.push_back(part_file(path));
    const PartFile& first = parts.front();
    for (const PartFile& p : parts) {
        check_identity(p.path, p.header, picture_of_part(first), " as in " + first.path);
        if (p.spp != first.spp)
            throw UserError(p.path + ": is of " + std::to_string(p.spp) + " samples, not of " +
                            std::to_string(first.spp) + " as " + first.path);
    }
    std::stable_sort(parts.begin(), parts.end(), [](const PartFile& a, const PartFile& b) {
        return std::tuple(a.rows.first, a.rows.last, a.samples.first) <
               std::tuple(b.rows.first, b.rows.last, b.samples.first);
    });
    std::vector<Band> bands;
    for (PartFile& p : parts) {
        const bool same = !bands.empty() && bands.back().back().rows.first == p.rows.first &&
                          bands.back().back().rows.last == p.rows.last;
        if (!same) bands.emplace_back();
        bands.back().push_back(std::move(p));
    }
    const PartFile& any = bands.front().front();
    check_cover(
        "rows", bands.size(), uint64_t(any.picture.height),
        [&](size_t k) { return bands[k].front().rows; },
        [&](size_t k) { return bands[k].front().path; });
    for (const Band& band : bands)
        check_cover(
            "rows " + as_text(band.front().rows) + ": samples", band.size(), any.spp,
            [&](size_t k) { return band[k].samples; }, [&](size_t k) { return band[k].path; });
    return bands;
}

// ---- Putting together ---------------------------------------------------------------------------

// The film of a band: sums over all of its samples.
template <class Pixel>
FilmState<Pixel> film_of(const Band& band) {
    FilmState<Pixel> all;
    for (const PartFile& part : band) {
        FilmReader file(part.path);
        FilmState<Pixel> s = read_film<Pixel>(file, part.path, part.size());
        if (&part == &band.front()) {
            all = std::move(s);
            continue;
        }
        auto same = [](const Sets& a, const Sets& b) {
            return a.shown == b.shown && a.chance == b.chance;
        };
        if (!std::equal(s.sets.begin(), s.sets.end(), all.sets.begin(), all.sets.end(), same))
            throw UserError(part.path + ": its pixels have other sets than those of " +
                            band.front().path);
        for (size_t i = 0; i < all.first.size(); ++i) all.first[i].add(s.first[i]);
        for (size_t i = 0; i < all.others.size(); ++i) all.others[i].add(s.others[i]);
        all.samples += s.samples;
    }
    return all;
}

// What merging finds out, beside the pictures.
struct Merged {
    ErrorTerms terms;
    double sets = 1;  // of samples, a pixel in the mean
};

// Calls row(y, pixels of that row) from the top; one band is in memory at a time.  Sums are taken
// in the order in which a film of the whole picture takes them: blocks, and pixels in these.
template <class Pixel, class Row>
Merged merge(const std::vector<Band>& bands, const typename Pixel::Value& value, Shows shows,
             Row row) {
    const PartFile& any = bands.front().front();
    const size_t width = size_t(any.picture.width);
    const Blocks blocks{width * size_t(any.picture.height)};
    Merged merged;
    ErrorTerms block;
    size_t i = 0, others_seen = 0;
    for (const Band& band : bands) {
        const FilmState<Pixel> film = film_of<Pixel>(band);
        const Pixel* others = film.others.data();
        std::vector<std::array<float, 3>> pixels(width);
        for (size_t k = 0; k < film.first.size(); ++k, ++i) {
            const SetsOfPixel<Pixel> pixel{film.sets.empty() ? Sets{} : film.sets[k],
                                           &film.first[k], others};
            others += pixel.sets.count() - 1;
            block += terms_of(pixel, value, any.spp);
            if ((i + 1) % blocks.size() == 0) merged.terms += std::exchange(block, {});
            pixels[k % width] = picture_of(pixel, value, any.spp, shows);
            if ((k + 1) % width == 0) row(int(i / width), pixels);
        }
        others_seen += film.others.size();
    }
    merged.terms += block;
    merged.sets = 1 + double(others_seen) / double(blocks.pixels);
    return merged;
}
