// world/scene_file_bounds_test.cpp  what little input may ask for: each attack of less than 10 kB a
// file is refused, or ends soon
#include "base/complaint.h"
#include "base/folder.h"
#include "world/scene_file.h"

namespace {

const std::string before = "camera 0 0 5  0 0 0  40\ndiffuse d .5 .5 .5\n";

// A line again and again, as long as the text stays below 10 kB.
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

// One polygon that goes round nine corners until 10 kB are full: two bytes a corner, and 7/9 of
// them have an area.
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
const std::string shining = "mtllib m.mtl\nusemtl a\n", mesh = "mesh m.obj 1 0 0 0",
                  grey_mesh = mesh + " d\n";

}  // namespace

TEST_CASE("a mesh of 10 kB that a scene of 25 kB repeats: so many shapes are too many") {
    const Folder folder;
    folder.write("m.obj", many_cornered());
    const size_t once = parsed(folder, before + grey_mesh).scene.shapes.size();
    CHECK(once > 3500);
    std::string text = before;
    for (size_t i = 0; i <= most_shapes / once; ++i) text += grey_mesh;
    const std::string why = complaint(folder, text), line = std::to_string(3 + most_shapes / once);
    CHECK(why.starts_with("s.scene:" + line + ": "));
    CHECK(why.ends_with("m.obj:10: more than 4194304 shapes, or materials"));
}

TEST_CASE("materials of a mesh that a scene repeats") {
    const Folder folder;
    folder.write("m.obj", shining + square + "f 1 2 3 4\n");
    std::string many = "newmtl a\n";
    for (int i = 0; i < 30000; ++i) many += "newmtl " + std::to_string(i) + "\n";
    folder.write("m.mtl", many);
    std::string text = before;
    for (size_t i = 0; i <= most_shapes / 30000; ++i) text += mesh + "\n";
    CHECK(complaint(folder, text).ends_with("more than 4194304 shapes, or materials"));
}

TEST_CASE("a concave face of 5000 corners: few are tried") {
    const Folder folder;
    // From all corners but two something is seen from its back; that is found out last.
    std::string arrow = "v 0 2 0\nv -1 -1 0\nv 0 0 0\nv 1 -1 0\nf";
    for (int i = 0; i < 4997; ++i) arrow += " 2";
    folder.write("m.obj", arrow + " 3 4 1\n");
    CHECK(complaint(folder, before + grey_mesh).c_str() ==
          doctest::Contains("of its first 16 corners"));
}

TEST_CASE("a hundred lights in one place have a warning each; a quarter of a million are refused") {
    const Folder folder;
    folder.write("m.mtl", "newmtl a\nKe 1 1 1\n");
    folder.write("m.obj", shining + square + "f 1 2 3\nf 3 4 1\n");
    std::string scene = before;
    for (int i = 0; i < 100; ++i) scene += mesh + "\n";
    const ParsedScene all = parsed(folder, scene);
    CHECK(all.scene.lights.size() == 200);
    REQUIRE(all.warnings.size() == 99);
    CHECK(all.warnings[0].starts_with("line 4: this light lies in the surface of line 3: "));
    CHECK(all.warnings[98].starts_with("line 102: this light lies in the surface of line "));
    folder.write("m.obj", filled(shining + square, "f 1 2 3\nf 3 4 1\n"));
    for (int i = 0; i < 100; ++i) scene += mesh + "\n";
    CHECK(complaint(folder, scene) == "s.scene: too many shapes where lights are");
}

TEST_CASE("a wall of forty thousand lights, across any axis, is no crowd") {
    for (const char* place : {"0 %d %d", "%d 0 %d", "%d %d 0"}) {
        std::string obj = shining;
        for (int row = 0; row < 200; ++row)
            for (int column = 0; column < 200; ++column) {
                for (const auto& [y, z] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1)}) {
                    char at[40];
                    std::snprintf(at, sizeof at, place, row + y, column + z);
                    obj += "v " + std::string(at) + "\n";
                }
                obj += "f -3 -2 -1\n";
            }
        const Folder folder;
        folder.write("m.mtl", "newmtl a\nKe 1 1 1\n");
        folder.write("m.obj", obj);
        const ParsedScene wall = parsed(folder, before + mesh + "\n");
        CHECK(wall.scene.lights.size() == 40000);
        CHECK(wall.warnings.empty());
    }
}

TEST_CASE("hundreds of point lights beside a hundred thousand shapes: the first on one is told") {
    const Folder folder;
    folder.write("m.obj", filled(square, "f 1 2 3\n"));
    std::string scene = before;
    for (int i = 0; i < 100; ++i) scene += grey_mesh;
    const std::string beside = "pointlight .2 .9 0  1 1 1\n";  // in the plane, in the box
    scene = filled(scene, beside);
    CHECK(parsed(folder, scene).scene.lights.size() > 250);
    // Of two that lie on shapes the first, and of its shapes the first.
    const std::string on = "pointlight .9 .2 0  1 1 1\n", off = "pointlight .2 .9 1  1 1 1\n";
    const std::string found = complaint(
        folder, before + off + "mesh m.obj 1 9 0 0 d\n" + on + on + grey_mesh + grey_mesh);
    CHECK(found == "s.scene:5: this point light lies on the surface of line 7: move it off");
    const std::string later =
        complaint(folder, before + "pointlight 9.9 .2 0  1 1 1\nmesh m.obj 1 0 0 0 d\n" + on +
                              "mesh m.obj 1 9 0 0 d\n");
    CHECK(later == "s.scene:3: this point light lies on the surface of line 6: move it off");
}

TEST_CASE("words and lines of 10 kB, numbers of 10 000 digits, a line of 5000 words") {
    const Folder folder;
    folder.write("m.obj", "mtllib m.obj\n" + square + "f 1 2 3\n");  // itself
    const std::string digits(9000, '1');
    CHECK(parsed(folder, before + "sphere 0 0 0  0." + digits + "  d\n").scene.shapes[0].r ==
          doctest::Approx(1. / 9));
    const std::pair<std::string, const char*> rows[] = {
        {before + "sphere 0 0 0 " + digits + " d\n", "is too large"},
        {std::string(9990, 'x'), "unknown keyword 'xxx"},
        {filled("sphere", " 1"), "too many words"},
        {before + filled("sphere 0 0 0 1 ", "d"), "unknown material"},
        {before + grey_mesh, "m.obj: no material in it"},
        {before + "mesh s.scene 1 0 0 0 d\n", "cannot open"}};
    for (const auto& [text, why] : rows)
        CHECK(complaint(folder, text).c_str() == doctest::Contains(why));
}
