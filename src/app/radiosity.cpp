// app/radiosity.cpp  6  the program: a scene's illumination maps, and what its camera sees of them
#include "app/help.h"
#include "app/mesh_view.h"
#include "app/outputs.h"
#include "app/radiosity_options.h"
#include "app/walks.h"
#include "base/program.h"
#include "radiosity/shooting.h"

namespace {

constexpr const char* before_options =
    "usage: radiosity [options] SCENE\n\nFinds the illumination of SCENE (a file in the format of "
    "scenes/*.scene, all of\nit diffuse), on triangles that its faces are cut into, and draws what "
    "its camera\nsees of them.  Light is scattered without end, whatever the scene's depth.\n\n";

constexpr const char* after_options = R"(
A .pfm holds linear radiance; a .png holds exposure times radiance, clamped to
[0,1] and encoded as sRGB.  Pixel (0,0) is the top left one.

Exit status: 0 done; 1 a file could not be written; 2 the scene or an option
cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM, 129 SIGHUP), after
writing the image of the light found so far.
)";

// ---- What is measured ---------------------------------------------------------------------------

// What a method has found; NaN: it does not say.
struct Solution {
    IlluminationMap map;
    uint64_t shots = 0, particles = 0, rays = 0;
    double unshot = NAN, seconds = 0;
    MapError stated = {};  // of shooting, at most that
    int signal = 0;        // that cut it short
    bool empty() const { return shots == 0 && particles == 0; }
};

std::string shot(uint64_t shots, double unshot) {
    return std::to_string(shots) + " shots, " + percent(unshot) + " unshot";
}

// What ended the run; "": there was no light left, or none at all.
std::string stopped_by(const RadiosityOptions& o, const Solution& s) {
    if (s.signal) return "signal";
    if (o.error > 0 &&
        (is_random(o) ? ErrorTarget(o.error).met(s.stated) : s.stated.error <= o.error))
        return "--error";
    if (o.unshot > 0 && s.unshot <= o.unshot) return "--unshot";
    if (o.shots > 0 && s.shots >= o.shots) return "--shots";
    if (o.particles > 0 && s.particles >= o.particles) return "--particles";
    return o.seconds > 0 && s.seconds >= o.seconds ? "--time" : "";
}

std::string words_of_error(const RadiosityOptions& o, const Solution& s) {
    if (!std::isfinite(s.stated.error)) return ", error not known";
    const std::string own = o.error > 0 ? " without that of the triangles" : "";
    return (is_random(o) ? "" : ", error at most " + percent(s.stated.error)) + own;
}

std::string summary(const RadiosityOptions& o, const Mesh& mesh, const Solution& s) {
    const std::string what = stopped_by(o, s);
    const std::string by = s.signal                       ? " (interrupted)"
                           : o.error > 0 && !what.empty() ? " (stopped by " + what + ")"
                                                          : "";
    return o.scene + ": " + std::to_string(mesh.elements()) + " triangles, " +
           (is_random(o) ? walked(s.particles, s.stated) : shot(s.shots, s.unshot)) +
           words_of_error(o, s) + ", " + fixed(s.seconds, 2) + " s, " +
           fixed(double(s.rays) / s.seconds * 1e-6, 2) + " Mrays/s" + by;
}

// ---- The scene ----------------------------------------------------------------------------------

struct Stage {
    Scene scene;  // of triangles
    Mesh mesh;
    double H = 0;      // longest edge
    double bytes = 0;  // of mesh and solution
};

Bytes bytes_of(const RadiosityOptions& o) {
    return is_random(o) ? Particles::bytes() : Shooting::bytes();
}

Stage stage_of(const RadiosityOptions& o, const Scene& scene, double H) {
    auto [facets, warnings] = faceted(scene, H);
    for (const std::string& w : warnings) tell(o, o.scene + ":" + w);
    Stage stage{std::move(facets), {}, H, bytes_of(o).of(sizes(scene, H))};
    stage.mesh = make_mesh(stage.scene, H);
    return stage;
}

// Throws UserError if Shooting::error would stay 1 whatever is shot.
void check_bounded(const std::string& name, const Scene& scene) {
    if (const uint32_t line = line_of_white(scene))
        throw UserError("--error: " + name + ":" + std::to_string(line) +
                        ": reflects all light, so nothing bounds what is not yet sent: say "
                        "--method particles");
}

// ---- Methods ------------------------------------------------------------------------------------

Solution shoot(const RadiosityOptions& o, const Stage& stage) {
    const Shooter shooter = o.method == Method::shooting ? Shooter::element : Shooter::face;
    Shooting solver(stage.scene, stage.mesh, shooter, o.threads);
    Progress progress(o.seconds, o.quiet);
    solver.run({o.unshot, o.seconds, o.shots, o.error}, [&](const Shooting& now) {
        const double unshot = now.unshot();
        // It falls by about the same factor from shot to shot.
        double done = o.shots ? double(now.shots()) / double(o.shots) : 0;
        if (o.unshot > 0 && o.unshot < 1 && unshot > 0)
            done = std::max(done, std::log(unshot) / std::log(o.unshot));
        if (o.error > 0) done = std::max(done, std::log(now.error()) / std::log(o.error));
        progress.show(done, shot(now.shots(), unshot));
    });
    Solution s{solver.map()};
    s.shots = solver.shots(), s.rays = solver.rays(), s.unshot = solver.unshot();
    s.stated.error = solver.error();
    s.seconds = progress.elapsed();
    return s;
}

