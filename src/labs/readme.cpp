// labs/readme.cpp  3  writes the README's tables from the program's own
//
//   build/readme [README.md]
//
// What stands between <!-- options --> and <!-- /options --> becomes the table of options, and so
// do the statements of a scene's file.
#include "app/help.h"
#include "app/options.h"
#include "base/files.h"
#include "base/program.h"

namespace {

// The text with a table between its marks.
std::string with_table(const std::string& text, const std::string& name, const std::string& table) {
    const std::string before = "<!-- " + name + " -->\n", after = "<!-- /" + name + " -->";
    const size_t start = text.find(before), end = text.find(after, start);
    if (end == text.npos) throw UserError("no lines " + before + "and " + after + " in the README");
    return text.substr(0, start).append(before).append(table).append(text, end);
}

int run(const std::vector<std::string>& words) {
    const std::string usage = "usage: readme [README.md]";
    if (words.size() == 1 && (words[0] == "--help" || words[0] == "-h")) {
        std::printf("%s\nWrites its tables of options and statements.\n", usage.c_str());
        return 0;
    }
    if (words.size() > 1 || (words.size() == 1 && !words[0].ends_with(".md")))
        throw UserError(usage);
    const std::string path = words.empty() ? "README.md" : words[0];
    const std::string old = read_file(path);
    write_file(path, with_table(with_table(old, "options", option_markdown(option_table)),
                                "statements", grammar_markdown()));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return run({argv + 1, argv + argc}); });
}
