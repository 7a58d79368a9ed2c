// app/threads.h  1  threads, and signals that ask for an end
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <future>
#include <vector>

namespace penumbra {

// ---- Ctrl-C -------------------------------------------------------------------------------------

// The signal that asks for an end, or 0.
inline std::atomic<int> interrupted = 0;

// The first Ctrl-C, or another signal to end, asks for an end; a second Ctrl-C kills.  Signals that
// the parent ignores stay ignored.  A closed stderr does not lose the image, and a file that grows
// too large is reported as an error.
inline void catch_interrupt() {
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        struct sigaction before {};
        action.sa_handler = [](int caught) { interrupted = caught; };
        // A batch system and a script may both send SIGTERM.
        action.sa_flags = signal == SIGINT ? int(SA_RESETHAND) : 0;
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
    for (int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

// Thrown to abandon work after an interrupt.
struct Interrupted {};

// ---- Threads ------------------------------------------------------------------------------------

// Calls work(k, worker) for every k < count from several threads, numbered from 0, and
// meanwhile(fraction done) from this one ten times per second.  Once `interrupted`, it returns
// false early, with some k left out.  Passes on exceptions of work.  Where the system has no more
// threads, those that it has do the work; if it has none, this one.
inline bool by_workers(size_t count, unsigned threads,
                       const std::function<void(size_t, unsigned)>& work,
                       const std::function<void(double)>& meanwhile) {
    std::atomic<size_t> next = 0, done = 0;
    auto run = [&](unsigned worker) {
        try {  // an item that was cut short does not count
            for (size_t k; !interrupted && (k = next++) < count; done += !interrupted)
                work(k, worker);
        } catch (const Interrupted&) {
        } catch (...) {
            next = count;
            throw;
        }
    };
    std::vector<std::future<void>> workers;
    try {
        for (unsigned i = 0; i < std::min<size_t>(threads, count); ++i)
            workers.push_back(std::async(std::launch::async, run, i));
    } catch (const std::system_error&) {
        if (workers.empty()) run(0);
    }
    for (auto& worker : workers)
        while (worker.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready)
            meanwhile(double(done) / double(count));
    for (auto& worker : workers) worker.get();  // or throws what it has thrown
    meanwhile(double(done) / double(count));
    return done == count;
}

}  // namespace penumbra
