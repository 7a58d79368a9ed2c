// app/checkpoints_test.cpp  what films say of themselves, and when they are written
#include "app/checkpoints.h"

#include "base/folder.h"
#include "film/refusal.h"
#include "path/scenes.h"

namespace {

Options options_of(const std::vector<std::string>& words) {
    Options o = parse_words(option_table, words);
    o.scene = "test";
    return o;
}

FilmHeader identity(const std::vector<std::string>& words, Scene scene = scene_of(unequal)) {
    const Options o = options_of(words);
    return identity_of(job_of(o, scene), "sum");
}

// The first line in which they differ.
std::string difference(const FilmHeader& its, const FilmHeader& expected) {
    const std::string why = refusal([&] { check_identity("a.film", its, expected); });
    return why == "no refusal" ? "" : why;
}

Folder& folder_of_test() {
    static Folder folder;
    return folder;
}

std::string sum_of(const std::string& a, const std::string& b) {
    const Folder& folder = folder_of_test();
    folder.write("a", a), folder.write("b", b);
    return sum_of_files({folder / "a", folder / "b"});
}

FilmState<MeanPixel> state_of(size_t pixels) {
    FilmState<MeanPixel> s;
    s.first.resize(pixels), s.spread.resize(pixels);
    s.ahead.resize(pixels), s.terms.resize(pixels);
    return s;
}

}  // namespace

TEST_CASE("every option that is in --stats and changes samples is in the head, and no other") {
    const std::vector<std::vector<std::string>> changing = {
        {"--sampler", "halton"},    {"--sets", "4"},
        {"--direction", "uniform"}, {"--light", "nee"},
        {"--direct", "ratio"},      {"--polygons", "angle"},
        {"--pick", "power"},        {"--seed", "9"},
        {"--view", "albedo"},       {"--film", "torus"},
        {"--roulette", "0.250001"}, {"--rows", "0-3"},
        {"--samples", "0-3"},       {"--indirect", "control"}};
    const std::vector<std::vector<std::string>> others = {
        {"--threads", "1"}, {"--exposure", "3"}, {"--every", "7"},           {"--time", "9"},
        {"--quiet"},        {"--error", "1%"},   {"--checkpoint", "a.film"}, {"-o", "a.pfm"}};
    const FilmHeader plain = identity({});
    CHECK(difference(plain, plain) == "");
    for (const auto& words : changing) {
        INFO(words[0]);
        const std::string key = words[0].substr(2);
        CHECK(difference(plain, identity(words)).starts_with("a.film: its " + key + " is "));
        CHECK(difference(identity(words), plain).starts_with("a.film: its " + key + " is "));
    }
    for (const auto& words : others) {
        INFO(words[0]);
        CHECK(difference(plain, identity(words)) == "");
        CHECK(difference(identity(words), plain) == "");
    }
    // What is in the statistics of what was asked for is one or the other.
    for (const auto& row : option_table) {
        const std::string name(row.name);
        auto has = [&](const auto& all) {
            return std::any_of(all.begin(), all.end(), [&](const auto& w) { return w[0] == name; });
        };
        INFO(name);
        CHECK((row.stats(options_of({})).empty() || has(changing) || has(others)));
    }
}

TEST_CASE("the scene's depth and size are in the head, and its grid if it has one") {
    Scene scene = scene_of(unequal);
    const FilmHeader plain = identity({});
    scene.depth = 2;
    CHECK(difference(identity({}, scene), plain) == "a.film: its depth is 2, not 3");
    scene = scene_of(unequal);
    scene.size.height = 33;
    CHECK(difference(identity({}, scene), plain) == "a.film: its size is 64x33, not 64x32");
    const std::vector<std::string> stratified = {"--sampler", "stratified", "--spp", "35"};
    CHECK(identity(stratified).find("grid") == "7x5");
    CHECK_FALSE(plain.find("grid"));
    CHECK(identity({"--film", "cvor", "--spp", "35"}).find("weights") == "35");
    CHECK_FALSE(plain.find("weights"));
    CHECK(plain.find("precision") == (sizeof(real) == 4 ? "float" : "double"));
    // Not of the samples alone.
    CHECK(difference(identity({"--spp", "35"}), identity({"--spp", "99"})) == "");
}

