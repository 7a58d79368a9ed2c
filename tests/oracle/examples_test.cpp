// oracle/examples_test.cpp  the examples of README.md, verbatim, as a reader would write them
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oracle/expect.h"

// What a host has.
struct Vec {
    float x, y, z;
};
const float Pi = 3.14159265f;

namespace {

Vec sample_cosine(float u, float v) {
    const float r = std::sqrt(u), phi = 2 * Pi * v;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)};
}
float pdf_cosine(Vec w) { return w.z > 0 ? w.z / Pi : 0; }

}  // namespace

// clang-format off: the page is not formatted

TEST_CASE("a density") {
    // [density
    oracle::Random random(oracle::seed_of("cosine hemisphere"));
    oracle::Verdict v = oracle::expect_density(random, sample_cosine, pdf_cosine);
    if (!v.pass) std::puts(v.text.c_str());
    // ]
    CHECK(v.pass);
}

TEST_CASE("a mistake") {
    oracle::pictures = "build/logs";
    oracle::Random random(oracle::seed_of("forgotten"));
    // [mistake
    auto forgotten = [](Vec w) { return w.z > 0 ? w.z : 0; };  // 1/pi
    oracle::Verdict v = oracle::expect_density(random, sample_cosine, forgotten, {.name = "cosine"});
    // ]
    CHECK(!v.pass);
    CHECK(
        v.text.starts_with("cosine: the pdf is 3.142 (pi) times the density of the samples, "
                           "everywhere; looks like 1/pi forgotten\n"));
    std::ifstream picture("build/logs/oracle-cosine.svg");
    CHECK(picture.good());
}

TEST_CASE("failing samples and lobes") {
    oracle::Random random(oracle::seed_of("upper half of a sphere"));
    // [failing
    auto upper = [](double u, double v) -> std::optional<oracle::Triple> {
        const double z = 1 - 2 * u, r = std::sqrt(1 - z * z);
        if (z < 0) return {};
        return oracle::Triple{r * std::cos(2 * oracle::pi * v), r * std::sin(2 * oracle::pi * v), z};
    };
    auto half = [](const oracle::Triple& w) { return w[2] > 0 ? 1 / (4 * oracle::pi) : 0; };
    oracle::Verdict v = oracle::expect_density(random, upper, half);  // 50 % of the samples fail
    // ]
    CHECK(v.pass);
}

TEST_CASE("domains") {
    oracle::Random random(oracle::seed_of("domains"));
    // [domains
    using Pair = std::pair<double, double>;
    oracle::Verdict a = oracle::expect_density(random, [](double u) { return -std::log1p(-u); },
                                               [](double t) { return t < 0 ? 0 : std::exp(-t); });  // the line
    oracle::Verdict b = oracle::expect_density(
        random, [](double u, double v) { return Pair{u, std::sqrt(v)}; }, [](Pair x) { return 2 * x.second; }, oracle::Square{});
    const oracle::Triangle<3> t{{0, 0, 1}, {2, 0, 0}, {0, 1, 0}};  // in space: area 3/2
    oracle::Verdict c = oracle::expect_density(
        random, [&](double u, double v) { return t.at({std::sqrt(u), v}); }, [](oracle::Triple) { return 2 / 3.0; }, t);
    oracle::Verdict d = oracle::expect_choice(random, [](double u) { return u < 0.3 ? 0 : 1; },
                                              [](int i) { return i == 0 ? 0.3 : 0.7; }, 2);
    // ]
    CHECK(a.pass);
    CHECK(b.pass);
    CHECK(c.pass);
    CHECK(d.pass);
}

TEST_CASE("factors") {
    oracle::Random random(oracle::seed_of("factors"));
    oracle::pictures = "";
    // [factors
    // A point of the square [-1,1]^2 at z = 2, whose density per solid angle is r^2 / (4 cos).
    auto sample = [](double u, double v) {
        const double x = 2 * u - 1, y = 2 * v - 1, r = std::sqrt(x * x + y * y + 4);
        return oracle::Triple{x / r, y / r, 2 / r};
    };
    auto pdf = [](oracle::Triple w) {
        const double x = 2 * w[0] / w[2], y = 2 * w[1] / w[2];
        const bool inside = w[2] > 0 && std::abs(x) < 1 && std::abs(y) < 1;
        return inside ? (x * x + y * y + 4) / 4 : 0;  // and the cosine?
    };
    oracle::Options o;
    o.factors = {{"1/cos at the light", [](const oracle::Triple& w) { return 1 / w[2]; }},
                 {"r^2", [](const oracle::Triple& w) { return 4 / (w[2] * w[2]); }}};
    oracle::Verdict v = oracle::expect_density(random, sample, pdf, o);
    // ]
    CHECK(!v.pass);
    INFO(v.text);
    CHECK(
        v.text.starts_with("pdf / density of the samples = 1/cos at the light^-1: looks like 1/cos "
                           "at the light forgotten in the pdf"));
}

