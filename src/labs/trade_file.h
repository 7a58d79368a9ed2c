// labs/trade_file.h  3  a measured trade as a file of rows, and its images beside it
//
// Words are separated by tabs, one row a thing: trade, scene, setting, point, answer, picture,
// candidate; what a row belongs to stands above it.  Images are out of line, in PFM.
#pragma once
#include "labs/lab.h"
#include "labs/trade_data.h"

namespace trade_file {

inline std::string row(const std::vector<std::string>& cells) {
    std::string line;
    for (const std::string& cell : cells) line += (line.empty() ? "" : "\t") + cell;
    return line + "\n";
}
inline std::string exact(double x) { return text("%.17g", x); }
inline std::string count(size_t n) { return std::to_string(n); }
inline std::string yes(bool b) { return b ? "yes" : "no"; }

inline std::string rows_of(const TradeSetting& s) {
    std::string rows =
        row({"setting", s.words, yes(s.is_float), yes(s.unbiased), yes(s.takes_every_scene),
             exact(s.c), exact(s.gamma), exact(s.spread), s.dropped});
    for (const TradePoint& p : s.points)
        rows += row({"point", exact(p.spp), exact(p.seconds), exact(p.error), exact(p.error_se)});
    return rows;
}

inline std::string rows_of(const TradeScene& s) {
    std::string rows = row({"scene", s.name, s.remark, count(size_t(s.width)),
                            count(size_t(s.height)), exact(s.exposure), exact(s.reference_error)});
    for (const TradeSetting& setting : s.settings) rows += rows_of(setting);
    for (const TradeAnswer& a : s.answers)
        rows += row(
            {"answer", exact(a.E), count(a.setting), exact(a.seconds), exact(a.default_seconds)});
    for (const TradePicture& p : s.pictures)
        rows += row({"picture", p.words, yes(p.is_float), exact(p.seconds), exact(p.error)});
    return rows;
}

inline std::string encode(const Trade& t) {
    std::string rows = row({"trade", t.default_words, t.command});
    for (const TradeScene& s : t.scenes) rows += rows_of(s);
    for (const TradeCandidate& c : t.candidates)
        rows += row({"candidate", c.words, yes(c.is_float), exact(c.mean_ratio),
                     exact(c.worst_ratio), c.worst_scene});
    return rows;
}

// A row's cells, taken one after the other.
class Cells {
public:
    explicit Cells(const std::string& line) {
        for (size_t from = 0, to = 0; to != line.npos; from = to + 1) {
            to = line.find('\t', from);
            cells_.push_back(line.substr(from, to - from));
        }
    }
    std::string words() {
        if (next_ == cells_.size()) throw UserError("a row of " + in_quotes(cells_[0]) + " ends");
        return cells_[next_++];
    }
    double number() {
        const std::string word = words();
        return word == "nan" || word == "-nan" ? double(NAN) : parse_number(word, HUGE_VAL);
    }
    size_t count() { return size_t(parse_count(words(), 0, UINT64_MAX)); }
    bool yes() { return words() == "yes"; }

private:
    std::vector<std::string> cells_;
    size_t next_ = 0;
};

// Braces: their values are taken from left to right.
inline TradeSetting setting_of(Cells& c) {
    TradeSetting s{c.words(), c.yes(), c.yes(), c.yes()};
    s.c = c.number(), s.gamma = c.number(), s.spread = c.number(), s.dropped = c.words();
    return s;
}
inline TradeScene scene_of(Cells& c) {
    TradeScene s{c.words(), c.words(), int(c.count()), int(c.count()), c.number()};
    s.reference_error = c.number();
    return s;
}

// What stands below a scene.
inline void add_to(TradeScene& scene, const std::string& kind, Cells& c) {
    if (kind == "setting")
        scene.settings.push_back(setting_of(c));
    else if (kind == "point" && !scene.settings.empty())
        scene.settings.back().points.push_back({c.number(), c.number(), c.number(), c.number()});
    else if (kind == "answer")
        scene.answers.push_back({c.number(), c.count(), c.number(), c.number()});
    else if (kind == "picture")
        scene.pictures.push_back({c.words(), c.yes(), c.number(), c.number()});
    else
        throw UserError("a row of " + in_quotes(kind) + " where none is expected");
}

inline Trade decode(const std::string& rows) {
    Trade t;
    std::istringstream lines(rows);
    for (std::string line; std::getline(lines, line);) {
        Cells c(line);
        const std::string kind = c.words();
        if (kind == "trade")
            t.default_words = c.words(), t.command = c.words();
        else if (kind == "scene")
            t.scenes.push_back(scene_of(c));
        else if (kind == "candidate")
            t.candidates.push_back({c.words(), c.yes(), c.number(), c.number(), c.words()});
        else if (!t.scenes.empty())
            add_to(t.scenes.back(), kind, c);
        else
            throw UserError("a row of " + in_quotes(kind) + " where none is expected");
    }
    return t;
}

// Calls with(file's name, image) for every image of a trade.
template <class T, class With>
void each_image(T& trade, const std::string& folder, With with) {
    for (auto& scene : trade.scenes) {
        with(folder + "/" + scene.name + "-reference.pfm", scene.reference);
        for (size_t k = 0; k < scene.pictures.size(); ++k)
            with(folder + "/" + scene.name + "-" + std::to_string(k) + ".pfm",
                 scene.pictures[k].image);
    }
}

}  // namespace trade_file

// FOLDER/trade.rows, and images beside it.
inline void write_trade(const Trade& trade, const std::string& folder) {
    trade_file::each_image(trade, folder, [](const std::string& file, const Image& image) {
        if (!image.pixels.empty()) write_image(file, image, 1);
    });
    write_file(folder + "/trade.rows", trade_file::encode(trade));
}

inline Trade read_trade(const std::string& folder) {
    const std::string file = folder + "/trade.rows";
    Trade trade = trade_file::decode(read_file(file));
    trade_file::each_image(trade, folder, [](const std::string& name, Image& image) {
        if (std::filesystem::exists(name)) image = read_pfm(name);
    });
    return trade;
}
