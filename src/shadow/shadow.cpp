// shadow/shadow.cpp  9  the program: images whose direct light is found by its shadows alone
#include "shadow/shadow.h"

#include "app/render.h"
#include "base/program.h"

namespace {

constexpr const char* before_options =
    "usage: shadow [options] SCENE\n\nRenders SCENE (a file in the format of scenes/*.scene) by "
    "light\nsamples.  Visible diffuse surfaces would get known light from each lamp, were\n"
    "nothing in the way; samples find what shadows take from it.\n\n";

constexpr const char* after_options = R"(
An estimate takes all samples of a replication, N / K of them, so that a run is
one pass: it ends by --spp alone, and Ctrl-C leaves no image.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM,
129 SIGHUP).
)";

struct ShadowOptions : Options {
    Estimator estimator = Estimator::ratio;
};

OptionTable shadow_table(ShadowOptions& o) {
    o.sets = 2;
    o.technique.light = LightMode::nee;
    OptionTable table = {
        output_row(o, "out/NAME-shadow.png, .pfm"),
        one_of("--estimator", "stochastic|control|ratio|regression",
               "light samples as they are; or the known light less what shadows take from it: by "
               "their difference, by the part that is visible, or by as much as correlation tells",
               o.estimator),
        whole_number("--sets", "replications of each pixel, whose spread tells the error", "2",
                     o.sets, 1, most_sets)};
    table[2].value = "K";
    table[2].json = [&o] { return std::to_string(o.sets); };
    for (Option& r :
         without(option_table(o), {"-o", "--sets", "--light", "--time", "--error", "--keep",
                                   "--rows", "--view", "--pixel", "--sample"}))
        table.push_back(std::move(r));
    row(table, "--spp").help = "samples a pixel, of all replications together";
    row(table, "--spp").otherwise = "the scene's";
    return table;
}

// The program; returns its exit status, throws UserError and SystemError.
int shadow(const std::vector<std::string>& words) {
    ShadowOptions o;
    OptionTable table = shadow_table(o);
    parse_words(table, words, o);
    if (o.help) {
        std::printf("%s%s%s", before_options, option_lines(table).c_str(), after_options);
        return 0;
    }
    const ParsedScene parsed = load(o);
    const Scene& scene = parsed.scene;
    Plan plan = plan_of(o, scene);
    plan.at_once = std::exchange(plan.target.samples, 1);
    const Pattern pattern = make_pattern(o.sampler, o.seed, scene.depth, plan.at_once);
    const auto outputs = outputs_of(o, parsed, "-shadow", plan.size);
    catch_interrupt();
    for (const std::string& w : parsed.warnings) tell(o, o.scene + ": warning: " + w);
    const Radiance L = shadow_estimate(scene, o.technique, pattern, o.estimator, plan.at_once);
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
