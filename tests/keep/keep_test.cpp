// keep/keep_test.cpp  checkpoints return the film that was written, resume it, or are refused
#include "keep/keep.h"

#include <thread>

#include "base/complaint.h"
#include "base/folder.h"
#include "film/fill.h"
#include "film/passes.h"
#include "keep/change_head.h"
#include "oracle/expect.h"

namespace {

constexpr Size size = {37, 25};  // 925 pixels: blocks of 3, and one of 1

// Noise at the left, smooth values at the right.
rgb noise(const PixelSample& s) {
    const uint64_t key = hash(hash(hash(s.set, s.i), uint64_t(s.x)), uint64_t(s.y));
    const real u = real(to_unit(key));
    return s.x < 9 ? rgb{u, 0, 5 * u} : rgb{1, real(s.y), u / 100};
}

// Fills a film to n samples per replication; stops after `stop_after` samples, as Ctrl-C does.
Film fill(Film film, uint64_t n, unsigned threads = 2, int64_t stop_after = INT64_MAX) {
    std::atomic<int64_t> left = stop_after;
    const Radiance L = [&](const PixelSample& s, Tally& tally) {
        if (left-- <= 0) throw Interrupted();
        ++tally.rays;
        for (FixedPoint& sum : tally.sums) sum += (FixedPoint(1) << 70) + s.i;
        return noise(s);
    };
    Watch watch;
    watch.elapsed = [] { return 1.0; };
    Loop(film, {{n, 0, 0}, 1, threads}, L, watch).run();
    return film;
}

const FilmOf of = {{}, {{"sampler", "\"sobol\""}, {"seed", "7"}}, {{"name", "cube"}}};

Film restored(const std::string& path, const Film& empty, const FilmOf& what = of) {
    Film film = empty;
    Keeper(path, what).restore(film);
    return film;
}

}  // namespace

TEST_CASE("a film comes back as it was: before its sets, after them, and amid a pass") {
    const Folder folder;
    const Keeper keeper(folder / "a.film", of);
    for (const uint32_t sets : {0u, 1u, 3u}) {
        Film empty = make_film(size, sets, 5);
        empty.evidence.resize(sets);
        for (const uint64_t n : {1, 16, 20})
            for (const int64_t stop_after : {int64_t(500), INT64_MAX}) {
                const Film film = fill(empty, n, 1, stop_after);
                INFO(sets, " sets, ", n, " samples, stopped after ", stop_after);
                CHECK(keeper.write(film, {}, true) == "");
                CHECK(same(restored(folder / "a.film", empty), film));
            }
    }
}

TEST_CASE("a film that was stopped anywhere, and kept, becomes what one run makes") {
    const Folder folder;
    const uint64_t seed = seed_here();
    int amid = 0;
    for (const uint32_t sets : {0u, 3u}) {
        Film empty = make_film(size, sets);
        empty.evidence.resize(3);
        const Film whole = fill(empty, 40);
        for (uint64_t k = 0; k < 12; ++k) {
            const auto stop = int64_t(whole.total() * to_unit(hash(seed, k)));
            const Film film = fill(empty, 40, 3, stop);
            Keeper(folder / "a.film", of).write(film, {}, false);
            if (film.most_taken() + film.pilot == 0) continue;
            amid += film.least_taken() != film.most_taken();
            const Film on = fill(restored(folder / "a.film", empty), 40);
            CAPTURE(stop);
            CHECK(same(on, whole));
        }
    }
    CHECK(amid > 3);
}

