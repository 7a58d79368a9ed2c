// main.cpp  runs every test; the last line says "N passed, N failed"
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "base/allocations.h"
#include "oracle/oracle.h"
#include "reporter.h"

std::atomic<size_t> allocations = 0;
[[gnu::noinline]] void* operator new(size_t n) {
    ++allocations;
    if (void* p = std::malloc(n ? n : 1)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, size_t) noexcept { std::free(p); }

REGISTER_REPORTER("counter", 0, Reporter);

int main(int argc, char** argv) {
    doctest::Context context;
    context.setOption("reporters", "counter");
    context.applyCommandLine(argc, argv);
    const int status = context.run();
    const unsigned ran = Reporter::ran, failed = Reporter::failed;
    if (context.shouldExit() && ran == 0) return status;  // --help, --list-test-cases
    if (ran == 0) std::puts("no test ran");
    if (oracle::statistical_checks > 0)
        std::printf("%d statistical checks; a false alarm has a probability of at most %.1e\n",
                    oracle::statistical_checks.load(), oracle::alpha_spent.load());
    std::printf("%u passed, %u failed\n", ran - failed, failed);
    return ran == 0 || failed > 0 ? 1 : status;
}
