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

TEST_CASE("a film alone is its picture, whatever its replications") {
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

TEST_CASE("seeds are replications: their mean by samples, and its variance, as by hand") {
    const Scenes folder;
    const Words words = folder.of("--replications 1");
    const std::array<double, 8> n = {16, 16, 96, 32, 16, 64, 8, 8};
    const double N = 256, K = 8;
    std::vector<Image> images;
    Words parts;
    for (size_t k = 0; k < n.size(); ++k) {
        parts.push_back("--spp " + std::to_string(int(n[k])) + " --seed " + std::to_string(k));
        expect_success(folder, words + outputs("one") + split(parts[k]));
        images.push_back(read_pfm(folder / "one.pfm"));
    }
    folder.merge_parts(words, parts, "all");
    const Image all = read_pfm(folder / "all.pfm");
    const double pixels = double(all.pixels.size());
    double worst = 0, d2 = 0, terms2 = 0;
    for (size_t i = 0; i < all.pixels.size(); ++i) {
        double term = 0;
        for (size_t c = 0; c < 3; ++c) {
            double mean = 0, squares = 0;
            for (size_t k = 0; k < n.size(); ++k) mean += n[k] / N * double(images[k].pixels[i][c]);
            for (size_t k = 0; k < n.size(); ++k)
                squares += n[k] * sqr(double(images[k].pixels[i][c]) - mean);
            const double its = double(all.pixels[i][c]);
            worst = std::max(worst, std::abs(mean - its) / std::max(1e-30, mean));
            term += squares / N / (K - 1) / 3;
        }
        d2 += term / pixels, terms2 += term * term * 2 / (K + 1);
    }
    CHECK(worst < 1e-6);  // float rounding
    const double d_rel = std::sqrt(d2 / (mean_square(all) - d2));
    CHECK(folder.number("all", "samples_per_pixel") == N);
    CHECK(folder.number("all", "replications_per_pixel") == K);
    CHECK(folder.number("all", "d_rel") == doctest::Approx(d_rel).epsilon(1e-5));
    CHECK(folder.number("all", "d_rel_standard_error") ==
          doctest::Approx(d_rel * (1 + d_rel * d_rel) * std::sqrt(terms2) / pixels / d2 / 2)
              .epsilon(1e-5));
}

TEST_CASE("adaptive films of other seeds add their samples and replications") {
    const Scenes folder;
    const Words words = folder.of(""), parts = {"--spp 60 --seed 1", "--spp 100 --seed 2"};
    double samples = 0;
    for (const std::string& part : parts) {
        expect_success(folder, words + outputs("one") + split(part));
        samples += folder.number("one", "samples_per_pixel");
    }
    folder.merge_parts(words, parts, "all");
    CHECK(folder.number("all", "samples_per_pixel") == doctest::Approx(samples));
    CHECK(folder.number("all", "replications_per_pixel") == 2 * 8);
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

TEST_CASE("memory of merging: the picture, and of each film a row and a byte a pixel") {
    const Scenes folder;
    folder.write("unequal.scene", camera + "diffuse m .5 .5 .5\nsphere 0 0 90 1 m\n");
    folder.merge_parts(folder.of("--spp 2 --replications 2 --depth 0") + split("--size 1024x1024"),
                       {"--seed 0", "--seed 1", "--seed 2"}, "all");
    const double pixels = 1024.0 * 1024, memory = folder.number("all", "peak_memory_bytes");
    INFO(memory, " bytes of ", pixels, " pixels");
    CHECK(memory < pixels * (12 + 1 * 3) * 1.1 + 8e6);  // the program takes 8 MB
}
