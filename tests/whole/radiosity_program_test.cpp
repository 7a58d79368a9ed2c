// whole/radiosity_program_test.cpp  build/radiosity as its user meets it
#include "whole/process.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

namespace {

const std::string methods[] = {"shooting", "hierarchy", "particles"};

// A lamp and a block in a room, all diffuse; the camera is in the room.
const std::string room =
    "size 33 17\ncamera 0 0 4.5  0 0 0  60\ndiffuse white .7 .7 .7\ndiffuse red .6 .1 .1\n"
    "light lamp 8 8 8\nbox 10 10 10  0  -5 -5 -5  white\nbox 2 4 2  30  -2 -5 -2  red\n"
    "quad -1 4.9 -1  2 0 0  0 0 2  lamp\n";

// Walls that glow, seen from within: everywhere E = pi L.
const std::string glowing =
    "size 9 5\ncamera .3 .2 4  0 0 0  70\nlight l .18 .18 .18 twosided\n"
    "box 10 10 10  0  -5 -5 -5  l\n";

struct RunSummary {
    unsigned long long triangles = 0, found = 0;
    double seconds = -1, speed = -1;
    bool interrupted = false, complete = false;
};

// Of the line "NAME: 8 triangles, 3 shots, 1 % unshot, 0.1 s, 1 Mrays/s", or "..., 3 particles".
RunSummary line_of(const std::string& err, const std::string& name) {
    RunSummary s;
    const size_t end = err.find('\n', err.find(" Mrays/s"));
    if (end == err.npos) return s;
    const std::string line = err.substr(0, end);
    const size_t start = line.rfind(name + ": ");
    if (start == line.npos) return s;
    char what[20] = "";
    if (std::sscanf(line.c_str() + start + name.size(), ": %llu triangles, %llu %19[a-z]",
                    &s.triangles, &s.found, what) != 3)
        return s;
    const size_t seconds = line.rfind(" s, "), before = line.rfind(", ", seconds - 1);
    s.interrupted = line.ends_with(" (interrupted)");
    s.complete =
        std::sscanf(line.c_str() + before, ", %lf s, %lf Mrays/s", &s.seconds, &s.speed) == 2 &&
        (std::string(what) == "shots" || std::string(what) == "particles");
    return s;
}

// A busy machine shows progress after two seconds.
int lines_but_progress(const std::string& err) {
    std::istringstream lines(err);
    int n = 0;
    for (std::string line; std::getline(lines, line);) n += !contains(line, " s elapsed, ");
    return n;
}

// A number of the statistics; "null": NaN.
double number_of(const std::string& json, const std::string& key) {
    const std::string start = "\n  \"" + key + "\": ";
    const size_t at = json.find(start);
    REQUIRE(at != json.npos);
    const std::string value = json.substr(at + start.size(), 40);
    return value.starts_with("null") ? std::nan("") : std::strtod(value.c_str(), nullptr);
}

double mean_of(const Image& image) {
    double sum = 0;
    for (const auto& pixel : image.pixels) sum += double(pixel[1]);
    return sum / double(image.pixels.size());
}

// Relative, whatever the value: doctest's own tolerance is that of 1 + the value.
doctest::Approx about(double value, double relative) {
    return doctest::Approx(value).epsilon(relative).scale(0);
}

// A folder with a scene.
struct Place : Folder {
    explicit Place(const std::string& scene) { write("file.scene", scene); }
};

}  // namespace

// ---- What it says and writes --------------------------------------------------------------------

TEST_CASE("radiosity --help names every option on one page of stdout") {
    const Folder folder;
    for (const char* line : {"--help", "-h", "--help file.scene"}) {
        const Outcome o = run(folder, "radiosity", split(line));
        CHECK(o.status == 0);
        CHECK(o.err == "");
        for (const char* word : {"radiosity [options] SCENE",
                                 "--method shooting|hierarchy|particles",
                                 "--mesh H",
                                 "--unshot F",
                                 "--shots N",
                                 "--particles N",
                                 "--error E",
                                 "--time S",
                                 "--sampler independent|stratified|halton|sobol",
                                 "--seed N",
                                 "--rays K",
                                 "--view luminance|illuminance|mesh",
                                 "--final-gather",
                                 "--threads N",
                                 "--size WxH",
                                 "--exposure E",
                                 "-o FILE",
                                 "--stats FILE",
                                 "--quiet",
                                 "--help",
                                 "130 interrupted"}) {
            INFO(std::string(word));
            CHECK(contains(o.out, word));
        }
        CHECK(std::count(o.out.begin(), o.out.end(), '\n') <= 90);
        std::istringstream lines(o.out);
        for (std::string text; std::getline(lines, text);) CHECK(text.size() <= 80);
    }
    CHECK(folder.all().empty());
}

