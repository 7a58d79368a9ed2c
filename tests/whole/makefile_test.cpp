// whole/makefile_test.cpp  what the Makefile and the gallery do for whoever types make
//
// The compiler is a script that makes every program a script, which writes the files that it is
// told to write.
#include <doctest/doctest.h>

#include <regex>

#include "course/python.h"
#include "text/folder.h"

namespace {

const std::string compiler = R"sh(#!/bin/sh
echo "$*" >>compiled
[ "${1-}" != --version ] || exec cat version
case $(cat version),$* in
    Clang*,*--param*) echo "error: argument unused"; exit 1 ;;
    Clang*,*-Wno-invalid-feature-combination*) ;;
    Clang*,*" -c "*src*) echo "error: +avx10.1-256 will be promoted"; exit 1 ;;
    *,*invalid-feature-combination*) echo "error: no such option"; exit 1 ;;
esac
case $* in *-fsyntax-only*) cat >asked; while read -r header; do ! grep -q "$header" asked || exit 1; done <missing; exit ;; esac
while [ "$1" != -o ]; do shift; done
mkdir -p "$(dirname "$2")" && { cat program; echo "# $*"; } >"$2" && chmod u+x "$2"
)sh";
const std::string program = R"sh(#!/bin/sh
echo "$0 $*" >>rendered
while [ $# -gt 0 ]; do
    case $1 in -o) echo rendered >"$2" ;; --stats) cp statistics "$2" ;; esac
    shift
done
)sh";
const std::string apt_get = R"sh(#!/bin/sh
echo "$*" >>installed
name=${3#lib} && [ ! -e offline ] && sed -i "/${name%-dev}/d" missing
)sh";
const std::string statistics = R"sh({
  "width": 40,
  "height": 30,
  "samples_per_pixel": 1.25e+2,
  "repeat_with_spp": 50,
  "seconds": 0.75,
  "d_rel": 0.0312,
  "d_rel_standard_error": 0.0021,
  "d_rel_reason": null
}
)sh";

struct Workshop : Folder {
    Workshop() {
        for (const std::string name : {"Makefile", "tests/tests.mk", "src/labs/labs.mk",
                                       "src/course/classroom.mk", "src/course/course.mk"})
            write(name, read_file(name));
        write("tests/base/a_test.cpp", "");
        write("src/app/penumbra.cpp", "");
        write("src/keep/compare.cpp", "");
        write("src/labs/knot.cpp", "");
        write("scenes/room.scene", "# A room.\nmesh a.obj 1 0 0 0\n");
        write("scenes/a.obj", "");
        write("statistics", statistics);
        write("version", "GNU");
        write("missing", "");
        write("bin/apt-get", apt_get);
        write("bin/sudo", "#!/bin/sh\nshift; \"$@\"\n");
        write("bin/brew", "#!/bin/sh\necho /opt/brew\n");
        write("cc", compiler);
        write("program", program);
        for (const std::string name : {"scenes/gallery", "scenes/parts", "src/packages"})
            write(name, read_file(name));
        for (const std::string name : {"scenes/gallery", "scenes/parts", "src/packages", "cc",
                                       "bin/apt-get", "bin/sudo", "bin/brew"})
            fs::permissions(path / name, fs::perms::owner_all);
    }
    Printed run(const std::string& command) const {
        return output_of("cd '" + path.string() + "' && env -i PATH=\"$PWD/bin:$PATH\" " + command);
    }
    // Expects `make WORDS` to succeed, and returns what it says.
    std::string make(const std::string& words = "") const {
        const Printed said = run("make CXX=./cc " + words);
        INFO("make ", words, ": ", said.text);
        CHECK(said.status == 0);
        return said.text;
    }
    // How often a program has run.
    long renders() const {
        const std::string lines = has("rendered") ? read("rendered") : "";
        return std::count(lines.begin(), lines.end(), '\n');
    }
    void make_newer(const std::string& file, const std::string& than) const {
        fs::last_write_time(path / file,
                            fs::last_write_time(path / than) + std::chrono::seconds(2));
    }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

}  // namespace

TEST_CASE("make renders again what is older than its parts, and what another command wrote") {
    const Workshop shop;
    shop.write("out/room.png", "by another command");
    shop.make();
    CHECK(shop.read("out/room.png") == "rendered\n");
    CHECK(contains(shop.read("out/index.html"),
                   "<p class=\"small\">125 samples per pixel, 0.8 s, error 3.1 % ± 0.2 %</p>"));
    CHECK(contains(shop.read("out/index.html"), "--size 40x30 --spp 50 "));
    CHECK(shop.renders() == 1);
    shop.make();
    shop.make("out/room.png out/room.pfm");
    CHECK(shop.renders() == 1);
    shop.make_newer("scenes/a.obj", "out/room.png");
    shop.make("out/room.png");
    CHECK(shop.renders() == 2);
    fs::remove(shop / "scenes/a.obj");  // is no later than the picture
    shop.write("scenes/a.obj", "");
    shop.make_newer("out/room.json", "scenes/a.obj");

    shop.write("out/room.png", "by another command");
    shop.make_newer("out/room.png", "out/room.json");
    shop.make("out/room.png");
    CHECK(shop.read("out/room.png") == "rendered\n");
    for (const std::string name : {"out/room.png", "out/room.pfm", "out/room.json"}) {
        INFO(name);
        fs::remove(shop / name);
        shop.make("out/room.png out/room.pfm");
        CHECK(shop.has(name));
    }
    CHECK(shop.renders() == 6);
}

