// whole/behaviour_test.cpp  accepted scenes and options, output, images that depend on the seed
#include <set>
#include <valarray>

#include "base/approx.h"
#include "text/png.h"
#include "whole/process.h"

namespace {

const std::string in_light =
    "size 8 4\ndiffuse m .5 .5 .5\nlight l 1 1 1 twosided m\nbox 9 9 9 30 -7 -4 -4 l\n";
const std::string lamp = "light l 1 1 1\nsphere 0 0 0 1 l\n";

// What is said of a sample of pixel 1,2.
std::string replayed(const Place& place, const std::string& options = "") {
    return expect_exit(place, "penumbra --pixel 1,2 file.scene " + options, 0).out;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (size_t i = 0; (i = text.find(what, i)) != text.npos; i += by.size())
        text.replace(i, what.size(), by);
    return text;
}

}  // namespace

TEST_CASE("odd scenes are accepted: every pixel is finite, and what is dropped is counted") {
    const std::string in_the_plane = "quad 0 0 0 1 2 3 2 4 6 m\n";
    struct Row {
        std::string scene, options = {}, warning = {};
        int width = 8, height = 4;
    };
    const Row rows[] = {
        {good},
        {good + "triangle 0 0 0 1 1 1 2 2 2 m\n", "", "dropped 1 triangle without area"},
        {good + "triangle 1 2 3 1 2 3 1 2 3 m\n" + in_the_plane + "triangle 0 0 0 1 0 0 1 0 0 l\n",
         "", "dropped 4 triangles without area"},
        {good + "quad 0 0 0 0 0 0 0 1 0 l\n", "", "dropped 2 triangles without area"},
        {camera + "size 8 4\ndiffuse m 1 1 1\nsphere 0 0 0 1 m\n", "",
         "no light: the image will be black"},
        {camera + "size 1 1\n" + lamp, "", "", 1, 1},
        {camera + "size 16384 1\n" + lamp, "", "", 16384, 1},
        {camera + "size 1 16384\n" + lamp, "", "", 1, 16384},
        {good, "--size 1x1", "", 1, 1},
        {good, "--size 16384x1", "", 16384, 1},
        {good, "--size 3x5", "", 3, 5},
        // Cameras inside balls, inside a glowing box, and inside a rotated one: coplanar points.
        {good + "glass g 1.5\nsphere 0 0 5 1 g\n"},
        {good + "sphere 1 0 5 3 l\n"},
        {good + "light t 1 1 1 twosided m\nsphere 0 0 3 2 t\n"},  // the eye is on the sphere
        {good + "box 1 1 1 0 -.5 -.5 4.5 l\n"},
        {camera + in_light, "--spp 200"},
        {camera + in_light, "--spp 200 --light nee --direction uniform"},
        // The extremes of every number.
        {good + "phong p .5 .5 .5 .5 .5 .5 1e6\nphong q 0 0 0 1 1 1 0\nsphere 1 0 0 1 p\n"
                "sphere -1 0 0 1 q\n",
         "--spp 200"},
        {good + "glass g 1\nglass h 1e-3\nglass i 1e3\nsphere 1 0 0 1 g\nsphere -1 0 0 1 h\n"
                "sphere 0 1 0 1 i\n",
         "--spp 200"},
        {good + "sphere 0 -1e8 0 99999999 m\nsphere 1 2 1 1e-8 l\n"},
        {good + "depth 0\nexposure 1e-30\n"},
        {good + "depth 1000000\nexposure 1e30\n"},
        {good, "--depth 0 --exposure 1e-30 --seed 18446744073709551615 --threads 1024"},
        {good, "--depth 1000000 --exposure 1e30 --seed 0 --threads 1 --roulette 1"},
        {good, "--spp 3 --time 1e30 --roulette 1e-30"},
        {good, "--spp 1099511627776 --time 1e-9"},
        {good, "--light none --direction uniform"},
        {good, "--light none --light nee --direction uniform --direction bsdf"},
    };
    for (const Row& row : rows) {
        const Place place(row.scene);
        INFO(row.scene, row.options);
        const Outcome o = place.render("--spp 8 " + row.options + " -o a.pfm -o a.png");
        const Image image = read_pfm(place / "a.pfm");
        CHECK(image.width == row.width);
        CHECK(image.height == row.height);
        CHECK(!first_non_finite(image));
        CHECK(summary(o.err).found);
        // Another warning, of a precision that is too low, may precede it.
        const bool is_warned = contains(o.err, "file.scene: warning: " + row.warning + "\n");
        if (!row.warning.empty())
            CHECK(is_warned);
        else if (sizeof(real) == 8 || !contains(o.err, "precision is too low here"))
            CHECK_FALSE(contains(o.err, "warning"));
        CHECK(place.files() == 3);
    }
}

