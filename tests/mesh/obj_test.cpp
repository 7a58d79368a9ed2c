// mesh/obj_test.cpp  meshes: accepted and refused statements, line numbers of errors, images equal
// to those of scenes written by hand
#include "mesh/obj.h"

#include "base/complaint.h"
#include "base/folder.h"
#include "world/scene_file.h"

namespace {

Scene scene_with(const Folder& folder, const std::string& obj,
                 const std::string& placement = "1 0 0 0 grey") {
    folder.write("m.obj", obj);
    const std::string text =
        "camera 0 0 5  0 0 0  40\ndiffuse grey 0.5 0.5 0.5\nmesh m.obj " + placement + "\n";
    return parse_scene(text, folder / "s.scene").scene;
}

// Returns the error of reading `obj`, without the folder; "" if there is none.
std::string complaint(const Folder& folder, const std::string& obj) {
    const std::string why = ::complaint([&] { scene_with(folder, obj); }), place = folder / "";
    return why.empty() ? "" : why.substr(std::min(why.size(), why.find(place, 1) + place.size()));
}

// Returns the statement of a vertex.
std::string at(double x, double y) {
    return "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
}

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

using Corners = std::vector<vec3>;
Corners corners_of(const Shape& s) { return {s.a, s.b, s.c}; }

}  // namespace

TEST_CASE("an OBJ file that cannot be used is refused at its line") {
    const Folder folder;
    folder.write("good.mtl", "newmtl red\nKd 1 0 0\nNs 3\nmap_Kd no.png\n");
    folder.write("none_in_it.mtl", "# nothing\nillum 2\n");
    folder.write("early.mtl", "Kd 1 0 0\n");
    folder.write("bright.mtl", "newmtl a\nKd 1 0 1.5\n");
    folder.write("negative.mtl", "newmtl a\nKe 1 0 -1\n");
    folder.write("twice.mtl", "newmtl a\nnewmtl a\n");
    const struct {
        std::string text, message;
    } table[] = {
        {"v 1 2\n", "m.obj:1: v needs three numbers"},
        {"v 1 2 x\n", "m.obj:1: 'x' is not a number"},
        {"\nv 1 nan 2\n", "m.obj:2: 'nan' is not a number"},
        {"v 1 1e999 2\n", "m.obj:1: '1e999' is too large"},
        {corners + "f 1 2\n", "m.obj:5: a face needs three corners or more"},
        {corners + "f 1 2 5\n", "m.obj:5: no vertex '5' among the 4 so far"},
        {corners + "f 0 1 2\n", "m.obj:5: no vertex '0' among the 4 so far"},
        {corners + "f -5 1 2\n", "m.obj:5: no vertex '-5' among the 4 so far"},
        {corners + "f 1.5 2 3\n", "m.obj:5: no vertex '1.5' among the 4 so far"},
        {corners + "f a b c\n", "m.obj:5: 'a' is not a number"},
        {"f 1 2 3\n" + corners, "m.obj:1: no vertex '1' among the 0 so far"},
        {"usemtl red\n", "m.obj:1: unknown material 'red'"},
        {"usemtl\n", "m.obj:1: usemtl needs a name"},
        {"vertex 1 2 3\n", "m.obj:1: not a line of an OBJ file"},
        {"root:x:0:0::/root:/bin/sh\n", "m.obj:1: not a line of an OBJ file"},
        {corners, "m.obj: no face in it"},
        {"", "m.obj: no face in it"},
        {"mtllib none_in_it.mtl\nf 1 2 3\n", "none_in_it.mtl: no material in it"},
        {"mtllib good.mtl\nusemtl Red\n", "unknown material 'Red' (did you mean 'red'?)"},
        {"mtllib early.mtl\n", "early.mtl:1: Kd before newmtl"},
        {"mtllib bright.mtl\n", "bright.mtl:2: Kd must not exceed 1"},
        {"mtllib negative.mtl\n", "negative.mtl:2: a colour must not be negative"},
        {"mtllib twice.mtl\n", "twice.mtl:2: a second material 'a'"},
        {"mtllib good.mtl\nusemtl blue\n", "m.obj:2: unknown material 'blue'"},
        // The message names the line with `mtllib`, whatever the lines inside the library are.
        {"\n\n\nmtllib none_in_it.mtl\n", "m.obj:4: "},
        {"\n\nmtllib bright.mtl\n", "m.obj:3: "},
        {"mtllib good.mtl\nmtllib none_in_it.mtl\n", "none_in_it.mtl: no material in it"},
        {"mtllib good.mtl\nmtllib early.mtl\n", "early.mtl:1: Kd before newmtl"},
        {"mtllib none.mtl\n", "cannot open"},
    };
    for (const auto& row : table) {
        const std::string found = complaint(folder, row.text);
        INFO("found ", found, ", expected ", row.message);
        CHECK(found.find(row.message) != found.npos);
    }

    CHECK(complaint(folder, "mtllib good.mtl\nusemtl red\n" + corners + "f 1 2 3\n").empty());
}

