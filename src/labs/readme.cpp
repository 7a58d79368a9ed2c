// labs/readme.cpp  3  writes tables of options and statements from the programs' own
//
//   build/readme
//
// What stands between <!-- options --> and <!-- /options --> of README.md becomes penumbra's table,
// and so do the statements of a scene's file, and in reference/ the options of radiosity.
#include "app/help.h"
#include "app/options.h"
#include "app/radiosity_options.h"
#include "base/files.h"
#include "base/program.h"

namespace {

// The text with a table between its marks.
std::string with_table(const std::string& text, const std::string& name, const std::string& table) {
    const std::string before = "<!-- " + name + " -->\n", after = "<!-- /" + name + " -->";
    const size_t start = text.find(before), end = text.find(after, start);
    if (end == text.npos) throw UserError("no lines " + before + "and " + after + " to write to");
    return text.substr(0, start).append(before).append(table).append(text, end);
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
    const std::string readme = read_file("README.md"),
                      page = read_file("reference/radiosity-options.md");
    const std::string options = with_table(readme, "options", option_markdown(option_table));
    write_file("README.md", with_table(options, "statements", grammar_markdown()));
    write_file("reference/radiosity-options.md",
               with_table(page, "options", option_markdown(radiosity_table)));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return run({argv + 1, argv + argc}); });
}
