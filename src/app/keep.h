// app/keep.h  2  films in files, if -DWITH_KEEP: with src/keep
#pragma once
#include "film/film.h"
#include "text/files.h"
#include "text/program.h"

#ifdef WITH_KEEP
#include "keep/keep.h"
#else
namespace penumbra {
struct Keeper {
    Keeper(const std::string& path, const FilmOf&) {
        if (!path.empty()) throw UserError("--keep: this program was built without src/keep");
    }
    Spent restore(Film&) const { return {}; }
    void write_now_and_then(const Film&, const Spent&) {}
    std::string write(const Film&, const Spent&, bool) { return ""; }
};
}  // namespace penumbra
#endif
