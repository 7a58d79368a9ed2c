// whole/merge_refusals_test.cpp  what is not put together: gaps, overlaps, strangers
#include <cmath>
#include <cstring>

#include "base/rng.h"
#include "oracle/expect.h"
#include "whole/kept.h"
#include "whole/process.h"

namespace {

// Parts of a picture of 7 rows.
struct Parts : Folder {
    Parts() { write("file.scene", good); }
    void part(const std::string& film, const std::string& options) const {
        expect_success(*this, "penumbra",
                       split("--keep " + film + " --size 8x7 " + options + " file.scene"));
    }
    void expect_refused(const std::string& films, const std::string& why) const {
        expect_refusal(*this, "merge", split("-o y.pfm -o y.png --stats y.json " + films), why);
    }
};

void change_head(const std::string& from, const std::string& to, const std::string& key,
                 const std::string& value) {
    FilmReader file(from);
    Facts head = file.head();
    for (auto& [k, v] : head)
        if (k == key) v = value;
    std::vector<std::byte> numbers(file.left());
    file.read(numbers);
    write_film_file(to, head, {numbers});
}

}  // namespace

TEST_CASE("rows that are missing, or there twice, are told; so are equal seeds") {
    const Parts folder;
    for (const char* range : {"0-2", "3-3", "4-6", "2-4", "0-6"})
        folder.part(std::string(range) + ".film", "--spp 20 --rows " + std::string(range));
    folder.expect_refused("4-6.film 3-3.film", "rows 0-2 are missing\n");
    folder.expect_refused("4-6.film 0-2.film", "rows 3-3 are missing\n");
    folder.expect_refused("3-3.film 0-2.film", "rows 4-6 are missing\n");
    const std::string twice = "2-4.film: has rows 2-4 by seed 0, which overlap those of 0-2.film\n";
    folder.expect_refused("0-2.film 2-4.film 4-6.film", twice);
    folder.expect_refused("0-2.film 3-3.film 2-4.film 4-6.film", twice);
    folder.expect_refused("0-6.film 3-3.film",
                          "3-3.film: has rows 3-3 by seed 0, which overlap those of 0-6.film\n");
    folder.expect_refused("3-3.film 0-2.film 4-6.film ./3-3.film",
                          "./3-3.film: has rows 3-3 by seed 0, which overlap those of 3-3.film\n");
    folder.part("1.film", "--spp 20 --seed 1"), folder.part("2.film", "--spp 40 --seed 1");
    folder.expect_refused("0-6.film 1.film 2.film",
                          "2.film: has rows 0-6 by seed 1, which overlap those of 1.film\n");
    folder.expect_refused("1.film 0-6.film 2.film",
                          "2.film: has rows 0-6 by seed 1, which overlap those of 1.film\n");
    folder.expect_refused("3-3.film 1.film", "3-3.film: has rows 3-3 by seed 0, which overlap");
    folder.expect_refused("0-2.film no.film 4-6.film", "no.film: cannot open: No such file");
    folder.expect_refused("", "no parts given (try --help)\n");
    expect_success(folder, "merge", split("-o y.pfm 0-6.film 1.film"));
}

TEST_CASE("a part of another picture is told by what differs") {
    const Parts folder;
    folder.part("a.film", "--spp 20 --rows 0-2");
    folder.part("b.film", "--spp 20 --rows 3-6");
    const std::pair<const char*, const char*> rows[] = {
        {"--sampler halton", "its sampler is halton, not sobol as in a.film\n"},
        {"--sets 2", "its sets is 2, not adaptive as in a.film\n"},
        {"--depth 2", "its depth is 2, not 8 as in a.film\n"},
        {"--size 8x8", "its size is 8x8, not 8x7 as in a.film\n"},
        {"--sampler stratified", "its sampler is stratified, not sobol as in a.film\n"}};
    for (const auto& [options, why] : rows) {
        fs::remove(folder / "c.film");
        folder.part("c.film", "--spp 20 --rows 3-6 " + std::string(options));
        folder.expect_refused("a.film c.film", "c.film: " + std::string(why));
    }
    fs::remove(folder / "c.film");
    folder.write("file.scene", good + "\n");
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
    const bool is_float = in_head(folder, "b.film", "precision") == "float";
    change_head(folder / "b.film", folder / "c.film", "precision", is_float ? "double" : "float");
    folder.expect_refused("c.film", is_float ? "c.film: its precision is double, not float\n"
                                             : "c.film: its precision is float, not double\n");
}

TEST_CASE("a head that no run writes is no part") {
    const Parts folder;
    folder.part("a.film", "--spp 20");
    const std::tuple<const char*, const char*, const char*> rows[] = {
        {"size", "x", "its size is 'x'"},
        {"size", "99999x1", "its size is '99999x1'"},
        {"rows", "0-7", "its rows is '0-7'"},
        {"rows", "5-3", "its rows is '5-3'"},
        {"complete", "no", "is not complete: go on by penumbra --keep c.film"},
        {"size", "800x7", "holds less than it should"},
        {"pilot", "soon", "its pilot is 'soon'"},
        {"seconds", "long", "its seconds is 'long'"},
        {"rays", "-1", "its rays is '-1'"}};
    for (const auto& [key, value, why] : rows) {
        INFO(std::string(value));
        change_head(folder / "a.film", folder / "c.film", key, value);
        folder.expect_refused("c.film", "c.film: " + std::string(why) + "\n");
    }
}

TEST_CASE("a merge writes over none of its parts, and no file twice") {
    const Parts folder;
    folder.part("a.film", "--spp 20 -o a.pfm");
    fs::create_symlink("a.film", folder / "link.pfm");
    expect_refusal(folder, "merge", split("-o y.pfm --stats a.film a.film"),
                   "a.film: would replace another file of this run\n");
    expect_refusal(folder, "merge", split("-o link.pfm a.film"),
                   "link.pfm: would replace another file of this run\n");
    expect_refusal(folder, "merge", split("-o y.pfm --stats y.pfm a.film"),
                   "y.pfm: would replace another file of this run\n");
    expect_refusal(folder, "merge", split("-o y.pfm -o ./y.pfm a.film"),
                   "./y.pfm: would replace another file of this run\n");
    expect_success(folder, "merge", split("-o y.pfm a.film"));
    CHECK(folder.same("a.pfm", "y.pfm"));
    // Without -o they are named after the scene, as a render's are.
    const Outcome o = expect_success(folder, "merge", split("a.film"));
    CHECK(folder.same("a.pfm", "out/file.pfm"));
    CHECK(contains(o.err, "wrote out/file.png, out/file.pfm\n"));
}

TEST_CASE("a pixel that no file can hold is told, and nothing is written") {
    const Parts folder;
    folder.part("a.film", "--spp 20");
    FilmReader file(folder / "a.film");
    std::vector<std::byte> numbers(file.left());
    file.read(numbers);
    const double infinite = INFINITY;  // in the last sum
    std::memcpy(numbers.data() + numbers.size() - sizeof infinite, &infinite, sizeof infinite);
    write_film_file(folder / "b.film", file.head(), {numbers});
    const auto before = folder.all();
    const Outcome o = run(folder, "merge", split("-o y.pfm -o y.png --stats y.json b.film"));
    CHECK(o.status == 1);
    CHECK(o.err == "pixel 7,6 is more than a file can hold; nothing was written\n");
    const bool untouched = folder.all() == before;
    CHECK(untouched);
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
