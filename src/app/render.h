// app/render.h  4  from options to an image: a film, its target, its error, its file
#pragma once
#include "app/keep.h"
#include "app/options.h"
#include "app/outputs.h"
#include "app/unseen.h"
#include "app/views.h"
#include "base/program.h"
#include "path/start.h"
#include "world/scene_file.h"

// ---- The scene ----------------------------------------------------------------------------------

// The scene with the user's options; throws UserError if it cannot be read or rendered.
inline ParsedScene load(const Options& o) {
    ParsedScene parsed = read_scene(o.scene);
    Scene& scene = parsed.scene;
    for (const std::string& hidden : hidden_lights(scene)) parsed.warnings.push_back(hidden);
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    if (o.view == View::occlusion) scene.depth = 1;    // for the numbers of one direction
    if (o.view != View::radiance) scene.exposure = 1;  // a scene's own is meant for radiance
    if (o.exposure) scene.exposure = real(*o.exposure);
    for (size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].kind == Light::Kind::point && o.technique.light == LightMode::none)
            throw UserError(o.scene + ":" + std::to_string(scene.line_of_light[i]) +
                            ": --light none: rays never hit a point light");
    if (o.rows && o.rows->last >= scene.size.height)
        throw UserError("--rows: the picture has rows 0-" + std::to_string(scene.size.height - 1));
    if (o.replay && (o.replay->x >= scene.size.width || o.replay->y >= scene.size.height))
        throw UserError("--pixel: outside the image");
    return parsed;
}

// ---- A picture ----------------------------------------------------------------------------------

// A scene without light is black, whatever error is asked for.
inline Plan plan_of(const Options& o, const Scene& scene) {
    const double error = scene.lights.empty() ? 0 : o.error;
    const bool ends = o.spp > 0 || o.seconds > 0 || error > 0;
    const uint64_t N = ends ? o.spp : scene.samples;
    // Two replications tell nothing of the noise of a picture of few pixels.
    const bool few = scene.size.width * scene.size.height < 16;
    const uint32_t most = N > 0 && N < least_of_noisy ? uint32_t(N) : least_of_noisy;
    const uint32_t sets = o.sets ? o.sets : N == 1 ? 1 : few ? most : 0;
    Plan plan{
        {samples_each(sets, N), o.seconds, error}, 1, o.threads, bytes_of_machine(), scene.size};
    plan.sets = sets;
    if (o.rows) plan.size.height = o.rows->count(), plan.first_row = o.rows->first;
    return plan;
}

// Throws UserError if memory has no room for the film.
inline Film film_for(const Plan& plan) {
    if (bytes_of(plan.size, std::max(2u, plan.sets)) > plan.memory)
        throw UserError(std::to_string(plan.size.width) + "x" + std::to_string(plan.size.height) +
                        " pixels do not fit into the " + fixed(plan.memory * 1e-9, 0) +
                        " GB of this machine: render fewer rows at a time (--rows)");
    Film film = make_film(plan.size, plan.sets, plan.first_row);
    film.evidence = plan.evidence;
    return film;
}

// A NaN is an error and no black dot.
inline void check_finite(const NonFinite& bad) {
    if (bad.count == 0) return;
    throw SystemError(counted(bad.count, "sample") + (bad.count == 1 ? " was" : " were") +
                      " not finite, the first at " + in_words(bad.first) + " (replay it by " +
                      in_words(bad.first, "--pixel ", " --sample ") + "); nothing was written");
}

// The results of a film.
inline Run run_of(const Film& film, const Plan& plan, const Spent& spent,
                  const ErrorChecks& checks) {
    Run run;
    static_cast<Spent&>(run) = spent;
    const bool all = film.pilot + film.least_taken() > 0;  // pixels have samples
    run.spp = all ? film.total() / double(film.pixels()) * double(plan.at_once) : 0;
    run.interrupted = interrupted;
    const bool all_taken = plan.target.samples > 0 && film.least_taken() == plan.target.samples;
    run.stopped_by = run.interrupted        ? "interrupt"
                     : checks.is_enough()   ? "error"
                     : checks.is_hopeless() ? "error not known"
                     : all_taken            ? "samples"
                                            : "time";
    run.error = error_of(film);
    run.doubt = doubt_of(film, run.error, plan.judge);
    run.sets = film.replications_per_pixel();
    run.exponent_of_cost = 1 / checks.history().exponent();
    return run;
}

