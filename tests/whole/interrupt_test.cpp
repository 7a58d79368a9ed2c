// whole/interrupt_test.cpp  Ctrl-C: when it is heard, and what is kept
#include "whole/process.h"

namespace {

void expect_samples_so_far(int signal, int status) {
    const Folder folder;
    folder.write("file.scene", good + "quad -9 -1 -9  0 0 18  18 0 0  m\n");
    Outcome o;
    // A busy machine may not have begun, or not have chosen sets: then again, with more patience.
    for (double patience = 0.25; patience < 20 && !summary(o.err).error.starts_with("d_rel ");
         patience *= 3) {
        Process process(folder, "penumbra",
                        split("--spp 1000000000 --size 33x17 -o a.pfm -o a.png file.scene"));
        process.listen(patience, [](const Outcome&) { return false; });
        process.interrupt(signal);
        o = process.finish();
    }
    INFO(o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == status);
    CHECK(folder.all().size() == 3);
    const Summary s = summary(o.err);
    REQUIRE(s.found);
    CHECK(s.interrupted);
    REQUIRE(s.samples > 0);
    CHECK(s.samples < 1000000000);
    // It shows what a run of some samples shows.
    expect_success(folder, "penumbra", split("--spp 64 --size 33x17 -o b.pfm file.scene"));
    const Image image = read_pfm(folder / "a.pfm"), other = read_pfm(folder / "b.pfm");
    CHECK(all_finite(image));
    double square = 0, norm = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        square += std::pow(double(image.pixels[i][1]) - double(other.pixels[i][1]), 2);
        norm += std::pow(double(other.pixels[i][1]), 2);
    }
    CHECK(square < 0.04 * norm);
}

}  // namespace

TEST_CASE("Ctrl-C writes the samples so far, and says how many they are") {
    expect_samples_so_far(SIGINT, 130);
}

TEST_CASE("SIGTERM and SIGHUP do what Ctrl-C does, and the exit status tells them apart") {
    expect_samples_so_far(SIGTERM, 143);
    expect_samples_so_far(SIGHUP, 129);
}

TEST_CASE("a signal that was ignored from the start stays ignored") {
    const Folder folder;
    folder.write("file.scene", hall_of_mirrors("4 4", 10));
    Process process(folder, "penumbra", split("--threads 1 --time 0.6 -o a.pfm file.scene"),
                    {.ignored = SIGINT});
    REQUIRE(process.listen(30, [](const Outcome& o) { return contains(o.err, "no light"); }));
    process.listen(0.2, [](const Outcome&) { return false; });
    process.interrupt();
    const Outcome o = process.finish();
    CHECK(o.status == 0);
    CHECK_FALSE(summary(o.err).interrupted);
    CHECK(folder.has("a.pfm"));
}

TEST_CASE("Ctrl-C is heard within a path, too") {
    const Folder folder;
    folder.write("file.scene",
                 hall_of_mirrors("8192 1", 1000000));  // an hour a pass, 0.2 s a sample
    const auto before = folder.all();
    for (const char* sets : {"", "--sets 3"}) {
        Process process(folder, "penumbra", split(std::string(sets) + " -o a.pfm file.scene"));
        REQUIRE(process.listen(30, [](const Outcome& o) { return contains(o.err, "no light"); }));
        process.listen(0.3, [](const Outcome&) { return false; });
        process.interrupt();
        const Outcome o = process.finish();  // which waits for a minute
        INFO(o.err);
        CHECK(o.signal == 0);
        CHECK(o.status == 130);
        CHECK(summary(o.err).samples == 0);
        const bool untouched = folder.all() == before;
        CHECK(untouched);
    }
}

TEST_CASE("Ctrl-C before the first pass is complete leaves no file; where no terminal is, no bar") {
    const Folder folder;
    folder.write("file.scene",
                 hall_of_mirrors("1024 1024", 1000));  // minutes a pass, 40 ms a block
    folder.write("out/file.png", "old");
    const auto before = folder.all();
    Process process(folder, "penumbra", split("--threads 1 file.scene"));
    // The first line about progress comes after two seconds.
    REQUIRE(process.listen(30, [](const Outcome& o) { return contains(o.err, " s elapsed"); }));
    process.interrupt();
    const Outcome o = process.finish();
    INFO(o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 130);
    CHECK(contains(o.err, " s left\n"));
    CHECK_FALSE(contains(o.err, "\r"));
    CHECK_FALSE(contains(o.err, "\033"));
    const Summary s = summary(o.err);
    CHECK(s.found);
    CHECK(s.interrupted);
    CHECK(s.samples == 0);
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}

TEST_CASE("a second Ctrl-C kills at once, and leaves no file") {
    const Folder folder;
    // Minutes a pass; a film of so many pixels takes a moment to add up after it, too.
    folder.write("file.scene", hall_of_mirrors("4096 2048", 1000000));
    const auto before = folder.all();
    auto never = [](const Outcome&) { return false; };
    Outcome o;
    double seconds = 0;
    // A busy machine may not have begun the pass, or end a path at once: then again, with more
    // patience.
    for (double patience = 0.1; patience < 20 && o.signal == 0; patience *= 3) {
        Process process(folder, "penumbra", split("-o a.pfm file.scene"));
        REQUIRE(process.listen(30, [](const Outcome& p) { return contains(p.err, "no light"); }));
        process.listen(patience, never);
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < 50 && !process.ended(); ++i) {  // signals that follow too soon are one
            process.interrupt();
            process.listen(0.002, never);
        }
        o = process.finish();
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    CHECK(o.signal == SIGINT);
    CHECK(seconds < 10);
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}