TEST_CASE("pixels of a film, a row at a time, are those of the film in memory") {
    const Folder folder;
    for (const uint32_t sets : {0u, 3u})
        for (const int64_t stop_after : {int64_t(30000), INT64_MAX}) {
            Film film = make_film(size, sets);
            film.evidence.resize(sets);
            film = fill(film, 20, 1, stop_after);
            Keeper(folder / "a.film", of).write(film, {}, true);
            FilmPixels pixels(folder / "a.film", size);
            int wrong = 0;
            for_each_pixel(film, [&](size_t, const Pixel& p) {
                const Pixel its = pixels.next();
                wrong += its.first != p.first || its.others != p.others ||
                         its.sum.size() != p.sum.size() ||
                         std::memcmp(its.sum.data(), p.sum.data(), p.sum.size_bytes()) != 0;
            });
            CHECK(wrong == 0);
            CHECK(same(pixels.film().evidence, film.evidence));
        }
}

TEST_CASE("what a run took comes back, and the head says what the film is of") {
    const Folder folder;
    const std::string path = folder / "a.film";
    const Film film = fill(make_film(size, 2), 1);
    Keeper(path, of).write(film, {0.1, 1e9, uint64_t(1) << 53}, true);
    Film back = film;
    const Spent spent = Keeper(path, of).restore(back);
    CHECK(spent.seconds == 0.1);
    CHECK(spent.cpu_seconds == 1e9);
    CHECK(spent.rays == uint64_t(1) << 53);
    const Facts expected = {
        {"sampler", "sobol"}, {"seed", "7"}, {"name", "cube"}, {"complete", "yes"}};
    const Facts head = FilmReader(path).head();
    CHECK(Facts(head.begin() + 1, head.begin() + 5) == expected);
    Keeper(path, of).write(film, {}, false);
    CHECK(FilmReader(path).said("complete") == "no");
}

TEST_CASE("no film is nothing to go on from, and no name no film") {
    const Folder folder;
    const Film empty = make_film(size, 2);
    CHECK((same(restored(folder / "no.film", empty), empty) && same(restored("", empty), empty)));
    CHECK(Keeper("", of).write(empty, {}, true) == "");
    CHECK(folder.files() == 0);
}

TEST_CASE("a film of other samples is refused by the first thing that differs") {
    const Folder folder;
    const std::string path = folder / "a.film";
    folder.write("scene", "box"), folder.write("mesh", "knot");
    FilmOf what = of;
    what.files = {folder / "scene", folder / "mesh"};
    const Film film = fill(make_film(size, 2), 1);
    Keeper(path, what).write(film, {}, true);
    auto why = [&](const FilmOf& other) {
        const std::string text = complaint([&] { restored(path, film, other); });
        return text.starts_with(path + ": ") ? text.substr(path.size() + 2) : text;
    };
    CHECK(why(what) == "");
    FilmOf other = what;
    other.samples[1] = {"seed", "8"};
    CHECK(why(other) == "was rendered with seed 7, not 8");
    other.samples[0] = {"sampler", "\"halton\""};
    CHECK(why(other) == "was rendered with sampler sobol, not halton");
    other = what, other.notes = {{"name", "sphere"}};
    CHECK(why(other) == "");
    other = what, other.samples.push_back({"grid", "7x5"});
    CHECK(why(other) == "was rendered with grid not known, not 7x5");
    Film lit = film;
    lit.evidence.resize(2);
    CHECK(complaint([&] { restored(path, lit, what); }) ==
          path + ": was rendered with evidence 0, not 2");
    folder.write("scene", "boxk"), folder.write("mesh", "not");
    CHECK(why(what) == "was rendered from another version of cube");
    what.notes = {{"name", "other"}};
    CHECK(why(what) == "was rendered from cube, not from other");
}

