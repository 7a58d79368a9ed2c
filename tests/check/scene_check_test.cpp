// check/scene_check_test.cpp  lights in other surfaces, point lights on them, coarse coordinates
#include "check/scene_check.h"

#include <doctest/doctest.h>

#include "base/approx.h"
#include "base/cases.h"
#include "path/paths.h"
#include "text/complaint.h"
#include "text/folder.h"
#include "text/scene_file.h"

namespace {

const std::string room =
    "size 4 4\ncamera 0 1 4  0 0.5 0  50\ndepth 3\ndiffuse grey 0.5 0.5 0.5\n"
    "light lamp 2 2 2\nquad -4 0 -4  0 0 8  8 0 0  grey\n";
const std::string over = "quad -1 2 -1  2 0 0  0 0 2  ";  // six lines precede it

std::string replaced(const std::string& from, const std::string& to, std::string text = room) {
    return text.replace(text.find(from), from.size(), to);
}

ParsedScene parsed(const std::string& text) { return parse_scene(text, "test"); }

bool warns(const ParsedScene& scene, const std::string& words) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& w) { return w.find(words) != w.npos; });
}

// The radiance of all pixels, with some samples each.
std::vector<rgb> render(const Scene& scene, LightMode mode) {
    std::vector<rgb> all;
    for (int i = 0; i < 16; ++i)
        for (uint64_t k = 0; k < 32; ++k)
            all.push_back(radiance(scene, {Direction::bsdf, mode, 0}, {SamplerKind::independent, 3},
                                   i % 4, i / 4, k));
    return all;
}

double light_of(const Scene& scene, LightMode mode = LightMode::none) {
    double sum = 0;
    for (rgb L : render(scene, mode)) sum += double(L.x);
    return sum;
}

const double rounding = single ? 0.01 : 1e-9;

// The total light of the pixels of two scenes, for each mode: the same paths up to rounding.  With
// two lights to choose from, light samples differ: the tolerance is six standard errors.
void expect_same_light(const Scene& a, const Scene& b) {
    for (LightMode mode : {LightMode::none, LightMode::nee, LightMode::mis}) {
        CAPTURE(int(mode));
        const double light = light_of(a, mode);
        CHECK(light > 0);
        const bool others = mode != LightMode::none && a.lights.size() != b.lights.size();
        CHECK(light_of(b, mode) == doctest::Approx(light).epsilon(others ? 0.06 : rounding));
    }
}

// A floor with ray origins `offset` off it, and other shapes; returns the warnings.
constexpr double offset = 32 * double(ulp) * 1000;
std::string told(const std::string& eye, const std::string& others) {
    std::string all;
    for (const std::string& w : parsed("camera " + eye + "\ndiffuse d .5 .5 .5\nlight l 1 1 1\n" +
                                       "quad -1000 0 -1000  0 0 2000  2000 0 0  d\n" + others)
                                    .warnings)
        all += (all.empty() ? "" : "\n") + w;
    return all;
}
std::string off(const std::string& text, double offsets) {
    return with(text, said(offsets * offset));
}
const std::string from_above = "0 9 20  0 0 0  50", panel = "quad -9 9 -9  18 0 0  0 0 18  l\n";

}  // namespace

