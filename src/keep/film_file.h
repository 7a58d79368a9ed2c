// keep/film_file.h  1  .film files: a head that says what is in them, numbers, and a checksum
//
//     penumbra film 10                   what it is, and the version of this format
//     bytes 00000000000000001536         of numbers, after the head
//     checksum 0f1e2d3c4b5a6978          of all that follows this line
//     scene 7dc0f03976e8ec38             KEY VALUE: what the writer says of them
//                                        an empty line
//     numbers, as memory holds them: little-endian
#pragma once
#include <bit>
#include <sstream>

#include "base/rng.h"
#include "film/weights.h"
#include "text/files.h"
#include "text/program.h"

namespace penumbra {

static_assert(std::endian::native == std::endian::little,
              "numbers are written as memory holds them");

// FNV-1a (Fowler, Noll, Vo 1991).  A step is a bijection of the sum for any byte, and of the byte
// for any sum: a single damaged byte always changes the sum.  Several damaged bytes leave it the
// same with probability about 2^-64.  It does not protect against forgery.
struct Checksum {
    uint64_t sum = 0xcbf29ce484222325;

    void add(std::span<const std::byte> bytes) {
        for (const std::byte b : bytes) sum = (sum ^ uint64_t(b)) * 0x100000001b3;
    }
    std::string text() const {
        char text[20];
        std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum));
        return text;
    }
};

// The three lines that come first; they have one length.
inline std::string first_lines(uint64_t bytes, const Checksum& checksum) {
    const std::string digits = std::to_string(bytes);
    return "penumbra film 10\nbytes " + std::string(20 - digits.size(), '0') + digits +
           "\nchecksum " + checksum.text() + "\n";
}

// At any moment the file is the old one or the new one, even if the process is killed or the power
// fails.  Keys are words, and values have no line breaks.
inline void write_film_file(const std::string& path, const Facts& head, const Pieces& numbers) {
    std::string lines;
    for (const auto& [key, value] : head) lines += key + " " + value + "\n";
    lines += "\n";
    Checksum checksum;
    checksum.add(std::as_bytes(std::span(lines)));
    uint64_t bytes = 0;
    for (const auto& n : numbers) checksum.add(n), bytes += n.size();
    lines = first_lines(bytes, checksum) + lines;
    Pieces pieces = {std::as_bytes(std::span(lines))};
    pieces.insert(pieces.end(), numbers.begin(), numbers.end());
    write_file(path, pieces);
}

// Throws UserError with the file's name about a file in another format.  It first reads all of the
// file once, so that no part of a damaged file is used.
class FilmReader {
public:
    explicit FilmReader(const std::string& path) : path_(path), in_(open_file(path)) {
        std::string head(1 << 16, '\0');  // none is longer
        head.resize(read_some(std::as_writable_bytes(std::span(head))));
        const size_t lines = check_first_lines(head), end = head.find("\n\n", lines - 1);
        const size_t bytes = head.find("\nbytes ");
        if (end == head.npos || bytes == head.npos) refuse(cut_short);
        left_ = std::strtoull(head.c_str() + bytes + 7, nullptr, 10);
        in_.clear();
        in_.seekg(0, std::ios::end);
        const uint64_t there = uint64_t(in_.tellg()) - (end + 2);
        if (there != left_) refuse(there < left_ ? cut_short : "is longer than it says");
        if (first_lines(left_, checksum_from(lines)) != head.substr(0, lines))
            refuse("is damaged (its checksum differs)");
        go_to(end + 2);
        std::istringstream in(head.substr(lines, end + 1 - lines));
        for (std::string key, value; in >> key && in.get() && std::getline(in, value);)
            head_.push_back({key, value});
    }

    [[noreturn]] void refuse(const std::string& why) const { throw UserError(path_ + ": " + why); }
    const Facts& head() const { return head_; }
    std::string said(std::string_view key) const {
        for (const auto& [k, value] : head_)
            if (k == key) return value;
        return "not known";
    }
    // The number in [0, most] at the beginning of a value, or `after` a character of it.
    double number(std::string_view key, double most = 0x1p53, char after = '\0') const {
        const std::string value = said(key);
        const size_t at = after ? value.find(after) : 0;
        const char* const from =
            value.data() + (at == value.npos ? value.size() : at + (after != 0));
        char* end = nullptr;
        const double x = std::strtod(from, &end);  // of nothing: it ends where it begins
        if (end == from || !(x >= 0 && x <= most))
            refuse("invalid " + std::string(key) + " " + in_quotes(value));
        return x;
    }
    uint64_t left() const { return left_; }  // bytes of numbers to be read
    void read(std::span<std::byte> numbers) {
        if (numbers.size() > left_) refuse("is too short for its size");
        if (read_some(numbers) != numbers.size()) refuse(cut_short);
        left_ -= numbers.size();
    }

private:
    static constexpr const char* cut_short = "is cut short";
    const std::string path_;
    std::ifstream in_;
    Facts head_;
    uint64_t left_ = 0;

