// app/summary_test.cpp  the statistics of a run
#include "app/summary.h"

#include <doctest/doctest.h>

TEST_CASE("the statistics are JSON: quoted, complete, null where nothing is known") {
    Options o;
    o.scene = "a \"b\"\\\n";
    RunStats run{64, 2, 4000000, 0, false};
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
