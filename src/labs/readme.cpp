// labs/readme.cpp  4  writes tables of options and scene statements into documents
//
//   build/readme
//
// It replaces the text between <!-- options --> and <!-- /options --> of reference/options.md by
// the options of penumbra, and of reference/radiosity-options.md by those of radiosity.  The
// statements of a scene's file go to reference/scenes.md.
#include "labs/page.h"
#include "text/scene_file.h"

namespace {
using namespace penumbra;

// Replaces the text between the two marks of a table.
void write_table(const std::string& file, const std::string& name, const std::string& table) {
    const std::string text = read_file(file), before = "<!-- " + name + " -->\n";
    const size_t start = text.find(before), end = text.find("<!-- /" + name + " -->", start);
    if (end == text.npos) throw UserError(file + ": no place for the table of " + name);
    write_file(file, text.substr(0, start).append(before).append(table).append(text, end));
}

std::string one_line(const std::string& text) {
    std::string line;
    for (const std::string& word : words_in(text)) line += (line.empty() ? "" : " ") + word;
    return line;
}
std::string code(const std::string& text) {
    std::string line = one_line(text);
    for (size_t i = 0; (i = line.find('|', i)) != line.npos; i += 2) line.insert(i, 1, '\\');
    return "`" + line + "`";
}

// The tables of a program's --help, one for each group: a heading ends with a colon, an option is
// indented by 2 columns, and its meaning by 24.
std::string option_tables(const std::string& help) {
    std::string page, heading;
    Lines rows;
    auto end = [&] {
        for (auto& row : rows) {
            row[1] = one_line(row[1]);
            const size_t at = row[1].rfind(" (default: ");
            if (at == std::string::npos || row[1].back() != ')') continue;
            row[2] = row[1].substr(at + 11, row[1].size() - at - 12), row[1].resize(at);
        }
        if (!rows.empty())
            page += (page.empty() ? "### " : "\n### ") + heading + "\n\n" +
                    table({"option", "meaning", "default"}, rows) + "\n";
        rows.clear();
    };
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("  -")) {
            const size_t gap = std::min(line.find("  ", 2), line.size());
            rows.push_back({code(line.substr(0, gap)), line.substr(gap), ""});
        } else if (line.starts_with(std::string(24, ' ')) && !rows.empty()) {
            rows.back()[1] += line;
        } else if (end(); line.ends_with(':') && line[0] != ' ') {
            heading = line.substr(0, line.size() - 1);
        }
    }
    end();
    return page;
}

int write_all(const Scope& scope) {
    for (const std::string& prefix : {std::string(), std::string("radiosity-")}) {
        const std::string program = scope.beside(prefix.empty() ? "penumbra" : "radiosity");
        write_table("reference/" + prefix + "options.md", "options",
                    option_tables(said_by(program + " --help")));
    }
    Lines rows;
    for (const Statement& s : grammar)
        rows.push_back({code(std::string(s.keyword) + " " + std::string(s.words)),
                        std::string(s.meaning), std::string(s.default_text)});
    write_table("reference/scenes.md", "statements",
                table({"statement", "meaning", "default"}, rows) + "\n");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return experiment(argc, argv,
                      {"readme", "Writes tables of options and statements into reference/."},
                      write_all);
}
