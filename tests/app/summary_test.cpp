// app/summary_test.cpp  the statistics of a run
#include "app/summary.h"

#include <doctest/doctest.h>

TEST_CASE("the statistics are JSON: quoted, complete, null where nothing is known") {
    Options o;
    o.scene = "a \"b\"\\\n";
    RunStats run;
    run.spp = 64, run.seconds = 2, run.rays = 4000000;
    run.mean_radiance = {2, 2, 4};
    run.variance_of_mean = {1e-300, NAN, INFINITY};
    const std::string text = encode_stats(o, {2, 1}, 5, run);
    for (const char* line :
         {R"("scene": "a \"b\"\\\u000a")", R"("mean_radiance": [2, 2, 4])",
          R"("variance_of_mean": [1e-300, null, null])", R"("rays": 4000000)",
          R"("mrays_per_second": 2,)", R"("samples_per_pixel": 64)", R"("sampler": "sobol")",
          R"("depth": 5)", R"("roulette": 0.250000)", R"("non_finite": 0)"}) {
        INFO(text);
        INFO(std::string(line));
        CHECK(text.find(line) != text.npos);
    }
}

TEST_CASE(
    "the statistics of maps: what they took; depth is none, for light is scattered without end") {
    RunStats run;
    CHECK(encode_stats({}, {2, 1}, 5, run).find("\"map_") == std::string::npos);
    MapStats maps;
    maps.H = 0.5, maps.triangles = 366, maps.particles = 4096, maps.rays = 9000;
    maps.error = 0.125, maps.seconds = 0.25, maps.slope = {1, 2, 4};
    run.maps = maps;
    const std::string text = encode_stats({}, {2, 1}, 5, run);
    for (const char* line :
         {R"("depth": null)", R"("map_mesh": 0.5)", R"("map_triangles": 366)",
          R"("map_particles": 4096)", R"("map_error": 0.125)", R"("map_seconds": 0.25)",
          R"("map_rays": 9000)", R"("map_slope": [1, 2, 4])", R"("indirect": "path")"}) {
        INFO(text);
        INFO(std::string(line));
        CHECK(text.find(line) != text.npos);
    }
    CHECK(summary(maps) == "maps: 366 triangles, 4096 particles, error 12.5 %, 0.25 s");
    maps.error = INFINITY;  // noise is all that there is
    CHECK(summary(maps) == "maps: 366 triangles, 4096 particles, 0.25 s");
}