    size_t read_some(std::span<std::byte> bytes) { return read_from(in_, path_, bytes); }
    void go_to(uint64_t byte) {
        in_.clear();
        in_.seekg(std::streamoff(byte));
    }
    // Returns where they end.
    size_t check_first_lines(const std::string& head) const {
        const std::string first = first_lines(0, {});
        const size_t line = first.find('\n') + 1, end = head.find('\n');
        const size_t magic = first.rfind(' ', line) + 1;  // its version follows
        if (!head.empty() && head.size() < first.size() && first.starts_with(head.substr(0, line)))
            refuse(cut_short);
        if (head.compare(0, magic, first, 0, magic) != 0 || end > magic + 20)
            refuse("is not a film");
        const std::string version = first.substr(magic, line - 1 - magic);
        if (head.substr(magic, end - magic) != version)
            refuse("is of another Penumbra: format version " + head.substr(magic, end - magic) +
                   ", not " + version);
        return first.size();
    }
    Checksum checksum_from(uint64_t byte) {
        Checksum sum;
        std::vector<std::byte> piece(1 << 18);
        go_to(byte);
        while (const size_t n = read_some(piece)) sum.add(std::span(piece).first(n));
        return sum;
    }
};

// ---- Films --------------------------------------------------------------------------------------

inline Spent spent_in(const FilmReader& file) {
    return {file.number("seconds"), file.number("cpu-seconds"), uint64_t(file.number("rays"))};
}

// Reads a film but its sums, which come last in the file; throws UserError if it holds no possible
// film of this size.
inline Film film_but_sums(FilmReader& file, Size size) {
    Film f{size, 0, uint32_t(file.number("replications-per-pixel", max_replications))};
    const uint64_t n = f.pixels(), bytes_of_sums = n * f.replications * sizeof(Sum);
    if (bytes_of_sums == 0 || file.left() < bytes_of_sums) file.refuse("is too short for its size");
    f.is_pilot = file.said("weights-chosen") == "no";
    f.pilot = uint64_t(file.number("pilot", f.is_pilot ? 0 : double(pilot_samples)));
    f.samples_done.resize(f.blocks()), f.weight.resize(n),
        f.pilot_deviation.resize(f.is_pilot ? n : 0);
    f.near.resize(size_t(file.number("light-groups", 1 << 10)));
    file.read(std::as_writable_bytes(std::span(f.samples_done)));
    file.read(std::as_writable_bytes(std::span(f.weight)));
    file.read(std::as_writable_bytes(std::span(f.pilot_deviation)));
    file.read(std::as_writable_bytes(std::span(f.near)));
    auto impossible = [most = f.is_pilot ? 1 : max_weight](uint8_t w) {
        return !std::has_single_bit(w) || w > most;
    };
    if (std::ranges::any_of(f.weight, impossible) ||
        f.max_samples_done() > (f.is_pilot ? pilot_samples : max_samples))
        file.refuse("has a pixel with an impossible number of samples");
    if (file.left() != bytes_of_sums) file.refuse("its replications do not match its length");
    return f;
}

// Reads a film pixel by pixel, without holding its sums in memory.
class FilmPixels {
public:
    FilmPixels(const std::string& path, Size size)
        : file_(path), film_(film_but_sums(file_, size)) {
        if (!film_.has_samples()) file_.refuse("has no samples");
        row_.resize(size_t(size.width) * film_.replications);
    }
    const Film& film() const { return film_; }  // without its sums
    // Adds the replications of the next pixel.
    void add_next(Pixel& p) {
        const size_t K = film_.replications, x = i_ % size_t(film_.size.width);
        if (x == 0) file_.read(std::as_writable_bytes(std::span(row_)));
        for (size_t k = 0; k < K; ++k) p.add(row_[x * K + k], film_.samples(i_));
        ++i_;
    }

private:
    FilmReader file_;
    Film film_;             // without its sums
    std::vector<Sum> row_;  // those of a row
    size_t i_ = 0;
};

}  // namespace penumbra
