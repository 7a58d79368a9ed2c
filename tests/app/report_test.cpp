// app/report_test.cpp  progress, the error in words, JSON
#include "app/report.h"

#include <doctest/doctest.h>

#include "text/folder.h"

namespace {

Run run_of(double d_rel, double standard_error) {
    Run run;
    run.spp = 64, run.seconds = 8, run.rays = 16000000, run.replications = 2.5;
    run.error.pixels = 1;
    run.error.variances.fill(std::pow(2 * d_rel, 2));
    const double d2 = run.error.d2();
    run.error.squares = 3 * (4 + d2);
    const double spread = d_rel > 0 ? standard_error * 2 * d2 / d_rel / (1 + d_rel * d_rel) : 0;
    run.error.terms2 = spread * spread;
    run.stopped_by = Stop::samples;
    return run;
}

std::string json_of(const Run& run, Size size) {
    json::Object object;
    add_run(object, run, size);
    return object.text();
}

// Returns the output to stderr during the work.
template <class Work>
std::string told(Work work) {
    const Folder folder;
    const std::string path = folder / "err";
    std::fflush(stderr);
    const int before = ::dup(STDERR_FILENO), file = ::open(path.c_str(), O_CREAT | O_WRONLY, 0600);
    ::dup2(file, STDERR_FILENO);
    work();
    std::fflush(stderr);
    ::dup2(before, STDERR_FILENO);
    ::close(before), ::close(file);
    return read_file(path);
}

}  // namespace

