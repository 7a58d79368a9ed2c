// labs/peers.cpp  6  efficiency compared with Cycles
//
//   build/peers [--seeds N] [--quick]
#include "labs/grid.h"
#include "text/json.h"
#include "text/scene_file.h"

namespace {
using namespace penumbra;

std::string json_of(vec3 v) { return json::numbers({double(v.x), double(v.y), double(v.z)}); }

// The JSON text that cycles.py reads.
std::string room_of(const Scene& s, uint64_t spp) {
    std::string materials, faces;
    for (const Material& m : s.materials)
        materials += text("%s{\"albedo\": %s, \"radiance\": %s}", materials.empty() ? "" : ",\n",
                          json_of(m.diffuse()), json_of(m.Le));
    for (size_t i = 0; i < s.shapes.size(); ++i)
        faces += text("%s{\"corners\": [%s, %s, %s], \"material\": %zu}",
                      faces.empty() ? "" : ",\n", json_of(s.shapes[i].a), json_of(s.shapes[i].b),
                      json_of(s.shapes[i].c), size_t(s.material_of[i]));
    const Camera& c = s.camera;
    const double aspect = double(s.size.width) / double(s.size.height);
    json::Object room;
    room.add("size", text("[%d, %d]", s.size.width, s.size.height));
    room.add("samples", std::to_string(spp));
    room.add("depth", std::to_string(s.depth));
    room.add("angle", json::number(2 * std::atan(double(c.tan_half) * aspect)));
    room.add("eye", json_of(c.eye));
    room.add("right", json_of(c.right));
    room.add("up", json_of(c.up));
    room.add("back", json_of(-c.forward));
    room.add("materials", "[" + materials + "]");
    room.add("faces", "[" + faces + "]");
    return room.text();
}

Rendered by_cycles(const Scene& scene, uint64_t spp, uint64_t seed, const std::string& stem) {
    write_file(stem + ".room.json", room_of(scene, spp));
    try {
        execute({"/bin/sh", "-c", "exec blender \"$@\" >\"$0\" 2>&1", stem + ".log", "-b",
                 "--python-exit-code", "1", "--python", "src/labs/cycles.py", "--",
                 stem + ".room.json", std::to_string(seed), stem});
    } catch (const SystemError& e) {
        throw SystemError("blender: " + std::string(e.what()) + "; see " + stem + ".log");
    }
    std::string seconds = read_file(stem + ".seconds");
    seconds.erase(seconds.find('\n'));
    Rendered taken{read_pfm(stem + ".pfm"), {{"cpu_seconds", parse_number(seconds)}}};
    for (const char* suffix : {".room.json", ".log", ".seconds", ".pfm", ".exr"})
        std::filesystem::remove(stem + suffix);
    return taken;
}

// Renders an image by Cycles.  Unless --replications is 1, renders halves and reports the error of
// their mean.
Rendered render(const std::vector<std::string>& words) {
    const std::string stem = value_of(words, "-o") + "-cycles";
    const Scene scene = read_scene(words.at(0)).scene;
    const uint64_t spp = parse_count(value_of(words, "--spp"), 1, 1 << 20),
                   seed = parse_count(value_of(words, "--seed"), 0, 1 << 30);
    if (value_of(words, "--replications") == "1") return by_cycles(scene, spp, seed, stem);
    Rendered a = by_cycles(scene, spp / 2, seed, stem);
    const Rendered b = by_cycles(scene, spp / 2, seed + 1, stem);
    a.of["d_rel"] = d_rel(a.image, b.image) / 2;
    a.of["cpu_seconds"] += b.of.at("cpu_seconds");
    for (size_t i = 0; i < a.image.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
            a.image.pixels[i][c] = (a.image.pixels[i][c] + b.image.pixels[i][c]) / 2;
    return a;
}

const std::string cycles = "Cycles";

std::string views(const Rows& rows) {
    Lines lines;
    for (const auto& [scene, all] : grouped(rows, of_scene))
        for (const auto& [name, some] : grouped(all, of_setting)) {
            auto time = [](const Rows& r) { return mean(r, "cpu_seconds"); };
            lines.push_back(
                {scene, name, text("%.4f", relative_error(some)), text("%.2f", time(some)),
                 gain(all, name, cycles, time), gain(all, name, cycles, efficiency),
                 text("%.4f", mean(some, "mean") / mean(by_setting(all, cycles), "mean"))});
        }
    return table({"camera", "renderer", "relative RMSE", "CPU s", "CPU s, × Cycles",
                  "efficiency, × Cycles", "mean, × Cycles"},
                 lines);
}

// Each renderer has its own reference, so differences between models do not count as errors.
int study(const Scope& scope, uint64_t seeds) {
    if (std::system("command -v blender >/dev/null") != 0)
        return std::puts("peers: nothing is measured without Cycles; install blender"), 0;
    Page page(scope, "peers");
    const uint64_t spp = scope.quick ? 16 : 64;
    const std::vector<Subject> both = {{"A", "scenes/cornell36.scene", 16 * spp},
                                       {"B", "scenes/cornell36b.scene", 16 * spp}};
    std::vector<Setting> ours = {{"penumbra, the default", "--replications adaptive"}};
    for (const char* words : {"", "--light nee --sampler independent", "--sampler independent",
                              "--sampler stratified", "--sampler halton"})
        ours.push_back({std::string("penumbra, --replications 1 ") + words,
                        std::string("--replications 1 ") + words});
    RenderGrid theirs("peers-cycles", scope.self + " --render"), grid("peers", scope.beside());
    Rows rows;
    for (uint64_t n = 1; n <= seeds; ++n) {  // in turns: renders of a former turn are kept
        rows = theirs.run(both, {{cycles, "--replications 1"}}, {spp}, n);
        append(rows, grid.run(both, ours, {spp}, n));
    }
    page.set("table", views(rows));
    // More is better: efficiency by default, and CPU time of Cycles over that of one replication.
    auto seconds = [](const Rows& r) { return mean(r, "cpu_seconds"); };
    std::vector<double> numbers;
    for (const char* camera : {"A", "B"})
        numbers.push_back(over(in_scene(rows, camera), ours[0].name, cycles, efficiency));
    for (const char* camera : {"A", "B"})
        numbers.push_back(over(in_scene(rows, camera), cycles, ours[1].name, seconds));
    const Lines all = page.measured(numbers);
    const std::vector<double> least = least_of(all, 4);
    page.set("A", text("%.2f", least[0]));
    page.set("B", text("%.2f", least[1]));
    page.set("processors", table({"processor", "instructions", "compiler", "commit", "efficiency A",
                                  "efficiency B", "speed A", "speed B"},
                                 all));
    page.set("samples", text("%.0f", double(spp)));
    page.set("seeds", text("%.0f", double(seeds)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    uint64_t seeds = 3;
    const Lab lab{"peers",
                  "Measures efficiency compared with Cycles, if blender is installed.",
                  {whole_number("--seeds", "renders of each", "3", seeds, 3, 100)},
                  render};
    return experiment(argc, argv, lab, [&](const Scope& scope) { return study(scope, seeds); });
}
