// text/scene_file_bounds_test.cpp  bounds on input: every attack with files of less than 10 kB is
// refused, or ends soon
#include "base/cases.h"
#include "text/complaint.h"
#include "text/folder.h"
#include "text/scene_file.h"

namespace {

const std::string before = "camera 0 0 5  0 0 0  40\ndiffuse d .5 .5 .5\nlight l 1 1 1\n";

// `before`, followed by `times` copies of a line.
std::string repeated(size_t times, const std::string& line) {
    std::string text = before;
    for (size_t i = 0; i < times; ++i) text += line;
    return text;
}

// Repeats a line as long as the text stays below 10 kB.
std::string filled(std::string text, const std::string& line) {
    while (text.size() + line.size() < 10000) text += line;
    return text;
}

ParsedScene parsed(const Folder& folder, const std::string& text) {
    return parse_scene(text, folder / "s.scene");
}

std::string complaint(const Folder& folder, const std::string& text) {
    const std::string why = ::complaint([&] { parsed(folder, text); });
    return why.substr(std::min(why.size(), (folder / "").size()));
}

// One polygon of 10 kB that visits nine corners again and again: two bytes per corner, and 7/9 of
// its triangles have an area.
std::string many_cornered() {
    std::string text;
    for (int i = 0; i < 9; ++i)
        text += "v " + std::to_string(std::cos(i * 0.698)).substr(0, 5) + " " +
                std::to_string(std::sin(i * 0.698)).substr(0, 5) + " 0\n";
    text += "f";
    for (int i = 0; text.size() < 9990; ++i) text += " " + std::to_string(i % 9 + 1);
    return text + "\n";
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string shining = "mtllib m.mtl\nusemtl a\n", placed = "mesh m.obj 1 0 0 0\n",
                  grey_mesh = "mesh m.obj 1 0 0 0 d\n";

}  // namespace

TEST_CASE("a mesh of 10 kB that a scene of 25 kB repeats: so many shapes are too many") {
    const Folder folder;
    folder.write("m.obj", many_cornered());
    const size_t once = parsed(folder, before + grey_mesh).scene.shapes.size();
    CHECK(once > 3500);
    const size_t times = max_shapes / once + 1;
    const std::string why = complaint(folder, repeated(times, grey_mesh)),
                      line = std::to_string(3 + times);
    CHECK(why.starts_with("s.scene:" + line + ": "));
    CHECK(why.ends_with("m.obj:10: more than 4194304 shapes"));
}

TEST_CASE("boxes, like meshes, are at most 2^22 shapes") {
    const size_t times = max_shapes / 12 + 1;
    const Folder folder;
    CHECK(complaint(folder, repeated(times, "box 1 1 1 0 0 0 0 d\n")) ==
          "s.scene:" + std::to_string(3 + times) + ": more than 4194304 shapes");
}

TEST_CASE("of a library that a scene repeats, the materials that faces name count") {
    const Folder folder;
    folder.write("m.obj", "mtllib m.mtl\nusemtl 7\n" + square + "f 1 2 3 4\nf 1 2 3\n");
    std::string many;
    for (int i = 0; i < 1000; ++i) many += "newmtl " + std::to_string(i) + "\n";
    folder.write("m.mtl", many);
    const size_t times = 500;
    CHECK(parsed(folder, repeated(times, placed)).scene.materials.size() == times + 2);
}

TEST_CASE(
    "concave faces of a thousand corners that a scene repeats are cut up until it takes a second") {
    std::string comb = "v 0 -1 0\nv 999 -1 0\n", face = "f 1 2";
    for (int i = 999; i >= 0; --i) {
        comb += "v " + said(i, i % 2 ? 0 : 5, 0) + "\n";
        face += " -" + std::to_string(i + 1);
    }
    const Folder folder;
    folder.write("m.obj", comb + face + "\n");
    CHECK(parsed(folder, before + grey_mesh).warnings.size() == 1);  // no light
    const ParsedScene all = parsed(folder, repeated(400, grey_mesh));
    CHECK(all.scene.shapes.size() > 400 * 990);
    REQUIRE(all.warnings.size() == 2);
    CHECK(all.warnings[0].find(
              "1 face is too large to cut up, first at line 1003: triangles may overlap") !=
          std::string::npos);
}

TEST_CASE("a hundred lights in one place have a warning each; thousands are refused") {
    const Folder folder;
    folder.write("m.mtl", "newmtl a\nKe 1 1 1\n");
    folder.write("m.obj", shining + square + "f 1 2 3\nf 3 4 1\n");
    const ParsedScene all = parsed(folder, repeated(100, placed));
    CHECK(all.scene.lights.size() == 200);
    REQUIRE(all.warnings.size() == 99);
    CHECK(all.warnings[0].starts_with(
        "line 5 (m.obj:7): this light lies in the surface of line 4 (m.obj:7): "));
    CHECK(all.warnings[98].starts_with(
        "line 103 (m.obj:7): this light lies in the surface of line "));
    CHECK(complaint(folder, repeated(4200, "sphere 0 0 0 1 l\n")) ==
          "s.scene: too many shapes where lights or glass are");
}

TEST_CASE("a wall of so many lights that none may be in one place, across any axis, is no crowd") {
    const int n = 160;  // all 3e8 pairs are too many to test
    for (const char* place : {"v 0 %d %d\n", "v %d 0 %d\n", "v %d %d 0\n"}) {
        std::string obj = shining;
        for (int i = 0; i <= n; ++i)
            for (int k = 0; k <= n; ++k) {
                char at[40];
                std::snprintf(at, sizeof at, place, i, k);
                obj += at;
            }
        for (int i = 0; i < n * (n + 1); ++i)
            if (i % (n + 1) < n) obj += "f " + said(i + 1, i + 2, i + n + 2) + "\n";
        const Folder folder;
        folder.write("m.mtl", "newmtl a\nKe 1 1 1\n");
        folder.write("m.obj", obj);
        const ParsedScene wall = parsed(folder, before + placed);
        CHECK(wall.scene.lights.size() == n * n);
        CHECK(wall.warnings.empty());
    }
}

TEST_CASE("hundreds of point lights beside ten thousand shapes: the first on one is told") {
    const Folder folder;
    folder.write("m.obj", filled(square, "f 1 2 3\n"));
    const std::string beside = "pointlight .2 .9 0  1 1 1\n";  // in the plane and in the box
    CHECK(parsed(folder, filled(repeated(10, grey_mesh), beside)).scene.lights.size() > 250);
    // The message names the first of two lights on shapes, and the first shape below it.
    const std::string on = "pointlight .9 .2 0  1 1 1\n", off = "pointlight .2 .9 1  1 1 1\n";
    const std::string found = complaint(
        folder, before + off + "mesh m.obj 1 9 0 0 d\n" + on + on + grey_mesh + grey_mesh);
    CHECK(found ==
          "s.scene:6: this point light lies on the surface of line 8 (m.obj:5): move it off");
    const std::string later =
        complaint(folder, before + "pointlight 9.9 .2 0  1 1 1\nmesh m.obj 1 0 0 0 d\n" + on +
                              "mesh m.obj 1 9 0 0 d\n");
    CHECK(later ==
          "s.scene:4: this point light lies on the surface of line 7 (m.obj:5): move it off");
}

TEST_CASE("words and lines of 10 kB, numbers of 10 000 digits, a line of 5000 words") {
    const Folder folder;
    folder.write("m.obj", "mtllib m.obj\n" + square + "f 1 2 3\n");  // names itself
    const std::string digits(9000, '1');
    CHECK(parsed(folder, before + "sphere 0 0 0  0." + digits + "  d\n").scene.shapes[0].r ==
          doctest::Approx(1. / 9));
    const std::pair<std::string, const char*> rows[] = {
        {before + "sphere 0 0 0 " + digits + " d\n", "is too large"},
        {std::string(9990, 'x'), "unknown keyword 'xxx"},
        {filled("sphere", " 1"), "too many words"},
        {before + filled("sphere 0 0 0 1 ", "d"), "unknown material"},
        {before + "mesh s.scene 1 0 0 0 d\n", "cannot open"}};
    for (const auto& [text, why] : rows)
        CHECK(complaint(folder, text).c_str() == doctest::Contains(why));
}
