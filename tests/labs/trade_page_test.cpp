// labs/trade_page_test.cpp  the page says what was measured, needs nothing but itself, and leaves
// nobody out
#include "labs/trade_page.h"

#include <set>

#include "base/rng.h"
#include "labs/trade_report.h"
#include "labs/trade_sample.h"

namespace {

const std::string cheapest_on = "The cheapest setting for an error on ",
                  answers_end = ", and how many times its time the default takes";

using Rows = std::vector<std::vector<std::string>>;

size_t lines(std::string_view words) {
    return size_t(std::count(words.begin(), words.end(), '\n'));
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

}  // namespace

TEST_CASE("the judge of pages judges") {
    CHECK(Html("<!doctype html><p id=\"a\">1 &lt; 2<br></p>").by_id("a").words == "1 < 2");
    CHECK(Html("<script>a < b && c</script>").elements.size() == 1);
    CHECK(
        Html("<table><caption>c</caption><thead><tr><th>1</th></tr></thead></table>").table("c") ==
        Rows{{"1"}});
}

TEST_CASE("the answers on the page are the measured ones") {
    const Html page(trade_page(sample_trade()));
    const Rows rows = page.table(cheapest_on + "first" + answers_end);
    CHECK(rows ==
          Rows{{"Error", "Cheapest setting", "Its time", "The default's"},
               {"10 %", "--sampler halton --light needouble, unbiased", "0.0151 s",
                "0.0400 s · 2.65×"},
               {"3 %", "--sampler sobol --light misfloat, unbiased", "0.400 s", "0.444 s · 1.11×"},
               {"1 %", "--sampler halton --light needouble, unbiased", "1.51 s", "4.00 s · 2.64×"},
               {"0.3 %", "none measured gets there", "–", "–"}});
    const Rows all = page.table(
        "Time of the cheapest setting · how many times that the default takes; –: nothing "
        "measured gets there");
    CHECK(all == Rows{{"Scene", "10 %", "3 %", "1 %", "0.3 %"},
                      {"first", "0.0151 s · 2.65×", "0.400 s · 1.11×", "1.51 s · 2.64×", "–"},
                      {"second", "0.0151 s · 2.65×", "0.400 s · 1.11×", "1.51 s · 2.64×", "–"}});
}

TEST_CASE("the page's numbers are those of the report's table") {
    const Trade trade = sample_trade();
    const Html page(trade_page(trade));
    for (const TradeScene& scene : trade.scenes) {
        const Rows rows = page.table(cheapest_on + scene.name + answers_end);
        REQUIRE(rows.size() == scene.answers.size() + 1);
        for (size_t k = 0; k < scene.answers.size(); ++k) {
            const std::string cell = trade::cell(scene, scene.answers[k]);
            const std::vector<std::string>& row = rows[k + 1];
            CHECK_MESSAGE(cell.starts_with(row[2]), cell);
            const std::string own = row[3].substr(0, row[3].find(" ·"));
            CHECK_MESSAGE(cell.ends_with("default " + own), cell);
        }
    }
}

TEST_CASE("a scene that was asked for other errors has its answers in their columns") {
    Trade trade = sample_trade();
    trade.scenes[1].answers.erase(trade.scenes[1].answers.begin());
    const Rows all =
        Html(trade_page(trade))
            .table(
                "Time of the cheapest setting · how many times that the default takes; –: nothing "
                "measured gets there");
    CHECK(all[2] ==
          std::vector<std::string>{"second", "–", "0.400 s · 1.11×", "1.51 s · 2.64×", "–"});
}

TEST_CASE("all settings, and those that may be the default, are on the page") {
    const Html page(trade_page(sample_trade()));
    const Rows rows =
        page.table("All settings on second, each with the last count that was measured");
    REQUIRE(rows.size() == 5);
    CHECK(rows[1] == std::vector<std::string>{"--sampler sobol --light mis", "double, unbiased",
                                              "2 % · t^−0.50", "4.08 %", "64", "0.640 s", "2.5 %",
                                              ""});
    CHECK(rows[3][1] == "double, biased");
    CHECK(rows[3][7] == "after 64 samples: 1/11 of the best's efficiency");
    CHECK(rows[4][1] == "float, unbiased");
    CHECK(page.table("Unbiased settings that take every scene: their time over the cheapest such "
                     "one's") ==
          Rows{{"Setting", "Numbers", "Geometric mean of scenes", "Worst", "There"},
               {"--sampler sobol --light mis", "double", "1.08×", "1.31×", "second"},
               {"--sampler halton --light mis", "float", "1.20×", "2.50×", "first"}});
}

TEST_CASE("beside each picture stand its setting, precision, bias, time and error") {
    const Html page(trade_page(sample_trade()));
    const std::vector<Element> captions = page.all("figcaption");
    auto told = [&](const std::string& words) {
        return std::count_if(captions.begin(), captions.end(),
                             [&](const Element& e) { return e.words == words; });
    };
    CHECK(told("Referenceknown to 0.12 %") == 2);
    CHECK(told("--sampler sobol --light misdouble, unbiased0.310 s, error 3.59 %") == 2);
    CHECK(told("--sampler halton --light nee --direct ratiodouble, biased0.290 s, error 9.12 %") ==
          2);
    CHECK(told("--sampler sobol --light misfloat, unbiased0.300 s, error 3.45 %") == 2);
    CHECK(
        contains(page.by_id("scene-second").words, "In float a sphere of this scene is 5 % off."));
    CHECK(!contains(page.by_id("scene-first").words, "5 % off"));
}

TEST_CASE("the page needs nothing but itself") {
    const std::string bytes = trade_page(sample_trade());
    for (const Element& e : Html(bytes).elements)
        for (const char* name : {"src", "href", "srcset", "action", "data", "poster", "xlink:href"})
            if (e.has(name))
                CHECK_MESSAGE((e.of(name).starts_with("#") || e.of(name).starts_with("data:")),
                              e.of(name));
    for (const char* outside : {"http", "//www", "@import", "url(", "fetch(", "import("})
        CHECK_MESSAGE(!contains(bytes, outside), outside);
}

TEST_CASE("the script is at most 150 lines, none of which hides another") {
    CHECK(lines(trade_script) <= 150);
    std::istringstream in(trade_script);
    for (std::string line; std::getline(in, line);) CHECK_MESSAGE(line.size() <= 100, line);
    CHECK(Html(trade_page(sample_trade())).all("script").size() == 1);
}

TEST_CASE("whatever words a trade has, they are words on the page") {
    Trade trade = sample_trade();
    const std::string words = "<b>\"R&D\"</b> &lt; 'x'";
    trade.default_words = trade.command = trade.scenes[0].remark = trade.scenes[0].name =
        trade.scenes[0].settings[0].words = trade.scenes[0].settings[0].dropped =
            trade.scenes[0].pictures[0].words = trade.candidates[0].words =
                trade.candidates[0].worst_scene = words;
    const Html page(trade_page(trade));  // well-formed
    for (const Element& e : page.all("b")) CHECK(e.words != "\"R&D\"");
    CHECK(page.by_id("scene-" + words).of("data-name") == words);
    for (const char* tag : {"h2", "p", "td", "th", "a", "code", "li", "figcaption"}) {
        const std::vector<Element> all = page.all(tag);
        CHECK_MESSAGE(std::any_of(all.begin(), all.end(),
                                  [&](const Element& e) { return contains(e.words, words); }),
                      tag);
    }
}

TEST_CASE("who sees no pictures is told them; who uses no mouse reaches all") {
    const Html page(trade_page(sample_trade()));
    std::set<std::string> ids;
    for (const Element& e : page.elements)
        if (e.has("id")) CHECK_MESSAGE(ids.insert(e.of("id")).second, "twice " << e.of("id"));
    for (const Element& e : page.elements) {
        const bool viewer = e.of("id").starts_with("image-");  // the script says what they show
        if (e.tag == "img" && !viewer) CHECK(!e.of("alt").empty());
        if (e.tag == "svg" || e.tag == "canvas")
            CHECK_MESSAGE((e.of("role") == "img" && !e.of("aria-label").empty()), e.tag);
        if (e.tag == "input" || e.tag == "select") CHECK(page.within(e, "label"));
        if (e.tag == "button") CHECK(!e.words.empty());
        if (e.tag == "th") CHECK((e.of("scope") == "col" || e.of("scope") == "row"));
        if (e.tag == "table") CHECK(!page.elements[e.parent].tag.empty());
        for (const char* name : {"aria-describedby", "aria-labelledby"})
            if (e.has(name)) CHECK(ids.contains(e.of(name)));
        const std::string link = e.of("href");
        if (link.starts_with("#") && !link.starts_with("#scene="))
            CHECK(ids.contains(link.substr(1)));
    }
    CHECK(page.by_id("live").of("aria-live") == "polite");
    CHECK(page.by_id("stage").of("tabindex") == "0");
    CHECK(page.all("html")[0].of("lang") == "en");
}

TEST_CASE("headings: one of the first order, and none skips an order") {
    int before = 0, first = 0;
    for (const Element& e : Html(trade_page(sample_trade())).elements)
        if (e.tag.size() == 2 && e.tag[0] == 'h' && std::isdigit(e.tag[1])) {
            const int order = e.tag[1] - '0';
            first += order == 1;
            CHECK(order <= before + 1);
            before = order;
        }
    CHECK(first == 1);
}

TEST_CASE("without its script the page shows pictures, maps and curves") {
    const Html page(trade_page(sample_trade()));
    size_t pictures = 0, maps = 0;
    for (const Element& e : page.all("img")) {
        pictures += e.of("class") == "picture";
        maps += e.of("class") == "map";
    }
    CHECK(pictures == 8);
    CHECK(maps == 6);
    CHECK(page.all("svg").size() == 2);
    CHECK(page.by_id("compare").of("class") == "scripted");  // which the style hides
}

TEST_CASE("the default's curve has the first colour; settings that answer have a name") {
    const Trade trade = sample_trade();
    CHECK(named_settings(trade, trade.scenes[0]) == std::vector<size_t>{0, 1, 3});
    Trade other = trade;
    for (int k = 0; k < 20; ++k)
        other.scenes[0].settings.push_back(sample_setting(text("--seed %d", k), 0.1)),
            other.scenes[0].answers.push_back({0.001, size_t(4 + k), 1, 1});
    CHECK(named_settings(other, other.scenes[0]).size() == most_named);
    CHECK(named_settings(other, other.scenes[0])[0] == 0);
    other.default_words = "--unheard-of";
    CHECK(named_settings(other, other.scenes[0])[0] == 1);
    const std::string svg = curves_svg(trade.scenes[0], {0, 1, 3}).file();
    CHECK(contains(svg, text("stroke=\"%s\"", svg::colours[2])));
    CHECK(!contains(svg, text("stroke=\"%s\"", svg::colours[3])));
    CHECK(contains(svg, text("stroke=\"%s\"", unnamed)));
    CHECK(contains(svg, "stroke-dasharray"));  // float
    CHECK(!contains(curves_svg(trade.scenes[0], {0, 1}).file(), "stroke-dasharray"));
}

TEST_CASE("axes hold all points, and are marked at 1 and 3 times powers of ten") {
    const Axis axes[] = {axis_of("", {0.02, 5, NAN, 0, -1}), axis_of("", {1, 1e4}),
                         axis_of("", {})};
    CHECK(axes[0].lo < 0.02);
    CHECK(axes[0].hi > 5);
    CHECK(axes[0].ticks.size() == 5);  // 0.03, 0.1, 0.3, 1, 3; 5 × 1.5 is below 10
    CHECK(axes[0].ticks.front() == doctest::Approx(0.03));
    CHECK(axes[1].ticks.size() == 5);  // powers of ten: 1 ... 10 000
    CHECK(axes[2].lo < axes[2].hi);
}

TEST_CASE("a law is drawn through what it says at the ends of its points") {
    TradeSetting s = sample_setting("", 0.02);
    s.points[1].error = 1;  // the law does not follow
    const Curve law = fitted(s);
    CHECK(law.seconds == std::vector<double>{0.04, 0.64});
    CHECK(law.percent[0] == doctest::Approx(10));
    CHECK(law.percent[1] == doctest::Approx(2.5));
    CHECK(measured(s).percent[1] == 100);
    s.c = NAN;
    CHECK(fitted(s).seconds.empty());
}

TEST_CASE("a picture of another size, or with what is no number, is refused") {
    Trade trade = sample_trade();
    trade.scenes[1].pictures[2].image = sample_image(9, 8, 3);
    CHECK_THROWS_WITH_AS(trade_page(trade), "second: a picture is not as large as the reference",
                         UserError);
    trade = sample_trade();
    trade.scenes[0].pictures[1].image.at(3, 2)[1] = NAN;
    CHECK_THROWS_WITH_AS(trade_page(trade), "first: no number in a picture's pixel 3,2", UserError);
}

TEST_CASE("pictures of many pixels are thinned; errors stay in parts of all the reference's mean") {
    Trade trade = sample_trade();
    TradeScene& scene = trade.scenes[0];
    scene.reference = sample_image(256, 64, 0);
    for (TradePicture& p : scene.pictures) p.image = sample_image(256, 64, 1);
    const Html page(trade_page(trade));
    const Element section = page.by_id("scene-first");
    CHECK(section.of("data-width") == "128");
    CHECK(section.of("data-height") == "32");
    CHECK(std::stod(section.of("data-mean")) ==
          doctest::Approx(quadratic_mean(scene.reference)).epsilon(1e-6));
    CHECK(contains(section.words, "Of every 2×2 pixels of a picture one is shown."));
    CHECK(!contains(page.by_id("scene-second").words, "one is shown"));
    for (const Element& e : page.all("img"))
        if (e.of("class") == "picture")
            CHECK(e.of("width") == (e.of("alt").starts_with("first") ? "128" : "9"));
}

TEST_CASE("a trade without pictures, answers, points or scenes has a page, too") {
    Trade trade = sample_trade();
    trade.scenes[0].pictures.clear(), trade.scenes[0].reference = {};
    trade.scenes[1].answers.clear();
    for (TradeSetting& s : trade.scenes[1].settings) s.points.clear(), s.c = NAN;
    CHECK(Html(trade_page(trade)).all("svg").size() == 2);
    CHECK(Html(trade_page(Trade{})).all("section").size() == 1);
}

TEST_CASE("fifteen scenes of seven pictures of 8192 pixels of noise are less than 9 MB") {
    auto noise = [](uint64_t seed) {
        Rng rng{seed};
        return painted(128, 64, [&](int, int) {
            const auto x = float(rng.uniform()), y = float(rng.uniform()), z = float(rng.uniform());
            return Colour{x, y, z};
        });
    };
    Trade trade = sample_trade();
    trade.scenes.resize(1);
    trade.scenes[0].reference = noise(0);
    for (size_t k = 0; k < 3; ++k) trade.scenes[0].pictures[k].image = noise(k + 1);
    const size_t three = trade_page(trade).size();
    trade.scenes[0].pictures.resize(2);
    const double one = double(three - trade_page(trade).size());
    CHECK(15 * 7 * one < 9e6);
}
