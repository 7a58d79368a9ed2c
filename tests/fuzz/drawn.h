// fuzz/drawn.h  converts bytes to a well-formed scene and to compatible options
#pragma once
#include <cmath>
#include <vector>

#include "base/vec.h"
#include "fuzz/input.h"

namespace penumbra::fuzz {

// A scene, and the options to render it.
struct Drawn {
    std::string scene;
    std::vector<std::string> options;
    bool moderate = true;  // no extreme numbers: samples must not overflow
};

// ---- Options ------------------------------------------------------------------------------------

// Options with few samples and one thread; some combinations are invalid and get refused.
inline std::vector<std::string> drawn_options(Choices& c) {
    std::vector<std::string> words = {"--quiet", "--threads", "1"};
    auto say = [&](const std::string& name, const std::string& value) {
        words.push_back(name), words.push_back(value);
    };
    say("--size", c.of({"8x4", "1x1", "5x3", "1x9"}));
    say("--spp", c.of({"4", "6", "1", "2"}));
    say("--depth", c.of({"3", "0", "1", "8"}));
    say("--light", c.of({"mis", "nee", "none"}));
    say("--sampler", c.of({"sobol", "independent", "stratified", "halton"}));
    say("--direction", c.of({"bsdf", "uniform"}));
    say("--roulette", c.of({"0.25", "0", "1", "1e-9"}));
    say("--seed", std::to_string(c.byte()));
    if (c.rarely()) say("--view", c.of({"normal", "depth", "albedo", "bvh"}));
    if (c.rarely()) say("--replications", c.of({"2", "3", "1", "adaptive"}));
    if (c.rarely()) say("--rows", "0-0"), say("-o", "a.pfm");
    return words;
}

// ---- Scenes -------------------------------------------------------------------------------------

class SceneWriter {
public:
    SceneWriter(Choices& choices, bool moderate) : c_(choices), moderate_(moderate) {}

    std::string text() {
        camera();
        do material();
        while (materials_ < 6 && c_.below(3) != 0);
        do content();
        while (shapes_++ < 40 && !c_.empty());
        return text_;
    }

private:
    Choices& c_;
    const bool moderate_;
    std::string text_;
    unsigned materials_ = 0, shapes_ = 0;

    void word(const std::string& w) {
        text_ += (text_.empty() || text_.back() == '\n' ? "" : " ") + w;
    }
    void word(double x) {
        char digits[40];
        std::snprintf(digits, sizeof digits, "%.9g", x);
        word(std::string(digits));
    }
    void end() { text_ += '\n'; }

    // Numbers on a grid, so that many coincide, or of any size.
    double power() {
        const int most = sizeof(real) == 4 ? 9 : 30;
        return std::pow(10, int(c_.byte()) % (2 * most + 1) - most);
    }
    double number() {
        if (!moderate_ && c_.rarely()) return power() * (c_.below(2) ? 1 : -1);
        return (double(c_.byte()) - 128) / 16;
    }
    double length() {
        if (!moderate_ && c_.rarely()) return power();
        return (1 + double(c_.byte())) / 16;
    }
    void point() {
        for (int k = 0; k < 3; ++k) word(number());
    }
    void colour(double most) {
        for (int k = 0; k < 3; ++k) word(most * c_.below(8) / 7);
    }
    void radiance() {
        for (int k = 0; k < 3; ++k) word(!moderate_ && c_.rarely() ? power() : double(c_.below(8)));
    }

    void camera() {
        word("camera");
        point(), point();
        word(1 + c_.below(178));
        end();
    }

    void material() {
        const std::string keyword = c_.of({"diffuse", "light", "phong", "mirror", "glass"});
        word(keyword), word("m" + std::to_string(materials_));
        if (keyword == "diffuse" || keyword == "mirror") colour(1);
        if (keyword == "phong")
            colour(0.5), colour(0.5), word(c_.of({"10", "0", "1", "1e6", "0.5"}));
        if (keyword == "glass") word(c_.of({"1.5", "1", "0.5", "1e-3", "1e3"}));
        if (keyword == "light") {
            radiance();
            if (c_.below(2)) word("twosided");
            if (materials_ > 0 && c_.below(2)) any_material();
        }
        ++materials_;
        end();
    }
    void any_material() { word("m" + std::to_string(c_.below(materials_))); }

    void content() {
        const std::string keyword = c_.of({"sphere", "quad", "triangle", "box", "pointlight"});
        word(keyword);
        if (keyword == "sphere") point(), word(length());
        if (keyword == "triangle" || keyword == "quad") point(), point(), point();
        if (keyword == "pointlight") point(), radiance();
        if (keyword == "box") {
            for (int k = 0; k < 3; ++k) word(length());
            word(number() * 15);
            point();
        }
        if (keyword != "pointlight") any_material();
        end();
    }
};

inline Drawn drawn(std::string_view bytes) {
    Choices c(bytes);
    Drawn d;
    d.moderate = !c.rarely();
    d.options = drawn_options(c);
    d.scene = SceneWriter(c, d.moderate).text();
    return d;
}

// A room with one-sided and two-sided lamps in random order.  They lie in its surfaces, in each
// other, or twice in one place.
inline std::string drawn_lamps(Choices& c) {
    std::string text =
        "camera 0 1 3.9  0 1 0  90\ndepth 2\ndiffuse d .5 .5 .5\nlight l 1 1 1\n"
        "light m 1 .5 2 twosided\nlight n .5 1 .5 twosided d\n"
        "quad -4 0 -4  0 0 8  8 0 0  d\nquad -4 4 -4  8 0 0  0 0 8  d\n";
    auto half = [&](int from, unsigned steps) {
        char word[20];
        std::snprintf(word, sizeof word, " %g", from + c.below(steps) / 2.0);
        return std::string(word);
    };
    for (unsigned k = 0; k < 6 && !c.empty(); ++k) {
        const std::string what = c.of({"quad", "triangle", "sphere"}),
                          material = c.of({"l", "m", "n", "d"});
        text += what;
        if (what == "sphere") {
            text += c.of({" 1 2 0  .5", " 1 2 0  1", " -2 1 -1  1"});
        } else {
            const std::string y = c.of({" 4", " 0", " 2"}), x = half(-3, 8), z = half(-3, 8);
            const std::string u = half(1, 5), v = half(1, 5);
            const bool turned = c.below(2) != 0;
            if (what == "quad")
                text += x + y + z +
                        (turned ? " " + u + " 0 0  0 0" + v : "  0 0" + v + " " + u + " 0 0");
            else
                text += x + y + z + (turned ? "  3" : "  -3") + y + " 3 " + u + y + " -3.5";
        }
        text += "  " + material + "\n";
    }
    return text + "quad 2 3 -3  1 0 0  0 0 1  l\n";
}

}  // namespace penumbra::fuzz
