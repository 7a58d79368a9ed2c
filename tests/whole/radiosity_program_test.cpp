// whole/radiosity_program_test.cpp  build/radiosity as a user runs it
#include "base/approx.h"
#include "base/vec.h"
#include "text/png.h"
#include "whole/process.h"

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
    bool interrupted = false, complete = false;
};

// Parses "file.scene: 8 triangles, 3 shots, 1 % unshot, 0.1 s, 1 Mrays/s", or "..., 3 particles".
RunSummary line_of(const std::string& err) {
    RunSummary s;
    const std::string line = err.substr(0, err.find('\n', err.find(" Mrays/s")));
    const size_t start = line.rfind("file.scene: "), seconds = line.rfind(" s, ");
    char what[20] = "";
    double took, speed;
    s.complete = start != line.npos && seconds != line.npos &&
                 std::sscanf(line.c_str() + start, "file.scene: %llu triangles, %llu %19[a-z]",
                             &s.triangles, &s.found, what) == 3 &&
                 (what == std::string("shots") || what == std::string("particles")) &&
                 std::sscanf(line.c_str() + line.rfind(", ", seconds - 1), ", %lf s, %lf Mrays/s",
                             &took, &speed) == 2;
    s.interrupted = line.ends_with(" (interrupted)");
    return s;
}

double mean_of(const Image& image) {
    double sum = 0;
    for (const auto& pixel : image.pixels) sum += double(pixel[1]);
    return sum / double(image.pixels.size());
}

struct Room : Place {
    using Place::Place;
    Outcome maps(const std::string& options) const {
        return expect_success(*this, "radiosity file.scene -o a.pfm " + options);
    }
    Image map(const std::string& options) const {
        maps(options);
        return read_pfm(*this / "a.pfm");
    }
    double mean(const std::string& options) const { return mean_of(map(options)); }
};

// Interrupts a run of several hours once it has found something.
Outcome interrupted_run(const Folder& folder, const std::string& options, int signal = SIGINT) {
    return cut_short_late_enough(folder, "radiosity -o a.pfm -o a.png file.scene " + options,
                                 signal, [&](const Outcome&) { return folder.has("a.pfm"); });
}

}  // namespace

// ---- Messages and files -------------------------------------------------------------------------

TEST_CASE("radiosity --help is one page of stdout, and makes no file") {
    const Folder folder;
    for (const std::string line : {"--help", "-h", "--help file.scene"})
        expect_help(folder, "radiosity " + line, 104,
                    "radiosity [options] SCENE;--method shooting|hierarchy|particles;--help;"
                    "130 interrupted");
    CHECK(folder.files() == 0);
}

