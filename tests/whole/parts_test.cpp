// whole/parts_test.cpp  bands and seeds that are rendered separately merge to one picture
#include <cmath>

#include "whole/kept.h"
#include "whole/process.h"

namespace {

struct Scenes : Unequal {
    Scenes() : Unequal("12x7") {}
    void merge_parts(const Words& words, const Words& parts, const std::string& name) const {
        Words films;
        for (size_t k = 0; k < parts.size(); ++k) {
            films.push_back("part" + std::to_string(k) + ".film");
            expect_success(*this, words + split(parts[k] + " -o x.pfm --keep " + films.back()));
        }
        std::rotate(films.begin(), films.begin() + ptrdiff_t(films.size() / 2), films.end());
        expect_success(*this, split("merge -o " + name + ".png") + outputs(name) + films);
        for (const std::string& film : films) fs::remove(*this / film);
    }
    // Expects the merged parts to equal the whole picture and its statistics.
    void expect_whole(const std::string& options, const Words& parts) const {
        INFO(options);
        const Words words = of(options);
        expect_success(*this, words + outputs("whole") + Words{"-o", "whole.png"});
        merge_parts(words, parts, "parts");
        expect_same_run(*this, "whole", "parts", true);
        CHECK(same("whole.png", "parts.png"));
    }
};

double mean_square(const Image& image) {
    double sum = 0;
    for (const auto& p : image.pixels)
        for (float c : p) sum += double(c) * double(c);
    return sum / (3 * double(image.pixels.size()));
}

}  // namespace

TEST_CASE(
    "bands of fixed --replications make up the picture, bit by bit, and all that is said of it") {
    const Scenes folder;
    for (const std::string& options : parts_of("--replications 2 --spp 37;--replications 1 --spp "
                                               "9;--replications 3 --spp 40 --sampler stratified;"
                                               "--replications 2 --spp 20 --sampler halton --light "
                                               "nee;--replications 2 --spp 2 --view normal"))
        folder.expect_whole(options, {"--rows 0-0", "--rows 1-4 --threads 1", "--rows 5-6"});
}

TEST_CASE("a film alone is its picture, whatever its sets") {
    const Scenes folder;
    for (const std::string options : {"--spp 60", "--spp 1", "--spp 2", "--spp 17 --seed 5"})
        folder.expect_whole(options, {""});
    // The exposure differs from that of the render.
    expect_success(folder, folder.of("--keep a.film --exposure 3 -o a.png"));
    expect_success(folder, folder.of("--exposure 9 -o bright.png"));
    expect_success(folder, "merge --exposure 9 -o b.png a.film");
    CHECK(folder.same("b.png", "bright.png"));
    expect_success(folder, "merge -o c.png a.film");
    CHECK(folder.same("c.png", "a.png"));
}

TEST_CASE("adaptive bands choose by their own rows: each is what a band alone is") {
    const Scenes folder;
    const Words words = folder.of("--spp 40");
    Image whole(12, 7);
    int y = 0;
    for (const std::string rows : {"0-3", "4-6"}) {
        expect_success(folder, words + split("-o band.pfm --rows " + rows));
        const Image band = read_pfm(folder / "band.pfm");
        std::copy(band.pixels.begin(), band.pixels.end(), &whole.at(0, y));
        y += band.height;
    }
    folder.merge_parts(words, {"--rows 0-3", "--rows 4-6"}, "parts");
    const bool same = read_pfm(folder / "parts.pfm").pixels == whole.pixels;
    CHECK(same);
}

