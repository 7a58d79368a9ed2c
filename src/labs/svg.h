// labs/svg.h  1  plots and contact sheets as SVG, in one style
//
// Plots have a white background, units at the axes and labels at the curves.  Colour-blind readers
// can distinguish the colours (Okabe, Ito 2008).  The unit is the pixel, the origin is top left.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "keep/pair.h"
#include "text/image_file.h"

namespace penumbra {

// Formats like printf.  The argument of %s may be a std::string.
inline const char* for_printf(const std::string& words) { return words.c_str(); }
inline auto for_printf(auto number) { return number; }
inline std::string text(const char* format, const auto&... values) {
    std::string line(size_t(std::snprintf(nullptr, 0, format, for_printf(values)...)), ' ');
    std::snprintf(line.data(), line.size() + 1, format, for_printf(values)...);
    return line;
}
// "0.982 %"
inline std::string percent(double x) { return text("%.3g %%", 100 * x); }

struct PlotPoint {
    double x = 0, y = 0;
};

namespace svg {

inline constexpr const char* ink = "#222222";
inline constexpr const char* grid = "#e2e2e2";
inline constexpr const char* frame = "#888888";
inline constexpr const char* colours[] = {"#000000", "#0072b2", "#d55e00", "#009e73",
                                          "#cc79a7", "#e69f00", "#56b4e9", "#888888"};
inline constexpr double letter = 13;  // font size

struct Type {
    const char* anchor = "start";  // or "middle", "end"
    const char* colour = ink;
    bool bold = false;
    double turn = 0;  // degrees, clockwise
};

inline std::string escaped(std::string_view words) {
    std::string out;
    for (char c : words)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return out;
}

// The label of a power of ten: 10⁻³, or 0.01.
inline std::string tick(double x) {
    const double exponent = std::round(std::log10(x));
    if (exponent > -3 && exponent < 6) return text("%.6g", x);
    constexpr const char* raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string out = exponent < 0 ? "10⁻" : "10";
    for (char digit : text("%.0f", std::abs(exponent))) out += raised[digit - '0'];
    return out;
}

}  // namespace svg

// ---- A sheet ------------------------------------------------------------------------------------

class Svg {
public:
    Svg(double width, double height) : width_(width), height_(height) {}

    void words(PlotPoint at, std::string_view words, const svg::Type& type = {}) {
        body_ += text(R"(<text x="%.1f" y="%.1f" text-anchor="%s" fill="%s" font-size="%.1f")",
                      at.x, at.y, type.anchor, type.colour, svg::letter);
        if (type.bold) body_ += R"( font-weight="bold")";
        if (type.turn != 0)
            body_ += text(" transform=\"rotate(%.1f %.1f %.1f)\"", type.turn, at.x, at.y);
        body_ += text(">%s</text>\n", svg::escaped(words));
    }

    void line(const std::vector<PlotPoint>& through, const char* colour, double width = 1) {
        body_ += text("<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"%.1f\" points=\"",
                      colour, width);
        for (const PlotPoint& p : through) body_ += text("%.1f,%.1f ", p.x, p.y);
        body_ += "\"/>\n";
    }
    void dot(PlotPoint at, const char* colour) {
        body_ +=
            text("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", at.x, at.y, colour);
    }
    // Scales a picture to this width without smoothing.
    void picture(PlotPoint at, double width, const Image& image, double exposure) {
        body_ += text(
            "<image x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" "
            "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,%s\"/>\n",
            at.x, at.y, width, width * image.height / image.width,
            base64(encode_png(image, exposure)));
    }

    std::string file() const {
        return text(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" "
            "viewBox=\"0 0 %g %g\" font-family=\"Helvetica, Arial, sans-serif\">\n"
            "<rect width=\"%g\" height=\"%g\" fill=\"white\"/>\n%s</svg>\n",
            width_, height_, width_, height_, width_, height_, body_);
    }

private:
    double width_, height_;
    std::string body_;
};

struct PlotPicture {
    Image image;
    std::string title, caption;
};

// Pictures of equal size, unscaled, `columns` per row, with title and caption below.
inline Svg contact_sheet(const std::vector<PlotPicture>& pictures, size_t columns,
                         double exposure) {
    constexpr double gap = 16, words = 48;
    const double width = pictures[0].image.width + gap, height = pictures[0].image.height + words;
    const size_t rows = (pictures.size() + columns - 1) / columns;
    Svg sheet(gap + width * double(columns), gap + height * double(rows));
    for (size_t i = 0; i < pictures.size(); ++i) {
        const PlotPoint at = {gap + width * double(i % columns),
                              gap + height * double(i / columns)};
        sheet.picture(at, width - gap, pictures[i].image, exposure);
        sheet.words({at.x, at.y + height - words + 16}, pictures[i].title, {.bold = true});
        sheet.words({at.x, at.y + height - words + 32}, pictures[i].caption);
    }
    return sheet;
}

// ---- Plots --------------------------------------------------------------------------------------

// A curve of a plot.  Its label is at its right end.
struct Series {
    std::string words;
    std::vector<double> x, y;
};

// A logarithmic axis between powers of ten.
struct Axis {
    double lo = 1, hi = 10;

