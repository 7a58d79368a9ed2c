// labs/svg.h  1  plots and sheets of pictures as SVG, in one style
//
// Light ground, axes with units, labels at the curves themselves, colours that the colour-blind
// tell apart (Okabe, Ito 2008).  Lengths are in pixels from the top left corner.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "film/image.h"

// As printf; a string for %s may be a std::string.
inline const char* for_printf(const std::string& words) { return words.c_str(); }
inline auto for_printf(auto number) { return number; }
inline std::string text(const char* format, const auto&... values) {
    std::string line(size_t(std::snprintf(nullptr, 0, format, for_printf(values)...)), ' ');
    std::snprintf(line.data(), line.size() + 1, format, for_printf(values)...);
    return line;
}

struct Place {
    double x = 0, y = 0;
};

namespace svg {

inline constexpr const char* ink = "#222222";
inline constexpr const char* grid = "#e2e2e2";
inline constexpr const char* frame = "#888888";
inline constexpr const char* colours[] = {"#000000", "#0072b2", "#d55e00", "#009e73",
                                          "#cc79a7", "#e69f00", "#56b4e9", "#888888"};
inline constexpr double letter = 13;  // size of type

inline std::string escaped(std::string_view words) {
    std::string out;
    for (char c : words) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

inline std::string base64(std::string_view bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    return out;
}

// 10⁻³, or 0.25: as short as it can be read.
inline std::string tick(double x) {
    const double exponent = std::log10(std::abs(x)), nearest = std::round(exponent);
    const bool far = x != 0 && (exponent < -2.5 || exponent > 5.5);
    if (far && std::abs(exponent - nearest) < 1e-9) {
        constexpr const char* raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
        std::string out = text(exponent < 0 ? "%s10⁻" : "%s10", x < 0 ? "-" : "");
        for (char digit : text("%.0f", std::abs(nearest))) out += raised[digit - '0'];
        return out;
    }
    return text(x == std::round(x) && !far ? "%.0f" : "%.4g", x);  // %g: 65536 is 6.554e+04
}

}  // namespace svg

// ---- A sheet ------------------------------------------------------------------------------------

class Svg {
public:
    Svg(double width, double height) : width_(width), height_(height) {}

    struct Type {
        const char* anchor = "start";  // what is at the place; or "middle", "end"
        const char* colour = svg::ink;
        double size = svg::letter;
        bool bold = false;
        double turn = 0;  // degrees, clockwise
    };
    void words(Place at, std::string_view words) { this->words(at, words, Type()); }
    void words(Place at, std::string_view words, const Type& type) {
        body_ += text(R"(<text x="%.1f" y="%.1f" text-anchor="%s" fill="%s" font-size="%.1f")",
                      at.x, at.y, type.anchor, type.colour, type.size);
        if (type.bold) body_ += R"( font-weight="bold")";
        if (type.turn != 0)
            body_ += text(" transform=\"rotate(%.1f %.1f %.1f)\"", type.turn, at.x, at.y);
        body_ += text(">%s</text>\n", svg::escaped(words));
    }

    void line(const std::vector<Place>& through, const char* colour, double width = 1,
              bool dashed = false) {
        body_ +=
            text("<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"%.1f\"%s points=\"%s\"/>\n",
                 colour, width, dashed ? R"( stroke-dasharray="5 4")" : "", points(through));
    }
    void area(const std::vector<Place>& outline, const char* colour, double opacity = 1) {
        body_ += text("<polygon fill=\"%s\" fill-opacity=\"%.1f\" points=\"%s\"/>\n", colour,
                      opacity, points(outline));
    }
    void dot(Place at, const char* colour, double radius = 3) {
        body_ += text("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>\n", at.x, at.y,
                      radius, colour);
    }
    // The pixels of a picture, enlarged to that width without smoothing.
    void picture(Place at, double width, const Image& image, double exposure) {
        body_ += text(
            "<image x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" "
            "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,%s\"/>\n",
            at.x, at.y, width, width * image.height / image.width,
            svg::base64(encode_png(image, exposure)));
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

    static std::string points(const std::vector<Place>& places) {
        std::string out;
        for (const Place& p : places) out += text("%.1f,%.1f ", p.x, p.y);
        return out;
    }
};

struct Picture {
    Image image;
    std::string title, caption;
};

// Pictures of one size, pixel by pixel, `columns` a row, each above its title and its caption.
inline Svg contact_sheet(const std::vector<Picture>& pictures, size_t columns, double exposure) {
    constexpr double gap = 16, words = 48;
    const double width = pictures[0].image.width + gap, height = pictures[0].image.height + words;
    const size_t rows = (pictures.size() + columns - 1) / columns;
    Svg sheet(gap + width * double(columns), gap + height * double(rows));
    for (size_t i = 0; i < pictures.size(); ++i) {
        const Place at = {gap + width * double(i % columns), gap + height * double(i / columns)};
        sheet.picture(at, width - gap, pictures[i].image, exposure);
        sheet.words({at.x, at.y + height - words + 16}, pictures[i].title, {.bold = true});
        sheet.words({at.x, at.y + height - words + 32}, pictures[i].caption);
    }
    return sheet;
}

// ---- Axes ---------------------------------------------------------------------------------------

struct Axis {
    std::string label;  // with its unit
    double lo = 0, hi = 1;
    bool log = true;
    std::vector<double> ticks = {};  // none: powers of ten, or five even steps

