// text/folder.h  a temporary folder for a test's files
#pragma once
#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "text/files.h"

namespace penumbra {

namespace fs = std::filesystem;

// A temporary folder; the destructor removes it.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "penumbra-test-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }

    std::string operator/(const std::string& name) const { return (path / name).string(); }
    void write(const std::string& name, const std::string& bytes) const {
        fs::create_directories((path / name).parent_path());
        std::ofstream(path / name, std::ios::binary) << bytes;
    }
    bool has(const std::string& name) const { return fs::exists(path / name); }
    std::string read(const std::string& name) const {
        REQUIRE(has(name));
        return read_file(*this / name);
    }
    // Compares two files; a failed CHECK prints no bytes.
    bool same(const std::string& a, const std::string& b) const { return read(a) == read(b); }
    // Returns all files with their bytes; links count as the files that they lead to.
    std::map<std::string, std::string> all() const {
        std::map<std::string, std::string> found;
        for (const auto& entry : fs::recursive_directory_iterator(path))
            found[entry.path().lexically_relative(path).string()] =
                entry.is_symlink()        ? "-> " + fs::read_symlink(entry.path()).string()
                : entry.is_regular_file() ? read_file(entry.path().string())
                                          : "no regular file";
        return found;
    }
    size_t files() const { return all().size(); }
};

}  // namespace penumbra

using namespace penumbra;
