// whole/merge_refusals_test.cpp  what is not put together: gaps, overlaps, strangers
#include "base/rng.h"
#include "oracle/expect.h"
#include "whole/kept.h"
#include "whole/process.h"

namespace {

// Parts of a picture of 7 rows and 20 samples.
struct Parts : Folder {
    Parts() { write("file.scene", diffuse); }
    void part(const std::string& film, const std::string& options) const {
        expect_success(*this, "penumbra",
                       split("--checkpoint " + film + " --size 8x7 " + options + " file.scene"));
    }
    void expect_refused(const std::string& films, const std::string& why) const {
        expect_refusal(*this, "merge", split("-o y.pfm -o y.png --stats y.json " + films), why);
    }
};

}  // namespace

TEST_CASE("rows that are missing, or there twice, are told") {
    const Parts folder;
    for (const char* range : {"0-2", "3-3", "4-6", "2-4", "0-6"})
        folder.part(std::string(range) + ".film", "--spp 20 --rows " + std::string(range));
    folder.expect_refused("4-6.film 3-3.film", "rows 0-2 are missing\n");
    folder.expect_refused("4-6.film 0-2.film", "rows 3-3 are missing\n");
    folder.expect_refused("3-3.film 0-2.film", "rows 4-6 are missing\n");
    folder.expect_refused("0-2.film 2-4.film 4-6.film",
                          "2-4.film: has rows 2-2, as 0-2.film has\n");
    folder.expect_refused("0-2.film 3-3.film 2-4.film 4-6.film",
                          "2-4.film: has rows 2-2, as 0-2.film has\n");
    folder.expect_refused("0-6.film 3-3.film", "3-3.film: has rows 3-3, as 0-6.film has\n");
    folder.expect_refused("3-3.film 0-2.film 4-6.film ./3-3.film",
                          "./3-3.film: has rows 3-3: samples 0-19, as 3-3.film has\n");
    folder.expect_refused("0-2.film no.film 4-6.film", "no.film: cannot open: No such file");
    folder.expect_refused("", "no parts given (try --help)\n");
}

TEST_CASE("samples that are missing, or there twice, are told") {
    const Parts folder;
    for (const char* range : {"0-4", "5-9", "5-7", "10-19", "8-19", "0-19"})
        folder.part(std::string(range) + ".film", "--spp 20 --samples " + std::string(range));
    folder.expect_refused("0-4.film 10-19.film", "rows 0-6: samples 5-9 are missing\n");
    folder.expect_refused("5-9.film 10-19.film", "rows 0-6: samples 0-4 are missing\n");
    folder.expect_refused("5-9.film 0-4.film", "rows 0-6: samples 10-19 are missing\n");
    folder.expect_refused("5-9.film 0-4.film 8-19.film",
                          "8-19.film: has rows 0-6: samples 8-9, as 5-9.film has\n");
    folder.expect_refused("0-19.film 8-19.film",
                          "8-19.film: has rows 0-6: samples 8-19, as 0-19.film has\n");
    expect_success(folder, "merge", split("-o y.pfm 8-19.film 0-4.film 5-7.film"));
}

TEST_CASE("a part of another picture is told by what differs") {
    const Parts folder;
    folder.part("a.film", "--spp 20 --rows 0-2");
    folder.part("b.film", "--spp 20 --rows 3-6");
    const std::pair<const char*, const char*> rows[] = {
        {"--spp 20 --seed 1", "its seed is 1, not 0 as in a.film\n"},
        {"--spp 20 --sampler halton", "its sampler is halton, not sobol as in a.film\n"},
        {"--spp 20 --sets 2", "its sets is 2, not noise as in a.film\n"},
        {"--spp 20 --depth 2", "its depth is 2, not 8 as in a.film\n"},
        {"--spp 20 --size 8x8", "its size is 8x8, not 8x7 as in a.film\n"},
        {"--spp 21", "is of 21 samples, not of 20 as a.film\n"}};
    for (const auto& [options, why] : rows) {
        folder.part("c.film", std::string(options) + " --rows 3-6");
        folder.expect_refused("a.film c.film", "c.film: " + std::string(why));
    }
    folder.part("a.film", "--spp 20 --sampler stratified --rows 0-2");
    folder.part("c.film", "--spp 40 --sampler stratified --rows 3-6");
    folder.expect_refused("a.film c.film", "c.film: its grid is 8x5, not 5x4 as in a.film (as --s");
    folder.part("a.film", "--spp 20 --rows 0-2");
    folder.write("file.scene", diffuse + "\n");
    folder.part("c.film", "--spp 20 --rows 3-6");
    folder.expect_refused("a.film c.film", "c.film: its scene is another one\n");
    folder.expect_refused("c.film a.film", "a.film: its scene is another one\n");
    expect_success(folder, "merge", split("-o y.pfm a.film b.film"));
}

