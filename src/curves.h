// curves.h  floor 2  curves over logarithmic or linear axes, and words
#pragma once
#include <functional>

#include <stb/stb_easy_font.h>

#include "image.h"

using Colour = std::array<float, 3>;  // linear
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

inline void set_pixel(Image& sheet, int x, int y, Colour c, float opacity = 1) {
    if (x < 0 || y < 0 || x >= sheet.width || y >= sheet.height) return;
    for (size_t k = 0; k < 3; ++k) sheet.at(x, y)[k] += opacity * (c[k] - sheet.at(x, y)[k]);
}

// The font comes as quads, four vertices x y z colour each, with whole-numbered sides.
inline void draw_text(Image& sheet, int left, int top, std::string words, Colour c = ink,
                      int letter = 1) {
    struct Vertex {
        float x, y, z;
        unsigned char colour[4];
    };
    std::vector<Vertex> vertices((words.size() + 1) * 4 * 20);
    const int quads = stb_easy_font_print(0, 0, words.data(), nullptr, vertices.data(),
                                          int(vertices.size() * sizeof(Vertex)));
    for (size_t q = 0; q < size_t(quads); ++q) {
        const Vertex &from = vertices[4 * q], &to = vertices[4 * q + 2];
        for (int y = top + letter * int(from.y); y < top + letter * int(to.y); ++y)
            for (int x = left + letter * int(from.x); x < left + letter * int(to.x); ++x)
                set_pixel(sheet, x, y, c);
    }
}

inline void draw_line(Image& sheet, double x0, double y0, double x1, double y1, Colour c) {
    const int steps = 1 + int(2 * std::max(std::abs(x1 - x0), std::abs(y1 - y0)));
    for (int k = 0; k <= steps; ++k) {
        const double t = double(k) / steps;
        set_pixel(sheet, int(std::lround(std::lerp(x0, x1, t))),
                  int(std::lround(std::lerp(y0, y1, t))), c);
    }
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
            draw_line(sheet, at_x(x), top, at_x(x), top + height, grey);
            draw_text(sheet, int(at_x(x)) - 10, top + height + 5, number(x));
        }
        auto mark = [&](double y) {
            draw_line(sheet, left, at_y(y), left + width, at_y(y), grey);
            draw_text(sheet, left - 44, int(at_y(y)) - 4, number(y));
        };
        if (log_y)
            // Exponents, with room for the rounding of a logarithm: y0 and y1 may be powers of 10.
            for (double e = std::ceil(std::log10(y0) - 1e-9); e <= std::log10(y1) + 1e-9; ++e)
                mark(std::pow(10, e));
        else
            for (int k = 0; k <= 4; ++k) mark(y0 + (y1 - y0) * k / 4);
        draw_text(sheet, left, top - 14, title);
    }
    void curve(const std::vector<double>& xs, const std::vector<double>& ys, Colour c) const {
        for (size_t k = 0; k < xs.size(); ++k) {
            for (int d = -1; d <= 1; ++d)
                if (k > 0)
                    draw_line(sheet, at_x(xs[k - 1]), at_y(ys[k - 1]) + d * 0.5, at_x(xs[k]),
                              at_y(ys[k]) + d * 0.5, c);
            for (int dy = -2; dy <= 2; ++dy)
                for (int dx = -2; dx <= 2; ++dx)
                    set_pixel(sheet, int(at_x(xs[k])) + dx, int(at_y(ys[k])) + dy, c);
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
                for (int y = from; y <= to; ++y) set_pixel(sheet, x, y, c, 0.2f);
            }
    }
};