TEST_CASE("a lamp in a ceiling shines as if it were in front of it, however light is found") {
    const std::string text = replaced("depth 3", "depth 1");
    const Scene alone = parsed(text + over + "lamp\n").scene;
    // The covers have the same corners in other orders, one half, another diagonal, other sizes.
    for (const char* cover :
         {"quad -3 2 -3  6 0 0  0 0 6  grey\n", "quad -1 2 -1  2 0 0  0 0 2  grey\n",
          "quad -1 2 -1  0 0 2  2 0 0  grey\n", "quad 1 2 1  -2 0 0  0 0 -2  grey\n",
          "triangle -1 2 -1  1 2 -1  1 2 1  grey\n", "triangle 1 2 -1  1 2 1  -1 2 1  grey\n",
          "triangle -3 2 -3  3 2 -3  0 2 3  grey\n", "quad -1 2 -1  .5 0 0  0 0 .5  grey\n",
          "quad -1 2 -1  2 0 0  0 0 2  lamp\n", "quad -1 2 -1  0 0 2  2 0 0  lamp\n"})
        for (const bool before : {false, true}) {
            const std::string lamp = over + "lamp\n";
            INFO(std::string(before ? "before it: " : "after it: "), cover);
            const ParsedScene both = parsed(text + (before ? cover + lamp : lamp + cover));
            const bool is_lamp = both.scene.light_of.back() >= 0 && both.scene.lights.size() == 2;
            CHECK(both.warnings.size() == 1);
            CHECK(warns(both, before || is_lamp
                                  ? "line 8: this light lies in the surface of line 7"
                                  : "line 7: this light lies in the surface of line 8"));
            expect_same_light(alone, both.scene);
        }
    // Shapes that touch its edge, cross it, or miss it narrowly.
    for (const char* beside :
         {"quad 1 2 -1  2 0 0  0 0 2  grey\n", "quad -1 1 0  2 0 0  0 3 0  grey\n",
          "quad -1 2.001 -1  2 0 0  0 0 2  grey\n", "quad -1 2 -1  0 .5 0  0 0 2  grey\n"})
        CHECK(parsed(text + over + "lamp\n" + beside).warnings.empty());
    // Far from the eye, which is at 0: the wall determines the rounding errors.
    const std::string eye = "size 4 4\ncamera 0 0 0  0 0 -1  50\ndiffuse grey .5 .5 .5\n",
                      wall = "quad -9e3 -9e3 -1e4  18e3 0 0  0 18e3 0  ";
    for (const std::string& both :
         {wall + "grey\n" + wall + "lamp\n", wall + "lamp\n" + wall + "grey\n"})
        for (rgb L : render(parsed(eye + "light lamp 2 2 2\n" + both).scene, LightMode::none))
            CHECK(L == rgb{2, 2, 2});
}

TEST_CASE("of two lamps in one place the first shines, and the other where it is alone") {
    const std::string text = replaced("depth 3", "depth 1");
    const std::string longer = "quad -1 2 -1  4 0 0  0 0 2  lamp\n";
    auto light = [&](const std::string& shapes) { return light_of(parsed(text + shapes).scene); };
    for (const std::string& two : {over + "lamp\n" + longer, longer + over + "lamp\n"})
        CHECK(light(two) == doctest::Approx(light(longer)).epsilon(rounding));
    // Another radiance: the second lamp has no effect where they overlap.
    const std::string bright = "light bright 9 9 9\n" + over + "lamp\n";
    expect_same_light(parsed(text + bright).scene, parsed(text + bright + over + "bright\n").scene);
    CHECK(light(bright + "quad -1 2 -1  4 0 0  0 0 2  bright\n") ==
          doctest::Approx(light(bright + "quad 1 2 -1  2 0 0  0 0 2  bright\n")).epsilon(rounding));
}

TEST_CASE("a lamp of two sides in a wall shines on both; two of one side, back to back, as it") {
    const std::string wall = "quad -3 0 -1  6 0 0  0 3 0  grey\n";
    const std::string both = "light both 2 2 2 twosided\nquad -1 .5 -1  2 0 0  0 1 0  both\n";
    const std::string pair =
        "quad -1 .5 -1  2 0 0  0 1 0  lamp\nquad -1 .5 -1  0 1 0  2 0 0  lamp\n";
    for (const char* eye : {"0 1 4", "0 1 -4"}) {
        const std::string text = replaced("0 1 4", eye, replaced("depth 3", "depth 0"));
        auto lit = [&](const std::string& scene) {
            int n = 0;
            for (rgb L : render(parsed(text + scene).scene, LightMode::none))
                n += L == rgb{2, 2, 2};
            return n;
        };
        const int alone = lit(both);
        CHECK(alone > 10);
        for (const std::string& others : {wall + both, both + wall, pair, wall + pair})
            CHECK(std::abs(lit(others) - alone) <= (single ? 2 : 0));
    }
    // Light samples lie where the copies of the lamp do.
    const Scene two = parsed(room + wall + both).scene;
    for (size_t i = 0; i < two.shapes.size(); ++i)
        if (two.light_of[i] != no_light)
            for (vec3 at : {two.lights[size_t(two.light_of[i])].p,
                            two.lights[size_t(two.light_of[i])].centre})
                CHECK(two.shapes[i].a.z == at.z);
}

