// whole/kept_refusals_test.cpp  films that cannot be resumed, and names that cannot be written
#include "whole/kept.h"
#include "whole/process.h"

namespace {

struct Kept : MeshPlace {
    void keep(const std::string& film, const std::string& options) const {
        render("--keep " + film + " -o x.pfm " + options);
        fs::remove(*this / "x.pfm");
    }
    void refuse(const std::string& options, const std::string& why) const {
        expect_refusal(*this, "penumbra -o y.pfm file.scene " + options, why);
    }
};

}  // namespace

TEST_CASE("a film of other samples is refused by what differs, and nothing is touched") {
    const Kept folder;
    folder.keep("a.film", "--spp 17");
    for (const auto& [options, why] :
         {std::pair<std::string, std::string>{"--size 9x4", "size 8x4, not 9x4"},
          {"--sampler halton", "sampler sobol, not halton"},
          {"--replications 2", "replications 8, not 2"},
          {"--direction uniform", "direction bsdf, not uniform"},
          {"--light nee", "light mis, not nee"},
          {"--depth 3", "depth 8, not 3"},
          {"--roulette 0.5", "roulette 0.25, not 0.5"},
          {"--seed 1", "seed 0, not 1"},
          {"--view normal", "view radiance, not normal"},
          {"--rows 0-1", "rows 0-3, not 0-1"}})
        folder.refuse("--spp 20 --keep a.film " + options,
                      "a.film: was rendered with " + why + "\n");
    // Options that samples do not depend on may change.
    folder.render(
        "--spp 18 --keep a.film --threads 3 --exposure 2 -o z.pfm --stats z.json "
        "--error 50% --time 9");
}

TEST_CASE("another scene, by one byte of any of its files; the same one elsewhere") {
    const Kept folder;
    folder.keep("a.film", "--spp 2");
    for (const std::string name : {"file.scene", "m.obj", "m.mtl"}) {
        INFO(name);
        const std::string bytes = folder.read(name);
        folder.write(name, bytes + "\n");
        folder.refuse("--spp 2 --keep a.film",
                      "a.film: was rendered from another version of file.scene\n");
        folder.write(name, bytes);
        folder.write("other/" + name, bytes);
    }
    expect_success(folder, "penumbra --spp 2 --keep a.film -o z.pfm other/file.scene");
}

TEST_CASE("a film of fewer samples than replications has one of each, and gets no other") {
    const Kept folder;  // a picture of few pixels has 8
    folder.keep("a.film", "--spp 1");
    folder.refuse("--spp 2 --keep a.film", "a.film: was rendered with replications 1, not 2\n");
    folder.render("--spp 8 --replications 1 --keep a.film -o z.pfm");
    folder.keep("b.film", "--spp 3");
    folder.refuse("--spp 8 --keep b.film", "b.film: was rendered with replications 3, not 8\n");
    folder.render("--spp 8 --replications 3 --keep b.film -o z.pfm");
}

TEST_CASE("a film of an earlier Penumbra is refused by its version") {
    const Kept folder;
    folder.keep("a.film", "--spp 17");
    folder.write("b.film", "penumbra film 9" + folder.read("a.film").substr(16));
    const std::string why = "b.film: is of another Penumbra: format version 9, not 10\n";
    folder.refuse("--spp 17 --keep b.film", why);
    for (const std::string program : {"merge -o y.pfm b.film", "compare b.film b.film"})
        expect_refusal(folder, program, why);
}

TEST_CASE("a film that is torn, longer, empty, a folder or in none") {
    const Kept folder;
    folder.keep("a.film", "--spp 17");
    const std::string film = folder.read("a.film");
    for (size_t cut : {size_t(0), film.size() / 2}) {
        folder.write("b.film", film.substr(0, cut));
        folder.refuse("--spp 17 --keep b.film",
                      cut == 0 ? "b.film: is not a film\n" : "b.film: is cut short\n");
    }
    folder.write("b.film", film + "x");
    folder.refuse("--spp 17 --keep b.film", "b.film: is longer than it says\n");
    folder.write("deep.film/file", "");
    folder.refuse("--spp 17 --keep deep.film", "deep.film: is a directory\n");
    folder.refuse("--spp 17 --keep no/a.film", "no/a.film: cannot write: No such file");
}

TEST_CASE("a film shares its name with nothing else") {
    const Kept folder;
    folder.keep("a.film", "--spp 2");
    folder.write("scene.film", folder.read("file.scene"));
    fs::create_symlink("a.film", folder / "link.pfm");
    const std::string why = ": would replace another file of this run\n";
    expect_refusals(folder, "penumbra",
                    {{"--keep a.film --stats ./a.film -o y.pfm file.scene", "./a.film" + why},
                     {"--keep a.film -o link.pfm file.scene", "link.pfm" + why},
                     {"--rows 0-1 --keep b.film --stats b.film file.scene", "b.film" + why},
                     {"--keep scene.film -o y.pfm scene.film", "scene.film" + why}});
}
