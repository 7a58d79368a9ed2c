// oracle/arrays_test.cpp  arrays of samples, and build/oracle, which reads them from files
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "oracle/expect.h"

namespace {

using Triples = std::vector<oracle::Triple>;

Triples cosine_samples(oracle::Random& random, size_t n) {
    Triples samples;
    for (size_t i = 0; i < n; ++i) {
        const double u = random(), phi = 2 * oracle::pi * random();
        samples.push_back(
            {std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u)});
    }
    return samples;
}
double cosine_pdf(const oracle::Triple& w) { return std::max(0.0, w[2]) / oracle::pi; }
std::vector<double> at(const auto& points, const auto& pdf) {
    std::vector<double> values;
    for (const auto& w : points) values.push_back(pdf(w));
    return values;
}

// ---- The program
// ----------------------------------------------------------------------------------

const std::string folder = "build/oracle-arrays";

struct Ran {
    int status;
    std::string out;  // with what goes to stderr
};
Ran shell(const std::string& command) {
    const int status = std::system(
        ("mkdir -p " + folder + " && cd " + folder + " && { " + command + "; } >log 2>&1").c_str());
    std::ifstream log(folder + "/log");
    return {status < 0 ? status : WEXITSTATUS(status),
            std::string(std::istreambuf_iterator<char>(log), {})};
}
// Compiled once.
Ran program(const std::string& arguments) {
    static const Ran built =
        shell("c++ -std=c++20 -O1 -I../../tests ../../tests/oracle/arrays.cpp -o oracle");
    INFO(built.out);
    REQUIRE(built.status == 0);
    return shell("env -u ORACLE_PICTURES ./oracle " + arguments);
}
void write(const std::string& file, const std::string& bytes) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/" + file, std::ios::binary) << bytes;
}

template <class T>
std::string bytes_of(const std::vector<T>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}
std::string swapped(std::string bytes, size_t size) {
    for (size_t i = 0; i < bytes.size(); i += size)
        std::reverse(bytes.begin() + long(i), bytes.begin() + long(i + size));
    return bytes;
}
// A .npy of this version by NumPy's documentation (numpy.lib.format).
std::string npy(const std::string& type, const std::string& shape, const std::string& data,
                const std::string& order = "False", char version = 1) {
    const std::string header =
        "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }\n";
    std::string length{char(header.size() % 256), char(header.size() / 256)};
    if (version > 1) length += std::string(2, '\0');
    return "\x93NUMPY" + std::string{version, '\0'} + length + header + data;
}
std::string rows_of(const Triples& points) {
    std::string bytes;
    for (const auto& p : points) bytes += bytes_of(std::vector<double>(p.begin(), p.end()));
    return bytes;
}
std::string text_of(const Triples& points) {
    std::string text;
    for (const auto& p : points) text += oracle::say("%.17g,%.17g,%.17g\n", p[0], p[1], p[2]);
    return text;
}

}  // namespace

TEST_CASE(
    "arrays: what is right is refused as seldom as alpha says, and what delta_min says is seen") {
    const oracle::Aside aside;
    oracle::Random random(seed_here());
    const oracle::Sphere sphere;
    int refused = 0, seen = 0;
    const int runs = 200;
    for (int run = 0; run < runs; ++run) {
        const Triples points = oracle::points_in(random, sphere, 20000),
                      samples = cosine_samples(random, 100000);
        const oracle::Options often{.alpha = 0.05};
        refused += !expect_samples(samples, points, at(points, cosine_pdf), sphere, often).pass;
        if (run % 10 > 0) continue;
        const oracle::Verdict v = expect_samples(samples, points, at(points, cosine_pdf), sphere);
        // Half of all cells has too much, half too little: where x is positive, as medians of phi
        // nearly divide them.
        auto off = [&](const oracle::Triple& w) {
            return cosine_pdf(w) * (1 + std::copysign(1.2 * v.delta_min, w[0]));
        };
        seen += !expect_samples(samples, points, at(points, off), sphere).pass;
    }
    INFO(refused, " of ", runs, ", ", seen);
    CHECK(oracle::p_at_least(refused, runs, 0.05) > 1e-6);
    CHECK(seen == runs / 10);
}

