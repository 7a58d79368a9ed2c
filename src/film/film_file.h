// film/film_file.h  2  .film files: a head that says what is in them, numbers, and a checksum
//
//     penumbra film 1                    what it is, and the version of this format
//     bytes 00000000000000001536         of numbers, after the head
//     checksum 0f1e2d3c4b5a6978          of all that follows this line
//     scene scenes/cube.scene            KEY VALUE: what the writer says of them
//     ...
//                                        an empty line
//     numbers, as memory holds them: little-endian
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/rng.h"

static_assert(std::endian::native == std::endian::little,
              "numbers are written as memory holds them");

// ---- The checksum -------------------------------------------------------------------------------

// Of bytes, in any pieces: s <- mix((s ^ w) + golden) for each word w of 8 of them, the last one
// filled with zeros, and for their number.  A step is a bijection of s for any w, and of w for any
// s: if one word alone is damaged, by however many bits, the sum differs for certain.  If more are,
// it is the same with a probability of 2^-64.  No proof against forgery.
class Checksum {
public:
    void add(const void* bytes, size_t size) {
        if (size == 0) return;
        auto* from = static_cast<const unsigned char*>(bytes);
        const auto* const end = from + size;
        const size_t waiting = bytes_ % 8;
        bytes_ += size;
        if (waiting > 0) {
            const size_t n = std::min(8 - waiting, size);
            std::memcpy(reinterpret_cast<unsigned char*>(&word_) + waiting, from, n);
            if (waiting + n < 8) return;
            fold(std::exchange(word_, 0));
            from += n;
        }
        for (; end - from >= 8; from += 8) {
            uint64_t word;
            std::memcpy(&word, from, 8);
            fold(word);
        }
        std::memcpy(&word_, from, size_t(end - from));
    }
    uint64_t value() const {
        Checksum all = *this;
        if (all.bytes_ % 8 > 0) all.fold(all.word_);
        all.fold(all.bytes_);
        return all.sum_;
    }

private:
    uint64_t sum_ = 0, word_ = 0, bytes_ = 0;
    void fold(uint64_t word) { sum_ = mix((sum_ ^ word) + golden); }
};

// ---- The head -----------------------------------------------------------------------------------

// Keys and their values, in the order in which they were set.
struct FilmHeader {
    std::vector<std::pair<std::string, std::string>> entries;

    std::optional<std::string> find(std::string_view key) const {
        for (const auto& [k, value] : entries)
            if (k == key) return value;
        return {};
    }
    // A key is a word; a value is what stands on one line.
    void set(const std::string& key, const std::string& value) {
        if (key.empty() || key.find_first_of(" \n") != key.npos || value.find('\n') != value.npos)
            throw UserError(in_quotes(key + " " + value) + " is no line of a .film file");
        for (auto& [k, old] : entries)
            if (k == key) {
                old = value;
                return;
            }
        entries.emplace_back(key, value);
    }
};

namespace film_file {

inline constexpr std::string_view magic = "penumbra film ", version = "1";
inline constexpr size_t longest_head = 1 << 16;  // bytes

// The three lines that come first.  They have one length, and are written last.
inline std::string first_lines(uint64_t bytes, uint64_t checksum) {
    char lines[80];
    std::snprintf(lines, sizeof lines, "bytes %020llu\nchecksum %016llx\n",
                  static_cast<unsigned long long>(bytes),
                  static_cast<unsigned long long>(checksum));
    return std::string(magic).append(version).append("\n").append(lines);
}

inline std::string encode(const FilmHeader& header) {
    std::string lines;
    for (const auto& [key, value] : header.entries) lines += key + " " + value + "\n";
    return lines + "\n";
}

}  // namespace film_file

// Throws UserError if no .film file could be written there.
inline void check_film(const std::string& path) {
    if (is_stream(path)) throw UserError(path + ": is no regular file");
    check_writable(path);
}

// ---- Writing ------------------------------------------------------------------------------------

// Writes beside the file, and renames once all of it is on the disk: at any moment the file is the
// old one or the new one, though the process be killed or the power fail.
class FilmWriter {
public:
    FilmWriter(const std::string& path, const FilmHeader& header) : file_(path) {
        const std::string lines = film_file::encode(header), first = film_file::first_lines(0, 0);
        if (first.size() + lines.size() > film_file::longest_head)
            throw UserError(path + ": its head would be longer than " +
                            std::to_string(film_file::longest_head) + " bytes");
        file_.write(first.data(), first.size());
        add(lines.data(), lines.size());
    }
    void append(const void* numbers, size_t bytes) {
        add(numbers, bytes);
        bytes_ += bytes;
    }
    template <class T>
    void append(const std::vector<T>& numbers) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(numbers.data(), numbers.size() * sizeof(T));
    }
    void commit() {
        const std::string first = film_file::first_lines(bytes_, checksum_.value());
        file_.write_at(0, first.data(), first.size());
        file_.commit();
    }

