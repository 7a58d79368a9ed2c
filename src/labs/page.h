// labs/page.h  3  a report: a Markdown template, filled with measured values
#pragma once
#include <map>
#include <set>

#include "labs/lab.h"

namespace penumbra {

using Lines = std::vector<std::vector<std::string>>;  // the cells of each line of a table

// A table in Markdown.
inline std::string table(const std::vector<std::string>& head, const Lines& lines) {
    auto line_of = [](const std::vector<std::string>& cells) {
        std::string line = "|";
        for (const std::string& cell : cells) line += cell.empty() ? " |" : " " + cell + " |";
        return line + "\n";
    };
    std::string words = line_of(head) + "|";
    for (size_t i = 0; i < head.size(); ++i) words += "---|";
    words += "\n";
    for (const auto& line : lines) words += line_of(line);
    words.pop_back();  // the template has the newline
    return words;
}

// The numbers that lines end with, from `first` on; more is better: of every processor those of its
// best line (by their product), and of these the least of each.
inline std::vector<double> least_of(const Lines& lines, size_t first) {
    struct Best {
        double product = 0;
        std::vector<double> numbers;
    };
    std::map<std::string, Best> of;
    for (const auto& cells : lines) {
        Best now{1, {}};
        for (size_t i = first; i < cells.size(); ++i)
            now.numbers.push_back(std::strtod(cells[i].c_str(), nullptr)),
                now.product *= now.numbers.back();
        if (Best& best = of[cells[0]]; best.numbers.empty() || best.product < now.product)
            best = now;
    }
    std::vector<double> least = of.begin()->second.numbers;
    for (const auto& [processor, best] : of)
        for (size_t i = 0; i < least.size(); ++i) least[i] = std::min(least[i], best.numbers[i]);
    return least;
}

// The template reference/NAME.md.in has {{word}} for a table, a number or a verdict, and
// {{plot FILE The caption}} for a picture.
class Page {
public:
    // Writes FOLDER/NAME.md, pictures into FOLDER/, and numbers into FOLDER/data/.
    Page(const std::string& folder, const std::string& name)
        : folder_(folder), name_(name), prose_(read_file("reference/" + name + ".md.in")) {
        std::filesystem::create_directories(folder + "/data");
        check_writable(file(name + ".md"));
    }

    // The page of an experiment.  {{made}} is the date, the commit and the command.
    Page(const Scope& scope, const std::string& name) : Page(report_folder(scope.quick), name) {
        set("made", made_by(scope.command));
    }

    void set(const std::string& word, const std::string& words) { words_[word] = words; }
    void plot(const std::string& name, const Svg& svg) {
        write_file(file(name + ".svg"), svg.file());
        plots_.insert(name);
    }
    void data(const std::string& name, const std::string& numbers) {
        write_file(file("data/" + name + ".csv"), numbers);
    }
    // Replaces {{word}} by the verdict, and counts failures.
    void claim(const std::string& word, bool holds) { set(word, verdict(holds)); }
    std::string verdict(bool holds) {
        failures_ += !holds;
        return holds ? "ok" : "**fails**";
    }

    // Writes and prints the report.  Returns the exit status: 1 if a claim failed.
    int finish() {
        std::string out;
        for (size_t at = 0;;) {
            const size_t open = prose_.find("{{", at), close = prose_.find("}}", open);
            out += prose_.substr(at, open - at);
            if (open == prose_.npos) break;
            out += filled(prose_.substr(open + 2, close - open - 2));
            at = close + 2;
        }
        for (const auto& [word, words] : words_)
            if (!used_.count(word)) throw UserError(name_ + ".md.in has no {{" + word + "}}");
        write_file(file(name_ + ".md"), out);
        std::fputs(out.c_str(), stdout);
        std::fprintf(stderr, "wrote %s; %d claims failed\n", file(name_ + ".md").c_str(),
                     failures_);
        return failures_ > 0;
    }

    std::string file(const std::string& name) const { return folder_ + "/" + name; }

    // What this program ever measured, in data/processors.csv: processor, instructions, compiler,
    // commit, numbers.  Those of now take the place of former ones of the same first
    // three.
    Lines measured(const std::vector<double>& numbers) const {
        std::vector<std::string> now = {name_, processor(), instructions(), compiler(),
                                        git_commit()};
        for (double x : numbers) now.push_back(text("%.2f", x));
        Lines all;
        const std::string kept = file("data/processors.csv");
        std::istringstream in(std::filesystem::exists(kept) ? read_file(kept) : "");
        for (std::string line; std::getline(in, line);) {
            std::istringstream words(line);
            auto& cells = all.emplace_back();
            for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
            if (cells.size() < 5 || std::equal(cells.begin(), cells.begin() + 4, now.begin()))
                all.pop_back();
        }
        all.push_back(now);
        std::string lines;
        for (const auto& cells : all) {
            for (const std::string& cell : cells) lines += cell + ",";
            lines.back() = '\n';
        }
        write_file(kept, lines);
        std::erase_if(all, [&](const auto& cells) { return cells[0] != name_; });
        for (auto& cells : all) cells.erase(cells.begin());
        return all;
    }

private:
    std::string folder_, name_, prose_;
    std::map<std::string, std::string> words_;
    std::set<std::string> plots_, used_;
    int failures_ = 0;

    std::string filled(const std::string& place) {
        const std::vector<std::string> words = words_in(place);
        if (words.size() > 2 && words[0] == "plot" && plots_.count(words[1]))
            return "![" + place.substr(place.find(words[1]) + words[1].size() + 1) + "](" +
                   words[1] + ".svg)";
        const auto at = words_.find(place);
        if (at == words_.end()) throw UserError(name_ + ".md.in: nothing fills {{" + place + "}}");
        used_.insert(place);
        return at->second;
    }
};

}  // namespace penumbra
