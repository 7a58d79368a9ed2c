// app/penumbra.cpp  5  the program: options in, image and statistics out
#include "app/render.h"

#ifdef WITH_SHOW
#include "show/show.h"
#else
namespace penumbra {
struct Show {
    OptionTable rows() const { return {}; }
    void begin(auto&&...) const {}
    void picture_now_and_then(auto&&...) const {}
    void end(auto&&...) const {}
};
}  // namespace penumbra
#endif

namespace {
using namespace penumbra;

constexpr const char* before_options =
    "usage: penumbra [options] SCENE\n\nRenders SCENE (a file in the format of scenes/*.scene) "
    "by path tracing.\n\nexamples:\n"
    "  penumbra scenes/cornell.scene                           to out/cornell.png\n"
    "  penumbra --error 3% -o a.png scenes/atelier.scene       to an error of 3 %\n"
    "  penumbra --time 10 --size 512x512 scenes/cornell.scene  in ten seconds\n\n";

constexpr const char* after_options = R"(
The estimated error is the relative RMSE d_rel: the root mean square error of
the image, divided by the RMS of the image without noise.

A .pfm and a .hdr hold linear radiance; a .png holds exposure times radiance,
clamped to [0,1], in sRGB.  Pixel (0,0) is at the top left.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM,
129 SIGHUP), after writing the image of the samples so far.
)";

// What --view shows of a sample instead of its radiance; none: radiance.
std::function<rgb(const Start&)> view_of(const Options& o, const Scene& scene) {
    if (!o.view.of) return {};
    return [&, far = far_of(scene)](const Start& at) {
        return o.view.of({scene, at, meet(scene, at.ray), far});
    };
}

// The function that renders a sample.  It abandons a path after an interrupt.
SampleFunction radiance_of(const Options& o, const Scene& scene, const SamplerSettings& settings,
                           const std::optional<LightRecorder>& recorder) {
    return [&, view = view_of(o, scene)](const PixelSample& s, Tally& tally) {
        const Start at = start(scene, settings, s);
        if (view) return ++tally.rays, view(at);
        auto misses = recorder->visitor(tally);
        return Li(scene, o.technique, at.ray, at.sampler,
                  [&](const PathState& path, const VertexEvents& e) {
                      if (interrupted) throw Interrupted();
                      tally.rays += 1 + (e.direct.light != nullptr);
                      misses(path, e);
                  });
    };
}

// Facts that must agree when a film is resumed, or merged with others.
FilmOf film_of(OptionTable& table, const Options& o, const ParsedScene& parsed, const Plan& plan) {
    const Scene& scene = parsed.scene;
    FilmOf what{{parsed.files.begin(), parsed.files.end() - 1}, {}, {}};
    if (!o.keep.empty()) what.scene = parsed.text;
    what.samples = {
        {"precision", sizeof(real) == 4 ? "float" : "double"},
        {"size", std::to_string(scene.size.width) + "x" + std::to_string(scene.size.height)},
        {"depth", std::to_string(scene.depth)}};
    for (const Option& r :
         without(table, {"--error", "--replications", "--seed", "--rows", "--threads"}))
        if (r.json) what.samples.push_back({std::string(r.name.substr(2)), r.json()});
    what.samples.push_back(
        {"replications", plan.is_adaptive ? "adaptive" : std::to_string(plan.replications)});
    if (!moves_surfaces) what.samples.push_back({"check", "none"});
    what.samples.push_back({"seed", std::to_string(o.seed)});
    what.samples.push_back({"rows", as_text(rows_of(o, scene))});
    what.notes = {{"name", printable(o.scene)}, {"exposure", json::number(double(scene.exposure))}};
    return what;
}

// The program; returns its exit status, throws UserError and SystemError.
int penumbra_main(const std::vector<std::string>& words) {
    Options o;
    Show show;
    OptionTable table = option_table(o) + show.rows();
    parse_options(table, o, words);
    if (print_manual(o, table, before_options, after_options)) return 0;
    const ParsedScene parsed = load(o);
    const NamedScene& scene = parsed.scene;
    const SamplerSettings settings = sampler_settings(o.sampler, o.seed, scene.depth);
    if (o.replay) {
        replay(scene, o.technique, settings, *o.replay, view_of(o, scene));
        return 0;
    }
    const auto outputs = outputs_of(o, parsed, "", scene.size);
    catch_interrupt();
    for (const std::string& w : parsed.warnings) tell(o, o.scene + ": warning: " + w);
    const RowRange rows = rows_of(o, scene);
    std::optional<LightRecorder> recorder;
    if (!o.view.of)
        recorder.emplace(scene, o.technique, rows.first, rows.count(), scene.line_of_light);
    const Plan plan = plan_of(o, scene, recorder ? &*recorder : nullptr);
    const SampleFunction L = radiance_of(o, scene, settings, recorder);
    const FilmOf what = film_of(table, o, parsed, plan);
    show.begin(o, outputs);
    const auto look = [&](const Film& film, const Spent& spent) {
        show.picture_now_and_then(o, scene, plan, film, spent);
    };
    const Picture picture = render(o, plan, L, what, look);  // frees the film, erases the bar
    const int status = write_picture(o, table, scene, outputs, picture);
    show.end(o, picture.run);
    return status;
}

}  // namespace

int main(int argc, char** argv) try {
    return finished(penumbra_main({argv + 1, argv + argc}));
} catch (...) {
    return failed();
}
