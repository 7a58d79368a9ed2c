// whole/interrupt_test.cpp  Ctrl-C: its latency, and the files that it leaves
#include "whole/process.h"

namespace {

bool has_begun(const Outcome& o) { return contains(o.err, "no light"); }

// Ctrl-C so many seconds after the beginning; waits up to a minute for the end.
Outcome interrupted(const Folder& folder, const Command& command, double seconds,
                    const Setting& setting = {}) {
    Process process(folder, command, setting);
    REQUIRE(process.listen(30, has_begun));
    process.listen(seconds);
    process.interrupt();
    return process.finish();
}

}  // namespace

TEST_CASE("SIGTERM, SIGHUP and Ctrl-C write the samples so far; the exit status tells them apart") {
    for (const auto& [signal, status] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}}) {
        const Place place(diffuse_scene);
        // An error is known once replications are chosen.
        const Outcome o = cut_short_late_enough(
            place, "penumbra --spp 1000000000 --size 33x17 -o a.pfm -o a.png file.scene", signal,
            [](const Outcome& so_far) {
                return summary(so_far.err).error.starts_with("estimated error ");
            });
        INFO(o.err);
        CHECK(o.status == status);
        CHECK(place.files() == 3);
        const Summary s = summary(o.err);
        REQUIRE(s.found);
        CHECK(s.interrupted);
        REQUIRE(s.samples > 0);
        CHECK(s.samples < 1000000000);
        // The image approximates that of a complete run with some samples.
        const Image image = read_pfm(place / "a.pfm"), other = place.image("--spp 64 --size 33x17");
        CHECK(d_rel(other, image) < 0.2);
    }
}

TEST_CASE("a signal that was ignored from the start stays ignored") {
    const Place place(hall_of_mirrors("4 4", 10));
    const Outcome o = interrupted(place, "penumbra --threads 1 --time 0.6 -o a.pfm file.scene", 0.2,
                                  {.ignored = SIGINT});
    CHECK(o.status == 0);
    CHECK_FALSE(summary(o.err).interrupted);
    CHECK(place.has("a.pfm"));
}

TEST_CASE("Ctrl-C is heard within a path, too") {
    const Place place(hall_of_mirrors("8192 1", 1000000));  // an hour per pass, 0.2 s per sample
    for (const std::string sets : {"", "--replications 3"}) {
        const Untouched all(place);
        const Outcome o = interrupted(place, "penumbra -o a.pfm file.scene " + sets, 0.3);
        INFO(o.err);
        CHECK(o.status == 130);
        CHECK(summary(o.err).samples == 0);
    }
}

TEST_CASE("Ctrl-C before the first pass is complete leaves no file; where no terminal is, no bar") {
    const Place place(hall_of_mirrors("1024 1024", 1000));  // minutes per pass, 40 ms per block
    place.write("out/file.png", "old");
    const Untouched all(place);
    Process process(place, "penumbra --threads 1 file.scene");
    // The first progress line appears after two seconds.
    REQUIRE(process.listen(30, [](const Outcome& o) { return contains(o.err, " s elapsed"); }));
    process.interrupt();
    const Outcome o = process.finish();
    INFO(o.err);
    CHECK(o.status == 130);
    CHECK(contains(o.err, " s left\n"));
    CHECK(o.err.find_first_of("\r\033") == o.err.npos);
    CHECK(summary(o.err).interrupted);
    CHECK(summary(o.err).samples == 0);
}

TEST_CASE("a second Ctrl-C kills at once, and leaves no file") {
    // A pass takes minutes; a film of so many pixels also takes a moment to add up.
    const Place place(hall_of_mirrors("4096 2048", 1000000));
    const Untouched all(place);
    Outcome o;
    double seconds = 0;
    // A busy machine may be too late for the pass, or end a path at once.  The test then repeats
    // with more patience.
    for (double patience = 0.1; patience < 20 && o.signal == 0; patience *= 3) {
        Process process(place, "penumbra -o a.pfm file.scene");
        REQUIRE(process.listen(30, has_begun));
        process.listen(patience);
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < 50 && !process.ended(); ++i) {  // signals in quick succession merge
            process.interrupt();
            process.listen(0.002);
        }
        o = process.finish();
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    CHECK(o.signal == SIGINT);
    CHECK(seconds < 10);
}
