// whole/outputs_test.cpp  which files are written, and that they are whole
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
                   split("-o a.pfm -o b.png --spp 2 -o c.pfm -o a.pfm file.scene -o d.png"));
    CHECK(other.all().size() == 5);
    CHECK(other.same("a.pfm", "c.pfm"));
    CHECK(other.same("b.png", "d.png"));
    other.write("default.pfm", folder.read("out/my.first scene.pfm"));
    other.write("default.png", folder.read("out/my.first scene.png"));
    CHECK(other.same("a.pfm", "default.pfm"));
    CHECK(other.same("b.png", "default.png"));
    CHECK(other.read("a.pfm").starts_with("PF\n8 4\n"));
    CHECK(other.read("b.png").starts_with("\x89PNG"));
}

TEST_CASE("a disk that fills up: exit status 1, and the old image is whole") {
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
