// film/image_test.cpp  images keep their values and their orientation, in memory and in files
#include "film/image.h"

#include <doctest/doctest.h>

#include <sys/resource.h>

#include <cstdlib>
#include <map>

#include "base/folder.h"
#include "base/system_calls.h"
#include "film/film.h"
#include "film/png.h"

namespace {

using Pixel = std::array<float, 3>;

// The bytes of a PFM of one colour pixel (1, -2, 0.5): 0x3f800000, 0xc0000000, 0x3f000000.
const std::string one_pixel("PF\n1 1\n-1.0\n\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f", 24);

bool refused(const std::string& path) {
    try {
        read_pfm(path);
    } catch (const UserError& e) {
        return std::string(e.what()).starts_with(path + ": ");
    }
    return false;
}

// All values different, in every pixel and channel, with signs, zeros and subnormal numbers.
Image variegated(int width, int height) {
    Image image(width, height);
    float k = 0;
    for (Pixel& pixel : image.pixels)
        for (float& channel : pixel) {
            channel = (k - 7) * 0.37f;
            ++k;
        }
    image.at(0, 0) = {0, -0.0f, 1e-42f};
    return image;
}

}  // namespace

// ---- Images and files ---------------------------------------------------------------------------

TEST_CASE("a fresh image is NaN everywhere, and (x, y) counts from the top left, row by row") {
    Image image(3, 2);
    REQUIRE(image.pixels.size() == 6);
    bool all_nan = true;
    for (const Pixel& pixel : image.pixels)
        for (float channel : pixel) all_nan = all_nan && std::isnan(channel);
    CHECK(all_nan);
    image.at(1, 0) = {1, 1, 1};
    image.at(0, 1) = {2, 2, 2};
    CHECK(image.pixels[1][0] == 1);
    CHECK(image.pixels[3][0] == 2);
}

TEST_CASE("a PFM is its header, then rows from the bottom up, little-endian") {
    Image image(1, 1);
    image.at(0, 0) = {1, -2, 0.5f};
    CHECK(encode_pfm(image) == one_pixel);

    Image four(2, 2);
    for (int i = 0; i < 4; ++i) four.pixels[size_t(i)] = {float(i), float(i), float(i)};
    const std::string bytes = encode_pfm(four), header = "PF\n2 2\n-1.0\n";
    REQUIRE(bytes.size() == header.size() + 48);
    CHECK(bytes.starts_with(header));
    std::array<float, 12> values;
    std::memcpy(values.data(), bytes.data() + header.size(), 48);
    CHECK(values == std::array<float, 12>{2, 2, 2, 3, 3, 3, 0, 0, 0, 1, 1, 1});
}

TEST_CASE("what is written to a PFM is read back bit by bit, NaN and infinity too") {
    const Folder folder;
    for (auto [w, h] : {std::pair(1, 1), std::pair(5, 3), std::pair(3, 5), std::pair(1, 7)}) {
        Image image = variegated(w, h);
        image.pixels.back() = {NAN, INFINITY, 3.4e38f};
        write_image(folder / "a.pfm", image, 17);  // exposure is for PNG
        const Image back = read_pfm(folder / "a.pfm");
        CHECK(back.width == w);
        CHECK(back.height == h);
        REQUIRE(back.pixels.size() == image.pixels.size());
        CHECK(std::memcmp(back.pixels.data(), image.pixels.data(), size_t(12 * w * h)) == 0);
    }
    folder.write("b.pfm", "PF 1\t1 -1\n" + one_pixel.substr(12));  // any white space will do
    CHECK(read_pfm(folder / "b.pfm").at(0, 0) == Pixel{1, -2, 0.5f});
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
          // As long as the header it lacks the rest of: 12 bytes.
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

TEST_CASE("sRGB has the values of its standard") {
    CHECK(encode_srgb(0) == 0);
    CHECK(std::abs(encode_srgb(1) - 1) < 1e-15);
    CHECK(std::abs(encode_srgb(0.0031308) - 0.04045) < 1e-6);
    CHECK(std::abs(encode_srgb(0.0031309) - 0.04045) < 2e-6);  // the branches meet
    CHECK(std::abs(encode_srgb(0.001) - 0.01292) < 1e-15);
    const std::map<double, int> known = {{0.0, 0},   {0.0031308, 10}, {0.01, 25},    {0.18, 118},
                                         {0.5, 188}, {0.75, 225},     {1.0, 255},    {-1.0, 0},
                                         {-1e30, 0}, {1.001, 255},    {7.0, 255},    {1e30, 255},
                                         {1e-9, 0},  {0.0001518, 1},  {0.0001517, 0}};
    for (const auto& value : known) {
        INFO(value.first);
        CHECK(int(to_byte(value.first)) == value.second);
    }
    for (int byte = 0; byte < 256; ++byte) {
        const double s = byte / 255.0;  // decoded as the standard has it, written independently
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        CHECK(int(to_byte(linear)) == byte);
    }
}

TEST_CASE("a PNG holds exposure times radiance in sRGB, from the top left, and nothing else") {
    Image image = variegated(5, 3);
    image.at(4, 0) = {1e30f, -1e30f, INFINITY};
    for (double exposure : {1.0, 0.25}) {
        const std::string bytes = encode_png(image, exposure);
        // Signature, then IHDR: 13 bytes, width and height big-endian, 8 bits, RGB.
        CHECK(
            bytes.starts_with(std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x05\0\0\0\x03"
                                          "\x08\x02\0\0\0",
                                          29)));
        const Decoded png = decode_png(bytes);
        REQUIRE(png.width == 5);
        REQUIRE(png.height == 3);
        bool same = true;
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 5; ++x)
                for (int c = 0; c < 3; ++c)
                    same = same && png.at(x, y, c) ==
                                       int(to_byte(exposure * double(image.at(x, y)[size_t(c)])));
        CHECK(same);
        CHECK(png.at(4, 0, 0) == 255);
        CHECK(png.at(4, 0, 1) == 0);
        CHECK(png.at(4, 0, 2) == 255);
    }
}