TEST_CASE(
    "radiosity writes out/NAME-radiosity.png and .pfm unless told, and says so in two lines") {
    for (const std::string& method : methods) {
        INFO(method);
        const Folder folder;
        folder.write("a.scene", room);
        const Outcome o = expect_success(
            folder, "radiosity", split("--mesh 5 --stats s.json a.scene --method " + method));
        INFO(o.err);
        CHECK(folder.all().size() == 5);  // with out/ and the scene
        CHECK(o.err.ends_with("\nwrote out/a-radiosity.png, out/a-radiosity.pfm, s.json\n"));
        CHECK(lines_but_progress(o.err) == 2);
        const Image image = read_pfm(folder / "out/a-radiosity.pfm");
        CHECK(image.width == 33);
        CHECK(image.height == 17);
        CHECK(all_finite(image));
        CHECK(folder.read("out/a-radiosity.png").starts_with("\x89PNG"));

        const RunSummary s = line_of(o.err, "a.scene");
        REQUIRE(s.complete);
        CHECK_FALSE(s.interrupted);
        const std::string stats = folder.read("s.json");
        CHECK(contains(stats, "\"method\": \"" + method + "\""));
        CHECK(contains(stats, "\"interrupted\": false"));
        CHECK(contains(stats, "\"bias\": \"biased\""));
        CHECK(number_of(stats, "mesh") == 5);
        CHECK(number_of(stats, "faces") == 13);
        CHECK(number_of(stats, "elements") == double(s.triangles));
        CHECK(number_of(stats, "vertices") > 0.5 * double(s.triangles));
        CHECK(number_of(stats, "bytes") > 0);
        CHECK(number_of(stats, "rays") > 0);
        CHECK(number_of(stats, "mean_of_image") > -1);
        const bool walks = method == "particles";
        CHECK(number_of(stats, walks ? "particles" : "shots") == double(s.found));
        CHECK(number_of(stats, walks ? "shots" : "particles") == 0);
        CHECK(std::isnan(number_of(stats, walks ? "unshot" : "error_uncertainty")));
        CHECK(std::isnan(number_of(stats, "error_asked")));
        CHECK(contains(stats,
                       walks ? "\"stopped_by\": \"--particles\"" : "\"stopped_by\": \"--unshot\""));
        CHECK(!contains(o.err, "(stopped by"));
        if (walks) {
            CHECK(s.found == 1000000);
            CHECK(number_of(stats, "error") > 0);
            CHECK(number_of(stats, "error") < 0.1);
            CHECK(number_of(stats, "error_uncertainty") > 0);
            CHECK(number_of(stats, "error_uncertainty") < 0.1 * number_of(stats, "error"));
        } else {
            CHECK(number_of(stats, "unshot") <= 0.01);
            CHECK(number_of(stats, "unshot") > 0);
            CHECK(number_of(stats, "error") > 0.003);
            CHECK(number_of(stats, "error") < 0.1);
        }
    }
}

