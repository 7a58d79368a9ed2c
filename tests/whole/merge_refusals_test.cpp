// whole/merge_refusals_test.cpp  films that merge refuses: gaps, overlaps, foreign parts
#include <cmath>
#include <cstring>

#include "base/rng.h"
#include "oracle/expect.h"
#include "whole/kept.h"
#include "whole/process.h"

namespace {

// Parts of a picture of 7 rows.
struct Parts : Place {
    Parts() : Place(good) {}
    void part(const std::string& film, const std::string& options) const {
        render("--keep " + film + " --size 8x7 " + options);
    }
    void refuse(const std::string& films, const std::string& why) const {
        expect_refusal(*this, "merge -o y.pfm -o y.png --stats y.json " + films, why);
    }
};

// Two parts: rows 0-2 and 3-6.
struct TwoParts : Parts {
    TwoParts() {
        for (const std::string rows : {"0-2", "3-6"})
            part(rows + ".film", "--spp 20 --rows " + rows);
    }
};

}  // namespace

TEST_CASE("rows that are missing, or there twice, are told; so are equal seeds") {
    const Parts folder;
    for (const std::string range : {"0-2", "3-3", "4-6", "2-4", "0-6"})
        folder.part(range + ".film", "--spp 20 --rows " + range);
    folder.part("1.film", "--spp 20 --seed 1"), folder.part("2.film", "--spp 40 --seed 1");
    const std::string twice = "rows 2-4 of 2-4.film overlap rows 0-2 of 0-2.film\n",
                      seed = "rows 0-6 of seed 1 appear twice: 1.film and 2.film\n",
                      row = "rows 3-3 of 3-3.film overlap rows 0-6 of ";
    for (const auto& [films, why] :
         std::vector<Refusal>{{"4-6.film 3-3.film", "rows 0-2 are missing\n"},
                              {"4-6.film 0-2.film", "rows 3-3 are missing\n"},
                              {"3-3.film 0-2.film", "rows 4-6 are missing\n"},
                              {"0-2.film 2-4.film 4-6.film", twice},
                              {"0-2.film 3-3.film 2-4.film 4-6.film", twice},
                              {"0-6.film 3-3.film", row + "0-6.film\n"},
                              {"3-3.film 0-2.film 4-6.film ./3-3.film",
                               "rows 3-3 of seed 0 appear twice: 3-3.film and ./3-3.film\n"},
                              {"0-6.film 1.film 2.film", seed},
                              {"1.film 0-6.film 2.film", seed},
                              {"3-3.film 1.film", row},
                              {"0-2.film no.film 4-6.film", "no.film: cannot open: No such file"},
                              {"", "no parts given (try --help)\n"}})
        folder.refuse(films, why);
    expect_success(folder, "merge -o y.pfm 0-6.film 1.film");
}

TEST_CASE("a part of another picture is told by what differs") {
    const TwoParts folder;
    auto render = [&](const std::string& options) {
        fs::remove(folder / "c.film");
        folder.part("c.film", "--spp 20 --rows 3-6 " + options);
    };
    for (const auto& [options, why] :
         std::vector<Refusal>{{"--sampler halton", "sampler halton, not sobol"},
                              {"--sampler stratified", "sampler stratified, not sobol"},
                              {"--replications 2", "replications 2, not 8"},
                              {"--depth 2", "depth 2, not 8"},
                              {"--size 8x8", "size 8x8, not 8x7"}}) {
        render(options);
        folder.refuse("0-2.film c.film", "c.film: was rendered with " + why + " as in 0-2.film\n");
    }
    folder.write("file.scene", good + "\n");
    render("");
    const std::string other = ": was rendered from another version of file.scene\n";
    folder.refuse("0-2.film c.film", "c.film" + other);
    folder.refuse("c.film 0-2.film", "0-2.film" + other);
    expect_success(folder, "merge -o y.pfm 0-2.film 3-6.film");
}

TEST_CASE("a part that is damaged, cut short, of another precision, or no film") {
    const TwoParts folder;
    auto refuse = [&](const std::string& bytes, const std::string& why) {
        folder.write("c.film", bytes);
        folder.refuse("0-2.film c.film", "c.film: " + why + "\n");
    };
    std::string film = folder.read("3-6.film");
    refuse(film.substr(0, film.size() - 8), "is cut short");
    film.back() = char(film.back() ^ 32);
    refuse(film, "is damaged (its checksum differs)");
    refuse("", "is not a film");
    folder.refuse("file.scene 0-2.film", "file.scene: is not a film\n");
    const bool is_float = in_head(folder, "3-6.film", "precision") == "float";
    const std::string its = is_float ? "float" : "double", other = is_float ? "double" : "float";
    change_head(folder / "3-6.film", folder / "c.film", {{"precision", other}});
    folder.refuse("c.film", "c.film: was rendered with precision " + other + ", not " + its + "\n");
}

