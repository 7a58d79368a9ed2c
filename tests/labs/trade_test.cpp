// labs/trade_test.cpp  laws, answers, tournaments, and the file of a trade
#include "labs/trade_law.h"

#include <doctest/doctest.h>

#include "labs/trade_file.h"

namespace {

// error = c seconds^-gamma at 4, 16, ... samples, a second each `per`; `off` by turns above and
// below the law.
TradeSetting by_law(const std::string& words, double c, double gamma, double off = 0) {
    TradeSetting s{words};
    double sign = 1;
    for (double spp : {4.0, 16.0, 64.0, 256.0, 1024.0}) {
        s.points.push_back(
            {spp, spp / 100, c * std::pow(spp / 100, -gamma) * std::exp(sign * off), 0.01});
        sign = -sign;
    }
    fit(s);
    return s;
}

TradeScene scene_of(const std::vector<TradeSetting>& settings) {
    TradeScene s{"room"};
    s.settings = settings;
    return s;
}

Entrant entrant(double efficiency, bool candidate, double log_error = 0, double cost = 1) {
    Entrant e;
    e.candidate = candidate, e.efficiency = {efficiency, log_error}, e.next_cost = cost;
    return e;
}

std::string alive(const std::vector<Entrant>& all) {
    std::string who;
    for (const Entrant& e : all) who += e.alive ? '1' : '0';
    return who;
}

}  // namespace

// ---- Laws ---------------------------------------------------------------------------------------

TEST_CASE("a law is found again, and the spread of the points about it") {
    const TradeSetting exact = by_law("a", 0.02, 0.7);
    CHECK(exact.c == doctest::Approx(0.02));
    CHECK(exact.gamma == doctest::Approx(0.7));
    CHECK(exact.spread < 1e-12);
    // Deviations d, -d, d, -d, d have the mean d / 5 and no slope; the rest is (1 - 1/25) d^2.
    const double d = 0.1;
    const TradeSetting off = by_law("a", 0.02, 0.7, d);
    CHECK(off.gamma == doctest::Approx(0.7));
    CHECK(off.c == doctest::Approx(0.02 * std::exp(d / 5)));
    CHECK(off.spread == doctest::Approx(d * std::sqrt(1 - 1 / 25.0)));
}

TEST_CASE("points without an error are left out of the law; one point has none") {
    TradeSetting s = by_law("a", 0.02, 0.5);
    s.points[2].error = NAN;
    s.points[4].error = 0;
    fit(s);
    CHECK(s.gamma == doctest::Approx(0.5));
    s.points.resize(1);
    fit(s);
    CHECK(std::isnan(s.gamma));
    CHECK(std::isnan(s.c));
}

TEST_CASE("seconds for an error: by the law, and no farther than it is believed") {
    const TradeSetting s = by_law("a", 0.02, 0.5);  // the last point: 10.24 s
    CHECK(seconds_for(s, 0.01) == doctest::Approx(4));
    const double least = 0.02 / std::sqrt(law_reach * 10.24);
    CHECK(seconds_for(s, 1.01 * least) == doctest::Approx(law_reach * 10.24 / 1.0201));
    CHECK(std::isnan(seconds_for(s, 0.99 * least)));
    CHECK(seconds_for(s, 5) == doctest::Approx(0.01));  // one sample a pixel
    CHECK(std::isnan(seconds_for(TradeSetting{"none"}, 0.1)));
}

TEST_CASE("seconds of what is biased or rounds: between its points, and nothing beyond") {
    TradeSetting s{"b"};
    s.unbiased = false;
    s.points = {{4, 1, 0.08}, {16, 4, 0.04}, {64, 16, 0.03}, {256, 64, 0.029}};
    fit(s);
    CHECK(seconds_for(s, 0.04) == doctest::Approx(4));
    CHECK(seconds_for(s, 0.08 / std::sqrt(2.0)) == doctest::Approx(2));
    CHECK(seconds_for(s, 0.16) == doctest::Approx(0.25));
    CHECK(std::isnan(seconds_for(s, 0.028)));
    TradeSetting rounds = by_law("c", 0.02, 0.5);
    CHECK(!std::isnan(seconds_for(rounds, 0.003)));
    rounds.is_float = true;
    CHECK(std::isnan(seconds_for(rounds, 0.003)));
}

// ---- Answers ------------------------------------------------------------------------------------

