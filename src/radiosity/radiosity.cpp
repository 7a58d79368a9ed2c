// radiosity/radiosity.cpp  9  the program: illumination maps of a scene, and images of them
#include "app/threads.h"
#include "radiosity/gather.h"
#include "radiosity/solution.h"

namespace {
using namespace penumbra;

constexpr const char* before_options =
    "usage: radiosity [options] SCENE\n\nComputes illumination maps of SCENE (a file in the format "
    "of "
    "scenes/*.scene, all\ndiffuse) on triangles of its faces, and renders them as its camera sees "
    "them, or\nby paths that end on them (--final-gather).  The number of bounces is "
    "unlimited,\nwhatever the scene's depth.\n\n";

constexpr const char* after_options = R"(
A .pfm and a .hdr hold linear radiance; a .png holds exposure times radiance,
clamped to [0,1], in sRGB.  Pixel (0,0) is at the top left.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM,
129 SIGHUP), after writing the image of the light found so far.
)";

Image picture_of(const RadiosityOptions& o, const Stage& stage, const IlluminationMap& map) {
    const auto& [scene, mesh, H, bytes] = stage;
    if (o.shows == MapView::illuminance)
        return irradiance_image(scene, mesh, map, o.rays, o.threads);
    Image image = radiance_image(scene, mesh, map, o.rays, o.threads);
    if (o.shows == MapView::mesh) draw_mesh(image, scene, mesh, o.rays, o.threads);
    return image;
}

// Completes the picture even after Ctrl-C, which only stops the search for light.  A second one
// kills.
Image picture_to_the_end(const RadiosityOptions& o, const Stage& stage, Solution& s) {
    Image image = picture_of(o, stage, s.map);
    while (interrupted) {  // rows are missing
        s.signal = interrupted.exchange(0);
        image = picture_of(o, stage, s.map);
    }
    return image;
}

// Renders the maps; returns the exit status.
int show_maps(const RadiosityOptions& o, const OptionTable& table, const Stage& stage,
              const std::vector<std::string>& outputs) {
    Solution s = solve(o, stage);
    if (s.empty() && s.signal) {
        tell(o, summary(o, stage.mesh, s));
        return 128 + s.signal;
    }
    const Image picture = picture_to_the_end(o, stage, s);
    const auto mean = mean_of_pixels(picture);
    const double exposure = double(stage.scene.exposure);
    write_images(outputs, picture,
                 o.shows == MapView::illuminance ? exposure / std::numbers::pi : exposure);
    if (!o.stats.empty()) write_file(o.stats, encode_stats(o, table, stage, s, mean));
    tell(o, summary(o, stage.mesh, s));
    tell_written(o, outputs);
    if (!stage.scene.lights.empty() && mean == std::array<double, 3>{}) tell_black(o);
    return s.signal ? 128 + s.signal : 0;
}

// Renders by paths that end on the maps; returns the exit status.  Particles and paths have keys of
// their own: they are independent.
int gather(const RadiosityOptions& o, const OptionTable& table, Stage& stage,
           const std::vector<std::string>& outputs) {
    NamedScene& scene = stage.scene;
    const Progress clock(0, true);
    Solution s = walk(o, stage, SamplerKind::halton, hash(o.seed, 1), walks_of(o, scene));
    Facts of_maps = {{"map_mesh", json::number(stage.H)},
                     {"map_triangles", std::to_string(stage.mesh.elements())},
                     {"map_particles", std::to_string(s.particles)},
                     {"map_error", json::number(s.stated.error)},
                     {"map_rays", std::to_string(s.rays)}};
    const KnownLight known = known_light(scene, std::move(stage.mesh), std::move(s.map));
    const double seconds = clock.elapsed();
    of_maps.push_back({"map_seconds", json::number(seconds)});
    // If no time is left, a tiny limit: 0 would be no limit.
    RadiosityOptions rest = o;
    if (o.seconds > 0) rest.seconds = std::max(1e-9, o.seconds - seconds);
    scene.depth = 1;
    const SamplerSettings settings = sampler_settings(o.sampler, o.seed, scene.depth);
    const SampleFunction L = final_gather(scene, o.technique, known, settings);
    Picture picture = render(rest, plan_of(rest, scene), L);
    picture.run.seconds += seconds, picture.run.rays += s.rays;
    picture.run.bias = "biased";
    picture.run.more = of_maps;
    return write_picture(o, table, scene, outputs, picture);
}

// The program; returns its exit status, throws UserError and SystemError.
int radiosity(const std::vector<std::string>& words) {
    RadiosityOptions o;
    OptionTable table = radiosity_table(o);
    parse_radiosity(table, o, words);
    if (print_manual(o, table, before_options, after_options)) return 0;
    const ParsedScene parsed = load(o);
    const double H = edge_length(o, parsed.scene, bytes_of(o));
    const auto outputs = outputs_of(o, parsed, "-radiosity", parsed.scene.size);
    catch_interrupt();
    for (const std::string& w : parsed.warnings) tell(o, o.scene + ": warning: " + w);
    Stage stage = stage_of(o, parsed.scene, H);
    return o.final_gather ? gather(o, table, stage, outputs) : show_maps(o, table, stage, outputs);
}

}  // namespace

int main(int argc, char** argv) try {
    return finished(radiosity({argv + 1, argv + argc}));
} catch (...) {
    return failed();
}