TEST_CASE("radiosity --error: what came first ends the run, and is said") {
    const Place folder(room);
    struct Row {
        std::string options, stopped_by;
    };
    const std::string walks = "--method particles ";
    const Row rows[] = {
        {walks + "--mesh 5 --error 20% --particles 1000000 --time 1000", "--error"},
        {walks + "--mesh 5 --error 1e-9 --particles 1600 --time 1000", "--particles"},
        {walks + "--mesh 5 --error 1e-9 --particles 1099511627776 --time 0.2", "--time"},
        {"--mesh 5 --error 20% --shots 1000000 --time 1000 --unshot 1e-9", "--error"},
        {"--mesh 5 --error 1e-9 --shots 1 --time 1000 --unshot 1e-8", "--shots"},
        {"--mesh 5 --error 1e-9 --time 1000 --unshot 20%", "--unshot"},
        {"--mesh 0.5 --method shooting --error 1e-9 --time 0.2", "--time"},
        {"--mesh 5 --method shooting --error 20%", "--error"}};
    for (const auto& [options, stopped_by] : rows) {
        INFO(options);
        const Outcome o = expect_success(folder, "radiosity",
                                         split("-o a.pfm --stats s.json file.scene " + options));
        INFO(o.err);
        const std::string stats = folder.read("s.json");
        CHECK(contains(stats, "\"stopped_by\": \"" + stopped_by + "\""));
        CHECK(contains(o.err, " Mrays/s (stopped by " + stopped_by + ")\n"));
        CHECK(contains(o.err, " without that of the triangles, "));
        CHECK(contains(o.err, ", error at most ") == !contains(options, "particles"));
        const double asked = number_of(stats, "error_asked"), error = number_of(stats, "error");
        CHECK(asked ==
              (contains(options, "20% ") || options.ends_with("--error 20%") ? 0.2 : 1e-9));
        CHECK((error <= asked) == (stopped_by == "--error"));
    }
    // Where nothing walks, nothing tells an error.
    folder.write("dark.scene", room.substr(0, room.find("quad")));
    const Outcome o = expect_success(
        folder, "radiosity", split("-o a.pfm --stats s.json dark.scene --error 5% " + walks));
    INFO(o.err);
    CHECK(contains(o.err, " 0 particles, error not known, "));
    CHECK(contains(folder.read("s.json"), "\"stopped_by\": null"));
    CHECK(std::isnan(number_of(folder.read("s.json"), "error")));
}

TEST_CASE("radiosity --error alone: particles in a closed white room end with a message") {
    const Place folder(
        "size 9 5\ncamera .3 .2 4  0 0 0  70\ndiffuse w 1 .5 .5\n"
        "box 10 10 10  0  -5 -5 -5  w\npointlight 0 0 0  9 9 9\n");
    const Outcome o = run(folder, "radiosity",
                          split("--method particles --mesh 5 --error 5% -o a.pfm file.scene"));
    INFO(o.err);
    CHECK(o.status == 2);
    CHECK(contains(o.err, "--error: none of 65536 particles lost light of some channel"));
    CHECK(folder.all().size() == 1);
}

TEST_CASE("statistics are UTF-8 even if the scene's name is not") {
    const Folder folder;
    folder.write("caf\xe9 \xc3\xa9.scene", room);
    const std::string options = "--stats s.json --quiet -o a.pfm --size 8x4";
    for (const std::string program : {"penumbra --spp 1", "radiosity --mesh 5 --shots 2"}) {
        std::vector<std::string> words = split(program + " " + options);
        const std::string name = words[0];
        words.erase(words.begin());
        words.push_back("caf\xe9 \xc3\xa9.scene");
        expect_success(folder, name, words);
        CHECK(contains(folder.read("s.json"), "\"scene\": \"caf\\ufffd \xc3\xa9.scene\""));
    }
}

TEST_CASE("radiosity --quiet prints nothing; -o and its files; the scene may come through a pipe") {
    const Place folder(room);
    const Outcome o = expect_success(
        folder, "radiosity", split("--quiet --mesh 3 --shots 4 -o a.pfm -o b.png file.scene"));
    CHECK(o.err == "");
    CHECK(folder.all().size() == 3);
    Process process(folder, "radiosity", split("--mesh 3 --shots 4 -o c.pfm /dev/stdin"),
                    {.input = room});
    CHECK(process.finish().status == 0);
    CHECK(folder.same("a.pfm", "c.pfm"));
}

TEST_CASE("radiosity: a sphere is told to become triangles, with its line; all black gets a hint") {
    const Place folder(good);
    const Outcome o = expect_success(folder, "radiosity", split("--mesh 1 -o a.pfm file.scene"));
    CHECK(contains(
        o.err,
        "file.scene:5: the sphere becomes 320 triangles, faces of their own, whose area is "));
    CHECK(contains(
        o.err, "file.scene:6: the sphere becomes 320 triangles, faces of their own, whose area "));
    CHECK_FALSE(contains(o.err, "black"));
    folder.write("turned.scene", camera + "light l 1 1 1\nquad -1 -1 0  0 2 0  2 0 0  l\n");
    folder.write("none.scene", camera + "diffuse m 1 1 1\nquad -1 -1 0  2 0 0  0 2 0  m\n");
    for (const std::string& method : methods) {
        const std::string line = "-o a.pfm --method " + method;
        CHECK(contains(expect_success(folder, "radiosity", split(line + " turned.scene")).err,
                       "turned.scene: all is black: no light reaches the camera"));
        CHECK(contains(expect_success(folder, "radiosity", split(line + " none.scene")).err,
                       "none.scene: warning: no light: all will be black"));
        CHECK(mean_of(read_pfm(folder / "a.pfm")) == 0);
    }
}

