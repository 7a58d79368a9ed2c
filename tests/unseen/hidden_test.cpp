// unseen/hidden_test.cpp  lamps in bodies, in glass, in rooms; point lights with mirrors and glass
#include "unseen/hidden.h"

#include <doctest/doctest.h>

#include "text/folder.h"
#include "text/scene_file.h"

namespace {

const std::string room =
    "size 4 4\ncamera 0 1 4  0 0.5 0  50\ndepth 3\ndiffuse grey 0.5 0.5 0.5\n"
    "light lamp 2 2 2\nquad -4 0 -4  0 0 8  8 0 0  grey\n";

NamedScene parsed(const std::string& text) { return parse_scene(text, "test").scene; }

}  // namespace

TEST_CASE("a lamp that no path leaves is told; one in glass, or in the eye's room, is not") {
    auto hidden = [](const std::string& shapes) {
        std::string all;
        for (const std::string& w :
             hidden_lights(parsed(room + "glass ice 1.5\nlight shade .1 .1 .1 grey\n" + shapes)))
            all += w + "\n";
        return all;
    };
    auto by = [](const std::string& line) {
        return "line 9: this light is hidden by line " + line +
               ": none of 512 paths from it comes out or in view of the eye\n";
    };
    const std::string lamp = "sphere 2 3 1 .5 lamp\n";
    CHECK(hidden(lamp + "sphere 2 3 1 .6 shade\n") == by("10"));
    CHECK(hidden(lamp + "sphere 2 3 1 .6 grey\n") == by("10"));
    CHECK(hidden("quad 1.8 3 1  .2 0 0  0 0 .2  lamp\nbox 2 2 2 30 1 2 .5 grey\n") == by("10"));
    CHECK(hidden("triangle 1.8 3 1  2 3 1  2 3 1.2  lamp\nsphere 2 3 1 .6 grey\n"
                 "sphere 2 3 1 .7 ice\n") == by("10"));
    CHECK(hidden(lamp + "sphere 2 3 1 .6 ice\nsphere 2 3 1 .7 grey\n") == by("11"));
    // On the floor, at the height of the eye, and in two balls that overlap.
    CHECK(hidden("sphere 1 .5 0 .2 lamp\nbox 1 1 1 0 .5 0 -.5 grey\n")
              .starts_with("line 9: this light is hidden"));
    CHECK(hidden("sphere 2 3 1 .2 lamp\nsphere 1.8 3 1 .5 grey\nsphere 2.2 3 1 .5 grey\n")
              .starts_with("line 9: this light is hidden"));
    const std::string both = "light both 1 1 1 twosided\nsphere 0 0 0 20 both\n";
    CHECK(hidden(both + "sphere 0 0 0 30 grey\n") == "");
    for (const std::string open :
         {"sphere 2 3 1 .6 ice\n", "sphere 2.6 3 1 .6 grey\n", "sphere 0 0 0 30 grey\n",
          "box 20 9 20 0 -10 -1 -10 grey\n", "box 1 1 1 0 1.5 2.2 1.5 grey\n"}) {
        INFO(open);
        CHECK(hidden(lamp + open).find("hidden") == std::string::npos);
    }
    CHECK(hidden("quad -1 4 -1 2 0 0 0 0 2 lamp\nsphere 0 4 0 .5 grey\n") == "");  // its middle
    // In an empty room with the eye, and in a tube that is open above and below.
    const std::string head =
        "camera 0 1.2 0  .01 1.2 -4  40\ndiffuse grey .5 .5 .5\nlight lamp 2 2 2\n"
        "sphere 0.4 2.4 .28 .04 lamp\n";
    CHECK(hidden_lights(parsed(head + "box 4 4 4 0 -2 0 -2 grey\n")).empty());
    CHECK(hidden_lights(parsed(head + "box .4 .4 .4 0 .2 2.2 0.1 grey\n")).size() == 1);
    const Folder folder;
    folder.write("tube.obj",
                 "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 4 -1\nv 1 4 -1\nv 1 4 1\nv -1 4 1\n"
                 "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    CHECK(hidden_lights(
              parse_scene(head + "mesh tube.obj .5 .4 1.4 .28 grey\n", folder / "test").scene)
              .empty());
    // A lamp that faces the bottom of a well: its light comes out after some bounces.
    folder.write("well.obj",
                 "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 4 -1\nv 1 4 -1\nv 1 4 1\nv -1 4 1\n"
                 "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 1 2 3 4\n");
    const std::string well =
        "camera 0 1 9  0 1 0  40\ndiffuse grey .5 .5 .5\nlight lamp 2 2 2\n"
        "quad -.2 2 -.2  .4 0 0  0 0 .4  lamp\nmesh well.obj 1 0 0 0 grey\n";
    CHECK(hidden_lights(parse_scene(well, folder / "test").scene).empty());
    const std::string point = "pointlight 2 3 1  9 9 9\n";
    CHECK(hidden(point + "sphere 2 3 1 .6 grey\n") == by("10"));
    const std::string missing =
        "a point light does not shine through glass or by mirrors, where no path finds it: that "
        "light is missing; a sphere of radius r and radiance I / (pi r^2) shines there, too\n";
    CHECK(hidden(point + "sphere 2 3 1 .6 ice\n") == by("10") + "line 9: " + missing);
    CHECK(hidden(point + "mirror m 1 1 1\nsphere 2 3 1 .6 m\n") == by("11") + "line 9: " + missing);
    CHECK(hidden(point + point + "mirror m 1 1 1\nsphere 0 1 0 .5 m\n") == "line 9: " + missing);
    CHECK(hidden(point + "mirror m 1 1 1\n") == "");
    CHECK(hidden(lamp + "sphere 0 1 0 .5 ice\n") == "");
}
