// whole/kept_refusals_test.cpp  films that are not gone on from, and names that are not written to
#include "whole/kept.h"
#include "whole/process.h"

namespace {

const std::string with_mesh = diffuse + "mesh m.obj 1 0 0 0\n";
const std::string mesh = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

struct Kept : Folder {
    Kept() {
        write("m.obj", mesh);
        write("m.mtl", "newmtl a\nKd 1 1 1\n");
        write("file.scene", with_mesh);
    }
    // Leaves a film of so many samples, and no picture.
    void keep(const std::string& film, const std::string& options) const {
        expect_success(*this, "penumbra",
                       split("--checkpoint " + film + " -o x.pfm " + options + " file.scene"));
        fs::remove(*this / "x.pfm");
    }
    void expect_refused(const std::string& options, const std::string& why) const {
        expect_refusal(*this, "penumbra", split(options + " -o y.pfm file.scene"), why);
    }
};

}  // namespace

TEST_CASE("a film of other samples is refused by what differs, and nothing is touched") {
    const Kept folder;
    folder.keep("a.film", "--spp 17");
    const std::pair<const char*, const char*> rows[] = {
        {"--size 9x4", "size is 8x4, not 9x4"},
        {"--sampler halton", "sampler is sobol, not halton"},
        {"--sets 2", "sets is noise, not 2"},
        {"--direction uniform", "direction is bsdf, not uniform"},
        {"--light nee", "light is mis, not nee"},
        {"--light nee --direct ratio", "light is mis, not nee"},
        {"--polygons angle", "polygons is area, not angle"},
        {"--indirect map --quiet", "indirect is path, not map"},
        {"--pick power", "pick is place, not power"},
        {"--depth 3", "depth is 8, not 3"},
        {"--roulette 0.5", "roulette is 0.25, not 0.5"},
        {"--seed 1", "seed is 0, not 1"},
        {"--view normal", "view is radiance, not normal"},
        {"--sampler independent --film cvor", "sampler is sobol, not independent"},
        {"--rows 0-1", "rows is 0-3, not 0-1"},
        {"--samples 0-16 --checkpoint b.film", "samples is all, not 0-16"}};
    for (const auto& [options, why] : rows)
        folder.expect_refused("--spp 20 --resume a.film " + std::string(options),
                              "a.film: its " + std::string(why));
    folder.expect_refused("--spp 16 --resume a.film",
                          "a.film: has 17 samples, more than --spp 16\n");

    folder.keep("b.film", "--spp 17 --light nee --sampler independent");
    folder.expect_refused(
        "--spp 17 --light nee --sampler independent --direct control --resume b.film",
        "b.film: its direct is stochastic, not control\n");
    folder.expect_refused("--spp 17 --light nee --sampler independent --film torus --resume b.film",
                          "b.film: its film is mc, not torus\n");
    // What samples do not depend on is another matter.
    expect_success(folder, "penumbra",
                   split("--spp 18 --resume a.film --threads 3 --exposure 2 -o z.pfm file.scene"));
}

TEST_CASE("where samples depend on how many there are, another total is refused") {
    const Kept folder;
    folder.keep("a.film", "--spp 12 --sampler stratified");
    folder.expect_refused("--spp 20 --sampler stratified --resume a.film",
                          "a.film: its grid is 4x3, not 5x4 (as --spp has it)\n");
    expect_success(folder, "penumbra",
                   split("--spp 256 --sampler stratified --checkpoint b.film -o z.pfm file.scene"));
    expect_success(folder, "penumbra",
                   split("--spp 512 --sampler stratified --resume b.film -o z.pfm file.scene"));
    folder.keep("c.film", "--spp 9 --sampler independent --film cvor");
    folder.expect_refused("--spp 10 --sampler independent --film cvor --resume c.film",
                          "c.film: its weights is 9, not 10 (as --spp has it)\n");
    folder.keep("d.film", "--spp 20 --indirect map");
    folder.expect_refused("--spp 60 --indirect map --quiet --resume d.film",
                          "d.film: its particles is 40, not 120 (as --spp has it)\n");
    folder.expect_refused("--spp 20 --indirect map --mesh 3 --quiet --resume d.film",
                          "d.film: its mesh is 1.");
    folder.keep("e.film", "--spp 8");
    folder.expect_refused("--spp 20 --resume e.film",
                          "e.film: its sets were chosen after 8 samples, not 16 as for so many: "
                          "give the same --spp\n");
    folder.expect_refused("--spp 9 --resume e.film",
                          "e.film: its sets were chosen after 8 samples, not 9 as");
}

