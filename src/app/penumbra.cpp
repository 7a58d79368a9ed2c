// app/penumbra.cpp  5  the program: options in, images and statistics out
#include "app/help.h"
#include "app/replay.h"
#include "base/program.h"
#include "world/scene_file.h"

namespace {

// The scene that the user asks for; throws UserError if it is not to be had.
Scene load(const Options& o) {
    auto [scene, warnings] = read_scene(o.scene);
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    scene.exposure = o.exposure.value_or(default_exposure(scene, o.view));
    for (Light& l : scene.lights) l.by_angle = o.polygons == Polygons::angle;
    for (const Light& l : scene.lights)
        if (l.kind == Light::Kind::point && o.technique.light == LightMode::none)
            throw UserError("--light none: rays never hit the point light of " + o.scene);
    if (o.replay && (o.replay->x >= scene.size.width || o.replay->y >= scene.size.height))
        throw UserError("--pixel: outside the image");
    if (!o.quiet)
        for (const std::string& w : warnings)
            std::fprintf(stderr, "%s: warning: %s\n", o.scene.c_str(), w.c_str());
    return scene;
}

// Images to write; throws UserError if one of the files cannot be written.
std::vector<std::string> outputs_of(const Options& o) {
    std::vector<std::string> outputs = o.outputs;
    std::error_code failed;
    if (outputs.empty()) {
        const std::string stem = "out/" + std::filesystem::path(o.scene).stem().string();
        outputs = {stem + ".png", stem + ".pfm"};
        if (std::filesystem::create_directories("out", failed), failed)
            throw UserError("out: cannot make this directory: " + failed.message());
    }
    for (const std::string& path : outputs) check_writable(path);
    if (!o.stats.empty()) check_writable(o.stats);
    return outputs;
}

// The program; returns its exit status, throws UserError and SystemError.
int penumbra(const std::vector<std::string>& words) {
    const Options o = parse_options(words);
    if (o.help) {
        std::fputs(help_page().c_str(), stdout);
        return 0;
    }
    const Scene scene = load(o);
    const Job job = job_of(o, scene);
    if (o.replay) {
        replay(job);
        return 0;
    }
    if (o.view == View::variance && job.passes.target.samples == 1)
        throw UserError("--view variance: needs --spp 2 or more");
    catch_interrupt();
    const std::vector<std::string> outputs = outputs_of(o);
    const auto [image, variance, run] = rendered(job);
    if (o.view == View::variance && run.spp == 1)
        throw UserError("--view variance: one sample has no variance; nothing was written");
    if (run.spp == 0) return 130;
    for (const std::string& path : outputs)
        write_image(path, o.view == View::variance ? variance : image, double(scene.exposure));
    if (!o.stats.empty())
        write_file(o.stats, encode_stats(o, scene.size, scene.depth, run, image, variance));
    return run.interrupted ? 130 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return penumbra({argv + 1, argv + argc}); });
}
