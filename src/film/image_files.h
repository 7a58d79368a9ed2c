// film/image_files.h  2  one picture in several files, row by row, so that memory need not hold it
#pragma once
#include <memory>
#include <set>

#include "film/image.h"

class ImageFiles {
public:
    // By the endings of `paths`: .pfm, of which no row is kept, or .png, which keeps 3 bytes a
    // pixel.
    ImageFiles(const std::vector<std::string>& paths, Size size, double exposure)
        : paths_(different(paths)), size_(size), exposure_(exposure) {
        const std::string header = pfm_header(size);
        for (const std::string& path : paths_)
            if (path.ends_with(".pfm")) {
                pfm_.push_back(std::make_unique<OutputFile>(path));
                pfm_.back()->write_at(0, header.data(), header.size());
            } else {
                rgb8_.resize(3 * size_t(size.width) * size_t(size.height));
            }
    }

    // Row y, from the top; in any order, each once.  Throws SystemError if a file cannot hold it.
    void add(int y, const std::vector<std::array<float, 3>>& row) {
        for (size_t x = 0; x < row.size(); ++x)
            for (float channel : row[x])
                if (!std::isfinite(channel))
                    throw SystemError("pixel " + std::to_string(x) + "," + std::to_string(y) +
                                      " is more than a file can hold; nothing was written");
        const size_t bytes = row.size() * sizeof row[0];
        const uint64_t below = uint64_t(size_.height - 1 - y);
        for (const auto& file : pfm_)
            file->write_at(pfm_header(size_).size() + below * bytes, row.data(), bytes);
        if (rgb8_.empty()) return;
        size_t at = 3 * size_t(y) * size_t(size_.width);
        for (const auto& pixel : row)
            for (float channel : pixel) rgb8_[at++] = to_byte(exposure_ * double(channel));
    }

    void commit() {
        for (const auto& file : pfm_) file->commit();
        for (const std::string& path : paths_)
            if (!path.ends_with(".pfm")) write_file(path, png_of(rgb8_, size_).view());
    }

private:
    const std::vector<std::string> paths_;
    const Size size_;
    const double exposure_;
    std::vector<std::unique_ptr<OutputFile>> pfm_;
    std::vector<uint8_t> rgb8_;

    // One file may have two names, or be asked for twice.
    static std::vector<std::string> different(const std::vector<std::string>& paths) {
        std::set<std::string> names;
        std::vector<std::string> once;
        for (const std::string& path : paths)
            if (names.insert(true_name(path)).second) once.push_back(path);
        return once;
    }
};
