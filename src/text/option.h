// text/option.h  3  a program's options: one table of rows
//
// Parsing, --help, suggestions, the first lines of --stats and the tables in reference/ follow from
// the rows.  A row holds functions that read and write the program's own variables.
#pragma once
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "text/json.h"
#include "text/program.h"
#include "text/words.h"

namespace penumbra {

using Text = std::string_view;

struct Option {
    Text name;                 // "--spp"
    std::string value;         // "N", or "none|nee|mis"; "": none
    Text help;                 // its meaning
    std::string default_text;  // the default; "": nothing
    std::function<void(Text)> set;
    std::function<std::string()> json = {};  // its value in --stats; none: not there
    Text also = {};                          // another name
    Text group = {};                         // heading in --help
    bool given = false;                      // the user gave this option
};
using OptionTable = std::vector<Option>;

// Throws UserError if there is no such row.
inline Option& row(OptionTable& table, Text name) {
    std::vector<Text> known;
    for (Option& r : table) {
        if (name == r.name || name == r.also) return r;
        known.push_back(r.name);
        if (!r.also.empty()) known.push_back(r.also);
    }
    throw UserError(unknown("option", name, known));
}
inline bool is_given(OptionTable& table, Text name) { return row(table, name).given; }
inline OptionTable operator+(OptionTable a, const OptionTable& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
inline OptionTable in_group(Text group, OptionTable rows) {
    for (Option& r : rows) r.group = group;
    return rows;
}
inline OptionTable without(OptionTable table, const std::vector<Text>& names) {
    std::erase_if(table, [&](auto& r) { return std::ranges::count(names, r.name) > 0; });
    return table;
}

// ---- Values -------------------------------------------------------------------------------------

// Words and what they stand for.
template <class Value>
using Alternatives = std::vector<std::pair<Text, Value>>;

template <class Value>
Text word_of(const Alternatives<Value>& alternatives, Value value) {
    const auto at = std::ranges::find(alternatives, value, &std::pair<Text, Value>::second);
    return alternatives.at(size_t(at - alternatives.begin())).first;  // throws: it has no word
}
// Throws UserError "unknown WHAT 'word' (did you mean ...?)".
template <class Value>
Value value_of(const Alternatives<Value>& alternatives, Text what, Text word) {
    std::vector<Text> known;
    for (const auto& [name, value] : alternatives) {
        if (name == word) return value;
        known.push_back(name);
    }
    throw UserError(unknown(what, word, known));
}

// One of several words; `at` holds the default.
template <class Value>
Option one_of(Text name, const std::type_identity_t<Alternatives<Value>>& alternatives, Text help,
              Value& at) {
    std::string words;
    for (const auto& [word, value] : alternatives)
        words.append(words.empty() ? "" : "|").append(word);
    auto set = [=, &at](Text text) { at = value_of(alternatives, "value", text); };
    auto word = [=, &at] { return std::string(word_of(alternatives, at)); };
    return {name, words, help, word(), set, [word] { return json::string(word()); }};
}

// A whole number of [least, most].
template <class Whole>
Option whole_number(Text name, Text help, std::string default_text, Whole& at, uint64_t least,
                    uint64_t most) {
    auto set = [&at, least, most](Text v) { at = Whole(parse_count(v, least, most)); };
    return {name, "N", help, std::move(default_text), set};
}

inline double parse_positive(Text text) {
    const double x = parse_number(text);
    if (!(x > 0)) throw UserError(in_quotes(text) + " is not positive");
    return x;
}

// A relative error: "1%" or "0.01".
inline double parse_error(Text text) {
    const double E = parse_fraction(text);
    if (!(E > 0 && E < 1)) throw UserError(in_quotes(text) + " is not between 0 and 100 %");
    return E;
}

// The two parts of "256x128" or "10-19".
inline std::array<Text, 2> parts_of(Text text, char between, Text form) {
    const size_t at = text.find(between);
    if (at == text.npos) throw UserError(in_quotes(text) + " is not " + std::string(form));
    return {text.substr(0, at), text.substr(at + 1)};
}

// ---- Options of every program -------------------------------------------------------------------

struct CommonOptions {
    std::string scene;
    std::vector<std::string> outputs;
    double seconds = 0;  // to stop after; 0: no limit
    uint64_t seed = 0;
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    std::optional<Size> size;        // default: the scene's
    std::optional<double> exposure;  // default: the scene's
    std::string stats;               // file, or empty
    bool quiet = false, help = false, version = false;
};

inline OptionTable output_rows(CommonOptions& o, std::string default_text) {
    auto set = [&o](Text v) {
        if (!v.ends_with(".png") && !v.ends_with(".pfm") && !v.ends_with(".hdr"))
            throw UserError(in_quotes(v) + " must end in .png, .pfm or .hdr");
        o.outputs.emplace_back(v);
    };
    auto set_size = [&o](Text v) {
        const auto [width, height] = parts_of(v, 'x', "WIDTHxHEIGHT");
        o.size = parse_size(width, height);
    };
    OptionTable rows = {
        {"-o", "FILE", "image to write (.png, .pfm or .hdr); may be repeated",
         std::move(default_text), set},
        {"--size", "WxH", "width and height in pixels, e.g. 256x128; the field of view is vertical",
         "the scene's", set_size},
        {"--exposure", "E", "factor from radiance to PNG", "the scene's",
         [&o](Text v) { o.exposure = parse_positive(v); }},
        {"--stats", "FILE", "write options and measurements as JSON", "",
         [&o](Text v) { o.stats = v; }}};
    rows[0].also = "--output";
    return in_group("Output", rows);
}

inline Option seed_row(CommonOptions& o) {
    Option seed = whole_number("--seed", "random seed", "0", o.seed, 0, UINT64_MAX);
    seed.json = [&o] { return std::to_string(o.seed); };
    seed.group = "Sampling";
    return seed;
}

inline OptionTable general_rows(CommonOptions& o) {
    OptionTable rows = {whole_number("--threads", "number of threads; it does not change the image",
                                     "all cores", o.threads, 1, 1024),
                        {"--quiet", "", "print errors only", "", [&o](Text) { o.quiet = true; }},
                        {"--help", "", "show this help", "", [&o](Text) { o.help = true; }},
                        {"--version", "", "show commit, precision and compiler", "",
                         [&o](Text) { o.version = true; }}};
    rows[0].json = [&o] { return std::to_string(o.threads); };
    rows[2].also = "-h";
    return in_group("General", rows);
}

// ---- Words to options ---------------------------------------------------------------------------

// Passes words that are no options, and all words after "--", to `other`.  Throws UserError about
// the first word that cannot be used.
inline void parse_words(OptionTable& table, const std::vector<std::string>& words,
                        const std::function<void(const std::string&)>& other) {
    bool is_ended = false;
    for (size_t i = 0; i < words.size(); ++i) {
        if (is_ended || !words[i].starts_with('-')) {
            other(words[i]);
            continue;
        }
        is_ended = words[i] == "--";
        if (is_ended) continue;
        // "--spp=64" is "--spp 64".
        const size_t equals = words[i].starts_with("--") ? words[i].find('=') : std::string::npos;
        const std::string word = words[i].substr(0, equals);
        Option& r = row(table, word);
        const bool joined = equals != std::string::npos;
        if (joined && r.value.empty()) throw UserError(word + ": takes no value");
        if (!joined && !r.value.empty() && i + 1 == words.size())
            throw UserError(word + ": needs a value");
        try {
            r.set(r.value.empty() ? "" : joined ? words[i].substr(equals + 1) : words[++i]);
            r.given = true;
        } catch (const UserError& e) {
            throw UserError(word + ": " + e.what());
        }
    }
}

// The same for a program of one scene.
inline void parse_words(OptionTable& table, const std::vector<std::string>& words,
                        CommonOptions& o) {
    parse_words(table, words, [&o](const std::string& word) {
        if (word.empty()) throw UserError("the scene's name is empty");
        if (!o.scene.empty())
            throw UserError("two scenes: " + in_quotes(o.scene) + " and " + in_quotes(word));
        o.scene = word;
    });
    if (!o.help && !o.version && o.scene.empty()) throw UserError("no scene given (try --help)");
}

// ---- Options to words ---------------------------------------------------------------------------

// The user's options, which come first in --stats.
inline json::Object asked_for(const OptionTable& table, const std::string& scene, Size size) {
    json::Object object;
    object.add("scene", json::string(scene));
    object.add("width", std::to_string(size.width));
    object.add("height", std::to_string(size.height));
    for (const Option& r : table)
        if (r.json) object.add(std::string(r.name.substr(2)), r.json());
    return object;
}

// Appends text to a page, broken into lines of less than 80 columns; further lines are indented.
inline void wrap(std::string& page, const std::string& text, size_t indent) {
    std::istringstream words(text);
    size_t column = page.size() - (page.rfind('\n') + 1);
    for (std::string word; words >> word; column += word.size() + 1) {
        if (column + word.size() >= 80) {
            page.back() = '\n';
            page.append(column = indent, ' ');
        }
        page += word + " ";
    }
    page.back() = '\n';
}

// "-o, --output FILE"
inline std::string usage_of(const Option& r) {
    return std::string(r.name) + (r.also.empty() ? "" : ", ") + std::string(r.also) +
           (r.value.empty() ? "" : " ") + r.value;
}

// A line or two for every option, under the headings of groups; these come in the order of their
// first rows.
inline std::string option_lines(const OptionTable& table) {
    constexpr size_t indent = 24;
    std::vector<Text> groups;
    for (const Option& r : table)
        if (std::ranges::count(groups, r.group) == 0) groups.push_back(r.group);
    std::string page;
    for (const Text group : groups) {
        if (!group.empty()) page.append(page.empty() ? "" : "\n").append(group).append(":\n");
        for (const Option& r : table) {
            if (r.group != group) continue;
            std::string line = "  " + usage_of(r) + " ";
            if (line.size() > indent) line.back() = '\n';
            line.append(line.size() > indent ? indent : indent - line.size(), ' ');
            page += line;
            std::string text(r.help);
            if (!r.default_text.empty()) text += " (default: " + r.default_text + ")";
            wrap(page, text, indent);
        }
    }
    return page;
}

// Prints the help, between these texts, or the version; false: the user asked for neither.
inline bool print_manual(const CommonOptions& o, const OptionTable& table, const char* before,
                         const char* after) {
    if (o.help) std::printf("%s%s%s", before, option_lines(table).c_str(), after);
    if (o.version && !o.help) std::printf("%s\n", version().c_str());
    return o.help || o.version;
}

}  // namespace penumbra
