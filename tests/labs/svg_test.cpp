// labs/svg_test.cpp  plots are well-formed, and show the numbers where the axes say
#include "labs/svg.h"

#include <doctest/doctest.h>

#include <functional>

namespace {

// What is wrong with a file of XML, if anything: tags that do not match, attributes without quotes,
// a second root, characters that must be escaped.
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

// All words of a sheet and their places.
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

std::string drawn(Axis x, Axis y, const std::function<void(Plot&)>& draw) {
    Svg sheet(640, 360);
    {
        Plot plot(sheet, {70, 40}, {400, 250}, std::move(x), std::move(y), "title");
        draw(plot);
    }
    return sheet.file();
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
    sheet.area({{1, 1}, {2, 1}, {2, 2}}, svg::grid, 0.5);
    sheet.line({}, svg::ink);
    {
        Plot plot(sheet, {70, 40}, {400, 250}, {"x, m", 1, 100}, {"y, s", 0, 1, false}, "R&D");
        plot.curve({1, 10, 100}, {0.1, 0.5, 0.9}, {.dashed = true}, "a < b");
        plot.band({1, 100}, {0.1, 0.2}, {0.3, 0.4}, svg::colours[1]);
    }
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

TEST_CASE("base64 as in RFC 4648, section 10") {
    CHECK(svg::base64("") == "");
    CHECK(svg::base64("f") == "Zg==");
    CHECK(svg::base64("fo") == "Zm8=");
    CHECK(svg::base64("foo") == "Zm9v");
    CHECK(svg::base64("foob") == "Zm9vYg==");
    CHECK(svg::base64("fooba") == "Zm9vYmE=");
    CHECK(svg::base64("foobar") == "Zm9vYmFy");
    CHECK(svg::base64("\xff\xfe\x80") == "//6A");
}

TEST_CASE("a plot's corners are the ends of its axes, and its middle is theirs") {
    Svg sheet(640, 360);
    const Plot logarithmic(sheet, {70, 40}, {400, 250}, {"x", 1, 10000}, {"y", 1e-4, 1}, "");
    CHECK(logarithmic.place(1, 1e-4).x == doctest::Approx(70));
    CHECK(logarithmic.place(1, 1e-4).y == doctest::Approx(290));
    CHECK(logarithmic.place(10000, 1).x == doctest::Approx(470));
    CHECK(logarithmic.place(10000, 1).y == doctest::Approx(40));
    CHECK(logarithmic.place(100, 1e-2).x == doctest::Approx(270));
    CHECK(logarithmic.place(100, 1e-2).y == doctest::Approx(165));
    CHECK(logarithmic.place(1e9, 0).x == doctest::Approx(470));  // at the nearer end
    CHECK(logarithmic.place(1e9, 0).y == doctest::Approx(290));
    const Plot linear(sheet, {0, 0}, {100, 100}, {"x", -1, 1, false}, {"y", 2, 4, false}, "");
    CHECK(linear.place(-1, 2).x == doctest::Approx(0));
    CHECK(linear.place(0.5, 3).x == doctest::Approx(75));
    CHECK(linear.place(0.5, 3.5).y == doctest::Approx(25));
}

TEST_CASE("ticks: every power of ten of a logarithmic axis, ends included; five of a linear one") {
    CHECK(Axis{"", 1e-3, 1e3}.marks().size() == 7);
    CHECK(Axis{"", 1e-3, 1e3}.marks().front() == doctest::Approx(1e-3));
    CHECK(Axis{"", 1e-3, 1e3}.marks().back() == doctest::Approx(1e3));
    CHECK(Axis{"", 2e-3, 900}.marks().size() == 5);
    CHECK(Axis{"", 0, 2, false}.marks() == std::vector<double>{0, 0.5, 1, 1.5, 2});
    CHECK(Axis{"", 1, 4096, true, {1, 64, 4096}}.marks() == std::vector<double>{1, 64, 4096});
}

TEST_CASE("ticks are written as short as they can be read") {
    CHECK(svg::tick(0) == "0");
    CHECK(svg::tick(0.25) == "0.25");
    CHECK(svg::tick(-2) == "-2");
    CHECK(svg::tick(4096) == "4096");
    CHECK(svg::tick(1e-3) == "10⁻³");
    CHECK(svg::tick(1e12) == "10¹²");
    CHECK(svg::tick(-1e-3) == "-10⁻³");
    CHECK(svg::tick(0.01) == "0.01");
    CHECK(svg::tick(100000) == "100000");
    CHECK(svg::tick(1234567) == "1.235e+06");
    CHECK(svg::tick(65536) == "65536");
}

TEST_CASE("ticks and titles stand at their places") {
    const std::string file = drawn({"x, m", 1, 100}, {"y, s", 0, 1, false}, [](Plot&) {});
    CHECK(find(file, "1").x == 70);
    CHECK(find(file, "10").x == 270);
    CHECK(find(file, "100").x == 470);
    CHECK(find(file, "0.25").y > find(file, "0.5").y);
    CHECK(find(file, "x, m").y > 290);
    CHECK(find(file, "y, s").x < 70);
    CHECK(find(file, "title").y < 40);
}

TEST_CASE("labels stand at the ends of their curves, a line apart and within the frame") {
    const std::string file = drawn({"x", 0, 1, false}, {"y", 0, 1, false}, [](Plot& plot) {
        plot.curve({0, 1}, {0, 0.80}, {}, "high");
        plot.curve({0, 1}, {0, 0.79}, {}, "a little lower");
        plot.curve({0, 1}, {0, 0.5}, {}, "alone");
        plot.curve({0, 1}, {0, 0}, {}, "at the bottom");
        plot.label(0, "there, too", svg::ink);
    });
    const double high = find(file, "high").y, lower = find(file, "a little lower").y;
    CHECK(high == doctest::Approx(40 + 0.2 * 250 + 4));
    CHECK(lower - high >= svg::letter);
    CHECK(find(file, "alone").y == doctest::Approx(40 + 0.5 * 250 + 4));
    const double bottom = find(file, "there, too").y, above = find(file, "at the bottom").y;
    CHECK(bottom == doctest::Approx(290 + 4));
    CHECK(bottom - above >= svg::letter);
    CHECK(find(file, "high").x > 470);
}

TEST_CASE("what is no number is not drawn") {
    const std::string file = drawn({"x", 0, 1, false}, {"y", 1e-3, 1}, [](Plot& plot) {
        plot.curve({0, 0.5, 1}, {0.5, NAN, INFINITY}, {}, "one point");
        plot.curve({0, 1}, {NAN, NAN}, {}, "no point");
    });
    CHECK(file.find("nan") == std::string::npos);
    CHECK(file.find("inf") == std::string::npos);
    CHECK(file.find("no point") == std::string::npos);
    CHECK(find(file, "one point").y < 165);
}
