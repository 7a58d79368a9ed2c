// whole/behaviour_test.cpp  what the program accepts, says and shows; an image depends on its seed
#include <set>

#include "base/vec.h"
#include "whole/process.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

// ---- Accepted -----------------------------------------------------------------------------------

TEST_CASE("odd scenes are accepted: every pixel is finite, and what is dropped is counted") {
    const std::string in_the_plane = "quad 0 0 0 1 2 3 2 4 6 m\n";
    struct Row {
        std::string scene, options, warning;
        int width, height;
    };
    const Row rows[] = {
        {good, "", "", 8, 4},
        {good + "triangle 0 0 0 1 1 1 2 2 2 m\n", "", "dropped triangles without area: 1", 8, 4},
        {good + "triangle 1 2 3 1 2 3 1 2 3 m\n" + in_the_plane + "triangle 0 0 0 1 0 0 1 0 0 l\n",
         "", "dropped triangles without area: 4", 8, 4},
        {good + "quad 0 0 0 0 0 0 0 1 0 l\n", "", "dropped triangles without area: 2", 8, 4},
        {camera + "size 8 4\ndiffuse m 1 1 1\nsphere 0 0 0 1 m\n", "",
         "no light: all will be black", 8, 4},
        {camera + "size 1 1\nlight l 1 1 1\nsphere 0 0 0 1 l\n", "", "", 1, 1},
        {camera + "size 16384 1\nlight l 1 1 1\nsphere 0 0 0 1 l\n", "", "", 16384, 1},
        {camera + "size 1 16384\nlight l 1 1 1\nsphere 0 0 0 1 l\n", "", "", 1, 16384},
        {good, "--size 1x1", "", 1, 1},
        {good, "--size 16384x1", "", 16384, 1},
        {good, "--size 3x5", "", 3, 5},
        // Inside balls, inside a box of light, and a turned one: coplanar points.
        {good + "glass g 1.5\nsphere 0 0 5 1 g\n", "", "", 8, 4},
        {good + "sphere 1 0 5 3 l\n", "", "", 8, 4},
        {good + "light t 1 1 1 twosided m\nsphere 0 0 3 2 t\n", "", "", 8, 4},  // on it
        {good + "box 1 1 1 0 -.5 -.5 4.5 l\n", "", "", 8, 4},
        {camera +
             "size 8 4\ndiffuse m .5 .5 .5\nlight l 1 1 1 twosided m\nbox 9 9 9 30 -7 -4 -4 l\n",
         "--spp 200", "", 8, 4},
        {camera +
             "size 8 4\ndiffuse m .5 .5 .5\nlight l 1 1 1 twosided m\nbox 9 9 9 30 -7 -4 -4 l\n",
         "--spp 200 --light nee --direction uniform", "", 8, 4},
        // Extremes of every number.
        {good + "phong p .5 .5 .5 .5 .5 .5 1e6\nphong q 0 0 0 1 1 1 0\nsphere 1 0 0 1 p\n"
                "sphere -1 0 0 1 q\n",
         "--spp 200", "", 8, 4},
        {good + "glass g 1\nglass h 1e-3\nglass i 1e3\nsphere 1 0 0 1 g\nsphere -1 0 0 1 h\n"
                "sphere 0 1 0 1 i\n",
         "--spp 200", "", 8, 4},
        {good + "sphere 0 -1e8 0 99999999 m\nsphere 1 2 1 1e-8 l\n", "", "", 8, 4},
        {good + "depth 0\nexposure 1e-30\n", "", "", 8, 4},
        {good + "depth 1000000\nexposure 1e30\n", "", "", 8, 4},
        {good, "--depth 0 --exposure 1e-30 --seed 18446744073709551615 --threads 1024", "", 8, 4},
        {good, "--depth 1000000 --exposure 1e30 --seed 0 --threads 1 --roulette 1", "", 8, 4},
        {good, "--spp 3 --time 1e30 --roulette 1e-30", "", 8, 4},
        {good, "--spp 1099511627776 --time 1e-9", "", 8, 4},
        {good, "--light none --direction uniform", "", 8, 4},
        {good, "--light none --light nee --direction uniform --direction bsdf", "", 8, 4},
    };
    for (const Row& row : rows) {
        const Folder folder;
        folder.write("file.scene", row.scene);
        INFO(row.scene, row.options);
        const Outcome o = expect_success(
            folder, "penumbra", split("--spp 8 " + row.options + " -o a.pfm -o a.png file.scene"));
        const Image image = read_pfm(folder / "a.pfm");
        CHECK(image.width == row.width);
        CHECK(image.height == row.height);
        CHECK(all_finite(image));
        CHECK(summary(o.err).found);
        const std::string warning = "file.scene: warning: " + row.warning + "\n";
        const bool coarse = sizeof(real) == 4 && contains(o.err, "are coarse here");  // said, too
        if (!coarse)
            CHECK(contains(o.err, row.warning.empty() ? "warning" : warning) ==
                  !row.warning.empty());
        CHECK(folder.all().size() == 3);
    }
}

