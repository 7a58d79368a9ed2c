// whole/how_to_add_test.cpp  new kinds take the places that reference/how-to-add.md says
#include <doctest/doctest.h>

#include "whole/process.h"

TEST_CASE(
    "a material and a sampler in two places each render, and radiosity refuses the material by "
    "name") {
    const Folder folder;
    const std::string line = "python3 tests/how_to_add " + (folder / "copy") + " 2>&1";
    std::string told;
    std::FILE* pipe = ::popen(line.c_str(), "r");
    REQUIRE(pipe);
    for (int c; (c = std::fgetc(pipe)) != EOF;) told += char(c);
    CAPTURE(told);
    CHECK(::pclose(pipe) == 0);
}
