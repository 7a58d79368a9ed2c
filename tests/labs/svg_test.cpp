// labs/svg_test.cpp  plots are well-formed, and show the numbers at the right coordinates
#include "labs/svg.h"

#include <doctest/doctest.h>

namespace {
using namespace penumbra;

// Returns the first error of an XML file, if any: mismatched tags, attributes without quotes, a
// second root, characters that must be escaped.
std::string wrong_with(std::string_view xml) {
    std::vector<std::string> open;
    int roots = 0;
    for (size_t i = 0; i < xml.size(); ++i) {
        if (xml[i] == '&') {
            const std::string_view rest = xml.substr(i);
            if (!rest.starts_with("&amp;") && !rest.starts_with("&lt;") &&
                !rest.starts_with("&quot;"))
                return "a bare &";
        }
        if (xml[i] != '<') continue;
        size_t end = i + 1;
        for (bool quoted = false; end < xml.size() && (quoted || xml[end] != '>'); ++end) {
            if (xml[end] == '"') quoted = !quoted;
            if (xml[end] == '<') return "a bare <";
            if (xml[end] == '=' && !quoted && xml[end + 1] != '"') return "an unquoted attribute";
        }
        if (end >= xml.size()) return "a tag that does not end";
        const std::string_view tag = xml.substr(i + 1, end - i - 1);
        const std::string name(tag.substr(0, tag.find_first_of(" /", 1)));
        if (tag.starts_with('/')) {
            if (open.empty() || "/" + open.back() != name) return "unexpected <" + name + ">";
            open.pop_back();
        } else {
            if (open.empty() && ++roots > 1) return "a second root";
            if (!tag.ends_with('/')) open.push_back(name);
        }
        i = end;
    }
    return open.empty() ? "" : "<" + open.back() + "> is left open";
}

struct Words {
    std::string words;
    double x, y;
};

// All words of a sheet and their coordinates.
std::vector<Words> all_words(const std::string& file) {
    std::vector<Words> out;
    for (size_t at = 0; (at = file.find("<text x=\"", at)) != file.npos; ++at) {
        const size_t x = at + 9, y = file.find("y=\"", x) + 3, from = file.find('>', y) + 1;
        out.push_back({file.substr(from, file.find('<', from) - from), std::stod(file.substr(x)),
                       std::stod(file.substr(y))});
    }
    return out;
}

Words find(const std::string& file, std::string_view words) {
    for (const Words& w : all_words(file))
        if (w.words == words) return w;
    FAIL("no words " << words);
    return {};
}

}  // namespace

TEST_CASE("the judge of XML judges") {
    CHECK(wrong_with("<a><b x=\"1\"/>1 &lt; 2</a>\n") == "");
    CHECK(wrong_with("<a><b></a></b>") != "");
    CHECK(wrong_with("<a><b></a>") != "");
    CHECK(wrong_with("<a/><b/>") != "");
    CHECK(wrong_with("<a>R&D</a>") != "");
    CHECK(wrong_with("<a x=\"<\"/>") != "");
    CHECK(wrong_with("<a x=1/>") != "");
    CHECK(wrong_with("<a x=\"1/>") != "");
}

TEST_CASE("words keep their letters, whatever these mean in XML") {
    Svg sheet(100, 50);
    sheet.words({10, 20}, "\"a\" < b & c > d", {.anchor = "end", .bold = true, .turn = -90});
    CHECK(wrong_with(sheet.file()) == "");
    CHECK(find(sheet.file(), "&quot;a&quot; &lt; b &amp; c > d").x == 10);
}

TEST_CASE("a sheet with everything on it is well-formed, and says its size") {
    Svg sheet(640, 360);
    Image image(2, 1);
    image.at(0, 0) = image.at(1, 0) = {1, 0.5f, 0};
    sheet.picture({500, 40}, 64, image, 1);
    sheet.line({}, svg::ink);
    sheet.dot({1, 2}, svg::grid);
    CHECK(wrong_with(sheet.file()) == "");
    CHECK(sheet.file().find("viewBox=\"0 0 640 360\"") != std::string::npos);
    CHECK(sheet.file().find("width=\"64.0\" height=\"32.0\"") != std::string::npos);
}