TEST_CASE("a scene's meaning does not depend on its line ends, comments, blanks or name") {
    auto replaced = [](std::string text, const std::string& what, const std::string& by) {
        for (size_t i = 0; (i = text.find(what, i)) != text.npos; i += by.size())
            text.replace(i, what.size(), by);
        return text;
    };
    const Folder folder;
    folder.write("good.scene", good);
    expect_success(folder, "penumbra", split("--spp 2 -o good.pfm good.scene"));
    const std::string scenes[] = {
        replaced(good, "\n", "\r\n"),
        replaced(good, " ", "\t"),
        replaced(good, "\n", "# comment with 'words' 1 2 3\n\n  # another\n"),
        replaced(good, "\n", "   \n\n\n\t"),
        good.substr(0, good.size() - 1),
        replaced(good, ".5", "+5e-1"),
        "# sphere\n" + good + "# size 3 3\n#",
        good + "light other 3 3 3\n",  // nothing is made of it
    };
    for (const std::string& scene : scenes)
        for (const std::string name :
             {"a.scene", "a folder/a scene's \"name\" .scene", "--/a", "a"}) {
            INFO(name, ":\n", scene);
            folder.write(name, scene);
            const Words words{"--spp", "2", "-o", "an image.pfm", "./" + name};
            expect_success(folder, "penumbra", words);
            CHECK(folder.same("an image.pfm", "good.pfm"));
            fs::remove(folder.path / "an image.pfm");
        }
}

// ---- Behaviour ----------------------------------------------------------------------------------

TEST_CASE("--help names every option on one page of stdout") {
    const Folder folder;
    for (const char* line : {"--help", "--help file.scene", "--spp 3 --quiet --help", "-h"}) {
        const Outcome o = run(folder, "penumbra", split(line));
        CHECK(o.status == 0);
        CHECK(o.err == "");
        for (const char* word : {"penumbra [options] SCENE",
                                 "-o FILE",
                                 "--spp N",
                                 "--time S",
                                 "--error E",
                                 "--sets K|adaptive",
                                 "uniform|bsdf",
                                 "--direction",
                                 "--light none|nee|mis",
                                 "--sampler independent|stratified|halton|sobol",
                                 "--view radiance|normal|depth|albedo|bvh",
                                 "--keep F.film",
                                 "--rows A-B",
                                 "--pixel X,Y",
                                 "--sample I[,K]",
                                 "Exit status: 0 done",
                                 "--depth N",
                                 "--roulette T",
                                 "--seed N",
                                 "--threads N",
                                 "--size WxH",
                                 "--exposure E",
                                 "--quiet",
                                 "--help",
                                 ".png",
                                 ".pfm"}) {
            INFO(std::string(word));
            CHECK(contains(o.out, word));
        }
        CHECK(o.out.ends_with("\n"));
        CHECK(std::count(o.out.begin(), o.out.end(), '\n') <= 64);
        std::istringstream lines(o.out);
        for (std::string text; std::getline(lines, text);) CHECK(text.size() <= 80);
    }
    CHECK(folder.all().empty());
}

TEST_CASE("--quiet prints nothing, but errors") {
    const Folder folder;
    folder.write("file.scene", good + "triangle 0 0 0 1 1 1 2 2 2 m\n");
    const Outcome o = expect_success(folder, "penumbra", split("--quiet --spp 2 file.scene"));
    CHECK(o.err == "");
    expect_refusal(folder, "penumbra", split("--quiet --spp 0 file.scene"), "--spp: '0'");
    folder.write("bad.scene", "x");
    expect_refusal(folder, "penumbra", split("--quiet bad.scene"), "bad.scene:1: unknown keyword");
}

