// keep/farm_test.cpp  farms without their engines: plans, stopped and killed parts, merges
//
// `make test-farm` runs the same scripts on a real Slurm, by GNU parallel and over ssh.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "text/folder.h"

namespace {

struct Said {
    int status = -1;
    std::string out, err;
    bool has(const std::string& part) const { return err.find(part) != err.npos; }
};

const std::string picture = "--size 8x6 --spp 5 a.scene";
const std::string farm_words = "--build build --folder farm -o a.pfm ";

// A folder for farms.  Scripts replace the programs: they print their arguments and write films.
struct Yard {
    Folder folder;

    Yard() {
        folder.write("a.scene", "");
        script("build/penumbra", R"(echo "$@" >>told
for word; do [ "$before" != --keep ] || film=$word; before=$word; done
printf 'penumbra film 2\ncomplete yes\n\n' >"$film"
)");
        script("build/merge", "echo \"$@\" >merged\n");
        fs::create_directory(folder.path / "bin");
    }
    void script(const std::string& name, const std::string& lines) const {
        folder.write(name, "#!/bin/bash\n" + lines);
        fs::permissions(folder.path / name, fs::perms::owner_all);
    }
    // Runs a script of src/keep in the folder; programs in bin/ precede those of the system.
    Said run(const std::string& words, const std::string& variables = "") const {
        const std::string command =
            "cd '" + folder.path.string() + "' || exit; exec >out 2>err; PATH=\"$PWD/bin:$PATH\" " +
            variables + " bash '" + fs::absolute("src/keep").string() + "'/" + words;
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                folder.read("out"), folder.read("err")};
    }
    Said plan(const std::string& options) const {
        return run("farm.sh plan " + farm_words + options + " -- " + picture);
    }
    std::string log(const std::string& number) const {
        return folder.read("farm/part-000" + number + ".log");
    }
};

std::string parts_of(const std::string& plan) { return plan.substr(plan.find("part ")); }

}  // namespace

TEST_CASE("bands make up the picture, as even as can be, each by all seeds") {
    const Yard yard;
    const Said said = yard.plan("--bands 4 --seeds 2");
    INFO(said.err);
    CHECK(said.status == 0);
    CHECK(parts_of(yard.folder.read("farm/farm.plan")) ==
          "part --rows 0-0 --seed 0\npart --rows 0-0 --seed 1\n"
          "part --rows 1-2 --seed 0\npart --rows 1-2 --seed 1\n"
          "part --rows 3-3 --seed 0\npart --rows 3-3 --seed 1\n"
          "part --rows 4-5 --seed 0\npart --rows 4-5 --seed 1\n");
}

TEST_CASE(
    "one part has all rows, and says nothing of seeds; a picture has as many files as given") {
    const Yard yard;
    CHECK(yard.plan("-o b.hdr --output c.png").status == 0);
    const std::string plan = yard.folder.read("farm/farm.plan");
    CHECK(parts_of(plan) == "part --rows 0-5\n");
    for (const char* file : {"a.pfm", "b.hdr", "c.png"})
        CHECK(plan.find("output -o\noutput " + (yard.folder / file) + "\n") != plan.npos);
}

TEST_CASE("what cannot be rendered is refused before it is planned") {
    const Yard yard;
    auto refused = [&](const std::string& words, const std::string& why) {
        const Said said = yard.run("farm.sh plan " + words);
        INFO(words << ": " << said.err);
        CHECK(said.status == 2);
        CHECK(said.has(why));
        CHECK_FALSE(yard.folder.has("farm/farm.plan"));
    };
    const std::pair<std::string, std::string> rows[] = {
        {"--bands 7 -- " + picture, "--bands 7: the picture has 6 rows"},
        {"--seeds 2 -- --seed 1 " + picture, "--seed: --seeds 2 sets it"},
        {"--bands 0 -- " + picture, "--bands '0' is not a number of 1 or more"},
        {"--bands -- " + picture, "--bands '--' is not a number"},
        {"--hosts h -- " + picture, "--hosts: not a farm option"},
        {"-- --spp 5 a.scene", "--size WxH"},
        {"-- --size 8x6 a.scene", "--spp ''"},
        {"-- --rows 0-1 " + picture, "--rows: the farm sets it"},
        {"-- --rows=0-1 " + picture, "--rows: the farm sets it"},
        {"-- --output b.pfm " + picture, "--output: the farm sets it"},
        {picture, "--size: not a farm option"},
        {"", "missing -- OPTIONS OF PENUMBRA SCENE"}};
    for (const auto& [words, why] : rows) refused(farm_words + words, "farm: " + why);
    refused("--build build --folder farm -- " + picture, "farm: -o FILE");
    refused("--build build -o a.pfm -- " + picture, "farm: --folder");
    refused(farm_words + "-o a.jpg -- " + picture, "a.jpg: must end in .png, .pfm or .hdr");
    refused("--build bin --folder farm -o a.pfm -- " + picture, "bin/penumbra: build it first");
    yard.script("build/penumbra", "echo 'a.scene:7: no such statement' >&2; exit 2\n");
    refused(farm_words + "-- " + picture, "a.scene:7: no such statement");
}

