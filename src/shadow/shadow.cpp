// shadow/shadow.cpp  9  the program: direct light as analytic light minus sampled shadows
#include "shadow/shadow.h"

#include "app/render.h"
#include "app/threads.h"
#include "text/program.h"

namespace {
using namespace penumbra;

constexpr const char* before_options =
    "usage: shadow [options] SCENE\n\nRenders SCENE (a file in the format of scenes/*.scene) with "
    "light sampling.\nComputes the unshadowed light of each lamp on visible diffuse surfaces in "
    "closed\nform; samples estimate only the shadows.\n\n";

constexpr const char* after_options = R"(
An estimate needs all N / K samples of a replication.  A run is one pass: only
--spp ends it, and Ctrl-C leaves no image.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM,
129 SIGHUP).
)";

struct ShadowOptions : Options {
    Estimator estimator = Estimator::ratio;
};

OptionTable shadow_table(ShadowOptions& o) {
    o.replications = 2;
    o.technique.light = LightMode::nee;
    OptionTable table =
        without(option_table(o), {"--replications", "--light", "--time", "--error", "--keep",
                                  "--rows", "--view", "--pixel", "--sample"}) +
        in_group("Light transport",
                 {one_of("--estimator",
                         {{"stochastic", Estimator::stochastic},
                          {"control", Estimator::control},
                          {"ratio", Estimator::ratio},
                          {"regression", Estimator::regression}},
                         "direct light where the camera sees a diffuse surface: plain Monte Carlo; "
                         "or a control variate, "
                         "ratio or regression estimator on the analytic unshadowed radiance",
                         o.estimator)}) +
        in_group("Sampling", {whole_number("--replications",
                                           "number of independent replications per pixel; their "
                                           "sample variance gives the error estimate",
                                           "2", o.replications, 1, max_replications)});
    row(table, "-o").default_text = "out/NAME-shadow.png, .pfm";
    row(table, "--replications").value = "K";
    row(table, "--replications").json = [&o] { return std::to_string(o.replications); };
    row(table, "--spp").help = "samples per pixel, of all replications together";
    row(table, "--spp").default_text = "the scene's";
    return table;
}

// The program; returns its exit status, throws UserError and SystemError.
int shadow(const std::vector<std::string>& words) {
    ShadowOptions o;
    OptionTable table = shadow_table(o);
    parse_words(table, words, o);
    if (print_manual(o, table, before_options, after_options)) return 0;
    const ParsedScene parsed = load(o);
    const Scene& scene = parsed.scene;
    const Plan plan = plan_at_once(o, scene);
    const SamplerSettings settings = sampler_settings(o.sampler, o.seed, scene.depth);
    const auto outputs = outputs_of(o, parsed, "-shadow", plan.size);
    catch_interrupt();
    for (const std::string& w : parsed.warnings) tell(o, o.scene + ": warning: " + w);
    const SampleFunction L = shadow_estimate(scene, o.technique, settings, o.estimator, plan.paths);
    Picture picture = render(o, plan, L);
    if (interrupted) picture.run.spp = 0;
    if (estimates_pixels(o.estimator)) picture.run.bias = "consistent";
    return write_picture(o, table, scene, outputs, picture);
}

}  // namespace

int main(int argc, char** argv) try {
    return finished(shadow({argv + 1, argv + argc}));
} catch (...) {
    return failed();
}
