// film/loop_test.cpp  the loop over passes: pilots, threads, Ctrl-C, and reasons to stop
#include "film/loop.h"

#include "app/threads.h"
#include "base/approx.h"
#include "base/cases.h"
#include "film/spread.h"

namespace {

const SampleFunction noisy = random_radiance(
    3, [](const PixelSample& s, vec2 u) { return heteroscedastic(s.x % 12, s.y, u); });

// Replications are two; 0: two with weights, as in filled().
Film film_of(Size size, uint32_t K) { return make_film(size, K ? K : 2, K == 0); }

Plan plan_of(uint64_t samples, unsigned threads = 1) {
    Plan plan;
    plan.samples = samples, plan.threads = threads;
    return plan;
}

struct Run {
    Stop stop;
    uint64_t rays, bad;
    std::vector<uint64_t> ends;  // least samples before each pass
};

// Continues a film.  The clock ticks once per sample of a pixel, or stands still.
Run run(Film& film, const Plan& plan, const SampleFunction& L = noisy, double tick = 0,
        std::function<void(const Film&, const Tally&)> between = {}) {
    Run r{};
    std::atomic<uint64_t> samples = 0;
    const SampleFunction counting = [&](const PixelSample& s, Tally& tally) {
        ++samples, ++tally.rays;
        return L(s, tally);
    };
    Watch watch;
    watch.elapsed = [&] { return 1e-9 + tick * double(samples); };
    watch.for_each = by_workers;
    watch.interrupted = [] { return interrupted != 0; };
    watch.between = [&](const Film& f, const Tally& tally) {
        r.ends.push_back(f.min_samples_done());
        if (between) between(f, tally);
    };
    Loop loop(film, plan, counting, watch);
    r.stop = loop.run();
    r.rays = loop.tally().rays, r.bad = loop.tally().bad;
    return r;
}

double samples_of(const Film& f) { return std::round(f.samples_per_pixel() * double(f.pixels())); }

}  // namespace

TEST_CASE("passes end at the seconds asked for; they grow, and shrink when samples take longer") {
    // The end after n samples of so many seconds each.
    auto ends = [](double seconds, double each, uint64_t most) {
        std::vector<uint64_t> found = {0};
        while (found.back() < most && (seconds == 0 || double(found.back()) * each < seconds)) {
            REQUIRE(found.size() < 1000);
            found.push_back(end_of_pass(found.back(), double(found.back()) * each,
                                        found.back() > 0 ? each : 0, seconds));
        }
        return found;
    };
    CHECK(ends(100, 7, 1000).back() == 15);  // the last pass is short
    CHECK(ends(0, 7, 5) == std::vector<uint64_t>{0, 1, 2, 3, 4, 5});
    CHECK(ends(0, 1e-9, 60) == std::vector<uint64_t>{0, 1, 3, 7, 15, 31, 63});
    CHECK(ends(1e30, 1e-9, 60) == ends(0, 1e-9, 60));
    const auto fine = ends(10, 1e-3, 1 << 20);
    CHECK(fine.back() >= 10000);
    CHECK(fine.back() < 10010);
    CHECK(fine.size() < 70);  // threads are seldom idle
    for (size_t k = 1; k < fine.size(); ++k)
        CHECK(fine[k] - fine[k - 1] <= 200);  // Ctrl-C is quick
    // The first pass has a sample, although its time is unknown; so has one when the time is over.
    CHECK(end_of_pass(0, 1, 0, 1e-9) == 1);
    CHECK(end_of_pass(16, 2, 1, 1e-9) == 17);
    CHECK(end_of_pass(1000, 1, 0.01, 0) == 1020);
    CHECK(end_of_pass(1000, 1, 0.01, 1.05) == 1005);
    // If the clock stands still, passes about double, and do not overflow.
    for (uint64_t n = 1, pass = 0; pass < 40; ++pass, n = 2 * n + 1) {
        CHECK(end_of_pass(n, 1, 0, 0) == 2 * n + 1);
        CHECK(end_of_pass(n, 1, 1e-300, 0) == 2 * n + 1);
    }
}