    // Position of x on the axis: 0 at lo, 1 at hi.
    double part(double x) const { return std::log(x / lo) / std::log(hi / lo); }
    std::vector<double> marks() const {
        std::vector<double> out;
        for (double x = lo; x < 2 * hi; x *= 10) out.push_back(x);
        return out;
    }
};
inline bool is_shown(double x) { return x > 0 && std::isfinite(x); }
inline Axis axis_of(const std::vector<Series>& all, std::vector<double> Series::*numbers) {
    double lo = INFINITY, hi = 0;
    for (const Series& s : all)
        for (double x : s.*numbers)
            if (is_shown(x)) lo = std::min(lo, x), hi = std::max(hi, x);
    if (hi == 0) return {};
    const double first = std::floor(std::log10(lo)), last = std::ceil(std::log10(hi));
    return {std::pow(10, first), std::pow(10, std::max(last, first + 1))};
}

// A plot on logarithmic axes.  Leaves out numbers without a logarithm.
inline Svg plot(const std::vector<Series>& all, std::string_view x_label, std::string_view y_label,
                std::string_view title) {
    constexpr PlotPoint corner = {80, 40}, size = {560, 300};
    constexpr double right = corner.x + size.x, bottom = corner.y + size.y,
                     line_height = svg::letter + 2;
    Svg sheet(860, 400);
    const Axis x = axis_of(all, &Series::x), y = axis_of(all, &Series::y);
    auto place = [&](double a, double b) {
        return PlotPoint{corner.x + size.x * x.part(a), corner.y + size.y * (1 - y.part(b))};
    };
    for (double t : x.marks()) {
        const double at = place(t, y.lo).x;
        sheet.line({{at, corner.y}, {at, bottom}}, svg::grid);
        sheet.words({at, bottom + 16}, svg::tick(t), {.anchor = "middle"});
    }
    for (double t : y.marks()) {
        const double at = place(x.lo, t).y;
        sheet.line({{corner.x, at}, {right, at}}, svg::grid);
        sheet.words({corner.x - 6, at + 4}, svg::tick(t), {.anchor = "end"});
    }
    sheet.line({corner, {right, corner.y}, {right, bottom}, {corner.x, bottom}, corner},
               svg::frame);
    sheet.words({corner.x, corner.y - 8}, title, {.bold = true});
    sheet.words({corner.x + size.x / 2, bottom + 34}, x_label, {.anchor = "middle"});
    sheet.words({corner.x - 46, corner.y + size.y / 2}, y_label, {.anchor = "middle", .turn = -90});
    std::vector<std::pair<double, size_t>> labels;  // heights, and indices of curves
    for (size_t i = 0; i < all.size(); ++i) {
        std::vector<PlotPoint> through;
        for (size_t k = 0; k < all[i].x.size(); ++k)
            if (is_shown(all[i].x[k]) && is_shown(all[i].y[k]))
                through.push_back(place(all[i].x[k], all[i].y[k]));
        if (through.empty()) continue;
        const char* colour = svg::colours[i % std::size(svg::colours)];
        sheet.line(through, colour, 2);
        for (const PlotPoint& p : through) sheet.dot(p, colour);
        labels.push_back({through.back().y, i});
    }
    // Moves labels at least a line apart, and none below the frame.
    std::sort(labels.begin(), labels.end());
    double room = -INFINITY;
    for (auto& [at, i] : labels) room = at = std::max(at, room + line_height);
    room = bottom + line_height;
    for (size_t k = labels.size(); k-- > 0;)
        room = labels[k].first = std::min(labels[k].first, room - line_height);
    for (const auto& [at, i] : labels)
        sheet.words({right + 6, at + 4}, all[i].words,
                    {.colour = svg::colours[i % std::size(svg::colours)]});
    return sheet;
}

}  // namespace penumbra
