// labs/trade_sample.h  a small trade that nobody measured, and a reader of pages
#pragma once
#include <doctest/doctest.h>

#include <map>

#include "labs/trade_page.h"

// Every pixel, channel and picture has another value; picture 0 is a reference.
inline Image sample_image(int width, int height, int picture) {
    return painted(width, height, [&](int x, int y) {
        const int n = (7 * x + 5 * y + 3 * picture) % 11;
        const float off = picture == 0 ? 0 : 0.01f * float(n * picture);
        const float blue = picture == 3 && x == 8 ? 0 : 0.2f + off;
        return Colour{0.05f + 0.06f * float(x) + off, 0.05f + 0.1f * float(y) - off / 2, blue};
    });
}

inline TradeSetting sample_setting(const std::string& words, double c) {
    TradeSetting s{words};
    s.c = c, s.gamma = 0.5, s.spread = 0.04;
    for (double spp : {4, 16, 64})
        s.points.push_back({spp, spp / 100, c / std::sqrt(spp / 100), c / 100});
    return s;
}

inline TradeScene sample_scene(const std::string& name, int width, int height) {
    TradeScene s{name};
    s.width = 256, s.height = 128, s.exposure = 0.75;
    s.settings = {sample_setting("--sampler sobol --light mis", 0.02),
                  sample_setting("--sampler halton --light nee", 0.0123),
                  sample_setting("--sampler halton --light nee --direct ratio", 0.05),
                  sample_setting("--sampler sobol --light mis", 0.019)};
    s.settings[2].unbiased = false;
    s.settings[2].dropped = "after 64 samples: 1/11 of the best's efficiency";
    s.settings[3].is_float = true;
    s.answers = {
        {0.1, 1, 0.0151, 0.04}, {0.03, 3, 0.4, 0.4444}, {0.01, 1, 1.513, 4}, {0.003, SIZE_MAX}};
    s.reference = sample_image(width, height, 0);
    s.reference_error = 0.0012;
    s.pictures = {{s.settings[0].words, false, 0.31, 0.0359, sample_image(width, height, 1)},
                  {s.settings[2].words, false, 0.29, 0.0912, sample_image(width, height, 2)},
                  {s.settings[3].words, true, 0.3, 0.0345, sample_image(width, height, 3)}};
    return s;
}

inline Trade sample_trade() {
    Trade t{{sample_scene("first", 12, 8), sample_scene("second", 9, 7)}};
    t.scenes[1].remark = "In float a sphere of this scene is 5 % off.";
    t.candidates = {{"--sampler sobol --light mis", false, 1.083, 1.311, "second"},
                    {"--sampler halton --light mis", true, 1.2, 2.5, "first"}};
    t.default_words = "--sampler sobol --light mis";
    t.command = "build/trade --quick";
    return t;
}

// ---- Reading a page -----------------------------------------------------------------------------

struct Element {
    std::string tag = "", words = "";  // words: of all that is in it
    std::map<std::string, std::string> attributes = {};
    size_t parent = SIZE_MAX;  // SIZE_MAX: none

    bool has(const std::string& name) const { return attributes.contains(name); }
    std::string of(const std::string& name) const { return has(name) ? attributes.at(name) : ""; }
};

