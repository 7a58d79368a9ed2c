// film/passes_test.cpp  stopping, Ctrl-C, threads, and the loop over passes
#include "film/passes.h"

#include <doctest/doctest.h>

#include "base/cases.h"
#include "film/spread.h"

TEST_CASE("passes end at the samples or the seconds asked for, and there is always a first") {
    auto passes = [](uint64_t spp, double seconds, double a_sample) {
        std::vector<uint64_t> sizes;
        uint64_t n = 0;
        for (uint64_t to; (to = end_of_pass({spp, seconds}, 1, n, double(n) * a_sample,
                                            n > 0 ? a_sample : 0)) > n;
             n = to) {
            sizes.push_back(to - n);
            REQUIRE(sizes.size() < 2000);
        }
        return std::pair(n, sizes);
    };
    for (uint64_t spp : {1, 2, 5, 64, 1000})
        for (double speed : {0.0, 1e-6, 0.03, 7.0}) {
            CHECK(passes(spp, 0, speed).first == spp);
            CHECK(passes(spp, 1e30, speed).first == spp);
        }
    CHECK(passes(0, 100, 7).first == 15);  // the last pass is short
    CHECK(passes(5, 100, 7).first == 5);   // the first limit counts
    CHECK(passes(50, 100, 7).first == 15);
    const auto [samples, sizes] = passes(0, 10, 1e-3);
    CHECK(samples >= 10000);
    CHECK(samples < 10100);
    CHECK(*std::max_element(sizes.begin(), sizes.end()) < 400);  // bounds the latency of Ctrl-C
    CHECK(sizes.size() < 200);                                   // threads are seldom idle
    for (uint64_t n : passes(100, 0, 7).second) CHECK(n == 1);
    // The first pass has at least one sample, although its time is unknown.
    CHECK(end_of_pass({0, 1e-9}, 16, 0, 1, 0) == 16);
    CHECK(end_of_pass({0, 1e-9}, 16, 16, 2, 1) == 16);
    // A film with more samples than requested keeps them.
    CHECK(end_of_pass({10, 0}, 1, 12, 0, 0) == 12);
    // If the clock stands still, passes about double, and do not overflow.
    for (uint64_t n = 1, pass = 0, to; pass < 40; ++pass, n = to) {
        to = end_of_pass({}, 1, n, 1, 0);
        CHECK(to == 2 * n + 1);
        CHECK(end_of_pass({}, 1, n, 1, 1e-300) == to);
    }
}

TEST_CASE("passes are whole grids, and shrink when samples take longer") {
    uint64_t n = 5, longest = 0, last = 0;  // resumes in the middle of a grid
    double elapsed = 0;
    for (int pass = 0; pass < 40; ++pass) {
        const double a_sample = pass < 20 ? 1e-5 : 1e-2;
        const uint64_t to = end_of_pass({}, 18, n, elapsed, 18 * a_sample);
        CHECK(to % 18 == 0);
        CHECK(to > n);
        longest = std::max(longest, to - n), last = to - n;
        elapsed += double(to - n) * a_sample;
        n = to;
    }
    CHECK(longest > 1000);
    CHECK(last == 18);  // 0.18 s
}

TEST_CASE("the pilot is 8 samples in whole grids, or all that there are") {
    auto pilot = [](uint64_t samples, uint64_t period) { return Plan{{samples}, period}.pilot(); };
    CHECK(said(pilot(0, 1), pilot(100, 1), pilot(5, 1), pilot(0, 18)) == "8 8 5 18");
    CHECK(said(pilot(36, 6), pilot(36, 36), pilot(10, 12)) == "12 36 10");
}

TEST_CASE("the first signal to end asks for an end, a second Ctrl-C kills; what is ignored stays") {
    struct sigaction before[5], caught{};
    const int signals[5] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ};
    for (int i = 0; i < 5; ++i) sigaction(signals[i], nullptr, &before[i]);
    std::signal(SIGHUP, SIG_IGN);  // as nohup does
    catch_interrupt();
    for (int signal : {SIGPIPE, SIGXFSZ, SIGHUP}) {
        sigaction(signal, nullptr, &caught);
        CHECK((caught.sa_handler == SIG_IGN));
    }
    for (int again = 0; again < 2; ++again) {
        std::raise(SIGTERM);
        CHECK(interrupted == SIGTERM);
    }
    std::raise(SIGINT);
    CHECK(interrupted == SIGINT);
    sigaction(SIGINT, nullptr, &caught);
    CHECK((caught.sa_handler == SIG_DFL));
    interrupted = 0;
    for (int i = 0; i < 5; ++i) sigaction(signals[i], &before[i], nullptr);
}