TEST_CASE("the sum of the scene's files tells every byte, and where a file ends") {
    const std::string sum = sum_of("scene", "mesh");
    CHECK(sum.size() == 16);
    CHECK(sum_of("scene", "mesh") == sum);
    CHECK(sum_of("scenf", "mesh") != sum);
    CHECK(sum_of("scene", "mesh\n") != sum);
    CHECK(sum_of("scenem", "esh") != sum);
    CHECK(sum_of("mesh", "scene") != sum);
    CHECK(sum_of("", "scenemesh") != sum_of("scenemesh", ""));
}

TEST_CASE("checkpoints take less than a hundredth of the time, and come no sooner than asked for") {
    CHECK(until_next(60, 0.01) == 60);
    CHECK(until_next(60, 0.6) == 60);
    CHECK(until_next(60, 3) == 300);
    CHECK(until_next(1e-9, 0.5) == 50);
}

TEST_CASE("a checkpoint is due after the interval, and then after the next") {
    const Folder folder;
    const Scene scene = scene_of(unequal);
    Options o = options_of({"--every", "1000"});
    const FilmState<MeanPixel> state = state_of(3);
    CHECK_FALSE(Checkpoints(job_of(o, scene), identity({})).is_due(1e9));
    o.checkpoint = folder / "a.film";
    const Job job = job_of(o, scene);
    Checkpoints checkpoints(job, identity({}));
    CHECK_FALSE(checkpoints.is_due(999));
    CHECK(checkpoints.is_due(1000));
    checkpoints.write_meanwhile(state, {}, 1500);
    CHECK(folder.has("a.film"));
    CHECK_FALSE(checkpoints.is_due(2499));
    CHECK(checkpoints.is_due(4000));
    // So after one that could not be written.
    fs::remove_all(folder.path);
    checkpoints.write_meanwhile(state, {}, 4000);
    CHECK_FALSE(checkpoints.is_due(4999));
    CHECK_THROWS_AS(checkpoints.write(state, {}, true), SystemError);
    fs::create_directory(folder.path);
}

TEST_CASE("what a run measured comes back, and says whether it is complete") {
    const Folder folder;
    RunStats run;
    run.seconds = 0.1, run.cpu_seconds = 1e30, run.rays = UINT64_MAX, run.redraws = 7;
    run.fallbacks = 8;
    for (bool with_maps : {false, true}) {
        FilmHeader h;
        h.set("mesh", "0.25");
        if (with_maps) run.maps = MapStats{0.25, 9, 10, 11, NAN, 0.3, {1, 0.5, real(0.1)}};
        if (!with_maps) h.entries.clear();
        set_run(h, run, with_maps);
        CHECK(h.find("complete") == (with_maps ? "yes" : "no"));
        const RunStats back = run_in(h, "a.film");
        CHECK(back.seconds == 0.1);
        CHECK(back.cpu_seconds == 1e30);
        CHECK(back.rays == UINT64_MAX);
        CHECK(back.redraws == 7);
        CHECK(back.fallbacks == 8);
        REQUIRE(back.maps.has_value() == with_maps);
        if (!with_maps) continue;
        CHECK(back.maps->H == 0.25);
        CHECK(back.maps->triangles == 9);
        CHECK(back.maps->particles == 10);
        CHECK(back.maps->rays == 11);
        CHECK(std::isnan(back.maps->error));
        CHECK(back.maps->seconds == 0.3);
        CHECK(back.maps->slope.y == real(0.5));
        CHECK(back.maps->slope.z == real(0.1));
    }
    FilmHeader h;
    set_run(h, run, true);
    h.set("seconds", "soon");
    CHECK(refusal([&] { run_in(h, "a.film"); }) == "a.film: seconds: 'soon' is not a number");
}
