// labs/trade_curves.h  4  error over seconds of one scene: all settings in grey, a few by name
#pragma once
#include "labs/trade_words.h"

// Colours of curves with names; the default is the first, and black.
inline constexpr size_t most_named = 7;
inline constexpr const char* unnamed = "#b8b8b8";

// The default, what answers a question, and the best of those that may be the default.
inline std::vector<size_t> named_settings(const Trade& trade, const TradeScene& scene) {
    std::vector<size_t> named;
    auto add = [&](size_t i) {
        const bool known = std::find(named.begin(), named.end(), i) != named.end();
        if (i < scene.settings.size() && !known && named.size() < most_named) named.push_back(i);
    };
    auto add_words = [&](const std::string& words, bool is_float) {
        for (size_t i = 0; i < scene.settings.size(); ++i)
            if (scene.settings[i].words == words && scene.settings[i].is_float == is_float) add(i);
    };
    add_words(trade.default_words, false);
    for (const TradeAnswer& a : scene.answers) add(a.setting);
    if (!trade.candidates.empty())
        add_words(trade.candidates[0].words, trade.candidates[0].is_float);
    add_words(trade.default_words, true);
    return named;
}

// From the least to the greatest with some room, and the ticks 1 and 3 times powers of ten between.
inline Axis axis_of(const std::string& label, std::vector<double> numbers) {
    std::erase_if(numbers, [](double x) { return !(x > 0 && std::isfinite(x)); });
    if (numbers.empty()) numbers = {1};
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    Axis out{label, *least / 1.5, *most * 1.5};
    const bool many = out.hi / out.lo > 3e3;
    for (double e = std::floor(std::log10(out.lo)); e <= std::log10(out.hi); ++e)
        for (double digit : {1.0, 3.0}) {
            const double tick = digit * std::pow(10, e);
            if (tick >= out.lo && tick <= out.hi && !(many && digit > 1)) out.ticks.push_back(tick);
        }
    return out;
}

struct Curve {
    std::vector<double> seconds, percent;
};

inline Curve measured(const TradeSetting& s) {
    Curve curve;
    for (const TradePoint& p : s.points)
        curve.seconds.push_back(p.seconds), curve.percent.push_back(100 * p.error);
    return curve;
}

// The fitted law, from the first point to the last.
inline Curve fitted(const TradeSetting& s) {
    if (s.points.empty() || !std::isfinite(s.c)) return {};
    Curve curve;
    for (double t : {s.points.front().seconds, s.points.back().seconds}) {
        curve.seconds.push_back(t);
        curve.percent.push_back(100 * s.c * std::pow(t, -s.gamma));
    }
    return curve;
}

inline Svg curves_svg(const TradeScene& scene, const std::vector<size_t>& named) {
    std::vector<double> seconds, percent;
    for (const TradeSetting& s : scene.settings)
        for (const Curve& c : {measured(s), fitted(s)}) {
            seconds.insert(seconds.end(), c.seconds.begin(), c.seconds.end());
            percent.insert(percent.end(), c.percent.begin(), c.percent.end());
        }
    Svg sheet(560, 380);
    Plot plot(sheet, {62, 14}, {468, 318}, axis_of("seconds of one core", seconds),
              axis_of("error, %", percent), "");
    for (const TradeSetting& s : scene.settings) {
        const Curve points = measured(s);
        plot.curve(points.seconds, points.percent, {.colour = unnamed, .width = 1, .radius = 1.5});
    }
    for (size_t k = named.size(); k-- > 0;) {  // the default above all
        const TradeSetting& s = scene.settings[named[k]];
        const Curve points = measured(s), law = fitted(s);
        const char* colour = svg::colours[k];
        plot.curve(law.seconds, law.percent,
                   {.colour = colour, .dots = false, .dashed = s.is_float});
        plot.curve(points.seconds, points.percent, {.colour = colour, .width = 0, .radius = 3.5},
                   std::to_string(k + 1));
    }
    return sheet;
}
