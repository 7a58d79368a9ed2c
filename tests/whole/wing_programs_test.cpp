// whole/wing_programs_test.cpp  build/shadow and build/voronoi as a user runs them
#include "whole/process.h"

namespace {

const std::string programs[] = {"shadow", "voronoi"};
const std::string words_of[] = {"--estimator", "--weights"};

const std::string scene =
    "size 17 9\ncamera 0 3 6  0 0 0  50\nsamples 8\ndiffuse g .5 .4 .3\nlight l 4 4 4\n"
    "quad -5 0 -5  0 0 10  10 0 0  g\nsphere 0 1 0  .5  g\nsphere 1 3 0  .4  l\n";

struct Shadows : Folder {
    Shadows() { write("a.scene", scene); }
    Image image(const std::string& program, const std::string& options) const {
        expect_success(*this, program + " --quiet -o x.pfm a.scene " + options);
        return read_pfm(*this / "x.pfm");
    }
};

}  // namespace

TEST_CASE("shadow and voronoi: one page of help; out/NAME-PROGRAM.png and .pfm; statistics") {
    for (size_t k = 0; k < 2; ++k) {
        const Shadows folder;
        expect_help(folder, programs[k] + " --help", 100,
                    programs[k] + " [options] SCENE;  " + words_of[k] + " ");
        const std::string help = run(folder, programs[k] + " --help").out;
        for (const std::string& gone : parts_of("--time;--error;--keep;--rows;--view;--pixel"))
            CHECK_FALSE(contains(help, "\n  " + gone));

        const Outcome o = expect_success(
            folder,
            programs[k] + " a.scene --replications 3 --spp 10 --size 136x72 --stats s.json");
        const std::string stem = "out/a-" + programs[k];
        CHECK(o.err.ends_with("\nwrote " + stem + ".png, " + stem + ".pfm, s.json\n"));
        CHECK(missing(o.err,
                      "a.scene: 12 samples per pixel, ;"
                      " (noise only; the estimator is consistent)") == "");
        CHECK(!first_non_finite(read_pfm(folder / (stem + ".pfm"))));
        const std::string json = folder.read("s.json");
        CHECK(said(stated(json, "samples_per_pixel"), stated(json, "replications_per_pixel"),
                   stated(json, "stopped_by")) == "12 3 \"samples\"");
        for (const char* key : {"redraws", "fallbacks"})
            CHECK(contains(json, "\"" + std::string(key) + "\": 0") == (programs[k] == "voronoi"));
    }
}

TEST_CASE(
    "shadow and voronoi: plain samples make penumbra's image; the others are of their class") {
    const Shadows folder;
    const std::string common = " --replications 2 --spp 32 --roulette .25 --seed 3 ";
    for (const std::string sampler : {"independent", "stratified", "halton", "sobol"}) {
        const std::string by = common + "--sampler " + sampler;
        CHECK(d_rel(folder.image("shadow", by + " --estimator stochastic"),
                    folder.image("penumbra", by + " --light nee")) < 1e-6);
    }
    for (const std::string light : {"nee", "mis"}) {
        const std::string by = common + "--light " + light;
        CHECK(d_rel(folder.image("voronoi", by + " --weights mc"),
                    folder.image("penumbra", by + " --sampler independent")) < 1e-6);
    }
    const Image truth = folder.image("penumbra", "--replications 1 --spp 4096");
    const std::pair<std::string, std::string> rows[] = {
        {"shadow", "stochastic unbiased"}, {"shadow", "control unbiased"},
        {"shadow", "ratio consistent"},    {"shadow", "regression consistent"},
        {"voronoi", "mc unbiased"},        {"voronoi", "vor consistent"},
        {"voronoi", "fvor consistent"},    {"voronoi", "cvor consistent"},
        {"voronoi", "torus unbiased"}};
    for (const auto& row : rows) {
        const auto& [program, estimator] = row;
        const Words words = split(estimator);
        const std::string option = words_of[program == "voronoi"] + " " + words[0];
        INFO(row.first, " ", option);
        const Image image = folder.image(program, option + common + "--stats s.json --threads 1");
        CHECK(folder.image(program, option + common + "--threads 3").pixels == image.pixels);
        CHECK(stated(folder.read("s.json"), "bias") == "\"" + words[1] + "\"");
        CHECK(d_rel(truth, image) > 1e-4);
        CHECK(d_rel(truth, image) < 0.5);
    }
}

TEST_CASE("shadow and voronoi refuse, in one line, what they cannot do") {
    const Shadows folder;
    expect_refusals(
        folder, "shadow",
        {{"--estimator mean a.scene", "--estimator: unknown value 'mean'"},
         {"--replications adaptive a.scene", "--replications: 'adaptive' is not a whole number"},
         {"--light mis a.scene", "unknown option '--light'"},
         {"--time 3 a.scene", "unknown option '--time'"},
         {"", "no scene given"}});
    expect_refusals(folder, "voronoi",
                    {{"--weights area a.scene", "--weights: unknown value 'area'"},
                     {"--sampler sobol a.scene", "unknown option '--sampler'"},
                     {"--error 1% a.scene", "unknown option '--error'"},
                     {"--spp 2097153 a.scene", "--spp: at most 1048576 samples per replication"},
                     {"-o a.scene a.scene", "-o: 'a.scene' must end in .png, .pfm or .hdr"}});
}

TEST_CASE("shadow and voronoi: Ctrl-C leaves no image") {
    for (const std::string& program : programs) {
        const Shadows folder;
        const Outcome o = cut_short(folder, program + " --spp 1000000 -o a.pfm a.scene", 0.5);
        INFO(o.err);
        CHECK(o.status == 130);
        CHECK(o.err.ends_with(
            ": interrupted before the first pass was complete: no image written\n"));
        CHECK(folder.files() == 1);
    }
}
