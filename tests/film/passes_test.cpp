// film/passes_test.cpp  when to stop, and work by several threads
#include "film/passes.h"

#include <doctest/doctest.h>

TEST_CASE("the schedule stops at the samples or the seconds asked for, and always begins") {
    auto passes = [](uint64_t spp, double seconds, double seconds_a_sample) {
        Schedule schedule({spp, seconds}, 1);
        std::vector<uint64_t> sizes;
        uint64_t samples = 0;
        while (uint64_t n = schedule.next(samples, double(samples) * seconds_a_sample)) {
            sizes.push_back(n);
            samples += n;
            REQUIRE(sizes.size() < 2000);
        }
        return std::pair(samples, sizes);
    };
    for (uint64_t spp : {1, 2, 5, 64, 1000})
        for (double speed : {0.0, 1e-6, 0.03, 7.0}) {
            CHECK(passes(spp, 0, speed).first == spp);
            CHECK(passes(spp, 1e30, speed).first == spp);
        }
    CHECK(passes(0, 1e-9, 7).first == 1);  // one sample at least
    CHECK(passes(0, 100, 7).first == 15);  // the pass that crosses the end is short
    CHECK(passes(5, 100, 7).first == 5);   // whichever comes first
    CHECK(passes(50, 100, 7).first == 15);
    const auto [samples, sizes] = passes(0, 10, 1e-3);
    CHECK(samples >= 10000);
    CHECK(samples < 10100);
    CHECK(*std::max_element(sizes.begin(), sizes.end()) < 400);  // so that Ctrl-C is soon obeyed
    CHECK(sizes.size() < 200);                                   // and threads are seldom idle
    for (uint64_t n : passes(100, 0, 7).second) CHECK(n == 1);
}

TEST_CASE("passes are whole grids, and shrink when samples take longer") {
    Schedule schedule({}, 18);
    uint64_t samples = 0, longest = 0, last = 0;
    double elapsed = 0;
    for (int pass = 0; pass < 40; ++pass) {
        const uint64_t n = schedule.next(samples, elapsed);
        CHECK(n % 18 == 0);
        longest = std::max(longest, n), last = n;
        samples += n;
        elapsed += double(n) * (pass < 20 ? 1e-5 : 1e-2);
    }
    CHECK(longest > 1000);
    CHECK(last == 18);  // 0.18 s
}

TEST_CASE("an interrupted pass is told to be incomplete") {
    auto work = [](size_t k) { interrupted = k == 1; };
    CHECK(!in_parallel(100, 1, work, [](double) {}));
    interrupted = 0;
}

TEST_CASE("last work that is cut short is no end of the pass") {
    auto work = [](size_t k) { interrupted = k == 9; };
    CHECK(!in_parallel(10, 1, work, [](double) {}));
    interrupted = 0;
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
    std::atomic<int> begun = 0;
    auto slow = [&](size_t) {
        ++begun;
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
    };
    auto meanwhile = [](double) { throw std::bad_alloc(); };
    CHECK_THROWS_AS(in_parallel(100, 1, slow, meanwhile), std::bad_alloc);
    CHECK(begun < 100);
}

TEST_CASE("who waits is told what part of the work is done") {
    std::atomic<int> calls = 0;
    std::vector<double> parts;
    auto work = [&](size_t k) {
        if (k != 3) return;
        // The call under way may have looked before piece 2 was done, the one after it has not.
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

TEST_CASE("progress is told in samples a pixel; a sample that is no number ends it at its pass") {
    struct Samples {
        uint64_t n = 0, bad = 0;
        size_t blocks() const { return 3; }
        void begin_pass(uint64_t) {}
        uint64_t samples() const { return n; }
        uint64_t non_finite() const { return bad; }
        void end_pass(uint64_t more) { n += more; }
    };
    struct {
        std::vector<double> shown;
        double elapsed() const { return 0; }
        void show(double samples) { shown.push_back(samples); }
    } progress;
    Samples film;
    render(
        film, {{24, 0}, 8, 1}, [](size_t, uint64_t) {}, progress);  // 8, and twice as many
    CHECK(film.n == 24);
    CHECK(std::find(progress.shown.begin(), progress.shown.end(), 8) != progress.shown.end());
    CHECK(progress.shown.back() == 24);
    Samples broken;
    render(
        broken, {{24, 0}, 8, 1}, [&](size_t, uint64_t n) { broken.bad = n == 16; }, progress);
    CHECK(broken.n == 8);
}

namespace {

// Counts, in passes, what is added to it.
struct Counting {
    uint64_t n = 0;
    std::vector<uint64_t> ends = {};  // of passes
    uint64_t begun = 0;               // samples of the running pass
    size_t blocks() const { return 2; }
    uint64_t samples() const { return n; }
    uint64_t non_finite() const { return 0; }
    void begin_pass(uint64_t more) { begun = more; }
    void end_pass(uint64_t more) {
        CHECK(more == begun);
        ends.push_back(n += more);
    }
};

struct Stopped {
    double elapsed() const { return 0; }  // passes may grow and grow
    void show(double) {}
};

}  // namespace

TEST_CASE("a pass ends at the pause, whatever its size, and others do as they like") {
    for (uint64_t pause : {1, 5, 16, 63, 100}) {
        Counting film;
        Stopped clock;
        render(
            film, {{64, 0}, 1, 1, pause}, [](size_t, uint64_t) {}, clock);
        CAPTURE(pause);
        CHECK(film.n == 64);
        CHECK(std::count(film.ends.begin(), film.ends.end(), pause) == (pause <= 64));
        CHECK(film.ends.size() < 12);
    }
}

TEST_CASE("no pass brings more samples than the last look allows, but for whole grids; 0: enough") {
    for (uint64_t period : {1, 6}) {
        Counting film;
        Stopped clock;
        // Asked before each pass; looks at 20, 50 and 51 samples.
        std::vector<uint64_t> seen;
        auto look = [&](const Counting& f) -> uint64_t {
            seen.push_back(f.samples());
            for (uint64_t at : {20, 50, 51})
                if (f.samples() < at) return at - f.samples();
            return 0;
        };
        render(
            film, {{0, 0}, period, 1}, [](size_t, uint64_t) {}, clock, look);
        CAPTURE(period);
        auto ended_at = [&](uint64_t n) {
            return std::find(film.ends.begin(), film.ends.end(), n) != film.ends.end();
        };
        std::vector<uint64_t> asked = {0};
        asked.insert(asked.end(), film.ends.begin(), film.ends.end());
        CHECK(seen == asked);
        CHECK(ended_at(period == 1 ? 20 : 24));
        CHECK(ended_at(period == 1 ? 50 : 54));
        CHECK(film.n == (period == 1 ? 51 : 54));
        for (uint64_t end : film.ends) CHECK(end % period == 0);
    }
}

TEST_CASE("many passes that looks cut short do not end a render") {
    Counting film;
    Stopped clock;
    auto look = [](const Counting& f) -> uint64_t { return f.samples() < 1000 ? 1 : 0; };
    render(
        film, {{5000, 0}, 1, 1}, [](size_t, uint64_t) {}, clock, look);
    CHECK(film.n == 1000);
    // And those after them are short enough to be interrupted.
    Schedule schedule({}, 1);
    for (uint64_t n = 0; n < 1000; ++n) CHECK(schedule.next(n, 0) <= 2);
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