TEST_CASE(
    "a picture depends on the meshes and libraries that are there, and on those that are made") {
    const Workshop shop;
    shop.write("scenes/a.obj",
               "mtllib a.mtl sub\\b.mtl\r\n  mtllib none.mtl a.obj c.mtl # all\n"
               "mtllib my stuff.mtl\nmtllib\n");
    shop.write("scenes/room.scene",
               "mesh a.obj#here\nmesh \"my # room.obj\" 1 0 0 0\nmesh \"q.obj\" 1 0 0 0\r\n"
               "mesh none.obj 1 0 0 0\nmesh \"none\nmesh p%q:r.obj 1 0 0 0\nmesh\n"
               "mesh " +
                   (shop / "far.obj") + " 1 0 0 0\n");
    shop.write("scenes/again.scene", "mesh a.obj 1 0 0 0\n");
    shop.write("scenes/knot.scene", "mesh ../build/knot.obj 1 0 0 0\n");
    const std::vector<std::string> parts = {"scenes/a.obj", "scenes/a.mtl", "scenes/sub/b.mtl",
                                            "scenes/c.mtl", "scenes/q.obj", shop / "far.obj"};
    const std::vector<std::string> others = {"scenes/my # room.obj", "scenes/my stuff.mtl",
                                             "scenes/p%q:r.obj"};
    for (const auto& names : {parts, others})
        for (const std::string& name : names)
            if (name != "scenes/a.obj") shop.write(name, "");
    shop.make("out/room.json out/again.json out/knot.json");
    CHECK(shop.has("build/knot"));
    long n = shop.renders();
    shop.make("out/room.json out/again.json");
    CHECK(shop.renders() == n);
    // As if the part had just been written.
    for (const std::string& name : parts) {
        INFO(name);
        shop.make("out/room.json -W " + name);
        CHECK(shop.renders() == ++n);
    }
    shop.make("out/again.json -W scenes/c.mtl");
    CHECK(shop.renders() == ++n);
    shop.make("out/again.json -W scenes/q.obj");
    CHECK(shop.renders() == n);
}

TEST_CASE("make build/scenes has the scenes of each set as files") {
    const Workshop shop;
    shop.write("scenes/calibration/hard", "@@ bulb\n# A bulb.\n\n@@ hole\n# A hole.\n");
    shop.write("scenes/calibration/ordinary", "@@ hole\n# Another.\n");
    shop.make("build/scenes");
    CHECK(shop.read("build/scenes/hard/bulb.scene") == "# A bulb.\n\n");
    CHECK(shop.read("build/scenes/hard/hole.scene") == "# A hole.\n");
    CHECK(shop.read("build/scenes/ordinary/hole.scene") == "# Another.\n");
    shop.write("scenes/calibration/hard", "@@ bulb\n# Another bulb.\n");
    shop.make_newer("scenes/calibration/hard", "build/scenes");
    shop.make("build/scenes");
    CHECK(shop.read("build/scenes/hard/bulb.scene") == "# Another bulb.\n");
    CHECK(!shop.has("build/scenes/hard/hole.scene"));
    CHECK(shop.has("build/scenes/ordinary/hole.scene"));
}

TEST_CASE("make draws the gallery without any module, and without the course") {
    const Workshop shop;
    fs::remove_all(shop / "src/keep");
    fs::remove_all(shop / "src/course");
    shop.make();
    CHECK(shop.has("out/index.html"));
}

TEST_CASE("the gallery shows no picture without its statistics") {
    const Workshop shop;
    shop.write("out/room.png", "");
    auto refused = [&](const std::string& json, const std::string& why) {
        if (!json.empty()) shop.write("out/room.json", json);
        const Printed said = shop.run("scenes/gallery out room");
        CHECK(said.text == "gallery: out/room.json" + why + "\n");
        CHECK(said.status == 1);
        CHECK(!shop.has("out/index.html"));
    };
    refused("", " is not there");
    refused(statistics.substr(0, 50), " has no number \"repeat_with_spp\"");
    for (const std::string key : {"height", "samples_per_pixel", "repeat_with_spp", "d_rel"}) {
        std::string json = statistics;
        json.replace(json.find(key) + key.size() + 3, 1, "x");
        refused(json, " has no number \"" + key + "\"");
    }
    // An error that is not known has its reason, as it stands in the file.
    std::string json = statistics;
    json.replace(json.find("0.0312"), 6, "null");
    refused(json, " has no reason why the error is not known");
    json.replace(json.rfind("null"), 4, R"("a lamp, \"small\" & \\ bright")");
    shop.write("out/room.json", json);
    CHECK(shop.run("scenes/gallery out room").status == 0);
    CHECK(contains(shop.read("out/index.html"),
                   "error not known: a lamp, &quot;small&quot; &amp; \\ bright</p>"));
}

