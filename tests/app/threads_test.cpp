// app/threads_test.cpp  Ctrl-C and other signals, and work by several threads
#include "app/threads.h"

#include <dlfcn.h>
#include <pthread.h>

#include <doctest/doctest.h>

#include <new>
#include <thread>

namespace {
using namespace penumbra;
std::atomic<int> threads_left = -1;  // -1: any number
}  // namespace

// A program's own functions precede those of its libraries.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*run)(void*), void* argument) {
    if (threads_left == 0) return EAGAIN;
    if (threads_left > 0) --threads_left;
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const Create create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    return create(thread, attributes, run, argument);
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
        CHECK(!by_workers(
            count, 1, [at = last](size_t k, unsigned) { interrupted = k == at; }, [](double) {}));
        interrupted = 0;
    }
}

TEST_CASE("work that nobody waits for any more leaves its thread, and is no failure") {
    std::atomic<int> begun = 0;
    auto work = [&](size_t k, unsigned) {
        ++begun;
        if (k != 5) return;
        interrupted = SIGINT;
        throw Interrupted();
    };
    CHECK(!by_workers(1 << 20, 1, work, [](double) {}));
    interrupted = 0;
    CHECK(begun == 6);
}

TEST_CASE("what work throws reaches the caller, and nobody begins another piece") {
    for (unsigned threads : {1u, 3u}) {
        std::atomic<int> begun = 0;
        auto work = [&](size_t k, unsigned) {
            ++begun;
            if (k == 5) throw std::bad_alloc();
        };
        CHECK_THROWS_AS(by_workers(1 << 20, threads, work, [](double) {}), std::bad_alloc);
        CHECK(begun < 1 << 20);
    }
    auto slow = [&](size_t, unsigned) {
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
    };
    auto meanwhile = [](double) { throw std::bad_alloc(); };
    CHECK_THROWS_AS(by_workers(2, 1, slow, meanwhile), std::bad_alloc);
}

TEST_CASE("who waits is told what part of the work is done") {
    std::atomic<int> calls = 0;
    std::vector<double> parts;
    auto work = [&](size_t k, unsigned) {
        if (k != 3) return;
        // A call that has begun may precede the end of piece 2; the call after it cannot.
        for (const int before = calls; calls < before + 2;) std::this_thread::yield();
    };
    auto meanwhile = [&](double part) {
        parts.push_back(part);
        ++calls;
    };
    CHECK(by_workers(4, 1, work, meanwhile));
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
            auto work = [&](size_t k, unsigned) {
                if (k >= count)
                    outside = true;
                else
                    ++done[k];
            };
            CHECK(by_workers(count, threads, work, [&](double p) { part = p; }));
            CHECK_FALSE(outside);
            CHECK(part == 1);
            for (const auto& times : done) CHECK(times == 1);
        }
}

TEST_CASE("a system that has no more threads: those that there are do the work, or the caller") {
    for (const int left : {0, 1, 2}) {
        threads_left = left;
        std::vector<std::atomic<int>> done(100);
        std::atomic<unsigned> most = 0;
        const bool complete = by_workers(
            done.size(), 8,
            [&](size_t k, unsigned worker) {
                ++done[k];
                if (worker > most) most = worker;
            },
            [](double) {});
        threads_left = -1;
        CHECK(complete);
        CHECK(most <= unsigned(std::max(0, left - 1)));
        for (const auto& times : done) CHECK(times == 1);
    }
}

TEST_CASE("threads that work at the same time have different numbers") {
    std::atomic<int> begun = 0;
    unsigned by[2] = {};
    std::thread::id in[2];
    by_workers(
        2, 2,
        [&](size_t k, unsigned worker) {
            by[k] = worker, in[k] = std::this_thread::get_id();
            // The second never begins meanwhile where the system grants one thread only.
            ++begun;
            for (int i = 0; begun < 2 && i < 1000000; ++i) std::this_thread::yield();
        },
        [](double) {});
    CHECK((by[0] != by[1]) == (in[0] != in[1]));
}