    // 0 at lo, 1 at hi; beyond, at the nearer end.
    double part(double x) const {
        const double t = log ? std::log(x / lo) / std::log(hi / lo) : (x - lo) / (hi - lo);
        return std::clamp(t, 0.0, 1.0);
    }
    std::vector<double> marks() const {
        if (!ticks.empty()) return ticks;
        std::vector<double> out;
        // With room for the rounding of a logarithm: lo and hi may be powers of ten.
        for (double e = std::ceil(std::log10(lo) - 1e-9); log && e <= std::log10(hi) + 1e-9; ++e)
            out.push_back(std::pow(10, e));
        for (int k = 0; !log && k <= 4; ++k) out.push_back(lo + (hi - lo) * k / 4);
        return out;
    }
};

// A part of a sheet with two axes; labels of curves stand at their right ends.
class Plot {
public:
    // The frame's corner and size; ticks and labels need some 60 to its left, 45 below, 25 above.
    Plot(Svg& sheet, Place corner, Place size, Axis x, Axis y, std::string_view title)
        : sheet_(sheet), corner_(corner), size_(size), x_(std::move(x)), y_(std::move(y)) {
        for (double t : x_.marks()) {
            const double at = place(t, y_.lo).x;
            sheet_.line({{at, corner_.y}, {at, bottom()}}, svg::grid);
            sheet_.words({at, bottom() + 16}, svg::tick(t), {.anchor = "middle"});
        }
        for (double t : y_.marks()) {
            const double at = place(x_.lo, t).y;
            sheet_.line({{corner_.x, at}, {right(), at}}, svg::grid);
            sheet_.words({corner_.x - 6, at + 4}, svg::tick(t), {.anchor = "end"});
        }
        sheet_.line(
            {corner_, {right(), corner_.y}, {right(), bottom()}, {corner_.x, bottom()}, corner_},
            svg::frame);
        sheet_.words({corner_.x, corner_.y - 8}, title, {.bold = true});
        sheet_.words({corner_.x + size_.x / 2, bottom() + 34}, x_.label, {.anchor = "middle"});
        sheet_.words({corner_.x - 46, corner_.y + size_.y / 2}, y_.label,
                     {.anchor = "middle", .turn = -90});
    }
    Plot(const Plot&) = delete;
    Plot& operator=(const Plot&) = delete;
    // Labels find their places when all are known: a line apart, and none below the frame.
    ~Plot() {
        std::stable_sort(labels_.begin(), labels_.end(),
                         [](const Label& a, const Label& b) { return a.y < b.y; });
        double room = -INFINITY;
        for (Label& l : labels_) room = l.y = std::max(l.y, room + line_height);
        room = bottom() + line_height;
        for (size_t k = labels_.size(); k-- > 0;)
            room = labels_[k].y = std::min(labels_[k].y, room - line_height);
        for (const Label& l : labels_)
            sheet_.words({right() + 6, l.y + 4}, l.words, {.colour = l.colour});
    }

    Place place(double x, double y) const {
        return {corner_.x + size_.x * x_.part(x), corner_.y + size_.y * (1 - y_.part(y))};
    }

    struct Style {
        const char* colour = svg::ink;
        bool dots = true, dashed = false;
        double width = 2, radius = 3;  // of the line (0: none) and of the dots
    };
    // Points that are not finite are left out.
    void curve(const std::vector<double>& x, const std::vector<double>& y, const Style& style,
               const std::string& words = "") {
        std::vector<Place> through;
        for (size_t k = 0; k < x.size(); ++k)
            if (std::isfinite(x[k]) && std::isfinite(y[k])) through.push_back(place(x[k], y[k]));
        if (through.empty()) return;
        if (style.width > 0) sheet_.line(through, style.colour, style.width, style.dashed);
        for (const Place& p : through)
            if (style.dots) sheet_.dot(p, style.colour, style.radius);
        if (!words.empty()) labels_.push_back({through.back().y, words, style.colour});
    }
    // At the right border.
    void label(double y, const std::string& words, const char* colour) {
        labels_.push_back({place(x_.hi, y).y, words, colour});
    }
    // Between two curves.
    void band(const std::vector<double>& x, const std::vector<double>& low,
              const std::vector<double>& high, const char* colour) {
        std::vector<Place> outline;
        for (size_t k = 0; k < x.size(); ++k) outline.push_back(place(x[k], low[k]));
        for (size_t k = x.size(); k-- > 0;) outline.push_back(place(x[k], high[k]));
        sheet_.area(outline, colour, 0.2);
    }
    // A curve in a band of y ± deviation.
    void spread(const std::vector<double>& x, const std::vector<double>& y,
                const std::vector<double>& deviation, const char* colour,
                const std::string& words) {
        std::vector<double> low = y, high = y;
        for (size_t k = 0; k < y.size(); ++k) low[k] -= deviation[k], high[k] += deviation[k];
        band(x, low, high, colour);
        curve(x, y, {.colour = colour}, words);
    }

private:
    struct Label {
        double y;
        std::string words;
        const char* colour;
    };
    Svg& sheet_;
    Place corner_, size_;
    Axis x_, y_;
    std::vector<Label> labels_;

    static constexpr double line_height = svg::letter + 2;

    double right() const { return corner_.x + size_.x; }
    double bottom() const { return corner_.y + size_.y; }
};
