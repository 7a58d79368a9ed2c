// mesh/obj_test.cpp  meshes: accepted and refused statements, line numbers of errors, images equal
// to those of scenes written by hand
#include "mesh/obj.h"

#include "text/complaint.h"
#include "text/folder.h"
#include "text/scene_file.h"

namespace {

ParsedScene parsed_with(const Folder& folder, const std::string& obj,
                        const std::string& placement = "1 0 0 0 grey") {
    folder.write("m.obj", obj);
    return parse_scene("camera 0 0 5  0 0 0  40\ndiffuse grey 0.5 0.5 0.5\nmesh m.obj " +
                           placement + "\nlight sky 1 1 1\nsphere 0 0 0 1e3 sky\n",
                       folder / "s.scene");
}
// Without the sky.
NamedScene scene_with(const Folder& folder, const std::string& obj,
                      const std::string& placement = "1 0 0 0 grey") {
    NamedScene s = parsed_with(folder, obj, placement).scene;
    s.shapes.pop_back(), s.material_of.pop_back(), s.light_of.pop_back(), s.lights.pop_back();
    s.materials.pop_back(), s.names.pop_back();
    return s;
}

// The warnings about a mesh, without the folder.
std::vector<std::string> warnings(const Folder& folder, const std::string& obj,
                                  const std::string& placement = "1 0 0 0 grey") {
    std::vector<std::string> all = parsed_with(folder, obj, placement).warnings;
    for (std::string& w : all)
        if (w.starts_with(folder / "")) w = w.substr((folder / "").size());
    return all;
}
using Told = std::vector<std::string>;

// The material of each triangle.
std::vector<std::string> names(const NamedScene& s) {
    std::vector<std::string> all;
    for (uint32_t m : s.material_of) all.push_back(s.names[m]);
    return all;
}
using Names = std::vector<std::string>;

using Corners = std::vector<vec3>;

double area(const Scene& s) {
    double sum = 0;
    for (const Shape& t : s.shapes) sum += double(length(area_vector(t))) / 2;
    return sum;
}

// Returns the error of reading `obj`, without the folder; "" if there is none.
std::string complaint(const Folder& folder, const std::string& obj,
                      const std::string& placement = "1 0 0 0 grey") {
    const std::string why = ::complaint([&] { scene_with(folder, obj, placement); }),
                      place = folder / "";
    return why.empty() ? "" : why.substr(std::min(why.size(), why.find(place, 1) + place.size()));
}

// Returns the statement of a vertex.
std::string at(double x, double y) {
    return "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
}

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Corners corners_of(const Shape& s) { return {s.a, s.b, s.c}; }

}  // namespace

TEST_CASE("an OBJ file that cannot be used is refused at its line") {
    const Folder folder;
    const struct {
        std::string text, message;
    } table[] = {
        {"v 1 2\n", "m.obj:1: v needs three numbers"},
        {"v 1 2 x\n", "m.obj:1: 'x' is not a number"},
        {"v 1 2 3 v 4 5 6\n", "m.obj:1: 'v' is not a number"},
        {corners + "f 1 2 5\n", "m.obj:5: no vertex '5' among 4"},
        {corners + "f 0 1 2\n", "m.obj:5: no vertex '0' among 4"},
        {corners + "f -5 1 2\n", "m.obj:5: no vertex '-5' among 4"},
        {corners + "f 1.5 2 3\n", "m.obj:5: no vertex '1.5' among 4"},
        {corners + "f 1e30 2 3\n", "m.obj:5: no vertex '1e30' among 4"},
        {corners + "f a b c\n", "m.obj:5: 'a' is not a number"},
        {"vertex 1 2 3\n", "m.obj:1: not a line of an OBJ file"},
        {"root:x:0:0::/root:/bin/sh\n", "m.obj:1: not a line of an OBJ file"},
        {corners, "m.obj: no face in it"},
        {corners + "surf 0 1 0 1 1 2 3 4\n", "m.obj: no face in it"},
        {"", "m.obj: no face in it"},
    };
    for (const auto& row : table) {
        const std::string found = complaint(folder, row.text);
        INFO("found ", found, ", expected ", row.message);
        CHECK(found.find(row.message) != found.npos);
    }
}