TEST_CASE(
    "arrays: what fails by chance, jumps, poles and what is forgiven are no reason to refuse") {
    const oracle::Aside aside;
    oracle::Random random(seed_here());
    const oracle::Sphere sphere;
    const oracle::Interval unit(0, 1);
    const auto directions = oracle::points_in(random, sphere, 20000);
    const auto points = oracle::points_in(random, unit, 20000),
               many = oracle::points_in(random, unit, 800000);
    for (int run = 0; run < 40; ++run) {
        // Uniform directions, of which those below fail; a jump at b; a pole at 0, where x = u^2.
        Triples above;
        std::vector<oracle::Point<1>> below, pole;
        const double b = 0.5 + 0.4 * random();
        for (int i = 0; i < 60000; ++i) {
            const double z = 2 * random() - 1, phi = 2 * oracle::pi * random();
            const double s = std::sqrt(1 - z * z);
            if (z > 0) above.push_back({s * std::cos(phi), s * std::sin(phi), z});
            if (i < 20000) below.push_back({b * random()}), pole.push_back({std::pow(random(), 2)});
        }
        auto upper = [](auto& w) { return (w[2] > 0) / (4 * oracle::pi); };
        CHECK(expect_samples(above, directions, at(directions, upper), sphere, {.n = 60000}).pass);
        std::vector<double> jump, root;
        for (const auto& x : points) jump.push_back((x[0] < b) / b);
        for (const auto& x : many) root.push_back(0.5 / std::sqrt(x[0]));
        CHECK(expect_samples(below, points, jump, unit).pass);
        if (run % 8 > 0) continue;
        const oracle::Verdict v = expect_samples(pole, many, root, unit);
        INFO(v.text);
        CHECK(v.pass);
    }
    const auto samples = cosine_samples(random, 20000);
    auto more = [](auto& w) { return 1.02 * cosine_pdf(w); };
    CHECK(!expect_samples(samples, directions, at(directions, more), sphere).pass);
    CHECK(expect_samples(samples, directions, at(directions, more), sphere, {.tolerance = 0.05})
              .pass);
}

TEST_CASE("arrays: points, two in each of equal parts") {
    oracle::Random random(seed_here());
    const auto line = oracle::points_in(random, oracle::Interval(1, 8), 13);
    CHECK(line.size() == 14);
    for (size_t i = 0; i < line.size(); ++i) CHECK(std::floor(line[i][0]) == double(1 + i / 2));
    // 17 parts lie in 4 slabs of 4, 4, 4 and 5.
    int begun[5] = {};
    for (const auto& p : oracle::points_in(random, oracle::Square{}, 34))
        ++begun[std::min(3, int(p[0] * 17 / 4))];
    for (int slab = 0; slab < 4; ++slab) CHECK(begun[slab] == (slab < 3 ? 8 : 10));
}

