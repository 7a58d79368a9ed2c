// whole/parts_test.cpp  bands and ranges of samples, rendered one by one, make up the picture
#include <cmath>

#include "oracle/expect.h"
#include "whole/kept.h"
#include "whole/process.h"

namespace {

struct Row {
    const char* options;
    bool diffuse = false;  // the scene
};

struct Scenes : Folder {
    Scenes() {
        write("unequal.scene", unequal);
        write("diffuse.scene", diffuse);
    }
};

const Row rows[] = {{"--spp 37"},
                    {"--spp 37 --sampler independent"},
                    {"--spp 40 --sampler stratified"},
                    {"--spp 37 --sampler halton"},
                    {"--spp 37 --sampler halton-naive"},
                    {"--spp 37 --sets 1"},
                    {"--spp 37 --sets 3"},
                    {"--spp 11"},
                    {"--spp 2"},
                    {"--spp 1"},
                    {"--spp 37 --view variance"},
                    {"--spp 37 --view normal"},
                    {"--spp 37 --light nee --direct control"},
                    {"--spp 37 --light nee --direct ratio"},
                    {"--spp 37 --light nee --direct regression --sets 2"},
                    {"--spp 37 --sampler independent --film vor --sets 1"},
                    {"--spp 37 --sampler independent --film cvor --sets 2"},
                    {"--spp 37 --sampler independent --film torus --sets 2"},
                    {"--spp 37 --indirect map", true},
                    {"--spp 37 --indirect control --particles 3000", true},
                    {"--spp 37 --indirect regression", true}};

Words words_of(const Row& row) {
    return split(row.options) +
           Words{"--size", "12x7", row.diffuse ? "diffuse.scene" : "unequal.scene"};
}

// Renders parts, by a line of options each, and puts them together.
void merge_parts(const Folder& folder, const Words& words, const Words& parts,
                 const std::string& name) {
    Words films;
    for (size_t k = 0; k < parts.size(); ++k) {
        films.push_back("part" + std::to_string(k) + ".film");
        expect_success(folder, "penumbra",
                       split(parts[k] + " --checkpoint " + films.back()) + words);
    }
    std::rotate(films.begin(), films.begin() + ptrdiff_t(films.size() / 2), films.end());
    expect_success(folder, "merge", outputs(name) + Words{"-o", name + ".png"} + films);
    for (const std::string& film : films) fs::remove(folder / film);
}

double number(const Folder& folder, const std::string& name, const std::string& key) {
    const std::string text = stated(folder.read(name + ".json"), key);
    return contains(text, "null") ? NAN : std::stod(text.substr(text.find_first_not_of('[')));
}

// That two pictures and what is said of them are one but for rounding; of `unit`, that of sums.
void expect_close(const Folder& folder, double unit) {
    const Image a = read_pfm(folder / "whole.pfm"), b = read_pfm(folder / "parts.pfm");
    REQUIRE(a.pixels.size() == b.pixels.size());
    double worst = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double x = double(a.pixels[i][c]), y = double(b.pixels[i][c]);
            worst = std::max(worst, std::abs(x - y) / std::max(1e-30, std::abs(x)));
        }
    CHECK(worst <= double(std::numeric_limits<float>::epsilon()));  // one step of the file
    for (const char* key : {"samples_per_pixel", "sets_per_pixel", "stopped_by"}) {
        INFO(std::string(key));
        CHECK(stated(folder.read("whole.json"), key) == stated(folder.read("parts.json"), key));
    }
    for (const char* key : {"mean_radiance", "variance_of_mean", "d_rel", "d_rel_standard_error"}) {
        INFO(std::string(key));
        const double x = number(folder, "whole", key), y = number(folder, "parts", key);
        CHECK(std::isnan(x) == std::isnan(y));
        if (!std::isnan(x)) CHECK(std::abs(x - y) <= unit * std::abs(x));
    }
}

}  // namespace

TEST_CASE("bands make up the picture, bit by bit, and all that is said of it") {
    const Scenes folder;
    for (const Row& row : rows) {
        INFO(std::string(row.options));
        const Words words = words_of(row);
        expect_success(folder, "penumbra", outputs("whole") + Words{"-o", "whole.png"} + words);
        if (!contains(row.options, "--film") || contains(row.options, "--sets")) {
            merge_parts(folder, words, {"--rows 0-0", "--rows 1-4 --threads 1", "--rows 5-6"},
                        "parts");
            expect_same_run(folder, "whole", "parts");
            CHECK(folder.same("whole.png", "parts.png"));
        }
        if (row.diffuse)
            for (const char* key :
                 {"map_mesh", "map_triangles", "map_particles", "map_error", "map_slope", "depth"})
                CHECK(stated(folder.read("whole.json"), key) ==
                      stated(folder.read("parts.json"), key));
        merge_parts(folder, words, {""}, "one");
        expect_same_run(folder, "whole", "one");
        CHECK(folder.same("whole.png", "one.png"));
    }
}