TEST_CASE("faces: any number of corners, indices from the end, texture and normal indices") {
    const Folder folder;
    for (const char* face :
         {"f 1 2 3 4", "f -4 -3 -2 -1", "f 1/1 2/2 3/3 4/4", "f 1//1 2//1 3//1 4//1",
          "f 1/9/9 2/9/9 3/9/9 4/9/9", "f 1 2 3 4 # 5", "f 1 2 3 4# 5"}) {
        CAPTURE(face);
        const Scene s = scene_with(
            folder, "# comment\no thing\nvn 0 0 1\nvt 0 0\ng a\ns off\n" + corners + face + "\r\n");
        REQUIRE(s.shapes.size() == 2);
        CHECK(corners_of(s.shapes[0]) == Corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
        CHECK(corners_of(s.shapes[1]) == Corners{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    }
    std::string ngon, face = "f";
    for (int i = 0; i < 100; ++i) {
        ngon += at(std::cos(i * 0.0628318530718), std::sin(i * 0.0628318530718));
        (face += " ") += std::to_string(i + 1);
    }
    const Scene scene = scene_with(folder, ngon + face + "\n");
    CHECK(scene.shapes.size() == 98);
    double area = 0;
    for (const Shape& s : scene.shapes) area += double(area_vector(s).z) / 2;
    CHECK(area == doctest::Approx(50 * std::sin(0.0628318530718)).epsilon(1e-5));
}

TEST_CASE("an arrowhead is fanned from the corner that sees all, a star is refused") {
    const Folder folder;
    const std::string arrow = "v 0 2 0\nv -1 -1 0\nv 0 0 0\nv 1 -1 0\n";
    for (const char* face : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3"}) {
        const Scene scene = scene_with(folder, arrow + face + "\n");
        REQUIRE(scene.shapes.size() == 2);
        for (const Shape& s : scene.shapes) CHECK(double(area_vector(s).z) == doctest::Approx(2));
    }
    std::string star;
    for (int i = 0; i < 10; ++i) {
        const double r = i % 2 ? 0.2 : 1, angle = i * 0.628318530718;
        star += at(r * std::cos(angle), r * std::sin(angle));
    }
    CHECK(complaint(folder, star + "f 1 2 3 4 5 6 7 8 9 10\n")
              .starts_with("m.obj:11: none of its first 16 corners sees all others"));
}

TEST_CASE("a corner between two others in line is a corner, wherever the polygon begins") {
    Corners square = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    for (size_t start = 0; start < square.size(); ++start) {
        const auto fan = fan_of(square);
        REQUIRE(fan);
        CHECK(*fan == square);  // convex: not rotated
        std::rotate(square.begin(), square.begin() + 1, square.end());
    }
}

TEST_CASE(
    "of a concave face the first 16 corners are tried as the fan's, of a convex one any number") {
    // A star about the origin: only the origin, its last corner, sees all other corners.
    auto star = [](size_t n) {
        Corners tips;
        for (size_t i = 0; i < n; ++i) {
            const real angle = real(1.5) * real(i) / real(n), r = real(1 + i % 2);
            tips.push_back({r * std::cos(angle), r * std::sin(angle), 0});
        }
        tips.push_back({0, 0, 0});
        return tips;
    };
    const auto fan = fan_of(star(most_starts - 1));
    REQUIRE(fan);
    CHECK(fan->at(0) == vec3{0, 0, 0});
    CHECK(fan->at(1) == star(most_starts - 1)[0]);
    CHECK(!fan_of(star(most_starts)));
    Corners round;
    for (int i = 0; i < 5000; ++i)
        round.push_back({real(std::cos(i * 0.001)), real(std::sin(i * 0.001)), 0});
    CHECK(fan_of(round));
}

TEST_CASE("a mesh is scaled, then moved; a material of its own goes before the scene's") {
    const Folder folder;
    folder.write("m.mtl", "newmtl lamp\nKd 0.1 0.2 0.3\nKe 4 5 6\n");
    const Scene scene =
        scene_with(folder, "mtllib m.mtl\n" + corners + "f 1 2 3\nusemtl lamp\nf 1 2 3 4\n",
                   "2 10 20 30 grey");
    REQUIRE(scene.shapes.size() == 3);
    REQUIRE(scene.material_of.size() == 3);
    CHECK(scene.shapes[0].c == vec3{12, 22, 30});
    CHECK(scene.materials[scene.material_of[0]].kd == rgb{0.5, 0.5, 0.5});
    CHECK(scene.materials[scene.material_of[1]].kd == rgb{real(0.1), real(0.2), real(0.3)});
    REQUIRE(scene.lights.size() == 1);  // the square is one light
    CHECK(scene.lights[0].kind == Light::Kind::quad);
    CHECK(scene.lights[0].L == rgb{4, 5, 6});
    CHECK(scene.light_of == std::vector<int32_t>{no_light, 0, 0});
    CHECK_THROWS_WITH_AS(scene_with(folder, corners + "f 1 2 3\n", "1 0 0 0"),
                         doctest::Contains("m.obj:5: no material"), UserError);
    CHECK_THROWS_WITH_AS(scene_with(folder, corners, "0 0 0 0 grey"),
                         doctest::Contains("s.scene:3: scale must be positive"), UserError);
}

TEST_CASE("cornell36 by statements and as OBJ are the same shapes, materials and lights") {
    const Scene a = read_scene("scenes/cornell36.scene").scene;
    const Scene b = read_scene("scenes/cornell36obj.scene").scene;
    REQUIRE(a.shapes.size() == 36);
    REQUIRE(b.shapes.size() == 36);
    for (size_t i = 0; i < a.shapes.size(); ++i) {
        CHECK((a.shapes[i].a == b.shapes[i].a && a.shapes[i].b == b.shapes[i].b &&
               a.shapes[i].c == b.shapes[i].c));
        CHECK(a.materials[a.material_of[i]].kd == b.materials[b.material_of[i]].kd);
        CHECK(a.light_of[i] == b.light_of[i]);
    }
    CHECK(b.lights.size() == 1);
    CHECK(a.camera.tan_half == b.camera.tan_half);
}

TEST_CASE("negative indices count from the last of those so far, not of the file") {
    const Scene s = scene_with(
        Folder(), corners + "f -3 -2 -1\nv 2 0 0\nf -1 -2 -5\n" + corners + "f 1 -1 -8\n");
    REQUIRE(s.shapes.size() == 3);
    const vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0}, far{2, 0, 0};
    CHECK(corners_of(s.shapes[0]) == Corners{b, c, d});
    CHECK(corners_of(s.shapes[1]) == Corners{far, d, a});
    CHECK(corners_of(s.shapes[2]) == Corners{a, d, b});
}
