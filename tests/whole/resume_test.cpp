// whole/resume_test.cpp  checkpoints: a run that goes on is one that never stopped
#include <cmath>

#include "base/rng.h"
#include "oracle/expect.h"
#include "whole/kept.h"
#include "whole/process.h"

namespace {

struct Row {
    const char* options;
    bool diffuse = false;  // the scene
};

Words scene_of(const Row& row) {
    return {"--size", "12x6", row.diffuse ? "diffuse.scene" : "unequal.scene"};
}

struct Scenes : Folder {
    Scenes() {
        write("unequal.scene", unequal);
        write("diffuse.scene", diffuse);
    }
};

// Interrupts the run, or kills it, after so many seconds, unless it is done before.
Outcome cut_short(const Folder& folder, const Words& words, double seconds, int signal = SIGTERM) {
    Process process(folder, "penumbra", words);
    process.listen(seconds, [](const Outcome&) { return false; });
    process.interrupt(signal);
    return process.finish();
}

}  // namespace

TEST_CASE("with more samples than before: the same image as at once, by any number of threads") {
    const Row rows[] = {{"--sampler independent"},
                        {"--sampler halton"},
                        {"--sampler halton-naive"},
                        {"--sets 1 --pick power"},
                        {"--sets 2 --direction uniform --roulette 0.3"},
                        {"--view variance --polygons angle"},
                        {"--view normal"},
                        {"--light nee --direct control"},
                        {"--light nee --direct ratio"},
                        {"--light nee --direct regression --seed 3 --depth 2"},
                        {"--indirect map --particles 3000", true},
                        {"--indirect control --particles 3000", true},
                        {"--indirect regression --particles 3000", true}};
    const Scenes folder;
    for (const Row& row : rows) {
        INFO(std::string(row.options));
        const Words words = split(row.options) + scene_of(row);
        expect_success(folder, "penumbra", split("--spp 37") + outputs("whole") + words);
        std::string resume;
        // Before the sets are chosen, when they have just been, and later.
        for (const char* spp : {"5", "16", "23", "37"}) {
            if (row.diffuse && spp[0] == '5') continue;
            // Sets of so few are others.
            const bool early = spp[0] == '5' && !contains(row.options, "--sets") &&
                               !contains(row.options, "variance") &&
                               !contains(row.options, "naive");
            if (early) continue;
            expect_success(folder, "penumbra",
                           split(resume + "--checkpoint a.film --threads 2 --spp ") + Words{spp} +
                               outputs("parts") + words);
            resume = "--resume a.film --threads 3 ";
        }
        expect_same_run(folder, "whole", "parts");
        CHECK(in_head(folder, "a.film", "complete") == "yes");
        // What is complete ends at once, with the same image.
        const std::string rays = stated(folder.read("parts.json"), "rays");
        expect_success(folder, "penumbra",
                       split("--resume a.film --spp 37") + outputs("again") + words);
        expect_same_run(folder, "whole", "again");
        if (!row.diffuse) CHECK(stated(folder.read("again.json"), "rays") == rays);
    }
}

TEST_CASE("interrupted at random moments, mostly in a pass: the same image in the end") {
    const Row rows[] = {{"--spp 500"},
                        {"--spp 360 --sampler stratified"},
                        {"--spp 300 --light nee --direct ratio --sets noise"},
                        {"--spp 300 --view variance"},
                        {"--error 3% --sampler independent"},
                        {"--spp 100 --sampler independent --film vor --sets 2"},
                        {"--spp 100 --sampler independent --film fvor"},
                        {"--spp 100 --sampler independent --film cvor"},
                        {"--spp 100 --sampler independent --film torus --sets 1"},
                        {"--spp 200 --indirect map", true},
                        {"--spp 200 --indirect regression", true}};
    const Scenes folder;
    uint64_t draws = 0;
    const uint64_t seed = seed_here();
    int interruptions = 0, unfinished = 0;
    for (const Row& row : rows) {
        INFO(std::string(row.options));
        const Words words = split(row.options) + scene_of(row);
        const auto start = std::chrono::steady_clock::now();
        expect_success(folder, "penumbra", outputs("whole") + words);
        const double took =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        Words kept = split("--checkpoint a.film") + outputs("parts") + words;
        for (int run = 0; run < 3; ++run) {
            const double moment = took * double(to_unit(hash(hash(0, seed), draws++)));
            const Outcome o = cut_short(folder, kept, moment);
            INFO(o.err);
            // One that had not yet begun is killed by the signal.
            if (o.signal == SIGTERM) continue;
            if (o.status != 0) {
                CHECK(o.status == 143);
                ++interruptions;
                CHECK(in_head(folder, "a.film", "complete") == "no");
                unfinished += in_head(folder, "a.film", "unfinished") == "yes";
            }
            if (run == 0) kept = split("--resume a.film --threads 5") + kept;
        }
        expect_success(folder, "penumbra", kept);
        expect_same_run(folder, "whole", "parts");
        fs::remove(folder / "a.film");
    }
    CHECK(interruptions > 3);
    CHECK(unfinished > 1);
}

