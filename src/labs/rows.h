// labs/rows.h  4  numbers of many renders: means with standard errors, tables, plots
#pragma once
#include <map>
#include <numeric>
#include <optional>

#include "labs/page.h"

namespace penumbra {

// ---- A row --------------------------------------------------------------------------------------

// One render: its position in the grid and its numbers.  These are its statistics and
//     off    relative RMSE against the reference
//     own    relative RMSE of the reference, by its own estimate; NaN: none
//     d2     off^2 - own^2: squared relative RMSE of the image, as the two errors are independent
//     mean   mean over all channels of all pixels
//     error  1 if --error ended it
//     stated "error" of the statistics: for build/radiosity, the error of its maps
struct Row {
    std::string scene, setting;
    uint64_t count = 0, seed = 0;  // count: samples per pixel; 0: the setting ends the run
    std::map<std::string, double> of = {};

    double operator[](const std::string& name) const {
        const auto at = of.find(name);
        return at == of.end() ? NAN : at->second;
    }
};
using Rows = std::vector<Row>;
inline void append(Rows& rows, const Rows& more) {
    rows.insert(rows.end(), more.begin(), more.end());
}

// A row as a line of text with tabs.  row_of() reads exactly the same numbers back.
inline std::string line_of(const Row& r, const std::string& print) {
    std::ostringstream line;
    line.precision(17);
    line << r.scene << '\t' << r.setting << '\t' << r.count << '\t' << r.seed << '\t' << print;
    for (const auto& [name, x] : r.of) line << '\t' << name << '=' << x;
    line << "\t.\n";
    return line.str();
}

// Reads a row and its fingerprint from a line.  Returns nothing if the line is incomplete.
inline std::optional<std::pair<Row, std::string>> row_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, '\t');) cells.push_back(cell);
    if (cells.size() < 6 || cells.back() != ".") return std::nullopt;
    Row r{cells[0], cells[1], std::strtoull(cells[2].c_str(), nullptr, 10),
          std::strtoull(cells[3].c_str(), nullptr, 10)};
    for (size_t k = 5; k + 1 < cells.size(); ++k) {
        const size_t at = cells[k].find('=');
        r.of[cells[k].substr(0, at)] = std::strtod(cells[k].c_str() + at + 1, nullptr);
    }
    return std::pair{r, cells[4]};
}

// ---- Statistics of rows -------------------------------------------------------------------------

template <class Which>
Rows where(const Rows& rows, Which which) {
    Rows some;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), which);
    return some;
}
inline Rows in_scene(const Rows& rows, const std::string& name) {
    return where(rows, [&](const Row& r) { return r.scene == name; });
}
inline Rows by_setting(const Rows& rows, const std::string& name) {
    return where(rows, [&](const Row& r) { return r.setting == name; });
}

inline std::vector<double> all_of(const Rows& rows, const std::string& name) {
    std::vector<double> x;
    for (const Row& r : rows) x.push_back(r[name]);
    return x;
}
inline double mean(const Rows& rows, const std::string& name) {
    const std::vector<double> x = all_of(rows, name);
    return std::accumulate(x.begin(), x.end(), 0.0) / double(x.size());
}

// Averages squared errors, because d2 is unbiased.  NaN: the error is too small for the reference.
inline double relative_error(const Rows& rows) { return std::sqrt(mean(rows, "d2")); }

// 1 / (squared error x CPU seconds).  It does not depend on the samples of an unbiased estimator.
inline double efficiency(const Rows& rows) {
    return 1 / (mean(rows, "d2") * mean(rows, "cpu_seconds"));
}

// The ratio of a number between two settings: its geometric mean over the scenes that have both.
template <class Number>
double over(const Rows& rows, const std::string& setting, const std::string& base, Number number) {
    double sum = 0, scenes = 0;
    std::map<std::string, std::pair<Rows, Rows>> of;
    for (const Row& r : rows) {
        if (r.setting == setting) of[r.scene].first.push_back(r);
        if (r.setting == base) of[r.scene].second.push_back(r);
    }
    for (const auto& [scene, both] : of)
        if (!both.first.empty() && !both.second.empty())
            sum += std::log(number(both.first) / number(both.second)), ++scenes;
    return std::exp(sum / scenes);
}

