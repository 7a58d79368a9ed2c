// base/files.h  2  files: read whole, written whole or not at all
#pragma once
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/words.h"

inline std::string aside(const std::string& path) {
    return path + ".part" + std::to_string(::getpid());
}

// Throws UserError if `path` could not be written; leaves nothing behind.
inline void check_writable(const std::string& path) {
    std::error_code unreachable;
    if (std::filesystem::is_directory(path, unreachable))
        throw UserError(path + ": is a directory");
    std::FILE* file = std::fopen(aside(path).c_str(), "wb");
    if (!file) throw UserError(path + ": cannot write: " + std::strerror(errno));
    std::fclose(file);
    std::remove(aside(path).c_str());
}

// Writes beside `path` and renames, so that a reader never sees half a file.
inline void write_file(const std::string& path, const std::string& bytes) {
    const std::string part = aside(path);
    std::FILE* file = std::fopen(part.c_str(), "wb");
    bool ok = file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (file) ok = std::fclose(file) == 0 && ok;
    if (ok && std::rename(part.c_str(), path.c_str()) == 0) return;
    std::string why = std::strerror(errno);
    std::remove(part.c_str());
    throw SystemError(path + ": cannot write: " + why);
}

// The bytes of a file; throws UserError if there are none to be had.
inline std::string read_file(const std::string& path) {
    std::error_code unreachable;
    if (std::filesystem::is_directory(path, unreachable))
        throw UserError(path + ": is a directory");
    std::ifstream in(path, std::ios::binary);
    if (!in) throw UserError(path + ": cannot open: " + std::strerror(errno));
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}