TEST_CASE("a smaller --error, after a greater one and after --spp") {
    const Scenes folder;
    const Words words = split("--size 12x6 --sampler independent unequal.scene");
    expect_success(folder, "penumbra", split("--error 4%") + outputs("whole") + words);
    expect_success(folder, "penumbra", split("--error 12% --checkpoint a.film -o x.pfm") + words);
    CHECK(std::stoi(in_head(folder, "a.film", "taken")) <
          std::stoi(stated(folder.read("whole.json"), "samples_per_pixel")));
    expect_success(folder, "penumbra",
                   split("--error 4% --resume a.film") + outputs("parts") + words);
    expect_same_run(folder, "whole", "parts");
    expect_success(folder, "penumbra", split("--spp 19 --checkpoint b.film -o x.pfm") + words);
    expect_success(folder, "penumbra",
                   split("--error 4% --resume b.film") + outputs("others") + words);
    expect_same_run(folder, "whole", "others");
}

TEST_CASE(
    "kill -9 at any moment: a film that is whole, or none; the chain ends in the same image") {
    const Scenes folder;
    const Words words = split("--size 80x40 --spp 24 --threads 2 unequal.scene");
    const auto start = std::chrono::steady_clock::now();
    expect_success(folder, "penumbra", outputs("whole") + words);
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const char* const asked = std::getenv("KILLS");
    const int kills = asked ? std::atoi(asked) : 30;
    const uint64_t seed = seed_here();
    const Words kept = split("--checkpoint a.film --every 0.000001") + outputs("parts") + words;
    int done = 0, killed = 0, chains = 0, within_a_write = 0;
    uint64_t taken = 0;
    for (; killed < kills; ++done) {
        REQUIRE(done < 20 * kills);
        const bool goes_on = folder.has("a.film");
        const Words run = goes_on ? split("--resume a.film") + kept : kept;
        const double moment = 1.5 * took * double(to_unit(hash(hash(0, seed), uint64_t(done))));
        const Outcome o = cut_short(folder, run, moment, SIGKILL);
        INFO(o.err);
        killed += o.signal == SIGKILL;
        for (const auto& entry : fs::directory_iterator(folder.path))
            within_a_write += contains(entry.path().filename(), ".a.film.part");
        const bool complete = o.signal == 0;
        if (complete) CHECK(o.status == 0);
        if (goes_on || complete) REQUIRE(folder.has("a.film"));
        if (!folder.has("a.film")) continue;
        // Which reads all of it; nothing that was kept is lost.
        const uint64_t now = std::stoull(in_head(folder, "a.film", "taken"));
        CHECK(now >= taken);
        taken = now;
        if (!complete) continue;
        expect_same_run(folder, "whole", "parts");
        fs::remove(folder / "a.film"), taken = 0, ++chains;
    }
    // The next run removes what the killed ones left.
    expect_success(folder, "penumbra",
                   (folder.has("a.film") ? split("--resume a.film") + kept : kept));
    expect_same_run(folder, "whole", "parts");
    for (const auto& [name, bytes] : folder.all()) CHECK_FALSE(contains(name, ".part"));
    MESSAGE(killed, " runs killed, ", within_a_write, " of them in a write; ", chains,
            " chains ended");
}