// A number of rows, with its standard error by the jackknife over seeds (Quenouille 1956, Tukey
// 1958).
struct Estimate {
    double value = 0, error = 0;
};
template <class Number>
Estimate jackknife(const Rows& rows, Number number) {
    std::map<uint64_t, Rows> without;
    for (const Row& r : rows) without[r.seed];
    for (auto& [seed, others] : without)
        others = where(rows, [s = seed](const Row& r) { return r.seed != s; });
    Moments m;
    for (const auto& [seed, others] : without) m.add(number(others));
    const double n = double(without.size());
    return {number(rows), n > 1 ? std::sqrt((n - 1) / n * m.m2) : NAN};
}
inline std::string told(const Estimate& e, const char* format) {
    if (std::isnan(e.value)) return "–";
    if (std::isnan(e.error)) return text(format, e.value);
    std::string error = text(format, e.error);
    if (e.error > 0 && error.find_first_of("123456789") == error.npos)
        error.back() = '1', error.insert(0, "< ");
    return text(format, e.value) + " ± " + error;
}

// The ratio of a number between two settings over all scenes.  "=": their images are identical.
template <class Number>
std::string gain(const Rows& rows, const std::string& setting, const std::string& base,
                 Number number, const char* format = "%.2f") {
    if (all_of(by_setting(rows, setting), "off") == all_of(by_setting(rows, base), "off"))
        return "=";
    auto ratio = [&](const Rows& some) { return over(some, setting, base, number); };
    return told(jackknife(rows, ratio), format);
}

// ---- Tables and plots ---------------------------------------------------------------------------

inline std::string of_scene(const Row& r) { return r.scene; }
inline std::string of_setting(const Row& r) { return r.setting; }
inline std::string of_count(const Row& r) { return text("%.0f", double(r.count)); }

// Rows grouped by one word, in the order of its first appearances.
template <class Key>
std::vector<std::pair<std::string, Rows>> grouped(const Rows& rows, Key key) {
    std::vector<std::pair<std::string, Rows>> groups;
    for (const Row& r : rows) {
        const std::string word = key(r);
        auto at = std::find_if(groups.begin(), groups.end(),
                               [&](const auto& group) { return group.first == word; });
        if (at == groups.end()) at = groups.insert(at, {word, {}});
        at->second.push_back(r);
    }
    return groups;
}

// A Markdown table: a line per `by`, a column per `across`.  `value` makes a cell from its rows.
template <class By, class Across, class Value>
std::string table(const Rows& rows, By by, Across across, Value value) {
    const auto columns = grouped(rows, across);
    Lines lines;
    for (const auto& [word, group] : grouped(rows, by)) {
        std::vector<std::string>& line = lines.emplace_back(1, word);
        const auto cells = grouped(group, across);
        for (const auto& column : columns) {
            const auto at = std::find_if(cells.begin(), cells.end(), [&](const auto& cell) {
                return cell.first == column.first;
            });
            line.push_back(at == cells.end() ? "" : value(at->second));
        }
    }
    std::vector<std::string> head(1);
    for (const auto& column : columns) head.push_back(column.first);
    return table(head, lines);
}

// CSV with numbers of every row.  A cell is empty if its row lacks the number.
inline std::string csv_of(const Rows& rows, const std::vector<std::string>& numbers) {
    std::string out = "scene,setting,count,seed";
    for (const std::string& name : numbers) out += "," + name;
    for (const Row& r : rows) {
        out +=
            text("\n\"%s\",\"%s\",%.0f,%.0f", r.scene, r.setting, double(r.count), double(r.seed));
        for (const std::string& name : numbers)
            out += std::isnan(r[name]) ? "," : text(",%.6g", r[name]);
    }
    return out + "\n";
}

// Coordinates for plot(): the count of rows, or the mean of a number.
inline double count_of(const Rows& rows) { return double(rows[0].count); }
inline auto mean_of(const std::string& number) {
    return [number](const Rows& rows) { return mean(rows, number); };
}

// Draws a curve per word of `series`, a point per count.  x_of and y_of compute its coordinates.
template <class Word, class X, class Y>
Svg plot(const Rows& rows, const std::string& x, const std::string& y, Word series, X x_of, Y y_of,
         const std::string& title) {
    std::vector<Series> all;
    for (const auto& [word, group] : grouped(rows, series)) {
        Series& s = all.emplace_back(Series{word, {}, {}});
        for (const auto& [count, cell] : grouped(group, of_count))
            s.x.push_back(x_of(cell)), s.y.push_back(y_of(cell));
    }
    return plot(all, x, y, title);
}

}  // namespace penumbra
