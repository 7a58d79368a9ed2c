// app/outputs.h  2  the files that a program leaves: checked before it renders, written after it
#pragma once
#include <set>

#include "app/report.h"
#include "film/image.h"

// Images to write: those that were asked for, or `stem`.png and .pfm, where NAME is the scene's;
// none if it is empty.  Throws UserError if one of all the files (`others`, too) cannot be written,
// would replace another or what is `used`, or has no room for the picture.
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

// Writes one picture to every file; throws SystemError, before it writes any, if there is a pixel
// that files do not hold.
inline void write_images(const std::vector<std::string>& paths, const Image& picture,
                         double exposure) {
    if (const auto at = first_non_finite(picture))
        throw SystemError("pixel " + *at + " is more than a file can hold; nothing was written");
    for (const std::string& path : paths) write_image(path, picture, exposure);
}

// Says which files were written.
inline void tell_written(const CommonOptions& o, std::vector<std::string> files) {
    if (!o.stats.empty()) files.push_back(o.stats);
    std::string names;
    for (const std::string& path : files) names += (names.empty() ? "" : ", ") + path;
    tell(o, "wrote " + names);
}

// A hint at the most frequent reason.
inline void tell_black(const CommonOptions& o) {
    tell(o, o.scene + ": all is black: no light reaches the camera (lights emit on one side " +
                "only, unless they are twosided)");
}
