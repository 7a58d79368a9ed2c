// whole/outputs_test.cpp  the names and completeness of written files
#include "whole/process.h"

TEST_CASE("without -o the images are out/NAME.png and out/NAME.pfm; with it, those alone") {
    const Folder folder;
    folder.write("deep/down/my.first scene.scene", good);
    expect_success(folder, Words{"penumbra", "--spp", "2", "deep/down/my.first scene.scene"});
    CHECK(folder.files() == 6);  // includes three directories

    const Place other(good);
    other.render("-o a.pfm -o b.png --spp 2 -o c.pfm -o d.png");
    CHECK(other.files() == 5);
    CHECK(other.same("a.pfm", "c.pfm"));
    CHECK(other.same("b.png", "d.png"));
    other.render("-o a.hdr --exposure 9 --spp 2");
    other.render("-o b.hdr --spp 2");
    CHECK(other.read("a.hdr").starts_with("#?RADIANCE\n"));
    CHECK(other.same("a.hdr", "b.hdr"));  // exposure is for PNG
    for (const auto& [a, b] : {std::pair{"a.pfm", "scene.pfm"}, {"b.png", "scene.png"}}) {
        const bool same = other.read(a) == folder.read("out/my.first " + std::string(b));
        CHECK(same);
    }
    CHECK(other.read("a.pfm").starts_with("PF\n8 4\n"));
    CHECK(other.read("b.png").starts_with("\x89PNG"));

    // A band writes only its film, for `merge`.
    const Place band(good);
    band.render("--spp 2 --rows 1-2 --keep a.film");
    CHECK(band.files() == 2);
}

TEST_CASE("two things never get one file, nor does anything the file of the scene") {
    const MeshPlace place;
    place.write("out/scene.pfm", good);
    place.write("a.png", "old");
    fs::create_symlink("a.png", place / "link.pfm");
    const std::string why = ": would replace another file";
    expect_refusals(place, "penumbra",
                    {{"--stats a.pfm -o a.pfm file.scene", "a.pfm" + why},
                     {"--stats ./a.pfm -o out/../a.pfm file.scene", "./a.pfm" + why},
                     {"-o b.pfm -o ./b.pfm file.scene", "./b.pfm" + why},
                     {"-o a.png -o link.pfm file.scene", "link.pfm" + why},
                     {"--stats out/file.png file.scene", "out/file.png" + why},
                     {"--stats file.scene file.scene", "file.scene" + why},
                     {"--stats out/../m.obj file.scene", "out/../m.obj" + why},
                     {"--stats m.mtl file.scene", "m.mtl" + why},
                     {"out/scene.pfm", "out/scene.pfm" + why}});
    place.render("--spp 1 -o a.pfm -o b.pfm -o a.png");
}

TEST_CASE("a picture too large for a PNG is refused before it is rendered; a PFM has room for it") {
    const Place place(good);
    const std::string why = "32768x16384 pixels are too many for a PNG, which holds 268435456; say";
    // build/penumbra prints the same message if the machine has memory for the film.  A PFM may
    // have this size: the last row has another mistake.
    expect_refusals(place, "radiosity --size 32768x16384 file.scene",
                    {{"-o a.pfm -o a.png", "a.png: " + why},
                     {"", "out/file-radiosity.png: " + why},
                     {"-o file.scene/a.pfm", "file.scene/a.pfm: cannot write: "}});
}

TEST_CASE("what stdout does not take is an error") {
    const Place place(good);
    place.write("a.pfm", pfm(1, 1, {1, 1, 1}));
    for (const std::string& command :
         parts_of("penumbra --help;penumbra --pixel 1,1 file.scene;radiosity --help;"
                  "compare a.pfm a.pfm;compare --help;knot --help"))
        CHECK(expect_exit(place, command, 1, {.output = "/dev/full"}).err ==
              "stdout: cannot write: No space left on device\n");
}

TEST_CASE("a stderr that nobody reads costs no image") {
    const Place place(good + "triangle 0 0 0 1 1 1 2 2 2 m\n");  // a warning
    expect_exit(place, "penumbra --spp 2 -o a.pfm file.scene", 0, {.deaf = true});
    CHECK(place.has("a.pfm"));
}
