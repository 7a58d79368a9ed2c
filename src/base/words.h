// base/words.h  1  errors that the user can mend
#pragma once
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// What the user wrote cannot be used: message for stderr, exit status 2.
struct UserError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The machine failed us (a full disk, say): message for stderr, exit status 1.
struct SystemError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The user's word for a message: shortened, with '?' for what a terminal might not print.
inline std::string in_quotes(std::string_view word) {
    std::string shown(word.substr(0, 40));
    for (char& c : shown)
        if (c < ' ' || c > '~') c = '?';
    return "'" + shown + (word.size() > 40 ? "...'" : "'");
}

// The whole of `text` as a number of [-largest, largest]; throws UserError otherwise.  1e30 is the
// most that any statement or option needs, and float holds it.
inline constexpr double largest_number = 1e30;
inline double parse_number(std::string_view text, double largest = largest_number) {
    const bool plus = text.starts_with('+') && !text.starts_with("+-");
    std::string_view digits = text.substr(plus);
    double x = 0;
    auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (error == std::errc::result_out_of_range)
        throw UserError(in_quotes(text) + " is out of range");
    if (error != std::errc() || end != digits.data() + digits.size())
        throw UserError(in_quotes(text) + " is not a number");
    if (!std::isfinite(x)) throw UserError(in_quotes(text) + " is not finite");
    if (std::abs(x) > largest) throw UserError(in_quotes(text) + " is too large");
    return x;
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

// Width and height of an image, refused before anything is allocated for it.
struct Size {
    int width = 0, height = 0;
};
inline Size parse_size(std::string_view width, std::string_view height) {
    constexpr uint64_t longest = 1 << 16, most = 1 << 25;
    uint64_t w = parse_count(width, 1, longest), h = parse_count(height, 1, longest);
    if (w * h > most)
        throw UserError("an image of " + std::to_string(w) + "x" + std::to_string(h) +
                        " has more than " + std::to_string(most) + " pixels");
    return {int(w), int(h)};
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

// "unknown WHAT 'word' (did you mean 'nearest'?)"
inline std::string unknown(std::string_view what, std::string_view word,
                           const std::vector<std::string_view>& known) {
    auto nearest = *std::min_element(known.begin(), known.end(), [&](auto a, auto b) {
        return edit_distance(word, a) < edit_distance(word, b);
    });
    return "unknown " + std::string(what) + " " + in_quotes(word) + " (did you mean '" +
           std::string(nearest) + "'?)";
}
