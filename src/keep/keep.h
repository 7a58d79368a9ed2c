// keep/keep.h  3  checkpoints: films in files, resumed renders
#pragma once
#include <chrono>
#include <utility>

#include "keep/film_file.h"
#include "text/json.h"

namespace penumbra {

// Checksum of the scene's meshes and its text.
inline std::string sum_of_scene(const FilmOf& what) {
    Checksum sum;
    auto add = [&](const std::string& bytes) {
        const std::string end =
            std::to_string(bytes.size() + 1).insert(0, 1, '\n');  // where it ends
        sum.add(std::as_bytes(std::span(bytes)));
        sum.add(std::as_bytes(std::span(end)));
    };
    for (const std::string& file : what.files) add(read_file(file));
    if (!what.scene.empty()) add(what.scene);
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
        samples_.insert(samples_.begin(), {"scene", sum_of_scene(what)});
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
        check_agrees(file, {{"replications-per-pixel", std::to_string(f.replications)},
                            {"light-groups", std::to_string(f.near.size())}});
        f.sum = std::vector<Sum>();  // before there are others
        Film kept = film_but_sums(file, f.size);
        kept.first_row = f.first_row;
        kept.sum.resize(kept.pixels() * kept.replications);
        file.read(std::as_writable_bytes(std::span(kept.sum)));
        f = std::move(kept);
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
        if (f.max_samples_done() + f.pilot == 0 && std::filesystem::exists(path_)) return "";
        try {
            Facts head = head_;
            head.insert(head.end(), {{"complete", complete ? "yes" : "no"},
                                     {"seconds", json::number(spent.seconds)},
                                     {"cpu-seconds", json::number(spent.cpu_seconds)},
                                     {"rays", std::to_string(spent.rays)},
                                     {"replications-per-pixel", std::to_string(f.replications)},
                                     {"weights-chosen", f.is_pilot ? "no" : "yes"},
                                     {"pilot", std::to_string(f.pilot)},
                                     {"light-groups", std::to_string(f.near.size())}});
            write_film_file(
                path_, head,
                {std::as_bytes(std::span(f.samples_done)), std::as_bytes(std::span(f.weight)),
                 std::as_bytes(std::span(f.pilot_deviation)), std::as_bytes(std::span(f.near)),
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

}  // namespace penumbra