TEST_CASE("another scene, by one byte of any of its files") {
    const Kept folder;
    folder.keep("a.film", "--spp 2");
    for (const char* name : {"file.scene", "m.obj", "m.mtl"}) {
        INFO(std::string(name));
        const std::string bytes = folder.read(name);
        folder.write(name, bytes + "\n");
        folder.expect_refused("--spp 2 --resume a.film", "a.film: its scene is another one\n");
        folder.write(name, bytes);
    }
    // The same one, elsewhere.
    for (const char* name : {"file.scene", "m.obj", "m.mtl"})
        folder.write("other/" + std::string(name), folder.read(name));
    expect_success(folder, "penumbra", split("--spp 2 --resume a.film -o z.pfm other/file.scene"));
}

TEST_CASE("another precision") {
    const Kept folder;
    folder.keep("a.film", "--spp 2");
    FilmReader file(folder / "a.film");
    FilmHeader header = file.header();
    const bool is_float = header.find("precision") == "float";
    header.set("precision", is_float ? "double" : "float");
    FilmWriter other(folder / "b.film", header);
    other.append(file.read<char>(file.left()));
    other.commit();
    folder.expect_refused("--spp 2 --resume b.film",
                          is_float ? "b.film: its precision is double, not float\n"
                                   : "b.film: its precision is float, not double\n");
}

TEST_CASE("a film that is torn, damaged, longer, empty, a folder or not there") {
    const Kept folder;
    folder.keep("a.film", "--spp 17");
    const std::string film = folder.read("a.film");
    folder.write("deep.film/file", "");
    for (size_t cut :
         {size_t(0), size_t(5), size_t(40), size_t(200), film.size() / 2, film.size() - 1}) {
        folder.write("b.film", film.substr(0, cut));
        folder.expect_refused("--spp 17 --resume b.film --checkpoint b.film", "b.film: ");
    }
    for (size_t at = 7; at < film.size(); at += film.size() / 23) {
        std::string flipped = film;
        flipped[at] = char(flipped[at] ^ 4);
        folder.write("b.film", flipped);
        folder.expect_refused("--spp 17 --resume b.film --checkpoint b.film", "b.film: ");
    }
    folder.write("b.film", film + "x");
    folder.expect_refused("--spp 17 --resume b.film", "b.film: is longer than it says\n");
    folder.expect_refused("--spp 17 --resume deep.film", "deep.film: is a directory\n");
    folder.expect_refused("--spp 17 --resume no.film", "no.film: cannot open: No such file");
    folder.expect_refused("--spp 17 --checkpoint deep.film", "deep.film: is a directory\n");
    folder.expect_refused("--spp 17 --checkpoint no/a.film",
                          "no/a.film: cannot write: No such file");
    folder.expect_refused("--spp 17 --resume a.pfm", "--resume: 'a.pfm' does not end in .film\n");
    folder.expect_refused("--spp 17 --checkpoint a", "--checkpoint: 'a' does not end in .film\n");
}

