// text/png.h  decodes PNG files
#pragma once
#include <doctest/doctest.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_HDR
#include <stb/stb_image.h>

#include <string>
#include <vector>

struct Decoded {
    int width = 0, height = 0;
    std::vector<int> bytes;  // three per pixel
    int at(int x, int y, int channel) const { return bytes[size_t(3 * (y * width + x) + channel)]; }
};

inline Decoded decode_png(const std::string& png) {
    Decoded d;
    int channels = 0;
    auto* bytes = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                                        int(png.size()), &d.width, &d.height, &channels, 0);
    REQUIRE(bytes != nullptr);
    REQUIRE(channels == 3);
    d.bytes.assign(bytes, bytes + 3 * d.width * d.height);
    stbi_image_free(bytes);
    return d;
}
