// labs/trade_words_test.cpp  numbers of a trade are written as one reads them
#include "labs/trade_words.h"

#include <doctest/doctest.h>

TEST_CASE("numbers have as many digits as count, and no exponent") {
    CHECK(told_number(0.01234, 3) == "0.0123");
    CHECK(told_number(1.234, 3) == "1.23");
    CHECK(told_number(123.4, 3) == "123");
    CHECK(told_number(12345, 3) == "12345");
    CHECK(told_number(0, 3) == "0.00");
    CHECK(told_number(-0.5, 2) == "-0.50");
    CHECK(told_number(NAN, 3) == "–");
    CHECK(told_number(INFINITY, 3) == "–");
}

TEST_CASE("seconds become minutes and hours when these are easier to read") {
    CHECK(told_seconds(0.03412) == "0.0341 s");
    CHECK(told_seconds(34.12) == "34.1 s");
    CHECK(told_seconds(341) == "341 s");
    CHECK(told_seconds(900) == "15 min");
    CHECK(told_seconds(9000) == "2.5 h");
    CHECK(told_seconds(360000) == "100 h");
    CHECK(told_seconds(NAN) == "–");
}

TEST_CASE("errors are percent, ratios are times") {
    CHECK(told_percent(0.1) == "10 %");
    CHECK(told_percent(0.003) == "0.3 %");
    CHECK(told_percent(0.12345) == "12.3 %");
    CHECK(told_percent(12.3456) == "1235 %");
    CHECK(told_percent(NAN) == "–");
    CHECK(told_ratio(1.3149) == "1.31×");
    CHECK(told_ratio(226.4) == "226×");
    CHECK(told_ratio(NAN) == "–");
}

TEST_CASE("a law, its spread, and what a setting is") {
    TradeSetting s{"--light nee"};
    CHECK(told_law(s) == "–");
    CHECK(told_spread(s) == "–");
    s.c = 0.0213, s.gamma = 0.513, s.spread = std::log(1.05);
    CHECK(told_law(s) == "2.13 % · t^−0.51");
    CHECK(told_spread(s) == "5 %");
    CHECK(told_kind(s) == "double, unbiased");
    s.gamma = -0.1, s.is_float = true, s.unbiased = false;
    CHECK(told_law(s) == "2.13 % · t^0.10");
    CHECK(told_kind(s) == "float, biased");
    CHECK(told_words("") == "no options");
}