TEST_CASE("a film is the same by any number of threads and passes, and as filled by hand") {
    for (Size size : {Size{24, 12}, Size{1, 1}, Size{1, 30}, Size{30, 1}})
        for (uint32_t K : {0u, 1u, 3u})
            for (uint64_t n : {1, 2, 3, 5, 40}) {
                const Film by_hand = filled(size, K, n, noisy);
                for (unsigned threads : {1u, 2u, 7u})
                    for (double tick : {0.0, 0.01, 1.0}) {
                        Film film = film_of(size, K);
                        const Run r = run(film, plan_of(n, threads), noisy, tick);
                        CHECK(same(film, by_hand));
                        CHECK(double(r.rays) == samples_of(film));
                        CHECK(r.stop == Stop::samples);
                        if (tick == 1 && K > 0) CHECK(r.ends.size() == n);
                        // What is done is not done again, if less is asked for, either.
                        CHECK(run(film, plan_of(n)).rays == 0);
                        CHECK(run(film, plan_of((n + 1) / 2)).stop == Stop::samples);
                        CHECK(same(film, by_hand));
                    }
            }
}

TEST_CASE("passes of the pilot have fixed ends, then weights are chosen; all see a whole film") {
    Film film = film_of({24, 12}, 0);
    film.first_row = 50;
    Plan plan = plan_of(20);
    plan.noisy = {30, 200};
    std::vector<uint64_t> pilots;
    const Run r = run(film, plan, noisy, 1e-6, [&](const Film& f, const Tally& tally) {
        if (f.is_pilot) pilots.push_back(f.min_samples_done());
        CHECK(f.min_samples_done() == f.max_samples_done());
        CHECK(double(tally.rays) == samples_of(f));
    });
    CHECK(pilots == std::vector<uint64_t>{0, 1, 2, 3});
    CHECK(said(film.is_pilot, film.pilot, film.min_samples_done()) == "no 4 20");
    Film by_hand = film_of({24, 12}, 0);
    by_hand.first_row = 50;
    for (uint64_t n : {1, 2, 3, 4}) fill(by_hand, n, noisy);
    choose_weights(by_hand, plan.noisy);
    fill(by_hand, 20, noisy);
    CHECK(same(film, by_hand));
    for (size_t i : plan.noisy) CHECK(film.weight[i] >= 4);
}

TEST_CASE("a time is kept, and every pixel has a sample when it is over") {
    // The picture has 48 pixels: one sample of each takes 48 ticks.
    for (uint32_t K : {0u, 2u})
        for (double seconds : {1e-9, 3.0, 30.0, 2000.0}) {
            Film film = film_of({8, 6}, K);
            Plan plan;
            plan.seconds = seconds;
            const Run r = run(film, plan, noisy, 1.0 / 48);
            CAPTURE(seconds);
            CHECK(r.stop == Stop::time);
            const double took = film.samples_per_pixel(), n = double(film.min_samples_done());
            CHECK(took >= seconds);
            // The last pass had one sample in each replication of weight 1.
            const double before = took * (n - 1) / n;
            CHECK((before < seconds || took == 2));
            CHECK(film.is_pilot == (K == 0 && seconds < 8));
            plan.samples = 1;  // whichever comes first
            film = film_of({8, 6}, K);
            if (seconds > 1) CHECK(run(film, plan, noisy, 1.0 / 48).stop == Stop::samples);
        }
    // Few blocks have a sample, and the time is over.
    for (uint32_t K : {0u, 2u}) {
        Film film = film_of({24, 12}, K);
        fill_blocks(film, 0, 5, 1, noisy);
        Plan plan;
        plan.seconds = 1e-12;
        CHECK(run(film, plan).stop == Stop::time);
        CHECK(said(film.min_samples_done(), film.max_samples_done()) == "1 1");
        // After a pilot no pass is needed.
        Film chosen = filled({24, 12}, 0, 0, noisy);
        chosen.pilot = 4;
        CHECK(run(chosen, plan).rays == 0);
    }
    // One sample of all pixels takes 10 ms: passes grow to 0.2 s, the last one is cut short.
    Film film = film_of({8, 6}, 2);
    Plan plan;
    plan.seconds = 3;
    const Run r = run(film, plan, noisy, 0.01 / 48);
    CHECK(std::abs(film.samples_per_pixel() - 300) <= 2);
    for (size_t k = 1; k < r.ends.size(); ++k) CHECK(r.ends[k] - r.ends[k - 1] <= 10);
    CHECK(r.ends.size() < 22);
}