TEST_CASE("the summary is a line of samples, seconds, Mrays/s and the error, and one of files") {
    const Folder folder;
    folder.write("file.scene", good);
    for (const auto& [options, samples] : std::map<std::string, unsigned>{
             {"--sets 2", 64}, {"--sets 1 --spp 7", 7}, {"--spp 9 --spp 2 --time 1e6", 2}}) {
        const Outcome o = expect_success(folder, "penumbra", split(options + " file.scene"));
        INFO(o.err);
        const Summary s = summary(o.err);
        REQUIRE(s.found);
        CHECK(s.scene == "file.scene");
        CHECK(s.samples == samples);
        CHECK(s.seconds >= 0);
        CHECK(s.speed > 0);
        CHECK_FALSE(s.interrupted);
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 2);
        CHECK(o.err.ends_with("\nwrote out/file.png, out/file.pfm\n"));
    }
    const Outcome o =
        expect_success(folder, "penumbra", split("-o a.pfm --stats s.json -o b.png file.scene"));
    CHECK(o.err.ends_with("\nwrote a.pfm, b.png, s.json\n"));
}

TEST_CASE("--time stops before --spp is reached; 64 samples are meant only if neither is given") {
    const Folder folder;
    folder.write("file.scene", good);
    const Outcome o =
        expect_success(folder, "penumbra", split("--spp 1000000000 --time 0.1 file.scene"));
    CHECK(summary(o.err).samples > 0);
    CHECK(summary(o.err).samples < 1000000000);
    folder.write("few.scene", good + "samples 3\n");
    for (const auto& [options, samples] :
         std::map<std::string, int>{{"--sets 1", 3}, {"--sets 2", 4}, {"--sets 1 --spp 5", 5}})
        CHECK(summary(expect_success(folder, "penumbra", split(options + " few.scene")).err)
                  .samples == samples);
    const Outcome timed = expect_success(folder, "penumbra", split("--time 0.2 few.scene"));
    CHECK(summary(timed.err).samples > 3);
}

TEST_CASE("a scene may come through a pipe") {
    const Folder folder;
    folder.write("file.scene", good);
    expect_success(folder, "penumbra", split("--spp 2 -o a.pfm file.scene"));
    Process process(folder, "penumbra", split("--spp 2 -o b.pfm /dev/stdin"), {.input = good});
    CHECK(process.finish().status == 0);
    CHECK(folder.same("a.pfm", "b.pfm"));
}

TEST_CASE("a picture that is black, though there are lights, gets a hint") {
    const Folder folder;
    const std::string quad = camera + "size 4 4\nlight l 1 1 1\nquad -1 -1 0 ";
    folder.write("faces.scene", quad + "2 0 0  0 2 0  l\n");
    folder.write("turned.scene", quad + "0 2 0  2 0 0  l\n");
    auto err = [&](const std::string& line) {
        return expect_success(folder, "penumbra", split("--spp 2 -o a.pfm " + line)).err;
    };
    CHECK(contains(err("turned.scene"), "turned.scene: all is black: no light reaches the camera"));
    CHECK(err("--quiet turned.scene") == "");
    CHECK_FALSE(contains(err("faces.scene"), "black"));
    CHECK_FALSE(contains(err("--view albedo turned.scene"), "all is black"));
    CHECK_FALSE(contains(err("--rows 0-1 turned.scene"), "all is black"));  // others may be lit
}

TEST_CASE("--pixel names the material and the line of what a path meets") {
    const Folder folder;
    folder.write("m.obj", "v -9 -1 -9\nv -9 -1 9\nv 9 -1 9\nv 9 -1 -9\nf 1 2 3 4\n");
    folder.write("file.scene", good + "mesh m.obj 1 0 0 0 m\n");
    const Outcome o = run(folder, "penumbra", split("--size 3x3 --pixel 1,1 file.scene"));
    CHECK(o.status == 0);
    CHECK(contains(o.out, "vertex 0: shape 0, material 'm', line 5, at distance 4."));
    bool ground = false;
    for (int sample = 0; sample < 20 && !ground; ++sample) {
        const std::string line = "--size 3x3 --pixel 1,2 --sample " + std::to_string(sample);
        ground = contains(run(folder, "penumbra", split(line + " file.scene")).out,
                          ", material 'm', line 7, at distance ");
    }
    CHECK(ground);
}