TEST_CASE("a part that is damaged, cut short, of another precision, or no film") {
    const Parts folder;
    folder.part("a.film", "--spp 20 --rows 0-2");
    folder.part("b.film", "--spp 20 --rows 3-6");
    const std::string film = folder.read("b.film");
    for (size_t at = 3; at < film.size(); at += film.size() / 17) {
        std::string damaged = film;
        damaged[at] = char(damaged[at] ^ 32);
        folder.write("c.film", damaged);
        folder.expect_refused("a.film c.film", "c.film: ");
    }
    folder.write("c.film", film.substr(0, film.size() - 8));
    folder.expect_refused("a.film c.film", "c.film: is cut short\n");
    folder.write("c.film", "");
    folder.expect_refused("c.film a.film", "c.film: ");
    folder.expect_refused("file.scene a.film", "file.scene: no film\n");
    FilmReader file(folder / "b.film");
    FilmHeader header = file.header();
    const bool is_float = header.find("precision") == "float";
    header.set("precision", is_float ? "double" : "float");
    FilmWriter other(folder / "c.film", header);
    other.append(file.read<char>(file.left()));
    other.commit();
    folder.expect_refused("c.film", is_float ? "c.film: its precision is double, not float\n"
                                             : "c.film: its precision is float, not double\n");
}

TEST_CASE("a head that no run writes is no part") {
    const Parts folder;
    folder.part("a.film", "--spp 20");
    const std::tuple<const char*, const char*, const char*> rows[] = {
        {"size", "8", "'8' is not WIDTHxHEIGHT"},
        {"rows", "0-7", "'7' is not a whole number from 0 to 6"},
        {"samples", "0-3", "does not say its spp"},
        {"taken", "0", "has no samples"},
        {"complete", "no", "is not complete, with 20 samples: go on by --resume c.film"},
        {"sampler", "sobel", "--sampler: "},
        {"view", "variance ", "--view: "},
        {"seconds", "long", "seconds: 'long' is not a number"},
        {"rays", "-1", "rays: '-1' is not a whole number"}};
    for (const auto& [key, value, why] : rows) {
        FilmReader file(folder / "a.film");
        FilmHeader header = file.header();
        header.set(key, value);
        FilmWriter other(folder / "c.film", header);
        other.append(file.read<char>(file.left()));
        other.commit();
        folder.expect_refused("c.film", "c.film: " + std::string(why));
    }
}

TEST_CASE("a merge writes over none of its parts; the same name twice is one file") {
    const Parts folder;
    folder.part("a.film", "--spp 20 -o a.pfm");
    fs::create_symlink("a.film", folder / "link.pfm");
    expect_refusal(folder, "merge", split("-o y.pfm --stats a.film a.film"),
                   "a.film: cannot be both a part of the picture and the statistics\n");
    expect_refusal(folder, "merge", split("-o link.pfm a.film"),
                   "link.pfm: cannot be both a part of the picture and a .pfm image\n");
    expect_refusal(folder, "merge", split("-o y.pfm --stats y.pfm a.film"),
                   "y.pfm: cannot be both a .pfm image and the statistics\n");
    expect_success(folder, "merge", split("-o y.pfm -o ./y.pfm -o y.pfm a.film"));
    CHECK(folder.same("a.pfm", "y.pfm"));
    // Without -o they are named after the scene, as a render's are.
    const Outcome o = expect_success(folder, "merge", split("a.film"));
    CHECK(folder.same("a.pfm", "out/file.pfm"));
    CHECK(contains(o.err, "wrote out/file.png, out/file.pfm\n"));
}

TEST_CASE("merging stops at Ctrl-C, and leaves no file") {
    const Parts folder;
    folder.part("a.film", "--size 1024x1024 --spp 1 --depth 0 -o z.pfm");
    fs::remove(folder / "z.pfm");
    const auto before = folder.all();
    const auto start = std::chrono::steady_clock::now();
    expect_success(folder, "merge", split("-o y.pfm a.film"));
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fs::remove(folder / "y.pfm");
    // A signal may come before anyone listens, or after the last row.
    bool heard = false;
    for (uint64_t k = 0; k < 100 && !heard; ++k) {
        Process process(folder, "merge", split("-o y.pfm a.film"));
        process.listen(took * double(to_unit(mix(seed_here() + k))),
                       [](const Outcome&) { return false; });
        process.interrupt(SIGTERM);
        const Outcome o = process.finish();
        heard = o.status == 143;
        if (o.status == 0) fs::remove(folder / "y.pfm");
        if (o.signal != SIGTERM) {
            const bool untouched = folder.all() == before;
            CHECK(untouched);
        }
    }
    CHECK(heard);
}
