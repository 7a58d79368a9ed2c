// keep/compare.cpp  3  build/compare: the error of an image against a reference
//
//   build/compare REFERENCE IMAGE [--limit 2%] [--alpha 1e-6] [--heatmap FILE.png]
//       [--page FILE.html]
//
// With the reference f, the image g and N numbers (three per pixel):
//   d = sqrt(1/N sum (f - g)^2),  d_rel = d / sqrt(1/N sum f^2)   (Khodulev 1996, ch. 5)
//
// Both are .pfm or .film.  Two films know the variances of their pixels, so that Welch's test
// applies.  The images differ, with exit status 1, if d_rel is above the limit or p below alpha.
#include "base/stats.h"
#include "keep/film_file.h"
#include "keep/pair.h"
#include "keep/read_pfm.h"
#include "text/option.h"

namespace {
using namespace penumbra;

struct Difference {
    double d = 0, d_rel = 0;
    double ratio_of_means = 0;
    double largest = 0;  // |f - g|, of one channel
    int x = 0, y = 0;    // where
};

Difference difference(const Image& f, const Image& g) {
    Difference result;
    double squares = 0, reference = 0, sum_f = 0, sum_g = 0;
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const double a = double(f.at(x, y)[c]), b = double(g.at(x, y)[c]);
                const double error = std::abs(a - b);
                squares += error * error;
                reference += a * a;
                sum_f += a;
                sum_g += b;
                if (error > result.largest) result = {0, 0, 0, error, x, y};
            }
    result.d = std::sqrt(squares / (3.0 * double(f.pixels.size())));
    result.d_rel = squares > 0 ? std::sqrt(squares / reference) : 0;
    result.ratio_of_means = sum_g / sum_f;
    return result;
}

// Welch's test (1947) of the means of both images over all pixels, per channel.  Jung, Hanika,
// Dachsbacher 2020 test per pixel, with far less power.  Pixels are independent, and means of that
// many are normal.
struct Equality {
    size_t channel = 0;  // the channel that differs most
    double sigmas = 0;   // its difference in standard errors
    // Two-sided p-values of that channel, and of the worst of three.  Correlation of the channels
    // only makes the latter smaller (Sidak 1967).
    double p_alone = 1, p = 1;
};

Equality equality(const Image& f, const Image& g, const Image& variance_f,
                  const Image& variance_g) {
    Equality result;
    for (size_t c = 0; c < 3; ++c) {
        double difference = 0, variance = 0;
        for (size_t i = 0; i < f.pixels.size(); ++i) {
            difference += double(g.pixels[i][c]) - double(f.pixels[i][c]);
            variance += double(variance_f.pixels[i][c]) + double(variance_g.pixels[i][c]);
        }
        const double sigmas = difference != 0 ? difference / std::sqrt(variance) : 0;
        if (std::abs(sigmas) > std::abs(result.sigmas)) result = {c, sigmas};
    }
    result.p_alone = p_of_z(result.sigmas);
    result.p = -std::expm1(3 * std::log1p(-result.p_alone));  // 1 - (1 - p)^3
    return result;
}

// Error of each pixel, root mean square of its channels, in units of four times d: black, blue,
// red, yellow, white.
Image heatmap(const Image& f, const Image& g, double d) {
    const std::array<std::array<double, 3>, 5> colours = {
        {{0, 0, 0}, {0, 0, 0.5}, {0.8, 0, 0.1}, {1, 0.8, 0}, {1, 1, 1}}};
    Image map(f.width, f.height);
    for (size_t i = 0; i < f.pixels.size(); ++i) {
        double squares = 0;
        for (size_t c = 0; c < 3; ++c)
            squares += sqr(double(f.pixels[i][c]) - double(g.pixels[i][c]));
        const double error = d > 0 ? std::min(3.999, std::sqrt(squares / 3) / d) : 0;
        const size_t k = size_t(error);
        for (size_t c = 0; c < 3; ++c)
            map.pixels[i][c] =
                float(std::lerp(colours[k][c], colours[k + 1][c], error - double(k)));
    }
    return map;
}

