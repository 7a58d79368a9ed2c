// voronoi/voronoi.cpp  9  the program: samples of a pixel weighted by their Voronoi cells
#include "app/render.h"
#include "app/threads.h"
#include "text/program.h"
#include "voronoi/weighted.h"

namespace {
using namespace penumbra;

constexpr const char* before_options =
    "usage: voronoi [options] SCENE\n\nRenders SCENE (a file in the format of scenes/*.scene) by "
    "independent paths.\nWeights each sample of a pixel by the area of its Voronoi cell.\n\n";

constexpr const char* after_options = R"(
Weights need all N / K samples of a replication.  A run is one pass: only --spp
ends it, and Ctrl-C leaves no image.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM,
129 SIGHUP).
)";

struct VoronoiOptions : Options {
    Weighting weights = Weighting::cvor;
};

OptionTable voronoi_table(VoronoiOptions& o) {
    o.replications = 2;
    o.sampler = SamplerKind::independent;
    OptionTable table =
        without(option_table(o), {"--replications", "--sampler", "--time", "--error", "--keep",
                                  "--rows", "--view", "--pixel", "--sample"}) +
        in_group(
            "Sampling",
            {one_of("--weights",
                    {{"mc", Weighting::mc},
                     {"vor", Weighting::vor},
                     {"fvor", Weighting::fvor},
                     {"cvor", Weighting::cvor},
                     {"torus", Weighting::torus}},
                    "weights of a pixel's samples: equal; or areas of Voronoi cells, bounded by "
                    "random sites in a strip around the pixel, the same without cells that leave "
                    "the strip, clipped to the pixel, or on a torus",
                    o.weights),
             whole_number("--replications",
                          "number of independent replications per pixel; their sample variance "
                          "gives the error estimate",
                          "2", o.replications, 1, max_replications)});
    row(table, "-o").default_text = "out/NAME-voronoi.png, .pfm";
    row(table, "--replications").value = "K";
    row(table, "--replications").json = [&o] { return std::to_string(o.replications); };
    row(table, "--spp").help = "samples per pixel, of all replications together";
    row(table, "--spp").default_text = "the scene's";
    return table;
}

// The radiance of one path; the film gets only weighted means of paths.
SampleFunction path_of(const Options& o, const Scene& scene, const SamplerSettings& settings) {
    return [&](const PixelSample& s, Tally& tally) {
        const Start at = start(scene, settings, s);
        const rgb L = Li(scene, o.technique, at.ray, at.sampler, [&](auto&, const VertexEvents& e) {
            if (interrupted) throw Interrupted();
            tally.rays += 1 + (e.direct.light != nullptr);
        });
        if (fits_float(L)) return L;
        throw SystemError(in_words(s) + " is not finite (replay it by penumbra " +
                          in_words(s, "--sampler independent --pixel ", " --sample ") + ")");
    };
}

// The program; returns its exit status, throws UserError and SystemError.
int voronoi_main(const std::vector<std::string>& words) {
    VoronoiOptions o;
    OptionTable table = voronoi_table(o);
    parse_words(table, words, o);
    if (print_manual(o, table, before_options, after_options)) return 0;
    const ParsedScene parsed = load(o);
    const Scene& scene = parsed.scene;
    const Plan plan = plan_at_once(o, scene);
    if (plan.paths > 1 << 20)
        throw UserError((o.spp > 0 ? "--spp" : o.scene + ": samples") +
                        std::string(": at most 1048576 samples per replication"));
    const SamplerSettings settings = sampler_settings(o.sampler, o.seed, scene.depth);
    const auto outputs = outputs_of(o, parsed, "-voronoi", plan.size);
    catch_interrupt();
    for (const std::string& w : parsed.warnings) tell(o, o.scene + ": warning: " + w);
    WeightTroubles troubles;
    const SampleFunction L = weighted_mean(scene, settings, o.weights, plan.paths,
                                           path_of(o, scene, settings), troubles);
    Picture picture = render(o, plan, L);
    Run& run = picture.run;
    if (interrupted) run.spp = 0;
    if (o.weights != Weighting::mc && o.weights != Weighting::torus) run.bias = "consistent";
    run.more = {{"redraws", std::to_string(troubles.redraws)},
                {"fallbacks", std::to_string(troubles.fallbacks)}};
    return write_picture(o, table, scene, outputs, picture);
}

}  // namespace

int main(int argc, char** argv) try {
    return finished(voronoi_main({argv + 1, argv + argc}));
} catch (...) {
    return failed();
}