TEST_CASE("a film that could be none is refused, by what is wrong") {
    const Folder folder;
    const std::string path = folder / "a.film";
    const Film empty = make_film(size, 0), film = fill(empty, 20);
    auto why = [&](const Facts& changed, const Film& f, const Film& into) {
        Keeper(path, {}).write(f, {}, true);
        change_head(path, path, changed);
        return complaint([&] { restored(path, into, {}); }).substr(path.size());
    };
    CHECK(why({{"pilot", "-1"}}, film, empty) == ": invalid pilot '-1'");
    CHECK(why({{"seconds", "soon"}}, film, empty) == ": invalid seconds 'soon'");
    CHECK(why({{"rays", "1e300"}}, film, empty) == ": invalid rays '1e300'");
    const std::string other = ": its replications do not match its length",
                      impossible = ": has a pixel with an impossible number of replications";
    Film wrong = film;
    wrong.sets[2] = 0;
    CHECK(why({}, wrong, empty) == impossible);
    wrong.sets[2] = most_sets + 1;
    CHECK(why({}, wrong, empty) == impossible);
    wrong.sets[2] = uint16_t(film.sets[2] + 1);
    CHECK(why({}, wrong, empty) == other);
    CHECK(why({}, film, make_film({37, 24}, 0)) != "");
    CHECK(why({}, film, make_film({1000, 1000}, 0)) == ": is too short for its size");
    CHECK(why({}, fill(empty, 20, 1, 500), make_film({37, 24}, 0)) == other);
    auto why_not_read = [&](const std::string& name, Size of_it) {
        return complaint([&] { FilmPixels(folder / name, of_it); }).substr((folder / name).size());
    };
    // The size exceeds any memory.
    CHECK(why_not_read("a.film", {1 << 30, 1 << 30}) == ": is too short for its size");
    Keeper(folder / "b.film", {}).write(empty, {}, true);
    CHECK(why_not_read("b.film", size) == ": has no samples");
}

TEST_CASE("films are written once in an interval, and a hundredth of the time at most") {
    const Folder folder;
    const Film film = fill(make_film(size, 2), 1);
    using std::chrono::milliseconds;
    Keeper seldom(folder / "a.film", of);
    seldom.write_now_and_then(film, {});
    CHECK(folder.files() == 0);
    Keeper often(folder / "a.film", of, milliseconds(30));
    auto writes = [&](int ms) {
        int count = 0;
        const auto end = std::chrono::steady_clock::now() + milliseconds(ms);
        while (std::chrono::steady_clock::now() < end) {
            fs::remove(folder / "a.film");
            often.write_now_and_then(film, {});
            count += folder.has("a.film");
            std::this_thread::sleep_for(milliseconds(1));
        }
        return count;
    };
    CHECK(writes(20) == 0);
    const int count = writes(200);
    CHECK(count >= 1);
    CHECK(count <= 7);
    // Slow writes are rare: the next one waits for 100 times the duration of the last one.
    const Film large = make_film({256, 256}, 2);
    Film one = large;
    one.taken[0] = 1;
    Keeper slow(folder / "b.film", of, milliseconds(0));
    const auto start = std::chrono::steady_clock::now();
    slow.write_now_and_then(one, {});
    const auto took = std::chrono::steady_clock::now() - start;
    REQUIRE(folder.has("b.film"));
    fs::remove(folder / "b.film");
    while (std::chrono::steady_clock::now() - start < 20 * took) {
        slow.write_now_and_then(one, {});
        std::this_thread::sleep_for(milliseconds(1));
    }
    CHECK_FALSE(folder.has("b.film"));
}

TEST_CASE("a film without samples replaces none; one that cannot be written says why") {
    const Folder folder;
    const Film empty = make_film(size, 2);
    const Keeper keeper(folder / "a.film", of);
    CHECK(keeper.write(fill(empty, 1), {}, true) == "");
    const std::string bytes = folder.read("a.film");
    CHECK(keeper.write(empty, {}, true) == "");
    CHECK(folder.read("a.film") == bytes);
    Film chosen = empty;  // a pilot counts as samples
    chosen.pilot = 16;
    CHECK(keeper.write(chosen, {}, true) == "");
    CHECK(folder.read("a.film") != bytes);
    CHECK(Keeper(folder / "no/a.film", of).write(empty, {}, true) ==
          folder / "no/a.film" + ": cannot write: No such file or directory");
}
