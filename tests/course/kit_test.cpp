// course/kit_test.cpp  the judge: right, wrong, open and silent; whatever the program does
#include "course/judge.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <utility>

using namespace penumbra;
using namespace course;

namespace {

// Programs are lines of shell: printf's octal escapes write doubles, 1.0 being
// \0\0\0\0\0\0\360\77.
constexpr const char* one = R"(\0\0\0\0\0\0\360\77)";
constexpr const char* two = R"(\0\0\0\0\0\0\0\100)";
constexpr const char* nan_number = R"(\0\0\0\0\0\0\370\177)";

// What is judged: one probe, which must be 1.
void one_is_one(Judge& j) {
    const Rows x = j.probe("one", Rows(Out{0.5}));
    j.number("one is 1", x.numbers.at(0), 1, 1e-9);
    j.exact("it is one number", x.numbers.size() == 1);
}

Judgement judged(const std::string& line, const std::vector<KnownMistake>& mistakes = {},
                 double patience = 2, const Judging& judging = one_is_one) {
    std::vector<std::string> words{"sh", "-c", line};
    std::vector<char*> argv;
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    try {
        Program program(argv.data(), patience);
        return judge_one("9.1", judging, mistakes, 1, program);
    } catch (const Silence& e) {
        return {{}, "9.1", "silent", e.what()};
    }
}
// Reads a question of one number, answers it, and waits for the end.
std::string answers(const std::string& bytes, const std::string& width = "1") {
    return "echo double; read question; head -c 8 >/dev/null; printf '" + width + "\\n" + bytes +
           "'; cat >/dev/null";
}

}  // namespace

TEST_CASE("of wrong items the one is told that knows most") {
    const Item right{"right", false, true, ""}, law{"law", false, false, ""},
        cause{"cause", true, false, "0.3 ; looks like degrees"},
        limit{"limit", false, false, "", 0.25}, rounding{"rounding", false, false, "", 0.5, 1e-9};
    CHECK(most_telling({right}) == nullptr);
    for (const std::vector<Item>& items :
         {std::vector{right, rounding, limit, law, cause}, {cause, law, limit, rounding}})
        CHECK(most_telling(items)->what == "cause");
    CHECK(most_telling({rounding, limit, law})->what == "law");
    CHECK(most_telling({rounding, limit})->what == "limit");
    CHECK(most_telling({rounding, right})->what == "rounding");
}

TEST_CASE("right is right, and wrong is wrong") {
    const Judgement right = judged(answers(one)), wrong = judged(answers(two));
    CHECK(right.state == "right");
    CHECK(wrong.state == "wrong");
    CHECK(wrong.right() == 1);
    CHECK_FALSE(wrong.named);
    CHECK(judged(answers(nan_number)).state == "wrong");
}

TEST_CASE("a mistake is named by its answers alone, and never what is right") {
    const KnownMistake stub{"9.1", "stub", "", "", {7}}, the_stub{"9.1", "stub", "", "", {2}},
        twice{"9.1", "twice", "twice", "There", {2}}, other{"9.2", "other", "other", "There", {2}},
        longer{"9.1", "longer", "", "", {2, 2}}, right{"9.1", "right", "", "", {1}},
        empty{"9.1", "empty", "", "", {}}, near_by{"9.1", "near", "", "", {2 + 1e-6}},
        rounded{"9.1", "rounded", "", "", {2 + 1e-9}},  // as a compiler may
        infinite{"9.1", "infinite", "", "", {oracle::infinity}};
    const struct {
        const char* answer;
        std::vector<KnownMistake> known;
        std::string named, state;
    } rows[] = {{two, {stub, other, longer, empty, twice}, "twice", "wrong"},
                {one, {stub, right}, "", "right"},
                {two, {stub, right, empty}, "", "wrong"},
                {two, {near_by}, "", "wrong"},
                {two, {infinite}, "", "wrong"},
                {two, {rounded}, "rounded", "wrong"},
                {two, {twice, the_stub, other}, "twice", "wrong"},  // whichever comes first
                {two, {the_stub}, "stub", "open"}};
    for (const auto& r : rows) {
        const Judgement came = judged(answers(r.answer), r.known);
        CAPTURE(r.known.front().name);
        CHECK((came.named ? came.named->name : "") == r.named);
        CHECK(came.state == r.state);
    }
}

