// app/part_test.cpp  parts of a picture, and when their sets are chosen
#include "app/part.h"

#include "app/job.h"
#include "film/refusal.h"
#include "path/scenes.h"

namespace {

Options with(const std::vector<std::string>& words) { return parse_words(option_table, words); }

Part part(const std::vector<std::string>& words, uint64_t total) {
    return part_of(with(words), scene_of(unequal), total);
}

uint64_t chosen_after(const std::vector<std::string>& words) {
    const Options o = with(words);
    const Scene scene = scene_of(unequal);
    return samples_to_choose(job_of(o, scene));
}

}  // namespace

TEST_CASE("a part has its rows and its samples, or all of them") {
    const Part all = part({}, 20);
    CHECK(as_text(all.row_range()) == "0-31");
    const Part some = part({"--rows", "3-7", "--samples", "5-9"}, 20);
    CHECK(some.size().width == 64);
    CHECK(some.size().height == 5);
    CHECK(as_text(some.row_range()) == "3-7");
    CHECK(some.total == 20);
    CHECK(refusal([] {
              part({"--rows", "3-32"}, 20);
          }) == "--rows 3-32: the picture has rows 0-31");
    CHECK(refusal([] {
              part({"--samples", "3-20"}, 20);
          }) == "--samples 3-20: a pixel has samples 0-19");
}

TEST_CASE("a sample of a part is one of the picture") {
    const Part some = part({"--rows", "3-7", "--samples", "5-9"}, 20);
    const PixelSample s = in_picture(some, 2, 1, 4, 6);
    CHECK(s.x == 2);
    CHECK(s.y == 4);
    CHECK(s.i == 9);
    CHECK(s.set == 6);
}

TEST_CASE("a part is of the picture's grids, and takes its own samples alone") {
    const Options o = with({"--spp", "36", "--sampler", "stratified", "--samples", "3-12"});
    const Scene scene = scene_of(unequal);
    const Job job = job_of(o, scene);
    CHECK(job.pattern.period() == 36);
    CHECK(job.passes.target.samples == 10);
    CHECK(job.part.total == 36);
}

TEST_CASE(
    "sets are chosen after the first 16 samples of the picture, in whole grids, or after all") {
    CHECK(chosen_after({"--spp", "100"}) == 16);
    CHECK(chosen_after({"--spp", "9"}) == 9);
    CHECK(chosen_after({"--time", "1"}) == 16);
    CHECK(chosen_after({"--error", "1%"}) == 16);
    CHECK(chosen_after({"--spp", "100", "--samples", "50-59"}) == 16);
    CHECK(chosen_after({"--spp", "100", "--samples", "0-3"}) == 16);
    CHECK(chosen_after({"--spp", "9", "--samples", "0-3"}) == 9);
    CHECK(chosen_after({"--spp", "36", "--sampler", "stratified"}) == 36);
    CHECK(chosen_after({"--spp", "12", "--sampler", "stratified"}) == 12);
    CHECK(chosen_after({"--spp", "55", "--sampler", "stratified"}) == 16);
}
