// app/help.h  2  the options in words: for --help, and for the README
#pragma once
#include <sstream>

#include "app/options.h"

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
        if (line.size() < indent) line.resize(indent, ' ');
        page += line;
        std::string text(row.help);
        if (!row.otherwise.empty()) text.append(" (default: ").append(row.otherwise).append(")");
        wrap(page, text, indent);
    }
    return page + R"(
A .pfm holds linear radiance; a .png holds exposure times radiance, clamped to
[0,1] and encoded as sRGB.  Pixel (0,0) is the top left one.

Exit status: 0 done; 1 a sample was not finite, or a file could not be written;
2 the scene or an option cannot be used; 130 interrupted (Ctrl-C), after writing
the image of the passes completed so far.
)";
}

inline std::string help_markdown() {
    std::string table = "| option | meaning | default |\n|---|---|---|\n";
    for (const Option& row : option_table) {
        std::string value(row.value);
        for (size_t i = 0; (i = value.find('|', i)) != value.npos; i += 2) value.insert(i, "\\");
        table += "| `" + std::string(row.name) + (value.empty() ? "" : " ") + value + "` | " +
                 std::string(row.help) + " | " +
                 (row.otherwise.empty() ? "" : std::string(row.otherwise)) + " |\n";
    }
    return table;
}
