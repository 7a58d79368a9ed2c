// keep/change_head.h  films whose heads say something else
#pragma once
#include "keep/film_file.h"

// Another film of the same numbers, some of whose facts are others.
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
