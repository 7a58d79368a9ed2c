// film/image.h  1  images, and the files they come from and go to
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

// What stb asserts is that it got the memory it asked for.
#define STBIW_ASSERT(condition) ((condition) ? void() : throw std::bad_alloc())
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include "base/files.h"
#include "base/vec.h"

// Row by row from the top left pixel (0,0); linear values.  Starts as NaN, so that a pixel nobody
// wrote is an error and not a black dot.
struct Image {
    int width = 0, height = 0;
    std::vector<std::array<float, 3>> pixels;

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(size_t(w) * size_t(h), {NAN, NAN, NAN}) {}
    std::array<float, 3>& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    const std::array<float, 3>& at(int x, int y) const {
        return pixels[size_t(y) * size_t(width) + size_t(x)];
    }
};

// The first pixel, "x,y", that holds what is no finite number.
inline std::optional<std::string> first_non_finite(const Image& image) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (float channel : image.at(x, y))
                if (!std::isfinite(channel)) return std::to_string(x) + "," + std::to_string(y);
    return {};
}

// ---- PFM: linear float, bottom row first, little-endian ---------------------------------------

static_assert(std::endian::native == std::endian::little, "PFM is written as memory holds it");

inline std::string pfm_header(Size size) {
    return "PF\n" + std::to_string(size.width) + " " + std::to_string(size.height) + "\n-1.0\n";
}

// Hands the bytes of the file to `take`, row by row.
void give_pfm(const Image& image, auto take) {
    const std::string header = pfm_header({image.width, image.height});
    take(header.data(), header.size());
    for (int y = image.height - 1; y >= 0; --y)
        take(&image.at(0, y), size_t(image.width) * sizeof image.at(0, 0));
}

inline std::string encode_pfm(const Image& image) {
    std::string bytes;
    give_pfm(image, [&](const void* piece, size_t size) {
        bytes.append(static_cast<const char*>(piece), size);
    });
    return bytes;
}

inline Image read_pfm(const std::string& path) {
    const InputFile in(path);
    std::string start(1000, '\0');  // no header is longer
    start.resize(in.read(start.data(), start.size()));
    std::istringstream header(start);
    std::string magic, width, height;
    double scale = 0;
    header >> magic >> width >> height >> scale;
    if (!header || header.eof() || magic != "PF" || !(scale < 0))
        throw UserError(path + ": not a little-endian colour PFM file");
    Size size;
    try {
        size = parse_size(width, height);
    } catch (const UserError& e) {
        throw UserError(path + ": " + e.what());
    }
    const size_t pixels = size_t(header.tellg()) + 1,
                 row = size_t(size.width) * sizeof(Image::pixels[0]);
    auto refuse = [&] {
        throw UserError(path + ": " + width + "x" + height + " pixels do not fill the file");
    };
    if (in.size() != pixels + row * size_t(size.height)) refuse();
    Image image(size.width, size.height);
    in.go_to(pixels);
    for (int y = size.height - 1; y >= 0; --y)
        if (in.read(&image.at(0, y), row) != row) refuse();
    return image;
}

// ---- PNG: exposure, clamp, sRGB; nothing automatic --------------------------------------------

// Linear to sRGB (IEC 61966-2-1), both in [0,1].
inline double encode_srgb(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

inline uint8_t to_byte(double linear) {
    return uint8_t(255 * encode_srgb(std::clamp(linear, 0.0, 1.0)) + 0.5);
}

// Bytes of rows, each with one for its filter, that stb_image_write can take of any picture.  It
// counts in int: its buffer of what is compressed doubles to 3 * 2^29 - 1 bytes and no further.
// Every byte takes up to 9 bits in its code; 10 bits stand around them, 2 bytes before, and one is
// never filled.  Measured with bytes of 9 bits: this many succeed, one more fails.  21845x21845
// pixels of noise are read back right by libpng.
inline constexpr int64_t most_png_bytes = (8 * ((int64_t(3) << 29) - 1 - 1 - 2) - 10) / 9;

// Throws UserError if a picture is too large for a PNG file, "NAME: why".
inline void check_png(const std::string& name, Size size) {
    if (size.height > most_png_bytes / (3 * int64_t(size.width) + 1))
        throw UserError(name + ": " + std::to_string(size.width) + "x" +
                        std::to_string(size.height) +
                        " pixels are too many for a PNG, which holds " +
                        std::to_string(most_png_bytes / 3) + "; say -o FILE.pfm");
}

// The bytes of a file, where the library has put them.
struct Png {
    std::unique_ptr<unsigned char, void (*)(void*)> bytes;
    size_t size;
    std::string_view view() const { return {reinterpret_cast<const char*>(bytes.get()), size}; }
};

inline Png png_of(const std::vector<uint8_t>& rgb8, Size image) {
    check_png("PNG", image);
    int size = 0;
    auto* bytes = stbi_write_png_to_mem(rgb8.data(), 0, image.width, image.height, 3, &size);
    if (!bytes) throw std::bad_alloc();
    return {{bytes, std::free}, size_t(size)};
}

inline Png png_of(const Image& image, double exposure) {
    std::vector<uint8_t> rgb8;
    rgb8.reserve(3 * image.pixels.size());
    for (const auto& pixel : image.pixels)
        for (float channel : pixel) rgb8.push_back(to_byte(exposure * double(channel)));
    return png_of(rgb8, {image.width, image.height});
}

inline std::string encode_png(const Image& image, double exposure) {
    return std::string(png_of(image, exposure).view());
}

// By the ending of `path`: .png or .pfm.
inline void write_image(const std::string& path, const Image& image, double exposure) {
    if (!path.ends_with(".pfm")) return write_file(path, png_of(image, exposure).view());
    OutputFile file(path);
    give_pfm(image, [&](const void* piece, size_t size) { file.write(piece, size); });
    file.commit();
}
