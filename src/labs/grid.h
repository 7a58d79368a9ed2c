// labs/grid.h  5  renders scenes with settings, and measures error and cost of each render
//
//   RenderGrid grid("efficiency", "build/penumbra");
//   const Rows rows = grid.run({{"cornell", "scenes/cornell.scene --size 64x32"}},
//                              {{"the default", ""}, {"NEE", "--light nee"}}, {16, 64}, 8);
//   table(rows, of_setting, of_count, [](auto& r) { return text("%.3g", relative_error(r)); });
//
// Saves rows as text in out/NAME.rows, and references in out/truth/.  An interrupted study resumes
// from them.  Its tables can be made again without rendering.
#pragma once
#include <mutex>

#include "app/threads.h"
#include "base/rng.h"
#include "labs/rows.h"

namespace penumbra {

// ---- Scenes, settings and references ------------------------------------------------------------

// Options that name a scene and its size, and the samples per pixel of its reference.
struct Subject {
    std::string name, words;
    uint64_t truth = 16384;
    std::string truth_words = {};  // if not empty, they replace the options of the reference
};

struct Setting {
    std::string name, words;
    std::string program = {};  // and its first options; "": those of the grid
};

// A reference of many samples, by default with 16 replications.  Two could not estimate its error
// if a single pixel had most of it.
struct Truth {
    Image image;
    double own = 0;                    // relative RMSE by the spread of replications; NaN: unknown
    std::map<std::string, double> of;  // statistics of its render
};

inline std::string fingerprint(const std::string& bytes) {
    uint64_t h = bytes.size();
    for (unsigned char c : bytes) h = hash(h, c);
    return text("%012.0f", double(h >> 25));
}

// ---- The grid -----------------------------------------------------------------------------------

class RenderGrid {
public:
    // Renders with `program`, unless a setting has its own: a single-threaded render on each core.
    RenderGrid(std::string name, std::string program)
        : name_(std::move(name)), program_(std::move(program)) {
        std::filesystem::create_directories("out/truth");
        std::ifstream in(file());
        for (std::string line; std::getline(in, line);)
            if (const auto row = row_of(line)) done_[key(row->first, row->second)] = row->first;
    }

    unsigned jobs = all_cores();  // simultaneous renders
    // Adds numbers of an image to its row.
    std::function<void(Row&, const Image&, const Truth&)> measure;

    // With 0 seeds, runs each setting once without --seed.  Seeds are the outer loop, so an
    // interrupted study has fewer seeds of all.  Settings take turns, so load affects all alike.
    Rows run(const std::vector<Subject>& subjects, const std::vector<Setting>& settings,
             const std::vector<uint64_t>& counts, uint64_t seeds) {
        std::vector<Job> all, missing;
        for (const Subject& s : subjects)
            for (const Setting& setting : settings)
                for (uint64_t count : counts)
                    for (uint64_t seed = seeds > 0; seed <= seeds; ++seed)
                        all.push_back(job(s, setting, count, seed));
        const size_t each = std::max<uint64_t>(seeds, 1);  // runs of a scene, setting and count
        for (size_t seed = 0; seed < each; ++seed)
            for (size_t s = 0; s < subjects.size(); ++s)
                for (size_t c = 0; c < counts.size(); ++c)
                    for (size_t k = 0; k < settings.size(); ++k) {
                        const size_t setting = s * settings.size() + (k + seed) % settings.size();
                        const Job& j = all[(setting * counts.size() + c) * each + seed];
                        if (!done_.count(j.key)) missing.push_back(j);
                    }
        render_all(missing);
        Rows rows;
        for (const Job& j : all) rows.push_back(done_.at(j.key));
        return rows;
    }