struct Picture {
    Image image;
    Run run;
    std::string not_kept;  // why the film was not written, if it should have been
};

// Fills a film until the plan's target is met.
inline Picture render(const Options& o, const Plan& plan, const Radiance& L,
                      const FilmOf& what = {}) {
    Film film = film_for(plan);
    Keeper keeper(o.keep, what);
    const Spent before = keeper.restore(film);
    if (film.total() > 0)
        tell(o, "resuming " + o.keep + " at " +
                    significant(film.total() / double(film.pixels()), 3) + " samples per pixel");
    Progress progress(plan.target.seconds, o.quiet, before.seconds);
    ErrorChecks checks(plan.target.error, plan.period, plan.judge);
    Watch watch;
    Loop loop(film, plan, L, watch);
    auto spent = [&] {
        return Spent{progress.elapsed(), before.cpu_seconds + cpu_seconds(),
                     before.rays + loop.rays()};
    };
    watch.elapsed = [&] { return progress.elapsed(); };
    watch.between = [&](const Film& f) {
        if (!interrupted) keeper.write_now_and_then(f, spent());
        return checks.next(f);
    };
    watch.show = [&](double now, double all) {
        if (all == 0) all = HUGE_VAL;
        all = std::min(all, checks.expected() * film.replications_per_pixel());
        progress.show(now / all, fixed(now * double(plan.at_once), 1) + " samples per pixel");
    };
    loop.run();
    check_finite(loop.non_finite());
    if (loop.most_sets_chosen() < Allocation().most)
        tell(o, "a pixel has at most " + std::to_string(loop.most_sets_chosen()) +
                    " replications: more do not fit into memory");
    Run run = run_of(film, plan, spent(), checks);  // once: a signal may come at any time
    run.is_radiance = o.view == View::radiance;
    return {image_of(film), run, keeper.write(film, run, !run.interrupted)};
}

// ---- A program that renders ---------------------------------------------------------------------

// Writes the image and the statistics, and prints the summary.  Returns the exit status.
inline int write_picture(const Options& o, const OptionTable& table, const Scene& scene,
                         const std::vector<std::string>& outputs, const Picture& picture) {
    const auto& [image, run, not_kept] = picture;
    if (run.spp > 0) {
        write_images(outputs, image, double(scene.exposure), o.exposure ? View::radiance : o.view);
        json::Object stats = asked_for(table, o.scene, {image.width, image.height});
        stats.add("depth", std::to_string(scene.depth));
        add_run(stats, run, {image.width, image.height});
        if (!o.stats.empty()) write_file(o.stats, stats.text());
    }
    tell(o, summary(o.scene, run, o.error));
    std::vector<std::string> files = outputs;
    if (!o.keep.empty() && not_kept.empty()) files.push_back(o.keep);
    if (run.spp > 0) tell_written(o, files);
    if (o.view == View::radiance && !o.rows && !scene.lights.empty() && run.error.norm == 0)
        tell_black(o);
    if (!not_kept.empty()) throw SystemError(not_kept);
    return run.interrupted ? 128 + interrupted : 0;
}

// Images to write: none by default if it is a band, which is for build/merge.  A view has a file of
// its own.
inline std::vector<std::string> outputs_of(const Options& o, const ParsedScene& parsed,
                                           const std::string& suffix, Size size) {
    std::vector<std::string> kept;
    if (!o.keep.empty()) kept.push_back(o.keep);
    const std::string stem = o.rows ? "" : "out/NAME" + suffix + suffix_of(o.view);
    return outputs_of(o, stem, parsed.files, kept, size);
}