TEST_CASE("of reasons to stop the first counts: Ctrl-C, NaN, error, samples, time") {
    const Stop of_bit[] = {Stop::time, Stop::samples, Stop::error, Stop::not_finite,
                           Stop::interrupt};
    for (uint32_t K : {0u, 2u})
        for (uint32_t all = 1; all < 32; ++all) {
            Film film = filled({5, 5}, K, 7, [](const PixelSample&, Tally&) {
                return rgb{1, 1, 1};
            });
            Plan plan = plan_of(all & 2 ? 8 : 0);
            plan.seconds = all & 1 ? 1 : 0, plan.error = all & 4 ? 0.1 : 0;
            Watch watch;
            watch.elapsed = [&] { return film.min_samples_done() < 8 ? 0.0 : 1.0; };
            watch.interrupted = [] { return interrupted != 0; };
            const SampleFunction L = [&](const PixelSample&, Tally&) {
                if (all & 16) interrupted = SIGINT;
                return rgb{1, all & 8 ? real(NAN) : 1, 1};
            };
            const Stop stop = Loop(film, plan, L, watch).run();
            interrupted = 0;
            CAPTURE(all);
            CHECK(stop == of_bit[std::bit_width(all) - 1]);
        }
    Film film = film_of({5, 5}, 0);  // Ctrl-C before the run: no pass begins
    interrupted = SIGINT;
    const Run none = run(film, plan_of(20));
    interrupted = 0;
    CHECK(said(none.stop, none.rays, none.ends.size()) == said(Stop::interrupt, 0, 0));
}

TEST_CASE("a sample that is no number ends the run at its pass, counted with all of that pass") {
    for (uint32_t K : {0u, 2u})
        for (unsigned threads : {1u, 3u})
            for (uint64_t at : {2, 10}) {  // in the pilot, or after it
                Film film = film_of({9, 9}, K);
                std::atomic<uint64_t> bad = 0;
                const Run r = run(film, plan_of(64, threads), [&](const PixelSample& s, Tally&) {
                    const bool is_bad = s.i >= at && s.i < at + 2 && s.x == s.y;
                    bad += is_bad;
                    return is_bad ? rgb{1, NAN, 1} : rgb{1, 1, 1};
                });
                CHECK(r.stop == Stop::not_finite);
                CHECK(r.bad == bad);
                CHECK(r.bad > 0);
                CHECK(film.min_samples_done() == film.max_samples_done());
                CHECK(film.min_samples_done() < 64);
            }
}

TEST_CASE("an error ends a run at the first check where it is small enough, passes end at checks") {
    const double wanted = 0.02;
    for (uint32_t K : {0u, 3u}) {
        uint64_t n = 8;
        Film by_hand = filled({24, 12}, K, n, noisy);
        while (!is_small_enough(error_of(by_hand), wanted)) fill(by_hand, n = next_check(n), noisy);
        REQUIRE(n > 20);
        Plan plan;
        plan.error = wanted;
        for (double tick : {0.0, 1e-4, 1.0}) {
            Film film = film_of({24, 12}, K);
            const Run r = run(film, plan, noisy, tick);
            CHECK(r.stop == Stop::error);
            CHECK(same(film, by_hand));
            for (uint64_t check = 8; check < n; check = next_check(check))
                CHECK(std::count(r.ends.begin(), r.ends.end(), check) == 1);
        }
        // One that was interrupted ends there, too; fewer samples come first.
        for (uint64_t calls : {1000, 7777, 20000}) {
            Film film = film_of({24, 12}, K);
            uint64_t left = calls;
            const Run first = run(film, plan, [&](const PixelSample& s, Tally& tally) {
                if (--left == 0) interrupted = SIGINT;
                return noisy(s, tally);
            });
            interrupted = 0;
            CHECK(first.stop == Stop::interrupt);
            CHECK(run(film, plan).stop == Stop::error);
            CHECK(same(film, by_hand));
        }
        plan.samples = n - 1;
        Film film = film_of({24, 12}, K);
        CHECK(run(film, plan).stop == Stop::samples);
        CHECK(film.min_samples_done() == n - 1);
    }
    // An error in doubt ends a run at its first check of 4096 samples per pixel.
    Plan plan;
    plan.error = 100, plan.may_miss_light = [](auto&, auto&) { return true; };
    Film film = film_of({2, 1}, 4);
    CHECK(run(film, plan).stop == Stop::error_unknown);
    uint64_t n = 8;
    while (n < 1024) n = next_check(n);
    CHECK(film.min_samples_done() == n);
}

