// film/image.h  1  images, and the files they come from and go to
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

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

inline std::string encode_pfm(const Image& image) {
    std::string bytes =
        "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
    for (int y = image.height - 1; y >= 0; --y)
        bytes.append(reinterpret_cast<const char*>(&image.at(0, y)),
                     size_t(image.width) * sizeof image.at(0, 0));
    return bytes;
}

inline Image read_pfm(const std::string& path) {
    const std::string bytes = read_file(path);
    std::istringstream header(bytes);
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
    Image image(size.width, size.height);
    const size_t start = size_t(header.tellg()) + 1,
                 row = size_t(size.width) * sizeof image.at(0, 0);
    if (bytes.size() != start + row * size_t(size.height))
        throw UserError(path + ": " + width + "x" + height + " pixels do not fill the file");
    for (int y = 0; y < size.height; ++y)
        std::memcpy(&image.at(0, size.height - 1 - y), bytes.data() + start + row * size_t(y), row);
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

inline std::string encode_png(const Image& image, double exposure) {
    std::vector<uint8_t> rgb8;
    for (const auto& pixel : image.pixels)
        for (float channel : pixel) rgb8.push_back(to_byte(exposure * double(channel)));
    std::string bytes;
    auto append = [](void* out, void* data, int size) {
        static_cast<std::string*>(out)->append(static_cast<const char*>(data), size_t(size));
    };
    if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, rgb8.data(), 0))
        throw SystemError("out of memory for a PNG file");
    return bytes;
}

// By the ending of `path`: .png or .pfm.
inline void write_image(const std::string& path, const Image& image, double exposure) {
    write_file(path, path.ends_with(".pfm") ? encode_pfm(image) : encode_png(image, exposure));
}
