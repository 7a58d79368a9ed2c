// labs/trade_page.h  7  what `make trade` has measured as one page, on which a user chooses
//
// The page needs nothing but itself.  Without its script it shows curves, tables, pictures and
// error maps; with it, two pictures at a time are compared pixel by pixel.
#pragma once
#include "labs/trade_script.h"
#include "labs/trade_style.h"
#include "labs/trade_tables.h"

namespace page {

using svg::escaped;

inline std::string section(const Trade& trade, const TradeScene& scene) {
    const std::string name = escaped(scene.name);
    const double mean = quadratic_mean(scene.reference);
    const TradeScene shown = small(scene);
    std::string out = text(
        "<section class=\"scene\" id=\"scene-%s\" data-name=\"%s\" data-width=\"%d\" "
        "data-height=\"%d\" data-mean=\"%.9g\">\n<h2>%s</h2>\n",
        name, name, shown.reference.width, shown.reference.height, mean, name);
    if (!scene.remark.empty()) out += "<p>" + escaped(scene.remark) + "</p>\n";
    out += answers(scene) + curves(trade, scene);
    out += text("<details><summary>All %zu settings</summary>\n%s</details>\n",
                scene.settings.size(), settings(scene));
    if (!scene.pictures.empty()) out += pictures(shown, mean, thinning(scene.reference));
    return out + "</section>\n";
}

inline std::string lens(const char* id, const char* words) {
    return text(
        "<figure><canvas id=\"lens-%s\" width=\"144\" height=\"144\" role=\"img\" "
        "aria-label=\"%s, nine by nine pixels enlarged\"></canvas>"
        "<figcaption>%s</figcaption></figure>\n",
        id, words, words);
}

inline std::string values_row(const char* id, const char* words) {
    return text(
        "<tr id=\"row-%s\"><th scope=\"row\">%s</th><td class=\"number\"></td>"
        "<td class=\"number\"></td><td class=\"number\"></td><td class=\"number\"></td></tr>\n",
        id, words);
}

inline constexpr const char* compare_controls = R"html(
<h2 id="compare-title" tabindex="-1">Two pictures, pixel by pixel</h2>
<p id="compare-help">Point at a pixel; or go to the pictures by the tab key and press the arrow keys,
with Shift for ten pixels at a time.  The space bar flips, and dragging wipes.
The address leads here again.</p>
<form id="controls" onsubmit="return false">
<label>Scene <select id="scene"></select></label>
<fieldset><legend>Show A and B</legend>
<label><input type="radio" name="mode" value="side" checked> side by side</label>
<label><input type="radio" name="mode" value="flip"> flipped</label>
<label><input type="radio" name="mode" value="wipe"> wiped</label>
<label><input type="radio" name="mode" value="error"> as error maps</label></fieldset>
<fieldset><legend>Pixel</legend>
<label>x <input type="number" id="x" min="0" value="0"></label>
<label>y <input type="number" id="y" min="0" value="0"></label></fieldset>
<button type="button" id="flip" data-of="flip">Flip to B</button>
<label data-of="wipe">A ends, B begins <input type="range" id="wipe" min="0" max="100" value="50"></label>
<label class="wide">Picture A <select id="a"></select></label>
<label class="wide">Picture B <select id="b"></select></label>
</form>
<div id="stage" tabindex="0" role="application" aria-label="Pictures A and B" aria-describedby="compare-help">
<p id="name-a" class="a"><b>A</b> <span></span></p>
<div class="a frame"><img id="image-a" alt=""><span class="mark"></span></div>
<p id="name-b" class="b"><b>B</b> <span></span></p>
<div class="b frame"><img id="image-b" alt=""><span class="mark"></span></div>
</div>
)html";

inline std::string compare() {
    return std::string(
               "<section id=\"compare\" class=\"scripted\" "
               "aria-labelledby=\"compare-title\">") +
           compare_controls + "<div data-of=\"error\">" + error_scale() + "</div>\n" +
           "<output id=\"live\" aria-live=\"polite\" for=\"x y\"></output>\n"
           "<div class=\"lenses\"><div>\n" +
           lens("r", "reference") + lens("a", "A") + lens("b", "B") +
           "</div>\n<table id=\"values\"><caption>Linear values of the pixel, "
           "and its error over the quadratic mean</caption>\n<thead><tr><td></td>"
           "<th scope=\"col\" class=\"number\">red</th><th scope=\"col\" "
           "class=\"number\">green</th>"
           "<th scope=\"col\" class=\"number\">blue</th>"
           "<th scope=\"col\" class=\"number\">error</th></tr></thead>\n<tbody>\n" +
           values_row("r", "reference") + values_row("a", "A") + values_row("b", "B") +
           "</tbody></table></div>\n</section>\n";
}

inline std::string introduction(const Trade& trade) {
    std::string out = text(
        "<h1>Accuracy against time</h1>\n"
        "<p>Which setting of Penumbra reaches an error in the least time, and what does it cost "
        "not "
        "to choose?  An error is d<sub>rel</sub>: the quadratic mean of an image's error over the "
        "reference's quadratic mean.  Times are those of one core, for an image of the size that "
        "the scene's file gives.  The default is %s.</p>\n",
        code(trade.default_words));
    if (!trade.candidates.empty()) {
        const TradeCandidate& best = trade.candidates[0];
        out += text(
            "<p>For those who do not want to choose: %s in %s takes %s the time of the cheapest "
            "setting that is unbiased and takes every scene, in the geometric mean of scenes, and "
            "%s at worst (%s).</p>\n",
            code(best.words), told_precision(best.is_float), told_ratio(best.mean_ratio),
            told_ratio(best.worst_ratio), escaped(best.worst_scene));
    }
    out +=
        "<nav aria-label=\"Scenes\"><ul>\n<li class=\"scripted\"><a href=\"#compare\">Compare "
        "pictures</a></li>\n";
    for (const TradeScene& scene : trade.scenes)
        out += text("<li><a href=\"#scene-%s\">%s</a></li>\n", escaped(scene.name),
                    escaped(scene.name));
    return out + "</ul></nav>\n";
}

}  // namespace page

// One file of HTML.
inline std::string trade_page(const Trade& trade) {
    std::string out = text(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n"
        "<title>Penumbra: accuracy against time</title>\n<style>%s</style>\n</head>\n<body>\n"
        "<header>%s</header>\n<main>\n",
        trade_style, page::introduction(trade));
    if (!trade.scenes.empty()) out += "<h2>The answers</h2>\n" + page::overview(trade);
    if (!trade.candidates.empty())
        out += "<h2>One default for all</h2>\n" + page::candidates(trade);
    out += page::compare();
    for (const TradeScene& scene : trade.scenes) out += page::section(trade, scene);
    return out +
           text(
               "</main>\n<footer><p>Measured by %s.</p></footer>\n<script>%s</script>\n</body>\n"
               "</html>\n",
               page::code(trade.command), trade_script);
}
