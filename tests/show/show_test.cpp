// show/show_test.cpp  what the page of a render is told, and when
#include "show/show.h"

#include "base/cases.h"
#include "film/fill.h"
#include "path/scenes.h"
#include "text/complaint.h"
#include "text/folder.h"

namespace {

using clock_ = std::chrono::steady_clock;
constexpr std::chrono::hours day(24);

// A folder, and a film of this scene in it.
struct Room {
    Folder folder;
    NamedScene scene = scene_of(glowing_room);
    Options o;
    Plan plan;
    Film film;

    explicit Room(uint64_t samples = 3) {
        o.scene = "the \"room\".scene", o.quiet = true, o.stats = folder / "a.json";
        scene.exposure = 2;
        plan = plan_of(o, scene);
        const SampleFunction L = [](const PixelSample& s, Tally&) {
            return rgb{real(s.x) / 20, 0, 1};
        };
        film = make_film(scene.size, 2, false);
        if (samples > 0) fill(film, samples, L);
    }
    std::vector<std::string> outputs() const { return {folder / "a.pfm", folder / "a.png"}; }
    void begin(Show& show) {
        OptionTable table = show.rows();
        Options ignored;
        parse_words(table, {"--show", "a.scene"}, ignored);
        show.begin(o, outputs());
    }
    void picture(Show& show) { show.picture(o, scene, plan, film, {.seconds = 2}); }
    bool is_due(Show& show, clock_::time_point start) {
        fs::remove(folder.path / "a.png");
        show.picture_now_and_then(o, scene, plan, film, {}, start);
        return folder.has("a.png");
    }
    // "STATE, true|false, "WORDS"", after another stamp than before.
    std::string told() {
        const std::string script = folder.read("a.html.js");
        long long stamp = 0;
        int at = 0;
        REQUIRE(std::sscanf(script.c_str(), "now(%lld, %n", &stamp, &at) == 1);
        CHECK(stamp > before_);
        before_ = stamp;
        REQUIRE(script.ends_with(");\n"));
        return script.substr(size_t(at), script.size() - size_t(at) - 3);
    }

private:
    long long before_ = 0;
};

}  // namespace

TEST_CASE("the page is told of a picture after each is written, and of the last one") {
    Room room;
    {
        Show show;
        room.begin(show);
        CHECK(room.folder.read("a.html") == show_page);
        CHECK(room.told() == R"("rendering", false, "the \"room\".scene")");
        CHECK(room.folder.files() == 2);
        const std::string png = encode_png(image_of(room.film), 2);
        for (int again = 0; again < 2; ++again) {
            fs::remove(room.folder.path / "a.png");
            room.picture(show);
            CHECK(room.folder.read("a.png") == png);
            const std::string told = room.told();
            INFO(told);
            CHECK(told.starts_with(
                R"("rendering", true, "the \"room\".scene: 6 samples per pixel, 2.00 s)"));
        }
        Run run = run_of(room.film, room.plan, {.seconds = 3}, Stop::samples);
        show.end(room.o, run);
        CHECK(room.told().starts_with(
            R"("done", true, "the \"room\".scene: 6 samples per pixel, 3.00 s)"));
    }
    CHECK(room.folder.read("a.html.js").find("\"done\"") != std::string::npos);
    CHECK(room.folder.files() == 3);  // the PFM and the statistics are not written yet
}

TEST_CASE("a run that fails or is interrupted has stopped, and may have no picture") {
    Room room;
    try {
        Show show;
        room.begin(show);
        room.picture(show);
        throw SystemError("a failure");
    } catch (const SystemError&) {
    }
    CHECK(room.told().starts_with(R"("stopped", true, "the \"room\".scene: 6 samples)"));
    Room other;
    Show show;
    other.begin(show);
    Run run;
    run.stopped_by = Stop::interrupt;
    show.end(other.o, run);
    CHECK(other.told().starts_with(R"("stopped", false, "the \"room\".scene: interrupted before)"));
}

TEST_CASE("pictures are a second apart, and take at most a 20th of the time") {
    using std::chrono::milliseconds;
    const clock_::time_point start(day);
    struct Row {
        int took, next;  // ms
    };
    for (const Row& row :
         {Row{0, 1000}, {10, 1010}, {52, 1052}, {53, 1060}, {100, 2000}, {5000, 100000}}) {
        INFO(row.took);
        const auto end = start + milliseconds(row.took);
        CHECK(
            (next_picture(start, end, std::chrono::seconds(1)) == start + milliseconds(row.next)));
    }
}

TEST_CASE("the first picture is due when all pixels have samples, the next one later") {
    Room room, without_samples(0);
    const auto now = clock_::now();
    for (Room* r : {&room, &without_samples}) {
        Show show;
        CHECK_FALSE(r->is_due(show, now));  // nobody asks for it
        r->begin(show);
        CHECK(r->is_due(show, now) == (r == &room));
        CHECK_FALSE(r->is_due(show, now));
        CHECK(r->is_due(show, now + day) == (r == &room));
    }
}

TEST_CASE("a picture that cannot be written stops no render, and is missed on the page") {
    Room room;
    Show show;
    room.begin(show);
    fs::create_directory(room.folder.path / "a.png");
    const auto now = clock_::now();
    show.picture_now_and_then(room.o, room.scene, room.plan, room.film, {}, now);
    CHECK(room.told().starts_with(R"("rendering", false)"));
    fs::remove(room.folder.path / "a.png");
    CHECK(room.is_due(show, now + day));
    CHECK(room.told().starts_with(R"("rendering", true)"));
}

TEST_CASE("a page needs a PNG, and replaces nobody's file") {
    Room room;
    Show show;
    OptionTable table = show.rows();
    Options ignored;
    parse_words(table, {"--show", "a.scene"}, ignored);
    auto refused = [&](const std::vector<std::string>& outputs) {
        return complaint<UserError>([&] { show.begin(room.o, outputs); });
    };
    CHECK(refused({room.folder / "a.pfm"}) == "--show: needs -o FILE.png");
    room.folder.write("a.html", "<!DOCTYPE html>mine");
    CHECK(refused(room.outputs()) ==
          room.folder / "a.html" + ": --show would replace a page that is not its own");
    CHECK(room.folder.read("a.html") == "<!DOCTYPE html>mine");
    CHECK(room.folder.files() == 1);
    room.folder.write("c.html.js", "mine");
    CHECK(refused({room.folder / "c.png"}) ==
          room.folder / "c.html.js" + ": --show would replace a page that is not its own");
    for (const char* name : {"d.html", "./d.html"}) {
        room.o.stats = room.folder / name;
        CHECK(refused({room.folder / "d.png"}) ==
              room.folder / "d.html: --show would replace a page that is not its own");
    }
    room.folder.write("e.html", "");
    room.folder.write("e.html.js", "");
    show.begin(room.o, {room.folder / "e.png"});  // a full disk, say, left no more of it
    CHECK(room.folder.read("e.html") == show_page);
    CHECK(refused({room.folder / "no/a.png"}).starts_with(room.folder / "no/a.html: cannot write"));
    fs::create_directory(room.folder.path / "b.html.js");
    CHECK(refused({room.folder / "b.png"}) == room.folder / "b.html.js: is a directory");
}
