// text/image_file_test.cpp  images keep their values and their orientation, in memory and in files
#include "text/image_file.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <map>

#include "base/cases.h"
#include "base/system_calls.h"
#include "film/variegated.h"
#include "text/complaint.h"
#include "text/folder.h"
#include "text/png.h"

TEST_CASE("a fresh image is NaN everywhere, and (x, y) counts from the top left, row by row") {
    Image image(3, 2);
    REQUIRE(image.pixels.size() == 6);
    bool all_nan = true;
    for (const Colour& pixel : image.pixels)
        for (float channel : pixel) all_nan = all_nan && std::isnan(channel);
    CHECK(all_nan);
    image.at(1, 0) = {1, 1, 1};
    image.at(0, 1) = {2, 2, 2};
    CHECK(image.pixels[1][0] == 1);
    CHECK(image.pixels[3][0] == 2);
}

TEST_CASE("the first pixel with a channel that is no finite number is found, row by row") {
    for (float bad : {NAN, INFINITY, -INFINITY})
        for (size_t c = 0; c < 3; ++c) {
            Image image(3, 2);
            image.pixels.assign(6, {1, 0, 3.4e38f});
            CHECK(!first_non_finite(image));
            image.at(0, 1)[c] = bad;
            CHECK(first_non_finite(image) == "0,1");
            image.at(2, 0)[c] = bad;
            CHECK(first_non_finite(image) == "2,0");
        }
}

TEST_CASE("a PFM is its header, then rows from the bottom up, little-endian") {
    const Folder folder;
    Image one(1, 1);
    one.at(0, 0) = {1, -2, 0.5f};            // 0x3f800000, 0xc0000000, 0x3f000000
    write_image(folder / "a.pfm", one, 17);  // exposure is for PNG
    CHECK(folder.read("a.pfm") ==
          std::string("PF\n1 1\n-1.0\n\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f", 24));

    Image four(2, 2);
    for (int i = 0; i < 4; ++i) four.pixels[size_t(i)] = {float(i), float(i), float(i)};
    write_image(folder / "a.pfm", four, 17);
    const std::string bytes = folder.read("a.pfm"), header = "PF\n2 2\n-1.0\n";
    REQUIRE(bytes.size() == header.size() + 48);
    CHECK(bytes.starts_with(header));
    std::array<float, 12> values;
    std::memcpy(values.data(), bytes.data() + header.size(), 48);
    CHECK(values == std::array<float, 12>{2, 2, 2, 3, 3, 3, 0, 0, 0, 1, 1, 1});
}

TEST_CASE("a Radiance file holds 8 bits of each channel and an exponent, from the top left") {
    const Folder folder;
    Image image(3, 2);
    image.at(0, 0) = {1, 0.5f, 0.25f};
    image.at(1, 0) = {-0.25f, 0.5f, 0};
    image.at(2, 0) = {-1, 3e38f, 0x1p126f};  // the nearest representable value
    image.at(0, 1) = {-3, -0.25f, -1e30f};
    image.at(1, 1) = {1e-30f, 255.99f, 256};
    image.at(2, 1) = {0x1p-149f, 0, 0};
    write_image(folder / "a.hdr", image, 17);  // exposure is for PNG
    const std::string bytes = folder.read("a.hdr"),
                      header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 3\n";
    REQUIRE(bytes.size() == header.size() + 24);
    CHECK(bytes.starts_with(header));
    CHECK(bytes.substr(header.size(), 4) == "\x80\x40\x20\x81");
    CHECK(bytes.substr(header.size() + 4, 4) == std::string("\0\x80\0\x80", 4));
    CHECK(bytes.substr(header.size() + 8, 4) == std::string("\0\xff\x80\xff", 4));
    CHECK(bytes.substr(header.size() + 12, 3) == std::string(3, '\0'));
    CHECK(bytes.substr(header.size() + 16, 4) == std::string("\0\x7f\x80\x89", 4));
    CHECK(bytes.substr(header.size() + 20, 3) == std::string(3, '\0'));
}

