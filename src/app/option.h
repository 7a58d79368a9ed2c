// app/option.h  1  a program's options as one table of rows, and what all programs are asked
//
// Parsing, --help, suggestions, --stats and the README's tables all follow from the rows.  O is the
// struct that a program's options are read into; it inherits CommonOptions.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "base/words.h"
#include "film/passes.h"

struct CommonOptions {
    std::string scene;
    std::vector<std::string> outputs;
    double seconds = 0;  // to stop after; 0: no limit
    uint64_t seed = 0;
    unsigned threads = all_cores();
    std::optional<Size> size;      // default: the scene's
    std::optional<real> exposure;  // default: the scene's
    std::string stats;             // file, or empty
    bool quiet = false, help = false;
    std::vector<std::string_view> given;  // names of options that the user gave
};

inline bool is_given(const CommonOptions& o, std::string_view name) {
    return std::find(o.given.begin(), o.given.end(), name) != o.given.end();
}

// ---- Values -------------------------------------------------------------------------------------

namespace option {

inline double positive(std::string_view text) {
    double x = parse_number(text);
    if (!(x > 0)) throw UserError(in_quotes(text) + " is not positive");
    return x;
}

inline Size size(std::string_view text) {
    size_t x = text.find('x');
    if (x == text.npos) throw UserError(in_quotes(text) + " is not WIDTHxHEIGHT");
    return parse_size(text.substr(0, x), text.substr(x + 1));
}

inline std::string image(std::string_view text) {
    if (!text.ends_with(".png") && !text.ends_with(".pfm"))
        throw UserError(in_quotes(text) + " ends neither in .png nor in .pfm");
    return std::string(text);
}

// The words of "none|nee|mis".
inline std::vector<std::string_view> words_of(std::string_view alternatives) {
    std::vector<std::string_view> words;
    for (size_t from = 0, to = 0; to != alternatives.npos; from = to + 1) {
        to = alternatives.find('|', from);
        words.push_back(alternatives.substr(from, to - from));
    }
    return words;
}

// The index of `text` among them.
inline size_t choice(std::string_view text, std::string_view alternatives) {
    const auto known = words_of(alternatives);
    const auto found = std::find(known.begin(), known.end(), text);
    if (found == known.end()) throw UserError(unknown("value", text, known));
    return size_t(found - known.begin());
}

}  // namespace option

// ---- Rows ---------------------------------------------------------------------------------------

using Text = std::string_view;

// Functions are plain pointers: std::function would cost every file that includes this a second.
template <class O>
struct Option {
    Text name;
    Text value;           // what stands after it; "": nothing
    Text help;            // what it is for
    Text otherwise = {};  // without it; "": nothing
    void (*assign)(O&, Text);
    std::string (*json)(const O&) = nullptr;  // its value; none: not in --stats
    // Of a choice instead: its word's index among those of `value`.
    void (*choose)(O&, size_t) = nullptr;
    size_t (*chosen)(const O&) = nullptr;

    void set(O& o, Text v) const {
        if (choose)
            choose(o, option::choice(v, value));
        else
            assign(o, v);
    }
    std::string stats(const O& o) const {  // "": nothing
        if (chosen) return '"' + std::string(option::words_of(value)[chosen(o)]) + '"';
        return json ? json(o) : "";
    }
};

template <class O>
using OptionTable = std::vector<Option<O>>;

// One of several words, which stand in the order of their enumeration; at(o) is where it is kept.
template <class O, class At>
Option<O> one_of(Text name, Text words, Text help, At) {
    using Enum = std::remove_reference_t<decltype(At()(std::declval<O&>()))>;
    auto choose = [](O& o, size_t k) { At()(o) = Enum(k); };
    auto chosen = [](const O& o) { return size_t(At()(o)); };
    const Text otherwise = option::words_of(words)[chosen({})];
    return {name, words, help, otherwise, nullptr, nullptr, choose, chosen};
}

// The rows of CommonOptions.
template <class O>
struct CommonRows {
    static Option<O> output(Text otherwise) {
        return {"-o", "FILE", "image to write, .png or .pfm; may be repeated", otherwise,
                [](O& o, Text v) { o.outputs.push_back(option::image(v)); }};
    }
    static Option<O> time(Text help) {
        return {"--time", "S", help, "", [](O& o, Text v) { o.seconds = option::positive(v); }};
    }
    static Option<O> seed() {
        return {"--seed",
                "N",
                "another seed, another noise",
                "0",
                [](O& o, Text v) { o.seed = parse_count(v, 0, UINT64_MAX); },
                [](const O& o) { return std::to_string(o.seed); }};
    }
    static Option<O> threads() {
        return {"--threads",
                "N",
                "the image does not depend on it",
                "all cores",
                [](O& o, Text v) { o.threads = unsigned(parse_count(v, 1, 1024)); },
                [](const O& o) { return std::to_string(o.threads); }};
    }
    static Option<O> size() {
        return {"--size", "WxH",
                "pixels, e.g. 256x128; pixels are square, and the field of view is vertical",
                "the scene's", [](O& o, Text v) { o.size = option::size(v); }};
    }
    static Option<O> exposure() {
        return {"--exposure", "E", "factor from radiance to PNG", "the scene's",
                [](O& o, Text v) { o.exposure = real(option::positive(v)); }};
    }
    static Option<O> stats() {
        return {"--stats", "FILE", "write what was measured, as JSON", "",
                [](O& o, Text v) { o.stats = v; }};
    }
    static Option<O> quiet() {
        return {"--quiet", "", "print nothing but errors", "", [](O& o, Text) { o.quiet = true; }};
    }
    static Option<O> help() {
        return {"--help", "", "print this, as -h does", "", [](O& o, Text) { o.help = true; }};
    }
};

// How the user would write that option: "--light nee".
template <class O>
std::string as_written(const OptionTable<O>& table, const O& o, std::string_view name) {
    for (const Option<O>& row : table)
        if (row.name == name) {
            std::string word = row.stats(o);
            std::erase(word, '"');
            return std::string(name) + " " + word;
        }
    return std::string(name);
}

// ---- Words to options ---------------------------------------------------------------------------

// Throws UserError about the first word that cannot be used.
template <class O>
O parse_words(const OptionTable<O>& table, const std::vector<std::string>& words) {
    std::vector<Text> known;
    for (const Option<O>& row : table) known.push_back(row.name);
    O o;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string word = words[i] == "-h" ? "--help" : words[i];
        const auto row = std::find_if(table.begin(), table.end(),
                                      [&](const Option<O>& r) { return r.name == word; });
        if (row != table.end()) {
            const bool has_value = !row->value.empty();
            if (has_value && i + 1 == words.size()) throw UserError(word + ": needs a value");
            try {
                row->set(o, has_value ? words[++i] : "");
                o.given.push_back(row->name);
            } catch (const UserError& e) {
                throw UserError(word + ": " + e.what());
            }
        } else if (word.starts_with('-')) {
            throw UserError(unknown("option", word, known));
        } else if constexpr (requires { o.parts; }) {
            o.parts.push_back(word);
        } else if (!o.scene.empty()) {
            throw UserError("two scenes: " + in_quotes(o.scene) + " and " + in_quotes(word));
        } else {
            o.scene = word;
            if (word.empty()) throw UserError("the scene's name is empty");
        }
    }
    return o;
}

inline void need_scene(const CommonOptions& o) {
    if (o.scene.empty()) throw UserError("no scene given (try --help)");
}