TEST_CASE("ranges of samples make up the picture but for rounding, and its error, as one run") {
    const Scenes folder;
    for (const Row& row : rows) {
        if (contains(row.options, "--film") || contains(row.options, "--spp 1 ") ||
            contains(row.options, "--spp 2") || std::string(row.options) == "--spp 1")
            continue;
        INFO(std::string(row.options));
        const Words words = words_of(row);
        expect_success(folder, "penumbra", outputs("whole") + words);
        const std::string last = contains(row.options, "--spp 40")   ? "39"
                                 : contains(row.options, "--spp 11") ? "10"
                                                                     : "36";
        merge_parts(folder, words, {"--samples 9-" + last, "--samples 0-4", "--samples 5-8"},
                    "parts");
        // Sums of 37 terms, differences of which the variances are.
        expect_close(folder, contains(row.options, "regression") ? 1e-9 : 1e-11);
        if (last != "36") continue;
        // The first part chooses the sets by its own samples, the others by those.
        merge_parts(folder, words, {"--samples 0-20", "--samples 21-36"}, "parts");
        expect_close(folder, contains(row.options, "regression") ? 1e-9 : 1e-11);
    }
}

TEST_CASE("a grid of parts: bands of ranges of samples, each its own") {
    const Scenes folder;
    const Words words = split("--spp 37 --size 12x7 unequal.scene");
    expect_success(folder, "penumbra", outputs("whole") + words);
    merge_parts(
        folder, words,
        {"--rows 0-2 --samples 0-11", "--rows 0-2 --samples 12-36", "--rows 3-3",
         "--rows 4-6 --samples 20-36", "--rows 4-6 --samples 0-0", "--rows 4-6 --samples 1-19"},
        "parts");
    expect_close(folder, 1e-11);
}

TEST_CASE("a picture of which a survey alone is seen: bands choose the same sets") {
    const Scenes folder;
    const Words words = split("--spp 17 --size 300x120 unequal.scene");
    expect_success(folder, "penumbra", outputs("whole") + words + Words{"-o", "whole.png"});
    merge_parts(folder, words, {"--rows 0-60", "--rows 61-61", "--rows 62-119"}, "parts");
    expect_same_run(folder, "whole", "parts");
}

TEST_CASE("a part that is interrupted, or given more samples, goes on, and is merged") {
    const Scenes folder;
    const Words words = split("--size 12x7 unequal.scene");
    expect_success(folder, "penumbra", split("--spp 37") + outputs("whole") + words);
    expect_success(folder, "penumbra", split("--spp 20 --rows 0-3 --checkpoint a.film") + words);
    expect_success(folder, "penumbra",
                   split("--spp 37 --rows 0-3 --resume a.film --checkpoint a.film") + words);
    expect_success(folder, "penumbra", split("--spp 37 --rows 4-6 --checkpoint b.film") + words);
    expect_success(folder, "merge", outputs("parts") + split("a.film b.film"));
    expect_same_run(folder, "whole", "parts");

    // A whole picture, cut short in mid-pass, is a part as well.
    Process process(folder, "penumbra",
                    split("--spp 1000000000 --checkpoint c.film -o c.pfm") + words);
    process.listen(0.4, [](const Outcome&) { return false; });
    process.interrupt();
    CHECK(process.finish().status == 130);
    const std::string taken = in_head(folder, "c.film", "taken");
    expect_refusal(
        folder, "merge", split("-o x.pfm c.film"),
        "c.film: is not complete, with " + taken + " samples: go on by --resume c.film\n");
}

TEST_CASE("a band alone: its image is that part of the picture, and its statistics are its own") {
    const Scenes folder;
    const Words words = split("--spp 20 --size 12x7 unequal.scene");
    expect_success(folder, "penumbra", outputs("whole") + words);
    expect_success(folder, "penumbra", split("--rows 2-4") + outputs("band") + words);
    const Image whole = read_pfm(folder / "whole.pfm"), band = read_pfm(folder / "band.pfm");
    CHECK(band.height == 3);
    const bool same = std::equal(band.pixels.begin(), band.pixels.end(),
                                 whole.pixels.begin() + ptrdiff_t(2 * whole.width));
    CHECK(same);
    CHECK(stated(folder.read("band.json"), "rows") == "\"2-4\",");
    const double d_rel = number(folder, "band", "d_rel");
    double norm = 0;
    for (const auto& pixel : band.pixels)
        for (float channel : pixel) norm += double(channel) * double(channel);
    // d_rel^2 |f|^2 is the mean over channels of n times the variance of their mean.
    const std::string of_mean = stated(folder.read("band.json"), "variance_of_mean");
    double sum = 0;
    std::istringstream in(of_mean.substr(1));
    for (double v = 0; in >> v; in.ignore(1)) sum += v;
    CHECK(sum / 3 * 36 == doctest::Approx(d_rel * d_rel * norm / 3 / 36).epsilon(1e-5));
}

TEST_CASE("memory of merging: a band at a time") {
    const Scenes folder;
    folder.write("dark.scene",
                 "size 2048 1024\n" + camera + "diffuse m .5 .5 .5\nsphere 0 0 90 1 m\n");
    Words films;
    for (int k = 0; k < 8; ++k) {
        films.push_back(std::to_string(k) + ".film");
        const std::string from = std::to_string(128 * k), to = std::to_string(128 * k + 127);
        expect_success(folder, "penumbra",
                       split("--spp 1 --depth 0 --rows " + from + "-" + to + " --checkpoint " +
                             films.back() + " dark.scene"));
    }
    expect_success(folder, "merge", outputs("all") + films);
    const double pixels = 2048.0 * 1024, memory = number(folder, "all", "peak_memory_bytes");
    const double each = memory / pixels;
    INFO(each, " bytes a pixel");
    // A band has 32 bytes for each of an eighth of the pixels; the programs themselves, 8 MB.
    CHECK(memory < pixels * 32 / 8 * 1.5 + 8e6);
}
