// FOUND src/folder/file.h:1
//
// course/hunt.cpp  a test that is red with the bug, and green without it
#include "base/rng.h"
#include "oracle/oracle.h"

using namespace penumbra;

int main() {
    oracle::pictures = "";
    // As an example: random numbers of [0,1) have the mean 1/2.
    Rng rng{oracle::seed_of("hunt")};
    const oracle::Verdict v = oracle::expect_mean(0.5, 100000, [&] { return rng.uniform(); });
    std::printf("random numbers: %s\n", v.text.c_str());
    return v.pass ? 0 : 1;
}