TEST_CASE("answers from known laws: who is cheapest changes where laws cross") {
    // They cross at 1 s and 2 %; the default is never the cheapest.
    const TradeScene s = scene_of(
        {by_law("default", 0.06, 0.6), by_law("steep", 0.02, 1), by_law("flat", 0.02, 0.5)});
    const std::vector<TradeAnswer> answers = answers_of(s, "default");
    REQUIRE(answers.size() == 4);
    const size_t flat = 2, steep = 1;
    CHECK(answers[0].setting == flat);
    CHECK(answers[0].seconds == doctest::Approx(0.04));
    CHECK(answers[1].setting == flat);
    CHECK(answers[2].setting == steep);
    CHECK(answers[2].seconds == doctest::Approx(2));
    CHECK(answers[3].setting == steep);
    CHECK(answers[3].seconds == doctest::Approx(0.02 / 0.003));
    for (const TradeAnswer& a : answers)
        CHECK(a.default_seconds == doctest::Approx(std::pow(0.06 / a.E, 1 / 0.6)));
}

TEST_CASE("an answer that nothing reaches has no setting") {
    const TradeScene s = scene_of({by_law("default", 10, 0.5)});
    const TradeAnswer last = answers_of(s, "default").back();
    CHECK(last.setting == SIZE_MAX);
    CHECK(std::isnan(last.seconds));
    CHECK(std::isnan(last.default_seconds));
}

TEST_CASE("the one default: the least mean ratio to the best candidate, and where it is worst") {
    // "even" takes 4 times the seconds of "sharp" in the first scene, and a quarter in the second,
    // where "sharp" also finds "biased" 100 times cheaper: no candidate.
    auto all = [](double even, double sharp) {
        std::vector<TradeSetting> settings = {
            by_law("even", even, 0.5), by_law("sharp", sharp, 0.5), by_law("steady", 0.05, 0.5),
            by_law("biased", 0.005, 0.5)};
        settings[3].unbiased = false;
        return scene_of(settings);
    };
    std::vector<TradeScene> scenes = {all(0.04, 0.02), all(0.02, 0.04), all(0.02, 0.08)};
    scenes[2].name = "hall";
    const std::vector<TradeCandidate> c = candidates_of(scenes);
    REQUIRE(c.size() == 3);
    CHECK(c[0].words == "even");
    CHECK(c[0].mean_ratio == doctest::Approx(std::pow(4, 1.0 / 3)));
    CHECK(c[0].worst_ratio == doctest::Approx(4));
    CHECK(c[0].worst_scene == "room");
    CHECK(c[1].words == "sharp");
    CHECK(c[1].mean_ratio == doctest::Approx(4));
    CHECK(c[1].worst_scene == "hall");
    CHECK(c[2].words == "steady");
}

TEST_CASE("float beside double: at the last count that both have") {
    TradeSetting d = by_law("a", 0.02, 0.5), f = d;
    f.is_float = true;
    for (TradePoint& p : f.points) p.seconds *= 0.8, p.error *= 1.5;
    f.points.pop_back();
    d.points.back().seconds = 1e6;  // does not count
    const FloatBesideDouble beside = float_beside_double(scene_of({d, f}));
    CHECK(beside.settings == 1);
    CHECK(beside.time == doctest::Approx(0.8));
    CHECK(beside.error == doctest::Approx(1.5));
}

// ---- The tournament -----------------------------------------------------------------------------

TEST_CASE("who is hopeless goes: by more than a factor of 8 and its standard error") {
    std::vector<Entrant> all = {entrant(80, true), entrant(10.1, true), entrant(9.9, true),
                                entrant(9, true, 0.2), entrant(9, true, 0.1)};
    drop_hopeless(all, 16);
    CHECK(alive(all) == "11010");
    CHECK(all[2].dropped == "after 16 samples: 1/8 of the best's efficiency");
    CHECK(all[0].dropped.empty());
}

TEST_CASE("candidates are compared with candidates, others with all; the best of either stays") {
    std::vector<Entrant> all = {entrant(1, true), entrant(0.5, true), entrant(1000, false),
                                entrant(1, false), entrant(200, false)};
    all.push_back(entrant(0, false, INFINITY));  // its error is too small to be told
    all.push_back(entrant(0.001, false));
    all.back().kept = true;
    drop_hopeless(all, 64);
    CHECK(alive(all) == "1110111");
}

TEST_CASE("a budget drops the least efficient of their class, and neither class's best") {
    std::vector<Entrant> all = {entrant(1, true), entrant(0.9, true), entrant(1000, false),
                                entrant(300, false), entrant(0.5, true)};
    drop_for_budget(all, 64, 5);
    CHECK(alive(all) == "11111");
    drop_for_budget(all, 64, 3.5);
    CHECK(alive(all) == "11100");
    drop_for_budget(all, 64, 0);
    CHECK(alive(all) == "10100");
    CHECK(all[1].dropped.starts_with("after 64 samples, for want of time"));
}