TEST_CASE("means") {
    oracle::pictures = "";
    oracle::Random random(oracle::seed_of("means"));
    // [means
    // int cos dw over the hemisphere by uniform directions; the pdf 1 / (2 pi) forgotten.
    auto estimate = [&] { return random(); };
    oracle::Verdict v = oracle::expect_mean(oracle::pi, 100000, estimate,
                                            {.factors = {{"1/pdf", 2 * oracle::pi}}});
    // ]
    CHECK(!v.pass);
    INFO(v.text);
    CHECK(v.text.find("looks like 1/pdf forgotten") != std::string::npos);
}

TEST_CASE("Quasi-Monte Carlo and consistent estimators") {
    oracle::Random random(oracle::seed_of("replicates"));
    // [replicates
    // A shifted grid of 8 points for the integral of 3 x^2: one replicate is one shift.
    auto replicate = [&](int) {
        const double shift = random();
        double sum = 0;
        for (int i = 0; i < 8; ++i) sum += 3 * std::pow((i + shift) / 8, 2) / 8;
        return sum;
    };
    oracle::Verdict v = oracle::expect_replicates(1, 64, replicate);
    // The square of a mean of n numbers of mean 1/2 is too large by 1 / 12 n.
    auto error = [&](uint64_t n) {
        double sum = 0;
        for (uint64_t i = 0; i < n; ++i) sum += random();
        return std::pow(sum / double(n), 2) - 0.25;
    };
    oracle::Verdict w = oracle::expect_bias_decay(1 / 12.0, 8, 100000, error);
    // ]
    CHECK(v.pass);
    CHECK(w.pass);
}

TEST_CASE("BSDFs") {
    oracle::Random random(oracle::seed_of("Lambert"));
    // [bsdf
    auto sample = [](Vec, float u, float v) { return sample_cosine(u, v); };
    auto pdf = [](Vec, Vec wi) { return pdf_cosine(wi); };
    auto eval = [](Vec wo, Vec wi) { return wo.z > 0 && wi.z > 0 ? 0.5f / float(oracle::pi) : 0; };
    oracle::Verdict v = oracle::expect_bsdf(random, sample, pdf, eval);
    // ]
    CHECK(v.pass);
}

TEST_CASE("a density that comes with the sample") {
    oracle::Random random(oracle::seed_of("beside"));
    // [beside
    struct Lobe { Vec wi; float pdf; };
    auto sample = [](float u, float v) {
        const Vec w = sample_cosine(u, v);
        return Lobe{w, pdf_cosine(w) / 2};  // "the pdf that sample returns is 0.5 (1/2, half) times what pdf says, in every sample"
    };
    oracle::Verdict v = oracle::expect_density(random, sample, pdf_cosine);
    // ]
    CHECK(v.text == "the pdf that sample returns is 0.5 (1/2, half) times what pdf says, in every sample");
}

TEST_CASE("arrays") {
    oracle::Random random(oracle::seed_of("arrays"));
    // [arrays
    // Arrays: your code evaluates its density at points that the oracle chooses.
    const auto points = oracle::points_in(random, oracle::Sphere{}, 100000);
    std::vector<Vec> samples;   // from elsewhere
    std::vector<float> pdfs;
    for (int i = 0; i < 40000; ++i) samples.push_back(sample_cosine(float(random.single()), float(random.single())));
    for (const auto& w : points) pdfs.push_back(pdf_cosine({float(w[0]), float(w[1]), float(w[2])}));
    oracle::Verdict v = oracle::expect_samples(samples, points, pdfs, oracle::Sphere{});
    // ]
    CHECK(v.pass);
}

TEST_CASE("images") {
    // [image
    const size_t width = 4, height = 2;
    const std::vector<float> truth = {1, 2, 3, 4, 5, 6, 7, 8}, errors(8, 0.01f);
    const std::vector<float> image = {5, 6, 7, 8, 1, 2, 3, 4};
    oracle::Verdict v = oracle::expect_image(width, height, image, errors, truth);
    // ]
    CHECK(v.text.starts_with(
        "the image is the reference upside down: looks like rows written in the other order"));
}

// Every block of code in README.md stands here, between "// [name" and "// ]".
TEST_CASE("the examples of the page are these") {
    // Text between a line that begins so and one that is the end.
    auto blocks = [](const char* path, const std::string& begin, const std::string& end,
                     size_t indent) {
        std::ifstream file(path);
        REQUIRE(file.good());
        std::vector<std::string> found;
        bool inside = false;
        for (std::string line; std::getline(file, line);) {
            if (inside && line == end)
                inside = false;
            else if (inside)
                found.back() += (line.size() > indent ? line.substr(indent) : "") + "\n";
            else if ((inside = line.starts_with(begin)))
                found.emplace_back();
        }
        return found;
    };
    const auto regions = blocks("tests/oracle/examples_test.cpp", "    // [", "    // ]", 4);
    const auto page = blocks("tests/oracle/README.md", "```cpp", "```", 0);
    CHECK(regions.size() >= 10);
    CHECK(page.size() == regions.size());
    for (const std::string& block : page) {
        INFO(block);
        CHECK(std::find(regions.begin(), regions.end(), block) != regions.end());
    }
}
