// labs/trade_words.h  3  the numbers of a trade in words: the report and the page say the same
#pragma once
#include "labs/svg.h"
#include "labs/trade_data.h"

inline constexpr const char* told_nothing = "–";  // of what is not known

// With so many digits that count, and no exponent: 0.0123, 1.23, 123.
inline std::string told_number(double x, int digits) {
    if (!std::isfinite(x)) return told_nothing;
    const int before = x == 0 ? 1 : int(std::floor(std::log10(std::abs(x)))) + 1;
    return text("%.*f", std::max(digits - before, 0), x);
}

// "0.0341 s", "34.1 s", "15 min", "2.5 h": of one core.
inline std::string told_seconds(double seconds) {
    if (!std::isfinite(seconds)) return told_nothing;
    if (seconds < 600) return told_number(seconds, 3) + " s";
    return seconds < 7200 ? told_number(seconds / 60, 2) + " min"
                          : told_number(seconds / 3600, 2) + " h";
}

// d_rel: "0.3 %", "12.3 %".
inline std::string told_percent(double error) {
    if (!std::isfinite(error)) return told_nothing;
    return text(error < 1 ? "%.3g %%" : "%.0f %%", 100 * error);
}

// "1.32×"
inline std::string told_ratio(double ratio) {
    if (!std::isfinite(ratio)) return told_nothing;
    return ratio > 1000 ? "> 1000×"
                        : told_number(ratio, 3) + "×";  // by laws far beyond their points
}

// "2.1 % · t^−0.51": what error is left after t seconds of a core.
inline std::string told_law(const TradeSetting& s) {
    if (!std::isfinite(s.c) || !std::isfinite(s.gamma)) return told_nothing;
    return told_percent(s.c) + " · t^" + text(s.gamma < 0 ? "%.2f" : "−%.2f", std::abs(s.gamma));
}

// "4 %": by how much the points' errors differ from their law.
inline std::string told_spread(const TradeSetting& s) { return told_percent(std::expm1(s.spread)); }

inline const char* told_precision(bool is_float) { return is_float ? "float" : "double"; }

inline std::string told_kind(const TradeSetting& s) {
    return text("%s, %s", told_precision(s.is_float), s.unbiased ? "unbiased" : "biased");
}

// How a trade names no options at all.
inline std::string told_words(const std::string& words) {
    return words.empty() ? "no options" : words;
}