// ---- Images -------------------------------------------------------------------------------------

TEST_CASE("radiosity: the files do not depend on threads, and on time only where it ends the run") {
    const Place folder(room);
    for (const std::string& method : methods) {
        const std::string common = "--method " + method +
                                   (method == "particles" ? " --particles 2000" : " --shots 6") +
                                   " --mesh 2 -o a.pfm -o a.png file.scene ";
        auto files = [&](const std::string& options) {
            expect_success(folder, "radiosity", split(common + options));
            return folder.read("a.pfm") + folder.read("a.png");
        };
        const std::string one = files("--threads 1");
        for (const char* options :
             {"--threads 1", "--threads 2", "--threads 3", "--threads 7", "", "--time 1e6"}) {
            INFO(method, " ", std::string(options));
            const bool same = files(options) == one;
            CHECK(same);
        }
        if (method == "particles") {
            for (const char* options :
                 {"--seed 1", "--sampler independent", "--sampler stratified"})
                CHECK(files(options) != one);
            CHECK(files("--seed 0") == one);
        }
        CHECK(files("--rays 1") != one);
        CHECK(files("--mesh 4") != one);
    }
}

TEST_CASE("radiosity: three methods, one image, and that of the path tracer") {
    const Place folder(room);
    expect_success(folder, "penumbra", split("--spp 64 --depth 30 -o a.pfm file.scene"));
    const double truth = mean_of(read_pfm(folder / "a.pfm"));
    auto mean = [&](const std::string& options) {
        expect_success(folder, "radiosity", split("-o b.pfm file.scene --mesh " + options));
        return mean_of(read_pfm(folder / "b.pfm"));
    };
    // Particles know the mean over a triangle, whatever its size (their mean has a standard
    // deviation of 0.2 %); vertices know E where they are, and the ceiling's are too few for the
    // lamp's glow.
    CHECK(mean("2.5 --method particles --particles 300000") == about(truth, 0.01));
    const double shooting = mean("2.5 --method shooting"), hierarchy = mean("2.5");
    CHECK(shooting == about(truth, 0.1));
    CHECK(hierarchy == about(shooting, 0.01));
    const double coarse = mean("5");
    CHECK(mean("5 --method hierarchy --unshot 1%") == about(coarse, 1e-12));
    CHECK(mean("5 --unshot 1e-3") > coarse);
    CHECK(mean("5 --unshot 50%") < coarse);
}

TEST_CASE("radiosity --view illuminance: pi L in a closed room that glows; its PNG is of white") {
    const Place folder(glowing);
    for (const std::string& method : methods) {
        expect_success(folder, "radiosity",
                       split("--view illuminance --mesh 4 -o a.pfm -o a.png file.scene --method " +
                             method + (method == "particles" ? "" : " --unshot 1e-9")));
        INFO(method);
        const Image image = read_pfm(folder / "a.pfm");
        // By particles of 10^6 on some 100 vertices: one of them is known within 1 %, 5 sigma.
        const double tolerance = method == "particles" ? 0.05 : 1e-5;
        for (const auto& pixel : image.pixels)
            CHECK(double(pixel[0]) == about(0.18 * std::numbers::pi, tolerance));
        if (method == "particles") continue;
        const std::string png = folder.read("a.png");
        int w = 0, h = 0, n = 0;
        stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                                                int(png.size()), &w, &h, &n, 3);
        REQUIRE(pixels != nullptr);
        CHECK(std::abs(int(pixels[0]) - 118) <= 1);  // of .18
        stbi_image_free(pixels);
    }
    expect_success(folder, "radiosity", split("--mesh 4 -o a.pfm file.scene"));
    for (const auto& pixel : read_pfm(folder / "a.pfm").pixels) CHECK(pixel[0] == .18f);
}