TEST_CASE("--pixel names each kind of light") {
    const Folder folder;
    for (const auto& [kind, shape] :
         std::map<std::string, std::string>{{"sphere", "sphere 0 5 0 1 l"},
                                            {"triangle", "triangle -1 5 -1  1 5 -1  0 5 1  l"},
                                            {"quad", "quad -1 5 -1  2 0 0  0 0 2  l"},
                                            {"point", "pointlight 0 5 0  1 1 1"}}) {
        folder.write("file.scene", "size 3 3\n" + camera +
                                       "diffuse m .5 .5 .5\nlight l 1 1 1\n"
                                       "quad -9 -1 -9  0 0 18  18 0 0  m\n" +
                                       shape + "\n");
        const Outcome o = run(folder, "penumbra", split("--pixel 1,2 file.scene"));
        INFO(o.out);
        CHECK(contains(o.out, "  light sample: " + kind + " light, chosen with probability 1, "));
    }
}

TEST_CASE("--stats: every key, and its relation to what was asked for and done") {
    const Folder folder;
    folder.write("file.scene", good + "depth 7\nquad -9 -1 -9  0 0 18  18 0 0  m\n");
    auto stats = [&](const std::string& options) {
        expect_success(folder, "penumbra", split(options + " --stats s.json -o a.pfm file.scene"));
        std::map<std::string, std::string> values;
        std::istringstream lines(folder.read("s.json"));
        for (std::string line; std::getline(lines, line);) {
            const size_t colon = line.find("\": ");
            if (colon == line.npos) continue;
            std::string value = line.substr(colon + 3);
            if (value.ends_with(',')) value.pop_back();
            CHECK(values.emplace(line.substr(3, colon - 3), value).second);
        }
        return values;
    };
    const std::string line = "--seed 5 --size 16x8 --spp 24 ";
    const auto one = stats(line + "--threads 1"), three = stats(line + "--threads 3"),
               twice = stats(line + "--threads 1 --spp 48");
    const std::map<std::string, std::string> asked = {
        {"scene", "\"file.scene\""},
        {"width", "16"},
        {"height", "8"},
        {"error", "null"},
        {"sets", "\"adaptive\""},
        {"sampler", "\"sobol\""},
        {"direction", "\"bsdf\""},
        {"light", "\"mis\""},
        {"roulette", "0.25"},
        {"view", "\"radiance\""},
        {"rows", "null"},
        {"seed", "5"},
        {"threads", "1"},
        {"depth", "7"},
        {"precision", sizeof(real) == 4 ? "\"float\"" : "\"double\""},
        {"interrupted", "false"},
        {"d_rel_reason", "null"},
        {"bias", "\"unbiased\""},
        {"stopped_by", "\"samples\""}};
    const std::set<std::string> of_time = {"seconds", "cpu_seconds", "mrays_per_second",
                                           "seconds_to_half_d_rel", "peak_memory_bytes"},
                                of_samples = {"samples_per_pixel",    "rays",
                                              "mean_radiance",        "variance_of_mean",
                                              "sets_per_pixel",       "d_rel",
                                              "d_rel_standard_error", "d_rel_by_spread"};
    CHECK(one.size() == asked.size() + of_time.size() + of_samples.size());
    auto number = [](const auto& values, const std::string& key) {
        const std::string& text = values.at(key);
        return std::strtod(text.c_str() + (text[0] == '['), nullptr);
    };
    for (const auto& [key, value] : one) {
        INFO(key);
        if (asked.contains(key)) {
            CHECK(value == asked.at(key));
            if (key != "threads") CHECK(three.at(key) == value);
        } else if (of_samples.contains(key)) {
            CHECK(three.at(key) == value);
            CHECK(number(one, key) > 0);
            // The same pilot chooses the same replications.
            if (key == "sets_per_pixel")
                CHECK(value == twice.at(key));
            else
                CHECK(value != twice.at(key));
        } else {
            CHECK(of_time.contains(key));
            CHECK(number(one, key) > 0);
        }
    }
    CHECK(number(one, "samples_per_pixel") == doctest::Approx(12 * number(one, "sets_per_pixel")));
    CHECK(number(twice, "samples_per_pixel") ==
          doctest::Approx(24 * number(one, "sets_per_pixel")));
    CHECK(number(one, "mrays_per_second") ==
          doctest::Approx(number(one, "rays") / number(one, "seconds") * 1e-6));
    CHECK(number(one, "seconds_to_half_d_rel") <= number(one, "seconds") * 4.001);
    CHECK(number(one, "seconds_to_half_d_rel") >= number(one, "seconds") * 1.999);
    const auto band = stats(line + "--rows 2-5");
    CHECK(band.at("rows") == "\"2-5\"");
    CHECK(band.at("height") == "4");
    const auto view = stats(line + "--view normal");  // a ray a sample
    CHECK(number(view, "rays") == number(view, "samples_per_pixel") * 16 * 8);
}