TEST_CASE("before anything is planned, penumbra is asked for a sample of a row") {
    const Yard yard;
    CHECK(yard.plan("--bands 3").status == 0);
    CHECK(yard.folder.read("told").starts_with("--size 8x6 --spp 1 --rows 0-0 --keep "));
    CHECK_FALSE(yard.folder.has("farm/check.film"));
    const std::string words = farm_words + "--bands 3 -- --size=8x6 --samples=5 a.scene";
    CHECK(yard.run("farm.sh plan " + words).status == 0);  // the same plan
}

TEST_CASE("the same plan is gone on with, another one is refused") {
    const Yard yard;
    CHECK(yard.plan("--bands 3").status == 0);
    CHECK(yard.plan("--bands 3").status == 0);
    const std::string before = yard.folder.read("farm/farm.plan");
    const Said said = yard.plan("--bands 2");
    CHECK(said.status == 2);
    CHECK(said.has("holds the parts of another picture"));
    CHECK(yard.folder.read("farm/farm.plan") == before);
}

TEST_CASE("a part is told its film, from which it goes on") {
    const Yard yard;
    CHECK(yard.plan("--bands 3 --seeds 5").status == 0);
    const std::string film = yard.folder / "farm/part-0007.film",
                      part = "--size 8x6 --spp 5 --rows 2-3 --seed 1 --threads 3 --keep " + film,
                      scene = " " + yard.folder / "a.scene" + "\n";
    fs::remove(yard.folder.path / "told");
    CHECK(yard.run("farm.sh part farm 7 3").status == 0);
    CHECK(yard.folder.has("told"));
    CHECK(yard.log("7") == "");
    CHECK(yard.run("farm.sh part farm 7 3").status == 0);
    CHECK(yard.log("7") == "farm: resuming from its film\n");
    // The plan has the folder's absolute path, while the script is called with a relative one.
    std::string told = yard.folder.read("told");
    for (size_t at; (at = told.find(" farm/")) != told.npos;)
        told.replace(at, 6, " " + yard.folder / "farm/");
    CHECK(told == part + scene + part + scene);
}

TEST_CASE(
    "parts that are not finished are named, with what they said last, and nothing is merged") {
    const Yard yard;
    CHECK(yard.plan("--bands 3").status == 0);
    for (const char* number : {"1", "2", "3"})
        CHECK(yard.run(std::string("farm.sh part farm ") + number).status == 0);
    yard.folder.write("farm/part-0002.film", "penumbra film 2\ncomplete no\n\ncomplete yes\n");
    yard.folder.write("farm/part-0002.log", "nothing yet\nthe lamp went out\n");
    const Said said = yard.run("farm.sh merge farm");
    CHECK(said.status == 1);
    CHECK(said.has("part-0002.film: not finished (--rows 2-3): the lamp went out"));
    CHECK(said.has("farm: 1 of 3 parts are missing"));
    CHECK_FALSE(said.has("part-0001"));
    CHECK_FALSE(yard.folder.has("merged"));
    CHECK(yard.run("farm.sh part farm 2").status == 0);
    CHECK(yard.run("farm.sh merge farm").status == 0);
    CHECK(yard.folder.read("merged") == "-o " + yard.folder / "a.pfm" +
                                            " farm/part-0001.film farm/part-0002.film "
                                            "farm/part-0003.film\n");
}

TEST_CASE("whoever stops a part stops penumbra, and waits until it has written its film") {
    const Yard yard;
    CHECK(yard.plan("").status == 0);
    yard.script("build/penumbra",
                "trap 'sleep .3; echo written >film; exit 143' TERM\n"
                "touch begun; for n in {1..400}; do sleep .05; done\n");
    const Said said = yard.run(
        "farm.sh part farm 1 & part=$!; until [ -e begun ]; do sleep .05; done; kill -TERM $part; "
        "wait $part");
    CHECK(said.status == 143);
    CHECK(yard.folder.has("film"));
    CHECK(yard.log("1").find("farm: stopping after signal TERM") != std::string::npos);
}

// ---- Signals and Slurm --------------------------------------------------------------------------

namespace {

struct Slurm : Yard {
    Slurm() {
        CHECK(plan("--bands 3").status == 0);
        script("bin/scontrol", "echo \"$@\" >>asked; exit 1\n");
        script("bin/squeue", "cat queue 2>/dev/null\n");
        script("bin/sbatch", "printf '%s\\n' \"$*\" >>submitted; wc -l <submitted\n");
    }
    // Runs part 2 on a node as job 77, and sends it a signal once it has begun.
    Said part(const std::string& penumbra, const std::string& variables,
              const std::string& signal = "") {
        script("build/penumbra", penumbra);
        fs::remove(folder.path / "asked");
        fs::remove(folder.path / "begun");
        const std::string tell =
            signal.empty() ? ""
                           : " & part=$!; until [ -e begun ]; do sleep .05; done; kill -" + signal +
                                 " $part; wait $part";
        return run("farm_slurm.sh part farm 2" + tell,
                   "SLURM_JOB_ID=77 SLURM_ARRAY_TASK_ID=2 " + variables);
    }
    bool queues_again() const {
        return folder.has("asked") && folder.read("asked") == "requeue 77\n";
    }
};
const std::string works =
    "trap 'exit 143' TERM; touch begun; for n in {1..400}; do sleep .05; done\n";

}  // namespace

