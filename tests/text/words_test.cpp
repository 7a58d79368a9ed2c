// text/words_test.cpp  numbers, sizes and words in the notation of users
#include "text/words.h"

#include <doctest/doctest.h>

#include "text/complaint.h"

namespace {

std::string about_number(const std::string& text) {
    return complaint([&] { parse_number(text); });
}

std::string about_size(const std::string& width, const std::string& height) {
    return complaint([&] { parse_size(width, height); });
}

}  // namespace

TEST_CASE("a number is the whole word, finite and within its limits") {
    CHECK(parse_number("-1.5e-3") == -0.0015);
    CHECK(parse_number("+2") == 2);
    CHECK(parse_number("-1e30") == -1e30);
    CHECK(parse_number(".5") == 0.5);
    CHECK(parse_number("5.") == 5);
    for (const char* word :
         {"", "x", "1x", "1 ", " 1", "\n1", "+-1", "++1", "0x10", "0X1p3", "1,5", "1e", ".", "nan"})
        CHECK(about_number(word) == in_quotes(word) + " is not a number");
    CHECK(about_number(std::string("1\0", 2)) == "'1?' is not a number");
    for (const char* word : {"1.1e30", "-1.1e30", "1e999", "-inf"})
        CHECK(about_number(word) == in_quotes(word) + " is too large");
}

TEST_CASE("a number is the nearest double, rounded to even from a tie") {
    CHECK(parse_number("0.1") == 0.1);
    CHECK(parse_number("9007199254740993") == 9007199254740992);  // a tie rounds to even
    CHECK(parse_number("9007199254740993.0000000000000000000001") == 9007199254740994);
    CHECK(parse_number("2.2250738585072012e-308") == 0x1p-1022);
    CHECK(parse_number("2e-324") == 0);
    CHECK(parse_number("3e-324") == 0x1p-1074);
}

TEST_CASE("a fraction is a number, or so many hundredths, and not negative") {
    CHECK(parse_fraction("0.25") == 0.25);
    CHECK(parse_fraction("2%") == 0.02);
    CHECK(parse_fraction("250%") == 2.5);
    CHECK(parse_fraction("0") == 0);
    CHECK(parse_fraction("1") == 1);
    CHECK_THROWS_AS(parse_fraction("1.01"), UserError);
    auto about = [](const std::string& text) { return complaint([&] { parse_fraction(text); }); };
    CHECK(about("-1e-9") == "'-1e-9' is negative");
    CHECK(about("-2%") == "'-2%' is negative");
    for (const char* word : {"", "%", "2%%", "2 %", "%2", "2%x"})
        CHECK(about(word).find("is not a number") != std::string::npos);
}

TEST_CASE("a count is a whole number from the least to the most") {
    CHECK(parse_count("3", 3, 5) == 3);
    CHECK(parse_count("5", 3, 5) == 5);
    CHECK(parse_count("18446744073709551615", 0, UINT64_MAX) == UINT64_MAX);
    for (const char* word : {"2", "6", "-3", "+3", "3.0", "3x", "", "18446744073709551619"})
        CHECK(complaint([&] {
                  parse_count(word, 3, 5);
              }).ends_with(" is not a whole number from 3 to 5"));
}

TEST_CASE("a size has 1 to 65536 pixels a side and at most 2^30 in all") {
    CHECK(parse_size("65536", "16384").width == 65536);
    CHECK(parse_size("16384", "65536").height == 65536);
    for (const auto& [width, height] : {std::pair{"65536", "65536"}, {"65536", "16385"}})
        CHECK(about_size(width, height).ends_with("has more than 1073741824 pixels"));
    CHECK(about_size("0", "1") == "'0' is not a whole number from 1 to 65536");
    CHECK(about_size("1", "65537") == "'65537' is not a whole number from 1 to 65536");
}

TEST_CASE("the words of a line end at white space of any kind and at a comment") {
    CHECK(words_before("a bc  d", '#') == Words{"a", "bc", "d"});
    CHECK(words_before(" \t\v\f\r a\tb\r", '#') == Words{"a", "b"});
    CHECK(words_before("a b#c d", '#') == Words{"a", "b"});
    CHECK(words_before("#a", '#') == Words{});
    CHECK(words_before("", '#') == Words{});
    CHECK(words_before("a \"b # c\" \"\"d\"e\" #\"", '#') == Words{"a", "b # c", "", "d\"e\""});
    CHECK(complaint([] { words_before("a \"b", '#'); }) == "a quote that does not end");
    CHECK(words_before(std::string("a\0b c", 5), '#') == Words{std::string("a\0b", 3), "c"});
}

TEST_CASE("the nearest word is the one with the fewest edits") {
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("abc", "abc") == 0);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("sitting", "kitten") == 3);
    CHECK(edit_distance("spere", "sphere") == 1);
    CHECK(unknown("keyword", "qaud", {"size", "quad", "sphere"}) ==
          "unknown keyword 'qaud' (did you mean 'quad'?)");
}

TEST_CASE("only a near word is meant") {
    using Known = std::vector<std::string_view>;
    const Known options = {"-o", "--spp", "--sampler", "--heatmap", "--help"};
    auto meant = [](const std::string& word) { return " (did you mean '" + word + "'?)"; };
    auto hint = [](const std::string& word, const Known& known) {
        return unknown("", word, known).substr(unknown("", word, {}).size());
    };
    CHECK(hint("Mis", {"none", "nee", "mis"}) == meant("mis"));
    CHECK(hint("gray", {"red", "grey"}) == meant("grey"));
    CHECK(hint("abcd", {"abxy"}) == meant("abxy"));  // half of the letters match
    CHECK(hint("abcd", {"axyz"}) == "");
    CHECK(hint("-O", options) == meant("-o"));
    CHECK(hint("x", options) == "");
    CHECK(hint("-spp", options) == meant("--spp"));
    CHECK(hint("--heat", options) == meant("--heatmap"));  // not --help: two edits
    CHECK(hint("", {"a", "none"}) == "");
    CHECK(hint("nea", {"nee", "neo"}) == meant("nee"));  // the first of equals
    CHECK(hint("a", {}) == "");
    CHECK(hint(std::string(1 << 20, 'x'), {"x"}) == "");
    CHECK(hint("a\n", {"a\n\n"}) == meant("a??"));
}

TEST_CASE("a name is looked up, or told with its neighbour") {
    const std::map<std::string, int> defined = {{"grey", 1}, {"red", 2}};
    CHECK(look_up(defined, "red", "colour") == 2);
    CHECK(complaint([&] { look_up(defined, "Grey", "colour"); }) ==
          "unknown colour 'Grey' (did you mean 'grey'?)");
}

TEST_CASE("a message keeps its letters, and loses what would move the cursor") {
    CHECK(printable("a \xc3\xa9 ~") == "a \xc3\xa9 ~");
    CHECK(printable("\x1b[2J\n\x7f\t") == "?[2J???");
    CHECK(printable("\xc2\x9b"
                    "2J \xc2\xa0") == "\xc2?2J \xc2\xa0");  // CSI; no-break space
}

TEST_CASE("what the user wrote is shown short and printable") {
    CHECK(in_quotes("a b~") == "'a b~'");
    CHECK(in_quotes("a\x7f\n\x1b\xc3") == std::string("'a").append(4, '?') + "'");
    CHECK(in_quotes(std::string(41, 'x')) == "'" + std::string(40, 'x') + "...'");
}
