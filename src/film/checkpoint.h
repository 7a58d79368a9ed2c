// film/checkpoint.h  6  films in files: to go on from, or to be merged with others
#pragma once
#include <type_traits>

#include "film/film.h"
#include "film/film_file.h"

// ---- Numbers in the head ------------------------------------------------------------------------

inline void set_count(FilmHeader& header, const std::string& key, uint64_t n) {
    header.set(key, std::to_string(n));
}

// Throws UserError, of the file, if there is no such number.
inline uint64_t count_in(const FilmHeader& header, const std::string& key,
                         const std::string& path) {
    const auto value = header.find(key);
    if (!value) throw UserError(path + ": does not say its " + key);
    try {
        return parse_count(*value, 0, UINT64_MAX);
    } catch (const UserError& e) {
        throw UserError(path + ": " + key + ": " + e.what());
    }
}

// ---- The state ----------------------------------------------------------------------------------

// Of pixels of that kind: its numbers follow the head in the order of FilmState.  The image and its
// terms are there if a pass is unfinished: else they follow from the rest.
template <class Pixel>
void write_film(const std::string& path, FilmHeader header, const FilmState<Pixel>& s) {
    static_assert(std::is_trivially_copyable_v<Pixel>);
    const bool unfinished = std::find(s.ahead.begin(), s.ahead.end(), true) != s.ahead.end();
    header.set("pixels",
               std::string(Pixel::name) + " of " + std::to_string(sizeof(Pixel)) + " bytes");
    set_count(header, "taken", s.samples);
    set_count(header, "taken-by-other-sets", s.samples_of_others);
    set_count(header, "sets-chosen-after", s.sets_after);
    set_count(header, "other-sets", s.others.size());
    header.set("sets-known", s.sets.empty() ? "no" : "yes");
    set_count(header, "unfinished-pass", unfinished ? s.pass : 0);
    header.set("unfinished", unfinished ? "yes" : "no");
    FilmWriter file(path, header);
    file.append(s.first);
    file.append(s.spread);
    file.append(s.sets);
    file.append(s.others);
    if (unfinished) {
        file.append(s.ahead);
        file.append(s.terms);
        file.append(s.image.pixels);
    }
    file.commit();
}

// Throws UserError if the file, which is whole, holds another kind of film, or none that could be.
template <class Pixel>
FilmState<Pixel> read_film(FilmReader& file, const std::string& path, Size size) {
    const FilmHeader& header = file.header();
    auto refuse = [&](const char* why) { throw UserError(path + ": " + why); };
    const size_t n = size_t(size.width) * size_t(size.height), blocks = Blocks{n}.count();
    FilmState<Pixel> s;
    if (header.find("pixels") !=
        std::string(Pixel::name) + " of " + std::to_string(sizeof(Pixel)) + " bytes")
        refuse("holds another kind of pixels");
    s.samples = count_in(header, "taken", path);
    s.samples_of_others = count_in(header, "taken-by-other-sets", path);
    s.sets_after = count_in(header, "sets-chosen-after", path);
    const uint64_t others = count_in(header, "other-sets", path);
    const bool known = header.find("sets-known") == "yes";
    const bool unfinished = header.find("unfinished") == "yes";
    s.pass = count_in(header, "unfinished-pass", path);
    s.first = file.read<Pixel>(n);
    if (!known) s.spread = file.read<double>(n);
    if (known) s.sets = file.read<Sets>(n);
    uint64_t counted = 0;
    for (const Sets& sets : s.sets) {
        if (sets.shown < 1 || sets.shown > most_sets || !(sets.chance >= 0 && sets.chance <= 1))
            refuse("has a pixel of impossible sets");
        counted += sets.count() - 1;
    }
    if (others != counted) refuse("has other sets than it says");
    s.others = file.read<Pixel>(others);
    s.ahead.resize(blocks), s.terms.resize(blocks);
    if (unfinished) {
        s.ahead = file.read<char>(blocks);
        s.terms = file.read<ErrorTerms>(blocks);
        s.image.pixels = file.read<std::array<float, 3>>(n);
    }
    if (file.left() > 0) refuse("holds more than it should");
    return s;
}