TEST_CASE("what others write and Penumbra has not is told once, with its count and first line") {
    const Folder folder;
    folder.write("good.mtl",
                 "Kd 1 1 1\nnewmtl red\nKd 1 0 0\nKa 0 0 0\nmap_Kd no.png\nbump -bm 1 a.png\n"
                 "newmtl blue\nKa 1 1 1\nKd spectral a.rfl\n2/3 x\nnewmtl red\nKd 0 1 0\n");
    const std::string red = "mtllib good.mtl\nusemtl red\n";
    CHECK(warnings(folder, red + corners + "f 1 2 3\n") ==
          Told{"good.mtl: 1 material is defined twice, first 'red' at line 11: the first counts",
               "good.mtl: 5 statements are not used, first 'Kd' at line 1",
               "good.mtl: 2 textures are not used, first 'map_Kd' at line 5"});
    CHECK(scene_with(folder, red + corners + "f 1 2 3\n").materials.back().diffuse() ==
          rgb{1, 0, 0});
    folder.write("private.mtl", "root:x:0\n");  // what is no library is not shown
    CHECK(warnings(folder, "mtllib private.mtl\n" + corners + "f 1 2 3\n") ==
          Told{"private.mtl: 1 statement is not used, first at line 1"});
    CHECK(warnings(folder, "mg 1 0.5\nmtllib no.mtl\nmtllib no.mtl nor_this.mtl\nlod 1\n" +
                               corners + "f 1 2 3\n") ==
          Told{"m.obj: 2 lines are skipped, first 'mg' at line 1",
               "m.obj: 2 material files are missing, first 'no.mtl' at line 2"});
    CHECK(
        warnings(
            folder,
            corners +
                "v 1 nan 0\nv 1 -1.#IND 0\nv 1 2 -inf\nv 3.4e38 0 0\nv 1e999 1 1\nf 1 2\nf 1 2 5\n"
                "f 1 2 6\nf 1 2 7\nf 1 2 8\nf 1 2 9\nf 1 2 3\nf 1 1 2\n") ==
        Told{"m.obj: 6 faces are left out, first at line 10: faces need three corners, near enough",
             "dropped 1 triangle without area"});
    // What is no number changes nothing.
    folder.write("bad.mtl", "newmtl a\nKd .1 .2 .3\nKd nan nan nan\nNs 1.#INF\nd x\nKd 1e39 0 0\n");
    const std::string bad = "mtllib bad.mtl\nusemtl a\n" + corners + "f 1 2 3\n";
    CHECK(scene_with(folder, bad).materials.back().diffuse() == rgb{real(.1), real(.2), real(.3)});
    CHECK(warnings(folder, bad) ==
          Told{"bad.mtl: 4 statements are not used, first 'Kd' at line 3"});
    // Materials that would be black or opaque in silence.
    folder.write("odd.mtl",
                 "newmtl a\nmap_Kd a.png\nnewmtl b\nKd .2\nd .1\nNi 1\nnewmtl c\nKe 1\n");
    const std::string odd =
        "mtllib odd.mtl\n" + corners + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n";
    CHECK(scene_with(folder, odd).materials[1].diffuse() == rgb{.5, .5, .5});
    const std::vector<std::string> all = warnings(folder, odd);
    REQUIRE(all.size() > 2);
    CHECK(all[0] == "m.obj: 1 material is opaque, first 'b' at line 8: d or Tr without Ni above 1");
    CHECK(all[1] == "m.obj: 1 material is without Kd, first 'a' at line 6: grey of albedo 0.5");
    CHECK(all[2] == "odd.mtl: 1 texture is not used, first 'map_Kd' at line 2");
    // A mesh that is placed twice is told once.
    folder.write("m.obj", "mg 1\n" + corners + "f 1 2 3\n");
    CHECK(parse_scene("camera 0 0 5 0 0 0 40\nmesh m.obj 1 0 0 0\nmesh m.obj 1 5 0 0\nlight l 1 1 "
                      "1\nsphere 0 9 0 1 l\n",
                      folder / "s.scene")
              .warnings.size() == 2);
}

