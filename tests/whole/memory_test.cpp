// whole/memory_test.cpp  the memory of large images
#include "whole/process.h"

TEST_CASE("a large picture of two halves takes at most 64 bytes a pixel in all") {
#ifdef __SANITIZE_ADDRESS__
    MESSAGE("the address sanitizer needs more memory than that: not tested");
#else
    const Place place(camera + "light l 1 1 1\nsphere 0 0 0  1  l\n");  // a path ends on it
    for (const std::string options : {"--spp 18", "--replications 2 --spp 4"}) {
        const std::string stats = place.stats("--size 2048x1024 --sampler independent " + options);
        CHECK(number_of(stats, "replications_per_pixel") == 2);
        CHECK(number_of(stats, "d_rel") > 0);
        const double bytes = number_of(stats, "peak_memory_bytes") / (2048.0 * 1024);
        CAPTURE(bytes);
        CHECK(bytes <= 24 * 2 + 16);  // the program's own are among them
        CHECK(bytes > 24 * 2);        // bytes of the sums
    }
#endif
}