TEST_CASE(
    "radiosity writes out/NAME-radiosity.png and .pfm unless told, and says so in two lines") {
    for (const std::string& method : methods) {
        INFO(method);
        const Room place(room);
        const Outcome o = expect_success(
            place, "radiosity file.scene --mesh 5 --stats s.json --method " + method);
        INFO(o.err);
        CHECK(place.files() == 5);  // includes out/ and the scene
        CHECK(o.err.ends_with("\nwrote out/file-radiosity.png, out/file-radiosity.pfm, s.json\n"));
        // A busy machine prints progress after two seconds.
        int lines = 0;
        std::istringstream in(o.err);
        for (std::string line; std::getline(in, line);) lines += !contains(line, " s elapsed, ");
        CHECK(lines == 2);
        const Image image = read_pfm(place / "out/file-radiosity.pfm");
        CHECK(said(image.width, image.height) == "33 17");
        CHECK(!first_non_finite(image));
        CHECK(place.read("out/file-radiosity.png").starts_with("\x89PNG"));

        const RunSummary s = line_of(o.err);
        REQUIRE(s.complete);
        CHECK_FALSE(s.interrupted);
        const bool walks = method == "particles";
        const std::string stats = place.read("s.json");
        CHECK(said(stated(stats, "method"), stated(stats, "interrupted"), stated(stats, "bias"),
                   stated(stats, "stopped_by")) ==
              with("\"" + method + "\" false \"biased\" \"--@\"", walks ? "particles" : "unshot"));
        CHECK(!contains(o.err, "reach"));
        auto number = [&](const char* key) { return number_of(stats, key); };
        CHECK(said(number("mesh"), number("faces"), number("elements")) ==
              said(5, 13, double(s.triangles)));
        CHECK(number("vertices") > 0.5 * double(s.triangles));
        // Each vertex has the sums of 16 batches, each element what it sends, on both sides.
        CHECK(number("bytes") > (walks ? 2 * 16 * 3 * sizeof(double) * number("vertices")
                                       : 2 * 2 * 3 * sizeof(rgb) * number("elements")));
        CHECK(number("rays") > 0);
        CHECK(number("mean_of_image") > -1);
        CHECK(number(walks ? "particles" : "shots") == double(s.found));
        CHECK(number(walks ? "shots" : "particles") == 0);
        CHECK(std::isnan(number(walks ? "unshot" : "error_uncertainty")));
        CHECK(std::isnan(number("error_asked")));
        CHECK(number("error") > (walks ? 0 : 0.003));
        CHECK(number("error") < 0.1);
        CHECK(number(walks ? "error_uncertainty" : "unshot") > 0);
        if (walks) CHECK(s.found == 1000000);
        if (walks) CHECK(number("error_uncertainty") < 0.1 * number("error"));
        if (!walks) CHECK(number("unshot") <= 0.01);
    }
}

TEST_CASE("radiosity --error: what came first ends the run, and is said") {
    const Room place(room);
    const std::pair<std::string, std::string> rows[] = {
        {"--method particles --mesh 5 --error 20% --particles 1000000 --time 1000", "--error"},
        {"--method particles --mesh 5 --error 1e-9 --particles 1600 --time 1000", "--particles"},
        {"--method particles --mesh 5 --error 1e-9 --particles 1099511627776 --time 0.2", "--time"},
        {"--mesh 5 --error 20% --shots 1000000 --time 1000 --unshot 1e-9", "--error"},
        {"--mesh 5 --error 1e-9 --shots 1 --time 1000 --unshot 1e-8", "--shots"},
        {"--mesh 5 --error 1e-9 --time 1000 --unshot 20%", "--unshot"},
        {"--mesh 0.5 --method shooting --error 1e-9 --time 0.2", "--time"},
        {"--mesh 5 --method shooting --error 20%", "--error"}};
    for (const auto& row : rows) {
        const auto& [options, stopped_by] = row;
        INFO(row.first);
        const Outcome o = place.maps("--stats s.json " + options);
        INFO(o.err);
        const std::string stats = place.read("s.json");
        CHECK(stated(stats, "stopped_by") == "\"" + stopped_by + "\"");
        const bool reached = stopped_by == "--error";
        CHECK(contains(o.err, reached ? " Mrays/s, reached 20 % ("
                                      : "did not reach 1e-07 % (stopped by " + stopped_by + "; "));
        CHECK(contains(o.err, ", without the error of the mesh)\n"));
        CHECK(contains(o.err, "error at most ") == !contains(options, "particles"));
        const double asked = number_of(stats, "error_asked"), error = number_of(stats, "error");
        CHECK(asked == (contains(options, "--error 20%") ? 0.2 : 1e-9));
        CHECK((error <= asked) == (stopped_by == "--error"));
    }
    // Without particles there is no error estimate.
    const Room dark(room.substr(0, room.find("quad")));
    const Outcome o = dark.maps("--stats s.json --error 5% --method particles");
    INFO(o.err);
    CHECK(contains(o.err, " Mrays/s, error not known\n"));
    CHECK(stated(dark.read("s.json"), "stopped_by") == "null");
    CHECK(std::isnan(number_of(dark.read("s.json"), "error")));
}