TEST_CASE("a library that cannot be reached is missing") {
    const Folder folder;
    const std::string long_name(300, 'x'), face = corners + "f 1 2 3\n";
    CHECK(warnings(folder, "mtllib " + long_name + "\n" + face) ==
          Told{"m.obj: 1 material file is missing, first '" + long_name.substr(0, 40) +
               "...' at line 1"});
    for (const std::string name : {".", "/dev/zero", "m.obj/no.mtl"}) {
        INFO(name);
        CHECK(warnings(folder, "mtllib " + name + "\n" + face) ==
              Told{"m.obj: 1 material file is missing, first '" + name + "' at line 1"});
    }
    CHECK(warnings(folder, "mtllib\n" + face).empty());
}

TEST_CASE("faces whose material is missing have the mesh line's, or are grey") {
    const Folder folder;
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    const std::string faces = corners +
                              "f 1 2 3\nusemtl Default\nf 1 2 3\nf 2 3 4\nusemtl other\nf 2 3 4\n"
                              "usemtl\nf 1 2 4\nusemtl red\nf 1 3 4\nusemtl never used\n";
    CHECK(names(scene_with(folder, faces)) ==
          Names{"grey", "grey", "grey", "grey", "grey", "grey"});
    CHECK(warnings(folder, faces) ==
          Told{"m.obj: 3 materials are not defined, first 'Default' at line 6: 'grey' is used"});
    CHECK(scene_with(folder, faces).materials.size() == 1);
    // A library may follow.
    const NamedScene later = scene_with(folder, faces + "mtllib m.mtl\n", "1 0 0 0");
    CHECK(names(later).back() == "red");
    CHECK(later.materials[later.material_of[0]].diffuse() == rgb{0.5, 0.5, 0.5});
    CHECK(warnings(folder, faces + "mtllib m.mtl\n", "1 0 0 0") ==
          Told{"m.obj: 2 faces are without material, first at line 5: 'grey' is used",
               "m.obj: 2 materials are not defined, first 'Default' at line 6: 'grey' is used"});
}

TEST_CASE("names go to the end of the line, and '#' begins a comment only after a blank") {
    const Folder folder;
    folder.write("my stuff.mtl",
                 "newmtl Wood dark\nKd .1 .1 .1\nnewmtl Wood  # light\nKd .2 .2 .2\n"
                 "newmtl Mat#1\nKd .3 .3 .3 # a comment\n");
    const NamedScene s = scene_with(folder, "mtllib my stuff.mtl # all\n" + corners +
                                                "usemtl Wood dark \t\nf 1 2 3\n"
                                                "usemtl Wood\nf 1 2 3\nusemtl Mat#1\nf 1 2 3 #4\n");
    CHECK(names(s) == Names{"Wood dark", "Wood", "Mat#1"});
    folder.write("a.mtl", "newmtl a\nKd 1\n");
    folder.write("b.mtl", "newmtl b\nKd 1\n");
    std::filesystem::create_directory(folder / "sub");
    folder.write("sub/c.mtl", "newmtl c\nKd 1\n");
    const std::string two = "mtllib a.mtl  b.mtl\nmtllib sub\\c.mtl ./b.mtl \"a.mtl\"\n" + corners +
                            "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n";
    CHECK(names(scene_with(folder, two)) == Names{"a", "b", "c"});
    CHECK(warnings(folder, two).empty());
}

