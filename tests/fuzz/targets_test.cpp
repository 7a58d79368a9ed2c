// fuzz/targets_test.cpp  all inputs that ever broke something, the fuzzers' seeds, and the
// detection of violated invariants
#include "fuzz/targets.h"

#include <doctest/doctest.h>

#include "text/complaint.h"

using namespace fuzz;

namespace {

namespace fs = std::filesystem;

// What a target reports for a file: "" if nothing is wrong.
std::string told(const fuzz::Target& target, const std::string& input) {
    return complaint<std::exception>([&] { target.run(input); });
}

std::string drawn_bytes(uint64_t seed, size_t n) {
    std::string bytes;
    while (bytes.size() < n) bytes += char(mix(seed + bytes.size()) & 0xff);
    return bytes;
}

// The files of a folder for a target; none if the folder does not exist.
std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> files;
    if (fs::exists(folder))
        for (const auto& entry : fs::directory_iterator(folder))
            files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

NamedScene scene_of(const std::string& text) {
    return parse_scene("camera 0 0 5  0 0 0  40\ndiffuse d .5 .5 .5\nlight l 1 1 1\n" + text,
                       "s.scene")
        .scene;
}

}  // namespace

TEST_CASE("what fuzzers found, and what they begin with, breaks nothing") {
    for (const fuzz::Target& target : targets) {
        std::map<std::string, std::string> inputs = seeds_of(target.name);
        INFO(target.name);
        CHECK(!inputs.empty());
        for (const std::string& file : files_in(fs::path("tests/fuzz/regressions") / target.name))
            inputs[file] = read_file(file);
        for (const auto& [name, input] : inputs) {
            INFO(name);
            CHECK(told(target, input) == "");
        }
    }
}

TEST_CASE("a seed may have any bytes") {
    const auto seeds = seeds_of("pfm");
    CHECK(seeds.size() == 3);
    CHECK(seeds.at("one.pfm") == std::string("PF\n1 1\n-1.0\n\0\0\x80?\0\0\0?\0\0\0\0", 24));
}

TEST_CASE("seeds are accepted: fuzzers begin with what is right") {
    for (const auto& [kind, name] : {std::pair{"scene", "s.scene"}, {"obj", "m.obj"}})
        for (const auto& [seed, input] : seeds_of(kind)) {
            INFO(seed);
            const Bundle files = bundle(input, name);
            write_meshes(files);
            const bool is_scene = files.contains("s.scene");
            const std::string text = is_scene ? std::string(files.at(name)) : fuzz::around_mesh;
            CHECK_NOTHROW(parse_scene(text, place() / "s.scene"));
        }
    for (const auto& [seed, input] : seeds_of("pfm")) {
        place().write(seed, input);
        CHECK_NOTHROW(read_pfm(place() / seed));
    }
    for (unsigned kind = 0; kind < SmallFilm::kinds; ++kind) {
        place().write("f.film", small_film(kind));
        if (kind < 2) CHECK_NOTHROW(merge_alone(place() / "f.film"));  // the others are incomplete
        CHECK_NOTHROW(SmallFilm(kind).go_on(place() / "f.film"));
    }
}

// Most draws must be valid scenes: a fuzzer that draws refused ones finds nothing.
TEST_CASE(
    "drawn scenes are well-formed, of every kind of shape and material, and most are accepted") {
    std::string all;
    int accepted = 0, moderate = 0;
    constexpr int draws = 400;
    for (uint64_t k = 0; k < draws; ++k) {
        const std::string bytes = drawn_bytes(1000 * k, 120);
        const Drawn d = drawn(bytes);
        all += d.scene;
        for (const std::string& word : d.options) all += " " + word;
        moderate += d.moderate;
        const std::string why =
            complaint([&] { check_scene(parse_scene(d.scene, "s.scene").scene); });
        accepted += why.empty();
        // These reasons depend on the numbers, which the generator does not check.
        bool expected = why.empty();
        for (const char* reason :
             {"camera must look", "point light lies", "empty scene", "too small", "too large"})
            expected = expected || why.find(reason) != why.npos;
        INFO(why, "\n", d.scene);
        CHECK(expected);
    }
    CHECK(accepted > draws / 2);
    CHECK(moderate > draws / 2);
    CHECK(moderate < draws);
    for (const Statement& s : grammar)
        if (s.kind != Statement::setting && s.keyword != "mesh")
            CHECK(all.find(std::string(s.keyword) + " ") != all.npos);
    for (const char* word : {"stratified", "adaptive", "uniform", "--view bvh", "--rows"})
        CHECK(all.find(word) != all.npos);
}