TEST_CASE("a contact sheet: pictures row by row, each with its words, all on the sheet") {
    Image image(30, 20);
    image.pixels.assign(image.pixels.size(), {0, 0, 0});
    const std::string file =
        contact_sheet({{image, "a", "1 < 2"}, {image, "b", ""}, {image, "c", ""}}, 2, 1).file();
    CHECK(wrong_with(file) == "");
    CHECK(find(file, "b").x - find(file, "a").x > 30);
    CHECK(find(file, "b").y == find(file, "a").y);
    CHECK(find(file, "c").x == find(file, "a").x);
    CHECK(find(file, "c").y - find(file, "a").y > 20 + svg::letter);
    CHECK(find(file, "1 &lt; 2").y > find(file, "a").y);
    CHECK(find(file, "c").y < std::stod(file.substr(file.find("height=\"") + 8)));
}

TEST_CASE("axes go from one power of ten to another, with a tick at each") {
    const Axis a =
        axis_of({{"", {3, 20, 900}, {}}, {"", {2e-3, NAN, -1, INFINITY}, {}}}, &Series::x);
    CHECK(a.lo == doctest::Approx(1e-3));
    CHECK(a.hi == doctest::Approx(1e3));
    CHECK(a.marks().size() == 7);
    CHECK(a.marks().back() == doctest::Approx(1e3));
    CHECK(a.part(1e-3) == 0);
    CHECK(a.part(1) == doctest::Approx(0.5));
    const Axis one = axis_of({{"", {10, 10}, {}}}, &Series::x);
    CHECK(one.hi == doctest::Approx(100));
}

TEST_CASE("ticks are written as short as they can be read") {
    CHECK(percent(0.00982) == "0.982 %");
    CHECK(svg::tick(1e-3) == "10⁻³");
    CHECK(svg::tick(1e12) == "10¹²");
    CHECK(svg::tick(0.01) == "0.01");
    CHECK(svg::tick(100000) == "100000");
}

TEST_CASE("a plot: ticks, titles and labels stand at their places, labels a line apart") {
    const std::string file = plot({{"high", {1, 100}, {1, 80}},
                                   {"a little lower", {1, 100}, {1, 79}},
                                   {"at the bottom", {1, 100}, {5, 1}},
                                   {"there, too", {1, 100}, {5, 1}},
                                   {"one point", {1, 2, 100}, {NAN, 50, 0}},
                                   {"no point", {1, 10}, {NAN, -1}}},
                                  "x, m", "y, s", "R&D")
                                 .file();
    CHECK(wrong_with(file) == "");
    CHECK(find(file, "10").x == doctest::Approx(360));
    CHECK(find(file, "R&amp;D").y < 40);
    CHECK(find(file, "x, m").y > 340);
    CHECK(find(file, "y, s").x < 80);
    const double high = find(file, "high").y, lower = find(file, "a little lower").y,
                 bottom = find(file, "there, too").y, above = find(file, "at the bottom").y;
    CHECK(high == doctest::Approx(340 - 150 * std::log10(80) + 4).epsilon(0.001));
    CHECK(high < lower);
    CHECK(std::abs(high - lower) >= svg::letter);
    CHECK(std::abs(bottom - above) >= svg::letter);
    CHECK(std::max(bottom, above) == doctest::Approx(340 + 4));
    CHECK(find(file, "high").x > 640);
    // These points lie on the axes: x 1 to 100, y 1 to 100.
    CHECK(file.find("<circle cx=\"80.0\" cy=\"340.0\"") != file.npos);
    CHECK(file.find("<circle cx=\"640.0\" cy=\"340.0\"") != file.npos);
    for (const char* words : {"nan", "inf", "no point"}) CHECK(file.find(words) == file.npos);
}
