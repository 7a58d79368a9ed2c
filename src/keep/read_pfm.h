// keep/read_pfm.h  1  images come back from PFM files, and are compared
#pragma once
#include <iomanip>

#include "base/vec.h"
#include "text/image_file.h"

namespace penumbra {

// Throws UserError if it is not a PFM file as write_image makes them.
inline Image read_pfm(const std::string& path) {
    std::ifstream in = open_file(path);
    std::string magic, width, height;
    double scale = 0;
    in >> std::setw(3) >> magic >> std::setw(20) >> width >> std::setw(20) >> height >> scale;
    if (in.get() < 0 || magic != "PF" || !(scale < 0))
        throw UserError(path + ": not a little-endian colour PFM file");
    Size size;
    try {
        size = parse_size(width, height);
    } catch (const UserError& e) {
        throw UserError(path + ": " + e.what());
    }
    auto refuse = [&] {
        throw UserError(path + ": " + width + "x" + height + " pixels do not fill the file");
    };
    const uint64_t numbers = std::filesystem::file_size(path) - uint64_t(in.tellg()),
                   row = uint64_t(size.width) * sizeof(Image::pixels[0]);
    if (numbers != row * uint64_t(size.height)) refuse();
    Image image(size.width, size.height);
    for (int y = size.height - 1; y >= 0; --y) {
        const std::span pixels(&image.at(0, y), size_t(size.width));
        if (read_from(in, path, std::as_writable_bytes(pixels)) != row) refuse();
    }
    return image;
}

// Relative RMSE over all channels of all pixels (Khodulev 1996, ch. 5).
inline double d_rel(const Image& truth, const Image& image) {
    double off = 0, all = 0;
    for (size_t i = 0; i < truth.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double f = double(truth.pixels[i][c]);
            off += sqr(double(image.pixels[i][c]) - f), all += sqr(f);
        }
    return std::sqrt(off / all);
}

}  // namespace penumbra
