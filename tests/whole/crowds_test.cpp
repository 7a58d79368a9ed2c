// whole/crowds_test.cpp  what the scene check says of meshes, and of crowds of lights
#include <doctest/doctest.h>

#include "base/cases.h"
#include "check/scene_check.h"
#include "text/complaint.h"
#include "text/folder.h"
#include "text/scene_file.h"

namespace {

// A scene s.scene in a folder, with meshes.
const std::string grey_scene = "camera 0 0 5  0 0 0  40\ndiffuse d .5 .5 .5\nlight l 1 1 1\n";
const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string shining = "mtllib m.mtl\nusemtl a\n", placed = "mesh m.obj 1 0 0 0\n",
                  grey_mesh = "mesh m.obj 1 0 0 0 d\n";

std::string repeated(size_t times, const std::string& line) {
    std::string text;
    while (times-- > 0) text += line;
    return text;
}
ParsedScene parsed_in(const Folder& folder, const std::string& text) {
    return parse_scene(text, folder / "s.scene");
}
std::string complaint_in(const Folder& folder, const std::string& text) {
    const std::string why = complaint([&] { parsed_in(folder, text); });
    return why.substr(std::min(why.size(), (folder / "").size()));
}

}  // namespace

TEST_CASE("a hundred lights in one place have a warning each; thousands are refused") {
    const Folder folder;
    folder.write("m.mtl", "newmtl a\nKe 1 1 1\n");
    folder.write("m.obj", shining + square + "f 1 2 3\nf 3 4 1\n");
    const ParsedScene all = parsed_in(folder, grey_scene + repeated(100, placed));
    CHECK(all.scene.lights.size() == 200);
    REQUIRE(all.warnings.size() == 99);
    CHECK(all.warnings[0].starts_with(
        "line 5 (m.obj:7): this light lies in the surface of line 4 (m.obj:7): "));
    CHECK(all.warnings[98].starts_with(
        "line 103 (m.obj:7): this light lies in the surface of line "));
    CHECK(complaint_in(folder, grey_scene + repeated(4200, "sphere 0 0 0 1 l\n")) ==
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
        const ParsedScene wall = parsed_in(folder, grey_scene + placed);
        CHECK(wall.scene.lights.size() == n * n);
        CHECK(wall.warnings.empty());
    }
}

TEST_CASE("hundreds of point lights beside ten thousand shapes: the first on one is told") {
    const Folder folder;
    folder.write("m.obj", square + repeated(1200, "f 1 2 3\n"));
    const std::string beside = "pointlight .2 .9 0  1 1 1\n";  // in the plane and in the box
    CHECK(parsed_in(folder, grey_scene + repeated(10, grey_mesh) + repeated(300, beside))
              .scene.lights.size() > 250);
    // The message names the first of two lights on shapes, and the first shape below it.
    const std::string on = "pointlight .9 .2 0  1 1 1\n", off = "pointlight .2 .9 1  1 1 1\n";
    const std::string found = complaint_in(
        folder, grey_scene + off + "mesh m.obj 1 9 0 0 d\n" + on + on + grey_mesh + grey_mesh);
    CHECK(found ==
          "s.scene:6: this point light lies on the surface of line 8 (m.obj:5): move it off");
    const std::string later =
        complaint_in(folder, grey_scene + "pointlight 9.9 .2 0  1 1 1\nmesh m.obj 1 0 0 0 d\n" +
                                 on + "mesh m.obj 1 9 0 0 d\n");
    CHECK(later ==
          "s.scene:4: this point light lies on the surface of line 7 (m.obj:5): move it off");
    const std::string crowd = grey_scene + repeated(10, grey_mesh) + repeated(6000, beside);
    CHECK(complaint_in(folder, crowd) ==
          "s.scene: too many lights without a surface where shapes are");
}

TEST_CASE("warnings about a mesh's faces name its own lines") {
    const Folder folder;
    folder.write("m.mtl", "newmtl floor\nKd .5 .5 .5\nnewmtl lamp\nKe 5 5 5\n");
    folder.write("a # mesh.obj",
                 "mtllib m.mtl\n" + square + "usemtl floor\nf 4 3 2 1\nusemtl lamp\nf 4 3 2\n");
    const ParsedScene scene =
        parse_scene("camera 0 2 3  0 0 0  40\nmesh \"a # mesh.obj\" 1 0 0 0  # in quotes\n",
                    folder / "s.scene");
    CHECK(scene.warnings ==
          std::vector<std::string>{
              "line 2 (a # mesh.obj:9): this light lies in the surface of line 2 (a # "
              "mesh.obj:7): it is moved in front of it (of two lights in one place, the first)"});
}
