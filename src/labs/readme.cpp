// labs/readme.cpp  3  writes tables of options and scene statements into documents
//
//   build/readme
//
// Replaces text between marks such as <!-- options --> and <!-- /options -->.  README.md gets the
// options of penumbra and the scene statements, reference/radiosity-options.md those of radiosity.
#include "labs/lab.h"
#include "world/grammar.h"

namespace {

// Replaces the text between the two marks of a table.
std::string with_table(const std::string& text, const std::string& name, const std::string& table) {
    const std::string before = "<!-- " + name + " -->\n", after = "<!-- /" + name + " -->";
    const size_t start = text.find(before), end = text.find(after, start);
    if (end == text.npos) throw UserError("no lines " + before + "and " + after + " to write to");
    return text.substr(0, start).append(before).append(table).append(text, end);
}

// One row of a table: `word arguments`, their meaning and the default.
std::string row_markdown(const std::string& words, const std::string& meaning,
                         const std::string& otherwise) {
    std::string code;
    for (const std::string& part : words_in(words)) code += (code.empty() ? "" : " ") + part;
    for (size_t i = 0; (i = code.find('|', i)) != code.npos; i += 2) code.insert(i, 1, '\\');
    return "| `" + code + "` | " + meaning + " | " + otherwise +
           (otherwise.empty() ? "|\n" : " |\n");
}

// The table of options from --help: an option begins in column 2, its meaning in column 24.
std::string option_markdown(const std::string& help) {
    std::string table = "| option | meaning | default |\n|---|---|---|\n", option, meaning;
    auto end = [&] {
        if (option.empty()) return;
        const size_t at = meaning.rfind(" (default: ");
        const bool has = at != meaning.npos && meaning.back() == ')';
        table += row_markdown(option, meaning.substr(0, has ? at : meaning.npos),
                              has ? meaning.substr(at + 11, meaning.size() - at - 12) : "");
        option.clear();
    };
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        const bool begins = line.starts_with("  -"),
                   goes_on = line.starts_with(std::string(24, ' ')) && !option.empty();
        if (!goes_on) end();
        if (!begins && !goes_on) continue;
        const size_t gap = begins ? line.find("  ", 2) : 0;
        if (begins) option = line.substr(2, gap - 2), meaning = "";
        for (const std::string& word : words_in(gap == line.npos ? "" : line.substr(gap)))
            meaning += (meaning.empty() ? "" : " ") + word;
    }
    end();
    return table;
}

std::string help_of(const std::string& program) {
    const std::string file = "out/help" + std::to_string(::getpid());
    std::filesystem::create_directories("out");
    execute({"/bin/sh", "-c", "exec \"$0\" --help >\"$1\"", program, file});
    const std::string help = read_file(file);
    std::filesystem::remove(file);
    return help;
}

std::string grammar_markdown() {
    std::string table = "| statement | meaning | default |\n|---|---|---|\n";
    for (const Statement& row : grammar)
        table += row_markdown(std::string(row.keyword) + " " + std::string(row.words),
                              std::string(row.meaning), std::string(row.otherwise));
    return table;
}

}  // namespace

int main(int argc, char** argv) {
    const Lab lab{"readme", "Writes tables of options and statements into README.md.", {}};
    return lab_main(argc, argv, lab, [&] {
        const std::string penumbra = option_markdown(help_of(renderer_beside(lab, argv[0]))),
                          page = "reference/radiosity-options.md";
        const std::string options = with_table(read_file("README.md"), "options", penumbra);
        write_file("README.md", with_table(options, "statements", grammar_markdown()));
        const std::string radiosity = help_of(renderer_beside(lab, argv[0], "radiosity"));
        write_file(page, with_table(read_file(page), "options", option_markdown(radiosity)));
        return 0;
    });
}