TEST_CASE("a lamp in a ball of its size shines, and the first of two") {
    const std::string text = replaced("depth 3", "depth 1");
    const Scene alone = parsed(text + "sphere 0 1 0 .3 lamp\n").scene;
    expect_same_light(alone, parsed(text + "sphere 0 1 0 .3 grey\nsphere 0 1 0 .3 lamp\n").scene);
    expect_same_light(alone, parsed(text + "sphere 0 1 0 .3 lamp\nsphere 0 1 0 .3 grey\n").scene);
    const Scene two =
        parsed(text + "light k 9 9 9\nsphere 0 1 0 .3 lamp\nsphere 0 1 0 .3 k\n").scene;
    for (rgb L : render(two, LightMode::none)) CHECK(L.x <= 2);
    CHECK(parsed(text + "sphere 0 1 0 .3 grey\nsphere 0 1 0 .3001 lamp\n").warnings.empty());
}

// ---- Glass that touches -------------------------------------------------------------------------

namespace {

const std::string ice_room = replaced("depth 3", "depth 40") + "glass ice 1.5\n" + over + "lamp\n";
const double gap = single ? 4e-3 : 1e-7;

// The light of two scenes that differ by a gap: nearly the same paths.
void expect_as_with_a_gap(const ParsedScene& touching, const ParsedScene& apart) {
    CHECK(touching.warnings.size() == 1);
    CHECK(apart.warnings.empty());
    const double light = light_of(apart.scene);
    CHECK(light > 0);
    CHECK(light_of(touching.scene) == doctest::Approx(light).epsilon(single ? 0.05 : 1e-5));
}

// Every path of a scene in a furnace of radiance 1 brings 1, if it ends before its depth.
void expect_furnace(const std::string& bodies) {
    const Scene scene = parsed(
                            "size 8 8\ncamera .3 .7 9  .3 .7 0  40\ndepth 300\nglass a 1.3\n"
                            "glass b 1.5\nglass c 2.4\nlight sky 1 1 1 twosided\n"
                            "sphere 0 0 0 10 sky\n" +
                            bodies)
                            .scene;
    int ended = 0, wrong = 0;
    for (int i = 0; i < 64; ++i)
        for (uint64_t k = 0; k < 8; ++k) {
            const rgb L = radiance(scene, {Direction::bsdf, LightMode::none, 0},
                                   {SamplerKind::independent, 3}, i % 8, i / 8, k);
            ended += L.x != 0;
            wrong += L.x != 0 && std::abs(double(L.x) - 1) > (single ? 1e-4 : 1e-9);
        }
    INFO(bodies);
    CHECK(ended > 200);
    CHECK(wrong <= (single ? ended / 50 : 0));  // in float a hair is as wide as that
}

}  // namespace

