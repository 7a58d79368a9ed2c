// oracle/pictures.h  what a failed check saw, drawn in SVG; and the end of oracle.h
#pragma once
#include "checks.h"

namespace oracle::detail {

// ---- Pictures -----------------------------------------------------------------------------------

// A picture in SVG of a width and height in pixels; y points down.
struct Drawing {
    double width, height;
    std::string body = {};

    void rectangle(double x, double y, double w, double h, const std::string& style) {
        body += say("<rect x='%.2f' y='%.2f' width='%.2f' height='%.2f' style='%s'/>\n", x, y, w, h,
                    style.c_str());
    }
    void text(double x, double y, const std::string& words) {
        body += say("<text x='%.1f' y='%.1f'>", x, y);
        for (char c : words) body += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
        body += "</text>\n";
    }
    void curve(const std::vector<std::pair<double, double>>& points, const std::string& style) {
        body += "<polyline points='";
        for (const auto& [x, y] : points) body += say("%.1f,%.1f ", x, y);
        body += "' style='fill:none;" + style + "'/>\n";
    }

    // Three maps, row by row from the top, each 350 wide: black is 1, white 0; for the third, red
    // is 1, blue -1.
    void maps(const std::array<std::vector<double>, 3>& values, size_t across, double h,
              const std::array<const char*, 3>& titles) {
        const double w = 350.0 / double(across);
        for (size_t k = 0; k < 3; ++k) {
            const double left = 10 + 362 * double(k);
            text(left, 20, titles[k]);
            for (size_t i = 0; i < values[k].size(); ++i) {
                const double x = std::clamp(values[k][i], k == 2 ? -1.0 : 0.0, 1.0);
                const int fade = int(255 * (1 - std::abs(x)));
                rectangle(left + w * double(i % across), 30 + h * double(i / across), w + 0.1,
                          h + 0.1,
                          say("fill:rgb(%d,%d,%d)", k == 2 && x > 0 ? 255 : fade, fade,
                              k == 2 && x <= 0 ? 255 : fade));
            }
        }
    }

    // Into the folder of pictures; "" or "\nsee PATH".
    std::string written(const std::string& name) const {
        if (pictures.empty()) return "";
        static std::atomic<int> unnamed = 0;
        std::string file;
        for (char c : name.empty() ? say("check-%d", ++unnamed) : name)
            file += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
        for (size_t end = 0; end != std::string::npos;) {
            end = pictures.find('/', end + 1);
#ifdef _WIN32
            (void)_mkdir(pictures.substr(0, end).c_str());
#else
            (void)mkdir(pictures.substr(0, end).c_str(), 0777);
#endif
        }
        const std::string path = pictures + "/oracle-" + file.substr(0, 100) + ".svg";
        std::FILE* out = std::fopen(path.c_str(), "w");
        if (!out) return "\n" + path + ": cannot be written";
        std::fprintf(out,
                     "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' "
                     "font-family='sans-serif' font-size='12' shape-rendering='crispEdges'>\n"
                     "<rect width='100%%' height='100%%' fill='white'/>\n%s</svg>\n",
                     width, height, body.c_str());
        return (std::fclose(out) == 0 ? "\nsee " : "\ncannot be written: ") + path;
    }
};

// The running mean, and the band in which it would be with a mean of `truth`.
inline std::string picture_of(const Draws& draws, double truth, const Options& o) {
    const Estimate e = draws.estimate();
    const double t = where_equal([&](double x) { return p_of_t(x, e.df); }, o.alpha);
    std::vector<std::pair<double, double>> running, above, below;
    const double deviation = std::sqrt(draws.variance());
    const double half = std::max(1.5 * std::abs(e.mean - truth), 3 * t * e.standard_error);
    auto add = [&](auto& curve, double i, double y) {
        curve.emplace_back(60 + 520 * i / draws.n(),
                           180 - 140 * std::clamp((y - truth) / half, -1.1, 1.1));
    };
    double sum = 0;
    const size_t step = std::max<size_t>(1, draws.values.size() / 260);
    for (size_t i = 0; i < draws.values.size(); ++i) {
        sum += draws.values[i];
        if ((i + 1) % step != 0) continue;
        const double k = double(i + 1), band = t * deviation / std::sqrt(k);
        add(running, k, sum / k);
        add(above, k, truth + band);
        add(below, k, truth - band);
    }
    Drawing d{600, 350};
    d.curve({{60, 180}, {580, 180}}, "stroke:black");
    d.curve(above, "stroke:grey");
    d.curve(below, "stroke:grey");
    d.curve(running, "stroke:rgb(200,0,0);stroke-width:2");
    d.text(60, 20,
           say("running mean (red) of %.0f samples; grey: where it is with a mean of %.6g",
               draws.n(), truth));
    for (double k : {-1.0, 0.0, 1.0}) d.text(2, 184 - 140 * k, say("%.4g", truth + k * half));
    d.text(500, 345, say("n = %.0f", draws.n()));
    return d.written(o.name);
}

// Samples and pdf in bins of a part of the domain: phi (or the first coordinate) runs to the right,
// theta downwards.
template <class Check>
struct Bins {
    static constexpr size_t D = Check::D, across = 48, down = D == 1 ? 1 : 32,
                            right = D == 1 ? 0 : 1;
    const Check& check;
    Range<D> shown{check.domain.lower, check.domain.upper};
    double area = 1;  // of a bin
    std::vector<double> seen = std::vector<double>(across * down), claimed = seen;

