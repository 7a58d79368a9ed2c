// whole/how_to_add_test.cpp  new kinds take the places that reference/how-to-add.md says
#include "course/python.h"
#include "text/folder.h"

TEST_CASE("a material and a sampler take two places each, and radiosity refuses the material") {
    const Folder folder;
    const Printed printed = output_of("python3 tests/how_to_add " + (folder / "copy"));
    INFO(printed.text);
    CHECK(printed.status == 0);
}