TEST_CASE("a scene's meaning does not depend on its line ends, comments, blanks or name") {
    const Folder folder;
    folder.write("good.scene", good);
    expect_success(folder, "penumbra --spp 2 -o good.pfm good.scene");
    const std::string blanks = replaced(replaced(good, ".5", "+5e-1"), " ", " \t "),
                      ends = "   # comment with 'words' 1 2 3\r\n\n\n\t",
                      unused = "light other 3 3 3\n";
    for (const std::string& scene : {replaced(good, "\n", "\r\n"), good.substr(0, good.size() - 1),
                                     "# sphere\n" + replaced(blanks, "\n", ends) + unused + "#"})
        for (const std::string name :
             {"a.scene", "a folder/a scene's \"name\" .scene", "--/a", "a"}) {
            INFO(name, ":\n", scene);
            folder.write(name, scene);
            expect_success(folder,
                           Words{"penumbra", "--spp", "2", "-o", "an image.pfm", "./" + name});
            CHECK(folder.same("an image.pfm", "good.pfm"));
            fs::remove(folder.path / "an image.pfm");
        }
}

TEST_CASE("--help is one page of stdout, and makes no file") {
    const Folder folder;
    for (const std::string line : {"--help", "--help file.scene", "--spp 3 --quiet --help", "-h"})
        expect_help(folder, "penumbra " + line, 92,
                    "penumbra [options] SCENE;Exit status: 0 done;-o, --output FILE;--version");
    CHECK(folder.files() == 0);
}

TEST_CASE("the summary is a line of samples, seconds, Mrays/s and the error, and one of files") {
    const Place place(good + "triangle 0 0 0 1 1 1 2 2 2 m\n");  // a warning
    CHECK(place.render("--quiet --spp 2").err == "");
    expect_refusal(place, "penumbra --quiet --spp 0 file.scene", "--spp: '0'");
    for (const auto& [options, samples] :
         std::map<std::string, unsigned>{{"--replications 2", 64},
                                         {"--replications 1 --spp 7", 7},
                                         {"--spp 9 --replications 2 --spp 2 --time 1e6", 2}}) {
        const Outcome o = place.render("--size 64x64 " + options);
        INFO(o.err);
        const Summary s = summary(o.err);
        REQUIRE(s.found);
        CHECK(s.scene == "file.scene");
        CHECK(s.samples == samples);
        CHECK(s.seconds >= 0);
        CHECK(s.speed > 0);
        CHECK_FALSE(s.interrupted);
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 3);
        CHECK(o.err.ends_with("\nwrote out/file.png, out/file.pfm\n"));
    }
    const Outcome o = place.render("-o a.pfm --stats s.json -o b.png");
    CHECK(o.err.ends_with("\nwrote a.pfm, b.png, s.json\n"));
}

TEST_CASE("a scene may come through a pipe") {
    const Place place(good);
    place.render("--spp 2 -o a.pfm");
    expect_exit(place, "penumbra --spp 2 -o b.pfm /dev/stdin", 0, {.input = good});
    CHECK(place.same("a.pfm", "b.pfm"));
    for (int run = 0; run < 2; ++run)  // the second resumes the film of the first
        expect_exit(place, "penumbra --spp 2 --keep a.film -o c.pfm /dev/stdin", 0,
                    {.input = good});
    CHECK(place.same("a.pfm", "c.pfm"));
}

TEST_CASE("a picture that is black, though there are lights, gets a hint") {
    const std::string quad = camera + "size 4 4\nlight l 1 1 1\nquad -1 -1 0 ";
    const Place faces(quad + "2 0 0  0 2 0  l\n"), turned(quad + "0 2 0  2 0 0  l\n");
    CHECK(contains(turned.render("--spp 2").err,
                   "file.scene: the image is black: no light reaches the camera"));
    CHECK(turned.render("--spp 2 --quiet").err == "");
    CHECK_FALSE(contains(faces.render("--spp 2").err, "black"));
    CHECK_FALSE(contains(turned.render("--spp 2 --view albedo").err, "the image is black"));
    const std::string band = turned.render("--spp 2 --rows 0-1 -o a.pfm").err;
    CHECK_FALSE(contains(band, "the image is black"));  // other bands may be lit
}

