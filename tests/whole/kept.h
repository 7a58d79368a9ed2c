// whole/kept.h  renders that write .film files, and the results that two of them must share
#pragma once
#include "keep/change_head.h"
#include "path/scenes.h"
#include "whole/process.h"

// Compares image and statistics bit for bit; merged runs have fewer of these statistics.
inline void expect_same_run(const Folder& folder, const std::string& a, const std::string& b,
                            bool is_merged = false) {
    CHECK(folder.same(a + ".pfm", b + ".pfm"));
    const std::string of_a = folder.read(a + ".json"), of_b = folder.read(b + ".json");
    for (const char* key : {"samples_per_pixel", "mean_radiance", "variance_of_mean",
                            "replications_per_pixel", "d_rel", "d_rel_standard_error",
                            "d_rel_reason", "bias", "interrupted", "rays", "stopped_by"}) {
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

// A scene of unequal lights, with its checkpoints and outputs.
struct Unequal : Folder {
    std::string size;
    explicit Unequal(const std::string& s) : size(s) { write("unequal.scene", unequal); }
    Words of(const std::string& options) const {
        return split("penumbra unequal.scene " + options + " --size " + size);
    }
    double number(const std::string& name, const std::string& key) const {
        return number_of(read(name + ".json"), key);
    }
};
