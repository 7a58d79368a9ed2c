// film/image_files_test.cpp  pictures that come row by row are those that come at once
#include "film/image_files.h"

#include "base/folder.h"
#include "base/rng.h"

namespace {

using Row = std::vector<std::array<float, 3>>;

Image picture(int width, int height) {
    Image image(width, height);
    uint64_t k = 0;
    for (auto& pixel : image.pixels)
        for (float& channel : pixel) channel = float(1.5 * to_unit(mix(++k)));
    return image;
}

Row row_of(const Image& image, int y) {
    const auto from = image.pixels.begin() + ptrdiff_t(y) * image.width;
    return Row(from, from + image.width);
}

}  // namespace

TEST_CASE("rows in any order make the files that the whole picture makes") {
    for (const auto& [width, height] : {Size{7, 5}, Size{1, 9}, Size{300, 1}}) {
        const Folder folder;
        const Image image = picture(width, height);
        write_image(folder / "a.pfm", image, 0.7);
        write_image(folder / "a.png", image, 0.7);
        ImageFiles files({folder / "b.pfm", folder / "b.png", folder / "c.pfm"}, {width, height},
                         0.7);
        for (int k = 0; k < height; ++k) {
            const int y = (2 * k + 1) % height;  // all of these heights are odd
            files.add(y, row_of(image, y));
        }
        CHECK_FALSE(folder.has("b.pfm"));
        files.commit();
        CHECK(folder.files() == 5);
        for (const char* name : {"b.pfm", "c.pfm"}) CHECK(folder.same("a.pfm", name));
        CHECK(folder.same("a.png", "b.png"));
    }
}

TEST_CASE("a file by two names, or asked for twice, is written once") {
    const Folder folder;
    const Image image = picture(4, 2);
    write_image(folder / "a.pfm", image, 1);
    write_image(folder / "a.png", image, 1);
    ImageFiles files({folder / "b.pfm", folder / "./b.pfm", folder / "b.png", folder / "b.pfm",
                      folder / "b.png"},
                     {4, 2}, 1);
    for (int y : {1, 0}) files.add(y, row_of(image, y));
    files.commit();
    CHECK(folder.files() == 4);
    CHECK(folder.same("a.pfm", "b.pfm"));
    CHECK(folder.same("a.png", "b.png"));
}

TEST_CASE("a pixel that no file holds leaves none, and those of before as they were") {
    const Folder folder;
    folder.write("b.pfm", "old");
    const auto before = folder.all();
    {
        ImageFiles files({folder / "b.pfm", folder / "b.png"}, {4, 2}, 1);
        Row row(4, {1, 2, 3});
        files.add(0, row);
        row[2][1] = INFINITY;
        try {
            files.add(1, row);
            CHECK(false);
        } catch (const SystemError& e) {
            CHECK(std::string(e.what()) ==
                  "pixel 2,1 is more than a file can hold; nothing was written");
        }
    }
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}