TEST_CASE("--exposure changes the PNG, by the command line before the scene, and never the PFM") {
    const Folder folder;
    folder.write("a.scene",
                 camera + "size 4 4\nlight l .18 .18 .18\nsphere 0 0 0 4 l\nexposure 2\n");
    const std::pair<std::string, int> rows[] = {
        {"", 162}, {"--exposure 1", 118}, {"--exposure 9", 255}};
    for (const auto& [options, byte] : rows) {
        expect_success(folder, "penumbra", split(options + " -o a.png -o a.pfm a.scene"));
        CHECK(read_pfm(folder / "a.pfm").at(2, 2) == std::array<float, 3>{.18f, .18f, .18f});
        const std::string png = folder.read("a.png");
        int w = 0, h = 0, n = 0;
        stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                                                int(png.size()), &w, &h, &n, 3);
        REQUIRE(pixels != nullptr);
        CHECK(int(pixels[0]) == byte);
        stbi_image_free(pixels);
    }
}

TEST_CASE("on a terminal a bar shows time elapsed and time left, and goes; --quiet: no bar") {
    if (!terminal_to_be_had()) {
        MESSAGE("this machine lends no pseudo-terminal: not tested");
        return;
    }
    const Folder folder;
    folder.write("file.scene", good);
    Process loud(folder, "penumbra", split("--spp 1000000000 --time 0.5 --threads 1 file.scene"),
                 {.terminal = true});
    const Outcome o = loud.finish();
    INFO(o.err);
    CHECK(o.status == 0);
    for (const char* part :
         {"\r[", "###", "...]", " samples per pixel, ", " s elapsed, ", " s left"})
        CHECK(contains(o.err, part));
    const size_t erased = o.err.rfind("\r\033[K");
    REQUIRE(erased != o.err.npos);
    CHECK(o.err.find("file.scene: ", erased) == erased + 4);
    CHECK(summary(o.err).samples > 0);

    Process quiet(folder, "penumbra", split("--quiet --time 0.25 --threads 1 file.scene"),
                  {.terminal = true});
    CHECK(quiet.finish().err == "");
}

TEST_CASE("a sample that no image can hold: exit status 1, told where, nothing written") {
    // A lamp of 1e30 at 1e-6 of a quad that just fills pixel 2,1: 1e41, too much for float.
    const Folder folder;
    folder.write(
        "file.scene",
        "size 3 2\ncamera 0 0 3.2e-6  0 0 0  3.579821\ndiffuse m .5 .5 .5\n"
        "quad .5e-7 -1e-7 0  1e-7 0 0  0 1e-7 0  m\npointlight 1e-7 0 1e-6 1e30 1e30 1e30\n");
    folder.write("out/file.pfm", "old");
    for (const char* options : {"", "--threads 3", "--quiet"}) {
        const auto before = folder.all();
        const Outcome o = run(folder, "penumbra", split(std::string(options) + " file.scene"));
        INFO(o.err);
        CHECK(o.signal == 0);
        CHECK(o.status == 1);
        CHECK(contains(o.err, " not finite, the first at pixel 2,1 sample 0"));
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
        const bool untouched = folder.all() == before;
        CHECK(untouched);
    }
}

// ---- Determinism --------------------------------------------------------------------------------

TEST_CASE("variance and error are right however bright the light: 2^93 and 2^-80 times") {
    const Folder folder;
    struct Stated {
        double variance, d_rel, standard_error;
    };
    auto stated = [&](const std::string& light, const std::string& options) -> Stated {
        std::string scene = good;
        scene.replace(scene.find("1 1 1"), 5, light + " " + light + " " + light);
        folder.write("file.scene", scene + "quad -9 -1 -9  0 0 18  18 0 0  m\n");
        expect_success(folder, "penumbra",
                       split("--spp 8 --stats s.json -o a.pfm file.scene " + options));
        const std::string stats = folder.read("s.json");
        auto number = [&](const std::string& key) {
            const size_t at = stats.find(key);
            REQUIRE(at != stats.npos);
            return std::strtod(stats.c_str() + at + key.size(), nullptr);
        };
        return {number("\"variance_of_mean\": ["), number("\"d_rel\": "),
                number("\"d_rel_standard_error\": ")};
    };
    for (const char* options : {"--sampler independent", "", "--sets 3"}) {
        INFO(std::string(options));
        const Stated one = stated("1", options);
        CHECK(one.variance > 0);
        CHECK(one.d_rel > 0.001);
        CHECK(one.standard_error > 0);
        for (const auto& [light, exponent] : std::initializer_list<std::pair<const char*, int>>{
                 {"9903520314283042199192993792", 93},
                 {"8.27180612553027674871408692069962853565812110900878906250e-25", -80}}) {
            const Stated other = stated(light, options);
            CHECK(other.variance == std::ldexp(one.variance, 2 * exponent));
            CHECK(other.d_rel == one.d_rel);
            CHECK(other.standard_error == one.standard_error);
        }
    }
}