TEST_CASE("--pixel names the material and the line of what a path meets") {
    const Place place(good + "mesh m.obj 1 0 0 0 m\n");
    place.write("m.obj", "v -9 -1 -9\nv -9 -1 9\nv 9 -1 9\nv 9 -1 -9\nf 1 2 3 4\n");
    CHECK(contains(replayed(place, "--size 3x3 --pixel 1,1"),
                   "vertex 0: shape 0, material 'm', line 5, at distance 4."));
    std::string all;
    for (int sample = 0; sample < 20; ++sample)
        all += replayed(place, "--size 3x3 --sample " + std::to_string(sample));
    CHECK(contains(all, ", material 'm', line 7 (m.obj:5), at distance "));
}

TEST_CASE("--pixel names each kind of light, or why none is sampled") {
    const std::string ground = "quad -9 -1 -9  0 0 18  18 0 0  l\n",
                      no = "no light sample: ", grey = "diffuse l .5 .5 .5\n" + ground,
                      under = "light k 1 1 1\n" + grey;
    auto sampled = [](const std::string& kind) {
        return "light sample: " + kind + " light, chosen with probability 1, ";
    };
    for (const auto& [words, expected] : std::map<std::string, std::string>{
             {under + "sphere 0 5 0 1 k", sampled("sphere")},
             {under + "triangle -1 5 -1  1 5 -1  0 5 1  k", sampled("triangle")},
             {under + "quad -1 5 -1  2 0 0  0 0 2  k", sampled("quad")},
             {under + "pointlight 0 5 0  1 1 1", sampled("point")},
             {grey + "pointlight 0 -5 0 1 1 1", no + "the light is behind the surface\n"},
             {"mirror l .5 .5 .5\n" + ground + "pointlight 0 5 0 1 1 1",
              no + "the surface is a mirror or glass\n"},
             {grey, no + "the scene has no light\n"}}) {
        const std::string told = replayed(Place("size 3 3\n" + camera + words + "\n"));
        INFO(told);
        CHECK(contains(told, "  " + expected));
        CHECK(told.starts_with(
            "pixel 1,2, sample 0 of replication 0, seed 0\nposition in the pixel: "));
    }
}

TEST_CASE("--pixel prints all that the radiance consists of, in every light mode") {
    // The lamp hangs so low that most paths from the ground meet it.
    const Place place("size 3 3\n" + camera + "diffuse m .5 .4 .3\nlight l 3 2 1\n" +
                      "quad -9 -1 -9  0 0 18  18 0 0  m\nquad -9 1 -9  18 0 0  0 0 18  l\n");
    for (const auto& [mode, weight] : std::map<std::string, std::string>{
             {"none", "MIS weight: 1\n"}, {"nee", "MIS weight: 0\n"}, {"mis", "MIS weight: 0."}}) {
        std::string printed;
        for (int sample = 0; sample < 8; ++sample) {
            const std::string told =
                replayed(place, "--light " + mode + " --sample " + std::to_string(sample));
            INFO(told);
            std::map<std::string, std::valarray<double>> said;
            std::valarray<double> L(0.0, 3);
            std::istringstream lines(told);
            for (std::string line; std::getline(lines, line);) {
                const size_t colon = line.find(':');
                std::valarray<double> numbers(0.0, 3);
                std::istringstream in(line.substr(std::min(line.size(), colon + 1)));
                for (double& x : numbers) in >> x;
                const std::string key = line.substr(0, colon);
                said[key] = numbers;
                if (key == "  MIS weight")
                    L += said["  throughput"] * said["  emission"] * numbers[0];
                if (key == "    reflected") L += said["  throughput"] * numbers;
            }
            REQUIRE(said.contains("L"));
            for (size_t c = 0; c < 3; ++c) CHECK(L[c] == approx(said["L"][c], 1e-15));
            printed += told;
        }
        CHECK(contains(printed, "  emission: 3 2 1\n  " + weight));
    }
}

