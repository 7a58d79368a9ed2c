// app/penumbra.cpp  10  the program: options in, images and statistics out
#include "app/help.h"
#include "app/option_checks.h"
#include "app/outputs.h"
#include "app/render.h"
#include "app/replay.h"
#include "base/program.h"
#include "world/scene_file.h"

namespace {

constexpr const char* before_options =
    "usage: penumbra [options] SCENE\n\nRenders SCENE (a file in the format of scenes/*.scene) "
    "by path tracing.\n\n";

constexpr const char* after_options = R"(
A .pfm holds linear radiance; a .png holds exposure times radiance, clamped to
[0,1] and encoded as sRGB.  Pixel (0,0) is the top left one.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM,
129 SIGHUP), after writing the image of the passes completed so far.
)";

// The scene that the user asks for; throws UserError if it is not to be had.
ParsedScene load(Options& o) {
    ParsedScene parsed = read_scene(o.scene);
    Scene& scene = parsed.scene;
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    scene.exposure = o.exposure.value_or(default_exposure(scene, o.view));
    for (Light& l : scene.lights) l.by_angle = o.polygons == Polygons::angle;
    for (size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].kind == Light::Kind::point && o.technique.light == LightMode::none)
            throw UserError(o.scene + ":" + std::to_string(scene.line_of_light[i]) +
                            ": --light none: rays never hit a point light");
    if (!o.replay) check_memory(part_of(o, scene, target_of(o, scene).samples), bytes_of_machine());
    if (o.replay && (o.replay->x >= scene.size.width || o.replay->y >= scene.size.height))
        throw UserError("--pixel: outside the image");
    // Coarser than build/radiosity's: after a bounce its triangles are not seen, noise is (by
    // `make indirect`).
    if (has_maps(o)) o.mesh = edge_length(o.scene, scene, o.mesh, 16, Particles::bytes());
    return parsed;
}

// What is rendered, and the maps on which its paths end, if they do.
struct Stage {
    Scene scene;
    std::optional<Maps> maps;
};

Stage stage_of(const Options& o, const Scene& scene) {
    if (!has_maps(o)) return {scene, {}};
    auto [facets, warnings] = endless(scene, *o.mesh);
    for (const std::string& w : warnings) tell(o, o.scene + ":" + w);
    Stage stage{std::move(facets), {}};
    stage.maps = maps_of(o, stage.scene);
    return stage;
}

// Writes all that was asked for, and says so.
void write(const Options& o, const Scene& scene, const Rendered& rendered,
           const std::vector<std::string>& outputs) {
    const auto& [image, run, not_kept] = rendered;
    write_images(outputs, image, scene.exposure);
    const Size size = {image.width, image.height};
    if (!o.stats.empty()) write_file(o.stats, encode_stats(o, size, scene.depth, run));
    if (run.maps) tell(o, summary(*run.maps));
    tell(o, summary(o, run));
    std::vector<std::string> files = outputs;
    if (!o.checkpoint.empty() && not_kept.empty()) files.push_back(o.checkpoint);
    tell_written(o, files);
    if (o.view == View::radiance && !o.rows && !scene.lights.empty() &&
        run.mean_radiance == std::array<double, 3>{})
        tell_black(o);
}

// Images to write, unless it is a part that is for build/merge alone.
std::vector<std::string> outputs_for(const Options& o, const std::vector<std::string>& inputs,
                                     Size size) {
    std::vector<UsedFiles> used{{inputs}, {{}, "a checkpoint"}};
    for (const std::string& film : {o.checkpoint, o.resume})
        if (!film.empty()) used.back().paths.push_back(film);
    check_names(o.outputs, o.stats, used);
    if (!o.checkpoint.empty()) check_film(o.checkpoint);
    const bool is_part = (o.rows || o.samples) && o.outputs.empty();
    if (!is_part)
        return outputs_of(o, "", used, o.rows ? Size{size.width, int(o.rows->count())} : size);
    if (!o.stats.empty()) check_writable(o.stats);
    return {};
}

// The program; returns its exit status, throws UserError and SystemError.
int penumbra(const std::vector<std::string>& words) {
    Options o = parse_options(words);
    if (o.help) {
        std::printf("%s%s%s", before_options, option_lines(option_table).c_str(), after_options);
        return 0;
    }
    const auto [read, warnings, inputs] = load(o);
    std::vector<std::string> outputs;
    if (!o.replay) {
        outputs = outputs_for(o, inputs, read.size);
        catch_interrupt();
    }
    for (const std::string& w : warnings) tell(o, o.scene + ": warning: " + w);
    const auto [scene, maps] = stage_of(o, read);
    const Job job = maps ? job_of(o, scene, *maps) : job_of(o, scene);
    if (o.replay) {
        replay(job);
        return 0;
    }
    const bool is_kept = !o.checkpoint.empty() || !o.resume.empty();
    const Rendered result =
        rendered(job, is_kept ? identity_of(job, sum_of_files(inputs)) : FilmHeader());
    if (result.run.spp > 0)
        write(o, scene, result, outputs);
    else
        tell(o, summary(o, result.run));
    if (!result.not_kept.empty()) throw SystemError(result.not_kept);
    return result.run.interrupted ? 128 + interrupted : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return penumbra({argv + 1, argv + argc}); });
}
