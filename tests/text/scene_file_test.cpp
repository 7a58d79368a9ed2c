// text/scene_file_test.cpp  statements of scene files: their effects, and the lines of errors
#include "text/scene_file.h"

#include <doctest/doctest.h>

#include "text/complaint.h"

namespace {

const std::string camera = "camera 0 0 5  0 0 0  40\n";

NamedScene scene_of(const std::string& text) { return parse_scene(camera + text, "a.scene").scene; }

}  // namespace

TEST_CASE("materials are what their statements say") {
    const NamedScene s = scene_of(R"(
diffuse d  .1 .2 .3       # comment
phong   p  .1 .2 .3  .4 .5 .6  7
mirror  m  .7 .8 .9
glass   g  1.5
light   l  2 3 4
light   t  5 6 7  twosided p
light   o  8 9 1  t       # reflects like t, and has one side
sphere 0 0 0  1  d
)");
    const rgb low{.1, .2, .3}, high{.4, .5, .6}, none{};
    const Material expected[] = {{Rough(low)},
                                 {Rough(low, high, 7)},
                                 {Mirror({.7, .8, .9})},
                                 {Glass(1.5)},
                                 {Rough(none), {2, 3, 4}},
                                 {Rough(low, high, 7), {5, 6, 7}, true},
                                 {Rough(low, high, 7), {8, 9, 1}}};
    REQUIRE(s.materials.size() == std::size(expected));
    for (size_t i = 0; i < std::size(expected); ++i) {
        const Material &m = s.materials[i], &e = expected[i];
        CAPTURE(i);
        REQUIRE(m.scattering.index() == e.scattering.index());
        if (const Rough* rough = m.as<Rough>()) {
            CHECK(rough->kd == e.as<Rough>()->kd);
            CHECK(rough->ks == e.as<Rough>()->ks);
            CHECK(rough->exponent == e.as<Rough>()->exponent);
        }
        CHECK(m.albedo() == e.albedo());
        if (const Glass* glass = m.as<Glass>()) CHECK(glass->ior == e.as<Glass>()->ior);
        CHECK(m.Le == e.Le);
        CHECK(m.twosided == e.twosided);
    }
}

TEST_CASE("shapes, lights and the rest are what their statements say") {
    const NamedScene s = scene_of(R"(
size 30 20
depth 3
exposure 2
diffuse d .1 .2 .3
pointlight 7 8 9  4 5 6
sphere 1 2 3  4  d
triangle 1 0 0  0 1 0  0 0 1  d
quad 1 2 3  1 0 0  0 1 0  d
box 1 2 3  0  4 5 6  d
)");
    CHECK((s.size.width == 30 && s.size.height == 20));
    CHECK(s.depth == 3);
    CHECK(s.exposure == 2);
    REQUIRE(s.lights.size() == 1);
    CHECK((s.lights[0].p == vec3{7, 8, 9} && s.lights[0].L == rgb{4, 5, 6}));
    REQUIRE(s.shapes.size() == 1 + 1 + 2 + 12);
    CHECK((s.shapes[0].a == vec3{1, 2, 3} && s.shapes[0].r == 4));
    CHECK(s.shapes[1].c == vec3{0, 0, 1});
    CHECK((s.shapes[2].a == vec3{1, 2, 3} && s.shapes[2].c == vec3{2, 3, 3}));
    Box box;
    for (size_t i = 4; i < 16; ++i) box.add(bounds(s.shapes[i]));
    CHECK(max_abs(box.lo - vec3{4, 5, 6}) < 32 * 9 * ulp);
    CHECK(max_abs(box.hi - vec3{5, 7, 9}) < 32 * 9 * ulp);
}

TEST_CASE("a box faces outwards and turns about y: x' = c x + s z, z' = c z - s x") {
    for (real degrees : {real(0), real(30), real(90), real(-135), real(480)}) {
        Scene s;
        s.materials.resize(1);
        const vec3 size{1, 2, 3}, move{10, 20, 30};
        add_box(s, size, degrees, move, 0);
        CHECK(s.dropped == 0);
        REQUIRE(s.shapes.size() == 12);
        const real c = std::cos(degrees * pi / 180), sine = std::sin(degrees * pi / 180);
        auto turned = [&](vec3 v) { return vec3{c * v.x + sine * v.z, v.y, c * v.z - sine * v.x}; };
        const vec3 centre = turned(size / 2) + move;
        real volume = 0;
        for (const Shape& t : s.shapes) {
            CHECK(dot(area_vector(t), t.a - centre) > 0);
            volume += dot(area_vector(t), t.a - centre) / 6;
        }
        CHECK(double(volume) == doctest::Approx(6).epsilon(1e-5));
        const vec3 far = turned(size) + move;
        const bool found = std::any_of(s.shapes.begin(), s.shapes.end(), [&](const Shape& t) {
            for (vec3 p : {t.a, t.b, t.c})
                if (length(p - far) < 128 * ulp * length(far)) return true;
            return false;
        });
        CHECK(found);
    }
}

TEST_CASE("a scene may ask for all samples that a pixel can have") {
    const std::string ball = "diffuse d 1 1 1\nsphere 0 0 0 1 d\n";
    CHECK(scene_of("samples 1099511627776\n" + ball).samples == max_samples);
}

TEST_CASE("what cannot be is refused, at its line") {
    const std::pair<const char*, const char*> rows[] = {
        {"phong p  .6 .6 .6  .5 .1 .1  7\n", "a.scene:2: reflects more than it receives"},
        {"diffuse d  .1 -.2 .3\n", "a.scene:2: a colour must not be negative: '-.2'"},
        {"\n\nsize 3 4\nsize 3 4\n", "a.scene:5: a second size"},
        {"sphere 0 0 0  1  x\n", "a.scene:2: unknown material 'x'"},
        {"sphere 0 0 0  1\n", "a.scene:2: too few words (4)"},
        {"shpere 0 0 0  1\n", "a.scene:2: unknown keyword 'shpere' (did you mean 'sphere'?)"},
        {"# nothing\n", "a.scene: empty scene"}};
    for (const auto& [text, why] : rows) {
        const std::string found = complaint([&, text = text] { scene_of(text); });
        INFO(found);
        CHECK(found.starts_with(why));
    }
}

TEST_CASE("the defaults of the grammar are those of a scene that says nothing") {
    const NamedScene silent = scene_of("diffuse d 1 1 1\nsphere 0 0 0 1 d\n");
    for (const Statement& s : grammar) {
        if (s.default_text.empty()) continue;
        const std::string line = std::string(s.keyword) + " " + std::string(s.default_text) + "\n";
        const NamedScene scene = scene_of(line + "diffuse d 1 1 1\nsphere 0 0 0 1 d\n");
        CHECK((scene.size.width == silent.size.width && scene.size.height == silent.size.height));
        CHECK(scene.depth == silent.depth);
        CHECK(scene.samples == silent.samples);
        CHECK(scene.exposure == silent.exposure);
    }
}

TEST_CASE("a scene knows the names of its materials and the lines of its shapes and lights") {
    const NamedScene s = scene_of(R"(diffuse d 1 1 1
light l 1 1 1
box 1 1 1  0  0 0 0  d

pointlight 0 9 0  1 1 1
sphere 0 0 0  1  l
)");
    CHECK(s.names == std::vector<std::string>{"d", "l"});
    std::vector<uint32_t> lines(12, 4);
    lines.push_back(7);
    CHECK(s.line_of == lines);
    CHECK(s.line_of_light == std::vector<uint32_t>{6, 7});
}
