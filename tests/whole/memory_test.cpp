// whole/memory_test.cpp  large pictures: what they take
#include <doctest/doctest.h>

#include "whole/process.h"

namespace {

double number_after(const std::string& text, const std::string& key) {
    const size_t at = text.find(key);
    REQUIRE(at != text.npos);
    return std::strtod(text.c_str() + at + key.size(), nullptr);
}

}  // namespace

TEST_CASE("a large picture takes at most 32 bytes a pixel, and 24 for each replication") {
#ifdef __SANITIZE_ADDRESS__
    MESSAGE("the address sanitizer needs more memory than that: not tested");
#else
    // Lights alone: a path ends where it begins.
    const Folder folder;
    folder.write("file.scene", camera +
                                   "light l 1 1 1\n"
                                   "sphere 0 0 0  1  l\n");
    expect_success(
        folder, "penumbra",
        split("--size 2048x1024 --spp 18 --sampler independent --stats a.json file.scene"));
    const std::string stats = folder.read("a.json");
    const double K = number_after(stats, "\"sets_per_pixel\": ");
    CHECK(K > 2);
    CHECK(number_after(stats, "\"samples_per_pixel\": ") == doctest::Approx(9 * K));
    CHECK(number_after(stats, "\"d_rel\": ") > 0);
    const double bytes = number_after(stats, "\"peak_memory_bytes\": ") / (2048.0 * 1024);
    CAPTURE(bytes);
    CAPTURE(K);
    CHECK(bytes <= 32 + 24 * K);
    CHECK(bytes > 24 * K);  // of the sums alone
#endif
}