// A page that needs nothing beside it: both images with a slider, and the numbers, as JSON too.
constexpr const char* page_head =
    R"(<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><title>compare</title><style>
:root { color-scheme: light dark; }
body { font: 1rem/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 76rem; padding: 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin-bottom: 1rem; }
th, td { padding: .2rem .8rem .2rem 0; text-align: left; font-weight: 400; }
</style>
<h1>An image and its reference</h1>
<table id="difference"></table>
)";
constexpr const char* page_tail = R"(<script>
const told = JSON.parse(document.getElementById("numbers").textContent);
const whole = x => x === null ? "not finite" : String(+x.toPrecision(6));
document.getElementById("difference").append(...[
    ["d_rel", `${whole(told.d_rel && 100 * told.d_rel)} %: the RMS of the error over that of the reference`],
    ["d", `${whole(told.d)}: the RMS of the error`], ["ratio of means", whole(told.ratio_of_means)],
    ["largest error", `${whole(told.largest)} at ${told.at.join()}`]].map(([name, words]) =>
    make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, words))));
</script>
)";

std::string page(const ImagePair& pair, const Difference& d) {
    json::Object numbers;
    numbers.add("d", json::number(d.d));
    numbers.add("d_rel", json::number(d.d_rel));
    numbers.add("ratio_of_means", json::number(d.ratio_of_means));
    numbers.add("largest", json::number(d.largest));
    numbers.add("at", "[" + std::to_string(d.x) + ", " + std::to_string(d.y) + "]");
    return page_head + html_of(pair) + "<script type=\"application/json\" id=\"numbers\">" +
           numbers.text() + "</script>\n" + std::string(pair_viewer) + page_tail;
}

void check_same_size(const Image& f, const Image& g) {
    if (f.width != g.width || f.height != g.height)
        throw UserError("sizes differ: " + std::to_string(f.width) + "x" +
                        std::to_string(f.height) + " and " + std::to_string(g.width) + "x" +
                        std::to_string(g.height));
}

// An image, and the variances of its pixels if it comes from a film.
struct Known {
    Image image;
    std::optional<Image> variance = {};
};

Known read_film(const std::string& path) {
    Size size;
    {
        const FilmReader file(path);
        size = {int(file.number("size", 65536)),
                int(file.number("rows", 65536, '-') + 1 - file.number("rows", 65536))};
    }
    FilmPixels film(path, size);
    Image image(size.width, size.height), variance(size.width, size.height);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        Pixel p;
        film.add_next(p);
        for (size_t c = 0; c < 3; ++c) {
            image.pixels[i][c] = float(p.value(c));
            variance.pixels[i][c] = float(p.variance(c));
        }
    }
    if (first_non_finite(variance)) return {image};  // one replication has none
    return {image, variance};
}

Known read_known(const std::string& path) {
    const Known known = path.ends_with(".film") ? read_film(path) : Known{read_pfm(path)};
    if (const auto pixel = first_non_finite(known.image))
        throw UserError(path + ": pixel " + *pixel + " is not finite");
    return known;
}

// ---- Options and verdict ------------------------------------------------------------------------

struct Request : CommonOptions {
    std::vector<std::string> images;
    std::string map, page;
    std::optional<double> limit, alpha;
};

