// app/outputs.h  3  output files: checked before the render, written after it
#pragma once
#include <set>

#include "app/report.h"
#include "app/views.h"
#include "text/image_file.h"

namespace penumbra {

// Images to write: those that the user named, or `stem`.png and .pfm, with the scene's name for
// NAME; none if `stem` is empty.  Throws UserError if one of these files, of `others` or of --stats
// cannot be written, is one that is `used`, comes twice, or cannot hold so many pixels.
inline std::vector<std::string> outputs_of(const CommonOptions& o, std::string stem,
                                           const std::vector<std::string>& used,
                                           const std::vector<std::string>& others, Size size) {
    std::vector<std::string> outputs = o.outputs;
    if (outputs.empty() && !stem.empty()) {
        stem.replace(stem.find("NAME"), 4, std::filesystem::path(o.scene).stem().string());
        outputs = {stem + ".png", stem + ".pfm"};
    }
    std::vector<std::string> written = others;
    written.insert(written.end(), outputs.begin(), outputs.end());
    if (!o.stats.empty()) written.push_back(o.stats);
    std::set<std::string> names;
    for (const std::string& path : used) names.insert(true_name(path));
    for (const std::string& path : written) {
        if (path.ends_with(".png")) check_png(path, size);
        if (!names.insert(true_name(path)).second)
            throw UserError(path + ": would replace another file of this run");
    }
    std::error_code failed;
    if (outputs != o.outputs && (std::filesystem::create_directories("out", failed), failed))
        throw UserError("out: cannot make this directory: " + failed.message());
    for (const std::string& path : written) check_writable(path);
    return outputs;
}

// Writes one picture to every file; a PNG gets these shades.  Throws SystemError, before it writes
// any, if a pixel is too bright for a file.
inline void write_images(const std::vector<std::string>& paths, const Image& picture,
                         double exposure, Shades shades = Shades::as_they_are) {
    if (const auto at = first_non_finite(picture))
        throw SystemError("pixel " + *at + " is more than a file can hold; nothing was written");
    for (const std::string& path : paths)
        if (path.ends_with(".png") && shades != Shades::as_they_are)
            write_image(path, scaled(picture, shades), exposure);
        else
            write_image(path, picture, exposure);
}

inline void tell_written(const CommonOptions& o, std::vector<std::string> files) {
    if (!o.stats.empty()) files.push_back(o.stats);
    std::string names;
    for (const std::string& path : files) names += (names.empty() ? "" : ", ") + path;
    tell(o, "wrote " + names);
}

// With a hint at the most frequent reason.
inline void tell_black(const CommonOptions& o) {
    tell(o, o.scene +
                ": the image is black: no light reaches the camera (lights emit on one side "
                "only, unless they are twosided)");
}

}  // namespace penumbra
