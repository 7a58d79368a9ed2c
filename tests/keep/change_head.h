// keep/change_head.h  films with edited heads
#pragma once
#include "keep/film_file.h"

namespace penumbra {

// Copies a film with the same numbers and some other facts.
inline void change_head(const std::string& from, const std::string& to, const Facts& changed) {
    FilmReader file(from);
    Facts head = file.head();
    for (const auto& [key, value] : changed)
        for (auto& [k, v] : head)
            if (k == key) v = value;
    std::vector<std::byte> numbers(file.left());
    file.read(numbers);
    write_film_file(to, head, {numbers});
}

}  // namespace penumbra

using namespace penumbra;
