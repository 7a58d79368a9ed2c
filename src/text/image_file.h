// text/image_file.h  3  the files of images: PNG, Radiance HDR and PFM
#pragma once
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <optional>
#include <string>

// stb asserts only that memory was allocated.
#define STBIW_ASSERT(condition) ((condition) ? void() : throw std::bad_alloc())
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include "base/portable.h"
#include "film/image.h"
#include "text/files.h"

namespace penumbra {

// The first pixel, "x,y", that is not finite.
inline std::optional<std::string> first_non_finite(const Image& image) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (float channel : image.at(x, y))
                if (!std::isfinite(channel)) return std::to_string(x) + "," + std::to_string(y);
    return {};
}

// Linear to sRGB (IEC 61966-2-1), both in [0,1].
inline double encode_srgb(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * portable::pow(x, 1 / 2.4) - 0.055;
}

inline uint8_t to_byte(double linear) {
    return uint8_t(255 * encode_srgb(std::clamp(linear, 0.0, 1.0)) + 0.5);
}

// Throws UserError if a picture is too large for a PNG file, "NAME: why".  stb_image_write counts
// bytes in int.  2^28 pixels are 3 * 2^28 bytes, and one for each of at most 2^16 rows.  A byte
// takes up to 9 bits when it is compressed: all of them less than 2^30 bytes, and the buffer for
// them, which doubles, less than 2^31.
inline void check_png(const std::string& name, Size size) {
    constexpr int64_t most = 1 << 28;
    if (int64_t(size.width) * size.height > most)
        throw UserError(name + ": " + std::to_string(size.width) + "x" +
                        std::to_string(size.height) +
                        " pixels are too many for a PNG, which holds " + std::to_string(most) +
                        "; say -o FILE.pfm");
}

// The bytes of a PNG file: exposure, clamp, sRGB; nothing automatic.
inline std::string encode_png(const Image& image, double exposure) {
    check_png("PNG", {image.width, image.height});
    std::vector<uint8_t> rgb8;
    rgb8.reserve(3 * image.pixels.size());
    for (const auto& pixel : image.pixels)
        for (float channel : pixel) rgb8.push_back(to_byte(exposure * double(channel)));
    int size = 0;
    const std::unique_ptr<uint8_t, void (*)(void*)> bytes(
        stbi_write_png_to_mem(rgb8.data(), 0, image.width, image.height, 3, &size), std::free);
    if (!bytes) throw std::bad_alloc();
    return std::string(bytes.get(), bytes.get() + size);
}

// The bytes of a Radiance file (Ward 1991): linear; the greatest channel has the exponent, each 8
// bits, rounded down.  Numbers below 0 become 0, those above 2^127 (1 - 2^-8) that.
inline std::string encode_hdr(const Image& image) {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) +
                        " +X " + std::to_string(image.width) + "\n";
    bytes.reserve(bytes.size() + 4 * image.pixels.size());
    for (const auto& pixel : image.pixels) {
        int exponent = 0;
        std::frexp(std::clamp(std::max({pixel[0], pixel[1], pixel[2]}), 0x1p-127f, 0x1.fep126f),
                   &exponent);
        for (float channel : pixel)
            bytes += char(uint8_t(std::clamp(std::ldexp(channel, 8 - exponent), 0.f, 255.f)));
        bytes += char(exponent + 128);
    }
    return bytes;
}

// The ending of `path` chooses the format: .png, .hdr, or .pfm, which is linear float,
// little-endian, with the bottom row first.
inline void write_image(const std::string& path, const Image& image, double exposure) {
    static_assert(std::endian::native == std::endian::little);
    if (path.ends_with(".hdr")) return write_file(path, encode_hdr(image));
    if (!path.ends_with(".pfm")) return write_file(path, encode_png(image, exposure));
    const std::string header =
        "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
    Pieces pieces = {std::as_bytes(std::span(header))};
    for (int y = image.height - 1; y >= 0; --y)
        pieces.push_back(std::as_bytes(std::span(&image.at(0, y), size_t(image.width))));
    write_file(path, pieces);
}

}  // namespace penumbra