TEST_CASE("radiosity --view mesh: lines over what is there, the more the finer it is") {
    // A square before the camera fills rows and columns 4 to 12 or so, of two triangles.
    const Place folder(
        "size 64 64\ncamera 0 0 5  0 0 0  40\ndiffuse m 1 1 1\nlight l 1 1 1 twosided\n"
        "quad -1 -1 0  2 0 0  0 2 0  m\nquad -1 -1 9  2 0 0  0 2 0  l\n");
    auto image = [&](const std::string& options) {
        expect_success(folder, "radiosity",
                       split("--shots 1 --rays 1 -o a.pfm file.scene " + options));
        return read_pfm(folder / "a.pfm");
    };
    auto lines = [&](const std::string& mesh) {
        const Image plain = image(mesh), drawn = image(mesh + " --view mesh");
        int n = 0;
        for (size_t i = 0; i < plain.pixels.size(); ++i) n += plain.pixels[i] != drawn.pixels[i];
        return n;
    };
    // 2 x 2 of a view of 2 x 5 tan 20 degrees: s = 35.2 pixels.  Two triangles have four sides and
    // a diagonal, which a path of steps to the right and down crosses once a row and once a column.
    const double s = 64 * 2 / (10 * std::tan(20 * std::numbers::pi / 180));
    CHECK(lines("--mesh 9") == about(5 * s, 0.1));
    // Four cells a side: 3 more lines across, 3 more down, 4 times as long diagonals ... minus
    // crossings, which count once.
    CHECK(lines("--mesh 0.8") > 2.5 * lines("--mesh 9"));
}

// Particles know the mean over a triangle, and so does one bounce: the mean of the image is off by
// the noise of 100 000 particles, some .4 %, and by what small triangles cost.
TEST_CASE("radiosity --final-gather: the image of the path tracer, by options of paths") {
    const Place folder(room);
    expect_success(folder, "penumbra", split("--spp 64 --depth 30 -o a.pfm file.scene"));
    const double truth = mean_of(read_pfm(folder / "a.pfm"));
    const std::string gather = "--final-gather --mesh 1 --particles 100000 file.scene ";
    const Outcome o = expect_success(folder, "radiosity",
                                     split(gather + "--sets 2 --spp 64 --stats s.json -o b.pfm"));
    CHECK(mean_of(read_pfm(folder / "b.pfm")) == about(truth, 0.02));
    CHECK(contains(o.err, "file.scene: 64 samples per pixel, "));
    CHECK(contains(o.err, " without its bias (biased)"));
    const std::string stats = folder.read("s.json");
    CHECK(contains(stats, "\"bias\": \"biased\""));
    CHECK(number_of(stats, "map_particles") == 100000);
    CHECK(number_of(stats, "map_mesh") == 1);
    CHECK(number_of(stats, "map_triangles") > 1000);
    CHECK(number_of(stats, "map_error") > 0);
    CHECK(number_of(stats, "seconds") > number_of(stats, "map_seconds"));
    CHECK(number_of(stats, "rays") > number_of(stats, "map_rays"));
    // A particle for 16 paths, unless it is said.
    expect_success(folder, "radiosity",
                   split("--final-gather --spp 64 --stats s.json -o b.pfm file.scene"));
    CHECK(number_of(folder.read("s.json"), "map_particles") == 33 * 17 * 64 / 16 / 16 * 16 + 16);
    const Outcome e = expect_success(folder, "radiosity",
                                     split("--final-gather --error 20% -o b.pfm file.scene"));
    CHECK(contains(e.err, "(stopped by error)"));
    expect_success(folder, "radiosity", split(gather + "--spp 4 --threads 1 -o c.pfm"));
    expect_success(folder, "radiosity", split(gather + "--spp 4 --threads 3 -o d.pfm"));
    CHECK(folder.same("c.pfm", "d.pfm"));
}

// ---- Refusals -----------------------------------------------------------------------------------

