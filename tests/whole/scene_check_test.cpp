// whole/scene_check_test.cpp  covered lights, point lights on surfaces, coordinates too coarse
#include "world/scene_check.h"

#include <doctest/doctest.h>

#include "path/paths.h"
#include "world/scene_file.h"

namespace {

constexpr bool single = sizeof(real) == 4;

const std::string room =
    "size 4 4\ncamera 0 1 4  0 0.5 0  50\ndepth 3\ndiffuse grey 0.5 0.5 0.5\n"
    "light lamp 2 2 2\nquad -4 0 -4  0 0 8  8 0 0  grey\n";
const std::string over = "quad -1 2 -1  2 0 0  0 0 2  ";  // six lines before it

ParsedScene parsed(const std::string& text) { return parse_scene(text, "test"); }

bool warns(const ParsedScene& scene, const std::string& words) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& w) { return w.find(words) != w.npos; });
}

// Radiance of all pixels, some samples each.
std::vector<rgb> render(const Scene& scene, LightMode mode) {
    std::vector<rgb> all;
    for (int i = 0; i < 16; ++i)
        for (uint64_t k = 0; k < 32; ++k)
            all.push_back(radiance(scene, {Direction::bsdf, mode}, {SamplerKind::independent, 3},
                                   i % 4, i / 4, k));
    return all;
}

std::string complaint(const std::string& text) {
    try {
        parsed(text);
        return "";
    } catch (const UserError& e) {
        return e.what();
    }
}

}  // namespace

TEST_CASE("a light that an earlier shape covers is dark, however light is found") {
    const ParsedScene covered = parsed(room + over + "grey\n" + over + "lamp\n");
    CHECK(warns(covered, "line 8: this light is dark: line 7 covers it"));
    CHECK(covered.scene.lights.empty());
    for (LightMode mode : {LightMode::none, LightMode::nee, LightMode::mis})
        for (rgb L : render(covered.scene, mode)) CHECK(L == rgb{});
    // From its other corner, with its corners the other way round, and a sphere.
    CHECK(parsed(room + over + "grey\nquad -1 2 -1  0 0 2  2 0 0  lamp\n").scene.lights.empty());
    CHECK(parsed(room + "sphere 0 1 0 .3 grey\nsphere 0 1 0 .3 lamp\n").scene.lights.empty());
    // What covers it comes later, or is not quite there.
    CHECK(parsed(room + over + "lamp\n" + over + "grey\n").scene.lights.size() == 1);
    CHECK(parsed(room + over + "grey\nquad -1 2.1 -1  2 0 0  0 0 2  lamp\n").warnings.empty());
}

TEST_CASE("a light that stands twice is one light") {
    const Scene once = parsed(room + over + "lamp\n").scene;
    const ParsedScene twice = parsed(room + "pointlight 9 9 9  1 1 1\nsphere 3 3 3 .1 lamp\n" +
                                     over + "lamp\n" + over + "lamp\nsphere 2 3 3 .1 lamp\n");
    CHECK(warns(twice, "line 10: this light is dark: line 9 covers it"));
    REQUIRE(twice.scene.lights.size() == 4);
    CHECK(twice.scene.line_of_light == std::vector<uint32_t>{7, 8, 9, 11});
    // The light of every shape is the one whose geometry it has.
    for (size_t i = 0; i < twice.scene.shapes.size(); ++i)
        if (const int32_t k = twice.scene.light_of[i]; k != no_light)
            CHECK(twice.scene.line_of_light[size_t(k)] == twice.scene.line_of[i]);
    const Scene both = parsed(room + over + "lamp\n" + over + "lamp\n").scene;
    for (LightMode mode : {LightMode::none, LightMode::nee, LightMode::mis})
        CHECK(render(both, mode) == render(once, mode));
}

TEST_CASE("a point light on a surface is refused, off it accepted") {
    auto at = [](const char* place) {
        return complaint(room + "triangle 0 1 0  1 1 0  0 2 1  grey\nsphere 2 2 2 .5 grey\n" +
                         "pointlight " + place + "  1 1 1\n");
    };
    CHECK(at("0.5 0 0.5") == "test:9: this point light lies on the surface of line 6: move it off");
    CHECK(at("0 0 0").starts_with("test:9: this point light lies on"));  // on the diagonal
    CHECK(
        at("0.25 1.25 0.25").starts_with("test:9: this point light lies on the surface of line 7"));
    CHECK(at("2 2.5 2").starts_with("test:9: this point light lies on the surface of line 8"));
    CHECK(at("0.5 1e-4 0.5") == "");
    CHECK(at("0.5 -1e-4 0.5") == "");
    CHECK(at("5 0 0") == "");  // in the plane, beside the quad
    CHECK(at("1 2 1") == "");  // in the plane of the triangle, beyond its long side
    CHECK(at("2 2.501 2") == "");
    CHECK(at("2 2 2") == "");
}

TEST_CASE("coordinates that rounding makes coarse are told, with the shape") {
    auto box_at = [](double x) {
        char text[400];
        std::snprintf(
            text, sizeof text,
            "camera %.17g 0 1.8  %.17g 0 0  60\ndiffuse half .5 .5 .5\nlight glow .4 .4 .4 "
            "twosided half\nbox 4 3 4  0  %.17g -1.5 -2  glow\n",
            x, x, x - 2);
        return parsed(text);
    };
    CHECK(warns(box_at(1e6), "are coarse here") == single);
    CHECK(!warns(box_at(1e3), "are coarse here"));
    if (!single) CHECK(warns(box_at(1e14), "line 4: numbers of 8 bytes are coarse here"));
    for (const char* name : {"atelier", "cornell", "cornell36", "cornellglossy", "coursework",
                             "cube", "furnace", "lanterns", "materials", "panel", "penumbra"})
        CHECK(!warns(read_scene("scenes/" + std::string(name) + ".scene"), "are coarse"));
    CHECK(warns(read_scene("scenes/extremes.scene"), "are coarse here") == single);
    // The ground's rounding, some ball's size where it stands; not far above it.
    auto ball_at = [](const char* y) {
        const std::string r = single ? "1e6" : "1e15";
        return parsed("camera 0 2 9  0 1 0  40\ndiffuse m .5 .5 .5\nlight l 1 1 1\nsphere 0 -" + r +
                      " 0  " + r + "  m\nsphere 0 " + y + " 0  1  l\n");
    };
    CHECK(warns(ball_at("1"), "off the surface of line 4"));
    CHECK(!warns(ball_at("1000"), "are coarse"));
}

// Maps of its light have one side and no sky.  In float a ray that starts 10 micrometres from an
// edge may start behind it.
TEST_CASE("the house of atelier is closed, and only the fronts of its faces are seen") {
    const ParsedScene atelier = read_scene("scenes/atelier.scene");
    CHECK(atelier.warnings.empty());
    CHECK(atelier.scene.lights.size() == 5);
    const Scene& scene = atelier.scene;
    int escapes = 0, backs = 0;
    for (int y = 0; y < scene.size.height; ++y)
        for (int x = 0; x < scene.size.width; ++x)
            radiance(scene, {Direction::bsdf, LightMode::none}, {SamplerKind::independent, 5}, x, y,
                     0, [&](const Segment&, const Step& e) {
                         if (!e.met)
                             ++escapes;
                         else if (e.x.cos_o < 0)
                             ++backs;
                     });
    if (!single) {
        CHECK(escapes == 0);
        CHECK(backs == 0);
    }
}
