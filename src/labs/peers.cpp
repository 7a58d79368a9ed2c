// labs/peers.cpp  4  efficiency beside Cycles, in one run
//
//   build/peers [--seeds N] [--quick]
//
// Renders cornell36 by both cameras with Cycles (Debian's blender), with the tracer of textbook.h
// and with penumbra, by several of its options: one thread each, in turns, the same samples.  Time
// is that of the processor.  Nothing here fails for being slow.
#include "labs/seeds.h"
#include "labs/textbook.h"
#include "world/scene_file.h"

namespace {

const std::string folder = "build/cycles";  // rooms, the log of Blender

struct Effort {
    bool quick = false;
    uint64_t seeds = 3, spp = 64;
};

struct View {
    std::string name, scene;
};
const std::array<View, 2> views = {
    {{"A", "scenes/cornell36.scene"}, {"B", "scenes/cornell36b.scene"}}};

// ---- Cycles -------------------------------------------------------------------------------------

// A program on the PATH, or nothing.
std::optional<std::string> program_called(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string place; std::getline(folders, place, ':');)
        if (::access((place + "/" + name).c_str(), X_OK) == 0) return place + "/" + name;
    return {};
}

std::string json_of(vec3 v) { return json::numbers({double(v.x), double(v.y), double(v.z)}); }

