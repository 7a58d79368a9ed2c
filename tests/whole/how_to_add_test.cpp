// whole/how_to_add_test.cpp  new kinds take the edits that reference/how-to-add.md says
#include "course/python.h"
#include "text/folder.h"

TEST_CASE("new kinds take so many edits, and radiosity refuses those that it does not know") {
    const Folder folder;
    const Printed printed = output_of("python3 tests/how_to_add " + (folder / "copy"));
    INFO(printed.text);
    CHECK(printed.status == 0);
}
