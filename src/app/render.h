// app/render.h  4  from a plan to an image: a film, its error, its file
//
// Films are kept in files if -DWITH_KEEP: with src/keep.
#pragma once
#include "app/outputs.h"
#include "app/plan.h"
#include "app/threads.h"

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

namespace penumbra {

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
    return s.replication > 0 ? words + "," + std::to_string(s.replication) : words;
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
                         [&] { return LightRecorder::why_unknown(film, run.error); });
    run.replications = film.replications;
    const uint64_t n = film.min_samples_done();
    if (n > 0 && n == film.max_samples_done() && !film.is_pilot &&
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
inline Picture render(const Options& o, const Plan& plan, const SampleFunction& L,
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
    film.pilot_deviation = std::vector<float>();  // makes room for the image
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
