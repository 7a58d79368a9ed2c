// app/render.h  4  from options to an image: a film, its target, its error, its file
//
// Films are kept in files if -DWITH_KEEP: with src/keep.  Light that samples may have missed is
// looked for if -DWITH_UNSEEN: with src/unseen.
#pragma once
#include <utility>

#include "app/options.h"
#include "app/outputs.h"
#include "app/threads.h"
#include "app/views.h"
#include "path/start.h"
#include "text/program.h"
#include "text/scene_file.h"

#ifdef WITH_KEEP
#include "keep/keep.h"
#else
namespace penumbra {
struct Keeper {
    Keeper(const std::string& path, const FilmOf&) {
        if (!path.empty()) throw UserError("--keep: this program was built without src/keep");
    }
    Spent restore(Film&) const { return {}; }
    void write_now_and_then(const Film&, const Spent&) {}
    std::string write(const Film&, const Spent&, bool) { return ""; }
};
}  // namespace penumbra
#endif

#ifdef WITH_UNSEEN
#include "unseen/unseen.h"
#else
namespace penumbra {
inline std::vector<std::string> hidden_lights(const NamedScene&) { return {}; }
struct Unseen {
    void add(const std::vector<NearMisses>&, double, double) {}
    std::string doubt(double, double, double) const { return ""; }
};
struct Witness {
    Witness(const Scene&, const Technique&, int, int, const std::vector<uint32_t>&) {}
    std::vector<NearMisses> near_misses(double) const { return {}; }
    std::vector<size_t> noisy() const { return {}; }
    static std::string why_unknown(const Film&, const ImageError&) { return ""; }
    NoVisitor visitor(Tally&) const { return {}; }
};
}  // namespace penumbra
#endif

namespace penumbra {

// ---- The scene ----------------------------------------------------------------------------------

// The scene with the user's options; throws UserError if it cannot be read or rendered.
inline ParsedScene load(const Options& o) {
    ParsedScene parsed = read_scene(o.scene);
    NamedScene& scene = parsed.scene;
    for (const std::string& hidden : hidden_lights(scene)) parsed.warnings.push_back(hidden);
    scene.size = o.size.value_or(scene.size);
    scene.depth = o.depth.value_or(scene.depth);
    if (o.view.scatters) scene.depth = 1;  // for the numbers of one direction
    if (o.view.of) scene.exposure = 1;     // a scene's own is meant for radiance
    if (o.exposure) scene.exposure = real(*o.exposure);
    for (size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].is_delta() && o.technique.light == LightMode::none)
            throw UserError(o.scene + ":" + std::to_string(scene.line_of_light[i]) +
                            ": --light none: rays never hit a " + name_of(scene.lights[i]) +
                            " light");
    if (o.rows && o.rows->last >= scene.size.height)
        throw UserError("--rows: the picture has rows 0-" + std::to_string(scene.size.height - 1));
    return parsed;
}

// ---- A picture ----------------------------------------------------------------------------------

inline RowRange rows_of(const Options& o, const Scene& scene) {
    return o.rows.value_or(RowRange{0, scene.size.height - 1});
}

// Replications of each pixel, by default: 2, and up to 8 in pictures of less than 400 pixels, whose
// error may be that of one pixel.  7 replications give its standard error as a quarter.
inline uint32_t replications_of(Size size) {
    return uint32_t(std::clamp(799 / (size.width * size.height) + 1, 2, 8));
}

// Samples of a pixel of mean noise, over those of a replication of weight 1.
inline uint64_t samples_for_one(const Plan& plan) {
    return plan.replications * (plan.is_adaptive ? typical_weight : 1);
}

// A scene without light is black, whatever error is asked for.  A witness observes the samples.
inline Plan plan_of(const Options& o, const Scene& scene, const Witness* witness = nullptr) {
    Plan plan;
    plan.error = scene.lights.empty() ? 0 : o.error, plan.seconds = o.seconds;
    const bool ends = o.spp > 0 || plan.seconds > 0 || plan.error > 0;
    const uint64_t N = ends ? o.spp : scene.samples;
    const uint32_t K = replications_of(scene.size);
    plan.replications = o.replications ? o.replications : N > 0 && N < K ? uint32_t(N) : K;
    plan.is_adaptive = o.replications == 0 && plan.replications == 2 && N != 2;
    plan.samples = (N + samples_for_one(plan) - 1) / samples_for_one(plan);
    plan.threads = o.threads;
    const RowRange rows = rows_of(o, scene);
    plan.size = {scene.size.width, rows.count()}, plan.first_row = rows.first;
    if (!witness) return plan;
    plan.noisy = witness->noisy();
    plan.may_miss_light = [](const Film& film, const ImageError& error) {
        return !Witness::why_unknown(film, error).empty();
    };
    plan.near = witness->near_misses(plan.replications * (plan.is_adaptive ? min_of_noisy : 1));
    return plan;
}

// The same where one sample of the film is the mean of all paths of a replication.
inline Plan plan_at_once(const Options& o, const Scene& scene) {
    Plan plan = plan_of(o, scene);
    plan.paths = std::exchange(plan.samples, 1);
    return plan;
}