TEST_CASE("arrays: first lines") {
    const oracle::Aside aside;
    oracle::Random random(seed_here());
    const oracle::Sphere sphere;
    const Triples points = oracle::points_in(random, sphere, 200000);
    Triples samples = cosine_samples(random, 200000);
    auto first_line = [&](const auto& pdf, const oracle::Options& o = {}) {
        const oracle::Verdict v = expect_samples(samples, points, at(points, pdf), sphere, o);
        CHECK(!v.pass);
        return v.text.substr(0, v.text.find('\n'));
    };
    CHECK(first_line([](auto& w) { return std::max(0.0, w[2]); })
              .find(" (pi) times the density of the samples, as far as counts tell; looks like "
                    "1/pi forgotten") < 20);
    CHECK(first_line([](auto& w) {
              return 1.1 * cosine_pdf(w);
          }).find(" times the density of the samples, as far as counts tell: a constant factor") <
          20);
    CHECK(first_line([](auto& w) { return (w[2] > 0) / (2 * oracle::pi); }) ==
          "samples have the density of the pdf times cos(theta)");
    const std::string twice = first_line([](auto& w) { return cosine_pdf(w) * std::abs(w[2]); });
    CHECK(twice.starts_with(
        "samples have the density of the pdf times cos(theta)^-1: looks like a factor "
        "cos(theta) too many in the pdf; the pdf integrates to 0.66"));
    CHECK(first_line([](auto& w) {
              return cosine_pdf({w[0], w[1], -w[2]});
          }) ==
          "samples have the density of the pdf with z negated: looks like z negated in one of the "
          "two");
    CHECK(first_line([](auto& w) {
              return cosine_pdf({w[2], w[1], w[0]});
          }).find("exchanged") != std::string::npos);
    CHECK(first_line([](auto& w) {
              return w[2] > 0 ? std::pow(w[2], 1.2) * 2.2 / (2 * oracle::pi) : 0;
          }).find("the pdf is narrower than the samples") != std::string::npos);
    CHECK(first_line(cosine_pdf, {.n = 400000}) ==
          "the pdf is 2 (2, twice) times the density of the samples, 50 % of which fail, as far as "
          "counts tell: a constant factor, its normalisation");
    // A side that hardly has a part of the pdf, but no sample.
    auto below = [](auto& w) {
        return 0.999 * cosine_pdf(w) + (w[2] < 0) * 0.001 / (2 * oracle::pi);
    };
    CHECK(first_line(below) == "no sample has z < 0, where the pdf has 0.1 % of its integral");
    // In the words of an option: the factor that the host named.
    oracle::Options named;
    named.factors = {{"1 + x", [](const oracle::Triple& w) { return 1 + w[0]; }}};
    CHECK(first_line([](auto& w) { return cosine_pdf(w) * (1 + w[0]); }, named) ==
          "samples have the density of the pdf times 1 + x^-1: looks like a factor 1 + x too many "
          "in the pdf, or 1/(1 + x) forgotten");
    // Their order tells nothing.
    std::sort(samples.begin(), samples.end(), [](auto& a, auto& b) { return a[2] < b[2]; });
    CHECK(expect_samples(samples, points, at(points, cosine_pdf), sphere).pass);
    // A lobe that hardly any point meets.
    Triples lobe = samples;
    for (auto& w : lobe) {
        const double z = std::pow(w[2], 0.02), s = std::sqrt((1 - z * z) / (1 - w[2] * w[2]));
        w = {z, w[0] * s, w[1] * s};
    }
    auto narrow = [](auto& w) { return w[0] > 0 ? 50 * std::pow(w[0], 99) / oracle::pi : 0; };
    CHECK(expect_samples(lobe, points, at(points, narrow), sphere)
              .text.starts_with("200000 points are too few: "));
    samples[7] = {0, 0, 2};
    CHECK(first_line(cosine_pdf) ==
          "a sample is no direction: its length is 2, (0, 0, 2), sample 7");
    samples[7] = {0, 0, std::nan("")};
    CHECK(first_line(cosine_pdf) == "sample 7 is not finite, (0, 0, nan)");
}

TEST_CASE("build/oracle: the verdicts of C++, by NumPy's files and by text") {
    const oracle::Aside aside;
    CHECK(program("points -n 30000 -o points.npy").out ==
          "passed: 30000 points of the domain sphere in points.npy\n");
    REQUIRE(program("points -n 30000 -o points.csv").status == 0);
    oracle::Random same(oracle::seed_of("oracle points"));
    const oracle::Sphere sphere;
    const Triples points = oracle::points_in(same, sphere, 30000);
    std::ifstream written(folder + "/points.npy", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(written), {}};
    REQUIRE(bytes.size() == 128 + 30000 * 24);
    CHECK(bytes.substr(128) == rows_of(points));
    std::ifstream lines(folder + "/points.csv");
    CHECK(std::string(std::istreambuf_iterator<char>(lines), {}) == text_of(points));

    oracle::Random random(seed_here());
    const Triples samples = cosine_samples(random, 25000);
    write("samples.npy", npy("<f8", "25000, 3", rows_of(samples)));
    write("samples.csv", "x y z\n\n" + text_of(samples));
    for (const double scale : {1.0, 1.5}) {
        const auto pdf = at(points, [&](auto& w) { return scale * cosine_pdf(w); });
        std::string text;
        for (double p : pdf) text += oracle::say("%.17g\n", p);
        write("pdf.csv", text);
        write("pdf.npy", npy("<f8", "30000,", bytes_of(pdf)));
        const oracle::Verdict v =
            expect_samples(samples, points, pdf, sphere, {.alpha = 1e-5, .name = "cosine"});
        CHECK(v.pass == (scale == 1));
        const std::string wanted = (v.pass ? "passed: " : "refused: ") + v.text + "\n";
        for (const std::string files :
             {"samples.npy pdf.npy", "samples.csv pdf.npy", "samples.npy pdf.csv"}) {
            const Ran ran = program("density " + files + " --name cosine --alpha 1e-5");
            CHECK(ran.out == wanted);
            CHECK(ran.status == !v.pass);
        }
    }
    const Ran drawn = program("density samples.npy pdf.npy -n 50000");
    CHECK(drawn.out.starts_with("refused: the pdf is "));
    const Ran drawn_too = shell("ORACLE_PICTURES=. ./oracle density samples.npy pdf.npy");
    CHECK(drawn_too.out.find("\nsee ./oracle-check-1.svg\n") != std::string::npos);
    CHECK(std::ifstream(folder + "/oracle-check-1.svg").good());
}

