// app/filling.h  8  a film on its way to the target: passes, sets, looks at the error, checkpoints
#pragma once
#include <atomic>

#include "app/checkpoints.h"
#include "app/outputs.h"

struct Rendered {
    Image image;  // of what --view asks for
    RunStats run;
    std::string not_kept;  // why there is no checkpoint, if one was wanted
};

// Throws if a sample did not fit into the film; in_picture(its place) is one of the picture.
template <class Pixel, class InPicture>
void check_finite(const Film<Pixel>& film, InPicture in_picture) {
    if (film.non_finite() == 0) return;
    const NonFinite& bad = film.first_non_finite();
    const PixelSample s = in_picture(bad.x, bad.y, bad.sample, bad.set);
    const std::string pixel = std::to_string(s.x) + "," + std::to_string(s.y);
    const std::string sample = std::to_string(s.i);
    throw SystemError(std::to_string(film.non_finite()) +
                      " samples were not finite, the first at pixel " + pixel + " sample " +
                      sample + " (replay it by --pixel " + pixel + " --sample " + sample +
                      (s.set ? " --set " + std::to_string(s.set) : "") + "); nothing was written");
}

// radiance_of_block() is an L(sample, rays) for one thread, which counts its rays; count(run) adds
// what else it counts.
template <class Pixel, class RadianceOfBlock, class Count>
class Filling {
public:
    Filling(const Job& job, const FilmHeader& identity, const typename Pixel::Value& value,
            RadianceOfBlock radiance_of_block, Count count)
        : job_(job),
          value_(value),
          radiance_of_block_(radiance_of_block),
          count_(count),
          film_(job.part.size(), value,
                job.o.view == View::variance ? Shows::variances : Shows::values),
          checkpoints_(job, identity),
          before_(resumed()),
          progress_(job.passes.target, job.o.quiet, before_.seconds),
          rays_(before_.rays) {}

    Rendered fill() {
        if (!film_.has_sets() && sets_of(job_.o) != sets_by_noise)
            film_.add_sets(std::vector<Sets>(film_.number_of_pixels(), {sets_of(job_.o)}));
        if (!film_.has_sets() && needs_scouts()) choose_sets(samples_to_choose(job_));
        const auto unfinished = unfinished_pass();
        if (!unfinished || add(*unfinished))
            render(film_, job_.passes, adder(), progress_,
                   [&](const Film<Pixel>&) { return between(); });
        if (!needs_scouts()) choose_sets(film_.samples());
        check_finite(film_, [&](auto... at) { return in_picture(job_.part, at...); });
        Rendered r{{}, stats(), {}};
        try {
            // A film without samples replaces none.
            const bool is_empty = film_.samples() == 0 && !film_.unfinished_pass();
            const bool is_worth_it = !is_empty || !checkpoints_.are_there();
            if (checkpoints_.are_wanted() && is_worth_it)
                checkpoints_.write(film_.state(), r.run, !r.run.interrupted);
        } catch (const SystemError& e) {
            r.not_kept = e.what();
        }
        r.image = film_.take_image();
        return r;
    }

private:
    const Job& job_;
    const typename Pixel::Value value_;
    RadianceOfBlock radiance_of_block_;
    Count count_;
    Film<Pixel> film_;
    Checkpoints checkpoints_;
    const RunStats before_;  // what runs before this one measured
    SampleProgress progress_;
    ErrorCourse course_;
    bool enough_ = false;
    std::atomic<uint64_t> rays_;

    // ---- Passes ----

    // Adds to a block of a film; in_picture(x, y, i, set) is the sample of the picture.
    template <class InPicture>
    void add_block(Film<Pixel>& film, size_t block, uint64_t n, InPicture in_picture) {
        uint64_t rays = 0;
        auto L = radiance_of_block_();
        film.add_block(block, n, [&](int x, int y, uint64_t i, uint32_t set) {
            return L(in_picture(x, y, i, set), rays);
        });
        rays_ += rays;
    }
    auto adder() {
        return [this](size_t block, uint64_t n) {
            add_block(film_, block, n, [&](auto... at) { return in_picture(job_.part, at...); });
        };
    }
    // Sets that were added and have no samples yet are one, too, of no samples more.
    std::optional<uint64_t> unfinished_pass() const {
        const auto pass = film_.unfinished_pass();
        const bool lacks_others = film_.has_sets() && !film_.others_are_complete();
        return lacks_others && !pass ? 0 : pass;
    }
    bool add(uint64_t n) { return add_pass(film_, n, job_.passes.threads, adder(), progress_); }