// ---- What an image's error is ------------------------------------------------------------------

TEST_CASE("the summary states the error, or why it is not known; --error says what ended it") {
    const Folder folder;
    folder.write("file.scene", good + "quad -9 -1 -9  0 0 18  18 0 0  m\n");
    auto told = [&](const std::string& options) {
        const Outcome o =
            expect_success(folder, "penumbra", split("-o a.pfm " + options + " file.scene"));
        INFO(o.err);
        CHECK(summary(o.err).found);
        return summary(o.err);
    };
    for (const char* options : {"", "--sampler halton", "--sets 2", "--view normal"}) {
        INFO(std::string(options));
        CHECK(told(options).error.starts_with("d_rel "));
        CHECK(contains(told(options).error, " % ± "));
        CHECK(contains(told(options).error, " % needs "));
        CHECK(told(options).stopped_by == "");
    }
    CHECK(told("--sets 1").error == "d_rel not known: one replication");
    CHECK(told("--spp 1").error == "d_rel not known: one sample");
    const Summary error = told("--error 10%"), samples = told("--error 1e-5 --spp 20 --sets 2"),
                  time = told("--error 1e-6 --time 0.05 --spp 1000000000");
    CHECK(error.stopped_by == "error");
    CHECK(error.samples >= 16);
    CHECK(samples.stopped_by == "samples");
    CHECK(samples.samples == 20);
    CHECK(time.stopped_by == "time");
    CHECK(time.samples < 1000000000);
}

TEST_CASE("--pixel replays a sample of any set: the mean of two is the pixel") {
    const Folder folder;
    folder.write("file.scene", good + "quad -9 -1 -9  0 0 18  18 0 0  m\n");
    for (const std::string more : {"", "--light nee "}) {
        const std::string line = more + "--size 6x6 --seed 4 ";
        expect_success(folder, "penumbra", split(line + "--spp 2 -o a.pfm file.scene"));
        auto L = [&](const std::string& set) {
            const Outcome o =
                run(folder, "penumbra", split(line + "--pixel 1,5" + set + " file.scene"));
            CHECK(o.status == 0);
            const size_t at = o.out.rfind("\nL: ");
            REQUIRE(at != o.out.npos);
            return std::strtod(o.out.c_str() + at + 4, nullptr);
        };
        const double first = L(" --sample 0,0"), second = L(" --sample 0,1");
        CHECK(L("") == first);
        CHECK(first != second);
        CHECK(read_pfm(folder / "a.pfm").at(1, 5)[0] == float((first + second) / 2));
    }
}

TEST_CASE("an image depends on the seed, and not on threads, passes or the run") {
    const Folder folder;
    folder.write("file.scene",
                 good +
                     "phong p .2 .2 .2 .5 .5 .5 20\nglass g 1.5\nquad -9 -1 -9  0 0 18  18 0 0  p\n"
                     "sphere 1 0 1 .5 g\npointlight 2 3 3  5 5 5\n");
    auto image = [&](const std::string& options) {
        expect_success(folder, "penumbra",
                       split("--spp 5 --size 33x17 " + options + " -o a.pfm -o a.png file.scene"));
        return folder.read("a.pfm") + folder.read("a.png");
    };
    const std::string one = image("--threads 1");
    for (const char* options : {"--threads 1", "--threads 2", "--threads 3", "--threads 7",
                                "--threads 100", "", "--seed 0", "--time 1e6", "--quiet"}) {
        INFO(std::string(options));
        const bool same = image(options) == one;
        CHECK(same);
    }
    std::set<std::string> different{one};
    for (const char* options : {"--seed 1", "--seed 2", "--seed 18446744073709551615", "--spp 8",
                                "--spp 4", "--light nee", "--direction uniform", "--depth 1",
                                "--sets 1", "--sets 4", "--sampler halton", "--roulette 1"})
        different.insert(image(options));
    CHECK(different.size() == 13);
}
