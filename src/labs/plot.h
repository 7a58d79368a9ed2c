// labs/plot.h  1  lines and words on images
#pragma once
#include <stb/stb_easy_font.h>

#include "film/image.h"

using Colour = std::array<float, 3>;  // linear, 0 ... 1

// Ink over what is there; `part` of the pixel is covered.
inline void blend(Image& image, int x, int y, Colour ink, float part = 1) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    for (size_t c = 0; c < 3; ++c) image.at(x, y)[c] += part * (ink[c] - image.at(x, y)[c]);
}

struct Point {
    double x = 0, y = 0;  // in pixels from the top left corner
};

// A straight line with round ends, its edge smoothed over one pixel.
inline void draw_line(Image& image, Point a, Point b, Colour ink, double width = 1) {
    const double reach = width / 2 + 1, dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    for (int y = int(std::min(a.y, b.y) - reach); y <= int(std::max(a.y, b.y) + reach); ++y)
        for (int x = int(std::min(a.x, b.x) - reach); x <= int(std::max(a.x, b.x) + reach); ++x) {
            const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
            const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
            const double distance = std::hypot(px - t * dx, py - t * dy);
            const double part = std::clamp(width / 2 + 0.5 - distance, 0.0, 1.0);
            if (part > 0) blend(image, x, y, ink, float(part));
        }
}

inline void draw_polyline(Image& image, const std::vector<Point>& points, Colour ink,
                          double width = 1) {
    for (size_t i = 0; i + 1 < points.size(); ++i)
        draw_line(image, points[i], points[i + 1], ink, width);
}

inline void draw_box(Image& image, Point a, Point b, Colour ink) {
    draw_polyline(image, {a, {b.x, a.y}, b, {a.x, b.y}, a}, ink);
}

// ASCII; from `at`, its top left corner, or with `align` 0.5 about it and 1 to the left of it.  The
// font comes as rectangles of whole numbers, four vertices each.
inline void draw_text(Image& image, Point at, std::string words, Colour ink, double align = 0,
                      int scale = 1) {
    struct FontVertex {
        float x, y, z;
        unsigned char colour[4];
    };
    std::vector<FontVertex> vertices(words.size() * 4 * 20);
    const int quads = stb_easy_font_print(0, 0, words.data(), nullptr, vertices.data(),
                                          int(vertices.size() * sizeof(FontVertex)));
    const int left = int(std::lround(at.x - align * scale * stb_easy_font_width(words.data()))),
              top = int(std::lround(at.y));
    for (size_t q = 0; q < size_t(quads); ++q) {
        const FontVertex &from = vertices[4 * q], &to = vertices[4 * q + 2];
        for (int y = scale * int(from.y); y < scale * int(to.y); ++y)
            for (int x = scale * int(from.x); x < scale * int(to.x); ++x)
                blend(image, left + x, top + y, ink, 1);
    }
}
