// oracle/expect.h  verdicts of the oracle as checks of the running test case of doctest
#pragma once
#include <doctest/doctest.h>

#include "oracle.h"

namespace oracle {

// Checks that do not count among those of the suite, and draw nothing.
struct Aside {
    const int checks = statistical_checks;
    const double spent = alpha_spent;
    const std::string folder = std::exchange(pictures, "");
    ~Aside() { statistical_checks = checks, alpha_spent = spent, pictures = folder; }
};

inline void says(const Verdict& v, const std::string& words) {
    INFO(v.text);
    CHECK_MESSAGE(v.text.find(words) != std::string::npos, "it does not say: " << words);
}

}  // namespace oracle

// Of the running test case: a function of its name and of TEST_SEED.
inline uint64_t seed_here() {
    return oracle::seed_of(doctest::getContextOptions()->currentTest->m_name);
}

// Passes, and would have seen an error of `largest`: a test that has grown blind fails, too.
#define EXPECT(verdict, largest)                    \
    do {                                            \
        const oracle::Verdict verdict_ = (verdict); \
        INFO(verdict_.text);                        \
        CHECK(verdict_.pass);                       \
        CHECK(verdict_.delta_min <= (largest));     \
    } while (false)
