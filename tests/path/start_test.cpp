// path/start_test.cpp  the start of a path: where in the picture
#include "path/start.h"

#include "oracle/expect.h"

using namespace penumbra;

TEST_CASE("settings that would be gone before their samples are refused") {
    CHECK(!std::is_constructible_v<Sampler, SamplerSettings, uint64_t, uint64_t>);
    auto starts = [](auto&& p) {
        return requires(const Scene& s) { start(s, std::forward<decltype(p)>(p), PixelSample()); };
    };
    SamplerSettings stays;
    CHECK(starts(stays));
    CHECK(!starts(SamplerSettings()));
}

TEST_CASE("a sample stays in its pixel, however wide the picture is") {
    for (const int x : {0, 1, 255, 4095, 65535}) {
        CHECK(in_pixel(x, 0) == real(x));
        CHECK(in_pixel(x, below_one) < real(x + 1));
        CHECK(in_pixel(x, real(0.5)) == real(x) + real(0.5));
    }
}