TEST_CASE("a head that no run writes is no part") {
    const Parts folder;
    folder.part("a.film", "--spp 20");
    auto refuse = [&](const std::string& key, const std::string& value, const std::string& why) {
        INFO(value);
        change_head(folder / "a.film", folder / "c.film", {{key, value}});
        folder.refuse("c.film", "c.film: " + why + "\n");
    };
    for (const auto& [key, value] : {std::pair{"size", "x"},
                                     {"size", "99999x1"},
                                     {"rows", "0-7"},
                                     {"rows", "5-3"},
                                     {"pilot", "soon"},
                                     {"seconds", "long"},
                                     {"rays", "-1"}})
        refuse(key, value, "invalid " + std::string(key) + " '" + value + "'");
    refuse("complete", "no", "is not complete: resume it with penumbra --keep c.film");
    refuse("size", "800x7", "is too short for its size");
    const std::string known = "unknown view ";
    refuse("view", "heat", known + "'heat'");
    refuse("view", "Normal", known + "'Normal' (did you mean 'normal'?)");
    refuse("view", "", known + "''");
    // A size that the film does not have is told before its rows are looked at, and before there
    // is a picture, which may be larger than memory.
    change_head(folder / "a.film", folder / "d.film", {{"rows", "0-3"}});
    change_head(folder / "d.film", folder / "c.film", {{"size", "65536x65536"}});
    folder.refuse("c.film", "c.film: is too short for its size\n");
}

TEST_CASE("a merge writes over none of its parts, and no file twice") {
    const Parts folder;
    folder.part("a.film", "--spp 20 -o a.pfm");
    fs::create_symlink("a.film", folder / "link.pfm");
    const std::string why = ": would replace another file of this run\n";
    expect_refusals(folder, "merge a.film",
                    {{"-o y.pfm --stats a.film", "a.film" + why},
                     {"-o link.pfm", "link.pfm" + why},
                     {"-o y.pfm --stats y.pfm", "y.pfm" + why},
                     {"-o y.pfm -o ./y.pfm", "./y.pfm" + why}});
    expect_success(folder, "merge -o y.pfm a.film");
    CHECK(folder.same("a.pfm", "y.pfm"));
    // Without -o the files have the scene's name, like those of a render.
    const Outcome o = expect_success(folder, "merge a.film");
    CHECK(folder.same("a.pfm", "out/file.pfm"));
    CHECK(contains(o.err, "wrote out/file.png, out/file.pfm\n"));
}

TEST_CASE("a pixel that no file can hold is told, and nothing is written") {
    const Parts folder;
    folder.part("a.film", "--spp 20");
    FilmReader file(folder / "a.film");
    std::vector<std::byte> numbers(file.left());
    file.read(numbers);
    const double infinite = INFINITY;  // becomes the last sum
    std::memcpy(numbers.data() + numbers.size() - sizeof infinite, &infinite, sizeof infinite);
    write_film_file(folder / "b.film", file.head(), {numbers});
    const Untouched all(folder);
    CHECK(expect_exit(folder, "merge -o y.pfm -o y.png --stats y.json b.film", 1).err ==
          "pixel 7,6 is more than a file can hold; nothing was written\n");
}

TEST_CASE("merging stops at Ctrl-C, and leaves no file") {
    const Parts folder;
    folder.part("a.film", "--size 1024x1024 --spp 1 --depth 0 -o z.pfm");
    fs::remove(folder / "z.pfm");
    const Untouched all(folder);
    const double took = seconds_of(folder, "merge -o y.pfm a.film");
    fs::remove(folder / "y.pfm");
    // A signal may precede the handler, or follow the last row.
    bool heard = false;
    for (uint64_t k = 0; k < 100 && !heard; ++k) {
        const double moment = took * double(to_unit(mix(seed_here() + k)));
        const Outcome o = cut_short(folder, "merge -o y.pfm a.film", moment, SIGTERM);
        heard = o.status == 143;
        if (o.status == 0) fs::remove(folder / "y.pfm");
    }
    CHECK(heard);
}