TEST_CASE("what a killed run left beside its film, the next one removes") {
    const Scenes folder;
    folder.write(".a.film.part2147483646", "half");  // more than Linux gives to processes
    expect_success(folder, "penumbra",
                   split("--spp 2 --checkpoint a.film -o a.pfm --size 12x6 unequal.scene"));
    CHECK(folder.has("a.film"));
    CHECK_FALSE(folder.has(".a.film.part2147483646"));
}

TEST_CASE("a disk that is full costs checkpoints, and no image") {
    const Scenes folder;
    const Words words = split("--size 32x24 --spp 40 unequal.scene");
    expect_success(folder, "penumbra", outputs("whole") + words);
    auto run = [&](const char* options) {
        Process process(folder, "penumbra", split(options) + outputs("parts") + words,
                        {.largest_file = 16384});  // the film has 24576 bytes, the image 9216
        return process.finish();
    };
    Outcome o = run("--every 0.000001 --checkpoint a.film");
    INFO(o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 1);
    CHECK(contains(o.err, "a.film: cannot write: File too large; the render goes on\n"));
    CHECK(o.err.ends_with("a.film: cannot write: File too large\n"));
    CHECK_FALSE(contains(o.err, ", a.film"));
    expect_same_run(folder, "whole", "parts");
    CHECK_FALSE(folder.has("a.film"));
    CHECK(folder.files() == 6);

    // The one that is there stays.
    expect_success(folder, "penumbra",
                   split("--checkpoint a.film -o x.pfm --size 32x24 --spp 17 unequal.scene"));
    const std::string film = folder.read("a.film");
    o = run("--every 0.000001 --resume a.film --checkpoint a.film");
    CHECK(o.status == 1);
    expect_same_run(folder, "whole", "parts");
    const bool untouched = folder.read("a.film") == film;
    CHECK(untouched);
}

TEST_CASE("going on takes no more memory than beginning") {
    const Scenes folder;
    folder.write("dark.scene", camera + "diffuse m .5 .5 .5\nsphere 0 0 90 1 m\n");
    const Words words = split("--size 2048x1024 --depth 0 dark.scene");
    expect_success(folder, "penumbra", split("--spp 2") + outputs("whole") + words);
    expect_success(folder, "penumbra", split("--spp 1 -o x.pfm --checkpoint a.film") + words);
    expect_success(folder, "penumbra", split("--spp 2 --resume a.film") + outputs("parts") + words);
    expect_same_run(folder, "whole", "parts");
    const double whole = std::stod(stated(folder.read("whole.json"), "peak_memory_bytes")),
                 parts = std::stod(stated(folder.read("parts.json"), "peak_memory_bytes"));
    CHECK(parts < whole + 4e6);  // 2 bytes a pixel
}

TEST_CASE("what weights fell back to is counted in all runs together") {
    const Scenes folder;
    const Words words =
        split("--size 40x30 --spp 2 --sampler independent --film fvor --sets 2 unequal.scene");
    expect_success(folder, "penumbra", outputs("whole") + words);
    const std::string whole = stated(folder.read("whole.json"), "film_fallbacks");
    REQUIRE(std::stoi(whole) > 0);
    for (const char* rows : {"0-9", "10-29"})
        expect_success(
            folder, "penumbra",
            split("--rows " + std::string(rows) + " --checkpoint " + rows + ".film") + words);
    expect_success(folder, "merge", split("0-9.film 10-29.film") + outputs("parts"));
    CHECK(stated(folder.read("parts.json"), "film_fallbacks") == whole);
    expect_success(folder, "penumbra", split("-o x.pfm --checkpoint a.film") + words);
    expect_success(folder, "penumbra", split("--resume a.film") + outputs("again") + words);
    CHECK(stated(folder.read("again.json"), "film_fallbacks") == whole);
}

TEST_CASE("maps of a run that is kept have all their particles, whatever the time") {
    const Scenes folder;
    const Words words = split("--size 4x3 --indirect map --particles 300000 diffuse.scene");
    expect_success(folder, "penumbra",
                   split("--spp 1 --checkpoint a.film") + outputs("whole") + words);
    expect_success(folder, "penumbra",
                   split("--time 0.001 --spp 1 --resume a.film") + outputs("parts") + words);
    for (const char* key : {"map_particles", "map_error", "map_slope"})
        CHECK(stated(folder.read("whole.json"), key) == stated(folder.read("parts.json"), key));
}
