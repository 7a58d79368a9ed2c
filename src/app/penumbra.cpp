// app/penumbra.cpp  5  the program: options in, images and statistics out
#include "app/help.h"
#include "app/replay.h"
#include "base/program.h"
#include "world/scene_file.h"

namespace {

void tell(const Options& o, const std::string& line) {
    if (!o.quiet) std::fprintf(stderr, "%s\n", printable(line).c_str());
}

// The scene that the user asks for; throws UserError if it is not to be had.
ParsedScene load(const Options& o) {
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
    if (o.replay && (o.replay->x >= scene.size.width || o.replay->y >= scene.size.height))
        throw UserError("--pixel: outside the image");
    if (o.view == View::variance && target_of(o, scene).samples == 1)
        throw UserError("--view variance: needs --spp 2 or more");
    return parsed;
}

// Throws UserError if two different things would have the name of one file, or one would replace
// what the scene is read from.
void check_names(const std::vector<std::string>& images, const std::string& stats,
                 const std::vector<std::string>& inputs) {
    std::map<std::string, std::string> use;  // of a file
    for (const std::string& path : inputs) use[true_name(path)] = "part of the scene";
    auto check = [&](const std::string& path, const std::string& as) {
        const auto [place, is_new] = use.try_emplace(true_name(path), as);
        if (!is_new && place->second != as)
            throw UserError(path + ": cannot be both " + place->second + " and " + as);
    };
    for (const std::string& path : images)
        check(path, "a " + path.substr(path.size() - 4) + " image");
    if (!stats.empty()) check(stats, "the statistics");
}

// Images to write; throws UserError if one of the files cannot be written.
std::vector<std::string> outputs_of(const Options& o, const std::vector<std::string>& inputs) {
    std::vector<std::string> outputs = o.outputs;
    std::error_code failed;
    if (outputs.empty()) {
        const std::string stem = "out/" + std::filesystem::path(o.scene).stem().string();
        outputs = {stem + ".png", stem + ".pfm"};
        if (std::filesystem::create_directories("out", failed), failed)
            throw UserError("out: cannot make this directory: " + failed.message());
    }
    check_names(outputs, o.stats, inputs);
    for (const std::string& path : outputs) check_writable(path);
    if (!o.stats.empty()) check_writable(o.stats);
    return outputs;
}

// Writes all that was asked for, and says so.
void write(const Options& o, const Scene& scene, const Rendered& rendered,
           std::vector<std::string> outputs) {
    const auto& [image, variance, run] = rendered;
    const Image& picture = o.view == View::variance ? variance : image;
    if (const auto at = first_non_finite(picture))
        throw SystemError("pixel " + *at + " is more than a file can hold; nothing was written");
    for (const std::string& path : outputs) write_image(path, picture, double(scene.exposure));
    if (!o.stats.empty()) {
        write_file(o.stats, encode_stats(o, scene.size, scene.depth, run));
        outputs.push_back(o.stats);
    }
    tell(o, summary(o.scene, run));
    std::string names;
    for (const std::string& path : outputs) names += (names.empty() ? "" : ", ") + path;
    tell(o, "wrote " + names);
    if (o.view == View::radiance && !scene.lights.empty() &&
        run.mean_radiance == std::array<double, 3>{})
        tell(o, o.scene + ": all is black: no light reaches the camera (lights emit on one side " +
                    "only, unless they are twosided)");
}

// The program; returns its exit status, throws UserError and SystemError.
int penumbra(const std::vector<std::string>& words) {
    const Options o = parse_options(words);
    if (o.help) {
        std::fputs(help_page().c_str(), stdout);
        return 0;
    }
    const auto [scene, warnings, inputs] = load(o);
    const Job job = job_of(o, scene);
    std::vector<std::string> outputs;
    if (!o.replay) {
        outputs = outputs_of(o, inputs);
        catch_interrupt();
    }
    for (const std::string& w : warnings) tell(o, o.scene + ": warning: " + w);
    if (o.replay) {
        replay(job);
        return 0;
    }
    const Rendered result = rendered(job);
    if (o.view == View::variance && result.run.spp == 1)
        throw UserError("--view variance: one sample has no variance; nothing was written");
    if (result.run.spp > 0)
        write(o, scene, result, outputs);
    else
        tell(o, summary(o.scene, result.run));
    return result.run.interrupted ? 128 + interrupted : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return penumbra({argv + 1, argv + argc}); });
}