TEST_CASE("seeds are independent pictures: their mean by samples, and the variance of that") {
    const Scenes folder;
    for (const std::string options : {"--replications 8", "--replications adaptive"}) {
        INFO(options);
        const Words words = folder.of(options);
        // 16, 16 and 96 samples with fixed replications: weights 1/8, 1/8, 3/4.
        const Words parts = {"--spp 16 --seed 1", "--spp 16 --seed 2", "--spp 96 --seed 3"};
        std::array<Image, 3> images;
        double d2 = 0, sum = 0, fourth = 0;
        for (size_t k = 0; k < 3; ++k) {
            expect_success(folder, words + outputs("one") + split(parts[k]));
            images[k] = read_pfm(folder / "one.pfm");
            const double w = k == 2 ? 0.75 : 0.125, d_rel = folder.number("one", "d_rel");
            const double all = 1 + d_rel * d_rel;  // |f|^2 over |F|^2
            const double its = d_rel * d_rel * mean_square(images[k]) / all,
                         err = 2 * its * folder.number("one", "d_rel_standard_error") / d_rel / all;
            d2 += w * w * its, fourth += std::pow(w, 4) * err * err;
            sum += folder.number("one", "samples_per_pixel");
        }
        folder.merge_parts(words, parts, "all");
        CHECK(folder.number("all", "samples_per_pixel") == doctest::Approx(sum));
        if (contains(options, "adaptive")) continue;
        const Image all = read_pfm(folder / "all.pfm");
        double worst = 0;
        for (size_t i = 0; i < all.pixels.size(); ++i)
            for (size_t c = 0; c < 3; ++c) {
                auto f = [&](size_t k) { return double(images[k].pixels[i][c]); };
                const double mean = (f(0) + f(1) + 6 * f(2)) / 8, its = double(all.pixels[i][c]);
                worst = std::max(worst, std::abs(mean - its) / std::max(1e-30, mean));
            }
        CHECK(worst < 1e-6);  // float rounding
        const double d_rel = std::sqrt(d2 / (mean_square(all) - d2));
        CHECK(folder.number("all", "d_rel") == doctest::Approx(d_rel).epsilon(1e-5));
        CHECK(folder.number("all", "d_rel_standard_error") ==
              doctest::Approx(d_rel * (1 + d_rel * d_rel) * std::sqrt(fourth) / d2 / 2)
                  .epsilon(1e-5));
    }
}

TEST_CASE("bands may have several seeds, each band its own") {
    const Scenes folder;
    const Words words = folder.of("--replications 2 --spp 8");
    folder.merge_parts(words, {"--seed 1", "--seed 2"}, "whole");
    const Words fewer = {"--seed 2 --rows 0-2", "--seed 1 --rows 3-6", "--seed 2 --rows 3-6"};
    folder.merge_parts(words, fewer + Words{"--seed 1 --rows 0-2"}, "parts");
    expect_same_run(folder, "whole", "parts", true);
    folder.merge_parts(words, fewer, "fewer");
    CHECK(folder.number("fewer", "samples_per_pixel") == doctest::Approx(8. * (3 + 2 * 4) / 7));
    CHECK(std::isfinite(folder.number("fewer", "d_rel")));
}

TEST_CASE("a part that is given more samples goes on, and is merged") {
    const Scenes folder;
    const Words words = folder.of("--replications 2");
    expect_success(folder, words + split("--spp 37") + outputs("whole"));
    for (const std::string options :
         {"--spp 20 --rows 0-3 --keep a.film", "--spp 37 --rows 0-3 --keep a.film",
          "--spp 37 --rows 4-6 --keep b.film"})
        expect_success(folder, words + split(options));
    expect_success(folder, split("merge a.film b.film") + outputs("parts"));
    expect_same_run(folder, "whole", "parts", true);
}

TEST_CASE("memory of merging: the picture, and of each film a row and 2 bytes a pixel") {
    const Scenes folder;
    folder.write("unequal.scene", camera + "diffuse m .5 .5 .5\nsphere 0 0 90 1 m\n");
    folder.merge_parts(folder.of("--spp 2 --replications 2 --depth 0") + split("--size 1024x1024"),
                       {"--seed 0", "--seed 1", "--seed 2"}, "all");
    const double pixels = 1024.0 * 1024, memory = folder.number("all", "peak_memory_bytes");
    INFO(memory, " bytes of ", pixels, " pixels");
    CHECK(memory < pixels * (12 + 2 * 3) * 1.1 + 8e6);  // the program takes 8 MB
}