TEST_CASE("parts that there are not, and parts of what has none") {
    const Kept folder;
    const std::pair<const char*, const char*> rows[] = {
        {"--rows 0-4", "--rows 0-4: the picture has rows 0-3\n"},
        {"--rows 4-4", "--rows 4-4: the picture has rows 0-3\n"},
        {"--rows 0-2147483647", "--rows 0-2147483647: the picture has rows 0-3\n"},
        {"--rows 2-1", "--rows: '2-1' ends before it begins\n"},
        {"--rows 2", "--rows: '2' is not FIRST-LAST\n"},
        {"--rows -2", "--rows: '' is not a whole number"},
        {"--rows 1-", "--rows: '' is not a whole number"},
        {"--rows 1-2147483648", "--rows: '2147483648' is not a whole number from 0 to 2147483647"},
        {"--spp 9 --samples 0-9 --checkpoint a.film", "--samples 0-9: a pixel has samples 0-8\n"},
        {"--spp 9 --samples 5-3 --checkpoint a.film", "--samples: '5-3' ends before it begins\n"},
        {"--spp 9 --samples 0-3", "--samples: needs --checkpoint FILE, which build/merge takes\n"},
        {"--rows 0-1 --time 1", "--rows: all parts of a picture end by --spp, not by --time\n"},
        {"--rows 0-1 --error 1%", "--rows: all parts of a picture end by --spp, not by --error\n"},
        {"--samples 0-1 --spp 4 --time 1 --checkpoint a.film", "--samples: all parts of a pict"},
        {"--samples 0-1 --error 1% --checkpoint a.film", "--samples: all parts of a picture end"},
        {"--pixel 1,1 --rows 0-1", "--rows: goes without --pixel\n"},
        {"--pixel 1,1 --samples 0-1", "--samples: goes without --pixel\n"},
        {"--pixel 1,1 --checkpoint a.film", "--checkpoint: goes without --pixel\n"},
        {"--pixel 1,1 --resume a.film", "--resume: goes without --pixel\n"},
        {"--every 3", "--every: goes with --checkpoint FILE\n"},
        {"--every 0 --checkpoint a.film", "--every: '0' is not positive\n"},
        {"--time 1 --indirect map --checkpoint a.film", "--checkpoint: maps that --time fills are"},
        {"--spp 9 --samples 0-3 --checkpoint a.film --sampler independent --film cvor",
         "--samples: --film cvor needs all samples of a pixel at once\n"},
        {"--spp 9 --rows 0-1 --sampler independent --film cvor",
         "--rows: --film cvor needs --sets N\n"}};
    for (const auto& [options, why] : rows) folder.expect_refused(options, why);
    expect_refusal(folder, "penumbra", split("--rows 0-1 file.scene"),
                   "--rows: needs --checkpoint FILE, which build/merge takes\n");
}

TEST_CASE("a checkpoint shares its name with nothing else") {
    const Kept folder;
    folder.keep("a.film", "--spp 2");
    folder.write("scene.film", folder.read("file.scene"));
    fs::create_symlink("a.film", folder / "link.pfm");
    const std::pair<const char*, const char*> rows[] = {
        {"--checkpoint a.film --stats a.film -o y.pfm file.scene",
         "a.film: cannot be both a checkpoint and the statistics\n"},
        {"--resume a.film --stats ./a.film -o y.pfm file.scene",
         "./a.film: cannot be both a checkpoint and the statistics\n"},
        {"--checkpoint b.film --resume a.film --stats a.film -o y.pfm file.scene",
         "a.film: cannot be both a checkpoint and the statistics\n"},
        {"--checkpoint a.film -o link.pfm file.scene",
         "link.pfm: cannot be both a checkpoint and a .pfm image\n"},
        {"--rows 0-1 --checkpoint b.film --stats b.film file.scene",
         "b.film: cannot be both a checkpoint and the statistics\n"},
        {"--checkpoint scene.film -o y.pfm scene.film",
         "scene.film: cannot be both part of the scene and a checkpoint\n"}};
    for (const auto& [options, why] : rows) expect_refusal(folder, "penumbra", split(options), why);
}
