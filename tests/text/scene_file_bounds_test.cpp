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
const std::string placed = "mesh m.obj 1 0 0 0\n", grey_mesh = "mesh m.obj 1 0 0 0 d\n";

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