TEST_CASE("after Ctrl-C at any path each pixel is the mean of its own samples, and goes on") {
    const Size size{24, 12};
    for (uint32_t K : {0u, 3u}) {
        const Film whole = filled(size, K, 20, noisy);
        for (uint64_t at = 1; at < uint64_t(samples_of(whole)); at += 997) {
            Film film = film_of(size, K);
            uint64_t calls = 0;
            const Run r = run(film, plan_of(20), [&](const PixelSample& s, Tally& tally) {
                if (++calls == at) {
                    interrupted = SIGINT;
                    if (at % 2) {
                        tally.rays = 0;
                        throw Interrupted();
                    }
                }
                return noisy(s, tally);
            });
            interrupted = 0;
            CHECK(r.stop == Stop::interrupt);
            CHECK(calls <= at + 3 * 20 * 16);  // at most to the end of the block
            CHECK(double(r.rays) == samples_of(film));
            size_t wrong = 0;
            Tally tally;
            for (size_t i = 0; i < film.pixels(); ++i) {
                double sum = 0;
                for (uint32_t k = 0; k < film.replications; ++k) {
                    Sum of_replication{};
                    for (uint64_t s = 0; s < film.samples(i); ++s)
                        add_to(of_replication, noisy(film.sample_of(i, s, k), tally));
                    sum += of_replication[0];
                }
                const Pixel p = pixel_of(film, i);
                wrong +=
                    p.samples != double(film.replications * film.samples(i)) || p.sum[0] != sum;
            }
            CHECK(wrong == 0);
            CHECK(run(film, plan_of(20, 1 + at % 3)).stop == Stop::samples);
            CHECK(same(film, whole));
        }
    }
}

TEST_CASE("a pilot that Ctrl-C left in part is completed, and may go on with another plan") {
    const Size size{24, 12};
    for (uint64_t first : {1, 2, 3, 20})
        for (uint64_t second : {1, 2, 3, 20})
            for (uint64_t at : {100, 600, 1000, 2000}) {
                Film film = film_of(size, 0);
                uint64_t calls = 0;
                const Run r = run(film, plan_of(first), [&](const PixelSample& s, Tally& tally) {
                    if (++calls == at) interrupted = SIGINT;
                    return noisy(s, tally);
                });
                interrupted = 0;
                if (r.stop == Stop::samples) continue;
                const uint64_t most = film.max_samples_done();
                const bool was_pilot = film.is_pilot;
                uint64_t passes = 0;
                const Run on = run(film, plan_of(second), noisy, 0, [&](const Film&, auto&) {
                    if (++passes > 20) interrupted = SIGINT;  // a run that does not end
                });
                interrupted = 0;
                CAPTURE(first);
                CAPTURE(second);
                CAPTURE(at);
                CHECK(on.stop == Stop::samples);
                CHECK(!film.is_pilot);
                if (was_pilot) CHECK(film.pilot == std::max(most, std::min<uint64_t>(second, 4)));
                CHECK(film.min_samples_done() >= second);
                // No sample is lost, none taken twice.
                size_t wrong = 0;
                Tally tally;
                for (size_t i = 0; i < film.pixels(); ++i)
                    for (uint32_t k = 0; k < 2; ++k) {
                        Sum sum{};
                        for (uint64_t s = 0; s < film.samples(i); ++s)
                            add_to(sum, noisy(film.sample_of(i, s, k), tally));
                        wrong += film.sum[2 * i + k] != sum;
                    }
                CHECK(wrong == 0);
                CHECK(double(r.rays + on.rays) == samples_of(film));
            }
}

TEST_CASE("what a sample throws leaves the loop; the film goes on as if nothing had happened") {
    struct Failure {};
    for (uint32_t K : {0u, 3u}) {
        const Film whole = filled({24, 12}, K, 20, noisy);
        for (uint64_t at : {1, 1000, 5000})
            for (unsigned threads : {1u, 3u}) {
                Film film = film_of({24, 12}, K);
                std::atomic<uint64_t> calls = 0;
                auto failing = [&](const PixelSample& s, Tally& tally) {
                    if (++calls == at) throw Failure();
                    return noisy(s, tally);
                };
                CHECK_THROWS_AS(run(film, plan_of(20, threads), failing), Failure);
                run(film, plan_of(20, threads));
                CHECK(same(film, whole));
            }
    }
}

