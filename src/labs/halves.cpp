// labs/halves.cpp  6  the efficiency of a picture of two halves, with weights and without
//
//   build/halves [--quick] [--former PROGRAM]
#include "keep/film_file.h"
#include "labs/grid.h"

namespace {
using namespace penumbra;

const std::string weighted = "halves with weights", equal = "equal halves", one = "one replication",
                  former = "the former default";

struct Place {  // a size, with the samples per pixel of references, and seeds
    std::string size;
    uint64_t truth, seeds;
};

// The work of a render is the number of its rays, which other programs do not disturb.
double gain_in_rays(const Rows& rows) { return 1 / (mean(rows, "d2") * mean(rows, "rays")); }

std::vector<Subject> subjects_at(const Place& place) {
    std::vector<Subject> all;
    for (const std::string& name : scenes_in("scenes"))
        if (name != "extremes")  // no reference has enough samples
            all.push_back({name, "scenes/" + name + ".scene --size " + place.size, place.truth,
                           text("--spp %.0f --seed 1000000", double(place.truth))});
    return all;
}

Rows of_count(const Rows& rows, uint64_t count) {
    return where(rows, [&](const Row& r) { return r.count == count; });
}

// The geometric mean over counts of a setting's efficiency over that of another, in one scene.
double in_one_scene(const Rows& rows, const std::vector<uint64_t>& counts, const std::string& a,
                    const std::string& b) {
    double sum = 0;
    for (uint64_t count : counts) sum += std::log(over(of_count(rows, count), a, b, gain_in_rays));
    return std::exp(sum / double(counts.size()));
}

// The halves of a film, their difference around a mean grey, and the picture.
Svg picture_of_halves(const std::string& program, const std::string& scene, double exposure) {
    const std::string film = text("out/halves%d.film", int(::getpid()));
    const Image whole = rendering(program + " " + scene + " --spp 16 --keep " + film);
    FilmReader file(film);
    Film f = film_but_sums(file, {whole.width, whole.height});
    f.sum.resize(f.pixels() * f.replications);
    file.read(std::as_writable_bytes(std::span(f.sum)));
    std::filesystem::remove(film);
    Image half[2] = {whole, whole}, difference = whole;
    for (size_t i = 0; i < f.pixels(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            for (size_t k : {0, 1})
                half[k].pixels[i][c] = float(f.sum[2 * i + k][c] / double(f.samples(i)));
            difference.pixels[i][c] = std::abs(half[0].pixels[i][c] - half[1].pixels[i][c]) / 2;
        }
    return contact_sheet({{half[0], "one half", "its own randomisation"},
                          {half[1], "the other half", "as many samples"},
                          {difference, "half their difference", "estimates the error"},
                          {whole, "their mean", "the picture"}},
                         2, exposure);
}

int study(const Scope& scope, const std::string& former_program) {
    Page page(scope, "halves");
    const std::string program = scope.beside();
    RenderGrid grid("halves", program);
    std::vector<Place> places = {{"64x32", 8192, 4}, {"192x96", 1024, 2}, {"256x128", 1024, 1}};
    std::vector<uint64_t> counts = {16, 64, 256};
    if (scope.quick) places = {{"64x32", 512, 2}}, counts = {16};
    std::vector<Setting> settings = {
        {weighted, ""}, {equal, "--replications 2"}, {one, "--replications 1"}};
    if (!former_program.empty()) settings.push_back({former, "", former_program});
    Lines means, scenes;
    for (const Place& place : places) {
        const Rows rows = grid.run(subjects_at(place), settings, counts, place.seeds);
        for (uint64_t count : counts) {
            const Rows some = of_count(rows, count);
            means.push_back({place.size, text("%.0f", double(count))});
            for (const std::string& base : {one, equal, former})
                means.back().push_back(
                    by_setting(rows, base).empty() ? "" : gain(some, weighted, base, gain_in_rays));
        }
        size_t line = 0;
        for (const auto& [scene, some] : grouped(rows, [](const Row& r) { return r.scene; })) {
            if (scenes.size() <= line) scenes.push_back({scene});
            for (const std::string& base : {one, former})
                scenes[line].push_back(
                    by_setting(some, base).empty()
                        ? ""
                        : text("%.2f", in_one_scene(some, counts, weighted, base)));
            ++line;
        }
    }
    std::vector<std::string> head = {"scene"};
    for (const Place& place : places)
        for (const char* base : {"one", "former"}) head.push_back(place.size + ", × " + base);
    page.set("means", table({"size", "samples", "× one replication", "× equal halves",
                             "× the former default"},
                            means));
    page.set("scenes", table(head, scenes));
    page.plot("halves", picture_of_halves(program, "scenes/coursework.scene --size 192x96", 0.6));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    std::string former_program;
    const Lab lab{"halves",
                  "Measures the efficiency of two halves with weights.",
                  {{"--former", "PROGRAM", "compare with a former penumbra, too", "",
                    [&](Text v) { former_program = v; }}}};
    return experiment(argc, argv, lab,
                      [&](const Scope& scope) { return study(scope, former_program); });
}