TEST_CASE("radiosity --error alone: particles in a closed white room end with a message") {
    const Place place(
        "size 9 5\ncamera .3 .2 4  0 0 0  70\ndiffuse w 1 .5 .5\n"
        "box 10 10 10  0  -5 -5 -5  w\npointlight 0 0 0  9 9 9\n");
    const Untouched all(place);
    const Outcome o = expect_exit(
        place, "radiosity --method particles --mesh 5 --error 5% -o a.pfm file.scene", 2);
    CHECK(contains(o.err, "--error: none of 65536 particles lost light in some channel"));
}

TEST_CASE("statistics are UTF-8 even if the scene's name is not") {
    const Folder folder;
    const std::string name = "caf\xe9 \xc3\xa9.scene";
    folder.write(name, room);
    for (const std::string program : {"penumbra --spp 1", "radiosity --mesh 5 --shots 2"}) {
        const Words line = split(program + " --stats s.json --quiet -o a.pfm --size 8x4");
        expect_success(folder, line + Words{name});
        CHECK(stated(folder.read("s.json"), "scene") == "\"caf\\ufffd \xc3\xa9.scene\"");
    }
}

TEST_CASE("radiosity --quiet prints nothing; -o and its files; the scene may come through a pipe") {
    const Room place(room);
    CHECK(place.maps("--quiet --mesh 3 --shots 4 -o b.png").err == "");
    CHECK(place.files() == 3);
    expect_exit(place, "radiosity --mesh 3 --shots 4 -o c.pfm /dev/stdin", 0, {.input = room});
    CHECK(place.same("a.pfm", "c.pfm"));
}

TEST_CASE("radiosity: a sphere is told to become triangles, with its line; all black gets a hint") {
    const std::string err = Room(good).maps("--mesh 1").err,
                      told = "the sphere becomes 320 triangles; their area is ";
    for (const std::string line : {"file.scene:5: ", "file.scene:6: "})
        CHECK(contains(err, line + told));
    CHECK_FALSE(contains(err, "black"));
    const Room turned(camera + "light l 1 1 1\nquad -1 -1 0  0 2 0  2 0 0  l\n"),
        none(camera + "diffuse m 1 1 1\nquad -1 -1 0  2 0 0  0 2 0  m\n");
    for (const std::string& method : methods) {
        CHECK(contains(turned.maps("--method " + method).err,
                       "file.scene: the image is black: no light reaches the camera"));
        CHECK(contains(none.maps("--method " + method).err,
                       "file.scene: warning: no light: the image will be black"));
        CHECK(none.mean("--method " + method) == 0);
    }
}

// ---- Images -------------------------------------------------------------------------------------

TEST_CASE("radiosity: the files do not depend on threads, and on time only where it ends the run") {
    const Room place(room);
    for (const std::string& method : methods) {
        const std::string amount = method == "particles" ? " --particles 2000" : " --shots 6";
        auto files = [&](const std::string& options) {
            place.maps("--method " + method + amount + " --mesh 3 -o a.png " + options);
            return place.read("a.pfm") + place.read("a.png");
        };
        const std::string one = files("--threads 1");
        Words same = parts_of("--threads 1;--threads 2;--threads 3;--threads 7;;--time 1e6"),
              others = parts_of("--rays 1;--mesh 4");
        if (method == "particles") {
            same.push_back("--seed 0");
            others = others + parts_of("--seed 1;--sampler independent;--sampler stratified");
        }
        for (const std::string& options : same + others) {
            INFO(method, " ", options);
            const bool is_same = files(options) == one,
                       is_asked = std::find(same.begin(), same.end(), options) != same.end();
            CHECK(is_same == is_asked);
        }
    }
}

