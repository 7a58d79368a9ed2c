// oracle/mistakes_test.cpp  the oracle refuses classic mistakes, and names them
#include <doctest/doctest.h>

#include "oracle/mistakes_held_out.h"
#include "oracle/mistakes_of_light.h"

namespace {

// Every mistake is refused; nine of ten first lines name it, and none names another cause.
void all_named(const mistakes::Mistakes& catalogue, const std::string& seed) {
    const std::string folder = std::exchange(oracle::pictures, "");
    int planted = 0, named = 0;
    for (const auto& m : catalogue) {
        oracle::Random random(oracle::seed_of(seed + m.name));
        const oracle::Verdict v = m.run(random);
        CAPTURE(m.name);
        INFO(mistakes::first_line(v.text));
        CHECK(v.pass == m.expected.empty());
        if (m.expected.empty() || v.pass) continue;
        const mistakes::Naming naming = mistakes::naming(m, v);
        CHECK(naming != mistakes::Naming::wrong);
        ++planted;
        if (naming == mistakes::Naming::right)
            ++named;
        else
            MESSAGE("not named: " << m.name << ": " << mistakes::first_line(v.text));
    }
    oracle::pictures = folder;
    MESSAGE(named << " of " << planted << " named");
    CHECK(named >= 0.9 * planted);
}

}  // namespace

// The second catalogue was written by somebody who had not seen the hints: 36 of its 46 mistakes
// were named, and 2 wrongly, before hints were mended for it, too.
TEST_CASE("oracle: classic mistakes are refused and named") {
    mistakes::Mistakes both = mistakes::all();
    for (const auto& m : mistakes::held_out()) both.push_back(m);
    all_named(both, "");
}

TEST_CASE("oracle: how a hint is read") {
    using mistakes::says, mistakes::hint_of;
    const struct {
        const char *text, *word;
        bool said;
    } rows[] = {{"is it a factor of 2?", "2", true},
                {"samples 2.5 times", "2", false},
                {"samples 0.2 times", "2", false},
                {"the density lacks 1/pi.", "pi", true},
                {"is it 2 pi?", "pi", false},
                {"is it 2 pi?", "2 pi", true},
                {"a spin", "pi", false},
                {"Negative at (0, 0, -1)", "negative", true}};
    for (const auto& r : rows) {
        CAPTURE(r.text);
        CHECK(says(r.text, r.word) == r.said);
    }
    CHECK(hint_of("off by 3").empty());
    CHECK(hint_of("off by 3: is it a sign?") == "is it a sign?");
}
