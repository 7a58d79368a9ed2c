// text/files.h  2  files, read whole and written
//
// They are written whole or not at all, even if the power fails, if -DWITH_KEEP: with src/keep.
#pragma once
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "text/words.h"

namespace penumbra {

// What a film is of, for the head of its file.
struct FilmOf {
    std::vector<std::string> files;  // of the scene's meshes
    Facts samples, notes;            // facts that samples depend on, and other facts
    std::string scene = {};          // its text as it was read: a pipe has no second reading
};

// ---- Reading ------------------------------------------------------------------------------------

// Opens a regular file, or, `of_any_kind`, also a pipe, which may block, or a device, which may
// never end.  Throws UserError if it cannot be opened.
inline std::ifstream open_file(const std::string& path, bool of_any_kind = false) {
    std::error_code unreachable;
    const auto status = std::filesystem::status(path, unreachable);
    if (std::filesystem::is_directory(status)) throw UserError(path + ": is a directory");
    if (std::filesystem::is_other(status) && !of_any_kind)
        throw UserError(path + ": is not a regular file");
    std::ifstream in(path, std::ios::binary);
    if (!in) throw UserError(path + ": cannot open: " + std::strerror(errno));
    return in;
}

// Returns the number of bytes read.  It is less than asked for only at the end.
inline size_t read_from(std::istream& in, const std::string& path, std::span<std::byte> bytes) {
    in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (in.bad()) throw SystemError(path + ": cannot read: " + std::strerror(errno));
    return size_t(in.gcount());
}

// The whole file.  Files of /proc have no known length, and a device may never end.
inline std::string read_file(const std::string& path, bool of_any_kind = false,
                             size_t most = 1 << 30) {
    std::ifstream in = open_file(path, of_any_kind);
    std::string bytes, piece(1 << 16, '\0');
    while (const size_t n = read_from(in, path, std::as_writable_bytes(std::span(piece)))) {
        bytes.append(piece, 0, n);
        if (bytes.size() > most)
            throw UserError(path + ": is longer than " + std::to_string(most) + " bytes");
    }
    return bytes;
}

// ---- Names --------------------------------------------------------------------------------------

// A unique name of a file, with links resolved.
inline std::string true_name(const std::string& path) {
    std::error_code unreachable;
    const auto name = std::filesystem::absolute(path, unreachable);
    const auto plain = std::filesystem::weakly_canonical(name, unreachable);
    return unreachable ? path : plain.string();
}

// ---- Writing ------------------------------------------------------------------------------------

// Bytes that follow each other in a file.
using Pieces = std::vector<std::span<const std::byte>>;

// Throws UserError if `path` could not be written; leaves nothing behind.
inline void check_writable(const std::string& path);

// Throws SystemError on any failure.
inline void write_file(const std::string& path, const Pieces& pieces);
inline void write_file(const std::string& path, std::string_view bytes) {
    write_file(path, Pieces{std::as_bytes(std::span(bytes))});
}

}  // namespace penumbra

#ifdef WITH_KEEP
#include "keep/durable.h"
#else
namespace penumbra {
inline void check_writable(const std::string& path) {
    std::error_code ignored;
    const auto status = std::filesystem::symlink_status(path, ignored);
    if (std::filesystem::is_symlink(status) || std::filesystem::is_other(status)) return;
    const bool is_new = !std::filesystem::exists(status);
    if (!std::ofstream(path, std::ios::app))
        throw UserError(path + ": cannot write: " + std::strerror(errno));
    if (is_new) std::filesystem::remove(path, ignored);
}
inline void write_file(const std::string& path, const Pieces& pieces) {
    std::ofstream out(path, std::ios::binary);
    for (const auto& piece : pieces)
        out.write(reinterpret_cast<const char*>(piece.data()), std::streamsize(piece.size()));
    if (!out.flush()) throw SystemError(path + ": cannot write: " + std::strerror(errno));
}
}  // namespace penumbra
#endif