TEST_CASE("JSON: every digit of a number, every letter of a name") {
    CHECK(std::strtod(json::number(0.1 + 0.2).c_str(), nullptr) == 0.1 + 0.2);
    CHECK(json::number(NAN) == "null");
    CHECK(json::number(-INFINITY) == "null");
    CHECK(json::numbers({1, 2, NAN}) == "[1, 2, null]");
    CHECK(json::string("a\"b\\c\x01\n") == R"("a\"b\\c\u0001\u000a")");
    CHECK(json::string("\xc3\xa9") == "\"\xc3\xa9\"");
    // The first and last characters of two, three and four bytes are valid.  Cut, overlong and
    // surrogate sequences, those beyond the last and those without a first byte are not.
    for (const std::string good :
         {"\x7f", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80",
          "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
        CHECK(json::string("a" + good + "b") == "\"a" + good + "b\"");
    for (const std::string bad : {"\x80", "\xbf", "\xff", "\xc3", "\xe2\x82", "\xf0\x9f\x98",
                                  "\xc1\xbf", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf", "\xed\xa0\x80",
                                  "\xed\xbf\xbf", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80"}) {
        std::string each;
        for (size_t i = 0; i < bad.size(); ++i) each += "\\ufffd";
        CHECK(json::string(bad) == "\"" + each + "\"");
        CHECK(json::string("a" + bad + "\xc3\xa9") == "\"a" + each + "\xc3\xa9\"");
    }
    CHECK(json::truth(true) == "true");
    CHECK(json::truth(false) == "false");
    json::Object object;
    object.add("a", "1");
    object.add("b", "2");
    CHECK(object.text() == "{\n  \"a\": 1,\n  \"b\": 2\n}\n");
}

TEST_CASE("numbers for people") {
    CHECK(fixed(1.25, 1) == "1.2");
    CHECK(fixed(-2, 3) == "-2.000");
    CHECK(significant(0.0234, 1) == "0.02");
    CHECK(significant(234, 1) == "234");
    CHECK(significant(234, 2) == "234");
    CHECK(significant(3.14159, 3) == "3.14");
    CHECK(significant(64, 3) == "64");
}

TEST_CASE("an image's error in words: its standard error, and the time for half of it") {
    const std::string some = "estimated error 2.1 % ± 0.1 %; about ";
    CHECK(error_words(run_of(0.021, 0.0011)) == some + "27 s more for 1 %");
    Run run = run_of(0.021, 0.0011);
    CHECK(error_words(run, 0.007) == some + "64 s more for 0.7 %");
    CHECK(error_words(run, 0.03) == some + "27 s more for 1 %");
    auto words = [](double d_rel, double standard_error) {
        return error_words(run_of(d_rel, standard_error));
    };
    CHECK(words(0.2, 0.11) == "estimated error 20 % ± 11 %; about 24 s more for 10 %");
    CHECK(words(1.25, 0.4) == "estimated error 125 % ± 40 %; about 27 s more for 60 %");
    CHECK(words(0.00032, 0.00001) ==
          "estimated error 0.032 % ± 0.001 %; about 12 s more for 0.02 %");
    run = run_of(0.02, 0.001), run.seconds = 1000;
    CHECK(error_words(run) == "estimated error 2 % ± 0.1 %; about 3000 s more for 1 %");
    CHECK(words(0, 0) == "estimated error 0 % ± 0 %");
    run = run_of(0.02, 0.001), run.bias = "consistent";
    CHECK(error_words(run) ==
          "error 2 % ± 0.1 % (noise only; the estimator is consistent); about 24 s more for 1 %");
}

TEST_CASE("where no error is reported, the reason is") {
    auto why = [](double spp, double K, bool early) {
        Run run;
        run.spp = spp, run.replications = K;
        run.stopped_by = early ? Stop::interrupt : Stop::time;
        return error_words(run);
    };
    CHECK(why(1, 1, false) == "error not known: one sample");
    CHECK(why(64, 1, false) == "error not known: one replication");
    CHECK(why(64, 1, true) == "error not known: interrupted early");
    CHECK(why(64, 2.5, true) == "error not known: interrupted early");
    CHECK(why(64, 2.5, false) == "error not known: too little time");
    Run run = run_of(0.02, 0.001);
    run.doubt = "a few pixels dominate it";
    CHECK(error_words(run) == "error not known: a few pixels dominate it");
    run.error.squares = 0, run.doubt = "no sample found light";
    CHECK(error_words(run) == "error not known: no sample found light");
    run.spp = 1;
    CHECK(error_words(run) == "error not known: one sample");
    run = run_of(0.02, 0.001), run.spp = 2;
    CHECK(error_words(run).starts_with("estimated error 2 %"));  // two replications of one sample
}

TEST_CASE("the line that stays: the error, whether it was reached, interrupts") {
    Run run = run_of(0.02, 0.001);
    run.spp = 70.25;
    const std::string line = "a.scene: 70.2 samples per pixel, 8.00 s, 2.00 Mrays/s",
                      error = "estimated error 2 % ± 0.1 %; about ";
    CHECK(summary("a.scene", run) == line + ", " + error + "24 s more for 1 %");
    run.stopped_by = Stop::error;
    CHECK(summary("a.scene", run, 0.03) == line + ", reached 3 % (" + error + "24 s more for 1 %)");
    for (const auto& [by, option] : {std::pair{Stop::samples, "--spp"}, {Stop::time, "--time"}}) {
        run.stopped_by = by;
        CHECK(summary("a.scene", run, 0.015) == line + ", did not reach 1.5 % (stopped by " +
                                                    option + "; " + error +
                                                    "6.2 s more for 1.5 %)");
    }
    run.stopped_by = Stop::interrupt;
    CHECK(summary("a.scene", run, 0.01) == line + ", " + error + "24 s more for 1 % (interrupted)");
    run.is_radiance = false;
    CHECK(summary("a.scene", run) == line + " (interrupted)");
    run.stopped_by = Stop::samples, run.spp = 1;
    CHECK(summary("a.scene", run) == "a.scene: 1 sample per pixel, 8.00 s, 2.00 Mrays/s");
    run = run_of(0.02, 0.001);
    run.doubt = "no sample found light", run.stopped_by = Stop::error_unknown;
    CHECK(summary("a.scene", run, 0.01)
              .ends_with(", did not reach 1 % (error not known: no sample found light)"));
    run = Run();
    run.seconds = 8, run.stopped_by = Stop::interrupt;
    CHECK(summary("a.scene", run) ==
          "a.scene: interrupted before the first pass was complete: no image written");
}

TEST_CASE("what ended a run, in JSON") {
    for (const auto& [stop, word] : {std::pair{Stop::samples, "samples"},
                                     {Stop::time, "time"},
                                     {Stop::error, "error"},
                                     {Stop::error_unknown, "error not known"},
                                     {Stop::interrupt, "interrupt"},
                                     {Stop::no, "merge"}}) {
        Run run;
        run.stopped_by = stop;
        const std::string text = json_of(run, {1, 1});
        CHECK(text.find("\"stopped_by\": \"" + std::string(word) + "\"") != text.npos);
        const bool is_interrupt = stop == Stop::interrupt;
        CHECK(text.find("\"interrupted\": " + json::truth(is_interrupt)) != text.npos);
    }
}

TEST_CASE("the statistics of a run, all keys in their order, null where nothing is known") {
    Run run;
    run.spp = 64.5, run.seconds = 2, run.cpu_seconds = 3.5, run.rays = 4000000;
    run.replications = 2.75, run.repeat_spp = 48;
    run.error = {2, {4, 6, 8}, {8, 16, 24}, 96, 16};  // two pixels: |f|^2 = 16, |F|^2 = 8
    run.bias = "consistent", run.stopped_by = Stop::time;
    std::string text = json_of(run, {2, 1});
    const size_t peak = text.find("  \"peak_memory_bytes\": ");
    REQUIRE(peak != text.npos);
    const double bytes = std::strtod(text.c_str() + peak + 23, nullptr);
    text.resize(peak);
    CHECK(text == std::string("{\n  \"precision\": ") +
                      (sizeof(real) == 4 ? "\"float\"" : "\"double\"") +
                      ",\n  \"interrupted\": false,\n  \"samples_per_pixel\": 64.5,\n"
                      "  \"repeat_with_spp\": 48,\n  \"seconds\": 2,\n  \"cpu_seconds\": 3.5,\n  "
                      "\"rays\": 4000000,\n"
                      "  \"mrays_per_second\": 2,\n  \"mean_radiance\": [2, 3, 4],\n"
                      "  \"variance_of_mean\": [2, 4, 6],\n  \"replications_per_pixel\": 2.75,\n"
                      "  \"d_rel\": 1,\n  \"d_rel_standard_error\": 0.25,\n"
                      "  \"d_rel_by_spread\": 1,\n  \"d_rel_reason\": null,\n"
                      "  \"seconds_to_half_d_rel\": " +
                      json::number(8) +
                      ",\n  \"bias\": \"consistent\",\n  \"stopped_by\": \"time\",\n");
    // The memory of this process exceeds a megabyte; its unit is the byte.
    CHECK(bytes > 2e6);
    const std::vector<char> more(size_t(bytes) + (64 << 20), 1);
    const double grown = double(peak_memory_bytes()) - bytes;
    CHECK(more[more.size() / 2] == 1);
    CHECK(grown > 60 << 20);
    CHECK(grown < 1.01 * bytes + (70 << 20));
    run.is_radiance = false;
    CHECK(json_of(run, {2, 1}).find("\"d_rel_reason\": \"a view, not radiance\"") != text.npos);
    run = Run();
    Pixel pixel;  // of one replication
    pixel.add({1, 2, 3}, 1);
    run.error.add(pixel), run.stopped_by = Stop::interrupt;
    text = json_of(run, {1, 1});
    CHECK(text.find("\"d_rel_reason\": \"one sample\"") != text.npos);
    for (const char* key : {"d_rel", "d_rel_standard_error", "seconds_to_half_d_rel"})
        CHECK(text.find("\"" + std::string(key) + "\": null") != text.npos);
    CHECK(text.find("\"variance_of_mean\": [null, null, null]") != text.npos);
    CHECK(text.find("\"interrupted\": true") != text.npos);
    CHECK(json_of(run_of(0, 0), {1, 1}).find("\"seconds_to_half_d_rel\": null") != text.npos);
    Run doubtful = run_of(0.02, 0.001);
    doubtful.doubt = "rare \"light\"";
    text = json_of(doubtful, {1, 1});
    CHECK(text.find("\"d_rel_reason\": \"rare \\\"light\\\"\"") != text.npos);
    for (const char* key : {"d_rel", "d_rel_standard_error", "seconds_to_half_d_rel"})
        CHECK(text.find("\"" + std::string(key) + "\": null") != text.npos);
    CHECK(text.find("\"d_rel_by_spread\": 0.02") != text.npos);
}

TEST_CASE("progress in a log: a plain line every two seconds; quiet: none") {
    auto shown = [](double limit, bool quiet, double before, double done) {
        return told([&] {
            Progress progress(limit, quiet, before);
            const double until = progress.elapsed() + 0.3;
            while (progress.elapsed() < until) progress.show(done, "7 samples");
        });
    };
    CHECK(shown(0, false, 0, 0.5) == "");  // less than two seconds
    CHECK(shown(0, true, 8, 0.5) == "");
    CHECK(shown(0, false, 8, 0.5) == "50 %  7 samples, 8.0 s elapsed, 8.0 s left\n");
    CHECK(shown(0, false, 8, 0) == "0 %  7 samples, 8.0 s elapsed\n");
    CHECK(shown(10, false, 8, 0) == "80 %  7 samples, 8.0 s elapsed, 2.0 s left\n");
    CHECK(shown(10, false, 8, 0.9) == "90 %  7 samples, 8.0 s elapsed, 0.9 s left\n");
    CHECK(shown(4, false, 8, 0.5) == "100 %  7 samples, 8.0 s elapsed, 0.0 s left\n");
    CommonOptions o;
    CHECK(told([&] { tell(o, "a\x1b"); }) == "a?\n");
    o.quiet = true;
    CHECK(told([&] { tell(o, "a"); }) == "");
}
