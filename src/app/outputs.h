// app/outputs.h  2  what programs leave: lines on stderr, images and statistics in files
#pragma once
#include "app/option.h"
#include "film/image.h"

inline void tell(const CommonOptions& o, const std::string& line) {
    if (!o.quiet) std::fprintf(stderr, "%s\n", printable(line).c_str());
}

// Files of a program, and what they are to it.
struct UsedFiles {
    std::vector<std::string> paths;
    std::string use = "part of the scene";
};

// Throws UserError if two different things would have the name of one file, or one would replace
// what is used otherwise.
inline void check_names(const std::vector<std::string>& images, const std::string& stats,
                        const std::vector<UsedFiles>& used) {
    std::map<std::string, std::string> use;  // of a file
    auto check = [&](const std::string& path, const std::string& as) {
        const auto [place, is_new] = use.try_emplace(true_name(path), as);
        if (!is_new && place->second != as)
            throw UserError(path + ": cannot be both " + place->second + " and " + as);
    };
    for (const UsedFiles& files : used)
        for (const std::string& path : files.paths) check(path, files.use);
    for (const std::string& path : images)
        check(path, "a " + path.substr(path.size() - 4) + " image");
    if (!stats.empty()) check(stats, "the statistics");
}

// Throws UserError if a picture of this size has no room in one of the images.
inline void check_size(const std::vector<std::string>& images, Size size) {
    for (const std::string& path : images)
        if (path.ends_with(".png")) check_png(path, size);
}

// Images to write, out/NAMEsuffix.png and .pfm unless others were asked for; throws UserError if
// one of the files cannot be written, or has no room for the picture.
inline std::vector<std::string> outputs_of(const CommonOptions& o, const std::string& suffix,
                                           const std::vector<UsedFiles>& used, Size size) {
    std::vector<std::string> outputs = o.outputs;
    std::error_code failed;
    if (outputs.empty()) {
        const std::string stem = "out/" + std::filesystem::path(o.scene).stem().string() + suffix;
        outputs = {stem + ".png", stem + ".pfm"};
    }
    check_size(outputs, size);
    if (o.outputs.empty())
        if (std::filesystem::create_directories("out", failed), failed)
            throw UserError("out: cannot make this directory: " + failed.message());
    check_names(outputs, o.stats, used);
    for (const std::string& path : outputs) check_writable(path);
    if (!o.stats.empty()) check_writable(o.stats);
    return outputs;
}

// Writes one picture to every file; throws SystemError, before it writes any, if there is a pixel
// that files do not hold.
inline void write_images(const std::vector<std::string>& paths, const Image& picture,
                         real exposure) {
    if (const auto at = first_non_finite(picture))
        throw SystemError("pixel " + *at + " is more than a file can hold; nothing was written");
    for (const std::string& path : paths) write_image(path, picture, double(exposure));
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
