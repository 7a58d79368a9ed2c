// whole/kept.h  renders that are kept in .film files, and what two of them must share
#pragma once
#include "keep/film_file.h"
#include "path/scenes.h"
#include "whole/process.h"

// Diffuse surfaces alone, for maps.
inline const std::string diffuse = good + "quad -9 -1 -9  0 0 18  18 0 0  m\n";

inline Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// What stands behind "KEY": in --stats.
inline std::string stated(const std::string& stats, const std::string& key) {
    const std::string start = "\"" + key + "\": ";
    const size_t at = stats.find(start);
    REQUIRE(at != stats.npos);
    return stats.substr(at + start.size(), stats.find('\n', at) - at - start.size());
}

// Image and statistics, bit by bit; `merge` leaves fewer of these.
inline void expect_same_run(const Folder& folder, const std::string& a, const std::string& b,
                            bool is_merged = false) {
    CHECK(folder.same(a + ".pfm", b + ".pfm"));
    const std::string of_a = folder.read(a + ".json"), of_b = folder.read(b + ".json");
    for (const char* key :
         {"samples_per_pixel", "mean_radiance", "variance_of_mean", "sets_per_pixel", "d_rel",
          "d_rel_standard_error", "d_rel_reason", "bias", "interrupted", "rays", "stopped_by"}) {
        if (is_merged && std::string(key) == "stopped_by") continue;
        INFO(std::string(key));
        CHECK(stated(of_a, key) == stated(of_b, key));
    }
}

inline Words outputs(const std::string& name) {
    return {"-o", name + ".pfm", "--stats", name + ".json"};
}

inline std::string in_head(const Folder& folder, const std::string& film, const std::string& key) {
    return FilmReader(folder / film).said(key);
}