TEST_CASE("radiosity: three methods, one image, and that of the path tracer") {
    const Room place(room);
    const double truth = mean_of(place.image("--spp 64 --depth 30"));
    // Particles estimate the mean over a triangle of any size (their mean has a standard deviation
    // of 0.2 %).  Vertices have E only at their positions; the ceiling has too few of them for the
    // lamp's glow.
    CHECK(place.mean("--mesh 2.5 --method particles --particles 300000") == about(truth, 0.01));
    const double shooting = place.mean("--mesh 3 --method shooting");
    CHECK(shooting == about(truth, 0.1));
    CHECK(place.mean("--mesh 3") == about(shooting, 0.01));
    const double coarse = place.mean("--mesh 9");
    CHECK(place.mean("--mesh 9 --method hierarchy --unshot 1%") == about(coarse, 1e-12));
    CHECK(place.mean("--mesh 9 --unshot 1e-3") > coarse);
    CHECK(place.mean("--mesh 9 --unshot 50%") < coarse);
}

TEST_CASE("radiosity --view illuminance: pi L in a closed room that glows; its PNG is of white") {
    const Room place(glowing);
    for (const std::string& method : methods) {
        const bool walks = method == "particles";
        INFO(method);
        const Image image = place.map("--view illuminance --mesh 4 -o a.png --method " + method +
                                      (walks ? "" : " --unshot 1e-9"));
        // 10^6 particles on some 100 vertices: the error of each is 1 %; the tolerance is 5 sigma.
        for (const auto& pixel : image.pixels)
            CHECK(double(pixel[0]) == about(0.18 * std::numbers::pi, walks ? 0.05 : 1e-5));
        if (!walks) CHECK(std::abs(decode_png(place.read("a.png")).bytes[0] - 118) <= 1);  // of .18
    }
    for (const auto& pixel : place.map("--mesh 4").pixels) CHECK(pixel[0] == .18f);
}

TEST_CASE("radiosity --view mesh: lines over what is there, the more the finer it is") {
    // A square before the camera fills rows and columns 4 to 12 or so, of two triangles.
    const Room place(
        "size 64 64\ncamera 0 0 5  0 0 0  40\ndiffuse m 1 1 1\nlight l 1 1 1 twosided\n"
        "quad -1 -1 0  2 0 0  0 2 0  m\nquad -1 -1 9  2 0 0  0 2 0  l\n");
    auto lines = [&](const std::string& mesh) {
        const auto plain = place.map("--shots 1 --rays 1 " + mesh).pixels,
                   drawn = place.map("--shots 1 --rays 1 --view mesh " + mesh).pixels;
        int n = 0;
        for (size_t i = 0; i < plain.size(); ++i) n += plain[i] != drawn[i];
        return n;
    };
    // The square is 2 x 2 in a view of 2 x 5 tan 20 degrees: s = 35.2 pixels.  Two triangles have
    // four sides and a diagonal.  The diagonal crosses every row and every column once.
    const double s = 64 * 2 / (10 * std::tan(20 * std::numbers::pi / 180));
    CHECK(lines("--mesh 9") == about(5 * s, 0.1));
    // Four cells per side: 3 more lines across, 3 more down, 4 times the length of diagonals, minus
    // crossings, which count once.
    CHECK(lines("--mesh 0.8") > 2.5 * lines("--mesh 9"));
}

// Particles and one bounce estimate means over triangles.  So the image's mean has the noise of 100
// 000 particles, some .4 %, and the error of small triangles.
TEST_CASE("radiosity --final-gather: the image of the path tracer, by options of paths") {
    const Room place(room);
    const double truth = mean_of(place.image("--spp 64 --depth 30"));
    const std::string gather = "--final-gather --mesh 1 --particles 100000 ";
    const Outcome o = place.maps(gather + "--replications 2 --spp 64 --stats s.json");
    CHECK(mean_of(read_pfm(place / "a.pfm")) == about(truth, 0.02));
    CHECK(missing(o.err,
                  "file.scene: 64 samples per pixel, ;"
                  " (noise only; the estimator is biased)") == "");
    const std::string stats = place.read("s.json");
    auto number = [&](const char* key) { return number_of(stats, key); };
    CHECK(stated(stats, "bias") == "\"biased\"");
    CHECK(said(number("map_particles"), number("map_mesh")) == said(1e5, 1.0));
    CHECK(number("map_triangles") > 1000);
    CHECK(number("map_error") > 0);
    CHECK(number("seconds") > number("map_seconds"));
    CHECK(number("rays") > number("map_rays"));
    // By default there is a particle per 16 paths.
    place.maps("--final-gather --spp 64 --stats s.json");
    CHECK(number_of(place.read("s.json"), "map_particles") == 33 * 17 * 64 / 16 / 16 * 16 + 16);
    CHECK(contains(place.maps("--final-gather --error 20%").err, ", reached 20 % (error "));
    const bool same = place.map(gather + "--spp 4 --threads 1").pixels ==
                      place.map(gather + "--spp 4 --threads 3").pixels;
    CHECK(same);
}

