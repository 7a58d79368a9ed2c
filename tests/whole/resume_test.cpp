// whole/resume_test.cpp  --keep: a resumed run equals one without interruption
#include "base/rng.h"
#include "oracle/expect.h"
#include "whole/kept.h"
#include "whole/process.h"

namespace {

// Random moments in runs of unknown length, on a machine of varying speed.  Each moment is earlier
// after one that came too late and later after the others: about half are in time.
class RandomMoments {
public:
    explicit RandomMoments(double seconds) : most_(seconds) {}
    double next() { return most_ * double(to_unit(hash(hash(0, seed_), draws_++))); }
    void was_in_time(bool in_time) { most_ *= in_time ? 1.5 : 1 / 1.5; }

private:
    double most_;  // seconds
    const uint64_t seed_ = seed_here();
    uint64_t draws_ = 0;
};

}  // namespace

TEST_CASE("with more samples than before: the same image as at once, by any number of threads") {
    const Unequal folder("30x15");
    for (const std::string& options : parts_of(";--sampler independent --replications 1;--sampler "
                                               "halton;--replications 3 --light nee;"
                                               "--replications 2 --direction uniform --roulette "
                                               "0.3 --seed 3 --depth 2;--view normal")) {
        INFO(options);
        const Words words = folder.of(options);
        expect_success(folder, words + split("--spp 71") + outputs("whole"));
        // The first run ends with the pilot.
        for (const std::string spp : {"16", "32", "45", "71"})
            expect_success(
                folder, words + outputs("parts") + split("--keep a.film --threads 3 --spp " + spp));
        CHECK(in_head(folder, "a.film", "complete") == "yes");
        expect_same_run(folder, "whole", "parts");
        // A complete film ends at once, with the same image; a smaller target removes no samples.
        for (const std::string spp : {"71", "20"}) {
            expect_success(folder, words + outputs("again") + split("--keep a.film --spp " + spp));
            CHECK(folder.same("whole.pfm", "again.pfm"));
            CHECK(folder.number("again", "rays") == folder.number("whole", "rays"));
        }
        fs::remove(folder / "a.film");
    }
}

TEST_CASE("time and rays of a film are those of all its runs") {
    const Unequal folder("6x3");
    expect_success(folder, folder.of("--keep a.film --spp 16") + outputs("a"));
    change_head(folder / "a.film", folder / "a.film",
                {{"seconds", "1000"}, {"cpu-seconds", "2000"}, {"rays", "3000000"}});
    expect_success(folder, folder.of("--keep a.film --spp 17") + outputs("b"));
    CHECK(folder.number("b", "seconds") > 1000);
    CHECK(folder.number("b", "cpu_seconds") > 2000);
    CHECK(folder.number("b", "rays") > 3000000);
}

TEST_CASE("interrupted at random moments, mostly in a pass: the same image in the end") {
    const Unequal folder("40x30");
    int interruptions = 0, amid = 0;
    for (const std::string options :
         {"--spp 300", "--spp 242 --sampler stratified",
          "--spp 200 --replications 3 --sampler halton", "--error 6% --sampler independent"}) {
        INFO(options);
        RandomMoments moments(seconds_of(folder, folder.of(options) + outputs("whole")));
        const Words kept = folder.of(options) + split("--keep a.film") + outputs("parts");
        for (int run = 0, hits = 0; hits < 2 && run < 100; ++run) {
            const Words words = run > 0 ? kept + split("--threads 5") : kept;
            const Outcome o = cut_short(folder, words, moments.next(), SIGTERM);
            INFO(o.err);
            moments.was_in_time(o.status != 0);
            // The signal kills a process that has not yet begun.
            if (o.status == 0) fs::remove(folder / "a.film");  // complete: begins again
            if (o.signal == SIGTERM || o.status == 0) continue;
            CHECK(o.status == 143);
            ++interruptions, ++hits;
            if (!folder.has("a.film")) continue;
            CHECK(in_head(folder, "a.film", "complete") == "no");
            FilmReader film(folder / "a.film");
            std::vector<uint64_t> taken(300);  // blocks of 4 pixels
            film.read(std::as_writable_bytes(std::span(taken)));
            amid += std::count(taken.begin(), taken.end(), taken[0]) != 300;
        }
        expect_success(folder, kept);
        expect_same_run(folder, "whole", "parts");
        fs::remove(folder / "a.film");
    }
    CHECK(interruptions == 8);
    CHECK(amid > 1);
}

TEST_CASE("a smaller --error, after a greater one and after --spp") {
    const Unequal folder("12x6");
    const Words words = folder.of("--sampler independent");
    expect_success(folder, words + split("--error 4%") + outputs("whole"));
    for (const std::string first : {"--error 12%", "--spp 100"}) {
        expect_success(folder, words + split("--keep a.film -o x.pfm " + first));
        CHECK(std::stod(in_head(folder, "a.film", "rays")) < folder.number("whole", "rays"));
        expect_success(folder, words + split("--error 4% --keep a.film") + outputs("parts"));
        expect_same_run(folder, "whole", "parts");
        fs::remove(folder / "a.film");
    }
}

TEST_CASE("a disk that is full costs the film, and no image; the one that is there stays") {
    const Unequal folder("32x24");
    expect_success(folder, folder.of("--spp 40") + outputs("whole"));
    auto run_out = [&] {  // less than the film, more than the image
        return expect_exit(folder, folder.of("--spp 40 --keep a.film") + outputs("parts"), 1,
                           {.largest_file = 16384});
    };
    const std::string err = run_out().err;
    CHECK(err.ends_with("a.film: cannot write: File too large\n"));
    CHECK_FALSE(contains(err, ", a.film"));
    expect_same_run(folder, "whole", "parts");
    CHECK_FALSE(folder.has("a.film"));

    expect_success(folder, folder.of("--spp 34 --keep a.film -o x.pfm"));
    const std::string film = folder.read("a.film");
    run_out();
    CHECK(folder.same("whole.pfm", "parts.pfm") ==
          (folder.number("whole", "rays") == folder.number("parts", "rays")));
    const bool untouched = folder.read("a.film") == film;
    CHECK(untouched);
}

TEST_CASE("going on takes no more memory than beginning") {
    const Unequal folder("1024x512");
    folder.write("unequal.scene", camera + "diffuse m .5 .5 .5\nsphere 0 0 90 1 m\n");
    const Words words = folder.of("--depth 0 --replications 2");
    expect_success(folder, words + split("--spp 4") + outputs("whole"));
    expect_success(folder, words + split("--spp 2 -o x.pfm --keep a.film"));
    expect_success(folder, words + split("--spp 4 --keep a.film") + outputs("parts"));
    expect_same_run(folder, "whole", "parts");
    const double whole = folder.number("whole", "peak_memory_bytes"),
                 parts = folder.number("parts", "peak_memory_bytes");
    CHECK(parts < whole + 2e6);  // 2 bytes per pixel
}