// Throws UserError if memory has no room for the film.
inline Film film_for(const Plan& plan) {
    const double memory = bytes_of_machine();
    if (bytes_of(plan.size, plan.replications) > memory)
        throw UserError(std::to_string(plan.size.width) + "x" + std::to_string(plan.size.height) +
                        " pixels do not fit into the " + fixed(memory * 1e-9, 0) +
                        " GB of this machine: render fewer rows at a time (--rows)");
    Film film = make_film(plan.size, plan.replications, plan.is_adaptive, plan.first_row);
    film.near = plan.near;
    return film;
}

// "pixel 3,4 sample 5,1", or as options have it.
inline std::string in_words(const PixelSample& s, const char* pixel = "pixel ",
                            const char* sample = " sample ") {
    const std::string words =
        pixel + std::to_string(s.x) + "," + std::to_string(s.y) + sample + std::to_string(s.i);
    return s.set > 0 ? words + "," + std::to_string(s.set) : words;
}

// A NaN is an error and no black dot.
inline void check_finite(const Tally& t) {
    if (t.bad == 0) return;
    throw SystemError(counted(t.bad, "sample") + (t.bad == 1 ? " was" : " were") +
                      " not finite, the first at " + in_words(t.first_bad) + " (replay it by " +
                      in_words(t.first_bad, "--pixel ", " --sample ") + "); no result written");
}

// The results of a film.
inline Run run_of(const Film& film, const Plan& plan, const Spent& spent, Stop stop) {
    Run run;
    static_cast<Spent&>(run) = spent;
    if (film.has_samples()) run.spp = film.samples_per_pixel() * double(plan.paths);
    run.stopped_by = stop;
    run.error = error_of(film);
    run.doubt = in_words(doubt_of(film, run.error, plan.may_miss_light),
                         [&] { return Witness::why_unknown(film, run.error); });
    run.replications = film.replications;
    const uint64_t n = film.min_taken();
    if (n > 0 && n == film.max_taken() && !film.is_pilot &&
        (!plan.is_adaptive || film.pilot == std::min(n, pilot_samples)))
        run.repeat_spp = double(n * plan.paths * samples_for_one(plan));
    return run;
}

struct Picture {
    Image image;
    Run run;
    std::string not_kept;  // why the film was not written, if it should have been
};

// Fills a film until the plan's target is met; `look` sees it between passes.
using Look = std::function<void(const Film&, const Spent&)>;
inline Picture render(const Options& o, const Plan& plan, const Radiance& L,
                      const FilmOf& what = {}, const Look& look = {}) {
    Film film = film_for(plan);
    Keeper keeper(o.keep, what);
    const Spent before = keeper.restore(film);
    if (film.samples_per_pixel() > 0)
        tell(o, "resuming " + o.keep + " at " + significant(film.samples_per_pixel(), 3) +
                    " samples per pixel");
    Progress progress(plan.seconds, o.quiet, before.seconds);
    auto spent = [&](const Tally& tally) {
        return Spent{progress.elapsed(), before.cpu_seconds + cpu_seconds(),
                     before.rays + tally.rays};
    };
    Watch watch;
    watch.elapsed = [&] { return progress.elapsed(); };
    watch.for_each = by_workers;
    watch.interrupted = [] { return interrupted != 0; };
    watch.between = [&](const Film& f, const Tally& tally) {
        keeper.write_now_and_then(f, spent(tally));
        if (look) look(f, spent(tally));
    };
    watch.show = [&](double now, double end) {
        progress.show(now / end, fixed(now * double(plan.paths), 1) + " samples per pixel");
    };
    Loop loop(film, plan, L, watch);
    const Stop stop = loop.run();
    check_finite(loop.tally());
    Run run = run_of(film, plan, spent(loop.tally()), stop);
    run.is_radiance = !o.view.of;
    const std::string not_kept = keeper.write(film, run, !run.interrupted());
    film.deviation = std::vector<float>();  // makes room for the image
    return {image_of(film), run, not_kept};
}

// ---- A program that renders ---------------------------------------------------------------------

// Writes the image and the statistics, and prints the summary.  Returns the exit status.
inline int write_picture(const Options& o, const OptionTable& table, const Scene& scene,
                         const std::vector<std::string>& outputs, const Picture& picture) {
    const auto& [image, run, not_kept] = picture;
    if (run.spp > 0) {
        write_images(outputs, image, double(scene.exposure),
                     o.exposure ? Shades::as_they_are : o.view.shades);
        json::Object stats = asked_for(table, o.scene, {image.width, image.height});
        stats.add("depth", std::to_string(scene.depth));
        add_run(stats, run, {image.width, image.height});
        if (!o.stats.empty()) write_file(o.stats, stats.text());
    }
    tell(o, summary(o.scene, run, o.error));
    std::vector<std::string> files = outputs;
    if (!o.keep.empty() && not_kept.empty()) files.push_back(o.keep);
    if (run.spp > 0) tell_written(o, files);
    if (run.is_radiance && !o.rows && !scene.lights.empty() && run.error.norm() == 0) tell_black(o);
    if (!not_kept.empty()) throw SystemError(not_kept);
    return run.interrupted() ? 128 + interrupted : 0;
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

}  // namespace penumbra
