// world/scene_file_bounds_test.cpp  what little input may ask for: each attack of less than 10 kB a
// file is refused, or ends soon
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
    return parse_scene(text, (folder.path / "s.scene").string());
}

std::string complaint(const Folder& folder, const std::string& text) {
    try {
        parsed(folder, text);
        return "";
    } catch (const UserError& e) {
        return std::string(e.what()).substr(folder.path.string().size() + 1);
    }
}

// One polygon that goes round nine corners until 10 kB are full: two bytes a corner, and 7/9 of
// them have an area.
std::string many_cornered(const std::string& first = "") {
    std::string text = first;
    for (int i = 0; i < 9; ++i)
        text += "v " + std::to_string(std::cos(i * 0.698)).substr(0, 5) + " " +
                std::to_string(std::sin(i * 0.698)).substr(0, 5) + " 0\n";
    text += "f";
    for (int i = 0; text.size() < 9990; ++i) text += " " + std::to_string(i % 9 + 1);
    return text + "\n";
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string shining = "mtllib m.mtl\nusemtl a\n";

}  // namespace

TEST_CASE("a mesh of 10 kB that a scene of 10 kB repeats: so many shapes are too many") {
    const Folder folder;
    folder.write("m.obj", many_cornered());
    const Scene once = parsed(folder, before + "mesh m.obj 1 0 0 0 d\n").scene;
    CHECK(once.shapes.size() > 3500);
    const std::string again = filled(before, "mesh m.obj 1 0 0 0 d\n");
    const std::string why = complaint(folder, again);
    CHECK(why.find("s.scene:") == 0);
    CHECK(
        why.find("meshes are repeated too often: more than 262144 shapes, and 8 for each of the") !=
        why.npos);
    // By as many names of the file.
    std::string other = before;
    for (unsigned i = 0; i < 128; ++i) {
        std::string name = "m.obj";
        for (unsigned bit = 1; bit < 128; bit *= 2) name = (i & bit ? ".//" : "./") + name;
        other += "mesh " + name + " 1 0 0 0 d\n";
    }
    REQUIRE(other.size() < 10000);
    CHECK(complaint(folder, other).find("meshes are repeated too often") != std::string::npos);
}

TEST_CASE("what large files ask for is theirs: bytes are counted, each file once") {
    const Allowance allowance{"things", 100, 8};
    CHECK_NOTHROW(allowance.check(100, 0));
    CHECK_NOTHROW(allowance.check(180, 10));
    CHECK_THROWS_WITH_AS(allowance.check(181, 10),
                         "meshes are repeated too often: more than 100 things, and 8 for each of "
                         "the 10 bytes read",
                         UserError);
    // A mesh that is placed once stays below whatever its size: a face of many corners has least
    // bytes a shape, and half of the steps of a concave one's corners at 4 bytes are a 64th.
    CHECK(most_shapes.a_byte >= 1);
    CHECK(most_fan_steps.a_byte >= most_concave / 4);
    // A forest of sixty trees of 4000 shapes.
    const Folder folder;
    folder.write("m.obj", many_cornered());
    std::string forest = before;
    for (int i = 0; i < 60; ++i) forest += "mesh m.obj 1 " + std::to_string(3 * i) + " 0 0 d\n";
    CHECK(parsed(folder, forest).scene.shapes.size() > 200000);
}

TEST_CASE("a concave face that a scene repeats is cut up so often and no more") {
    const Folder folder;
    // From all corners but two something is seen from its back; that is found out last.
    std::string arrow = "v 0 2 0\nv -1 -1 0\nv 0 0 0\nv 1 -1 0\nf";
    for (int i = 0; i < 997; ++i) arrow += " 2";
    arrow += " 3 4 1\n";
    folder.write("m.obj", filled(arrow, arrow.substr(arrow.find('f'))));
    CHECK(complaint(folder, before + "mesh m.obj 1 0 0 0 d\n") == "");
    const std::string why = complaint(folder, filled(before, "mesh m.obj 1 0 0 0 d\n"));
    CHECK(why.find(
              "meshes are repeated too often: more than 33554432 steps to cut up concave faces") !=
          why.npos);
    // Convex faces take a step a corner.
    folder.write("m.obj", many_cornered());
    CHECK(complaint(folder, before + "mesh m.obj 1 0 0 0 d\nmesh m.obj 1 0 0 9 d\n") == "");
}

TEST_CASE("materials of a mesh that a scene repeats") {
    const Folder folder;
    folder.write("m.obj", shining + square + "f 1 2 3 4\n");
    std::string many = "newmtl a\n";
    for (int i = 0; many.size() < 9990; ++i) many += "newmtl " + std::to_string(i) + "\n";
    folder.write("m.mtl", many);
    const std::string why = complaint(folder, filled(before, "mesh m.obj 1 0 0 0\n"));
    CHECK(why.find("more than 65536 materials, and 8 for each of the") != why.npos);
}