// Letters for &amp; and its like.
inline std::string unescaped(std::string s) {
    constexpr const char* known[][2] = {
        {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&nbsp;", " "}, {"&amp;", "&"}};
    for (const auto& [from, to] : known)
        for (size_t at = 0; (at = s.find(from, at)) != s.npos; ++at)
            s.replace(at, std::string_view(from).size(), to);
    return s;
}

// A tag between < and >: its name and what is said of it, each in quotes.
inline Element parse_tag(const std::string& tag) {
    Element e;
    e.tag = tag.substr(0, tag.find_first_of(" /\n"));
    size_t at = e.tag.size();
    while ((at = tag.find_first_not_of(" /\n", at)) != tag.npos) {
        const size_t end = std::min(tag.find_first_of("= /\n", at), tag.size());
        const std::string name = tag.substr(at, end - at);
        REQUIRE_MESSAGE(!e.has(name), "twice " << name);
        at = end;
        e.attributes[name] = "";
        if (at == tag.size() || tag[at] != '=') continue;
        REQUIRE_MESSAGE(tag[at + 1] == '"', "no quotes around " << name);
        const size_t close = tag.find('"', at + 2);
        REQUIRE(close != tag.npos);
        e.attributes[name] = unescaped(tag.substr(at + 2, close - at - 2));
        at = close + 1;
    }
    return e;
}

// All elements in their order.  Fails where a tag is not closed, or closes another; where a quote
// or an ampersand is not escaped.
class Html {
public:
    std::vector<Element> elements;

    explicit Html(const std::string& page) {
        for (size_t at = 0; at < page.size();) {
            const size_t tag = std::min(page.find('<', at), page.size());
            words(page.substr(at, tag - at));
            if (tag == page.size()) break;
            size_t end = tag + 1;
            for (bool quoted = false; end < page.size() && (quoted || page[end] != '>'); ++end)
                if (page[end] == '"') quoted = !quoted;
            REQUIRE_MESSAGE(end < page.size(), "a tag that does not end");
            at = end + 1;
            const std::string inside = page.substr(tag + 1, end - tag - 1);
            if (inside[0] == '!') continue;
            if (inside[0] == '/') {
                close(inside.substr(1));
            } else if (const std::string raw = open(inside); !raw.empty()) {
                at = page.find("</" + raw, at);
                REQUIRE(at != page.npos);
            }
        }
        REQUIRE_MESSAGE(open_.empty(), "left open: " << elements[open_.back()].tag);
    }

    std::vector<Element> all(const std::string& tag) const {
        std::vector<Element> found;
        for (const Element& e : elements)
            if (e.tag == tag) found.push_back(e);
        return found;
    }
    const Element& by_id(const std::string& id) const {
        for (const Element& e : elements)
            if (e.of("id") == id) return e;
        FAIL("no element " << id);
        return elements[0];
    }
    // Is it inside such an element?
    bool within(const Element& e, const std::string& tag) const {
        for (size_t k = e.parent; k != SIZE_MAX; k = elements[k].parent)
            if (elements[k].tag == tag) return true;
        return false;
    }
    // Cells of all rows of the tables with this caption: words, row by row.
    std::vector<std::vector<std::string>> table(const std::string& caption) const {
        std::vector<std::vector<std::string>> rows;
        size_t last = SIZE_MAX;
        for (const Element& e : elements) {
            if (e.tag != "td" && e.tag != "th") continue;
            const size_t table = elements[elements[e.parent].parent].parent;
            if (caption_of(table) != caption) continue;
            if (e.parent != last) rows.emplace_back();
            last = e.parent;
            rows.back().push_back(e.words);
        }
        return rows;
    }

private:
    std::vector<size_t> open_;

    void words(const std::string& raw) {
        for (size_t at = 0; (at = raw.find('&', at)) != raw.npos; ++at)
            REQUIRE_MESSAGE(raw.find(';', at) < at + 7, "a bare & in " << raw);
        for (size_t k : open_) elements[k].words += unescaped(raw);
    }
    // The tag if what follows is no HTML.
    std::string open(const std::string& inside) {
        constexpr std::string_view empty = " meta link img input br ";
        Element e = parse_tag(inside);
        e.parent = open_.empty() ? SIZE_MAX : open_.back();
        elements.push_back(e);
        const bool closed = empty.find(" " + e.tag + " ") != empty.npos || inside.ends_with('/');
        if (!closed) open_.push_back(elements.size() - 1);
        return e.tag == "script" || e.tag == "style" ? e.tag : "";
    }
    void close(const std::string& tag) {
        REQUIRE_MESSAGE(!open_.empty(), "nothing to close: " << tag);
        REQUIRE(elements[open_.back()].tag == tag);
        open_.pop_back();
    }
    std::string caption_of(size_t table) const {
        for (const Element& e : elements)
            if (e.tag == "caption" && e.parent == table) return e.words;
        return "";
    }
};