Solution walk(const RadiosityOptions& o, const Stage& stage) {
    const Pattern pattern = Particles::pattern(o.sampler, o.seed, o.particles);
    Walked w = walk_all(stage.scene, stage.mesh, pattern, {o.particles, o.seconds, o.error}, o);
    Solution s{std::move(w.map)};
    s.particles = w.particles, s.rays = w.rays, s.stated = w.stated, s.seconds = w.seconds;
    return s;
}

Solution solve(const RadiosityOptions& o, const Stage& stage) {
    Solution s = is_random(o) ? walk(o, stage) : shoot(o, stage);
    s.signal = interrupted;
    return s;
}

// ---- Images and statistics ----------------------------------------------------------------------

Image picture_of(const RadiosityOptions& o, const Stage& stage, const IlluminationMap& map) {
    const auto& [scene, mesh, H, bytes] = stage;
    if (o.view == MapView::illuminance)
        return irradiance_image(scene, mesh, map, o.rays, o.threads);
    Image image = radiance_image(scene, mesh, map, o.rays, o.threads);
    if (o.view == MapView::mesh) draw_mesh(image, scene, mesh, o.rays, o.threads);
    return image;
}

// The picture to its end even after Ctrl-C, which ends the search for light alone; a second one
// kills.
Image picture_to_the_end(const RadiosityOptions& o, const Stage& stage, Solution& s) {
    Image image = picture_of(o, stage, s.map);
    while (interrupted) {  // rows are missing
        s.signal = interrupted.exchange(0);
        image = picture_of(o, stage, s.map);
    }
    return image;
}

std::string encode_stats(const RadiosityOptions& o, const Stage& stage, const Solution& s,
                         const std::array<double, 3>& mean) {
    const Mesh& mesh = stage.mesh;
    json::Object object = asked_for(o, radiosity_table, stage.scene.size);
    auto count = [](auto n) { return std::to_string(n); };
    object.add("rays_per_pixel", count(o.rays * o.rays));
    object.add("mesh", json::number(stage.H));
    object.add("faces", count(mesh.faces.size()));
    object.add("elements", count(mesh.elements()));
    object.add("vertices", count(mesh.vertices()));
    object.add("bytes", json::number(stage.bytes));
    object.add("precision", sizeof(real) == 4 ? "\"float\"" : "\"double\"");
    object.add("interrupted", json::truth(s.signal != 0));
    object.add("shots", count(s.shots));
    object.add("unshot", json::number(s.unshot));
    object.add("particles", count(s.particles));
    object.add("error", json::number(s.stated.error));
    object.add("error_uncertainty", json::number(s.stated.uncertainty));
    object.add("error_asked", o.error > 0 ? json::number(o.error) : "null");
    const std::string by = stopped_by(o, s);
    object.add("stopped_by", by.empty() ? "null" : json::string(by));
    object.add("seconds", json::number(s.seconds));
    object.add("cpu_seconds", json::number(cpu_seconds()));
    object.add("rays", count(s.rays));
    object.add("mrays_per_second", json::number(double(s.rays) / s.seconds * 1e-6));
    object.add("mean_of_image", json::numbers(mean));
    object.add("peak_memory_bytes", count(peak_memory_bytes()));
    return object.text();
}

void write(const RadiosityOptions& o, const Stage& stage, Solution& s,
           const std::vector<std::string>& outputs) {
    const Image picture = picture_to_the_end(o, stage, s);
    const auto mean = mean_of_pixels(picture);
    const real exposure = stage.scene.exposure;
    write_images(outputs, picture, o.view == MapView::illuminance ? exposure / pi : exposure);
    if (!o.stats.empty()) write_file(o.stats, encode_stats(o, stage, s, mean));
    tell(o, summary(o, stage.mesh, s));
    tell_written(o, outputs);
    if (!stage.scene.lights.empty() && mean == std::array<double, 3>{}) tell_black(o);
}

// The program; returns its exit status, throws UserError and SystemError.
int radiosity(const std::vector<std::string>& words) {
    const RadiosityOptions o = parse_radiosity(words);
    if (o.help) {
        std::printf("%s%s%s", before_options, option_lines(radiosity_table).c_str(), after_options);
        return 0;
    }
    ParsedScene parsed = read_scene(o.scene);
    parsed.scene.size = o.size.value_or(parsed.scene.size);
    parsed.scene.exposure = o.exposure.value_or(parsed.scene.exposure);
    if (o.error > 0 && !is_random(o)) check_bounded(o.scene, parsed.scene);
    const double H = edge_length(o.scene, parsed.scene, o.mesh, 32, bytes_of(o));
    const std::vector<std::string> outputs =
        outputs_of(o, "-radiosity", {{parsed.files}}, parsed.scene.size);
    catch_interrupt();
    for (const std::string& w : parsed.warnings) tell(o, o.scene + ": warning: " + w);
    const Stage stage = stage_of(o, parsed.scene, H);
    Solution s = solve(o, stage);
    if (s.empty() && s.signal)
        tell(o, summary(o, stage.mesh, s));
    else
        write(o, stage, s, outputs);
    return s.signal ? 128 + s.signal : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return radiosity({argv + 1, argv + argc}); });
}