TEST_CASE("a part queues again that its limit of time stops, or that is killed; no other does") {
    Slurm slurm;
    CHECK(slurm.part(works, "", "USR1").status == 143);
    CHECK(slurm.queues_again());
    // A cancelled part must not queue again for ever.
    CHECK(slurm.part(works, "", "TERM").status == 143);
    CHECK_FALSE(slurm.queues_again());
    const std::string killed = "kill -KILL $$\n";
    CHECK(slurm.part(killed, "").status == 137);
    CHECK(slurm.queues_again());
    CHECK(slurm.part(killed, "SLURM_RESTART_COUNT=1").status == 137);
    CHECK(slurm.queues_again());
    CHECK(slurm.part(killed, "SLURM_RESTART_COUNT=2").status == 137);
    CHECK_FALSE(slurm.queues_again());
    // Reaching a time limit is not a failure.
    CHECK(slurm.part(works, "SLURM_RESTART_COUNT=20", "USR1").status == 143);
    CHECK(slurm.queues_again());
    for (const int status : {0, 1, 2}) {
        CHECK(slurm.part("exit " + std::to_string(status) + "\n", "").status == status);
        CHECK_FALSE(slurm.queues_again());
    }
}

TEST_CASE(
    "an array of what is not finished, and behind it the merge, whatever becomes of the array") {
    Slurm slurm;
    CHECK(slurm.run("farm.sh part farm 2").status == 0);
    const std::string submit = "farm_slurm.sh " + farm_words +
                               "--bands 3 --cpus 4 --grace 30 --sbatch --qos=night -- " + picture;
    const Said said = slurm.run(submit);
    INFO(said.err);
    CHECK(said.status == 0);
    CHECK(said.out.starts_with("farm: job 1 renders parts 1,3, job 2 merges: "));
    const std::string submitted = slurm.folder.read("submitted"),
                      array = submitted.substr(0, submitted.find('\n')),
                      merge = submitted.substr(array.size() + 1);
    INFO(submitted);
    for (const char* word :
         {"--requeue", "--qos=night", "--array=1,3 ", "--cpus-per-task=4", "--signal=B:USR1@30"})
        CHECK(array.find(word) != array.npos);
    CHECK(merge.find("--dependency=afterany:1 ") != merge.npos);
    CHECK(merge.find("farm.sh merge ") != merge.npos);

    slurm.folder.write("queue", "1_3\n");
    const Said again = slurm.run(submit);
    CHECK(again.status == 2);
    CHECK(again.has("farm: job 1 is still running"));
    CHECK(slurm.folder.read("submitted") == submitted);
}

// ---- With the programs --------------------------------------------------------------------------

TEST_CASE("parts, one of them stopped in between, merge into the picture of one render") {
    const Folder folder;
    const char* suffix = std::getenv("PROGRAM_SUFFIX");
    for (const std::string program : {"penumbra", "merge"}) {
        const fs::path built = fs::absolute("build/" + program + (suffix ? suffix : ""));
        REQUIRE(fs::exists(built));
        fs::create_directories(folder.path / "build");
        fs::create_symlink(built, folder.path / "build" / program);
    }
    folder.write("a.scene",
                 "camera 0 0 5  0 0 0  40\ndiffuse grey .5 .5 .5\nlight lamp 9 9 9\n"
                 "quad -2 -1 -2  0 0 4  4 0 0  grey\nsphere 0 0 0  .5  lamp\n");
    const std::string script = "bash '" + fs::absolute("src/keep/farm.sh").string() + "' ",
                      words = "--size 24x18 --replications 2 --spp 600 a.scene";
    auto run = [&](const std::string& command) {
        const int status = std::system(
            ("cd '" + folder.path.string() + "' && { " + command + "; } >>out 2>>err").c_str());
        INFO(command << ": " << folder.read("err"));
        REQUIRE(status == 0);
    };
    run("build/penumbra --quiet -o whole.pfm " + words);
    run(script + "plan --build build --folder farm --bands 3 -o a.pfm -- " + words);
    run(script + "part farm 1 1; " + script + "part farm 2 1");
    run(script + "part farm 3 1 & part=$!; sleep .05; kill $part; wait $part || :");
    run(script + "part farm 3 1; " + script + "merge farm");
    CHECK(folder.same("a.pfm", "whole.pfm"));
}
