// keep/keep_test.cpp  checkpoints return the film that was written, resume it, or are refused
#include "keep/keep.h"

#include <thread>

#include "app/threads.h"
#include "film/fill.h"
#include "film/loop.h"
#include "keep/change_head.h"
#include "oracle/expect.h"
#include "text/complaint.h"
#include "text/folder.h"

namespace {

constexpr Size size = {37, 25};  // 925 pixels: blocks of 3, and one of 1

// Noise at the left, smooth values at the right.
rgb noise(const PixelSample& s) {
    const uint64_t key = hash(hash(hash(s.replication, s.i), uint64_t(s.x)), uint64_t(s.y));
    const real u = real(to_unit(key));
    return s.x < 9 ? rgb{u, 0, 5 * u} : rgb{1, real(s.y), u / 100};
}

// A film with two groups of lights, in rows from 5; K = 0: two replications, and a pilot.
Film blank(uint32_t K, Size of_it = size) {
    Film film = make_film(of_it, K ? K : 2, K == 0, 5);
    film.near.resize(2);
    film.near[1].line = 3, film.near[1].K = 8;
    return film;
}

// Fills a film to n samples per replication; stops after `stop_after` samples, as Ctrl-C does.
Film fill(Film film, uint64_t n, unsigned threads = 2, int64_t stop_after = INT64_MAX,
          std::vector<Film>* passes = nullptr) {
    std::atomic<int64_t> left = stop_after;
    const SampleFunction L = [&](const PixelSample& s, Tally& tally) {
        if (left-- <= 0) {
            interrupted = SIGTERM;
            throw Interrupted();
        }
        ++tally.rays;
        for (NearMisses& g : tally.near)
            g.sum[s.i % growths][s.replication % 2] += (FixedPoint(1) << 70) + s.i;
        return noise(s);
    };
    Plan plan;
    plan.samples = n, plan.threads = threads;
    Watch watch;
    watch.elapsed = [] { return 1.0; };
    watch.for_each = by_workers;
    watch.interrupted = [] { return interrupted != 0; };
    if (passes) watch.between = [&](const Film& f, const Tally&) { passes->push_back(f); };
    Loop(film, plan, L, watch).run();
    interrupted = 0;
    return film;
}

const FilmOf of = {{}, {{"sampler", "\"sobol\""}, {"seed", "7"}}, {{"name", "cube"}}};

Film restored(const std::string& path, const Film& empty, const FilmOf& what = of) {
    Film film = empty;
    Keeper(path, what).restore(film);
    return film;
}

}  // namespace

TEST_CASE("a film comes back as it was: in its pilot, after it, and amid a pass") {
    const Folder folder;
    const Keeper keeper(folder / "a.film", of);
    for (const uint32_t K : {0u, 1u, 3u})
        for (const uint64_t n : {1, 4, 20})
            for (const int64_t stop_after : {int64_t(500), int64_t(6000), INT64_MAX}) {
                const Film film = fill(blank(K), n, 1, stop_after);
                INFO(K, " replications, ", n, " samples, stopped after ", stop_after);
                CHECK(keeper.write(film, {}, true) == "");
                CHECK(same(restored(folder / "a.film", blank(K)), film));
            }
}

TEST_CASE("a film that was stopped anywhere, and kept, becomes what one run makes") {
    const Folder folder;
    const uint64_t seed = seed_here();
    int amid = 0, in_pilot = 0;
    for (const uint32_t K : {0u, 3u}) {
        const Film whole = fill(blank(K), 40);
        // Every other run stops in the pilot, which has 8 samples of a pixel.
        for (uint64_t k = 0; k < 24; ++k) {
            const double all =
                double(whole.pixels()) * (k % 2 ? whole.samples_per_pixel() : 2 * pilot_samples);
            const auto stop = int64_t(all * to_unit(hash(seed, k)));
            const Film film = fill(blank(K), 40, 3, stop);
            Keeper(folder / "a.film", of).write(film, {}, false);
            if (film.max_samples_done() + film.pilot == 0) continue;
            amid += film.min_samples_done() != film.max_samples_done(), in_pilot += film.is_pilot;
            const Film on = fill(restored(folder / "a.film", blank(K)), 40);
            CAPTURE(stop);
            CHECK(same(on, whole));
        }
    }
    CHECK(amid > 3);
    CHECK(in_pilot > 3);
}

TEST_CASE("whatever checkpoint a killed run has left, the film becomes what one run makes") {
    const Folder folder;
    for (const uint32_t K : {0u, 1u, 3u}) {
        std::vector<Film> passes;
        const Film whole = fill(blank(K), 40, 1, INT64_MAX, &passes);
        CHECK(passes.size() > 5);
        for (const Film& film : passes) {
            fs::remove(folder / "a.film");
            Keeper(folder / "a.film", of).write(film, {}, false);
            CHECK(same(fill(restored(folder / "a.film", blank(K)), 40), whole));
        }
    }
}