// ---- Refusals -----------------------------------------------------------------------------------

TEST_CASE("radiosity refuses, in one line, what it cannot do, and touches no file") {
    const Room place(room);
    place.write("out/file-radiosity.png", "old");
    const std::string lines = room +  // of 8 lines
                              "mirror m .5 .5 .5\nglass g 1.5\nphong p .1 .1 .1 .2 .2 .2 9\n"
                              "phong q .5 .5 .5 0 0 0 9\nlight k 1 1 1 p\n";
    const std::string triangle = "triangle 0 0 0 1 0 0 0 1 0 ";
    place.write("mirror.scene", lines + "sphere 0 0 0 1 m\n");
    place.write("glass.scene", lines + "quad 0 0 0 1 0 0 0 1 0 q\nquad 0 0 0 1 0 0 0 1 0 g\n");
    place.write("phong.scene", lines + triangle + "p\n");
    place.write("light.scene", lines + triangle + "k\n");
    place.write("white.scene", lines + "diffuse w 1 .5 .5\n" + triangle + "w\n");
    place.write("fine.scene", lines + triangle + "q\n");
    const std::string diffuse = "; radiosity supports diffuse surfaces";
    expect_refusals(place, "radiosity",
                    {{"", "no scene given"},
                     {"missing.scene", "missing.scene: cannot open: No such file"},
                     {"mirror.scene", "mirror.scene:14: material 'm' is a mirror" + diffuse},
                     {"glass.scene", "glass.scene:15: material 'g' is glass" + diffuse},
                     {"phong.scene", "phong.scene:14: material 'p' is glossy" + diffuse},
                     {"light.scene", "light.scene:14: material 'k' is glossy" + diffuse},
                     {"--error 5% white.scene",
                      "--error: white.scene:15: reflects all light, so that nothing"}});
    for (const auto& [words, why] : members({
             {"--mesh @", "1e-06;1e-30", "--mesh: edges of @ would be "},
             {"--mesh 1e-6 --method particles", "", "--mesh: edges of 1e-06 would be "},
             {"--method @", "shoot", "--method: unknown value '@' (did you mean 'shooting'?)"},
             {"@ 0", "--shots;--particles", "@: '0' is not a whole number from 1"},
             {"--rays @", "0;65", "--rays: '@' is not a whole number from 1 to 64"},
             {"--view @", "radiance", "--view: unknown value '@'"},
             {"--stats file.scene", "", "file.scene: would replace another file"},
             {"--stats a.png -o a.png", "", "a.png: would replace another file"},
             {"-o missing/a.png", "", "missing/a.png: cannot write: No such file or directory"},
             {"-o @", "a.jpg", "-o: '@' must end in .png, .pfm or .hdr"},
         }))
        expect_refusal(place, "radiosity file.scene " + words, why);
    CHECK(run(place, "radiosity --mesh 1e-6 file.scene").err.ends_with(" would fit\n"));
    expect_success(place, "radiosity --mesh 3 --shots 1 -o a.pfm fine.scene");
}

// ---- Ctrl-C -------------------------------------------------------------------------------------

