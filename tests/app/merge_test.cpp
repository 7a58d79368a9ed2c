// app/merge_test.cpp  parts that fit are the film of the whole picture, others are refused
#include "app/merge.h"

#include "app/render.h"
#include "base/folder.h"
#include "film/refusal.h"
#include "path/scenes.h"

namespace {

struct Pictures : Folder {
    Scene scene = scene_of(unequal);
    Pictures() { scene.size = {37, 25}; }  // 925 pixels, in blocks of 3 and one of 1

    // Renders; with a `film`, into that.
    Rendered render(const std::string& options, const std::string& film = "") const {
        std::vector<std::string> words;
        std::istringstream in(options);
        for (std::string word; in >> word;) words.push_back(word);
        Options o = parse_words(option_table, words);
        o.scene = "test";
        o.quiet = true;
        if (!film.empty()) o.checkpoint = *this / film;
        const Job job = job_of(o, scene);
        return rendered(job, identity_of(job, "sum"));
    }
    std::vector<Band> bands(const std::vector<std::string>& films) const {
        std::vector<std::string> paths;
        for (const std::string& film : films) paths.push_back(*this / film);
        return bands_of(paths);
    }
};

struct Picture {
    Image image;
    Merged merged;
};

template <class Pixel>
Picture merged(const std::vector<Band>& bands, const typename Pixel::Value& value, Shows shows) {
    const Size size = bands.front().front().picture;
    Picture p{Image(size.width, size.height), {}};
    p.merged = merge<Pixel>(bands, value, shows, [&](int y, const auto& row) {
        REQUIRE(row.size() == size_t(size.width));
        for (int x = 0; x < size.width; ++x) p.image.at(x, y) = row[size_t(x)];
    });
    return p;
}

bool same(const Image& a, const Image& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof a.pixels[0]) == 0;
}

bool same(const ImageError& a, const ImageError& b) {
    return a.square == b.square && a.spread == b.spread && a.norm == b.norm &&
           a.greatest == b.greatest;
}

std::string cover(const std::vector<Range>& ranges, uint64_t n) {
    const std::string names[] = {"a", "b", "c"};
    return refusal([&] {
        check_cover(
            "rows", ranges.size(), n, [&](size_t k) { return ranges[k]; },
            [&](size_t k) { return names[k]; });
    });
}

}  // namespace

TEST_CASE("bands are the picture bit by bit, and its error") {
    const Pictures folder;
    for (const char* options : {"--spp 18", "--spp 5", "--spp 18 --sets 3 --view variance",
                                "--spp 18 --light nee --direct regression"}) {
        INFO(std::string(options));
        const bool ratio = (std::string(options).find("regression") != std::string::npos);
        const Rendered whole = folder.render(options);
        for (const char* rows : {"0-9", "10-10", "11-15", "16-24"})
            folder.render(std::string(options) + " --rows " + rows, std::string(rows) + ".film");
        const auto bands = folder.bands({"11-15.film", "16-24.film", "0-9.film", "10-10.film"});
        const Shows shows = (std::string(options).find("variance") != std::string::npos)
                                ? Shows::variances
                                : Shows::values;
        const Picture p = ratio ? merged<ShadowPixel>(bands, {Estimator::regression}, shows)
                                : merged<MeanPixel>(bands, {}, shows);
        CHECK(same(p.image, whole.image));
        CHECK(same(p.merged.terms.error(), whole.run.error));
        CHECK(p.merged.terms.pixels == 925);
        CHECK(p.merged.terms.sum[1] / 925 == whole.run.mean_radiance[1]);
        CHECK(p.merged.sets == whole.run.sets);
    }
}

