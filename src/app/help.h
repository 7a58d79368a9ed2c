// app/help.h  2  options and statements in words: for --help, and for the README
#pragma once
#include <sstream>

#include "app/options.h"
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

inline std::string help_page() {
    constexpr size_t indent = 24;
    std::string page =
        "usage: penumbra [options] SCENE\n\nRenders SCENE (a file in the format of scenes/*.scene) "
        "by path tracing.\n\n";
    for (const Option& row : option_table) {
        std::string line = "  " + std::string(row.name) + " " + std::string(row.value) + " ";
        if (line.size() > indent) line.back() = '\n';
        line.append(line.size() > indent ? indent : indent - line.size(), ' ');
        page += line;
        std::string text(row.help);
        if (!row.otherwise.empty()) text.append(" (default: ").append(row.otherwise).append(")");
        wrap(page, text, indent);
    }
    return page + R"(
A .pfm holds linear radiance; a .png holds exposure times radiance, clamped to
[0,1] and encoded as sRGB.  Pixel (0,0) is the top left one.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C; 143 SIGTERM,
129 SIGHUP), after writing the image of the passes completed so far.
)";
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

inline std::string help_markdown() {
    std::string table = "| option | meaning | default |\n|---|---|---|\n";
    for (const Option& row : option_table)
        table += row_markdown(row.name, row.value, row.help, row.otherwise);
    return table;
}

inline std::string grammar_markdown() {
    std::string table = "| statement | meaning | default |\n|---|---|---|\n";
    for (const Statement& row : grammar)
        table += row_markdown(row.keyword, row.words, row.meaning, row.otherwise);
    return table;
}