TEST_CASE("--stats: every key, and its relation to what was asked for and done") {
    const Place place(good + "depth 7\nquad -9 -1 -9  0 0 18  18 0 0  m\n");
    auto stats = [&](const std::string& options) {
        std::map<std::string, std::string> values;
        const std::string json = place.stats(options);
        std::istringstream lines(json);
        for (std::string line; std::getline(lines, line);) {
            const size_t colon = line.find("\": ");
            if (colon == line.npos) continue;
            const std::string key = line.substr(3, colon - 3);
            CHECK(values.emplace(key, stated(json, key)).second);
        }
        return values;
    };
    const std::string line = "--seed 5 --size 32x16 --spp 48 ";
    const auto one = stats(line + "--threads 1"), three = stats(line + "--threads 3"),
               twice = stats(line + "--threads 1 --spp 96");
    const Words of_time = split(
                    "seconds cpu_seconds mrays_per_second seconds_to_half_d_rel "
                    "peak_memory_bytes"),
                of_samples = split(
                    "samples_per_pixel repeat_with_spp rays mean_radiance variance_of_mean "
                    "replications_per_pixel d_rel d_rel_standard_error d_rel_by_spread");
    auto among = [](const Words& words, const std::string& word) {
        return std::find(words.begin(), words.end(), word) != words.end();
    };
    CHECK(one.size() == 19 + of_time.size() + of_samples.size());
    auto number = [](const auto& values, const std::string& key) {
        const std::string& text = values.at(key);
        return std::strtod(text.c_str() + (text[0] == '['), nullptr);
    };
    CHECK(number(one, "repeat_with_spp") == 48);
    for (const auto& stat : one) {
        const auto& [key, value] = stat;
        INFO(stat.first);
        if (among(of_time, key)) {
            CHECK(number(one, key) > 0);
        } else if (among(of_samples, key)) {
            CHECK(three.at(key) == value);
            CHECK(number(one, key) > 0);
            // The same pilot samples lead to the same weights.
            CHECK((value == twice.at(key)) == (key == "replications_per_pixel"));
        } else {  // what was asked for, and how it ended
            CHECK((three.at(key) == value) == (key != "threads"));
        }
    }
    CHECK(said(one.at("scene"), one.at("width"), one.at("height"), one.at("depth"), one.at("rows"),
               one.at("stopped_by")) == R"("file.scene" 32 16 7 null "samples")");
    const double seconds = number(one, "seconds"), samples = number(one, "samples_per_pixel");
    CHECK(number(one, "replications_per_pixel") == 2);
    CHECK(samples == doctest::Approx(48).epsilon(0.25));  // a pixel of mean noise has 48
    CHECK(number(twice, "samples_per_pixel") == 2 * samples);
    CHECK(number(one, "mrays_per_second") == doctest::Approx(number(one, "rays") / seconds * 1e-6));
    CHECK(number(one, "seconds_to_half_d_rel") == doctest::Approx(4 * seconds).epsilon(1e-3));
    const auto band = stats(line + "--rows 2-5");
    CHECK(band.at("rows") == "\"2-5\"");
    CHECK(band.at("height") == "4");
    const auto view = stats(line + "--view normal");  // one ray per sample
    CHECK(number(view, "rays") == number(view, "samples_per_pixel") * 32 * 16);
}

TEST_CASE("--exposure changes the PNG, by the command line before the scene, and never the PFM") {
    const Place place(camera + "size 4 4\nlight l .18 .18 .18\nsphere 0 0 0 4 l\nexposure 2\n");
    for (const auto& [options, byte] :
         {std::pair{"", 162}, {"--exposure 1", 118}, {"--exposure 9", 255}}) {
        place.render(std::string(options) + " -o a.png -o a.pfm");
        CHECK(read_pfm(place / "a.pfm").at(2, 2) == std::array<float, 3>{.18f, .18f, .18f});
        CHECK(decode_png(place.read("a.png")).bytes[0] == byte);
    }
}

TEST_CASE("on a terminal a bar shows time elapsed and time left, and goes; --quiet: no bar") {
    if (!terminal_to_be_had()) return;
    const Place place(good);
    const Outcome o =
        expect_exit(place, "penumbra --spp 1000000000 --time 0.5 --threads 1 file.scene", 0,
                    {.terminal = true});
    CHECK(missing(o.err, "\r[;###;...]; samples per pixel, ; s elapsed, ; s left") == "");
    const size_t erased = o.err.rfind("\r\033[K");
    REQUIRE(erased != o.err.npos);
    CHECK(o.err.find("file.scene: ", erased) == erased + 4);
    CHECK(summary(o.err).samples > 0);
    const std::string quiet = "penumbra --quiet --time 0.25 --threads 1 file.scene";
    CHECK(run(place, quiet, {.terminal = true}).err == "");
}