OptionTable table_of(Request& r) {
    return OptionTable{{"--limit", "D", "exit with 1 if d_rel exceeds D, e.g. 2%", "",
                        [&r](Text v) { r.limit = parse_fraction(v); }},
                       {"--alpha", "P",
                        "exit with 1 if the p-value of the difference between the means of two "
                        "films is below P",
                        "1e-6",
                        [&r](Text v) {
                            r.alpha = parse_fraction(v);
                            if (!(*r.alpha > 0 && *r.alpha < 1))
                                throw UserError("must be between 0 and 1");
                        }},
                       {"--heatmap", "FILE.png",
                        "write an image of the errors: black (none) to white (4 d or more)", "",
                        [&r](Text v) {
                            r.map = v;
                            if (!v.ends_with(".png"))
                                throw UserError(in_quotes(v) + " must end in .png");
                        }},
                       {"--page", "FILE.html", "write a page with a slider between both images", "",
                        [&r](Text v) {
                            r.page = v;
                            if (!v.ends_with(".html"))
                                throw UserError(in_quotes(v) + " must end in .html");
                        }}} +
           in_group("", without(general_rows(r), {"--threads", "--quiet"}));
}

void print(const Difference& d, const std::optional<Equality>& e) {
    std::printf("d: %.6g\nd_rel: %.6g %%\nratio of means: %.6g\nlargest error: %.6g at %d,%d\n",
                d.d, 100 * d.d_rel, d.ratio_of_means, d.largest, d.x, d.y);
    const char* const channels[] = {"red", "green", "blue"};
    if (e)
        std::printf(
            "means: %s differs most, by %+.2f sigma: p = %.3g of one channel, %.3g of the "
            "worst of three\n",
            channels[e->channel], e->sigmas, e->p_alone, e->p);
}

// Prints "same: " or "differ: " with a comparison for each limit; returns the exit status.
int judge(const Request& r, const Difference& d, const std::optional<Equality>& e) {
    const double alpha = r.alpha.value_or(1e-6);
    const bool far = r.limit && d.d_rel > *r.limit, unlikely = e && e->p < alpha;
    if (!r.limit && !e) return 0;
    std::printf("%s: ", far || unlikely ? "differ" : "same");
    if (r.limit)
        std::printf("d_rel %.6g %% %s %.6g %%%s", 100 * d.d_rel, far ? ">" : "<=", 100 * *r.limit,
                    e ? ", " : "\n");
    if (e) std::printf("p = %.3g %s %.3g\n", e->p, unlikely ? "<" : ">=", alpha);
    return far || unlikely ? 1 : 0;
}

const char* const before_options =
    "usage: compare [options] REFERENCE IMAGE\n\nPrints the error of IMAGE against REFERENCE: d is "
    "the root mean square error,\nd_rel the relative RMSE: d divided by the RMS of REFERENCE.  "
    "Both are .pfm or .film.\nFor two films (penumbra --keep) it also compares the means.  The "
    "last line says\nwhether the images are the same (exit status 0) or differ (1).\n\n";

int compare(const std::vector<std::string>& words) {
    Request r;
    OptionTable table = table_of(r);
    parse_words(table, words, [&r](const std::string& word) { r.images.push_back(word); });
    if (print_manual(r, table, before_options, "")) return 0;
    if (r.images.size() != 2)
        throw UserError("usage: compare [options] REFERENCE IMAGE (try --help)");
    const auto [f, variance_f] = read_known(r.images[0]);
    const auto [g, variance_g] = read_known(r.images[1]);
    check_same_size(f, g);
    std::optional<Equality> e;
    if (variance_f && variance_g) e = equality(f, g, *variance_f, *variance_g);
    if (r.alpha && !e) throw UserError("--alpha: needs two films of --replications 2 or more");
    for (const std::string& file : {r.map, r.page})
        if (!file.empty()) check_writable(file);
    const Difference d = difference(f, g);
    print(d, e);
    if (!r.map.empty()) write_image(r.map, heatmap(f, g, d.d), 1);
    if (!r.page.empty()) write_file(r.page, page({g, f, r.images[1], r.images[0], {d.x, d.y}}, d));
    for (const std::string& file : {r.map, r.page})
        if (!file.empty()) std::fprintf(stderr, "wrote %s\n", printable(file).c_str());
    return judge(r, d, e);
}

}  // namespace

int main(int argc, char** argv) try {
    return finished(compare({argv + 1, argv + argc}));
} catch (...) {
    return failed();
}