    // How many samples the next pass may bring.
    uint64_t between() {
        const auto& [target, period, threads, pause] = job_.passes;
        const uint64_t samples = film_.samples();
        if (samples >= pause) {
            choose_sets(samples);
            if (film_.non_finite() > 0 || interrupted) return 0;
            const bool looks = target.error > 0 && next_look(samples - 1, pause, period) == samples;
            if (looks || course_.is_due(samples)) look(error_of(film_), looks);
        }
        const double seconds = progress_.elapsed() - before_.seconds;
        if (checkpoints_.is_due(seconds) && !interrupted)
            checkpoints_.write_meanwhile(film_.state(), stats(), seconds);
        if (enough_) return 0;
        const bool looking = target.error > 0 && samples >= pause;
        return looking ? next_look(samples, pause, period) - samples : UINT64_MAX;
    }

    void look(const ImageError& e, bool may_be_enough) {
        const double wanted = job_.passes.target.error;
        const uint64_t samples = film_.samples();
        course_.add(samples, e.d_rel());
        if (!may_be_enough) return;
        enough_ = is_small_enough(e, wanted);
        // It is dark, and will stay so.
        if (e.norm == 0 && job_.scene.lights.empty()) enough_ = true;
        const double all = double(samples) * course_.cost_of(std::max(1.0, e.d_rel() / wanted));
        progress_.expect(std::max(samples, all < 1e18 ? uint64_t(all) : 0));
    }

    RunStats stats() {
        const Target& target = job_.passes.target;
        RunStats run = before_;
        run.spp = film_.samples(), run.seconds = progress_.elapsed(), run.rays = rays_;
        run.cpu_seconds += cpu_seconds();
        count_(run);
        run.non_finite = film_.non_finite(), run.interrupted = interrupted;
        run.stopped_by = enough_ ? "error" : run.spp == target.samples ? "samples" : "time";
        if (run.interrupted) run.stopped_by = "interrupt";
        const ErrorTerms terms = film_.terms();
        for (size_t c = 0; c < 3; ++c) run.mean_radiance[c] = terms.sum[c] / double(terms.pixels);
        run.error = terms.error();
        run.sets = film_.sets_per_pixel();
        ErrorCourse course = course_;
        if (course.is_due(run.spp)) course.add(run.spp, run.error.d_rel());
        run.exponent_of_cost = 1 / course.exponent();
        return run;
    }

    // ---- Sets of samples, where noise is ----

    // Whether sets are chosen by samples that are not in this film.
    bool needs_scouts() const {
        const Part& part = job_.part;
        return part.first_sample > 0 ||
               (part.samples != part.total && part.samples < samples_to_choose(job_));
    }

    // Once, by the noise of n samples.
    void choose_sets(uint64_t n) {
        if (film_.has_sets() || n < 2 || interrupted || film_.non_finite() > 0) return;
        const Part& part = job_.part;
        const auto seen = noise(n);
        if (interrupted) return;
        auto by = [&](const Allocation& a) {
            return sets_where_noise_is(seen.first, part.first_row, part.rows, seen.second,
                                       job_.o.seed, a);
        };
        std::vector<Sets> sets = by({});
        // If hardly any time is left, those alone that measure; but a film that is kept has those
        // of a run without a break.
        const double limit = job_.passes.target.seconds, elapsed = progress_.elapsed();
        if (!checkpoints_.are_wanted() && limit > 0 &&
            (mean_count(sets) - 1) * elapsed > limit - elapsed)
            sets = by({.most = 1});
        film_.add_sets(std::move(sets));
        if (film_.samples() > 0) add(0);
    }