// Most drawn lamps lie in a surface or in each other; two cases are written by hand.
TEST_CASE("light modes agree wherever lamps lie") {
    int lifted = 0;
    for (uint64_t k = 0; k < 60; ++k) {
        const std::string bytes = drawn_bytes(1000 * k + 500, 40);
        CHECK(told(*fuzz::find("lamps"), bytes) == "");
        Choices c(bytes);
        const auto parsed = parse_scene(drawn_lamps(c), "s.scene");
        lifted += std::any_of(parsed.warnings.begin(), parsed.warnings.end(),
                              [](auto& w) { return w.find("lies in the surface") != w.npos; });
    }
    CHECK(lifted > 40);
}

TEST_CASE("broken scenes are told") {
    const NamedScene good = scene_of("sphere 0 0 0  1  d\nquad 3 0 0  1 0 0  0 1 0  l\n");
    CHECK_NOTHROW(check_scene(good));
    auto broken = [&](auto change) {
        NamedScene s = good;
        change(s);
        CHECK_THROWS_AS(check_scene(s), Broken);
    };
    broken([](NamedScene& s) { s.shapes[0].r = infinity; });
    broken([](NamedScene& s) { s.shapes[1].c = s.shapes[1].a; });
    broken([](NamedScene& s) { s.material_of[0] = 2; });
    broken([](NamedScene& s) { s.light_of[1] = 1; });
    broken([](NamedScene& s) { s.line_of.pop_back(); });
    broken([](NamedScene& s) { s.line_of_light.push_back(1); });
    broken([](NamedScene& s) { s.camera.right.x = NAN; });
}

TEST_CASE("a tree that errs is told") {
    const NamedScene good = scene_of("sphere 0 0 0  1  d\nsphere 3 0 0  1  d\nsphere 0 3 0  1  d\n");
    const Ray rays[] = {{{5, 0, 0}, {-1, 0, 0}}, {{0, 0, 5}, {0, 0, -1}}, {{5, 5, 5}, {1, 0, 0}}};
    for (const Ray& ray : rays) CHECK_NOTHROW(check_ray(good, ray));
    Scene other = good;  // its BVH has other shapes
    std::swap(other.shapes[0], other.shapes[1]);
    CHECK_THROWS_AS(check_ray(other, rays[0]), Broken);
    other.shapes.resize(1);
    CHECK_THROWS_AS(check_ray(other, rays[1]), Broken);
}

TEST_CASE("broken images and options are told") {
    Image image(2, 1);
    CHECK_THROWS_AS(check_image(image, {2, 1}, true), Broken);
    image.pixels.assign(2, {0, 0, -1});
    CHECK_THROWS_AS(check_image(image, {2, 1}, true), Broken);
    CHECK_NOTHROW(check_image(image, {2, 1}, false));
    CHECK_THROWS_AS(check_image(image, {1, 1}, false), Broken);

    Options o;
    const OptionTable table = option_table(o);
    CHECK_THROWS_AS(check_options(table, o), Broken);
    o.scene = "s";
    CHECK_NOTHROW(check_options(table, o));
    o.threads = 0;
    CHECK_THROWS_AS(check_options(table, o), Broken);
}