TEST_CASE("glass on anything is as if a hair of air were between") {
    auto block = [](double height) {
        return "box 1.4 .7 1.4 20 -.7 " + said(height) + " -.7 ice\n";
    };
    // Tops at the height of the floor.
    for (const std::string under :
         {"", "box 8 1 8 0 -4 -1 -4 grey\n", "mirror m .9 .9 .9\nbox 8 1 8 0 -4 -1 -4 m\n",
          "triangle -4 0 -4  4 0 -4  0 0 8  grey\n", "quad -4 0 -4  8 0 0  0 0 8  grey\n",
          "quad -.1 0 -.1  .2 0 0  0 0 .2  grey\n"})
        for (const bool before : {false, true}) {
            INFO(under);
            CAPTURE(before);
            const std::string floor = "quad -4 0 -4  0 0 8  8 0 0  grey\n";
            const std::string bare = under.empty() ? ice_room : replaced(floor, "\n", ice_room);
            auto with_block = [&](double height) {
                return parsed(bare + (before ? under + block(height) : block(height) + under));
            };
            const ParsedScene touching = with_block(0);
            expect_as_with_a_gap(touching, with_block(gap));
            CHECK(warns(touching, "this glass lies in the surface of line "));
        }
    const ParsedScene first = parsed(ice_room + block(0));
    CHECK(first.warnings ==
          std::vector<std::string>{"line 9: this glass lies in the surface of line 6: it is moved "
                                   "a hair into its own body, "
                                   "with air between"});
    // No other order of statements changes a bit.
    const std::string floor = "quad -4 0 -4  0 0 8  8 0 0  grey\n";
    const Scene last = parsed(replaced(floor, "\n", ice_room) + block(0) + floor).scene;
    CHECK(light_of(first.scene) == light_of(last));
}

TEST_CASE("a lamp on glass, under it and inside of its surface shines as with a gap") {
    const std::string cap = "light glow 3 3 3\nlight both 2 2 2 twosided\n";
    auto at = [&](double height, const std::string& lamp) {
        return parsed(ice_room + cap + "box 1.4 " + said(.7 - height) + " 1.4 0 -.7 .1 -.7 ice\n" +
                      lamp);
    };
    for (const char* lamp :
         {"quad -.3 .8 -.3  0 0 .6  .6 0 0  glow\n", "quad -.3 .8 -.3  .6 0 0  0 0 .6  glow\n",
          "quad -.9 .8 -.9  1.8 0 0  0 0 1.8  both\n"}) {
        INFO(std::string(lamp));
        expect_as_with_a_gap(at(0, lamp), at(gap, lamp));
    }
    // A lamp in the floor and glass upon both: two warnings, and the lamp is between them.
    const Scene three = parsed(ice_room + cap +
                               "quad -.3 0 -.3  0 0 .6  .6 0 0  glow\n"
                               "box 1 .5 1  0  -.5 0 -.5  ice\n")
                            .scene;
    const real floor = three.shapes[0].a.y, lamp = three.shapes[4].a.y;
    CHECK((floor == 0 && lamp > floor));
    for (size_t i = 6; i < 18; ++i) {
        const Shape& s = three.shapes[i];
        if (s.a.y == s.b.y && s.a.y == s.c.y && s.a.y < real(.3)) CHECK(s.a.y > lamp);
    }
    // Balls of one size: glass in a wall is not seen, and a lamp in glass is.
    const std::string ball = "sphere 0 .5 0  .5 ";
    CHECK(light_of(parsed(ice_room + ball + "grey\n" + ball + "ice\n").scene) ==
          light_of(parsed(ice_room + ball + "grey\n").scene));
    CHECK(light_of(parsed(ice_room + cap + ball + "ice\n" + ball + "glow\n").scene) ==
          light_of(parsed(ice_room + cap + ball + "glow\n").scene));
}

TEST_CASE("bodies of glass that touch or have faces in common lose no light in a furnace") {
    expect_furnace("box 2 2 1 0 -1 -1 -1 b\nbox 2 2 1 0 -1 -1 0 b\n");
    expect_furnace("box 2 2 1 0 -1 -1 -1 a\nbox 2 2 1 0 -1 -1 -1 c\n");  // one in the other
    expect_furnace("sphere 0 .7 0 1 b\nsphere 0 .7 0 1 a\nsphere 0 .7 0 1 b\n");
    Rng rng{7};
    auto whole = [&](int from, int to) { return from + int(rng.uniform() * (to - from + 1)); };
    for (int scene = 0; scene < 60; ++scene) {
        std::string bodies;
        for (int i = whole(2, 6); i > 0; --i)
            bodies += said("box", whole(1, 3), whole(1, 3), whole(1, 3), 0, whole(-2, 1),
                           whole(-2, 1), whole(-2, 1)) +
                      " " + "abc"[whole(0, 2)] + "\n";
        expect_furnace(bodies);
    }
}