TEST_CASE("efficiency is 1 / (error^2 seconds), and its logarithm's error twice the error's") {
    const Efficiency e = efficiency_of({16, 2, 0.1, 0.005});
    CHECK(e.value == doctest::Approx(50));
    CHECK(e.log_error == doctest::Approx(0.1));
    CHECK(efficiency_of({16, 2, NAN, NAN}).value == 0);
}

// ---- The file -----------------------------------------------------------------------------------

namespace {

Trade small_trade() {
    Trade t;
    t.default_words = "--sampler sobol --light mis", t.command = "build/trade";
    TradeScene s =
        scene_of({by_law("--sampler sobol --light mis", 0.02, 1 / 3.0), {"--sampler halton"}});
    s.remark = "some words, 5 %", s.width = 2, s.height = 1, s.exposure = 0.1;
    s.settings[0].dropped = "after 16 samples: why", s.settings[0].takes_every_scene = false;
    s.settings[1].is_float = true, s.settings[1].unbiased = false;
    s.settings[0].points[1].error = NAN;
    s.reference_error = 1e-3 / 3;
    s.answers = {{0.1, 0, 1 / 3.0, 2}, {0.003}};
    s.pictures = {{"--light nee", true, 0.7, 0.01, Image(2, 1)}};
    s.pictures[0].image.pixels = {{1, 2, 3}, {0.1f, 1e-30f, 7}};
    s.reference = s.pictures[0].image;
    t.scenes = {s, TradeScene{"empty"}};
    t.candidates = {{"--light mis", false, 1.1, 1 / 7.0, "room"}};
    return t;
}

}  // namespace

TEST_CASE("the file of a trade: what is read is what was written, to the last digit") {
    const Trade before = small_trade(), after = trade_file::decode(trade_file::encode(before));
    CHECK(trade_file::encode(after) == trade_file::encode(before));
    REQUIRE(after.scenes.size() == 2);
    const TradeScene &a = after.scenes[0], &b = before.scenes[0];
    CHECK(a.name == "room");
    CHECK(a.remark == b.remark);
    CHECK(a.width == 2);
    CHECK(a.height == 1);
    CHECK(a.exposure == b.exposure);
    CHECK(a.reference_error == b.reference_error);
    REQUIRE(a.settings.size() == 2);
    CHECK(a.settings[0].c == b.settings[0].c);
    CHECK(a.settings[0].gamma == b.settings[0].gamma);
    CHECK(a.settings[0].spread == b.settings[0].spread);
    CHECK(a.settings[0].dropped == "after 16 samples: why");
    CHECK(!a.settings[0].is_float);
    CHECK(a.settings[0].unbiased);
    CHECK(!a.settings[0].takes_every_scene);
    CHECK(a.settings[1].is_float);
    CHECK(!a.settings[1].unbiased);
    CHECK(std::isnan(a.settings[1].c));
    REQUIRE(a.settings[0].points.size() == 5);
    CHECK(std::isnan(a.settings[0].points[1].error));
    CHECK(a.settings[0].points[4].seconds == b.settings[0].points[4].seconds);
    CHECK(a.answers[0].default_seconds == 2);
    CHECK(a.answers[1].setting == SIZE_MAX);
    CHECK(a.pictures[0].is_float);
    CHECK(a.pictures[0].error == 0.01);
    CHECK(after.candidates[0].worst_ratio == 1 / 7.0);
    CHECK(after.candidates[0].worst_scene == "room");
    CHECK(after.command == "build/trade");
}

TEST_CASE("a file of a trade that ends within a row, or starts with a point, is refused") {
    CHECK_THROWS_AS(trade_file::decode("scene\tname\tremark\t2"), UserError);
    CHECK_THROWS_AS(trade_file::decode("point\t1\t1\t1\t1"), UserError);
    CHECK_THROWS_AS(trade_file::decode("scene\tn\t\t2\t2\t1\t1\npoint\t1\t1\t1\t1"), UserError);
}

TEST_CASE("a trade's images come back from its folder, pixel by pixel") {
    const std::string folder = "out/trade-test" + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    const Trade before = small_trade();
    write_trade(before, folder);
    const Trade after = read_trade(folder);
    std::filesystem::remove_all(folder);
    CHECK(after.scenes[0].reference.pixels == before.scenes[0].reference.pixels);
    CHECK(after.scenes[0].pictures[0].image.pixels == before.scenes[0].pictures[0].image.pixels);
    CHECK(after.scenes[1].reference.pixels.empty());
}