TEST_CASE("pixels of a film, a row at a time, are those of the film in memory") {
    const Folder folder;
    for (const uint32_t K : {0u, 1u, 3u})
        for (const int64_t stop_after : {int64_t(30000), INT64_MAX}) {
            const Film film = fill(blank(K), 20, 1, stop_after);
            Keeper(folder / "a.film", of).write(film, {}, true);
            FilmPixels pixels(folder / "a.film", size);
            int wrong = 0;
            for (size_t i = 0; i < film.pixels(); ++i) {
                const Pixel p = pixel_of(film, i);
                Pixel its;
                pixels.add_next(its);
                wrong += its.K != p.K || its.samples != p.samples || its.sum != p.sum ||
                         its.squares != p.squares;
            }
            CHECK(wrong == 0);
            CHECK(same(pixels.film().near, film.near));
            // Another film of the same pixels adds its replications.
            FilmPixels again(folder / "a.film", size);
            Pixel two = pixel_of(film, 0);
            again.add_next(two);
            CHECK(two.K == 2 * film.replications);
            CHECK(two.samples == 2 * pixel_of(film, 0).samples);
        }
}

// Films of two seeds, each with weights of its own; merged pixels have all of their replications.
TEST_CASE("the estimated error of merged films is their error, whatever weights they chose") {
    constexpr Size small = {24, 16};
    const uint64_t seed = seed_here();
    auto truth = [](int x) { return x % 3 ? 1.0 : std::exp2(-x / 4); };
    auto half_width = [](int x, int y) { return std::exp2(-(x + y) / 8); };
    for (const uint32_t K : {0u, 3u})
        for (const uint64_t n : {6, 24}) {
            Moments estimated, real_one;  // d^2 over its expectation
            for (uint64_t run = 0; run < 200; ++run) {
                std::vector<Film> films;
                for (uint64_t k = 0; k < 2; ++k)
                    films.push_back(filled(
                        small, K, k ? n : 6,
                        random_radiance(
                            hash(hash(seed, run), k), [&](const PixelSample& s, vec2 u) {
                                const double L = truth(s.x) + half_width(s.x, s.y) * (2 * u.x - 1);
                                return rgb{1, 1, 1} * real(L);
                            })));
                ImageError e;
                double squares = 0, expected = 0;
                for (size_t i = 0; i < films[0].pixels(); ++i) {
                    const int x = films[0].sample_of(i, 0, 0).x, y = films[0].sample_of(i, 0, 0).y;
                    Pixel p = pixel_of(films[0], i);
                    for (size_t r = 0; r < films[1].replications; ++r)
                        p.add(films[1].sum[i * films[1].replications + r], films[1].samples(i));
                    e.add(p);
                    squares += sqr(p.value(0) - truth(x));
                    expected += sqr(half_width(x, y)) / 3 / p.samples;
                }
                estimated.add(e.d2() * e.pixels / expected);
                real_one.add(squares / expected);
            }
            INFO(K, " replications, ", n, " samples");
            for (const Moments& m : {estimated, real_one})
                EXPECT(oracle::expect_mean(1, {m.mean, m.standard_error(), double(m.n - 1)}), 0.1);
        }
}

TEST_CASE("what a run took comes back, and the head says what the film is of") {
    const Folder folder;
    const std::string path = folder / "a.film";
    const Film film = fill(blank(2), 1);
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
    const Film empty = blank(2);
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
    const Film film = fill(blank(2), 1);
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
    lit.near.resize(3);
    for (const auto& [into, differs] :
         {std::pair{lit, "light-groups 2, not 3"}, {blank(3), "replications-per-pixel 2, not 3"}})
        CHECK(complaint([&, &f = into] { restored(path, f, what); }) ==
              path + ": was rendered with " + differs);
    other = what, other.scene = "box";  // the scene's text, as it came through a pipe
    CHECK(why(other) == "was rendered from another version of cube");
    Keeper(path, other).write(film, {}, true);
    CHECK(why(other) == "");
    other.scene = "cube";
    CHECK(why(other) == "was rendered from another version of cube");
    Keeper(path, what).write(film, {}, true);
    folder.write("scene", "boxk"), folder.write("mesh", "not");
    CHECK(why(what) == "was rendered from another version of cube");
    what.notes = {{"name", "other"}};
    CHECK(why(what) == "was rendered from cube, not from other");
}

