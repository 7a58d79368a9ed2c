// labs/maps.h  2  numbers as colours, with their scale
#pragma once
#include "labs/svg.h"

using Colour = std::array<float, 3>;  // linear, 0 ... 1

// From black to white.
inline Colour greys(double t) {
    const auto grey = float(t);
    return {grey, grey, grey};
}

// From blue by white to vermilion, which the colour-blind tell apart (Okabe, Ito 2008).
inline Colour blue_to_red(double t) {
    constexpr Colour blue = {0, 0.168f, 0.445f}, red = {0.665f, 0.112f, 0};
    const Colour& end = t < 0.5 ? blue : red;
    const auto part = float(std::abs(2 * t - 1));
    return {std::lerp(1.0f, end[0], part), std::lerp(1.0f, end[1], part),
            std::lerp(1.0f, end[2], part)};
}

// What colour a number has; those beyond the ends of the axis have that of the nearer end.
struct Map {
    Axis axis;
    Colour (*colours)(double);

    Colour operator()(double x) const { return colours(axis.part(x)); }
};

// A picture of what colour_of(x, y) says.
template <class ColourOf>
Image painted(int width, int height, ColourOf colour_of) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = colour_of(x, y);
    return image;
}

inline constexpr double picture_width = 256;

// A picture in a frame, with words above it.
inline void draw_picture(Svg& sheet, Place at, const std::string& words, const Image& image,
                         double exposure) {
    const double width = picture_width;
    const double right = at.x + width, bottom = at.y + width * image.height / image.width;
    sheet.words({at.x, at.y - 7}, words);
    sheet.picture(at, width, image, exposure);
    sheet.line({at, {right, at.y}, {right, bottom}, {at.x, bottom}, at}, svg::frame);
}

// A bar of all colours, which needs some 50 below `at` and 20 to both sides.
inline void draw_scale(Svg& sheet, Place at, double width, const Map& map) {
    constexpr int steps = 128, high = 6;
    auto colour = [&](int x, int) { return map.colours((x + 0.5) / steps); };
    sheet.picture(at, width, painted(steps, high, colour), 1);
    const double bottom = at.y + width * high / steps;
    for (double mark : map.axis.marks()) {
        const double x = at.x + width * map.axis.part(mark);
        sheet.line({{x, at.y}, {x, bottom + 4}}, svg::frame);
        sheet.words({x, bottom + 17}, svg::tick(mark), {.anchor = "middle"});
    }
    sheet.words({at.x + width / 2, bottom + 34}, map.axis.label, {.anchor = "middle"});
}