    explicit Bins(const Check& check_) : check(check_) {
        for (size_t k = 0; k < D; ++k) {
            const auto [low, high] =
                std::minmax_element(check.pilot.begin(), check.pilot.end(),
                                    [k](const auto& a, const auto& b) { return a[k] < b[k]; });
            const double margin = 0.05 * ((*high)[k] - (*low)[k]) + 1e-12;
            shown.lower[k] = std::max(shown.lower[k], (*low)[k] - margin);
            shown.upper[k] = std::min(shown.upper[k], (*high)[k] + margin);
            area *= (shown.upper[k] - shown.lower[k]) / double(k == right ? across : down);
        }
    }
    double part(const Point<D>& c, size_t k) const {
        return (c[k] - shown.lower[k]) / (shown.upper[k] - shown.lower[k]);
    }
    void add(std::vector<double>& bins, const Point<D>& c, double what) const {
        const double x = part(c, right), y = D == 1 ? 0 : part(c, 0);
        if (x >= 0 && x < 1 && y >= 0 && y < 1)
            bins[size_t(y * double(down)) * across + size_t(x * double(across))] += what;
    }
    // The s-th of nine points within bin i.
    Point<D> point(size_t i, int s) const {
        Point<D> c;
        for (size_t k = 0; k < D; ++k) {
            const bool here = k == right;
            const double bin =
                double(here ? i % across : i / across) + ((here ? s % 3 : s / 3) + 0.5) / 3;
            c[k] = std::clamp(shown.lower[k] + bin / double(here ? across : down) *
                                                   (shown.upper[k] - shown.lower[k]),
                              check.domain.lower[k], check.domain.upper[k]);
        }
        return c;
    }