TEST_CASE("an interrupted pass is told to be incomplete, though only its last work was cut short") {
    for (const auto& [count, last] : {std::pair(100u, 1u), std::pair(10u, 9u)}) {
        CHECK(!in_parallel(
            count, 1, [at = last](size_t k) { interrupted = k == at; }, [](double) {}));
        interrupted = 0;
    }
}

TEST_CASE("work that nobody waits for any more leaves its thread, and is no failure") {
    std::atomic<int> begun = 0;
    auto work = [&](size_t k) {
        ++begun;
        if (k != 5) return;
        interrupted = SIGINT;
        throw Interrupted();
    };
    CHECK(!in_parallel(1 << 20, 1, work, [](double) {}));
    interrupted = 0;
    CHECK(begun == 6);
}

TEST_CASE("what work throws reaches the caller, and nobody begins another piece") {
    for (unsigned threads : {1u, 3u}) {
        std::atomic<int> begun = 0;
        auto work = [&](size_t k) {
            ++begun;
            if (k == 5) throw std::bad_alloc();
        };
        CHECK_THROWS_AS(in_parallel(1 << 20, threads, work, [](double) {}), std::bad_alloc);
        CHECK(begun < 1 << 20);
    }
    auto slow = [&](size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(150)); };
    auto meanwhile = [](double) { throw std::bad_alloc(); };
    CHECK_THROWS_AS(in_parallel(2, 1, slow, meanwhile), std::bad_alloc);
}

TEST_CASE("who waits is told what part of the work is done") {
    std::atomic<int> calls = 0;
    std::vector<double> parts;
    auto work = [&](size_t k) {
        if (k != 3) return;
        // A call that has begun may precede the end of piece 2; the call after it cannot.
        for (const int before = calls; calls < before + 2;) std::this_thread::yield();
    };
    auto meanwhile = [&](double part) {
        parts.push_back(part);
        ++calls;
    };
    CHECK(in_parallel(4, 1, work, meanwhile));
    REQUIRE(parts.size() >= 3);
    CHECK(parts[parts.size() - 2] == 0.75);
    CHECK(parts.back() == 1);
}

TEST_CASE("every piece of work is done once, by any number of threads") {
    for (size_t count : {size_t(1), size_t(2), size_t(100)})
        for (unsigned threads : {1u, 2u, 7u, 300u}) {
            std::vector<std::atomic<int>> done(count);
            std::atomic<bool> outside = false;
            double part = -1;
            auto work = [&](size_t k) {
                if (k >= count)
                    outside = true;
                else
                    ++done[k];
            };
            CHECK(in_parallel(count, threads, work, [&](double p) { part = p; }));
            CHECK_FALSE(outside);
            CHECK(part == 1);
            for (const auto& times : done) CHECK(times == 1);
        }
}

namespace {

const Radiance noisy = random_radiance(
    3, [](const PixelSample& s, vec2 u) { return heteroscedastic(s.x % 12, s.y, u); });

struct Run {
    Film film;
    uint64_t rays, non_finite;
    uint32_t most;
    std::vector<uint64_t> ends;  // ends of passes
};

// The clock ticks once per sample of one pixel, or stands still.
Run run(Size size, uint32_t sets, const Plan& plan, const Radiance& L = noisy,
        std::function<uint64_t(const Film&)> between = nullptr, double tick = 0) {
    Run r{make_film(size, sets), 0, 0, 0, {}};
    std::atomic<uint64_t> samples = 0;
    const Radiance counting = [&](const PixelSample& s, Tally& tally) {
        ++samples, ++tally.rays;
        return L(s, tally);
    };
    Watch watch;
    watch.elapsed = [&] { return 1e-9 + tick * double(samples); };
    watch.between = [&](const Film& f) {
        if (f.least_taken() > 0) r.ends.push_back(f.least_taken());
        return between ? between(f) : UINT64_MAX;
    };
    Loop loop(r.film, plan, counting, watch);
    loop.run();
    r.rays = loop.rays(), r.non_finite = loop.non_finite().count, r.most = loop.most_sets_chosen();
    return r;
}

}  // namespace