TEST_CASE(
    "lines end by \\n, \\r\\n or \\r, go on after a backslash, and begin after a byte order mark") {
    const Folder folder;
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const NamedScene s =
            scene_with(folder, "\xef\xbb\xbf# exported" + end + "v 0 0 0" + end + "v 1 0 0" + end +
                                   "v 1 1 0" + end + end + "f 1 2 \\" + end + " 3" + end);
        REQUIRE(s.shapes.size() == 1);
        CHECK(s.shapes[0].c == vec3{1, 1, 0});
        CHECK(s.line_in_mesh[0] == 6);
    }
    CHECK(scene_with(folder, corners + "f 1 2 \\\n3 \\\n4").shapes.size() == 2);
    CHECK(scene_with(folder, corners + "f 1 2 3 \\").shapes.size() == 1);
    CHECK(scene_with(folder, corners + "f 1 2 \\ \n3\n").shapes.size() == 1);
    for (const char* path : {"# C:\\models\\", "o C:\\models\\", "g a\\"})
        CHECK(scene_with(folder, corners + path + "\nf 1 2 3\nf 1 3 4\n").shapes.size() == 2);
    CHECK(complaint(folder, corners + "\rf 1 2 9\n").starts_with("m.obj:6: "));
}

TEST_CASE("MTL: diffuse, Phong, mirror and glass, none of an albedo above 1") {
    const Folder folder;
    auto is_rough = [](const Material& m, rgb kd, rgb ks, real exponent) {
        const Rough* r = m.as<Rough>();
        return r && r->kd == kd && r->ks == ks && r->exponent == exponent;
    };
    auto read = [&](const std::string& lines) {
        folder.write("m.mtl", "newmtl a\n" + lines);
        return scene_with(folder, "mtllib m.mtl\nusemtl a\n" + corners + "f 1 2 3\n")
            .materials.back();
    };
    auto told = [&] {
        return warnings(folder, "mtllib m.mtl\nusemtl a\n" + corners + "f 1 2 3\n");
    };
    Material m = read("Kd .5\n");
    CHECK(is_rough(m, {.5, .5, .5}, {}, 0));
    m = read("Kd .1 .2 .3\nKs .4 .5 .6\nNs 20\nillum 1\n");  // no highlight
    CHECK(is_rough(m, {real(.1), real(.2), real(.3)}, {}, 0));
    for (const char* illum : {"", "illum 2\n"}) {
        m = read("Kd .1 .2 .3\nKs .4 .5 .6\nNs 20\n" + std::string(illum));
        CHECK(is_rough(m, {real(.1), real(.2), real(.3)}, {real(.4), real(.5), real(.6)}, 20));
    }
    CHECK(told().empty());
    CHECK(read("Ks .1\nNs -3\n").as<Rough>()->exponent == 0);
    CHECK(read("Kd .1 -.001 .3\n").diffuse() == rgb{real(.1), 0, real(.3)});
    for (const char* illum : {"3", "5"}) {
        m = read("Ks .95 .9 .8\nNs 1000\nillum " + std::string(illum) + "\n");
        CHECK((m.as<Mirror>() && m.albedo() == rgb{real(.95), real(.9), real(.8)}));
        m = read("Kd .5\nillum " + std::string(illum) + "\n");  // a mirror that reflects nothing
        CHECK(is_rough(m, {.5, .5, .5}, {}, 0));
    }
    for (const char* glass : {"illum 4\n", "illum 6\n", "illum 7\n", "illum 9\n", "d .1\n",
                              "Tr .9\n", "d 0\nTr 1\n", "d .1\nillum 2\n"}) {
        m = read("Kd .5\nNi 1.3\n" + std::string(glass));
        INFO(glass);
        CHECK((m.as<Glass>() && m.as<Glass>()->ior == real(1.3)));
    }
    CHECK(read("illum 7\n").as<Glass>()->ior == 1.5);
    // d counts, not Tr, which some programs write for opacity; what only fades is opaque.
    for (const char* opaque :
         {"Ni 1.3\nd 1\nTr 1\n", "Ni 1.3\nTr 1\nd 1\n", "Ni 1.3\n", "d .5\n", "d .5\nNi 1\n"})
        CHECK(read("Kd .5\n" + std::string(opaque)).as<Rough>());
    m = read("Kd 2 1 .5\n");
    CHECK(max_of(m.diffuse()) <= 1);
    CHECK(double(m.diffuse().z) == doctest::Approx(.25));
    CHECK(told() ==
          Told{"m.obj: 1 material is too bright, first 'a' at line 2: scaled to an albedo of 1"});
    m = read("Kd .8\nKs .8 .4 .4\nNs 9\n");
    CHECK(max_of(m.albedo()) <= 1);
    CHECK(double(m.as<Rough>()->ks.y) == doctest::Approx(.25));
    CHECK(read("Ks 3\nillum 3\n").albedo().x <= 1);
    CHECK(read("Ke 3 4 5\nKd .5\n").Le == rgb{3, 4, 5});
    CHECK(told().empty());
}