TEST_CASE("build/oracle: every domain") {
    auto uniform = [](const std::string& domain, double measure, const std::string& columns) {
        // Its own points are uniform in a box.
        REQUIRE(program("points -n 50000 --domain " + domain + " -o all.csv").status == 0);
        auto density = [&](double pdf, const std::string& samples) {
            shell("yes " + oracle::say("%.17g", pdf) + " | head -n 50000 >pdf.csv");
            return program("density " + samples + " pdf.csv --domain " + domain);
        };
        const Ran right = density(1 / measure, "all.csv");
        INFO(right.out);
        CHECK(right.status == 0);
        CHECK(density(1.01 / measure, "all.csv").status == 1);
        const std::string other = density(1, "pdf.csv").out;
        const std::string sizes = "pdf.csv: 50000 numbers; a row of this domain has " + columns;
        CHECK((other.find(sizes) != std::string::npos) == (columns != "1"));
    };
    uniform("square", 1, "2");
    uniform("interval:-1,3", 4, "1");
    uniform("box:0,2", 2, "1");
    uniform("box:0,2,0,3", 6, "2");
    uniform("box:0,2,0,3,1,2", 6, "3");
    uniform("box:0,2,0,3,1,2,-1,1", 12, "4");
    // Uniform in a triangle by Turk 1990; areas 1/2 and 1.
    std::string flat, above;
    oracle::Random random(seed_here());
    for (int i = 0; i < 30000; ++i) {
        const double s = std::sqrt(random()), t = random();
        flat += oracle::say("%.9g %.9g\n", s * (1 - t), s * t);
        above += oracle::say("%.9g %.9g 5\n", s * (1 - t), 2 * s * t);
    }
    write("flat.csv", flat), write("above.csv", above);
    shell("yes 2 | head -n 30000 >two.csv; yes 1 | head -n 30000 >one.csv");
    const std::string corners = "triangle:0,0,1,0,0,1", higher = "triangle:0,0,5,1,0,5,0,2,5";
    CHECK(program("density flat.csv two.csv --domain " + corners).status == 0);
    CHECK(program("density above.csv one.csv --domain " + higher).status == 0);
    CHECK(program("density flat.csv one.csv --domain " + corners)
              .out.starts_with("refused: the pdf is 0.5"));
    CHECK(program("density above.csv two.csv --domain " + higher).status == 1);
}

TEST_CASE("build/oracle: means, counts and images") {
    oracle::Random random(seed_here());
    std::vector<double> values, higher;
    std::vector<float> threes(1000, 3.0000005f);
    for (int i = 0; i < 20000; ++i) values.push_back(random()), higher.push_back(random() + 0.1);
    write("values.npy", npy("<f8", "20000,", bytes_of(values)));
    write("higher.npy", npy("<f8", "100, 200", bytes_of(higher)));
    write("threes.npy", npy("<f4", "1000,", bytes_of(threes)));
    CHECK(program("mean values.npy 0.5").status == 0);
    CHECK(program("mean values.npy -.5").status == 1);
    CHECK(program("mean values.npy 1").out.starts_with("refused: mean 0."));
    CHECK(program("mean threes.npy 3").status == 0);  // their rounding is that of floats
    CHECK(program("equal values.npy values.npy").status == 0);
    CHECK(program("equal values.npy higher.npy").status == 1);
    write("few.csv", "1 2 3");
    CHECK(program("equal values.npy few.csv")
              .out.starts_with("refused: few.csv: n = 3 is too small"));

    write("counts.csv", "5000, 5010, 9990\n");
    write("thirds.csv", "0.25\t0.25\t0.5\r\n");
    write("others.csv", "0.3;0.3;0.4\n");
    CHECK(program("counts counts.csv thirds.csv").status == 0);
    CHECK(program("counts counts.csv others.csv").status == 1);
    CHECK(program("counts counts.csv few.csv").status == 1);
    write("negative.csv", "0.5 0.8 -0.3");
    CHECK(program("counts counts.csv negative.csv")
              .out.starts_with("refused: a count or probability is -0.3"));

    std::vector<float> truth, image, errors(48, 0.01f);
    for (int i = 0; i < 48; ++i) truth.push_back(float(1 + i));
    for (int i = 0; i < 48; ++i) image.push_back(truth[size_t(i < 24 ? i + 24 : i - 24)]);
    write("truth.npy", npy("<f4", "8, 6", bytes_of(truth)));
    write("image.npy", npy("<f4", "8, 6", bytes_of(image)));
    write("errors.npy", npy("<f4", "8, 6", bytes_of(errors)));
    CHECK(program("image truth.npy errors.npy truth.npy").out.starts_with("passed: 6x8 pixels"));
    CHECK(program("image image.npy errors.npy truth.npy").status == 1);
    write("rgb.npy", npy("<f4", "4, 4, 3", bytes_of(truth)));
    write("rgb_errors.npy", npy("<f4", "4, 4, 3", bytes_of(errors)));
    CHECK(program("image rgb.npy rgb_errors.npy rgb.npy -n 100").out.starts_with("passed: red"));
}

