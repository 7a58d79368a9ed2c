// course/judge.h  the judge of an exercise: asks a program that holds the student's code, and
// decides
//
//     judge_2 [--mistakes FILE] [--json FILE] [--seed N] [--patience S] 2.2 -- PROGRAM [WORD...]
//
// PROGRAM answers questions over its stdin and stdout (answers.h).  Nothing of it is ever loaded
// here: whatever it does, the verdict rests on numbers that came over a pipe.  Exit status: 0
// right, 1 wrong, 3 the stub is still there, 2 the judge itself cannot work.
#pragma once
#include <bit>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <unordered_map>

#include "course/program.h"
#include "oracle/oracle.h"

namespace penumbra::course {

// ---- Numbers ------------------------------------------------------------------------------------

using oracle::Triple, oracle::detail::dot;

inline Triple operator+(const Triple& a, const Triple& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Triple operator-(const Triple& a, const Triple& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Triple operator*(double s, const Triple& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Triple operator*(const Triple& a, const Triple& b) {
    return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}
inline Triple cross(const Triple& a, const Triple& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Triple& a) { return std::sqrt(dot(a, a)); }
inline Triple unit(const Triple& a) { return 1 / length(a) * a; }
inline Triple triple(In x, size_t at = 0) { return {x[at], x[at + 1], x[at + 2]}; }

// Rows f(0), f(1), ... f(n - 1).
template <class F>
Rows rows_of(size_t n, F f) {
    Rows rows;
    for (size_t i = 0; i < n; ++i) rows.add(f(i));
    return rows;
}

// a equals b up to a relative error, or an absolute one below 1; NaN equals nothing, and what is
// infinite only itself.
inline bool near(double a, double b, double tolerance) {
    if (std::isinf(b)) return a == b;
    return std::abs(a - b) <= tolerance * std::max(1.0, std::abs(b));
}
inline bool near(const Triple& a, const Triple& b, double tolerance) {
    return near(a[0], b[0], tolerance) && near(a[1], b[1], tolerance) &&
           near(a[2], b[2], tolerance);
}

// The larger of two errors; what is not a number is no small one.
inline double worse(double a, double b) {
    return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN()
                                          : std::max(a, b);
}

// Laws know no directions, no left and right and no unit of length: what is asked is turned,
// mirrored, moved and scaled at random.
struct Pose {
    std::array<Triple, 3> axes;  // unit, and at right angles
    double scale = 1;
    Triple shift{};
    Triple turned(const Triple& d) const {
        return d[0] * axes[0] + d[1] * axes[1] + d[2] * axes[2];
    }
    Triple at(const Triple& p) const { return shift + scale * turned(p); }
};
inline double between(oracle::Random& random, double low, double high) {
    return low + (high - low) * random();
}
inline Triple in_cube(oracle::Random& random) {
    Triple p;
    for (double& x : p) x = between(random, -1, 1);
    return p;
}
inline Triple any_direction(oracle::Random& random) {
    for (;;) {
        const Triple p = in_cube(random);
        if (dot(p, p) > 0.01 && dot(p, p) < 1) return unit(p);
    }
}
inline Pose any_pose(oracle::Random& random, double scale = 1) {
    const Triple z = any_direction(random), x = unit(cross(z, any_direction(random)));
    const double side = random() < 0.5 ? 1 : -1;
    return {{x, side * cross(z, x), z}, scale, scale * in_cube(random)};
}

// ---- The judge ----------------------------------------------------------------------------------

// One thing that was looked at.
struct Item {
    std::string what;
    bool statistical = false;
    bool right = false;
    std::string seen;               // what was expected and what came, or what the oracle says
    double costs = 0.5;             // part of the points: a law half, a limit of it a quarter
    double off = oracle::infinity;  // how wrong, if that is a number

    // The more, the more it says of a mistake: a cause that the oracle suggests; a law; a limit,
    // which falls with the laws; what rounding may have made of another item's mistake.
    int knows() const {
        if (seen.find("looks like") != seen.npos) return 3;
        return off < 1e-6 ? 0 : costs < 0.5 ? 1 : 2;
    }
};

// The greatest of many errors, and what was seen there; what is not a number is the greatest of
// all.
struct Worst {
    double off = 0;
    std::string seen = "";
    void see(double by, const std::string& what) {
        if (by <= off || std::isinf(off)) return;
        off = std::isnan(by) ? oracle::infinity : by, seen = what;
    }
};

// How many of many are wrong, and what was seen at the first of these.
struct Several {
    size_t n = 0, wrong = 0;
    std::string first = "";
    void see(bool right, const std::string& what) {
        if (++n; !right && wrong++ == 0) first = what;
    }
};

// The wrong item that knows most; of equals the first.  Nothing: all are right.
inline const Item* most_telling(const std::vector<Item>& items) {
    const Item* most = nullptr;
    for (const Item& i : items)
        if (!i.right && (!most || i.knows() > most->knows())) most = &i;
    return most;
}

// A function of the program's, as a check of the oracle calls it: with one question after the
// other. Some are asked at once; what is asked beyond `budget` is put off, to be asked in a batch.
struct Known {
    struct Hash {
        size_t operator()(const Out& x) const {
            uint64_t h = 0;
            for (double d : x)
                h = (h ^ std::bit_cast<uint64_t>(d)) * 0x9e3779b97f4a7c15, h ^= h >> 29;
            return h;
        }
    };
    // Bit by bit: a student's NaN may be asked about, too, and equals itself.
    struct Same {
        bool operator()(const Out& a, const Out& b) const {
            return a.size() == b.size() &&
                   std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
        }
    };
    Program* program;
    std::string question;
    std::unordered_map<Out, Out, Hash, Same> answers = {};
    Rows put_off = {};
    int budget = 0;

    // The answer; or `meanwhile`, and then the whole check is run again.
    const Out& operator()(const Out& in, const Out& meanwhile) {
        const auto found = answers.find(in);
        if (found != answers.end()) return found->second;
        if (budget-- > 0) return answers[in] = program->ask(question, Rows(in)).numbers;
        put_off.add(in);
        return answers[in] = meanwhile;
    }
    // Whether there was nothing to be asked.
    bool catch_up() {
        budget = 4096;
        if (put_off.numbers.empty()) return true;
        const Rows out = program->ask(question, put_off);
        for (size_t i = 0; i < put_off.size(); ++i) {
            const auto in = put_off[i], row = out[i];
            answers[Out(in.begin(), in.end())] = Out(row.begin(), row.end());
        }
        put_off = {};
        return false;
    }
};

// All that was seen.
struct Evidence {
    std::vector<Item> items = {};
    Out fingerprint = {};               // answers to probes: by them known mistakes are told
    Out of_stub = {};                   // answers to further probes, by which the stub is told
    std::optional<double> credit = {};  // part of the points, where items do not say it
    double allows = 0;                  // seconds of CPU that answers may take by a rule of its own
};

class Judge : public Evidence {
public:
    oracle::Random random;
    double epsilon;  // of the student's `real`: 2^-53 or 2^-24

    Judge(Program& program, uint64_t seed)
        : random(seed), epsilon(program.is_float() ? 0x1p-24 : 0x1p-53), program_(program) {}

    // The answers to a batch of questions, row by row; throws Silence if they do not come.
    Rows ask(const std::string& question, const Rows& in) { return program_.ask(question, in); }
    // To one.
    Out ask(const std::string& question, const Out& in) {
        return program_.ask(question, Rows(in)).numbers;
    }
    // To questions that are always the same, and so tell which mistake it is.
    Rows probe(const std::string& question, const Rows& in) {
        Rows out = program_.ask(question, in);
        remember(out.numbers);
        return out;
    }
    // What follows from answers, where mistakes are told by that.
    void remember(const Out& numbers) {
        fingerprint.insert(fingerprint.end(), numbers.begin(), numbers.end());
    }

    // By which factor answers differ from what is expected, if all by one; -1 if not.  Whichever
    // way earlier exercises use random numbers, a mistake has one factor.
    void remember_factor(const Out& came, const Out& expected) {
        double factor = came.at(0) / expected.at(0);
        for (size_t i = 0; i < came.size(); ++i)
            if (!near(came[i], factor * expected[i], 1e5 * epsilon * std::abs(expected[i])))
                factor = -1;
        remember({std::isfinite(factor) ? factor : -1});
    }

    // A check of the oracle calls functions one by one: check(random, functions) is run with what
    // is known so far, and again with the same random numbers, until nothing was put off.  Its
    // picture, if it fails, is that of a run of which all was known.
    template <class Check>
    oracle::Verdict batched(const std::vector<std::string>& questions, Check check) {
        std::vector<Known> known;
        for (const std::string& q : questions) known.push_back({&program_, q});
        const std::string folder = oracle::pictures;
        if (!folder.empty()) oracle::pictures = folder + "/unfinished";
        for (;;) {
            oracle::Random same = random;
            const oracle::Verdict verdict = check(same, known);
            bool complete = true;
            for (Known& k : known) complete &= k.catch_up();
            if (!complete) continue;
            const bool last = verdict.pass || oracle::pictures == folder;
            oracle::pictures = folder;
            if (!last) continue;
            random = same;
            return verdict;
        }
    }

    // To questions whose answers mistakes do not share, but the stub always has: it is told by
    // these as well, so that nothing else is taken for it.
    void probe_stub(const std::string& question, const Rows& in) {
        const Out out = program_.ask(question, in).numbers;
        of_stub.insert(of_stub.end(), out.begin(), out.end());
    }

    // What holds to the last digits or not at all.
    void exact(const std::string& what, bool right, const std::string& seen = "") {
        items.push_back({what, false, right, seen});
    }
    // The item before is a limit of a law: the tiny, the far away, a corner.
    void limit() { items.back().costs = 0.25; }
    // A number; `of` says of which question.
    void number(const std::string& what, double came, double expected, double tolerance) {
        exact(what, near(came, expected, tolerance),
              oracle::say("%.9g expected, %.9g came", expected, came));
        items.back().off = std::abs(came - expected);
    }
    void vector(const std::string& what, const Triple& came, const Triple& expected,
                double tolerance) {
        exact(what, near(came, expected, tolerance),
              oracle::say("(%.6g, %.6g, %.6g) expected, (%.6g, %.6g, %.6g) came", expected[0],
                          expected[1], expected[2], came[0], came[1], came[2]));
    }
    // An error that is to be below a limit, and how many there are of what must not be.
    void below(const std::string& what, double off, double limit,
               const char* seen = "off by %.3g") {
        exact(what, off < limit, oracle::say(seen, off));
        items.back().off = off;
    }
    void worst(const std::string& what, const Worst& w, double limit) {
        exact(what, w.off <= limit, w.seen);
    }
    // All of them are right, and there are some.
    void all(const std::string& what, const Several& s) {
        const std::string count = oracle::say(" (%zu of %zu are wrong)", s.wrong, s.n);
        exact(what, s.n > 0 && s.wrong == 0, s.first + (s.n > 1 ? count : ""));
    }
    void none(const std::string& what, size_t count, const char* seen) {
        exact(what, count == 0, oracle::say(seen, count));
    }
    void statistical(const std::string& what, const oracle::Verdict& v) {
        std::string seen = v.text.substr(0, v.text.find('\n'));
        if (v.pass)
            seen = oracle::say("p = %.2g; errors above %.2g %% are seen", v.p, 100 * v.delta_min);
        items.push_back({what, true, v.pass, seen});
    }
    // The mean of a number of each row.
    template <class Rows, class Of>
    void mean(const std::string& what, double truth, const Rows& rows, Of of) {
        size_t i = 0;
        statistical(what, oracle::expect_mean(truth, rows.size(), [&] { return of(rows[i++]); }));
    }

private:
    Program& program_;
};

using Judging = std::function<void(Judge&)>;

// ---- Known mistakes -----------------------------------------------------------------------------

// A line of mistakes.txt, between tabs: exercise, name ("stub": the starter's), what it is in the
// student's terms, where to read, the answers to the judge's probes.
struct KnownMistake {
    std::string exercise, name, says, read;
    Out fingerprint;
};

inline std::vector<KnownMistake> read_mistakes(const std::string& path) {
    std::vector<KnownMistake> mistakes;
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream fields(line);
        KnownMistake m;
        for (std::string* field : {&m.exercise, &m.name, &m.says, &m.read})
            std::getline(fields, *field, '\t');
        for (std::string word; fields >> word;)
            m.fingerprint.push_back(std::strtod(word.c_str(), nullptr));
        mistakes.push_back(m);
    }
    return mistakes;
}

// The mistake whose answers these are.  Float has seven digits, of which a path may lose some.
inline const KnownMistake* mistake_of(const std::vector<KnownMistake>& mistakes,
                                      const std::string& exercise, const Judge& j) {
    const double tolerance = j.epsilon > 0x1p-50 ? 1e-4 : 1e-8;
    for (const KnownMistake& m : mistakes) {
        Out print = j.fingerprint;
        if (m.name == "stub") print.insert(print.end(), j.of_stub.begin(), j.of_stub.end());
        if (m.exercise != exercise || m.fingerprint.size() != print.size()) continue;
        bool same = !m.fingerprint.empty();
        for (size_t i = 0; same && i < m.fingerprint.size(); ++i) {
            const double a = print[i], b = m.fingerprint[i];
            same = a == b || near(a, b, tolerance) || (std::isnan(a) && std::isnan(b));
        }
        if (same) return &m;
    }
    return nullptr;
}

// ---- The program --------------------------------------------------------------------------------

struct Judgement : Evidence {
    std::string exercise, state;  // right, wrong, open, silent
    std::string silence = "";     // why answers ended, if they did
    std::optional<KnownMistake> named = {};
    size_t right() const {
        return size_t(
            std::count_if(items.begin(), items.end(), [](const Item& i) { return i.right; }));
    }
};

inline Judgement judge_one(const std::string& exercise, const Judging& judging,
                           const std::vector<KnownMistake>& mistakes, uint64_t seed,
                           Program& program) {
    Judge j(program, seed);
    Judgement result{{}, exercise, "right"};
    try {
        judging(j);
    } catch (const Silence& e) {
        result.silence = e.what();
        j.items.push_back({"all questions are answered", false, false, e.what()});
    }
    static_cast<Evidence&>(result) = j;
    if (result.right() == result.items.size() && !result.items.empty()) return result;
    result.state = result.silence.empty() ? "wrong" : "silent";
    if (const KnownMistake* m = mistake_of(mistakes, exercise, j)) {
        result.named = *m;
        if (m->name == "stub") result.state = "open";
    }
    return result;
}

// What is wrong, in a line: a known mistake, or else the item that knows most.  An item says what
// should be, and is not to be read as the mistake.  A silence is told where nothing that came
// before it says as much.
inline std::string headline(const Judgement& r) {
    if (r.named) return r.named->says;
    const Item* most = most_telling(r.items);
    if (!most) return "";
    const bool ended = !r.silence.empty() && most->seen == r.silence;
    return ended ? r.silence : "this should hold: " + most->what + ": " + most->seen;
}

// The verdict in a line, then what was looked at.
inline void print(const Judgement& r) {
    const std::string sheet = r.exercise.substr(0, r.exercise.find('.'));
    if (r.state == "right")
        std::printf("%s right: %zu of %zu\n", r.exercise.c_str(), r.right(), r.items.size());
    else if (r.state == "open")
        std::printf("%s open: the stub is still there\n", r.exercise.c_str());
    else if (r.named)
        std::printf("%s wrong: %s; read \"%s\" in sheet %s\n", r.exercise.c_str(),
                    headline(r).c_str(), r.named->read.c_str(), sheet.c_str());
    else
        std::printf("%s wrong: %s\n", r.exercise.c_str(), headline(r).c_str());
    for (const Item& i : r.items)
        std::printf("  %-5s  %-11s  %s%s%s\n",
                    i.right         ? "right"
                    : i.costs < 0.5 ? "wrong"
                                    : "WRONG",
                    i.statistical ? "statistical" : "exact", i.what.c_str(),
                    i.seen.empty() || (i.right && !i.statistical) ? "" : ": ",
                    i.right && !i.statistical ? "" : i.seen.c_str());
}

inline std::string json_text(const std::string& text) {
    std::string quoted = "\"";
    for (char c : text)
        if (c == '"' || c == '\\')
            quoted += '\\', quoted += c;
        else if (static_cast<unsigned char>(c) < ' ')
            quoted += ' ';
        else
            quoted += c;
    return quoted + '"';
}

inline void write_json(const std::string& path, const Judgement& r) {
    std::ofstream file(path);
    file << "{\"exercise\": " << json_text(r.exercise) << ", \"state\": " << json_text(r.state)
         << ", \"credit\": " << (r.credit ? oracle::say("%.6g", *r.credit) : "null")
         << ", \"allows\": " << oracle::say("%.6g", r.allows)
         << ",\n \"named\": " << json_text(r.named ? r.named->name : "")
         << ", \"says\": " << json_text(headline(r))
         << ", \"read\": " << json_text(r.named ? r.named->read : "") << ",\n \"items\": [";
    for (size_t i = 0; i < r.items.size(); ++i)
        file << (i ? ",\n  " : "\n  ") << "{\"what\": " << json_text(r.items[i].what)
             << ", \"kind\": \"" << (r.items[i].statistical ? "statistical" : "exact")
             << "\", \"right\": " << (r.items[i].right ? "true" : "false")
             << ", \"costs\": " << r.items[i].costs << ", \"seen\": " << json_text(r.items[i].seen)
             << "}";
    auto write = [&](const char* name, const Out& numbers) {
        file << "],\n \"" << name << "\": [";
        for (size_t i = 0; i < numbers.size(); ++i)
            file << (i ? ", " : "") << json_text(oracle::say("%.13g", numbers[i]));
    };
    write("fingerprint", r.fingerprint);
    write("of_stub", r.of_stub);
    file << "]}\n";
    if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

inline int judge(int argc, char** argv, const std::map<std::string, Judging>& exercises) try {
    std::string mistakes, json, exercise;
    uint64_t seed = oracle::seed_of("course");
    double patience = 5;
    int i = 1;
    for (; i < argc && std::string(argv[i]) != "--"; ++i) {
        const std::string word = argv[i];
        if (word.starts_with("--") && i + 1 == argc) throw std::runtime_error(word + ": of what?");
        if (word == "--mistakes")
            mistakes = argv[++i];
        else if (word == "--json")
            json = argv[++i];
        else if (word == "--seed")
            seed = std::strtoull(argv[++i], nullptr, 10);
        else if (word == "--patience")
            patience = std::strtod(argv[++i], nullptr);
        else
            exercise = word;
    }
    if (!std::getenv("ORACLE_PICTURES")) oracle::pictures = "";  // draws none where nobody looks
    const auto found = exercises.find(exercise);
    if (found == exercises.end()) throw std::runtime_error("no exercise '" + exercise + "' here");
    if (i + 1 >= argc) throw std::runtime_error("say -- and the program that answers");
    const std::vector<KnownMistake> known =
        mistakes.empty() ? std::vector<KnownMistake>{} : read_mistakes(mistakes);
    const Judgement r = [&] {
        try {
            Program program(argv + i + 1, patience);
            return judge_one(exercise, found->second, known, seed, program);
        } catch (const Silence& e) {  // it did not even begin
            const Item item{"all questions are answered", false, false, e.what()};
            return Judgement{{{item}}, exercise, "silent", e.what()};
        }
    }();
    print(r);
    if (!json.empty()) write_json(json, r);
    return r.state == "right" ? 0 : r.state == "open" ? 3 : 1;
} catch (const std::exception& e) {
    std::fprintf(stderr, "judge: %s\n", e.what());
    return 2;
}

}  // namespace penumbra::course