TEST_CASE("no path gets into an opaque body by glass that touches it") {
    Rng rng{8};
    auto whole = [&](int from, int to) { return from + int(rng.uniform() * (to - from + 1)); };
    int met = 0, inside = 0;
    for (int n = 0; n < 40; ++n) {
        std::string bodies = "sphere 0 0 0 50 sky\nbox 6 1 6 0 -3 -3 -3 grey\n";
        for (int i = whole(2, 5); i > 0; --i)
            bodies += said("box", whole(1, 3), whole(1, 3), whole(1, 3), 0, whole(-2, 1),
                           whole(-2, 1), whole(-2, 1)) +
                      (whole(0, 2) ? " ice\n" : " grey\n");
        const Scene scene = parsed(
                                "size 8 8\ncamera .3 .7 9  .3 .7 0  40\ndepth 60\nglass ice 1.5\n"
                                "diffuse grey .9 .9 .9\nlight sky 1 1 1 twosided\n" +
                                bodies)
                                .scene;
        for (int i = 0; i < 64; ++i)
            for (uint64_t k = 0; k < 16; ++k)
                radiance(scene, {Direction::bsdf, LightMode::none, 0},
                         {SamplerKind::independent, 3}, i % 8, i / 8, k,
                         [&](const PathState&, const VertexEvents& e) {
                             if (!e.met || !(max_of(e.vertex.material->diffuse()) > 0)) return;
                             ++met;
                             inside += e.vertex.cos_o < 0;
                         });
    }
    CHECK(met > 10000);
    CHECK(inside == 0);
}

TEST_CASE("glass that has no room to be moved is refused, with both lines") {
    const double hair = 512 * double(ulp) * 4;
    auto why = [&](const std::string& shapes) {
        return complaint([&] { parsed(ice_room + shapes); });
    };
    const std::string
        thin = "box 1 " + said(hair / 2) + " 1 0 -.5 0 -.5 ice\n",
        in_floor = "this glass lies in the surface of line 6 and has no room to be moved off: ";
    CHECK(why(thin) == "test:9: " + in_floor + "it is too thin");
    CHECK(why("box 1 " + said(8 * hair) + " 1 0 -.5 0 -.5 ice\n") == "");
    // Whatever is near, smaller than a hair or larger.
    for (const double size : {.4, hair / 4}) {
        const std::string coin = "quad -" + said(size / 2) + " " + said(hair / 2) + " -" +
                                 said(size / 2) + "  " + said(size) + " 0 0  0 0 " + said(size) +
                                 "  grey\n";
        if (size < .1 && single) continue;  // has no area
        CHECK(why("box 1 1 1 0 -.5 0 -.5 ice\n" + coin) ==
              "test:9: " + in_floor + "line 10 is too near");
        CHECK(why(coin + "box 1 1 1 0 -.5 0 -.5 ice\n") ==
              "test:10: " + in_floor + "line 9 is too near");
    }
    // What reflects nothing sends no rays: a sky and a sun make no hair wider.
    CHECK(why("sphere 0 0 0 1e8 lamp\nbox 1 " + said(40 * hair) + " 1 0 -.5 0 -.5 ice\n") == "");
    // Beside, above and away from it, anything may be.
    CHECK(why("box 1 1 1 0 -.5 0 -.5 ice\nquad .6 " + said(hair / 2) +
              " -.2  .4 0 0  0 0 .4  grey\n") == "");
}