TEST_CASE("a film is the same by any number of threads and passes, and as filled by hand") {
    for (Size size : {Size{24, 12}, Size{1, 1}, Size{1, 30}, Size{30, 1}})
        for (uint32_t sets : {0u, 1u, 3u})
            for (uint64_t n : {1, 2, 3, 40}) {
                const Film by_hand = filled(size, sets, n, noisy);
                for (unsigned threads : {1u, 2u, 7u}) {
                    const Run r = run(size, sets, {{n}, 1, threads});
                    CHECK(same(r.film, by_hand));
                    CHECK(double(r.rays) == r.film.total());
                    CHECK(r.most == 32);
                }
                const Run short_passes = run(size, sets, {{n}}, noisy,
                                             [](const Film& f) { return f.least_taken() + 1; });
                CHECK(same(short_passes.film, by_hand));
                CHECK(short_passes.ends.size() >= n);
            }
}

TEST_CASE("passes end at whole grids, but for the last and the pilot of few samples") {
    for (uint32_t sets : {2u, 0u}) {
        const Run on = run({3, 3}, sets, {{0}, 6}, noisy,
                           [](const Film& f) { return f.least_taken() < 90 ? 500 : 1; });
        for (uint64_t n : on.ends) CHECK(n % 6 == 0);
    }
    const Run r = run({3, 3}, 0, {{20}, 6});
    CHECK(said(r.film.pilot, r.film.least_taken(), r.film.samples(0, 0)) == "12 20 20");
}

TEST_CASE("no pass goes further than the one who watches allows; no further than it is: enough") {
    std::vector<uint64_t> asked;
    const Run r = run({4, 3}, 2, {}, noisy, [&](const Film& f) -> uint64_t {
        asked.push_back(f.least_taken());
        for (uint64_t at : {20, 50, 51})
            if (f.least_taken() < at) return at;
        return f.least_taken();
    });
    CHECK(asked.front() == 0);
    for (uint64_t at : {20, 50, 51}) CHECK(std::count(asked.begin(), asked.end(), at) == 1);
    CHECK(r.film.least_taken() == 51);
    CHECK(r.ends.size() < 20);
}

TEST_CASE("a time is kept by films of replications that are chosen, of which the pilot has half") {
    // The picture has 48 pixels: one sample of each takes 48 ticks.
    for (double seconds : {2.0, 300.0, 2000.0, 5000.0}) {
        const Run r = run({8, 6}, 0, {{0, seconds}}, noisy, nullptr, 1.0 / 48);
        CAPTURE(seconds);
        CHECK(!r.film.sets.empty());
        CHECK(r.film.least_taken() > 0);
        const double took = r.film.total() / 48, a_sample = r.film.replications_per_pixel();
        CAPTURE(took);
        CHECK(took <= std::max(seconds + a_sample, 1 + a_sample));
        if (seconds > 2) CHECK(took > seconds - a_sample);
        if (seconds < 30) CHECK(r.film.pilot <= seconds);
        if (seconds > 300) CHECK(r.film.pilot == pilot_samples);
    }
    const Run r = run({8, 6}, 0, {{0, 8}}, noisy, nullptr, 1.0 / 48);
    CHECK(r.film.pilot >= 4);  // half of the time
    CHECK(r.film.pilot < 8);
    // A sample of all pixels takes 10 ms: passes grow, and the one after the pilot is cut short.
    const Run fast = run({8, 6}, 0, {{0, 0.1}}, noisy, nullptr, 0.01 / 48);
    CHECK(fast.film.least_taken() > 0);
    CHECK(fast.film.total() / 48 <= 10 + fast.film.replications_per_pixel());
    // The time is over at once: replications are not chosen before the first sample.
    CHECK(run({8, 6}, 0, {{0, 1e-9}}, noisy, nullptr, 1.0 / 48).film.pilot == 1);
    // Grids of 6 samples by two replications take 0.12 s: a pass has one of them.
    CHECK(run({8, 6}, 2, {{60}, 6}, noisy, nullptr, 0.01 / 48).ends.size() == 10);
}

