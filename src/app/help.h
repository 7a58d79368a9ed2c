// app/help.h  2  options and statements in words: for --help, and for the README
#pragma once
#include <sstream>

#include "app/option.h"
#include "world/grammar.h"

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

// A line or two for every option.
template <class O>
std::string option_lines(const OptionTable<O>& table) {
    constexpr size_t indent = 24;
    std::string page;
    for (const Option<O>& row : table) {
        std::string line = "  " + std::string(row.name) + " " + std::string(row.value) + " ";
        if (line.size() > indent) line.back() = '\n';
        line.append(line.size() > indent ? indent : indent - line.size(), ' ');
        page += line;
        std::string text(row.help);
        if (!row.otherwise.empty()) text.append(" (default: ").append(row.otherwise).append(")");
        wrap(page, text, indent);
    }
    return page;
}

// ---- Tables of the README -----------------------------------------------------------------------

// One row: `word arguments`, and what is said about it.
inline std::string row_markdown(std::string_view word, std::string_view arguments,
                                std::string_view meaning, std::string_view otherwise) {
    std::string code(word);
    std::istringstream in{std::string(arguments)};
    for (std::string part; in >> part;) code.append(" ").append(part);
    for (size_t i = 0; (i = code.find('|', i)) != code.npos; i += 2) code.insert(i, 1, '\\');
    std::string row = "| `";
    row.append(code).append("` | ").append(meaning).append(" | ");
    return row.append(otherwise).append(otherwise.empty() ? "|\n" : " |\n");
}

template <class O>
std::string option_markdown(const OptionTable<O>& options) {
    std::string table = "| option | meaning | default |\n|---|---|---|\n";
    for (const Option<O>& row : options)
        table += row_markdown(row.name, row.value, row.help, row.otherwise);
    return table;
}

inline std::string grammar_markdown() {
    std::string table = "| statement | meaning | default |\n|---|---|---|\n";
    for (const Statement& row : grammar)
        table += row_markdown(row.keyword, row.words, row.meaning, row.otherwise);
    return table;
}
