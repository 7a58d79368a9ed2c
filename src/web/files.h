// web/files.h  1  what text/files.h is in a browser: files that the page has handed over
//
// src/web/web.mk puts this file in the place of src/text/files.h.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <vector>

// No operation of a file system is declared where there is none.
namespace std {
struct thread {
    static unsigned hardware_concurrency() { return 1; }
};
}  // namespace std

#include "text/words.h"

namespace penumbra {

// By their plain names: "build/knot.obj" is also "scenes/../build/knot.obj".
inline std::map<std::string, std::string> files_of_page;
inline std::string plain_name(const std::filesystem::path& path) {
    return path.lexically_normal().string();
}

inline std::string read_file(const std::string& path, bool = false, size_t = 0) {
    const auto found = files_of_page.find(plain_name(path));
    if (found == files_of_page.end()) throw UserError(path + ": the page has no such file");
    return found->second;
}

}  // namespace penumbra

namespace std::filesystem {
inline bool exists(const path& path) {
    return penumbra::files_of_page.contains(penumbra::plain_name(path));
}
inline bool is_regular_file(const path& path, error_code&) { return exists(path); }
}  // namespace std::filesystem