TEST_CASE("replications are cut to fit into the memory, and the loop tells how many there may be") {
    const Run all = run({24, 12}, 0, {{20}});
    const double K = all.film.replications_per_pixel();
    REQUIRE(K > 2.2);
    const Run cut = run({24, 12}, 0, {{20}, 1, 1, bytes_of({24, 12}, (K + 2) / 2)});
    CHECK(cut.most < 32);
    CHECK(cut.film.replications_per_pixel() <= (K + 2) / 2);
    CHECK(cut.film.least_taken() == 20);
}

TEST_CASE("progress is told in samples a pixel, now and in the end; then the clock is asked") {
    Film film = make_film({5, 5}, 3);
    Watch watch;
    std::vector<std::pair<double, double>> shown;
    watch.elapsed = [] { return 1.0; };
    watch.show = [&](double now, double all) { shown.push_back({now, all}); };
    Plan plan{{7}};
    Loop(film, plan, noisy, watch).run();
    CHECK(std::find(shown.begin(), shown.end(), std::pair(3.0, 21.0)) != shown.end());
    for (const auto& [now, all] : shown) CHECK(all == 21);
    CHECK(shown.back().first == 21);
    shown.clear();
    film = make_film({5, 5}, 0);
    plan.target.samples = 20;
    Loop(film, plan, noisy, watch).run();
    CHECK(shown.front().second == 40);  // assumes two replications
    CHECK(shown.back().first == 20 * film.replications_per_pixel());
    CHECK(shown.back().second == doctest::Approx(20 * film.replications_per_pixel()));
    shown.clear();
    plan.target = {0, 0};
    film = make_film({5, 5}, 1);
    watch.between = [](const Film& f) { return std::max<uint64_t>(3, f.least_taken()); };
    Loop(film, plan, noisy, watch).run();
    for (const auto& [now, all] : shown) CHECK(all == 0);  // the end is unknown
    // The interrupted pass ends at its 13th pixel of 25.
    film = make_film({5, 5}, 3);
    plan.target.samples = 7;
    watch.between = [](const Film& f) { return interrupted ? f.least_taken() : UINT64_MAX; };
    const Radiance L = [](const PixelSample& s, Tally&) {
        if (s.x == 2 && s.y == 2) interrupted = SIGINT;
        return rgb{1, 1, 1};
    };
    Loop(film, plan, L, watch).run();
    interrupted = 0;
    CHECK(shown.back().first == doctest::Approx(3 * 12.0 / 25));
    CHECK(shown.back().second == 21);
}

TEST_CASE("a sample that is no number ends the run at its pass, counted with all of that pass") {
    for (unsigned threads : {1u, 3u}) {
        const Run r = run({9, 9}, 2, {{64}, 8, threads}, [](const PixelSample& s, Tally&) {
            return s.i >= 10 && s.i < 12 && s.x == s.y ? rgb{1, NAN, 1} : rgb{1, 1, 1};
        });
        CHECK(r.non_finite == 2 * 2 * 9);
        CHECK(r.film.least_taken() == r.film.most_taken());
        CHECK(r.film.least_taken() < 64);
        CHECK(r.film.least_taken() >= 12);
    }
}

TEST_CASE("a pilot that Ctrl-C left in part is completed before replications are chosen") {
    const Size size{24, 12};
    Film film = make_film(size, 0);
    double now = 1;
    uint64_t calls = 0;
    Watch watch;
    watch.elapsed = [&] { return now; };
    watch.between = [](const Film& f) {
        CHECK(interrupted == 0);  // no pass may follow Ctrl-C
        return interrupted ? f.least_taken() : UINT64_MAX;
    };
    const Radiance L = [&](const PixelSample& s, Tally& tally) {
        if (++calls == 400) interrupted = SIGINT;
        return noisy(s, tally);
    };
    const Plan plan{{20, 100}};
    Loop(film, plan, L, watch).run();
    interrupted = 0;
    REQUIRE(film.least_taken() < film.most_taken());
    now = 60;  // the pilot's half of the time is over
    Loop(film, plan, noisy, watch).run();
    CHECK(film.least_taken() == 20);
    CHECK(film.pilot < 8);
    const Film by_hand = filled(size, 1, 20, noisy);
    for_each_pixel(film, [&](size_t i, const Pixel& p) { CHECK(p.sum[0].L == by_hand.sum[i].L); });
}

