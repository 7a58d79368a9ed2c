// labs/trade_pixels.h  3  pictures for a page: where they are wrong in colours, their values in few
// bytes
//
// Both are relative to the reference's quadratic mean |f|, so that scenes of any brightness share
// one scale.
#pragma once
#include <cstdlib>

#include "base/vec.h"
#include "labs/maps.h"

// |f|, of all channels of all pixels; 1 if all are black, so that nothing is divided by it.
inline double quadratic_mean(const Image& f) {
    double sum = 0;
    for (const auto& pixel : f.pixels)
        for (float channel : pixel) sum += double(channel) * double(channel);
    return sum > 0 ? std::sqrt(sum / (3 * double(f.pixels.size()))) : 1;
}

// ---- Error maps --------------------------------------------------------------------------------

// Of a pixel; the quadratic mean of a picture's pixels is its d_rel.
inline double pixel_error(const std::array<float, 3>& f, const std::array<float, 3>& g,
                          double mean) {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
        const double difference = double(g[c]) - double(f[c]);
        sum += difference * difference;
    }
    return std::sqrt(sum / 3) / mean;
}

using Byte3 = std::array<uint8_t, 3>;

// Each colour is brighter than the one before, also to the colour-blind and on grey paper.
// Cubehelix (D. A. Green, A colour scheme for the display of astronomical intensity images, 2011)
// from blue by red to yellow: start 2.6, 0.7 rotations, hue 1.4.
inline Byte3 cubehelix(double t) {
    const double angle = 2 * pi * (2.6 / 3 + 0.7 * t), a = 1.4 * t * (1 - t) / 2;
    const double c = std::cos(angle), s = std::sin(angle);
    auto byte = [](double x) { return uint8_t(std::lround(255 * std::clamp(x, 0.0, 1.0))); };
    return {byte(t + a * (-0.14861 * c + 1.78277 * s)), byte(t + a * (-0.29227 * c - 0.90649 * s)),
            byte(t + a * 1.97294 * c)};
}

// All error maps of a page: sixteen steps from 0.1 % to all of |f|, equal in the logarithm; what is
// beyond an end has that end's colour, and what is no number has the last.
inline constexpr int error_levels = 16;
inline const Axis error_axis = {"", 1e-3, 1};
inline int error_level(double error) {
    const double place = error_levels * error_axis.part(error);
    return place < error_levels ? int(place) : error_levels - 1;
}
inline std::array<Byte3, error_levels> error_colours() {
    std::array<Byte3, error_levels> colours;
    for (size_t k = 0; k < error_levels; ++k)
        colours[k] = cubehelix((double(k) + 0.5) / error_levels);
    return colours;
}

// ---- PNG with sixteen colours (ISO/IEC 15948) --------------------------------------------------

// Most significant byte first.
inline std::string big_endian(uint32_t word) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += char(word >> shift & 255);
    return bytes;
}

inline uint32_t crc32(std::string_view bytes) {
    uint32_t crc = 0xffffffff;
    for (char byte : bytes) {
        crc ^= uint8_t(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

inline std::string png_chunk(const std::string& name, const std::string& data) {
    return big_endian(uint32_t(data.size())) + name + data + big_endian(crc32(name + data));
}

// Of half a byte a pixel, where encode_png needs three: errors are noise, which hardly shrinks.
inline std::string error_png(int width, int height, const std::vector<int>& levels) {
    std::string rows, palette;
    for (size_t y = 0; y < size_t(height); ++y) {
        rows += '\0';  // no filter
        const int* row = &levels[y * size_t(width)];
        for (int x = 0; x < width; x += 2)
            rows += char(row[x] << 4 | (x + 1 < width ? row[x + 1] : 0));
    }
    for (const Byte3& colour : error_colours())
        for (uint8_t channel : colour) palette += char(channel);
    int size = 0;
    auto* bytes = reinterpret_cast<unsigned char*>(rows.data());
    unsigned char* packed = stbi_zlib_compress(bytes, int(rows.size()), &size, 8);
    if (!packed) throw SystemError("out of memory for a PNG file");
    const std::string data(reinterpret_cast<const char*>(packed), size_t(size));
    std::free(packed);
    const std::string header = big_endian(uint32_t(width)) + big_endian(uint32_t(height)) +
                               std::string("\4\3\0\0\0", 5);  // 4 bits, an index each
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("PLTE", palette) +
           png_chunk("IDAT", data) + png_chunk("IEND", "");
}

inline std::string error_map(const Image& reference, const Image& picture, double mean) {
    std::vector<int> levels;
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        levels.push_back(error_level(pixel_error(reference.pixels[i], picture.pixels[i], mean)));
    return error_png(picture.width, picture.height, levels);
}

// ---- Values in four bytes a pixel --------------------------------------------------------------

using Channels = std::array<double, 3>;

// As RGB9E5 (OpenGL 3.0), but with signs: three mantissas of 9 bits m, from -255 to 255, from bit 0
// on, and one exponent of 5 bits e above them; a channel is m 2^(e-27).  Within 1/254 of the
// pixel's largest channel from 2^-20 to 4080; beyond that, 4080.
inline uint32_t pack_pixel(const Channels& x) {
    const double largest = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    int e = 0;
    while (e < 31 && std::lround(std::ldexp(std::min(largest, 1e6), 27 - e)) > 255) ++e;
    uint32_t word = uint32_t(e) << 27;
    for (size_t c = 0; c < 3; ++c) {
        const double m = std::clamp(std::ldexp(x[c], 27 - e), -255.0, 255.0);
        word |= (uint32_t(std::lround(m)) & 511) << (9 * c);
    }
    return word;
}

inline Channels unpack_pixel(uint32_t word) {
    Channels x;
    for (size_t c = 0; c < 3; ++c) {
        const int m = int(word >> (9 * c) & 511);
        x[c] = std::ldexp(m < 256 ? m : m - 512, int(word >> 27) - 27);
    }
    return x;
}

// Of (picture - reference) / mean, little-endian.  A difference keeps its digits where a value
// would not: at an error of 0.3 % all of it is the value's last bit.
inline std::string packed_pixels(const Image& picture, const Image& reference, double mean) {
    std::string bytes;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        Channels x;
        for (size_t c = 0; c < 3; ++c)
            x[c] = (double(picture.pixels[i][c]) - double(reference.pixels[i][c])) / mean;
        const uint32_t word = pack_pixel(x);
        for (int shift = 0; shift < 32; shift += 8) bytes += char(word >> shift & 255);
    }
    return bytes;
}

inline Image black(int width, int height) {
    return painted(width, height, [](int, int) { return Colour{0, 0, 0}; });
}

// ---- Fewer pixels ------------------------------------------------------------------------------

// So many pixels of a picture are on the page, at most.
inline constexpr int most_pixels = 8192;

// Every how many-th pixel of every so many-th row that leaves.
inline int thinning(const Image& image) {
    int n = 1;
    while ((image.width / n) * (image.height / n) > most_pixels) ++n;
    return n;
}

// Those pixels, as they are: an average of pixels would have less noise than was measured.
inline Image thinned(const Image& image, int n) {
    return painted(image.width / n, image.height / n,
                   [&](int x, int y) { return image.at(n * x + n / 2, n * y + n / 2); });
}
