// labs/readme.cpp  3  writes tables of options and statements from the programs' own
//
//   build/readme
//
// What stands between <!-- options --> and <!-- /options --> of README.md becomes penumbra's table,
// and so do the statements of a scene's file, and in reference/ the options of radiosity.
#include "app/options.h"
#if __has_include("radiosity/options.h")
#include "radiosity/options.h"
#endif
#include "base/files.h"
#include "base/program.h"
#include "world/grammar.h"

namespace {

// The text with a table between its marks.
std::string with_table(const std::string& text, const std::string& name, const std::string& table) {
    const std::string before = "<!-- " + name + " -->\n", after = "<!-- /" + name + " -->";
    const size_t start = text.find(before), end = text.find(after, start);
    if (end == text.npos) throw UserError("no lines " + before + "and " + after + " to write to");
    return text.substr(0, start).append(before).append(table).append(text, end);
}

// One row: `word arguments`, and what is said about it.
std::string row_markdown(Text word, Text arguments, Text meaning, Text otherwise) {
    std::string code(word);
    std::istringstream in{std::string(arguments)};
    for (std::string part; in >> part;) code.append(" ").append(part);
    for (size_t i = 0; (i = code.find('|', i)) != code.npos; i += 2) code.insert(i, 1, '\\');
    std::string row = "| `";
    row.append(code).append("` | ").append(meaning).append(" | ");
    return row.append(otherwise).append(otherwise.empty() ? "|\n" : " |\n");
}

std::string option_markdown(const OptionTable& options) {
    std::string table = "| option | meaning | default |\n|---|---|---|\n";
    for (const Option& row : options)
        table += row_markdown(row.name, row.value, row.help, row.otherwise);
    return table;
}

std::string grammar_markdown() {
    std::string table = "| statement | meaning | default |\n|---|---|---|\n";
    for (const Statement& row : grammar)
        table += row_markdown(row.keyword, row.words, row.meaning, row.otherwise);
    return table;
}

int run(const std::vector<std::string>& words) {
    const std::string usage = "usage: readme";
    if (words.size() == 1 && (words[0] == "--help" || words[0] == "-h")) {
        std::printf(
            "%s\nWrites the tables of options and statements of README.md and reference/.\n",
            usage.c_str());
        return 0;
    }
    if (!words.empty()) throw UserError(usage);
    Options o;
    const std::string options =
        with_table(read_file("README.md"), "options", option_markdown(option_table(o)));
    write_file("README.md", with_table(options, "statements", grammar_markdown()));
#if __has_include("radiosity/options.h")
    RadiosityOptions r;
    const std::string page = "reference/radiosity-options.md";
    write_file(page, with_table(read_file(page), "options", option_markdown(radiosity_table(r))));
#endif
    return 0;
}

}  // namespace

int main(int argc, char** argv) try { return finished(run({argv + 1, argv + argc})); } catch (...) {
    return failed();
}
