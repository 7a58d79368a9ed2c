// whole/compare_test.cpp  comparisons verified by hand, and how programs run other programs
#include "keep/keep.h"
#include "keep/pair.h"
#include "labs/execute.h"
#include "text/browser.h"
#include "text/complaint.h"
#include "text/png.h"
#include "text/program.h"
#include "whole/process.h"

namespace {

struct Comparison {
    double d = -1, d_rel = -1, ratio = -1, largest = -1;
    int x = -1, y = -1;
};

Comparison compare(const Folder& folder, const std::string& words) {
    const Outcome o = expect_exit(folder, "compare " + words, 0);
    CHECK((o.err == "" || o.err == "wrote map.png\n"));
    Comparison c;
    int end = 0;
    const int read =
        std::sscanf(o.out.c_str(),
                    "d: %lf\nd_rel: %lf %%\nratio of means: %lf\nlargest error: %lf at %d,%d\n%n",
                    &c.d, &c.d_rel, &c.ratio, &c.largest, &c.x, &c.y, &end);
    const bool found = read == 6 && size_t(end) == o.out.size();
    REQUIRE(found);
    c.d_rel /= 100;
    return c;
}

// A film of one row.  Pixels have two replications of one sample, m - s and m + s: the mean is m
// and its variance is s^2.
void write_film(const Folder& folder, const std::string& name, const std::vector<float>& m,
                const std::vector<float>& variance) {
    const int width = int(m.size() / 3);
    Film f = make_film({width, 1}, 2, false);
    for (size_t i = 0; i < f.pixels(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double mean = double(m[3 * i + c]), s = std::sqrt(double(variance[3 * i + c]));
            f.sum[2 * i][c] = mean - s, f.sum[2 * i + 1][c] = mean + s;
        }
    f.samples_done.assign(f.samples_done.size(), 1);
    const std::string path = (folder.path / name).string();
    const Keeper keeper(path, {{}, {}, {{"size", std::to_string(width) + "x1"}, {"rows", "0-0"}}});
    REQUIRE(keeper.write(f, {}, true) == "");
}

}  // namespace

TEST_CASE("compare: d, d_rel, ratio of means, largest error and where, as by hand") {
    const Folder folder;
    std::vector<float> f{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, g = f;
    g[5] = 8;  // +2 at the top right, pixel 1,0
    g[7] = 3;  // -5 at the bottom left, pixel 0,1
    folder.write("f.pfm", pfm(2, 2, f));
    folder.write("g.pfm", pfm(2, 2, g));
    // The sums are 78 and 75, squares of f: 650, of g: 623, squares of the errors: 29.
    const Comparison c = compare(folder, "f.pfm g.pfm"), back = compare(folder, "g.pfm f.pfm"),
                     same = compare(folder, "f.pfm f.pfm");
    CHECK(c.d == doctest::Approx(std::sqrt(29 / 12.0)).epsilon(1e-5));
    CHECK(c.d_rel == doctest::Approx(std::sqrt(29 / 650.0)).epsilon(1e-5));
    CHECK(c.ratio == doctest::Approx(75 / 78.0).epsilon(1e-5));
    CHECK(said(c.largest, c.x, c.y) == "5 0 1");
    // The other image is the reference.
    CHECK(back.d == c.d);
    CHECK(back.d_rel == doctest::Approx(std::sqrt(29 / 623.0)).epsilon(1e-5));
    CHECK(back.ratio == doctest::Approx(78 / 75.0).epsilon(1e-5));
    CHECK(said(same.d, same.d_rel, same.ratio, same.largest) == "0 0 1 0");
    CHECK(folder.files() == 2);
}

TEST_CASE(
    "compare: the heat map is black where images agree, and brighter where they differ more") {
    const Folder folder;
    std::vector<float> f(18, 1.0f), g = f;
    for (size_t c = 0; c < 3; ++c) {
        g[3 * 2 + c] += 1;  // pixel 2,0
        g[3 * 3 + c] -= 4;  // pixel 0,1
    }
    folder.write("f.pfm", pfm(3, 2, f));
    folder.write("g.pfm", pfm(3, 2, g));
    for (bool differ : {true, false}) {
        compare(folder, std::string("f.pfm --heatmap map.png ") + (differ ? "g.pfm" : "f.pfm"));
        const Decoded map = decode_png(folder.read("map.png"));
        REQUIRE(map.width == 3);
        REQUIRE(map.height == 2);
        auto brightness = [&](int i) {
            return map.at(i, 0, 0) + map.at(i, 0, 1) + map.at(i, 0, 2);
        };
        for (int i : {0, 1, 4, 5}) CHECK(brightness(i) == 0);
        CHECK((brightness(2) > 0) == differ);
        CHECK((brightness(3) > brightness(2)) == differ);
    }
}

TEST_CASE("compare: a page has both images, their numbers, and begins at the largest error") {
    const Folder folder;
    std::vector<float> f{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, g = f;
    g[7] = 3;  // -5 at 0,1
    folder.write("f.pfm", pfm(2, 2, f));
    folder.write("g.pfm", pfm(2, 2, g));
    const Outcome refused = expect_exit(folder, "compare f.pfm g.pfm --page x.png", 2);
    CHECK(contains(refused.err, "must end in .html"));
    const Outcome o = expect_exit(folder, "compare f.pfm g.pfm --page x.html --limit 10%", 1);
    CHECK(o.err == "wrote x.html\n");
    const std::string page = folder.read("x.html");
    for (const char* name : {"f.pfm", "g.pfm"})
        CHECK(contains(page, "\"" + std::string(name) + "\", \"pixels\": \"" +
                                 base64(read_pfm(folder / name)) + "\""));
    for (const char* outside : {"http", "//www", "@import", "url(", "fetch(", "src="})
        CHECK_MESSAGE(!contains(page, outside), outside);
    if (browser().empty()) return;
    folder.write("driven.html", page + driven_by(R"js(
say("numbers", $("numbers").textContent);
say("table", [...$("difference").rows].map(row => row.textContent).join(" "));
say("names", $("name-a").textContent + " " + $("name-b").textContent + " " + stage.dataset.at);
say("green", cells(0)[2] + " " + cells(1)[2]);
)js"));
    auto seen = seen_in(browse(folder, "--dump-dom", "driven.html"));
    CHECK(seen["error"] + seen["done"] == "1");
    double d = 0, d_rel = 0;
    CHECK(std::sscanf(seen["numbers"].c_str(), "{ &quot;d&quot;: %lf, &quot;d_rel&quot;: %lf,", &d,
                      &d_rel) == 2);
    CHECK(d == doctest::Approx(std::sqrt(25 / 12.0)).epsilon(1e-15));
    CHECK(d_rel == doctest::Approx(std::sqrt(25 / 650.0)).epsilon(1e-15));
    CHECK(contains(seen["table"], "d_rel19.6116 %: "));
    CHECK(contains(seen["table"], "largest error5 at 0,1"));
    CHECK(seen["names"] == "A: g.pfm B: f.pfm 0,1");
    CHECK(seen["green"] == "3.00 8.00");
    folder.write("black.pfm", pfm(2, 2, std::vector<float>(12, 0)));
    expect_exit(folder, "compare black.pfm g.pfm --page x.html", 0);
    folder.write("driven.html", folder.read("x.html") + driven_by(R"js(
say("table", [...$("difference").rows].map(row => row.textContent).join(" "));
)js"));
    CHECK(contains(seen_in(browse(folder, "--dump-dom", "driven.html"))["table"],
                   "d_relnot finite %: "));
}

TEST_CASE("compare: two films show the same, or not") {
    const Folder folder;
    const std::vector<float> f = {1, 2, 3, 4, 5, 6}, g = {1, 2, 3, 4, 8, 6},  // green has 3 more
        none = {0, 0, 0, 0, 0, 0}, v = {1, 1, 1, 1, 1.25f, 1};
    write_film(folder, "f.film", f, v);
    write_film(folder, "g.film", g, v);
    write_film(folder, "f0.film", f, none);
    write_film(folder, "g0.film", g, none);
    auto verdict = [&](const std::string& words) {
        const Outcome o = run(folder, "compare " + words);
        double sigmas = -1, alone = -1, p = -1;
        const size_t at = o.out.find("by ");
        REQUIRE(at != o.out.npos);
        CHECK(std::sscanf(o.out.c_str() + at,
                          "by %lf sigma: p = %lf of one channel, %lf of the worst of three",
                          &sigmas, &alone, &p) == 3);
        // Sigmas are printed with two decimals.
        const double rounding = std::isfinite(sigmas) ? 0.01 * (1 + sigmas * sigmas) : 0,
                     expected = std::erfc(std::abs(sigmas) / std::sqrt(2.0));
        CHECK(std::abs(expected - alone) <= rounding * expected);
        CHECK(o.status == (p < 1e-6 ? 1 : 0));
        return std::pair{sigmas, p};
    };
    // The variance of the difference is 2 x 2.25: 3 / sqrt(4.5) = 1.41 sigma.  One channel has p =
    // .1573, the worst of three 1 - .8427^3; for 2 sigma these are .0455 and .1304.
    CHECK(verdict("f.film g.film") == std::pair{1.41, 0.402});
    CHECK(verdict("g0.film f.film") == std::pair{-2.0, 0.13});
    CHECK(verdict("f0.film f0.film") == std::pair{0.0, 1.0});
    CHECK(verdict("f0.film g0.film").second == 0);
    // Renders agree for another seed, and differ for another depth.
    const Place place(
        "camera 0 1 5 0 0 0 60\ndiffuse grey 0.5 0.5 0.5\nlight lamp 9 9 9\n"
        "quad -5 0 -5 0 0 10 10 0 0 grey\nsphere 0 3 0 1 lamp\nsphere 1 0.5 1 0.5 grey\n");
    for (const auto& [name, more] : {std::pair<std::string, std::string>{"a", "--seed 1"},
                                     {"b", "--seed 2"},
                                     {"c", "--depth 0"},
                                     {"d", "--replications 1"}}) {
        const std::string film = folder / (name + ".film"), image = folder / (name + ".pfm");
        place.render("--size 32x16 --spp 64 --sampler independent " + more + " -o " + image +
                     " --keep " + film);
        // The film and the image have the same pixels.
        expect_exit(folder, "compare --limit 0 " + film + " " + image, 0);
    }
    CHECK(verdict("a.film b.film").second > 1e-6);
    CHECK(verdict("a.film c.film").second < 1e-6);
    // One replication has no variance, and images have none, either.
    for (const std::string words : {"a.film d.film", "a.film b.pfm", "a.pfm b.film"})
        CHECK_FALSE(contains(expect_exit(folder, "compare " + words, 0).out, "sigma"));
}

TEST_CASE("compare judges: the last line and the exit status say the same, and why") {
    const Folder folder;
    folder.write("f.pfm", pfm(1, 1, {50, 50, 50}));
    folder.write("g.pfm", pfm(1, 1, {51, 51, 51}));         // d_rel = 1/50
    write_film(folder, "h.film", {50, 52, 50}, {0, 0, 0});  // 2 / 50 / sqrt(3), 2 sigma
    write_film(folder, "f1.film", {50, 50, 50}, {1, 1, 1});
    write_film(folder, "f.film", {50, 50, 50}, {0, 0, 0});
    write_film(folder, "g.film", {51, 51, 51}, {0, 0, 0});
    write_film(folder, "black.film", {0, 0, 0}, {0, 0, 0});
    folder.write("black.pfm", pfm(1, 1, {0, 0, 0}));
    // The p-value of 2 sigma in one of three channels is .130384.
    const std::string h = "f1.film h.film ";
    const std::pair<std::string, std::string> rows[] = {
        // words, the last line
        {"f.pfm g.pfm --limit 2%", "same: d_rel 2 % <= 2 %"},
        {"--limit .02 f.pfm g.pfm", "same: d_rel 2 % <= 2 %"},
        {"f.pfm --limit 0.01999 g.pfm", "differ: d_rel 2 % > 1.999 %"},
        {"f.pfm g.pfm --limit 1.9999%", "differ: d_rel 2 % > 1.9999 %"},
        {"f.pfm f.pfm --limit 0", "same: d_rel 0 % <= 0 %"},
        {"f.pfm g.pfm --limit 0%", "differ: d_rel 2 % > 0 %"},
        {"black.pfm black.pfm --limit 1%", "same: d_rel 0 % <= 1 %"},
        {"black.pfm f.pfm --limit 1e30%", "differ: d_rel inf % > 1e+30 %"},
        {h, "same: p = 0.13 >= 1e-06"},
        {h + "--alpha 0.13038", "same: p = 0.13 >= 0.13"},
        {h + "--alpha 13.038%", "same: p = 0.13 >= 0.13"},
        {h + "--alpha 0.13039", "differ: p = 0.13 < 0.13"},
        {"h.film f1.film --alpha 0.13039", "differ: p = 0.13 < 0.13"},
        {"h.film f1.film --alpha 0.13038", "same: p = 0.13 >= 0.13"},
        {h + "--alpha 1e-3 --limit 3%", "same: d_rel 2.3094 % <= 3 %, p = 0.13 >= 0.001"},
        {h + "--alpha 1e-3 --limit 2%", "differ: d_rel 2.3094 % > 2 %, p = 0.13 >= 0.001"},
        {h + "--alpha .2 --limit 3%", "differ: d_rel 2.3094 % <= 3 %, p = 0.13 < 0.2"},
        {h + "--alpha .2 --limit 2%", "differ: d_rel 2.3094 % > 2 %, p = 0.13 < 0.2"},
        {"f.film g.film --alpha 1e-30", "differ: p = 0 < 1e-30"},
        {"f.film f.film --alpha .999", "same: p = 1 >= 0.999"},
        {"black.film black.film", "same: p = 1 >= 1e-06"},
    };
    for (const auto& [words, last] : rows) {
        const Outcome o =
            expect_exit(folder, "compare " + words, last.starts_with("same: ") ? 0 : 1);
        INFO(o.out);
        CHECK(o.err == "");
        CHECK(o.out.ends_with("\n" + last + "\n"));
    }
    CHECK(run(folder, "compare f.pfm g.pfm").status == 0);  // without a limit
}

TEST_CASE("compare: images that cannot be compared are refused, and nothing is written") {
    const Folder folder;
    const std::string one = pfm(1, 1, {1, 1, 1});
    folder.write("one.pfm", one);
    folder.write("two.pfm", pfm(2, 1, {1, 1, 1, 1, 1, 1}));
    folder.write("high.pfm", pfm(1, 2, {1, 1, 1, 1, 1, 1}));
    folder.write("nan.pfm", pfm(2, 1, {1, 1, 1, 1, NAN, 1}));
    folder.write("inf.pfm", pfm(1, 2, {1, 1, 1, 1, 1, -INFINITY}));
    folder.write("cut.pfm", one.substr(0, one.size() - 1));
    write_film(folder, "two.film", {1, 1, 1, 1, 1, 1}, {0, 0, 0, 0, 0, 0});
    write_film(folder, "nan.film", {1, 1, 1, 1, NAN, 1}, {0, 0, 0, 0, 0, 0});
    const std::string film = folder.read("two.film");
    folder.write("cut.film", film.substr(0, film.size() - 1));
    for (const auto& [words, why] : members({
             {"@", "one.pfm;one.pfm one.pfm one.pfm", "usage: compare"},
             {"one.pfm two.pfm", "", "sizes differ: 1x1 and 2x1"},
             {"two.pfm high.pfm", "", "sizes differ: 2x1 and 1x2"},
             {"two.film one.pfm", "", "sizes differ: 2x1 and 1x1"},
             {"one.pfm two.pfm --heatmap a.png", "", "sizes differ"},
             {"@", "one.pfm missing.pfm;missing.pfm one.pfm",
              "missing.pfm: cannot open: No such file or directory"},
             {"one.pfm none.film", "", "none.film: cannot open"},
             {"one.pfm .", "", ".: is a directory"},
             {"@",
              "two.pfm nan.pfm;nan.pfm two.pfm;two.pfm nan.pfm --heatmap a.png;"
              "two.pfm nan.pfm --limit 1",
              "nan.pfm: pixel 1,0 is not finite"},
             {"nan.film two.pfm", "", "nan.film: pixel 1,0 is not finite"},
             {"high.pfm inf.pfm", "", "inf.pfm: pixel 0,1 is not finite"},
             {"one.pfm @", "cut.pfm", "@: 1x1 pixels do not fill the file"},
             {"one.pfm cut.film", "", "cut.film: is cut short"},
             {"one.pfm one.pfm --heatmap a.pfm", "", "--heatmap: 'a.pfm' must end in .png"},
             {"one.pfm one.pfm --heatmap missing/a.png", "",
              "missing/a.png: cannot write: No such file"},
             {"two.film two.film @", "--heatmap;--limit;--alpha", "@: needs a value"},
             {"one.pfm one.pfm --limit @", "-1%", "--limit: '@' is negative"},
             {"one.pfm one.pfm --limit %", "", "--limit: '' is not a number"},
             {"one.pfm one.pfm --limit @", "2",
              "--limit: '@' is more than 100 %; for percent say 2%"},
             {"one.pfm one.pfm --limit @%", "nan", "--limit: '@' is not a number"},
             {"one.pfm one.pfm --limit @", "one.pfm", "--limit: '@' is not a number"},
             {"two.film two.pfm --alpha 1e-6", "",
              "--alpha: needs two films of --replications 2 or more"},
             {"two.film two.film --alpha @", "0;100%", "--alpha: must be between 0 and 1"},
             {"one.pfm one.pfm --heat a.png", "",
              "unknown option '--heat' (did you mean '--heatmap'?)"},
         }))
        expect_refusal(folder, "compare " + words, why);
    expect_refusal(folder, "compare", "usage: compare");
}

TEST_CASE("compare and knot say how they are used, and write no file for it") {
    const Folder folder;
    for (const char* program : {"compare", "knot"})
        for (const char* word : {"--help", "-h"})
            CHECK(expect_exit(folder, Words{program, word}, 0)
                      .out.starts_with("usage: " + std::string(program) + " "));
    CHECK(folder.files() == 0);
    for (const std::string words : {"", "--hlep", "knot", "a.obj b.obj"})
        expect_refusal(folder, "knot " + words, "usage: knot FILE.obj");
    expect_success(folder, "knot a.obj");
    CHECK(folder.read("a.obj").starts_with("# trefoil knot, 24000 triangles\nv "));
}

TEST_CASE("a program that another runs: its failure, or that it is not there, is an error") {
    execute({"/bin/sh", "-c", "test \"$0\" = word", "word"});
    auto what = [](const Words& words) { return complaint<SystemError>([&] { execute(words); }); };
    CHECK(what({"/bin/sh", "-c", "exit 3"}) == "/bin/sh failed: exit status 3");
    CHECK(what({"/bin/sh", "-c", "kill -9 $$"}) == "/bin/sh failed: killed by signal 9");
    CHECK(what({"/nowhere"}).starts_with("/nowhere: cannot run: "));
}