private:
    OutputFile file_;
    Checksum checksum_;
    uint64_t bytes_ = 0;
    void add(const void* bytes, size_t size) {
        checksum_.add(bytes, size);
        file_.write(bytes, size);
    }
};

// ---- Reading ------------------------------------------------------------------------------------

// Refuses with UserError, by the file's name, what no FilmWriter has committed.  Its length is
// compared at once; what else it says is not to be believed before check().
class FilmReader {
public:
    explicit FilmReader(const std::string& path) : path_(path), in_(path) {
        std::string head(film_file::longest_head, '\0');
        head.resize(in_.read(head.data(), head.size()));
        const bool whole = head.size() < film_file::longest_head;
        const size_t lines = first_lines_of(head), end = head.find("\n\n", lines - 1);
        if (end == head.npos) refuse(whole ? cut_short : "is damaged (its head has no end)");
        start_ = end + 2;
        const uint64_t there = in_.size();
        if (there < start_ || there - start_ < bytes_) refuse(cut_short);
        if (there - start_ > bytes_) refuse("is longer than it says");
        for (size_t from = lines, to; from <= end; from = to + 1) {
            to = head.find('\n', from);
            const std::string line = head.substr(from, to - from);
            const size_t space = line.find(' ');
            if (space == 0 || space == line.npos) refuse("is damaged (its head is none)");
            header_.entries.emplace_back(line.substr(0, space), line.substr(space + 1));
        }
        lines_ = lines;
    }
    const FilmHeader& header() const { return header_; }
    uint64_t left() const { return bytes_ - read_; }  // bytes to be read

    // Reads all of the file once, so that nothing of a damaged one is used; the first read() does
    // it, too.
    void check() {
        Checksum checksum;
        std::vector<char> piece(1 << 18);
        in_.go_to(lines_);
        while (const size_t n = in_.read(piece.data(), piece.size())) checksum.add(piece.data(), n);
        if (film_file::first_lines(bytes_, checksum.value()) != first_lines_)
            refuse("is damaged (its checksum differs)");
        in_.go_to(start_);
        read_ = 0;
        checked_ = true;
    }
    void read(void* numbers, size_t bytes) {
        if (!checked_) check();
        if (bytes > left()) refuse("holds less than it should");
        if (in_.read(numbers, bytes) != bytes) refuse(cut_short);
        read_ += bytes;
    }
    template <class T>
    std::vector<T> read(size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (!checked_) check();
        if (count > left() / sizeof(T)) refuse("holds less than it should");
        std::vector<T> numbers(count);
        read(numbers.data(), count * sizeof(T));
        return numbers;
    }

private:
    static constexpr const char* cut_short = "is cut short";
    const std::string path_;
    const InputFile in_;
    FilmHeader header_;
    std::string first_lines_;
    size_t lines_ = 0;                           // where those of the header begin
    uint64_t start_ = 0, bytes_ = 0, read_ = 0;  // of the numbers
    bool checked_ = false;

    [[noreturn]] void refuse(const std::string& why) const { throw UserError(path_ + ": " + why); }
    // Where they end.
    size_t first_lines_of(const std::string& head) {
        using film_file::magic, film_file::version;
        const std::string first = film_file::first_lines(0, 0);
        if (!head.empty() && first.starts_with(head.substr(0, magic.size() + version.size() + 1)) &&
            head.size() < first.size())
            refuse(cut_short);
        const size_t end = head.find('\n');
        if (!head.starts_with(magic) || end > magic.size() + 20) refuse("no film");
        const std::string its = head.substr(magic.size(), end - magic.size());
        if (its != version) refuse("of another version (" + its + ")");
        first_lines_ = head.substr(0, first.size());
        const size_t bytes = first.find("bytes ") + 6;
        const char* const digits = head.data() + bytes;
        const auto [stop, error] = std::from_chars(digits, digits + 20, bytes_);
        if (error != std::errc() || stop != digits + 20) refuse("is damaged (its head is none)");
        return first.size();
    }
};