TEST_CASE(
    "radiosity: Ctrl-C writes the image of the shots so far, the last of which it may cut short") {
    for (const std::string method : {"shooting", "hierarchy"}) {
        const Room place(room);
        const std::string common = "--mesh 0.5 --method " + method;
        const Outcome o = interrupted_run(place, common + " --unshot 1e-300");
        INFO(method, ": ", o.err);
        CHECK(o.status == 130);
        CHECK(place.files() == 3);
        const RunSummary s = line_of(o.err);
        REQUIRE(s.complete);
        CHECK(s.interrupted);
        REQUIRE(s.found > 0);
        auto image_of = [&](uint64_t shots) {
            return place.map(common + " --shots " + std::to_string(shots)).pixels;
        };
        // Light only grows: the image lies between this shot and the one before.
        const auto seen = read_pfm(place / "a.pfm").pixels, most = image_of(s.found),
                   least = s.found > 1 ? image_of(s.found - 1) : decltype(seen)(seen.size());
        REQUIRE(seen.size() == most.size());
        for (size_t i = 0; i < seen.size(); ++i)
            for (size_t c = 0; c < 3; ++c) {
                CHECK(seen[i][c] >= least[i][c]);
                CHECK(seen[i][c] <= most[i][c]);
            }
    }
}

TEST_CASE(
    "radiosity: Ctrl-C while the image is drawn is not forgotten, and the image is complete") {
    const Room place(room);
    const Outcome o =
        interrupted_run(place, "--mesh 5 --shots 1 --rays 64 --size 64x32 --threads 1");
    INFO(o.err);
    CHECK(o.status == 130);
    CHECK(line_of(o.err).interrupted);
    CHECK(!first_non_finite(read_pfm(place / "a.pfm")));
}

TEST_CASE("radiosity: SIGTERM writes the image of the particles so far, and its statistics") {
    const Room place(room);
    const std::string walk = "--mesh 2 --method particles ";
    const Outcome o =
        interrupted_run(place, walk + "--particles 1099511627776 --stats s.json", SIGTERM);
    INFO(o.err);
    CHECK(o.status == 143);
    const RunSummary s = line_of(o.err);
    REQUIRE(s.complete);
    CHECK(s.interrupted);
    CHECK(s.found > 0);
    CHECK(s.found < 1099511627776);
    CHECK(stated(place.read("s.json"), "interrupted") == "true");
    CHECK(number_of(place.read("s.json"), "particles") == double(s.found));
    // The mean equals that of a complete run, so that interruption loses nothing.  One particle
    // gives the mean with a standard deviation of 120 %; the tolerance is 5 of the difference's.
    const double tolerance = 5 * 1.2 * std::sqrt(1 / double(s.found) + 1e-5);
    CHECK(mean_of(read_pfm(place / "a.pfm")) ==
          about(place.mean(walk + "--particles 100000"), tolerance));
}

TEST_CASE("radiosity: a bar shows what is left, in the method's own words, and goes") {
    if (!terminal_to_be_had()) return;
    const Place place(room);
    for (const std::string& method : methods) {
        const bool walks = method == "particles";
        const std::string parts = std::string("\r[#; s elapsed, ; s left;") +
                                  (walks ? " particles, error ; %, " : " shots, ; % unshot, ");
        Outcome o;
        std::string lacks = "a bar";
        // A busy machine may have printed nothing.  The test then repeats with more patience.
        // Particles have an error estimate only after a second.
        for (double seconds = walks ? 1.4 : 0.4; seconds < 20 && lacks != ""; seconds *= 3) {
            o = run(place,
                    "radiosity --mesh 1 -o a.pfm file.scene --method " + method + " --time " +
                        std::to_string(seconds),
                    {.terminal = true});
            lacks = missing(o.err.substr(0, o.err.rfind("\r\033[K")), parts);
        }
        INFO(o.err);
        CHECK(o.status == 0);
        CHECK(lacks == "");
        CHECK(line_of(o.err).complete);
    }
}