TEST_CASE("radiosity refuses, in one line, what it cannot do, and touches no file") {
    const Place folder(room);
    folder.write("out/file-radiosity.png", "old");
    const std::string materials =
        "mirror m .5 .5 .5\nglass g 1.5\nphong p .1 .1 .1 .2 .2 .2 9\nphong q .5 .5 .5 0 0 0 9\n"
        "light k 1 1 1 p\n";
    const std::string lines = room + materials;  // 8 and 5 lines
    folder.write("mirror.scene", lines + "sphere 0 0 0 1 m\n");
    folder.write("glass.scene", lines + "quad 0 0 0 1 0 0 0 1 0 q\nquad 0 0 0 1 0 0 0 1 0 g\n");
    folder.write("phong.scene", lines + "triangle 0 0 0 1 0 0 0 1 0 p\n");
    folder.write("light.scene", lines + "triangle 0 0 0 1 0 0 0 1 0 k\n");
    folder.write("white.scene", lines + "diffuse w 1 .5 .5\nquad 0 0 0 1 0 0 0 1 0 w\n");
    folder.write("fine.scene", lines + "triangle 0 0 0 1 0 0 0 1 0 q\n");
    const std::pair<std::string, std::string> rows[] = {
        {"", "no scene given"},
        {"missing.scene", "missing.scene: cannot open: No such file"},
        {"mirror.scene", "mirror.scene:14: 'm' is a mirror: illumination maps hold diffuse surf"},
        {"glass.scene", "glass.scene:15: 'g' is glass: illumination maps hold diffuse surfaces"},
        {"phong.scene", "phong.scene:14: 'p' is glossy: illumination maps hold diffuse surfaces"},
        {"light.scene", "light.scene:14: 'k' is glossy: illumination maps hold diffuse surfaces"},
        {"--mesh 1e-6 file.scene", "--mesh: edges of 1e-06 would be "},
        {"--mesh 1e-30 file.scene", "--mesh: edges of 1e-30 would be "},
        {"--mesh 1e-6 --method particles file.scene", "--mesh: edges of 1e-06 would be "},
        {"--mesh 0 file.scene", "--mesh: '0' is not positive"},
        {"--method shoot file.scene", "--method: unknown value 'shoot' (did you mean 'shooting'?)"},
        {"--method nee file.scene", "--method: unknown value 'nee'"},
        {"--unshot 0 file.scene", "--unshot: '0' is not between 0 and 100 %"},
        {"--unshot 2 file.scene", "--unshot: '2' is more than 100 %; for percent say 2%"},
        {"--error 0 file.scene", "--error: '0' is not between 0 and 100 %"},
        {"--error 1 --method particles file.scene", "--error: '1' is not between 0 and 100 %"},
        {"--error 5 file.scene", "--error: '5' is more than 100 %; for percent say 5%"},
        {"--error 5% white.scene", "--error: white.scene:15: reflects all light, so nothing"},
        {"--unshot 1% --method particles file.scene",
         "--unshot: needs --method shooting or hierarchy"},
        {"--shots 1 --method particles file.scene", "--shots: needs --method shooting or hier"},
        {"--particles 9 file.scene", "--particles: needs --method particles"},
        {"--sampler halton file.scene", "--sampler: needs --method particles"},
        {"--seed 1 --method shooting file.scene", "--seed: needs --method particles"},
        {"--shots 0 file.scene", "--shots: '0' is not a whole number from 1"},
        {"--particles 0 file.scene", "--particles: '0' is not a whole number from 1"},
        {"--rays 0 file.scene", "--rays: '0' is not a whole number from 1 to 64"},
        {"--rays 65 file.scene", "--rays: '65' is not a whole number from 1 to 64"},
        {"--view radiance file.scene", "--view: unknown value 'radiance'"},
        {"--spp 4 file.scene", "--spp: needs --final-gather"},
        {"--final-gather --rays 3 file.scene", "--rays: goes without --final-gather"},
        {"--final-gather --method shooting file.scene", "--final-gather: needs --method part"},
        {"--stats file.scene file.scene", "file.scene: would replace another file"},
        {"--stats a.png -o a.png file.scene", "a.png: would replace another file"},
        {"-o missing/a.png file.scene", "missing/a.png: cannot write: No such file or directory"},
        {"-o a.jpg file.scene", "-o: 'a.jpg' ends neither in .png nor in .pfm"},
    };
    for (const auto& [line, why] : rows) expect_refusal(folder, "radiosity", split(line), why);
    const Outcome o = run(folder, "radiosity", split("--mesh 1e-6 file.scene"));
    CHECK(contains(o.err, " would fit\n"));
    expect_success(folder, "radiosity", split("--mesh 3 --shots 1 -o a.pfm fine.scene"));
}

// ---- Ctrl-C -------------------------------------------------------------------------------------

namespace {

// Runs what would last for hours until something is found, then sends a signal.
Outcome interrupted_run(const Folder& folder, const std::string& options, int signal) {
    Outcome o;
    // A busy machine may not have begun: then again, with more patience.
    for (double patience = 0.2; patience < 20 && !folder.has("a.pfm"); patience *= 3) {
        Process process(folder, "radiosity", split(options + " -o a.pfm -o a.png file.scene"));
        process.listen(patience, [](const Outcome&) { return false; });
        process.interrupt(signal);
        o = process.finish();
    }
    return o;
}

}  // namespace