TEST_CASE("a Radiance file is what others read, each number at most 2^-7 of the greatest less") {
    for (int width : {1, 8, 300}) {  // decoders expect run lengths from 8 on
        Image image = variegated(width, 5);
        float scale = 1e-30f;
        for (Colour& pixel : image.pixels) {
            for (float& channel : pixel) channel = std::abs(channel) * scale;
            scale = scale > 1e30f ? 1e-30f : scale * 7;
        }
        const std::string bytes = encode_hdr(image);
        int w = 0, h = 0, channels = 0;
        float* read = stbi_loadf_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                             int(bytes.size()), &w, &h, &channels, 3);
        REQUIRE(read != nullptr);
        CHECK(w == width);
        CHECK(h == 5);
        bool near = true;
        for (size_t i = 0; i < image.pixels.size(); ++i) {
            const Colour& p = image.pixels[i];
            for (size_t c = 0; c < 3; ++c) {
                const float less = p[c] - read[3 * i + c];
                near = near && less >= 0 && less <= std::max({p[0], p[1], p[2]}) / 128;
            }
        }
        CHECK(near);
        stbi_image_free(read);
    }
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
        const double s = byte / 255.0;  // the standard's decoding, written independently
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
        CHECK(said(png.at(4, 0, 0), png.at(4, 0, 1), png.at(4, 0, 2)) == "255 0 255");
    }
}

TEST_CASE("a PFM is written row by row, for which no second picture is needed") {
    const Folder folder;
    const Image image = variegated(600, 400);
    const auto calls = calls_of({}, [&] { write_image(folder / "a.pfm", image, 1); });
    CHECK(std::count(calls.begin(), calls.end(), "write") == 401);  // a header, and rows
    CHECK(folder.read("a.pfm").size() == 16 + 12 * 600 * 400);
}

TEST_CASE("a picture that a PNG cannot hold is refused, before there is one") {
    auto refusal = [](Size size) { return complaint([&] { check_png("a.png", size); }); };
    CHECK(refusal({16384, 16384}) == "");
    CHECK(refusal({16384, 16385}) ==
          "a.png: 16384x16385 pixels are too many for a PNG, which holds 268435456; "
          "say -o FILE.pfm");
    CHECK(refusal({4096, 65536}) == "");
    CHECK(refusal({65536, 4097}) != "");
    CHECK(refusal({INT32_MAX, INT32_MAX}) != "");
}

TEST_CASE("a PNG for which there is no memory is an error, and no end of the program") {
#ifdef __SANITIZE_ADDRESS__
    MESSAGE("the address sanitizer needs more memory than that: not tested");
#else
    Image image(250, 350);
    float k = 0;
    for (Colour& pixel : image.pixels)  // incompressible noise
        for (float& channel : pixel) k = channel = std::fmod(k * 997 + 0.123f, 1.f);
    rlimit old_limit;
    REQUIRE(::getrlimit(RLIMIT_AS, &old_limit) == 0);
    auto allow_more = [&](rlim_t bytes) {  // beyond the current size of the process
        std::ifstream statm("/proc/self/statm");
        rlim_t pages = 0;
        statm >> pages;
        const rlim_t all = pages * rlim_t(::sysconf(_SC_PAGESIZE)) + bytes;
        const rlimit limit{all, old_limit.rlim_max};
        ::setrlimit(RLIMIT_AS, &limit);
    };
    const std::string expected = encode_png(image, 1);
    int written = 0, refused = 0;
    for (rlim_t room = 0; room < 2 << 20; room += 1 << 16) {
        std::vector<std::unique_ptr<char[]> > taken;  // takes freed memory, too
        taken.reserve(100000);
        allow_more(0);
        try {
            while (taken.size() < 100000) taken.push_back(std::make_unique<char[]>(1 << 16));
        } catch (const std::bad_alloc&) {
            if (!taken.empty()) taken.pop_back();  // allow_more reads a file
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