TEST_CASE("ranges of samples have the picture's sets, and their sums are its but for rounding") {
    const Pictures folder;
    const Rendered whole = folder.render("--spp 40");
    for (const char* samples : {"0-16", "17-17", "18-39"})
        folder.render("--spp 40 --samples " + std::string(samples), std::string(samples) + ".film");
    const auto bands = folder.bands({"17-17.film", "18-39.film", "0-16.film"});
    const Picture p = merged<MeanPixel>(bands, {}, Shows::values);
    CHECK(p.merged.sets == whole.run.sets);
    double worst = 0;
    for (size_t i = 0; i < whole.image.pixels.size(); ++i) {
        const double a = double(whole.image.pixels[i][1]), b = double(p.image.pixels[i][1]);
        worst = std::max(worst, std::abs(a - b) / std::max(1e-30, a));
    }
    CHECK(worst <= double(std::numeric_limits<float>::epsilon()));
    CHECK(p.merged.terms.error().d_rel() ==
          doctest::Approx(whole.run.error.d_rel()).epsilon(1e-11));
    CHECK(p.merged.terms.error().standard_error() ==
          doctest::Approx(whole.run.error.standard_error()).epsilon(1e-11));
}

TEST_CASE("parts of other sets are not added up") {
    const Pictures folder;
    for (const char* samples : {"0-9", "10-19"})
        folder.render("--spp 20 --samples " + std::string(samples), std::string(samples) + ".film");
    FilmReader file(folder / "10-19.film");
    FilmHeader header = file.header();
    auto state = read_film<MeanPixel>(file, "", folder.scene.size);
    // A pixel less that is measured, and one more.
    const auto measured = std::find_if(state.sets.begin(), state.sets.end(),
                                       [](const Sets& s) { return s.chance > 0; });
    const auto single = std::find_if(state.sets.begin(), state.sets.end(),
                                     [](const Sets& s) { return s.count() == 1; });
    REQUIRE(measured != state.sets.end());
    REQUIRE(single != state.sets.end());
    std::swap(*measured, *single);
    write_film(folder / "10-19.film", header, state);
    const auto bands = folder.bands({"0-9.film", "10-19.film"});
    CHECK(refusal([&] { merged<MeanPixel>(bands, {}, Shows::values); }) ==
          (folder / "10-19.film") + ": its pixels have other sets than those of " +
              (folder / "0-9.film"));
}

TEST_CASE("ranges make up all numbers, each once") {
    CHECK(cover({{0, 3}, {4, 4}, {5, 9}}, 10) == "no refusal");
    CHECK(cover({{0, 9}}, 10) == "no refusal");
    CHECK(cover({{0, 3}, {4, 4}}, 10) == "rows 5-9 are missing");
    CHECK(cover({{1, 3}, {4, 9}}, 10) == "rows 0-0 are missing");
    CHECK(cover({{0, 3}, {6, 9}}, 10) == "rows 4-5 are missing");
    CHECK(cover({{0, 3}, {3, 9}}, 10) == "b: has rows 3-3, as a has");
    CHECK(cover({{0, 5}, {3, 4}, {6, 9}}, 10) == "b: has rows 3-4, as a has");
    CHECK(cover({{0, 3}, {4, 11}}, 10) == "b: has rows 10-11, of 10");
}

TEST_CASE("a part says of which picture it is, and whether it is done") {
    const Pictures folder;
    folder.render("--spp 20 --rows 3-5 --samples 4-9", "a.film");
    const PartFile part = part_file(folder / "a.film");
    CHECK(part.picture.width == 37);
    CHECK(part.picture.height == 25);
    CHECK(part.size().height == 3);
    CHECK(as_text(part.rows) == "3-5");
    CHECK(as_text(part.samples) == "4-9");
    CHECK(part.spp == 20);
    CHECK(part.run.rays > 100);
    folder.render("--spp 20", "b.film");
    CHECK(as_text(part_file(folder / "b.film").samples) == "0-19");
    CHECK(part_file(folder / "b.film").spp == 20);
    const FilmHeader picture = picture_of_part(part);
    CHECK(picture.find("scene") == "sum");
    CHECK(picture.find("pixels"));
    for (const char* key : {"rows", "samples", "spp", "complete", "taken", "name"})
        CHECK_FALSE(picture.find(key));
}