TEST_CASE(
    "radiosity: Ctrl-C writes the image of the shots so far, the last of which it may cut short") {
    for (const std::string method : {"shooting", "hierarchy"}) {
        const Place folder(room);
        const std::string common = "--mesh 0.5 --method " + method;
        const Outcome o = interrupted_run(folder, common + " --unshot 1e-300", SIGINT);
        INFO(method, ": ", o.err);
        CHECK(o.signal == 0);
        CHECK(o.status == 130);
        CHECK(folder.all().size() == 3);
        const RunSummary s = line_of(o.err, "file.scene");
        REQUIRE(s.complete);
        CHECK(s.interrupted);
        REQUIRE(s.found > 0);
        auto image_of = [&](uint64_t shots) {
            expect_success(
                folder, "radiosity",
                split(common + " --shots " + std::to_string(shots) + " -o b.pfm file.scene"));
            return read_pfm(folder / "b.pfm").pixels;
        };
        // Light only grows: what is seen lies between this shot and the one before.
        const auto seen = read_pfm(folder / "a.pfm").pixels, most = image_of(s.found),
                   least = s.found > 1 ? image_of(s.found - 1) : decltype(seen)(seen.size());
        REQUIRE(seen.size() == most.size());
        for (size_t i = 0; i < seen.size(); ++i)
            for (size_t c = 0; c < 3; ++c) {
                CHECK(seen[i][c] >= least[i][c]);
                CHECK(seen[i][c] <= most[i][c]);
            }
    }
}

TEST_CASE("radiosity: SIGTERM writes the image of the particles so far, and its statistics") {
    const Place folder(room);
    const Outcome o = interrupted_run(
        folder, "--mesh 2 --method particles --particles 1099511627776 --stats s.json", SIGTERM);
    INFO(o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 143);
    const RunSummary s = line_of(o.err, "file.scene");
    REQUIRE(s.complete);
    CHECK(s.interrupted);
    CHECK(s.found > 0);
    CHECK(s.found < 1099511627776);
    const std::string stats = folder.read("s.json");
    CHECK(contains(stats, "\"interrupted\": true"));
    CHECK(number_of(stats, "particles") == double(s.found));
    // Its mean is that of a run to the end: nothing was lost on the way.  A particle alone brings
    // the mean with a standard deviation of 120 %; of the difference, 5 of them.
    const double tolerance = 5 * 1.2 * std::sqrt(1 / double(s.found) + 1e-5);
    expect_success(folder, "radiosity",
                   split("--mesh 2 --method particles --particles 100000 -o b.pfm file.scene"));
    CHECK(mean_of(read_pfm(folder / "a.pfm")) ==
          about(mean_of(read_pfm(folder / "b.pfm")), tolerance));
}

TEST_CASE("radiosity: a bar shows what is left, in the method's own words, and goes") {
    if (!terminal_to_be_had()) {
        MESSAGE("this machine lends no pseudo-terminal: not tested");
        return;
    }
    const Place folder(room);
    struct Row {
        const char* method;
        double patience;  // the error of particles is asked for once they have walked for a second
        Words parts;
    };
    const Row rows[] = {{"shooting", 0.4, {" shots, ", " % unshot, "}},
                        {"hierarchy", 0.4, {" shots, ", " % unshot, "}},
                        {"particles", 1.4, {" particles, error ", " %, "}}};
    for (const auto& [method, patience, words] : rows) {
        Words parts = {"\r[#", " s elapsed, ", " s left"};
        parts.insert(parts.end(), words.begin(), words.end());
        Outcome o;
        std::string missing = "a bar";
        // A busy machine may have shown nothing: then again, with more patience.
        for (double seconds = patience; seconds < 20 && missing != ""; seconds *= 3) {
            Process process(folder, "radiosity",
                            split("--mesh 1 -o a.pfm file.scene --method " + std::string(method) +
                                  " --time " + std::to_string(seconds)),
                            {.terminal = true});
            o = process.finish();
            const std::string bars = o.err.substr(0, o.err.rfind("\r\033[K"));
            missing = "";
            for (const std::string& part : parts)
                if (!contains(bars, part)) missing += part;
        }
        INFO(o.err);
        CHECK(o.status == 0);
        CHECK(missing == "");
        CHECK(line_of(o.err, "\033[Kfile.scene").complete);
    }
}