TEST_CASE("build/oracle: numbers of every type and order of bytes") {
    write("halves.csv", "1 0");
    auto counted = [](const std::string& file) {
        write("a.npy", file);
        const Ran ran = program("counts a.npy halves.csv");
        INFO(ran.out);
        CHECK(ran.out.starts_with("refused: 1 samples of 1 in cell 1, where the density is 0"));
    };
    counted(npy("<f4", "2,", bytes_of<float>({0, 1})));
    counted(npy("<f8", "2,", bytes_of<double>({0, 1})));
    counted(npy(">f4", "2,", swapped(bytes_of<float>({0, 1}), 4)));
    counted(npy(">f8", "2,", swapped(bytes_of<double>({0, 1}), 8)));
    counted(npy("<i2", "2,", bytes_of<int16_t>({0, 1})));
    counted(npy(">i4", "2,", swapped(bytes_of<int32_t>({0, 1}), 4)));
    counted(npy("<i8", "1, 2", bytes_of<int64_t>({0, 1})));
    counted(npy("<u2", "2, 1", bytes_of<uint16_t>({0, 1})));
    counted(npy("<u4", "2,", bytes_of<uint32_t>({0, 1})));
    counted(npy("<u8", "2,", bytes_of<uint64_t>({0, 1})));
    counted(npy("|i1", "2,", bytes_of<int8_t>({0, 1})));
    counted(npy("|u1", "2,", bytes_of<uint8_t>({0, 1})));
    counted(npy("|b1", "2,", bytes_of<uint8_t>({0, 1}), "False", 2));
}

