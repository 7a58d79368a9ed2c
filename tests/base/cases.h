// base/cases.h  compact tables of test cases
#pragma once
#include <charconv>
#include <sstream>
#include <string>
#include <vector>

// Splits a command line into words: "--spp 1 ''" has three, and the last is empty.
inline std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream in(line);
    for (std::string word; in >> word;) words.push_back(word == "''" ? "" : word);
    return words;
}

// Splits text at its semicolons.
inline std::vector<std::string> parts_of(const std::string& text) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ';');) parts.push_back(part);
    return parts;
}

// Replaces each @ in `text` with the value.
inline std::string with(std::string text, const std::string& value) {
    for (size_t at; (at = text.find('@')) != text.npos;) text.replace(at, 1, value);
    return text;
}

struct Refusal {
    std::string words, why;
};

// Words with a placeholder @, and values for it that must all be refused; ~ is the empty value.
struct Family {
    std::string words, values, why;
};
inline std::vector<Refusal> members(const std::vector<Family>& families) {
    std::vector<Refusal> rows;
    for (const Family& f : families)
        for (const std::string& value : f.values.empty() ? parts_of("~") : parts_of(f.values))
            rows.push_back({with(f.words, value == "~" ? "''" : value),
                            with(f.why, value == "~" ? "" : value)});
    return rows;
}

// The shortest text that distinguishes a value from its neighbours.  Several values are separated
// by blanks, so that a failed comparison shows all of them.
template <class T>
std::string said(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        return value ? "yes" : "no";
    } else if constexpr (std::is_enum_v<T>) {
        return said(int(value));
    } else if constexpr (std::is_arithmetic_v<T>) {
        char letters[40];
        return {letters, std::to_chars(letters, letters + sizeof letters, value).ptr};
    } else {
        return std::string(value);
    }
}
template <class T, class... Others>
std::string said(const T& value, const Others&... others) {
    return (said(value) + ... + (" " + said(others)));
}
