// whole/outputs_test.cpp  which files are written, and that they are whole
#include "base/files.h"
#include "whole/process.h"

TEST_CASE("without -o the images are out/NAME.png and out/NAME.pfm; with it, those alone") {
    const Folder folder;
    folder.write("deep/down/my.first scene.scene", good);
    expect_success(folder, "penumbra", {"--spp", "2", "deep/down/my.first scene.scene"});
    CHECK(folder.has("out/my.first scene.png"));
    CHECK(folder.has("out/my.first scene.pfm"));
    CHECK(folder.all().size() == 6);  // with three directories

    const Folder other;
    other.write("file.scene", good);
    expect_success(other, "penumbra",
                   split("-o a.pfm -o b.png --spp 2 -o c.pfm file.scene -o d.png"));
    CHECK(other.all().size() == 5);
    CHECK(other.same("a.pfm", "c.pfm"));
    CHECK(other.same("b.png", "d.png"));
    other.write("default.pfm", folder.read("out/my.first scene.pfm"));
    other.write("default.png", folder.read("out/my.first scene.png"));
    CHECK(other.same("a.pfm", "default.pfm"));
    CHECK(other.same("b.png", "default.png"));
    CHECK(other.read("a.pfm").starts_with("PF\n8 4\n"));
    CHECK(other.read("b.png").starts_with("\x89PNG"));

    // Of a band none but its film, which is for `merge`.
    const Folder band;
    band.write("file.scene", good);
    expect_success(band, "penumbra", split("--spp 2 --rows 1-2 --keep a.film file.scene"));
    CHECK(band.all().size() == 2);
}

TEST_CASE("a disk that fills up: exit status 1, the old image is whole, and nothing beside it") {
    const Folder folder;
    folder.write("file.scene", good);
    folder.write("a.pfm", "old");
    const auto before = folder.all();
    Process process(folder, "penumbra", split("--size 64x64 --spp 1 -o a.pfm file.scene"),
                    {.largest_file = 4096});
    const Outcome o = process.finish();
    CHECK(o.signal == 0);
    CHECK(o.status == 1);
    CHECK(contains(o.err, "a.pfm: cannot write: "));
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}

TEST_CASE("a name as long as names may be, and a link, are written; what a killed run left goes") {
    const Folder folder;
    const std::string name = std::string(251, 'a') + ".pfm";
    folder.write("file.scene", good);
    folder.write("deep/old.pfm", "old");
    fs::create_symlink("deep/old.pfm", folder / "link.pfm");
    // More than Linux gives to processes; beside the link, and beside what is written.
    const std::string beside = ".link.pfm.part2147483646";
    folder.write(beside, "not beside what is written");
    const fs::path left = aside(folder / "link.pfm", "2147483646");
    folder.write("deep/" + left.filename().string(), "half");
    CHECK(fs::exists(left));
    expect_success(folder, "penumbra", {"-o", name, "-o", "link.pfm", "--spp", "2", "file.scene"});
    CHECK(fs::is_symlink(folder / "link.pfm"));
    CHECK(folder.same(name, "deep/old.pfm"));
    CHECK(folder.has(beside));
    CHECK(!fs::exists(left));
    CHECK(folder.files() == 6);
}

TEST_CASE("two things never get one file, nor does anything the file of the scene") {
    const Folder folder;
    folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    folder.write("m.mtl", "newmtl a\nKd 1 1 1\n");
    folder.write("file.scene", good + "mesh m.obj 1 0 0 0\n");
    folder.write("out/scene.pfm", good);
    folder.write("a.png", "old");
    fs::create_symlink("a.png", folder / "link.pfm");
    const std::pair<std::string, std::string> rows[] = {
        {"--stats a.pfm -o a.pfm file.scene", "a.pfm: would replace another file"},
        {"--stats ./a.pfm -o out/../a.pfm file.scene", "./a.pfm: would replace another file"},
        {"-o b.pfm -o ./b.pfm file.scene", "./b.pfm: would replace another file"},
        {"-o a.png -o link.pfm file.scene", "link.pfm: would replace another file"},
        {"--stats out/file.png file.scene", "out/file.png: would replace another file"},
        {"--stats file.scene file.scene", "file.scene: would replace another file"},
        {"--stats out/../m.obj file.scene", "out/../m.obj: would replace another file"},
        {"--stats m.mtl file.scene", "m.mtl: would replace another file"},
        {"out/scene.pfm", "out/scene.pfm: would replace another file"}};
    for (const auto& [line, why] : rows) expect_refusal(folder, "penumbra", split(line), why);
    expect_success(folder, "penumbra", split("--spp 1 -o a.pfm -o b.pfm -o a.png file.scene"));
}

TEST_CASE("a picture too large for a PNG is refused before it is rendered; a PFM has room for it") {
    const Folder folder;
    folder.write("file.scene", good);
    const std::string why = "32768x16384 pixels are too many for a PNG, which holds 268435456; say";
    const std::string line = "--size 32768x16384 file.scene";
    // build/penumbra says the same, on a machine that has memory for the film.
    expect_refusal(folder, "radiosity", split("-o a.pfm -o a.png " + line), "a.png: " + why);
    expect_refusal(folder, "radiosity", split(line), "out/file-radiosity.png: " + why);
    // Nothing is wrong with the size of a PFM, so that another thing is.
    expect_refusal(folder, "radiosity", split("-o file.scene/a.pfm " + line),
                   "file.scene/a.pfm: cannot write: ");
}

TEST_CASE("what stdout does not take is an error") {
    const Folder folder;
    folder.write("file.scene", good);
    folder.write("a.pfm", pfm(1, 1, {1, 1, 1}));
    for (const std::string command :
         {"penumbra --help", "penumbra --pixel 1,1 file.scene", "radiosity --help",
          "compare a.pfm a.pfm", "compare --help", "knot --help"}) {
        const size_t space = command.find(' ');
        Process process(folder, command.substr(0, space), split(command.substr(space + 1)),
                        {.output = "/dev/full"});
        const Outcome o = process.finish();
        INFO(command);
        CHECK(o.status == 1);
        CHECK(o.err == "stdout: cannot write: No space left on device\n");
    }
}

TEST_CASE("a stderr that nobody reads costs no image") {
    const Folder folder;
    folder.write("file.scene", good + "triangle 0 0 0 1 1 1 2 2 2 m\n");  // a warning
    Process process(folder, "penumbra", split("--spp 2 -o a.pfm file.scene"), {.deaf = true});
    const Outcome o = process.finish();
    CHECK(o.signal == 0);
    CHECK(o.status == 0);
    CHECK(folder.has("a.pfm"));
}