    // On a line bars and a curve, else two maps and that of their difference.
    std::string picture() const {
        const double most = std::max({1.0, *std::max_element(seen.begin(), seen.end()),
                                      *std::max_element(claimed.begin(), claimed.end())});
        // The worst cell, in parts of what is shown.
        Range<D> worst = check.range(worst_cell(check));
        for (Point<D>* end : {&worst.lower, &worst.upper}) {
            const Point<D> c = *end;
            for (size_t k = 0; k < D; ++k) (*end)[k] = std::clamp(part(c, k), 0.0, 1.0);
        }
        Drawing d{D == 1 ? 620.0 : 1100.0, 330};
        const std::string ends = "from " + say_point(check.domain.at(shown.lower)) + " to " +
                                 say_point(check.domain.at(shown.upper));
        if (D == 1) {
            std::vector<std::pair<double, double>> line;
            for (size_t i = 0; i < across; ++i) {
                const double x = 40 + 11.5 * double(i), height = 240 * seen[i] / most;
                d.rectangle(x, 290 - height, 10, height, "fill:rgb(170,170,170)");
                line.emplace_back(x + 5, 290 - 240 * claimed[i] / most);
            }
            d.curve(line, "stroke:rgb(200,0,0);stroke-width:2");
            d.text(40, 20, "samples (grey) and pdf (red), " + ends + "; worst cell below");
            d.rectangle(40 + 552 * worst.lower[0], 300, 552 * (worst.upper[0] - worst.lower[0]), 6,
                        "fill:black");
            return d.written(check.o.name);
        }
        std::array<std::vector<double>, 3> values;
        for (size_t i = 0; i < seen.size(); ++i) {
            values[0].push_back(std::sqrt(seen[i] / most));
            values[1].push_back(std::sqrt(claimed[i] / most));
            values[2].push_back((seen[i] - claimed[i]) / (std::sqrt(claimed[i] + seen[i] + 1) * 6));
        }
        d.maps(values, across, 8, {"samples", "pdf", "samples - pdf: red too many, blue too few"});
        for (double left : {10, 372, 734}) {
            d.rectangle(left, 30, 350, 256, "fill:none;stroke:black");
            d.rectangle(left + 350 * worst.lower[right], 30 + 256 * worst.lower[0],
                        350 * (worst.upper[right] - worst.lower[right]),
                        256 * (worst.upper[0] - worst.lower[0]),
                        "fill:none;stroke:rgb(0,140,0);stroke-width:3");
        }
        d.text(10, 304,
               (Check::directions ? "phi to the right, theta down, "
                                  : "the second coordinate to the right, the first down, ") +
                   ends + "; worst cell in green");
        return d.written(check.o.name);
    }
};

// 100 000 samples more, and the pdf at nine points of each bin.
template <size_t M, size_t N, class Domain>
std::string picture_of(DensityCheck<M, N, Domain>& check) {
    if (Domain::dimensions > 2 || pictures.empty()) return "";
    Bins bins(check);
    double total = 0;
    for (int i = 0; i < 100000; ++i)
        if (const auto c = check.one()) {
            ++total;
            bins.add(bins.seen, *c, 1);
        }
    for (size_t i = 0; i < bins.seen.size(); ++i)
        for (int s = 0; s < 9; ++s)
            bins.claimed[i] +=
                check.density_at(bins.point(i, s)) / 9 * bins.area * total / check.parts.total;
    return bins.picture();
}
// All samples, and the pdf at all points.
template <size_t N, class Domain>
std::string picture_of(const ArrayCheck<N, Domain>& check) {
    if (Domain::dimensions > 2 || pictures.empty()) return "";
    Bins bins(check);
    const auto& parts = check.part_of;
    const double each = double(check.samples.size()) / sum_of(parts);
    for (size_t i = 0; i < parts.size(); ++i)
        bins.add(bins.claimed, check.domain.coordinates(check.points[i]), parts[i] * each);
    for (const Point<N>& w : check.samples) bins.add(bins.seen, check.domain.coordinates(w), 1);
    return bins.picture();
}

inline std::string Image::picture() const {
    // The three, by blocks of pixels.
    const size_t across = std::min<size_t>(width, 64), down = std::min<size_t>(height, 48);
    std::array<std::vector<double>, 3> values;
    for (auto& v : values) v.resize(across * down);
    std::vector<double> weight(across * down);
    double most = 1e-300, most_off = 1e-300;
    for (size_t i = 0; i < n(); ++i)
        ++weight[(i / width) * down / height * across + (i % width) * across / width];
    for (size_t i = 0; i < n(); ++i) {
        const size_t b = (i / width) * down / height * across + (i % width) * across / width;
        values[0][b] += f[i] / weight[b], values[1][b] += truth[i] / weight[b];
        values[2][b] += (f[i] - truth[i]) / weight[b];
    }
    for (size_t b = 0; b < weight.size(); ++b) {
        most = std::max({most, values[0][b], values[1][b]});
        most_off = std::max(most_off, std::abs(values[2][b]));
    }
    for (size_t b = 0; b < weight.size(); ++b) {
        for (size_t k = 0; k < 2; ++k)
            values[k][b] = 1 - std::pow(std::max(0.0, values[k][b] / most), 1 / 2.2);
        values[2][b] /= most_off;
    }
    const double h = 350.0 * double(height) / double(width) / double(down);
    Drawing d{1100, 60 + h * double(down)};
    d.maps(values, across, h,
           {"image", "reference", "image - reference: red too bright, blue too dark"});
    d.text(10, 50 + h * double(down), say("white is %.4g; full red and blue %.4g", most, most_off));
    return d.written(o.name);
}

// Most of the time that a check of a density takes to compile.  Of a program of several files one
// is compiled with -DORACLE_CHECKS=, all others with -DORACLE_CHECKS=extern.
#ifdef ORACLE_CHECKS
ORACLE_CHECKS template Verdict DensityCheck<2, 3, Sphere>::run();
ORACLE_CHECKS template Verdict DensityCheck<3, 3, Sphere>::run();
ORACLE_CHECKS template Verdict DensityCheck<2, 2, Plane>::run();
ORACLE_CHECKS template Verdict DensityCheck<1, 1, Line>::run();
#endif

}  // namespace oracle::detail

// The end of oracle.h: what checks.h began with.
#undef ORACLE_PRINTF
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif
#pragma pop_macro("pi")
#pragma pop_macro("min")
#pragma pop_macro("max")
#pragma pop_macro("near")
#pragma pop_macro("far")
