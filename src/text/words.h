// text/words.h  1  user errors, numbers from words, suggestions
#pragma once
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace penumbra {

// The user's input cannot be used: message for stderr, exit status 2.
struct UserError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The system failed, as with a full disk: message for stderr, exit status 1.
struct SystemError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Keys and values, as a file or a report has them.
using Facts = std::vector<std::array<std::string, 2>>;

// A message for one line of a terminal: '?' replaces control characters, which might move the
// cursor.  File names may contain them.  Other characters stay, ASCII or not.
inline std::string printable(std::string text) {
    unsigned char before = 0;
    for (char& c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool c1 = before == 0xc2 && byte < 0xa0;  // U+0080 to U+009F in UTF-8
        if (byte < ' ' || byte == 0x7f || c1) c = '?';
        before = byte;
    }
    return text;
}

// The user's word for a message: shortened, with '?' for characters that are not printable ASCII.
inline std::string in_quotes(std::string_view word) {
    std::string shown(word.substr(0, 40));
    for (char& c : shown)
        if (c < ' ' || c > '~') c = '?';
    return "'" + shown + (word.size() > 40 ? "...'" : "'");
}

// The whole of `text` as a decimal number in [-largest, largest]; throws UserError otherwise.  No
// statement or option needs more than 1e30, and float holds it.  strtod rounds correctly, and reads
// '.' because no program sets a locale.  It accepts leading blanks and hexadecimal digits; we do
// not.
inline constexpr double max_number = 1e30;
inline double parse_number(std::string_view text, double largest = max_number) {
    const std::string word(text);
    char* end = nullptr;
    const double x = std::strtod(word.c_str(), &end);
    const bool whole = !word.empty() && end == word.c_str() + word.size();
    if (!whole || std::isnan(x) || word.find_first_of(" \t\n\v\f\rxX") != word.npos)
        throw UserError(in_quotes(text) + " is not a number");
    if (std::abs(x) > largest) throw UserError(in_quotes(text) + " is too large");
    return x;
}

// The whole of `text` as a number of [0,1], or, if a percent sign follows it, in hundredths: "2%"
// is 0.02.  Throws UserError otherwise.
inline double parse_fraction(std::string_view text) {
    const bool percent = text.ends_with('%');
    const double x = parse_number(text.substr(0, text.size() - percent));
    if (x < 0) throw UserError(in_quotes(text) + " is negative");
    if (x > 1 && !percent)
        throw UserError(in_quotes(text) + " is more than 100 %; for percent say " +
                        std::string(text) + "%");
    return percent ? x / 100 : x;
}

// The whole of `text` as a whole number of [least, most]; throws UserError otherwise.
inline uint64_t parse_count(std::string_view text, uint64_t least, uint64_t most) {
    uint64_t n = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    bool whole = error == std::errc() && end == text.data() + text.size();
    if (!whole || n < least || n > most)
        throw UserError(in_quotes(text) + " is not a whole number from " + std::to_string(least) +
                        " to " + std::to_string(most));
    return n;
}

// "1 sample", "2 samples"
inline std::string counted(const std::string& number, const std::string& noun) {
    return number + " " + noun + (number == "1" ? "" : "s");
}
inline std::string counted(uint64_t n, const std::string& noun) {
    return counted(std::to_string(n), noun);
}

// Rejects large images before anything is allocated.
inline Size parse_size(std::string_view width, std::string_view height) {
    constexpr uint64_t longest = 1 << 16, most = 1 << 30;
    uint64_t w = parse_count(width, 1, longest), h = parse_count(height, 1, longest);
    if (w * h > most)
        throw UserError("an image of " + std::to_string(w) + "x" + std::to_string(h) +
                        " has more than " + std::to_string(most) + " pixels");
    return {int(w), int(h)};
}

// The words of a line before a comment, separated by white space; those with blanks in quotes.
using Words = std::vector<std::string>;
inline Words words_before(std::string_view line, char comment) {
    constexpr std::string_view space = " \t\n\v\f\r";
    Words words;
    for (size_t end = 0, start; (start = line.find_first_not_of(space, end)) != line.npos;) {
        const bool quoted = line[start] == '"';
        if (quoted && (end = line.find('"', start + 1)) == line.npos)
            throw UserError("a quote that does not end");
        if (!quoted)
            end = std::min(
                {line.find_first_of(space, start), line.find(comment, start), line.size()});
        if (start == end) break;
        words.emplace_back(line.substr(start + quoted, end - start - quoted));
        end += quoted;
    }
    return words;
}

inline UserError error_at(const std::string& file, uint32_t line, const std::string& why) {
    return UserError(file + ":" + std::to_string(line) + ": " + why);
}

// Calls read(line, number) for every line of a file's text; \n, \r\n or \r ends it.  UserErrors get
// the name of the file and the number.
template <class Read>
void read_lines(std::string_view text, const std::string& file, Read read) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
    for (uint32_t number = 1; !text.empty(); ++number) {
        const auto ends = [](char c) { return c == '\r' || c == '\n'; };
        const size_t end = size_t(std::ranges::find_if(text, ends) - text.begin());
        try {
            read(text.substr(0, end), number);
        } catch (const UserError& e) {
            throw error_at(file, number, e.what());
        }
        const size_t next = end + 1 + text.substr(end).starts_with("\r\n");
        text.remove_prefix(std::min(next, text.size()));
    }
}

// Number of single-letter edits from a to b (Levenshtein 1966).
inline size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = row[0]++;
        for (size_t j = 0; j < b.size(); ++j) {
            size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

// "unknown WHAT 'word'", and " (did you mean 'nearest'?)" if a known word is near: it begins with
// the word, or edits of at most half of the longer word's letters lead to it.  Only the first 100
// letters count.
inline std::string unknown(std::string_view what, std::string_view word,
                           const std::vector<std::string_view>& known) {
    std::string_view nearest;
    size_t least = SIZE_MAX;
    for (std::string_view k : known) {
        const std::string_view a = word.substr(0, 100), b = k.substr(0, 100);
        const size_t edits = !a.empty() && b.starts_with(a) ? 1 : edit_distance(a, b);
        if (2 * edits <= std::max(a.size(), b.size()) && edits < least) least = edits, nearest = k;
    }
    return "unknown " + std::string(what) + " " + in_quotes(word) +
           (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + "?)");
}

// The value of this name; throws UserError "unknown WHAT 'name' (did you mean 'other'?)".
template <class Value>
const Value& look_up(const std::map<std::string, Value>& defined, const std::string& name,
                     std::string_view what) {
    const auto found = defined.find(name);
    if (found != defined.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [other, value] : defined) known.push_back(other);
    throw UserError(unknown(what, name, known));
}

}  // namespace penumbra