    // Of the part's rows and those next to it, and of the survey.
    std::pair<NoiseOfRows, NoiseElsewhere> noise(uint64_t n) {
        const Part& part = job_.part;
        const Size picture = part.picture;
        const size_t width = size_t(picture.width);
        const int first = std::max(0, part.first_row - 1),
                  end = std::min(picture.height, part.first_row + part.rows + 1);
        auto scouted_rows = [&](int from, int to) {
            return scouted(n, size_t(to - from) * width,
                           [&](size_t k) { return size_t(from) * width + k; });
        };
        const int below = part.first_row + part.rows;
        NoiseOfRows around{
            picture, first, end - first,
            needs_scouts() ? scouted_rows(part.first_row, below) : film_.noise(2 * width)};
        const auto next = scouted_rows(below, end), before = scouted_rows(first, part.first_row);
        around.noise.insert(around.noise.end(), next.begin(), next.end());
        around.noise.insert(around.noise.begin(), before.begin(), before.end());
        NoiseElsewhere known = elsewhere(around, n);
        return {std::move(around), std::move(known)};
    }
    NoiseElsewhere elsewhere(const NoiseOfRows& around, uint64_t n) {
        const Survey survey(around.picture);
        const size_t from = size_t(around.first) * size_t(around.picture.width);
        std::vector<double> found(survey.count());
        std::vector<size_t> outside;
        for (size_t k = 0; k < found.size(); ++k) {
            const size_t i = survey.pixel(k);
            if (i >= from && i - from < around.noise.size())
                found[k] = around.noise[i - from];
            else
                outside.push_back(k);
        }
        const auto scouts =
            scouted(n, outside.size(), [&](size_t j) { return survey.pixel(outside[j]); });
        for (size_t j = 0; j < outside.size(); ++j) found[outside[j]] = scouts[j];
        return {survey, found};
    }

    // Noise of pixels pixel(k), k < count, that are not in this film, or whose first samples are
    // not: of n samples that nobody keeps.
    template <class PixelNumber>
    std::vector<double> scouted(uint64_t n, size_t count, PixelNumber pixel) {
        constexpr size_t most = 65536;  // at a time
        const size_t width = size_t(job_.part.picture.width);
        std::vector<double> noise;
        noise.reserve(count);
        for (size_t from = 0; from < count; from += most) {
            Film<Pixel> film({int(std::min(most, count - from)), 1}, value_);
            auto at = [&](int x, int, uint64_t i, uint32_t set) {
                const size_t k = pixel(from + size_t(x));
                return PixelSample{int(k % width), int(k / width), i, set};
            };
            struct {
                void show(double) {}
            } silent;
            const bool complete = add_pass(
                film, n, job_.passes.threads,
                [&](size_t block, uint64_t more) { add_block(film, block, more, at); }, silent);
            check_finite(film, at);
            const std::vector<double> found = complete ? film.noise() : std::vector<double>(most);
            noise.insert(noise.end(), found.begin(), found.end());
        }
        noise.resize(count);
        return noise;
    }

    // ---- Resuming ----

    // Puts into the film what there is; what was measured then.
    RunStats resumed() {
        const Options& o = job_.o;
        if (o.resume.empty()) return {};
        FilmReader file(o.resume);
        file.check();
        check_identity(o.resume, file.header(), checkpoints_.identity());
        const RunStats run = run_in(file.header(), o.resume);
        film_.restore([&] { return read_film<Pixel>(file, o.resume, job_.part.size()); });
        check_samples(film_.state());
        return run;
    }
    void check_samples(const FilmState<Pixel>& state) const {
        const Options& o = job_.o;
        const uint64_t samples = state.samples + state.pass, wanted = job_.passes.target.samples;
        const std::string has = o.resume + ": has " + std::to_string(samples) + " samples";
        if (wanted > 0 && samples > wanted)
            throw UserError(has + ", more than --spp " + std::to_string(wanted));
        if (!state.sets.empty() && sets_of(o) == sets_by_noise && !needs_scouts() &&
            state.sets_after != samples_to_choose(job_))
            throw UserError(o.resume + ": its sets were chosen after " +
                            std::to_string(state.sets_after) + " samples, not " +
                            std::to_string(samples_to_choose(job_)) +
                            " as for so many: give the same --spp");
        tell(o, has + ", goes on");
    }
};