TEST_CASE("build/oracle: what cannot be used is named, with status 2") {
    const auto ones = bytes_of(std::vector<double>(6, 1));
    write("good.npy", npy("<f8", "2, 3", ones));
    write("complex.npy", npy("<c16", "3,", ones));
    write("fortran.npy", npy("<f8", "2, 3", ones, "True"));
    write("short.npy", npy("<f8", "2, 4", ones));
    write("odd.npy", npy("<f8", "2, 3", ones + "x"));
    write("huge.npy", npy("<f8", "9999999999, 9999999999", ones));
    write("cut.npy", npy("<f8", "2, 3", ones).substr(0, 40));
    write("head.npy", npy("<f8", "2, 3", ones).substr(0, 8));
    write("none.npy", std::string("\x93NUMPY\x01\0\x05\0{...}", 15));
    write("flat.npy", npy("<f8", "6,", ones));
    write("four.npy", npy("<f8", "1, 1, 6", ones));
    write("nothing.npy", npy("<f8", "0, 3", ""));
    write("wraps.npy", npy("<f8", "9223372036854775811, 2", ones));  // 6 modulo 2^64
    write("wide.csv", std::string("1\0,\0"
                                  "2\0\n\0"
                                  "3\0,\0"
                                  "4\0\n\0",
                                  16));  // of UTF-16
    write("half.csv", "1,2,3x\n1,2,3\n");
    write("nil.csv", "");
    write("ragged.csv", "1,2\n3\n");
    write("word.csv", "1,2\n3,four\n");
    write("empty.csv", "only,names\n");
    const std::pair<std::string, std::string> wrong[] = {
        {"", "usage: oracle CHECK FILES"},
        {"mean missing.csv 1", "missing.csv: cannot be read: No such file"},
        {"mean . 1", ".: cannot be read"},
        {"mean complex.npy 1",
         "complex.npy: has numbers of type '<c16': save float32, float64 or integers"},
        {"mean fortran.npy 1",
         "fortran.npy: is in the order of Fortran: save numpy.ascontiguousarray"},
        {"mean short.npy 1", "short.npy: 2 x 4 numbers of 8 bytes expected, 48 bytes found"},
        {"mean odd.npy 1", "odd.npy: 2 x 3 numbers of 8 bytes expected, 49 bytes found"},
        {"mean huge.npy 1", "huge.npy: 9999999999 x 9999999999 numbers of 8 bytes expected"},
        {"mean cut.npy 1", "cut.npy: ends within its header"},
        {"mean head.npy 1", "head.npy: ends within its header"},
        {"mean none.npy 1", "none.npy: has no header of NumPy's"},
        {"density nothing.npy nothing.npy", "nothing.npy: 0 x 3 numbers"},
        {"density wraps.npy flat.npy --domain square",
         "wraps.npy: 9223372036854775811 x 2 numbers of 8 bytes expected"},
        {"mean wide.csv 1", "wide.csv:2: "},
        {"mean half.csv 1", "half.csv:1: '1 2 3x' is no row of numbers, nor of names"},
        {"mean nil.csv 1", "nil.csv: has no numbers"},
        {"mean good.npy 1 --tolerance inf",
         "--tolerance inf: no such option, or not a value of it"},
        {"points -o a.npy -n 1e12", "-n 1e12: no such option, or not a value of it"},
        {"points -o a.npy --domain box:0,inf", "domain box:0,inf: an end is not above the other"},
        {"mean ragged.csv 1", "ragged.csv:2: 1 numbers; the rows before have 2"},
        {"mean word.csv 1", "word.csv:2: '3 four' is no row of numbers"},
        {"mean empty.csv 1", "empty.csv: has no numbers"},
        {"mean good.npy one", "'one' is no number"},
        {"mean good.npy", "mean takes 2 files or numbers"},
        {"median good.npy 1", "'median': no such check"},
        {"--name x", "which check?"},
        {"mean good.npy 1 --seed 4", "--seed 4: no such option, or not a value of it"},
        {"mean good.npy 1 --alpha 2", "--alpha 2: no such option, or not a value of it"},
        {"mean good.npy 1 --alpha", "--alpha needs a value"},
        {"points", "points: name a file to write, -o FILE"},
        {"points -o no/folder.npy", "no/folder.npy: cannot be written: No such file"},
        {"points -o a.npy --domain cube", "domain 'cube': sphere, square, interval:A,B"},
        {"points -o a.npy --domain interval:2,1",
         "domain interval:2,1: an end is not above the other"},
        {"density good.npy good.npy", "good.npy: 2 x 3 numbers; expected one for each point"},
        {"density good.npy flat.npy --domain square",
         "good.npy: 2 x 3 numbers; a row of this domain has 2"},
        {"image flat.npy flat.npy flat.npy", "flat.npy: 6 numbers; expected height x width"},
        {"image four.npy four.npy four.npy",
         "four.npy: 1 x 1 x 6 numbers; expected height x width"},
        {"image good.npy flat.npy good.npy", "flat.npy: 6 numbers; good.npy: 2 x 3 numbers"}};
    for (const auto& [arguments, sentence] : wrong) {
        const Ran ran = program(arguments);
        INFO(arguments, ": ", ran.out);
        CHECK(ran.status == 2);
        CHECK(ran.out.find(sentence) != std::string::npos);
    }
    CHECK(program("--help").status == 0);
}

TEST_CASE("build/oracle: README.md's lines of Python") {
    const std::string python =
        shell("python3 -c 'import numpy'").status == 0 ? "python3" : "/usr/bin/python3";
    if (shell(python + " -c 'import numpy'").status != 0) {
        MESSAGE("skipped: NumPy is not installed (python3-numpy)");
        return;
    }
    std::ifstream page("tests/oracle/README.md");
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    const size_t from = text.find("```python\n") + 10;
    REQUIRE(from > 10);
    std::string lines = text.substr(from, text.find("```", from) - from);
    REQUIRE(program("--help").status == 0);
    shell("mkdir -p build && cp oracle build/oracle");
    write("right.py", lines);
    const Ran right = shell(python + " right.py");
    INFO(right.out);
    CHECK(right.status == 0);
    const size_t pi = lines.find(" / np.pi)");
    REQUIRE(pi != std::string::npos);
    write("wrong.py", lines.erase(pi, 8));
    const Ran wrong = shell(python + " wrong.py");
    CHECK(wrong.status == 1);
    CHECK(wrong.out.find("(pi) times the density of the samples, as far as counts tell; looks like "
                         "1/pi forgotten") != std::string::npos);
}
