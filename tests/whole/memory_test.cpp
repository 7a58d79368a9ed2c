// whole/memory_test.cpp  the memory of large images
#include "whole/process.h"

TEST_CASE("a large picture takes at most 32 bytes a pixel, and 24 for each replication") {
#ifdef __SANITIZE_ADDRESS__
    MESSAGE("the address sanitizer needs more memory than that: not tested");
#else
    const Place place(camera + "light l 1 1 1\nsphere 0 0 0  1  l\n");  // a path ends on it
    const std::string stats = place.stats("--size 2048x1024 --spp 18 --sampler independent");
    const double K = number_of(stats, "replications_per_pixel");
    CHECK(K > 2);
    CHECK(number_of(stats, "samples_per_pixel") == doctest::Approx(9 * K));
    CHECK(number_of(stats, "d_rel") > 0);
    const double bytes = number_of(stats, "peak_memory_bytes") / (2048.0 * 1024);
    CAPTURE(bytes);
    CAPTURE(K);
    CHECK(bytes <= 32 + 24 * K);
    CHECK(bytes > 24 * K);  // bytes of the sums
#endif
}
