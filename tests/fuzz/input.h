// fuzz/input.h  how targets interpret their bytes, and how they report what is broken
#pragma once
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "text/words.h"

namespace penumbra::fuzz {

// A violated invariant.  Nothing catches it: a fuzzer reports a crash, a test fails.
struct Broken : std::logic_error {
    using std::logic_error::logic_error;
};
inline void demand(bool holds, const std::string& what) {
    if (!holds) throw Broken(what);
}

// ---- Files --------------------------------------------------------------------------------------

// A folder of this process, removed when the process ends.
class Place {
public:
    Place() {
        std::string name =
            (std::filesystem::temp_directory_path() / "penumbra-fuzz-XXXXXX").string();
        demand(::mkdtemp(name.data()) != nullptr, "no folder for files");
        path_ = name;
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::string operator/(std::string_view name) const { return (path_ / name).string(); }
    void write(std::string_view name, std::string_view bytes) const {
        std::FILE* file = std::fopen((*this / name).c_str(), "wb");
        const bool ok = file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
        demand(file && std::fclose(file) == 0 && ok, "cannot write a file");
    }

private:
    std::filesystem::path path_;
};
inline const Place& place() {
    static const Place p;
    return p;
}

// The files of an input: a line "=== NAME" begins the next one.
using Bundle = std::map<std::string, std::string_view>;
inline Bundle bundle(std::string_view input, const std::string& first) {
    constexpr std::string_view mark = "=== ";
    Bundle files;
    std::string name = first;
    for (size_t start = 0;;) {
        size_t end = start;
        while (end < input.size() && input.substr(end, mark.size()) != mark) {
            end = input.find('\n', end);
            end = end == input.npos ? input.size() : end + 1;
        }
        files[name] = input.substr(start, end - start);
        if (end == input.size()) return files;
        const size_t line = std::min(input.find('\n', end), input.size());
        name = input.substr(end + mark.size(), line - end - mark.size());
        start = std::min(line + 1, input.size());
    }
}

// Writes the mesh of a scene, m.obj, and its materials, m.mtl; no others.
inline void write_meshes(const Bundle& files) {
    for (const char* name : {"m.obj", "m.mtl"}) {
        const auto found = files.find(name);
        place().write(name, found == files.end() ? "" : found->second);
    }
}

// Inputs that fuzzers begin with, by their names.  In tests/fuzz/seeds/TARGET a line "@@ NAME"
// begins one, \x41 is a byte, and a backslash at its end joins a line to the next.
inline std::map<std::string, std::string> seeds_of(const std::string& target) {
    std::map<std::string, std::string> seeds;
    std::string* seed = nullptr;
    std::ifstream file("tests/fuzz/seeds/" + target);
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("@@ ")) {
            seed = &seeds[line.substr(3)];
            continue;
        }
        line += '\n';
        for (size_t i = 0; i < line.size(); ++i) {
            if (line[i] != '\\')
                *seed += line[i];
            else if (line[++i] == 'x')
                *seed += char(std::stoi(line.substr(i + 1, 2), nullptr, 16)), i += 2;
        }
    }
    return seeds;
}

// ---- Choices ------------------------------------------------------------------------------------

// Consumes bytes one by one; after the end all are zero.
class Choices {
public:
    explicit Choices(std::string_view bytes) : rest_(bytes) {}
    bool empty() const { return rest_.empty(); }
    unsigned byte() {
        if (rest_.empty()) return 0;
        const auto b = static_cast<unsigned char>(rest_.front());
        rest_.remove_prefix(1);
        return b;
    }
    unsigned below(unsigned n) { return byte() % n; }
    bool rarely() { return byte() > 223; }
    template <size_t n>
    std::string of(const char* const (&words)[n]) {
        return words[below(unsigned(n))];
    }

private:
    std::string_view rest_;
};

}  // namespace penumbra::fuzz