TEST_CASE("variance and error are right however bright the light: 2^93 and 2^-80 times") {
    auto stats = [&](const std::string& light, const std::string& options) {
        const Place place(replaced(diffuse_scene, "1 1 1", light + " " + light + " " + light));
        return place.stats("--spp 8 " + options);
    };
    for (const std::string options : {"--sampler independent", "", "--replications 3"}) {
        INFO(options);
        const std::string one = stats("1", options);
        CHECK(number_of(one, "variance_of_mean") > 0);
        CHECK(number_of(one, "d_rel") > 0.001);
        CHECK(number_of(one, "d_rel_standard_error") > 0);
        for (const auto& [light, exponent] :
             {std::pair{"9903520314283042199192993792", 93},
              {"8.27180612553027674871408692069962853565812110900878906250e-25", -80}}) {
            const std::string other = stats(light, options);
            CHECK(number_of(other, "variance_of_mean") ==
                  std::ldexp(number_of(one, "variance_of_mean"), 2 * exponent));
            for (const char* key : {"d_rel", "d_rel_standard_error"})
                CHECK(stated(other, key) == stated(one, key));
        }
    }
}

TEST_CASE("the summary states the error, or why it is not known") {
    const Place place(diffuse_scene);
    auto told = [&](const std::string& options) {
        const Summary s = summary(place.render("-o a.pfm " + options).err);
        CHECK(s.found);
        return s.error;
    };
    for (const std::string options : {"", "--sampler halton", "--replications 2"}) {
        INFO(options);
        const std::string error = told(options);
        CHECK(error.starts_with("estimated error "));
        CHECK(missing(error, " % ± ; s more for ") == "");
    }
    CHECK(told("--replications 1") == "error not known: one replication");
    CHECK(told("--spp 1") == "error not known: one sample");
    CHECK(told("--view normal") == "");
}

TEST_CASE("--pixel replays any sample of any set: their mean is the pixel, bit for bit") {
    const Place place(diffuse_scene);
    for (const std::string more : {"", "--light nee ", "--sampler independent ",
                                   "--sampler stratified ", "--sampler halton "}) {
        const std::string line = more + "--size 6x6 --seed 4 ";
        auto L = [&](const std::string& set) {
            const std::string told = replayed(place, "--pixel 1,5 " + line + set);
            const size_t at = told.rfind("\nL: ");
            REQUIRE(at != told.npos);
            return std::strtod(told.c_str() + at + 4, nullptr);
        };
        const double first = L("--sample 0,0") + L("--sample 1"),
                     second = L("--sample 0,1") + L("--sample 1,1");
        CHECK(L("") == L("--sample 0,0"));
        CHECK(first != second);
        const Image image = place.image(line + "--spp 4 --replications 2");
        CHECK(image.at(1, 5)[0] == float((first + second) / 4));
    }
}

TEST_CASE("an image depends on the seed, and not on threads, passes or the run") {
    const Place place(good +
                      "phong p .2 .2 .2 .5 .5 .5 20\nglass g 1.5\n"
                      "quad -9 -1 -9  0 0 18  18 0 0  p\nsphere 1 0 1 .5 g\n"
                      "pointlight 2 3 3  5 5 5\n");
    auto image = [&](const std::string& options) {
        place.render("--spp 5 --size 33x17 " + options + " -o a.pfm -o a.png");
        return place.read("a.pfm") + place.read("a.png");
    };
    const std::string one = image("--threads 1");
    for (const std::string& options :
         parts_of("--threads 1;--threads 2;--threads 3;--threads 7;--threads 100;;--seed 0;"
                  "--time 1e6;--quiet")) {
        INFO(options);
        const bool same = image(options) == one;
        CHECK(same);
    }
    std::set<std::string> different{one};
    for (const std::string& options :
         parts_of("--seed 1;--seed 2;--seed 18446744073709551615;--spp 9;--spp 4;--light nee;"
                  "--direction uniform;--depth 1;--replications 1;--replications 4;--sampler "
                  "halton;--roulette 1"))
        different.insert(image(options));
    CHECK(different.size() == 13);
}
