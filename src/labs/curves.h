// labs/curves.h  2  curves over logarithmic or linear axes
#pragma once
#include "labs/plot.h"

inline constexpr Colour ink = {0.8f, 0.8f, 0.8f}, paper = {0.01f, 0.01f, 0.01f};
// Easy to tell apart.
inline constexpr Colour palette[] = {{0.9f, 0.9f, 0.9f},  {0.9f, 0.15f, 0.1f}, {0.95f, 0.5f, 0.05f},
                                     {0.1f, 0.5f, 1.0f},  {0.1f, 0.75f, 0.2f}, {0.8f, 0.2f, 0.8f},
                                     {0.85f, 0.8f, 0.1f}, {0.1f, 0.75f, 0.75f}};

inline Image blank(int width, int height) {
    Image sheet(width, height);
    sheet.pixels.assign(sheet.pixels.size(), paper);
    return sheet;
}

inline void caption(Image& sheet, int left, int top, const std::string& words, Colour c = ink,
                    int scale = 1) {
    draw_text(sheet, {double(left), double(top)}, words, c, 0, scale);
}

// A part of a sheet with logarithmic or linear axes.
struct Axes {
    Image& sheet;
    int left, top, width, height;
    double x0, x1, y0, y1;
    bool log_x = true, log_y = true;

    double at_x(double x) const {
        const double t = log_x ? std::log(x / x0) / std::log(x1 / x0) : (x - x0) / (x1 - x0);
        return left + std::clamp(t, 0.0, 1.0) * width;
    }
    double at_y(double y) const {
        const double t = log_y ? std::log(y / y0) / std::log(y1 / y0) : (y - y0) / (y1 - y0);
        return top + height - std::clamp(t, 0.0, 1.0) * height;
    }
    static std::string number(double x) {
        char text[32];
        std::snprintf(text, sizeof text, "%.4g", x);
        return text;
    }
    void frame(const std::string& title, const std::vector<double>& xs) const {
        const Colour grey = {0.1f, 0.1f, 0.1f};
        for (double x : xs) {
            draw_line(sheet, {at_x(x), double(top)}, {at_x(x), double(top + height)}, grey);
            draw_text(sheet, {at_x(x), double(top + height + 5)}, number(x), ink, 0.5);
        }
        auto mark = [&](double y) {
            draw_line(sheet, {double(left), at_y(y)}, {double(left + width), at_y(y)}, grey);
            draw_text(sheet, {double(left - 4), at_y(y) - 4}, number(y), ink, 1);
        };
        if (log_y)
            // Exponents, with room for the rounding of a logarithm: y0 and y1 may be powers of 10.
            for (double e = std::ceil(std::log10(y0) - 1e-9); e <= std::log10(y1) + 1e-9; ++e)
                mark(std::pow(10, e));
        else
            for (int k = 0; k <= 4; ++k) mark(y0 + (y1 - y0) * k / 4);
        caption(sheet, left, top - 14, title);
    }
    void curve(const std::vector<double>& xs, const std::vector<double>& ys, Colour c) const {
        for (size_t k = 0; k < xs.size(); ++k) {
            const Point p = {at_x(xs[k]), at_y(ys[k])};
            draw_line(sheet, p, p, c, 5);  // a dot
            if (k > 0) draw_line(sheet, {at_x(xs[k - 1]), at_y(ys[k - 1])}, p, c, 2);
        }
    }
    // Between two curves, see-through.
    void band(const std::vector<double>& xs, const std::vector<double>& low,
              const std::vector<double>& high, Colour c) const {
        for (size_t k = 1; k < xs.size(); ++k)
            for (int x = int(at_x(xs[k - 1])); x < int(at_x(xs[k])); ++x) {
                const double t = (x - at_x(xs[k - 1])) / (at_x(xs[k]) - at_x(xs[k - 1]));
                const int from = int(std::lerp(at_y(high[k - 1]), at_y(high[k]), t)),
                          to = int(std::lerp(at_y(low[k - 1]), at_y(low[k]), t));
                for (int y = from; y <= to; ++y) blend(sheet, x, y, c, 0.2f);
            }
    }
};
