// keep/read_pfm_test.cpp  PFM files return the images that were written; other files are refused
#include "keep/read_pfm.h"

#include "base/complaint.h"
#include "base/folder.h"
#include "film/variegated.h"

namespace {

// The bytes of a PFM of one colour pixel (1, -2, 0.5): 0x3f800000, 0xc0000000, 0x3f000000.
const std::string one_pixel("PF\n1 1\n-1.0\n\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f", 24);

bool refused(const std::string& path) {
    return complaint([&] { read_pfm(path); }).starts_with(path + ": ");
}

}  // namespace

TEST_CASE("what is written to a PFM is read back bit by bit, NaN and infinity too") {
    const Folder folder;
    for (auto [w, h] : {std::pair(1, 1), std::pair(5, 3), std::pair(3, 5), std::pair(1, 7)}) {
        Image image = variegated(w, h);
        image.pixels.back() = {NAN, INFINITY, 3.4e38f};
        write_image(folder / "a.pfm", image, 17);
        const Image back = read_pfm(folder / "a.pfm");
        CHECK(back.width == w);
        CHECK(back.height == h);
        REQUIRE(back.pixels.size() == image.pixels.size());
        CHECK(std::memcmp(back.pixels.data(), image.pixels.data(), size_t(12 * w * h)) == 0);
    }
    folder.write("b.pfm", "PF 1\t1 -1\n" + one_pixel.substr(12));  // any white space is valid
    CHECK(read_pfm(folder / "b.pfm").at(0, 0) == Colour{1, -2, 0.5f});
}

TEST_CASE("no part of a PFM passes for a whole one, nor does anything else") {
    const Folder folder;
    for (size_t length = 0; length < one_pixel.size(); ++length) {
        folder.write("a.pfm", one_pixel.substr(0, length));
        INFO(length, " bytes");
        CHECK(refused(folder / "a.pfm"));
    }
    const std::string pixel = one_pixel.substr(12);
    for (const std::string& bytes :
         {one_pixel + "x", "PF\n1 1\n1.0\n" + pixel, "Pf\n1 1\n-1.0\n" + pixel,
          "P6\n1 1\n-1.0\n" + pixel, "PF\n1 2\n-1.0\n" + pixel, "PF\n0 1\n-1.0\n" + pixel,
          "PF\n-1 -1\n-1.0\n" + pixel, "PF\n1.0 1\n-1.0\n" + pixel, "PF\n1 1\nnan\n" + pixel,
          std::string("PF\n1000000 1000000\n-1.0\n"), std::string("PF\n65536 65536\n-1.0\n"),
          // The header is cut short, but has the 12 bytes of a complete one.
          std::string("PF\n1 1\n-1.00")}) {
        folder.write("a.pfm", bytes);
        INFO(bytes);
        CHECK(refused(folder / "a.pfm"));
    }
    CHECK(refused(folder / "missing.pfm"));
    CHECK(refused(folder.path.string()));
    CHECK(refused(folder / std::string(1000, 'a')));
    folder.write("a.pfm", one_pixel);
    CHECK_FALSE(refused(folder / "a.pfm"));
}