TEST_CASE("a point light on a surface is refused, off it accepted") {
    auto at = [](const char* place) {
        const std::string text = "triangle 0 1 0  1 1 0  0 2 1  grey\nsphere 2 2 2 .5 grey\n";
        return complaint([&] { parsed(room + text + "pointlight " + place + "  1 1 1\n"); });
    };
    CHECK(at("0.5 0 0.5") == "test:9: this point light lies on the surface of line 6: move it off");
    for (const auto& [place, line] :
         {std::pair{"0 0 0", "6"}, {"0.25 1.25 0.25", "7"}, {"2 2.5 2", "8"}})  // on the diagonal
        CHECK(at(place).starts_with("test:9: this point light lies on the surface of line " +
                                    std::string(line)));
    // Near the quad in its plane, beyond the long side of the triangle.
    for (const char* place :
         {"0.5 1e-4 0.5", "0.5 -1e-4 0.5", "5 0 0", "1 2 1", "2 2.501 2", "2 2 2"})
        CHECK(at(place) == "");
    // 4 ulp of the quad's size, which is 4, and 4 ulp of this place are the limit.
    CHECK(at(("0.5 " + said(17 * double(ulp)) + " 0.5").c_str()) != "");
    CHECK(at(("0.5 " + said(19 * double(ulp)) + " 0.5").c_str()) == "");
}

TEST_CASE("coordinates that rounding makes coarse are told, with the shape") {
    auto box_at = [](double x) {
        const std::string at = said(x), wall = said(x - 2);
        return parsed("camera " + at + " 0 1.8  " + at + " 0 0  60\ndiffuse half .5 .5 .5\n" +
                      "light glow .4 .4 .4 twosided half\nbox 4 3 4  0  " + wall +
                      " -1.5 -2   glow\n");
    };
    CHECK(warns(box_at(1e6), "precision is too low here") == single);
    CHECK(!warns(box_at(1e3), "precision is too low here"));
    if (!single) CHECK(warns(box_at(1e14), "line 4: double precision is too low here"));
    for (const char* name : {"atelier", "cornell", "cornell36", "cornellglossy", "coursework",
                             "cube", "furnace", "lanterns", "materials", "panel", "penumbra"})
        CHECK(warns(read_scene("scenes/" + std::string(name) + ".scene"), "precision is too low") ==
              (single && name == std::string_view("atelier")));
    CHECK(warns(read_scene("scenes/extremes.scene"), "precision is too low here") == single);
}

TEST_CASE("where rays start more than 1 % of the way to something near, it is told") {
    const std::string start = "line 4: " + std::string(single ? "float" : "double") +
                              " precision is too low here: ray origins are offset by more than 1 % "
                              "of this shape's distance to ",
                      end = ", and light may be wrong; " +
                            std::string(single ? "use REAL=double, or " : "") +
                            "bring all shapes nearer to the origin";
    const std::string& eye = from_above;
    const struct {
        std::string eye, others, what;
    } rows[] = {{eye, "quad -1000 @ -1000  2000 0 0  0 0 2000  l\n", "line 5"},
                {eye, "quad -1000 -@ -1000  2000 0 0  0 0 2000  l\n", "line 5"},
                {"1 @ 2  9 @ 1  50", panel, "the eye"},
                {"1 -@ 2  9 -@ 1  50", panel, "the eye"},
                {eye, "pointlight 1 @ 2  9 9 9\npointlight 3 @ 2  9 9 9\n", "a point light"}};
    for (const auto& row : rows) {
        INFO(row.eye, row.others);
        for (const double offsets : {50.0, 95.0})
            CHECK(told(off(row.eye, offsets), off(row.others, offsets)) == start + row.what + end);
        CHECK(told(off(row.eye, 105), off(row.others, 105)) == "");
    }
    // The message names the ball or plate, line 5: most points of the floor are far from it.
    for (const std::string other :
         {"sphere 9 @ 9  5 l\n", "sphere 9 -@ 9  5 l\n", "quad 9 @ 9  1 0 0  0 0 1  l\n"}) {
        INFO(other);
        const std::string near = told(eye, off(other, 90));
        CHECK(near.starts_with("line 5: "));
        CHECK(near.ends_with(" distance to line 4" + end));
        CHECK(told(eye, off(other, 110)) == "");
    }
    // A small ball, located by its centre, on or above the floor; its size is many more offsets.
    auto ball = [&](double height) {
        return told(eye, panel + off("sphere 0 @ 0  ", height) + off("@ d\n", 40));
    };
    CHECK(ball(90).ends_with(" distance to line 4" + end));
    CHECK(ball(110) == "");
}