    // The reference of a subject.  The grid's program renders it once.
    const Truth& truth(const Subject& s) {
        const std::string print = print_of_truth(s);
        if (const auto at = truths_.find(print); at != truths_.end()) return at->second;
        std::string stem = s.name + "-" + print;
        std::replace(stem.begin(), stem.end(), '/', '-');
        stem = "out/truth/" + stem;
        if (!std::filesystem::exists(stem + ".pfm"))
            render(program_ + " " + truth_words(s), all_cores(), stem);
        const std::map<std::string, double> of = numbers_of(read_file(stem + ".json"));
        double own = NAN;
        for (const char* key : {"d_rel", "d_rel_by_spread"})
            if (const auto at = of.find(key); at != of.end()) own = at->second;
        return truths_[print] = {read_pfm(stem + ".pfm"), own, of};
    }

private:
    struct Job {
        Row row;
        const Subject* subject;
        std::string command, print, key;  // without its output files; fingerprint; position
    };
    std::string name_, program_;
    std::map<std::string, Row> done_;  // by position and fingerprint
    std::map<std::string, Truth> truths_;
    std::map<std::string, std::string> prints_;  // fingerprints of programs

    std::string file() const { return "out/" + name_ + ".rows"; }
    static std::string key(const Row& r, const std::string& print) {
        return line_of({r.scene, r.setting, r.count, r.seed}, print);
    }
    static std::string truth_words(const Subject& s) {
        if (!s.truth_words.empty()) return s.words + " " + s.truth_words;
        return text("%s --spp %.0f --replications 16 --seed 1000000", s.words, double(s.truth));
    }
    std::string print_of_truth(const Subject& s) const {
        return fingerprint(program_ + truth_words(s) + read_file(words_in(s.words)[0]));
    }

    Job job(const Subject& s, const Setting& setting, uint64_t count, uint64_t seed) {
        const Row row{s.name, setting.name, count, seed};
        const std::string program = setting.program.empty() ? program_ : setting.program,
                          file = words_in(program)[0];
        if (prints_[file].empty()) prints_[file] = fingerprint(read_file(file));
        const std::string command = text("%s %s %s%s%s", program, s.words, setting.words,
                                         count > 0 ? text(" --spp %.0f", double(count)) : "",
                                         seed > 0 ? text(" --seed %.0f", double(seed)) : "");
        const std::string print = fingerprint(prints_[file] + command + print_of_truth(s));
        return {row, &s, command, print, key(row, print)};
    }

    void render_all(const std::vector<Job>& missing) {
        std::ofstream out(file(), std::ios::app);
        out << '\n';  // the last line may have been cut short
        for (const Job& j : missing) truth(*j.subject);
        size_t count = 0;
        std::mutex lock;
        by_workers(
            missing.size(), jobs,
            [&](size_t k, unsigned) {
                const Row row =
                    rendered(missing[k], text("out/%s-%d-%zu", name_, int(::getpid()), k));
                const std::lock_guard guard(lock);
                std::fprintf(stderr, "%zu of %zu: %s, %s\n", ++count, missing.size(),
                             row.scene.c_str(), row.setting.c_str());
                done_[missing[k].key] = row;
                out << line_of(row, missing[k].print) << std::flush;
            },
            [](double) {});
    }

    Row rendered(const Job& job, const std::string& stem) const {
        render(job.command, 1, stem);
        const std::string json = read_file(stem + ".json");
        const Image image = read_pfm(stem + ".pfm");
        for (const char* suffix : {".pfm", ".json"}) std::filesystem::remove(stem + suffix);
        Row row = job.row;
        row.of = numbers_of(json);
        row.of["mean"] = image_mean(image);
        row.of["stated"] = row["error"];
        row.of["error"] = json.find("\"stopped_by\": \"error\"") != json.npos;
        const Truth& f = truths_.at(print_of_truth(*job.subject));
        const double off = row.of["off"] = d_rel(f.image, image);
        row.of["own"] = f.own;
        row.of["d2"] = off * off - f.own * f.own;
        if (measure) measure(row, image, f);
        return row;
    }

    // Writes STEM.pfm and STEM.json.  Renames complete files to these names.
    static void render(const std::string& command, unsigned threads, const std::string& stem) {
        std::vector<std::string> words = words_in(command + text(" --threads %u", threads));
        words.insert(words.end(),
                     {"--quiet", "-o", stem + ".new.pfm", "--stats", stem + ".new.json"});
        execute(words);
        std::filesystem::rename(stem + ".new.json", stem + ".json");
        std::filesystem::rename(stem + ".new.pfm", stem + ".pfm");
    }
};

}  // namespace penumbra