TEST_CASE("near misses are the same by any number of threads, and of what Ctrl-C left out") {
    const SampleFunction leaving = [](const PixelSample& s, Tally& tally) {
        if (s.x == 5 && s.i == 17 && interrupted == SIGTERM) throw Interrupted();
        const size_t k = size_t(s.y) % growths;
        NearMisses& near = tally.near.at(size_t(s.x) % 3);
        near.sum[k][s.replication % 2] += fixed_point(tally.share / (1.0 + double(s.i)));
        near.squares[s.replication % 2] += fixed_point(tally.share / (1.0 + double(s.i)));
        near.from_light[k % classes].came += s.i < 4 ? 1000 : 1;
        return noisy(s, tally);
    };
    auto film_by = [&](unsigned threads, int signal) {
        Film film = film_of({24, 12}, 0);
        film.near.resize(3);
        film.near[1].area = 5;
        run(film, plan_of(20, threads), leaving, 0, [&](const Film& f, const Tally&) {
            interrupted = f.pilot > 0 && f.min_samples_done() > 2 ? signal : 0;
        });
        interrupted = 0;
        run(film, plan_of(20, threads), leaving);
        return film;
    };
    const Film one = film_by(1, 0);
    double expected = 0, found = 0, squares = 0;
    uint64_t samples = 0;
    for (size_t p = 0; p < one.pixels(); ++p)
        for (uint64_t i = 4; i < one.samples(p); ++i, samples += one.replications)
            expected += 1.0 / one.weight[p] / double(1 + i);  // after the pilot
    // Of the pilot, too.
    uint64_t came = 0;
    for (const NearMisses& g : one.near)
        for (const Brought& of : g.from_light) came += of.came;
    CHECK(came == samples + 1000 * 4 * one.replications * one.pixels());
    for (const NearMisses& g : one.near)
        for (const auto& sums : g.sum) found += value_of(sums[0]) + value_of(sums[1]);
    for (const NearMisses& g : one.near) squares += value_of(g.squares[0] + g.squares[1]);
    CHECK(found == about(expected, 1e-12));
    CHECK(squares == about(expected, 1e-12));
    CHECK(one.near[1].area == 5);
    CHECK(same(one, [&] {
        Film film = film_of({24, 12}, 0);
        film.near = std::vector<NearMisses>(3);
        film.near[1].area = 5;
        fill_pilot(film, 20, leaving);
        fill(film, 20, leaving);
        return film;
    }()));
    for (unsigned threads : {1u, 2u, 7u})
        for (int signal : {0, SIGTERM}) CHECK(same(film_by(threads, signal), one));
}

TEST_CASE("progress is shown in samples per pixel, now and at the end, if that is known") {
    Film film = film_of({5, 5}, 3);
    Watch watch;
    watch.for_each = by_workers;
    watch.interrupted = [] { return interrupted != 0; };
    std::vector<std::pair<double, double>> shown;
    watch.elapsed = [] { return 1.0; };
    watch.show = [&](double now, double end) { shown.push_back({now, end}); };
    auto show = [&](const Plan& plan, const SampleFunction& L = noisy) {
        shown.clear();
        const Stop stop = Loop(film, plan, L, watch).run();
        interrupted = 0;
        return stop;
    };
    show(plan_of(7));
    CHECK(std::find(shown.begin(), shown.end(), std::pair(3.0, 21.0)) != shown.end());
    for (const auto& [now, end] : shown) CHECK(end == 21);
    CHECK(shown.back().first == 21);
    show(plan_of(70));  // goes on
    CHECK(shown.front().first > 21);
    film = film_of({5, 5}, 0);
    show(plan_of(20));
    CHECK(shown.front().second == 80);  // that of two replications of weight 2
    CHECK(shown.back().first == film.samples_per_pixel());
    CHECK(shown.back().second == film.samples_per_pixel());
    // Where the end is unknown it is infinite.
    film = film_of({5, 5}, 1);
    Plan plan;
    plan.seconds = 1;
    show(plan);
    for (const auto& [now, end] : shown) CHECK(end == HUGE_VAL);
    // With an error asked for the end is known by the first check, and at most that of all samples.
    film = film_of({12, 9}, 2);
    plan = plan_of(0), plan.error = 0.02;
    show(plan);
    CHECK(shown.front().second == HUGE_VAL);
    double expected = 0;
    for (const auto& [now, end] : shown)
        if (expected == 0 && now > 16) expected = end;
    const ErrorCheck first = check_error(filled({12, 9}, 2, 8, noisy), 0.02, {});
    REQUIRE(std::isfinite(first.expected));
    CHECK(expected == 2 * std::floor(first.expected));
    film = film_of({12, 9}, 2);
    plan.samples = 10, plan.error = 1e-6;
    show(plan);
    for (const auto& [now, end] : shown) CHECK(end == 20);
    // The interrupted pass ends at its 13th pixel of 25.
    film = film_of({5, 5}, 3);
    CHECK(show(plan_of(7), [](const PixelSample& s, Tally&) {
              if (s.x == 2 && s.y == 2) interrupted = SIGINT;
              return rgb{1, 1, 1};
          }) == Stop::interrupt);
    CHECK(shown.back().first == about(3 * 12.0 / 25, 1e-14));
    CHECK(shown.back().second == 21);
}