TEST_CASE("a film that could be none is refused, by what is wrong") {
    const Folder folder;
    const std::string path = folder / "a.film";
    const Film pilot = fill(blank(0), 20, 1, 500), film = fill(blank(0), 20);
    auto without_name = [&](const auto& work) {
        const std::string text = complaint(work);
        return text.substr(std::min(text.size(), path.size()));
    };
    auto why = [&](const Facts& changed, const Film& f, const Film& into) {
        Keeper(path, {}).write(f, {}, true);
        change_head(path, path, changed);
        return without_name([&] { restored(path, into, {}); });
    };
    for (const auto& [key, value] :
         {std::pair{"pilot", "-1"}, {"pilot", "5"}, {"seconds", "soon"}, {"rays", "1e300"}})
        CHECK(why({{key, value}}, film, film) ==
              ": invalid " + std::string(key) + " '" + value + "'");
    CHECK(why({{"pilot", "1"}}, pilot, film) == ": invalid pilot '1'");
    const std::string impossible = ": has a pixel with an impossible number of samples",
                      length = ": its replications do not match its length",
                      short_one = ": is too short for its size";
    for (const int w : {0, 3, 17, 32, 255}) {
        Film wrong = film;
        wrong.weight.back() = uint8_t(w);
        CAPTURE(w);
        CHECK(why({}, wrong, film) == impossible);
    }
    for (const int w : {1, 2, 4, 8, 16}) {
        Film right = film;
        right.weight[2] = uint8_t(w);
        CHECK(why({}, right, film) == "");
    }
    Film wrong = pilot;  // no weight is chosen yet
    wrong.weight[2] = 2;
    CHECK(why({}, wrong, pilot) == impossible);
    for (const auto& [f, most] : {std::pair{pilot, pilot_samples}, {film, max_samples}}) {
        wrong = f;
        wrong.samples_done.back() = most;
        CHECK(why({}, wrong, f) == "");
        wrong.samples_done.back() = most + 1;
        CHECK(why({}, wrong, f) == impossible);
    }
    // Other numbers than those of the head.
    wrong = film;
    wrong.sum.pop_back();
    CHECK(why({}, wrong, film) == length);
    wrong = film;
    wrong.sum.push_back({});
    CHECK(why({}, wrong, film) == length);
    wrong.sum.resize(film.pixels());
    CHECK(why({}, wrong, film) == short_one);
    wrong = film;
    wrong.near.resize(400);
    CHECK(why({{"light-groups", "2"}}, wrong, film) == length);
    CHECK(why({{"weights-chosen", "yes"}}, pilot, pilot) == length);
    CHECK(why({{"replications-per-pixel", "3"}}, film, blank(3)) == short_one);
    CHECK(why({{"replications-per-pixel", "1"}}, film, blank(1)) == length);
    for (const Film& f : {film, pilot}) CHECK(why({}, f, blank(0, {37, 24})) != "");
    CHECK(why({}, film, blank(0, {1000, 1000})) == short_one);
    auto why_not_read = [&](const Facts& changed, Size of_it) {
        change_head(path, folder / "b.film", changed);
        return without_name([&] { FilmPixels(folder / "b.film", of_it); });
    };
    Keeper(path, {}).write(film, {}, true);
    // Sizes that exceed any memory, and those of no picture.
    for (const Size of_it : {Size{1 << 30, (1 << 30) - 1}, {37, 0}, {37, -1}, {0, 25}})
        CHECK(why_not_read({}, of_it) == short_one);
    for (const std::string key : {"replications-per-pixel", "light-groups"})
        for (const std::string value : {"1025", "-1", "x", "nan"})
            CHECK(why_not_read({{key, value}}, size) == ": invalid " + key + " '" + value + "'");
    CHECK(why_not_read({{"replications-per-pixel", "0"}}, size) == short_one);
    CHECK(why_not_read({{"light-groups", "1024"}}, size) == short_one);
    CHECK(why_not_read({}, size) == "");
    fs::remove(path);
    Keeper(path, {}).write(blank(2), {}, true);
    CHECK(why_not_read({}, size) == ": has no samples");
}

TEST_CASE("films are written once in an interval, and a hundredth of the time at most") {
    const Folder folder;
    const Film film = fill(blank(2), 1);
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
    const Film large = make_film({256, 256}, 2, false);
    Film one = large;
    one.samples_done[0] = 1;
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
    const Film empty = blank(2);
    const Keeper keeper(folder / "a.film", of);
    CHECK(keeper.write(fill(empty, 1), {}, true) == "");
    const std::string bytes = folder.read("a.film");
    CHECK(keeper.write(empty, {}, true) == "");
    CHECK(folder.read("a.film") == bytes);
    Film chosen = empty;  // a pilot counts as samples
    chosen.pilot = 4;
    CHECK(keeper.write(chosen, {}, true) == "");
    CHECK(folder.read("a.film") != bytes);
    CHECK(Keeper(folder / "no/a.film", of).write(empty, {}, true) ==
          folder / "no/a.film" + ": cannot write: No such file or directory");
}