TEST_CASE("after Ctrl-C at any path each pixel is the mean of its own samples, and goes on") {
    const Size size{24, 12};
    for (uint32_t sets : {0u, 3u}) {
        const Film whole = filled(size, sets, 20, noisy);
        for (uint64_t at = 1; at < uint64_t(whole.total()); at += 997) {
            Film film = make_film(size, sets);
            Watch watch;
            watch.elapsed = [] { return 1.0; };
            uint64_t calls = 0;
            const Radiance L = [&](const PixelSample& s, Tally& tally) {
                if (++calls == at) {
                    interrupted = SIGINT;
                    if (at % 2) throw Interrupted();
                }
                ++tally.rays;
                return noisy(s, tally);
            };
            const Plan plan{{20}};
            {
                Loop loop(film, plan, L, watch);
                loop.run();
                CHECK(calls <= at + 20 * 32);  // at most to the end of the block
                CHECK(double(loop.rays()) == film.total());
            }
            interrupted = 0;
            size_t wrong = 0;
            Tally tally;
            const Image image = image_of(film);
            for_each_pixel(film, [&](size_t i, const Pixel& p) {
                double value = 0;
                for (uint32_t set = 0; set < p.count(); ++set) {
                    const uint64_t n = set == 0 ? p.first : p.others;
                    double sum = 0;
                    for (uint64_t k = 0; k < n; ++k)
                        sum += double(noisy({int(i % 24), int(i / 24), k, set}, tally).x);
                    value += sum / double(n);
                }
                const float of_samples = float(value / double(p.count()));
                wrong += p.count() == 0 ? !std::isnan(image.pixels[i][0])
                                        : image.pixels[i][0] != of_samples;
            });
            CHECK(wrong == 0);
            Loop(film, plan, noisy, watch).run();
            CHECK(same(film, whole));
        }
    }
}

TEST_CASE(
    "evidence is the same by any number of threads, and of what an interrupted pass left out") {
    const Radiance leaving = [](const PixelSample& s, Tally& tally) {
        if (s.x == 5 && s.i == 17 && interrupted == SIGTERM) throw Interrupted();
        tally.sums.at(size_t(s.x) % 3) += fixed_point(tally.share / (1.0 + double(s.i)));
        return noisy(s, tally);
    };
    auto film_by = [&](unsigned threads, int signal) {
        Film film = make_film({24, 12}, 0);
        film.evidence.resize(3);
        Plan plan{{20}, 1, threads};
        plan.noisy = {30};
        Watch watch;
        watch.elapsed = [] { return 1e-9; };
        Loop first(film, plan, leaving, watch);
        watch.between = [&](const Film& f) {
            interrupted = f.least_taken() > 9 ? signal : 0;
            return UINT64_MAX;
        };
        first.run();
        interrupted = 0;
        Loop second(film, plan, leaving, watch);
        signal = 0;
        second.run();
        return film;
    };
    const Film one = film_by(1, 0);
    double expected = 0;
    for (int i = 0; i < 20; ++i)
        for (size_t p = 0; p < one.pixels(); ++p)
            if (p % 24 % 3 == 0)
                expected += (i < 8 ? 0.5 : 1.0 / one.sets[p]) / (1 + i) +
                            (one.sets[p] - 1.0) / one.sets[p] / (1 + i);
    CHECK(value_of(one.evidence[0]) == doctest::Approx(expected));
    CHECK(one.sets[30] >= 8);
    for (unsigned threads : {1u, 2u, 7u})
        for (int signal : {0, SIGTERM}) {
            const Film film = film_by(threads, signal);
            CHECK(film.evidence == one.evidence);
            CHECK(same(film, one));
        }
}