// What cycles.py reads.
std::string room_of(const Scene& s, uint64_t spp) {
    std::string materials, faces;
    for (const Material& m : s.materials)
        materials += text("%s{\"albedo\": %s, \"radiance\": %s}", materials.empty() ? "" : ",\n",
                          json_of(m.kd), json_of(m.Le));
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

void add_cycles(Series& series, const std::string& blender, const View& view, uint64_t seed) {
    const std::string out = std::filesystem::absolute(folder + "/" + view.name).string();
    const std::string log = folder + "/blender.log";
    for (const char* suffix : {".pfm", ".seconds"}) std::filesystem::remove(out + suffix);
    try {
        execute({"/bin/sh", "-c", "exec \"$0\" \"$@\" >" + log + " 2>&1", blender, "-b",
                 "--python-exit-code", "1", "--python", "src/labs/cycles.py", "--", out + ".json",
                 std::to_string(seed), out});
    } catch (const SystemError& e) {
        throw SystemError("blender: " + std::string(e.what()) + "; see " + log);
    }
    series.images.push_back(read_pfm(out + ".pfm"));
    std::string seconds = read_file(out + ".seconds");
    seconds.erase(seconds.find('\n'));
    series.seconds.push_back(parse_number(seconds));
}

// ---- Ours ---------------------------------------------------------------------------------------

void add_textbook(Series& series, const Scene& scene, uint64_t spp, uint64_t seed) {
    textbook::Room room = textbook::room_of(scene);
    Image image(scene.size.width, scene.size.height);
    const double start = processor_seconds();
    for (int y = 0; y < scene.size.height; ++y)
        textbook::render_row(room, scene, seed, spp, y, image);
    series.seconds.push_back(processor_seconds() - start);
    series.images.push_back(image);
}

Rendering penumbra(const std::string& program, const View& view, const Choice& choice,
                   std::vector<std::string> more) {
    more.push_back(view.scene);
    more.insert(more.end(), choice.words.begin(), choice.words.end());
    return rendering(program, more);
}

void add_penumbra(Series& series, const std::string& program, const View& view,
                  const Choice& choice, uint64_t spp, uint64_t seed) {
    const Rendering r =
        penumbra(program, view, choice,
                 {"--threads", "1", "--spp", std::to_string(spp), "--seed", std::to_string(seed)});
    series.images.push_back(r.image);
    series.seconds.push_back(r.core_seconds());
}

// One set, but for the default.
std::vector<Choice> choices() {
    std::vector<Choice> all = {{"the default", choice_of("--sets adaptive").words},
                               choice_of("--sets 1"),
                               choice_of("--light nee --sampler independent")};
    for (const Choice& c : alternatives("--sampler")) all.push_back(c);
    return all;
}

// ---- Errors -------------------------------------------------------------------------------------

struct Row {
    std::string name;
    Series series;
    double mean_square = 0;

    // d_rel^2, of all seeds or of all but one.
    double error2(size_t without = SIZE_MAX) const {
        return variance_between(series, without) / mean_square;
    }
    double cost(size_t without) const { return error2(without) * seconds_without(series, without); }
    double mean() const {
        Moments m;
        for (const Image& image : series.images)
            for (const auto& pixel : image.pixels)
                for (float x : pixel) m.add(double(x));
        return m.mean;
    }
};

// ---- The report ---------------------------------------------------------------------------------

// In turns, so that whatever else the machine does hits all alike.
std::vector<Row> render_all(const View& view, const Effort& plan, const std::string& program,
                            const std::string& blender, Steps& steps) {
    const Scene scene = read_scene(view.scene).scene;
    write_file(folder + "/" + view.name + ".json", room_of(scene, plan.spp));
    std::vector<Row> rows = {{"Cycles", {}}, {"the textbook's tracer", {}}};
    for (const Choice& c : choices()) rows.push_back({"penumbra, " + c.name, {}});
    for (uint64_t seed = 1; seed <= plan.seeds; ++seed) {
        steps.next(view.name + ", seed " + std::to_string(seed));
        add_cycles(rows[0].series, blender, view, seed);
        add_textbook(rows[1].series, scene, plan.spp, seed);
        size_t k = 2;
        for (const Choice& c : choices())
            add_penumbra(rows[k++].series, program, view, c, plan.spp, seed);
    }
    for (Row& row : rows) row.mean_square = mean_square(row.series);
    return rows;
}

void tell(Report& report, const View& view, const std::vector<Row>& rows) {
    report.say("## Camera " + view.name + ", `" + view.scene + "`");
    report.head(
        {"", "d_rel", "core s", "core s, × Cycles", "efficiency, × Cycles", "mean, × Cycles"});
    const Row& cycles = rows[0];
    for (const Row& row : rows) {
        const size_t seeds = row.series.images.size();
        const Estimate time = over_seeds(seeds, [&](size_t without) {
            return seconds_without(row.series, without) / seconds_without(cycles.series, without);
        });
        const Estimate efficiency = over_seeds(
            seeds, [&](size_t without) { return cycles.cost(without) / row.cost(without); });
        report.row({row.name, text("%.4f", std::sqrt(row.error2())),
                    text("%.2f", seconds_without(row.series)), told(time, "%.2f"),
                    told(efficiency, "%.2f"), text("%.4f", row.mean() / cycles.mean())});
    }
    report.end_of_table();
}

int run(const std::string& program, const Effort& plan) {
    const auto blender = program_called("blender");
    if (!blender) {
        std::puts("peers: nothing is measured without Cycles: install blender (Debian: blender)");
        return 0;
    }
    std::filesystem::create_directories(folder);
    Report report(report_folder(plan.quick), "peers");
    report.say(text(R"(# Beside Cycles

Cycles renders the triangles of `cornell36` as it comes with Blender, on one thread of the processor,
with neither denoiser nor adaptive sampling nor clamping; the tracer of `src/labs/textbook.h` and
penumbra on one thread, too; all with %.0f samples a pixel and %.0f seeds, in turns.  Core seconds
of Cycles are those of %.0f samples less those of one, so that starting and reading do not count;
penumbra's count from the start to the end of the program, the textbook's its rows alone.  *The default* has
more samples where noise is, all others as many everywhere.  d_rel is the deviation between seeds over the
quadratic mean, efficiency 1 / (d_rel² × core seconds).  ± is the standard error over seeds (jackknife).)",
                    double(plan.spp), double(plan.seeds), double(plan.spp + 1)));
    Steps steps(views.size() * plan.seeds);
    for (const View& view : views)
        tell(report, view, render_all(view, plan, program, *blender, steps));
    report.say(made_by(plan.quick ? "build/peers --quick" : "build/peers"));
    return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    auto set_seeds = [&](const std::string& n) { plan.seeds = parse_count(n, 3, 100); };
    auto make_quick = [&](auto&) { plan = {true, 3, 16}; };
    const Lab lab{"peers",
                  "Measures efficiency beside Cycles, if blender is installed.",
                  {{"--seeds", "N", "renders of each (3)", set_seeds},
                   {"--quick", "", "fewer runs, into out/", make_quick}}};
    return lab_main(argc, argv, lab, [&] { return run(renderer_beside(lab, argv[0]), plan); });
}