TEST_CASE(
    "a quarter of a million lights in the same places: all but one set go, a warning a line") {
    const Folder folder;
    folder.write("m.mtl", "newmtl a\nKe 1 1 1\n");
    std::string faces = filled(shining + square, "f 1 2 3\nf 3 4 1\n");
    folder.write("m.obj", faces);
    const size_t in_one = parsed(folder, before + "mesh m.obj 1 0 0 0\n").scene.shapes.size();
    std::string scene = before;
    for (int i = 0; i < 200; ++i) scene += "mesh m.obj 1 0 0 0\n";
    const ParsedScene all = parsed(folder, scene);
    CHECK(all.scene.shapes.size() == 200 * in_one);
    CHECK(all.scene.lights.size() == 2);
    CHECK(all.scene.line_of_light == std::vector<uint32_t>{3, 3});
    CHECK(std::count(all.scene.light_of.begin(), all.scene.light_of.end(), no_light) ==
          ptrdiff_t(200 * in_one - 2));
    REQUIRE(all.warnings.size() == 200);
    CHECK(all.warnings[0] == "line 3: this light is dark: line 3 covers it, which comes first");
    CHECK(all.warnings[199] == "line 202: this light is dark: line 3 covers it, which comes first");
}

TEST_CASE("lights in other places stay, and know their shapes") {
    const Folder folder;
    folder.write("m.mtl", "newmtl a\nKe 1 1 1\n");
    folder.write("m.obj", filled(shining + square, "f 1 2 3\n"));
    std::string scene = before;
    for (int i = 0; i < 100; ++i) scene += "mesh m.obj 1 " + std::to_string(i / 2) + " 0 0\n";
    const Scene s = parsed(folder, scene).scene;
    REQUIRE(s.lights.size() == 50);
    for (size_t i = 0; i < s.shapes.size(); ++i)
        if (const int32_t k = s.light_of[i]; k != no_light)
            CHECK(s.lights[size_t(k)].p == s.shapes[i].a);
}

TEST_CASE("hundreds of point lights beside a hundred thousand shapes: the first on one is told") {
    const Folder folder;
    folder.write("m.obj", filled(square, "f 1 2 3\n"));
    std::string scene = before;
    for (int i = 0; i < 100; ++i) scene += "mesh m.obj 1 0 0 0 d\n";
    const std::string beside = "pointlight .2 .9 0  1 1 1\n";  // in the plane, in the box
    scene = filled(scene, beside);
    CHECK(parsed(folder, scene).scene.lights.size() > 250);
    // Of two that lie on shapes the first, and of its shapes the first.
    const std::string on = "pointlight .9 .2 0  1 1 1\n", off = "pointlight .2 .9 1  1 1 1\n";
    const std::string found = complaint(folder, before + off + "mesh m.obj 1 9 0 0 d\n" + on + on +
                                                    "mesh m.obj 1 0 0 0 d\nmesh m.obj 1 0 0 0 d\n");
    CHECK(found == "s.scene:5: this point light lies on the surface of line 7: move it off");
    const std::string later =
        complaint(folder, before + "pointlight 9.9 .2 0  1 1 1\nmesh m.obj 1 0 0 0 d\n" + on +
                              "mesh m.obj 1 9 0 0 d\n");
    CHECK(later == "s.scene:3: this point light lies on the surface of line 6: move it off");
}

TEST_CASE("words and lines of 10 kB, numbers of 10 000 digits, a line of 5000 words") {
    const Folder folder;
    const std::string digits(9000, '1');
    CHECK(parsed(folder, before + "sphere 0 0 0  0." + digits + "  d\n").scene.shapes[0].r ==
          doctest::Approx(1. / 9));
    CHECK(complaint(folder, before + "sphere 0 0 0 " + digits + " d\n").find("out of range") !=
          std::string::npos);
    CHECK(complaint(folder, std::string(9990, 'x')).find("unknown keyword 'xxx") !=
          std::string::npos);
    CHECK(complaint(folder, filled("sphere", " 1")).find("too many words") != std::string::npos);
    CHECK(complaint(folder, before + filled("sphere 0 0 0 1 ", "d")).find("undefined material") !=
          std::string::npos);
    folder.write("m.obj", "mtllib m.obj\n" + square + "f 1 2 3\n");  // itself
    CHECK(complaint(folder, before + "mesh m.obj 1 0 0 0 d\n").find("m.obj: no material in it") !=
          std::string::npos);
    CHECK(complaint(folder, before + "mesh s.scene 1 0 0 0 d\n").find("cannot open") !=
          std::string::npos);
}

TEST_CASE(
    "shapes in one place, or each a thousand times as large as the last: a tree of 64 levels") {
    // More would overrun the stack of its rays.
    const Folder folder;
    const std::string row = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    folder.write("m.obj", filled(row, "f 1 2 3\n"));
    std::string alike = before, growing = before;
    for (int i = 0; i < 60; ++i) {
        alike += "mesh m.obj 1 0 0 0 d\n";
        growing += "mesh m.obj 1e" + std::to_string(i % 17 - 8) + " 0 0 0 d\n";
    }
    for (const std::string& text : {alike, growing}) {
        const Scene s = parsed(folder, text).scene;
        CHECK(s.shapes.size() > 70000);
        const bvh::BinaryTree tree = bvh::build(s.shapes);
        CHECK(tree.branches.size() < 2 * s.shapes.size());
        std::vector<int> depth(tree.branches.size());
        for (size_t i = 0; i < tree.branches.size(); ++i)
            if (const uint32_t left = tree.branches[i].left)
                depth[left] = depth[left + 1] = depth[i] + 1;
        CHECK(*std::max_element(depth.begin(), depth.end()) < bvh::BinaryTree::depth);
    }
}