TEST_CASE("faces: any number of corners, indices from the end, texture and normal indices") {
    const Folder folder;
    for (const char* face :
         {"f 1 2 3 4", "f -4 -3 -2 -1", "f 1/1 2/2 3/3 4/4", "f 1//1 2//1 3//1 4//1",
          "f 1/9/9 2/9/9 3/9/9 4/9/9", "f 1 2 3 4 # 5", "f 1 2 3 4 #5"}) {
        CAPTURE(face);
        const NamedScene s = scene_with(
            folder, "# comment\no thing\nvn 0 0 1\nvt 0 0\ng a\ns off\n" + corners + face + "\r\n");
        REQUIRE(s.shapes.size() == 2);
        CHECK(corners_of(s.shapes[0]) == Corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
        CHECK(corners_of(s.shapes[1]) == Corners{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    }
    CHECK(scene_with(folder, "f 1 2 3\n" + corners + "f 1 2 3\n").shapes.size() == 2);
    std::string ngon, face = "f";
    for (int i = 0; i < 100; ++i) {
        ngon += at(std::cos(i * 0.0628318530718), std::sin(i * 0.0628318530718));
        (face += " ") += std::to_string(i + 1);
    }
    const NamedScene scene = scene_with(folder, ngon + face + "\n");
    CHECK(scene.shapes.size() == 98);
    double area = 0;
    for (const Shape& s : scene.shapes) area += double(area_vector(s).z) / 2;
    CHECK(area == doctest::Approx(50 * std::sin(0.0628318530718)).epsilon(1e-5));
}

TEST_CASE("concave faces are cut up, folded ones are told") {
    const Folder folder;
    const std::string arrow = "v 0 2 0\nv -1 -1 0\nv 0 0 0\nv 1 -1 0\n";
    for (const char* face : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3"}) {
        const NamedScene scene = scene_with(folder, arrow + face + "\n");
        REQUIRE(scene.shapes.size() == 2);
        for (const Shape& s : scene.shapes) CHECK(double(area_vector(s).z) == doctest::Approx(2));
    }
    std::string star;
    for (int i = 0; i < 10; ++i) {
        const double r = i % 2 ? 0.2 : 1, angle = i * 0.628318530718;
        star += at(r * std::cos(angle), r * std::sin(angle));
    }
    const NamedScene scene = scene_with(folder, star + "f 1 2 3 4 5 6 7 8 9 10\n");
    CHECK(scene.shapes.size() == 8);
    CHECK(area(scene) == doctest::Approx(10 * .2 * std::sin(.628318530718) / 2).epsilon(1e-5));
    // A saddle whose diagonals both fold it, and a bow tie.
    const std::string folded =
        corners +
        "v 2 0 0\nv 3 0 .2\nv 2.1 1 0\nv 2.9 1 -.2\nf 1 2 3 4\nf 5 6 7 8\nf 1 2 4 3\nf 1 1 2 2\n";
    CHECK(scene_with(folder, folded).shapes.size() == 6);
    CHECK(warnings(folder, folded) ==
          Told{"m.obj: 2 faces are folded, first at line 10: triangles may overlap",
               "dropped 2 triangles without area"});
}

TEST_CASE("a mesh is scaled, then moved; a material of its own goes before the scene's") {
    const Folder folder;
    folder.write("m.mtl", "newmtl lamp\nKd 0.1 0.2 0.3\nKe 4 5 6\n");
    const NamedScene scene =
        scene_with(folder, "mtllib m.mtl\n" + corners + "f 1 2 3\nusemtl lamp\nf 1 2 3 4\n",
                   "2 10 20 30 grey");
    REQUIRE(scene.shapes.size() == 3);
    REQUIRE(scene.material_of.size() == 3);
    CHECK(scene.shapes[0].c == vec3{12, 22, 30});
    CHECK(scene.materials[scene.material_of[0]].diffuse() == rgb{0.5, 0.5, 0.5});
    CHECK(scene.materials[scene.material_of[1]].diffuse() == rgb{real(0.1), real(0.2), real(0.3)});
    REQUIRE(scene.lights.size() == 1);  // the square is one light
    CHECK(scene.lights[0].as<QuadLight>());
    CHECK(scene.lights[0].L == rgb{4, 5, 6});
    CHECK(scene.light_of == std::vector<int32_t>{no_light, 0, 0});
    // Turned as boxes are, after z has been made y.
    CHECK(scene_with(folder, corners + "f 1 2 3\n", "2 0 0 5 turn 90").shapes[0].b ==
          vec3{0, 0, 3});
    CHECK(scene_with(folder, "v 1 2 3\nv 0 0 0\nv 1 0 0\nf 1 2 3\n", "1 0 0 0 z_up grey")
              .shapes[0]
              .a == vec3{1, 3, -2});
    CHECK(scene_with(folder, "v 1 2 3\nv 0 0 0\nv 1 0 0\nf 1 2 3\n", "1 0 0 0 turn -90 z_up")
              .shapes[0]
              .a == vec3{2, 3, 1});
    for (const auto& [words, why] : {std::pair{"turn", "turn needs degrees"},
                                     {"turn grey", "'grey' is not a number"},
                                     {"grey turn 9", "unknown word 'turn'"},
                                     {"z_down", "unknown material 'z_down'"}})
        CHECK(complaint(folder, corners + "f 1 2 3\n", "1 0 0 0 " + std::string(words)).find(why) !=
              std::string::npos);
    CHECK_THROWS_WITH_AS(scene_with(folder, corners, "0 0 0 0 grey"),
                         doctest::Contains("s.scene:3: scale must be positive"), UserError);
}

TEST_CASE("the name of a mesh's file may have blanks, in quotes") {
    const Folder folder;
    folder.write("a # mesh.obj", corners + "f 1 2 3\n");
    const ParsedScene scene = parse_scene(
        "camera 0 2 3  0 0 0  40\ndiffuse d .5 .5 .5\n"
        "mesh \"a # mesh.obj\" 1 0 0 0 d  # in quotes\n",
        folder / "s.scene");
    CHECK(scene.files.size() == 1);
    CHECK(scene.scene.shapes.size() == 1);
}

TEST_CASE("cornell36 by statements and as OBJ are the same shapes, materials and lights") {
    const NamedScene a = read_scene("scenes/cornell36.scene").scene;
    const NamedScene b = read_scene("scenes/cornell36obj.scene").scene;
    REQUIRE(a.shapes.size() == 36);
    REQUIRE(b.shapes.size() == 36);
    for (size_t i = 0; i < a.shapes.size(); ++i) {
        CHECK((a.shapes[i].a == b.shapes[i].a && a.shapes[i].b == b.shapes[i].b &&
               a.shapes[i].c == b.shapes[i].c));
        CHECK(a.materials[a.material_of[i]].diffuse() == b.materials[b.material_of[i]].diffuse());
        CHECK(a.light_of[i] == b.light_of[i]);
    }
    CHECK(b.lights.size() == 1);
    CHECK(a.camera.tan_half == b.camera.tan_half);
}

TEST_CASE("negative indices count from the last of those so far, not of the file") {
    const NamedScene s = scene_with(
        Folder(), corners + "f -3 -2 -1\nv 2 0 0\nf -1 -2 -5\n" + corners + "f 1 -1 -8\n");
    REQUIRE(s.shapes.size() == 3);
    const vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0}, far{2, 0, 0};
    CHECK(corners_of(s.shapes[0]) == Corners{b, c, d});
    CHECK(corners_of(s.shapes[1]) == Corners{far, d, a});
    CHECK(corners_of(s.shapes[2]) == Corners{a, d, b});
}
