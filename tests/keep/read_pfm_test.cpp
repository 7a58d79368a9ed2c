// keep/read_pfm_test.cpp  PFM files return the images that were written; other files are refused
#include "keep/read_pfm.h"

#include "base/cases.h"
#include "film/variegated.h"
#include "text/complaint.h"
#include "text/folder.h"

namespace {

// The bytes of a PFM of one colour pixel (1, -2, 0.5): 0x3f800000, 0xc0000000, 0x3f000000.
const std::string one_pixel("PF\n1 1\n-1.0\n\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f", 24);

// Why it is refused, without its name; "" if it is not.
std::string refusal(const std::string& path) {
    const std::string why = complaint([&] { read_pfm(path); });
    CHECK((why.empty() || why.starts_with(path + ": ")));
    return why.substr(std::min(why.size(), path.size() + 2));
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
    auto why = [&](const std::string& bytes) {
        folder.write("a.pfm", bytes);
        return refusal(folder / "a.pfm");
    };
    const std::string pixel = one_pixel.substr(12), no_pfm = "not a little-endian colour PFM file",
                      other_length = "1x1 pixels do not fill the file";
    CHECK(why(one_pixel) == "");
    for (size_t length = 0; length < one_pixel.size(); ++length) {
        INFO(length, " bytes");
        CHECK(why(one_pixel.substr(0, length)) == (length < 12 ? no_pfm : other_length));
    }
    CHECK(why(one_pixel + "x") == other_length);
    for (const std::string& head : parts_of("PF\n1 1\n1.0\n;Pf\n1 1\n-1.0\n;P6\n1 1\n-1.0\n;"
                                            "PF\n1 1\nnan\n;a picture\n"))
        CHECK(why(head + pixel) == no_pfm);
    CHECK(why("PF\n1 1\n-1.00") == no_pfm);  // 12 bytes, like one pixel
    CHECK(why("PF\n1 2\n-1.0\n" + pixel) == "1x2 pixels do not fill the file");
    CHECK(why("PF\n65536 65536\n-1.0\n").starts_with("an image of 65536x65536 has more than "));
    for (const std::string size : {"0", "-1", "1.0", "1000000"})
        CHECK(why("PF\n" + size + " " + size + "\n-1.0\n" + pixel) ==
              "'" + size + "' is not a whole number from 1 to 65536");
    CHECK(refusal(folder / "missing.pfm").starts_with("cannot open: "));
    CHECK(refusal(folder.path.string()) == "is a directory");
    CHECK(refusal(folder / std::string(1000, 'a')).starts_with("cannot open: "));
}
