// labs/trade_shots.h  5  a scene's pictures at equal time in HTML, with their values and error maps
#pragma once
#include "labs/trade_pixels.h"
#include "labs/trade_words.h"

namespace page {

using svg::escaped;

// Lines may end before an option, and not within one.
inline std::string code(const std::string& words) {
    std::string out = escaped(told_words(words));
    for (size_t at = 0; (at = out.find(" --", at)) != out.npos; at += 15)
        out.replace(at, 1, "</span> <span>");
    return "<code><span>" + out + "</span></code>";
}

inline std::string data_uri(const std::string& png) {
    return "data:image/png;base64," + svg::base64(png);
}

inline std::string img(const char* kind, const Image& size, const std::string& alt,
                       const std::string& png) {
    return text("<img class=\"%s\" width=\"%d\" height=\"%d\" alt=\"%s\" src=\"%s\">", kind,
                size.width, size.height, escaped(alt), data_uri(png));
}

// The colours of all error maps, with numbers.
inline std::string error_scale() {
    std::vector<int> all(error_levels);
    for (int k = 0; k < error_levels; ++k) all[size_t(k)] = k;
    std::string out = text("<div class=\"scale\"><img alt=\"%s\" src=\"%s\"><ul>\n",
                           "colours of the error maps, from dark to bright",
                           data_uri(error_png(error_levels, 1, all)));
    for (double mark : {1e-3, 1e-2, 1e-1, 1.0})
        out += text("<li style=\"left:%.2f%%\">%s%s</li>\n", 100 * error_axis.part(mark),
                    mark == error_axis.lo   ? "≤ "
                    : mark == error_axis.hi ? "≥ "
                                            : "",
                    told_percent(mark));
    return out + "</ul></div>\n";
}

// What is known of the bias: pictures name their settings.
inline std::string told_kind(const TradeScene& scene, const TradePicture& p) {
    for (const TradeSetting& s : scene.settings)
        if (s.words == p.words && s.is_float == p.is_float) return ::told_kind(s);
    return told_precision(p.is_float);
}

inline std::string reference_shot(const TradeScene& scene, double mean) {
    const Image& f = scene.reference;
    const std::string error = told_percent(scene.reference_error);
    return text(
        "<figure class=\"shot\" data-name=\"reference, known to %s\" data-values=\"%s\">\n%s\n"
        "<figcaption><b>Reference</b><br>known to %s</figcaption></figure>\n",
        error, svg::base64(packed_pixels(f, black(f.width, f.height), mean)),
        img("picture", f, scene.name + ": the reference", encode_png(f, scene.exposure)), error);
}

inline std::string shot(const TradeScene& scene, const TradePicture& p, double mean) {
    const std::string kind = told_kind(scene, p), words = told_words(p.words);
    const std::string result = told_seconds(p.seconds) + ", error " + told_percent(p.error);
    const std::string values = svg::base64(packed_pixels(p.image, scene.reference, mean));
    const std::string name = words + ", " + kind + ": " + result;
    return text(
        "<figure class=\"shot\" data-name=\"%s\" data-values=\"%s\">\n%s\n%s\n"
        "<figcaption>%s<br>%s<br>%s</figcaption></figure>\n",
        escaped(name), values,
        img("picture", p.image, scene.name + " by " + name, encode_png(p.image, scene.exposure)),
        img("map", p.image, "error map of " + scene.name + " by " + name,
            error_map(scene.reference, p.image, mean)),
        code(p.words), kind, result);
}

inline void check_picture(const TradeScene& scene, const Image& image) {
    if (image.width != scene.reference.width || image.height != scene.reference.height)
        throw UserError(scene.name + ": a picture is not as large as the reference");
    if (const auto pixel = first_non_finite(image))
        throw UserError(scene.name + ": no number in a picture's pixel " + *pixel);
}

// The same scene with pictures of as many pixels as a page can hold.
inline TradeScene small(TradeScene scene) {
    check_picture(scene, scene.reference);
    for (const TradePicture& p : scene.pictures) check_picture(scene, p.image);
    const int n = thinning(scene.reference);
    scene.reference = thinned(scene.reference, n);
    for (TradePicture& p : scene.pictures) p.image = thinned(p.image, n);
    return scene;
}

// mean: of the whole reference.
inline std::string pictures(const TradeScene& scene, double mean, int n) {
    const std::string part =
        n == 1 ? "" : text("  Of every %d×%d pixels of a picture one is shown.", n, n);
    std::string out = text(
        "<h3>Pictures at equal time</h3>\n"
        "<p>Below each picture is its error map: the error of each pixel, in parts of the "
        "reference's quadratic mean.%s\n<a class=\"scripted\" href=\"#scene=%s\">Compare two "
        "of them pixel by pixel</a></p>\n%s<div class=\"shots\">\n",
        part, escaped(scene.name), error_scale());
    out += reference_shot(scene, mean);
    for (const TradePicture& p : scene.pictures) out += shot(scene, p, mean);
    return out + "</div>\n";
}

}  // namespace page