TEST_CASE("the gallery's command repeats the picture, or takes as many samples") {
    const Workshop shop;
    for (const auto& [repeat, spp] : {std::pair("50", "50"), std::pair("null", "125")}) {
        std::string json = statistics;
        shop.write("out/room.json", json.replace(json.find("50,"), 2, repeat));
        CHECK(shop.run("scenes/gallery out room").status == 0);
        CHECK(contains(shop.read("out/index.html"),
                       "<code>build/penumbra --size 40x30 --spp " + std::string(spp) + " -o"));
    }
}

TEST_CASE("make says the name of a variant, and leaves the program without a suffix as it is") {
    const Workshop shop;
    shop.make("build/penumbra build/compare build/knot");
    const auto before = shop.read("build/penumbra");
    for (const auto& variant : std::map<std::string, std::string>{
             {"DEBUG=1", "-debug"}, {"SAN=1", "-san"}, {"TREE=plain REAL=float", "-float-plain"}})
        for (int time = 0; time < 2; ++time) {
            const std::string said =
                shop.make("build/penumbra build/compare build/knot " + variant.first);
            for (const std::string plain : {"build/penumbra", "build/compare", "build/knot"}) {
                INFO(variant.first, " ", plain);
                const std::string built = plain + variant.second;
                CHECK(
                    contains(said, "this variant is " + built + "; " + plain + " is as it was\n"));
                REQUIRE(shop.has(built));
                CHECK(contains(shop.read(built),
                               variant.second.substr(variant.second.rfind('-')) + "/"));
            }
        }
    shop.make_newer("build/penumbra", "build/penumbra-debug");
    CHECK(contains(shop.make("penumbra DEBUG=1"), "this variant is build/penumbra-debug;"));
    CHECK(shop.read("build/penumbra") == before);
    CHECK(!contains(shop.make("build/penumbra"), "variant"));
}

TEST_CASE("the gallery links pages, pictures and texts that are there, and no others") {
    const Workshop shop;
    shop.write("reference/hero.png", "");
    auto dead = [&] {
        std::string found;
        const std::string page = shop.read("out/index.html");
        const std::regex linked("(href|src)=\"([^\"]*)\"");
        for (std::sregex_iterator i(page.begin(), page.end(), linked), end; i != end; ++i) {
            const fs::path to = fs::path("out") / (*i)[2].str(), kind = to.extension();
            const bool shown =
                kind == ".png" || kind == ".html" || kind == ".json" || kind == ".scene";
            if (!shown || !shop.has(to.string())) found += to.string() + " ";
        }
        return found;
    };
    shop.make();  // make trade has not run
    CHECK(dead() == "");
    CHECK(!contains(shop.read("out/index.html"), "trade"));
    shop.write("out/trade/trade.html", "");
    shop.make();
    CHECK(dead() == "");
    CHECK(contains(shop.read("out/index.html"), "href=\"../out/trade/trade.html\""));
}

TEST_CASE("make installs stb for programs and doctest for tests, each when it is needed") {
    const Workshop shop;
    shop.write("missing", "doctest\nstb\n");
    shop.make("build/penumbra");
    CHECK(shop.read("installed") == "install -y libstb-dev\n");
    shop.make("packages");
    CHECK(shop.read("installed") == "install -y libstb-dev\ninstall -y doctest-dev\n");
    shop.make("packages build/compare");
    CHECK(shop.read("installed") == "install -y libstb-dev\ninstall -y doctest-dev\n");
    shop.write("missing", "doctest\n");
    shop.write("offline", "");
    const Printed said = shop.run("make CXX=./cc packages");
    CHECK(said.status == 2);
    CHECK(contains(said.text,
                   "penumbra: apt-get failed; run: sudo apt-get install -y doctest-dev\n"));
}

TEST_CASE("the compiler may be clang by another name, and finds Homebrew's headers last") {
    for (const std::string version : {"GNU", "Clang"}) {
        const Workshop shop;
        shop.write("version", version == "Clang" ? "Clang: Apple clang version 19" : version);
        shop.make("build/penumbra");
        CHECK(contains(shop.read("compiled"), " -idirafter /opt/brew/include "));
    }
}