TEST_CASE("shapes that touch are not near, nor are they with a light near by") {
    const std::string& eye = from_above;
    for (const char* standing :
         {"box 2 2 2  30  1 0 1  d\n", "sphere 2 1 3  1 d\n", "sphere 0 0 0  1 d\n",
          "quad -4 0 -4  0 0 8  8 0 0  d\n", "quad -4 0 -4  8 0 0  0 8 0  d\n"}) {
        INFO(std::string(standing));
        CHECK(told(eye, panel + standing) == "");
    }
    // A ball in a corner, a roof, a box upon a box.
    CHECK(told(eye, panel + "quad -9 0 -1  18 0 0  0 9 0  d\nsphere 3 1 0  1  d\n") == "");
    CHECK(told(eye, panel + "box 2 2 2  0  -1 0 -1  d\nbox 1 1 1  20  -.5 2 -.5  d\n") == "");
}

TEST_CASE("plates on a slope touch it within rounding; a small ball far away is not near itself") {
    const std::string& eye = from_above;
    std::string slope = "quad -90 0 0  180 0 0  0 2.1 1.3  d\n";
    for (int i = -20; i < 20; ++i) {
        char plate[200];
        std::snprintf(plate, sizeof plate, "quad %.1f .21 .13  .7 0 0  0 %.3f %.3f  d\n", 1.7 * i,
                      0.021 * (30 + i), 0.013 * (30 + i));
        slope += plate;
    }
    CHECK(told(eye, panel + slope) == "");
    const std::string ball = told(eye, panel + off("sphere 900 50 0  @ d\n", 30));
    CHECK(ball.find("shape's size,") != ball.npos);
    CHECK(ball.find("distance") == ball.npos);
}

TEST_CASE("three scenes that float gets wrong are told; in double they are not near") {
    const std::string floor = "quad -1000 0 -1000  0 0 2000  2000 0 0  d\n";
    const std::string head = "diffuse d .5 .5 .5\nlight l 1 1 1\n",
                      eye = "camera 0 1 4  0 .5 0  50\n";
    for (const char* h : {"1e-9", "1e-6", "1e-4", "1e-2", "0.1"})
        CHECK(parsed(eye + head + floor + "quad -1000 " + h + " -1000  2000 0 0  0 0 2000  l\n")
                  .warnings.size() == (single ? 1 : 0));
    CHECK(warns(parsed("camera 0 1e-3 0  5 1e-3 0  50\n" + head +
                       "sphere 0 -1e6 0  1e6 d\nsphere 0 2e3 0  900 l\n"),
                "distance to the eye") == single);
    for (const char* lamp : {"sphere 1.9997 .0349 0  .1 l\n", "sphere 6.9 .1204 0  .345 l\n"})
        CHECK(warns(parsed(eye + head + floor + lamp), "distance to line 4") == single);
}

// Maps of its light have one side and no sky.  In float, a ray from a point 10 micrometres before
// an edge may start behind the edge.
TEST_CASE("the house of atelier is closed, and only the fronts of its faces are seen") {
    const ParsedScene atelier = read_scene("scenes/atelier.scene");
    // The sill is a millimetre from the wall.
    CHECK(atelier.warnings.size() == (single ? 1 : 0));
    CHECK(atelier.scene.lights.size() == 5);
    const Scene& scene = atelier.scene;
    int escapes = 0, backs = 0;
    for (int y = 0; y < scene.size.height; ++y)
        for (int x = 0; x < scene.size.width; ++x)
            radiance(scene, {Direction::bsdf, LightMode::none, 0}, {SamplerKind::independent, 5}, x,
                     y, 0, [&](const PathState&, const VertexEvents& e) {
                         if (!e.met)
                             ++escapes;
                         else if (e.vertex.cos_o < 0)
                             ++backs;
                     });
    if (!single) {
        CHECK(escapes == 0);
        CHECK(backs == 0);
    }
}