TEST_CASE("a PFM is written in pieces, for which no second picture is needed") {
    const Folder folder;
    const Image image = variegated(600, 400);  // 2.9 MB, in pieces of up to 1 MiB
    const auto calls = calls_of({}, [&] { write_image(folder / "a.pfm", image, 1); });
    CHECK(std::count(calls.begin(), calls.end(), "write") == 3);
    CHECK(folder.read("a.pfm") == encode_pfm(image));
}

TEST_CASE("a picture that a PNG cannot hold is refused, before there is one") {
    auto refusal = [](Size size) -> std::string {
        try {
            check_png("a.png", size);
        } catch (const UserError& e) {
            return e.what();
        }
        return "";
    };
    // Rows of 2^16 bytes with that of their filter: 21845 of them are less than 1431655760 bytes.
    CHECK(refusal({21845, 21845}) == "");
    CHECK(refusal({21845, 21846}) ==
          "a.png: 21845x21846 pixels are too many for a PNG, which holds 477218586; "
          "say -o FILE.pfm");
    CHECK(refusal({65536, 7281}) == "");
    CHECK(refusal({65536, 7282}) != "");
    CHECK(refusal({32768, 16384}) != "");
    CHECK(refusal({INT32_MAX, INT32_MAX}) != "");
    CHECK(refusal({1, 357913940}) == "");  // 4 bytes a row
    CHECK(refusal({1, 357913941}) != "");
}

TEST_CASE("a PNG for which there is no memory is an error, and no end of the program") {
#ifdef __SANITIZE_ADDRESS__
    MESSAGE("the address sanitizer needs more memory than that: not tested");
#else
    Image image(500, 700);
    float k = 0;
    for (Pixel& pixel : image.pixels)  // noise, which nothing compresses
        for (float& channel : pixel) k = channel = std::fmod(k * 997 + 0.123f, 1.f);
    rlimit old_limit;
    REQUIRE(::getrlimit(RLIMIT_AS, &old_limit) == 0);
    auto allow_more = [&](rlim_t bytes) {  // than the process has now
        std::ifstream statm("/proc/self/statm");
        rlim_t pages = 0;
        statm >> pages;
        const rlim_t all = pages * rlim_t(::sysconf(_SC_PAGESIZE)) + bytes;
        const rlimit limit{all, old_limit.rlim_max};
        ::setrlimit(RLIMIT_AS, &limit);
    };
    const std::string expected = encode_png(image, 1);
    int written = 0, refused = 0;
    for (rlim_t room = 0; room < 8 << 20; room += 1 << 18) {
        std::vector<std::unique_ptr<char[]> > taken;  // what was freed before is room, too
        taken.reserve(100000);
        allow_more(0);
        try {
            while (taken.size() < 100000) taken.push_back(std::make_unique<char[]>(1 << 16));
        } catch (const std::bad_alloc&) {
        }
        allow_more(room);
        std::string bytes;
        try {
            bytes = encode_png(image, 1);
        } catch (const std::bad_alloc&) {
            ++refused;
        }
        ::setrlimit(RLIMIT_AS, &old_limit);
        const bool right = bytes == expected;
        written += right;
        CHECK((right || bytes.empty()));
    }
    MESSAGE(refused, " refused, ", written, " written");
    CHECK(refused > 4);
    CHECK(written > 4);
#endif
}