TEST_CASE("a program that is silent is wrong, and it is said why") {
    struct {
        std::string line, says;
    } cases[] = {
        {"exit 0", "exit status 0"},
        {"exit 3", "exit status 3"},
        {"echo 1.1 right: 9 of 9", "no answer"},
        {"echo double; exit 0", "one(0.5) ends the program"},
        {"echo double; kill -SEGV $$", "one(0.5) crashes: Segmentation fault"},
        {"echo double; kill -FPE $$", "Floating point exception"},
        {answers("", "!nobody"), "one(0.5) nobody"},
        {answers("", "many"), "'many' is no answer"},
        {answers("", "99999999999999"), "is no answer"},
        {answers("123", "1") + "; exit 0", "does not end"},
        {"echo double; read q; while :; do :; done", "does not end: no answer for 0.3 s"},
        {"while :; do sleep 1; done", "does not end"},
        {"echo double; yes a | tr -d '\\n'", "endless text"},
    };
    for (const auto& c : cases) {
        CAPTURE(c.line);
        const Judgement r = judged(c.line, {}, 0.3);
        CAPTURE(r.silence);
        CHECK(r.state == "silent");
        CHECK(r.silence.find(c.says) != r.silence.npos);
    }
}

TEST_CASE("a silence is told where nothing that came before it is wrong") {
    auto and_once_more = [](Judge& j) {
        one_is_one(j);
        (void)j.ask("one", Out{0.5});
    };
    const Judgement right = judged(answers(one), {}, 0.3, and_once_more),
                    wrong = judged(answers(two), {}, 0.3, and_once_more);
    CHECK(right.state == "silent");
    CHECK(headline(right) == "one(0.5) does not end: no answer for 0.3 s");
    CHECK(wrong.state == "silent");
    // An item says what should be, and must not be read as what is.
    CHECK(headline(wrong) == "this should hold: one is 1: 1 expected, 2 came");
}

TEST_CASE("whoever does not answer is ended, with all that he began") {
    const std::string mark = "/tmp/penumbra-judge-" + std::to_string(::getpid());
    std::filesystem::remove(mark);
    (void)judged("(sleep 1; touch " + mark + ") & echo double; read q; sleep 9", {}, 0.2);
    ::usleep(1500000);
    CHECK_FALSE(std::filesystem::exists(mark));
    std::filesystem::remove(mark);
}

TEST_CASE("float is told, and known by seven digits") {
    KnownMistake m{"9.1", "m", "m", "m", {2.00001}};
    CHECK_FALSE(judged(answers(two), {m}).named);
    std::string line = answers(two);
    line.replace(line.find("double"), 6, "float");
    CHECK(judged(line, {m}).named);
}

TEST_CASE("a check of the oracle, asked in batches, is the check") {
    // The program doubles all it is asked; the check is its mean.
    const std::string path = "build/course-doubler-" + std::to_string(::getpid());
    std::ofstream(path + ".py") << R"(
import struct, sys
i, o = sys.stdin.buffer, sys.stdout.buffer
o.write(b'double\n'); o.flush()
while True:
    line = i.readline().split()
    if not line: break
    n = int(line[1]) * int(line[2])
    x = struct.unpack('%dd' % n, i.read(8 * n))
    o.write(b'1\n' + struct.pack('%dd' % n, *[2 * a for a in x])); o.flush()
)";
    std::vector<std::string> words{"python3", path + ".py"};
    char* argv[] = {words[0].data(), words[1].data(), nullptr};
    Program program(argv, 20);
    Judge j(program, 1);
    auto mean_is = [](double truth) {
        return [truth](oracle::Random& random, auto& f) {
            return oracle::expect_mean(truth, 20000, [&] { return f[0]({random()}, {0})[0]; });
        };
    };
    // Drawn is what fails, once: not a run in which answers were yet to come.
    const std::string folder = std::exchange(oracle::pictures, path + "-pictures");
    auto drawn = [&] {
        const auto is_svg = [](const auto& entry) { return entry.path().extension() == ".svg"; };
        namespace fs = std::filesystem;
        if (!fs::exists(oracle::pictures)) return std::ptrdiff_t(0);
        return std::count_if(fs::directory_iterator(oracle::pictures), {}, is_svg);
    };
    const oracle::Verdict right = j.batched({"double"}, mean_is(1));
    CHECK(right.pass);
    CHECK(drawn() == 0);
    CHECK(!j.batched({"double"}, mean_is(1.1)).pass);
    CHECK(drawn() == 1);
    std::filesystem::remove_all(std::exchange(oracle::pictures, folder));
    oracle::Random alone(1);
    const oracle::Verdict same = oracle::expect_mean(1, 20000, [&] { return 2 * alone(); });
    CHECK(right.p == same.p);
    std::filesystem::remove(path + ".py");
}
