// keep/keep.h  2  checkpoints: films in files, resumed renders
#pragma once
#include <chrono>
#include <utility>

#include "base/json.h"
#include "keep/film_file.h"

inline Spent spent_in(const FilmReader& file) {
    return {file.number("seconds"), file.number("cpu-seconds"), uint64_t(file.number("rays"))};
}

// Reads everything except the sums, which come next in the file, into a film f of the right size.
// Returns the number of sums; throws UserError if the file holds no possible film.
inline size_t read_but_sums(FilmReader& file, Film& f) {
    const bool is_chosen = file.said("replications-chosen") == "yes";
    const size_t n = f.pixels();
    if (n == 0 || file.left() / sizeof(Sum) < n) file.refuse("is too short for its size");
    f.pilot = uint64_t(file.number("pilot"));
    f.taken.resize((n + f.block_size() - 1) / f.block_size());
    f.sets.resize(is_chosen ? n : 0);
    f.spread.resize(is_chosen ? 0 : n);
    f.evidence.resize(size_t(file.number("evidence", 1 << 16)));
    file.read(std::as_writable_bytes(std::span(f.taken)));
    file.read(std::as_writable_bytes(std::span(f.sets)));
    file.read(std::as_writable_bytes(std::span(f.spread)));
    file.read(std::as_writable_bytes(std::span(f.evidence)));
    size_t sums = is_chosen ? 0 : n;
    for (const uint16_t K : f.sets) {
        if (K < 1 || K > most_sets)
            file.refuse("has a pixel with an impossible number of replications");
        sums += K;
    }
    if (file.left() != sums * sizeof(Sum)) file.refuse("its replications do not match its length");
    return sums;
}

// Reads a film pixel by pixel, without holding its sums in memory.
class FilmPixels {
public:
    FilmPixels(const std::string& path, Size size) : file_(path) {
        film_.size = size;
        read_but_sums(file_, film_);
        if (film_.least_taken() + film_.pilot == 0) file_.refuse("has no samples");
    }
    const Film& film() const { return film_; }  // without its sums
    // The next one; it lives until the next row begins.
    Pixel next() {
        if (const size_t width = size_t(film_.size.width); i_ % width == 0) {
            size_t sets = 0;
            for (size_t i = i_; i < i_ + width; ++i) sets += film_.sets_of(i);
            row_.resize(sets);
            file_.read(std::as_writable_bytes(std::span(row_)));
            sum_ = row_.data();
        }
        const size_t block = i_ / film_.block_size(), sets = film_.sets_of(i_++);
        return {
            {std::exchange(sum_, sum_ + sets), sets}, film_.samples(block, 0), film_.taken[block]};
    }

private:
    FilmReader file_;
    Film film_;             // without its sums
    std::vector<Sum> row_;  // those of a row
    const Sum* sum_ = nullptr;
    size_t i_ = 0;
};

// Checksum of the scene's source files.
inline std::string sum_of_files(const std::vector<std::string>& files) {
    Checksum sum;
    for (const std::string& file : files) {
        std::string bytes = read_file(file);
        bytes.append("\n").append(std::to_string(bytes.size()));  // where it ends
        sum.add(std::as_bytes(std::span(bytes)));
    }
    return sum.text();
}

// Throws UserError about the first fact that the file does not have.  `as`: " as in a.film";
// `scene`: the name of the scene expected.
inline void check_agrees(const FilmReader& file, const Facts& expected, const std::string& as = "",
                         const std::string& scene = "") {
    for (const auto& [key, value] : expected) {
        const std::string its = file.said(key), name = file.said("name");
        if (its == value) continue;
        if (key == "scene")
            file.refuse(name == scene ? "was rendered from another version of " + name
                                      : "was rendered from " + name + ", not from " + scene + as);
        file.refuse("was rendered with " + key + " " + its + ", not " + value + as);
    }
}

class Keeper {
public:
    Keeper(const std::string& path, const FilmOf& what,
           std::chrono::nanoseconds interval = std::chrono::seconds(10))
        : path_(path), interval_(interval), samples_(what.samples) {
        if (path.empty()) return;
        for (auto& [key, value] : samples_) std::erase(value, '"');
        samples_.insert(samples_.begin(), {"scene", sum_of_files(what.files)});
        head_ = samples_;
        head_.insert(head_.end(), what.notes.begin(), what.notes.end());
    }

    // Reads the film of the file, if there is one, into f; throws UserError if it does not match.
    Spent restore(Film& f) const {
        if (path_.empty() || !std::filesystem::exists(path_)) return {};
        FilmReader file(path_);
        std::string name;
        for (const auto& [key, value] : head_)
            if (key == "name") name = value;
        check_agrees(file, samples_, "", name);
        check_agrees(file, {{"evidence", std::to_string(f.evidence.size())}});
        f.sum = std::vector<Sum>();  // before there are others
        f.sum.resize(read_but_sums(file, f));
        file.read(std::as_writable_bytes(std::span(f.sum)));
        return spent_in(file);
    }

    // At most every ten seconds, and for at most a hundredth of the time.  On a full disk the file
    // stays as it was, the render continues, and the next checkpoint may fit.
    void write_now_and_then(const Film& f, const Spent& spent) {
        const auto start = clock::now();
        if (path_.empty() || start < next_) return;
        const std::string failed = write(f, spent, false);
        if (!failed.empty())
            std::fprintf(stderr, "%s; the render continues\n", printable(failed).c_str());
        const auto end = clock::now();
        next_ = end + std::max<clock::duration>(interval_, 100 * (end - start));
    }

    // Writes the head and then the film's arrays, the sums last.  Returns why it failed, or "".  A
    // film without samples replaces no file.
    std::string write(const Film& f, const Spent& spent, bool complete) const {
        if (path_.empty()) return "";
        if (f.most_taken() == 0 && f.pilot == 0 && std::filesystem::exists(path_)) return "";
        try {
            Facts head = head_;
            head.insert(head.end(), {{"complete", complete ? "yes" : "no"},
                                     {"seconds", json::number(spent.seconds)},
                                     {"cpu-seconds", json::number(spent.cpu_seconds)},
                                     {"rays", std::to_string(spent.rays)},
                                     {"pilot", std::to_string(f.pilot)},
                                     {"evidence", std::to_string(f.evidence.size())},
                                     {"replications-chosen", f.sets.empty() ? "no" : "yes"}});
            write_film_file(
                path_, head,
                {std::as_bytes(std::span(f.taken)), std::as_bytes(std::span(f.sets)),
                 std::as_bytes(std::span(f.spread)), std::as_bytes(std::span(f.evidence)),
                 std::as_bytes(std::span(f.sum))});
            return "";
        } catch (const SystemError& e) {
            return e.what();
        }
    }

private:
    using clock = std::chrono::steady_clock;
    const std::string path_;
    const std::chrono::nanoseconds interval_;
    Facts samples_, head_;  // facts that must agree, and all facts
    clock::time_point next_ = clock::now() + interval_;
};
