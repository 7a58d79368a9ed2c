// whole/refusals_test.cpp  refused input: one line of message, and no file touched
#include <sys/stat.h>

#include <set>

#include "app/options.h"
#include "app/refused_words.h"
#include "text/scene_file.h"
#include "whole/process.h"

namespace {

// The shortest form of every statement; material m is defined.
const Words shortest = parts_of(
    "size 8 4;camera 0 0 5 0 0 0 40;depth 3;samples 3;exposure 2;diffuse n .1 .2 .3;"
    "phong n .1 .2 .3 .4 .5 .6 7;mirror n .7 .8 .9;glass n 1.5;light n 1 2 3;"
    "pointlight 3 3 3 1 2 3;sphere 1 2 3 .5 m;triangle 0 0 0 1 0 0 0 1 0 m;"
    "quad 0 0 0 1 0 0 0 1 0 m;box 1 2 3 45 4 5 6 m");

// A whole scene around a statement, which is line 2.
std::string around(const std::string& statement) {
    return "diffuse m .5 .5 .5\n" + statement + "\n" +
           (statement.starts_with("camera") ? "" : camera) + "sphere 0 0 0 1 m\n";
}

bool is_number(const std::string& word) {
    return word.find_first_of("0123456789") == 0 || word.find_first_of(".-") == 0;
}

}  // namespace

TEST_CASE("a scene that is wrong is refused with its line, and no file is touched") {
    const std::string nul(1, '\0');
    // The mistakes are in the seventh line.
    const std::vector<Family> statements = {
        {"@", "spere 0 0 0 1 m", "unknown keyword 'spere' (did you mean 'sphere'?)"},
        {"@", "Quad 0 0 0 1 0 0 0 1 0 m", "unknown keyword 'Quad' (did you mean 'quad'?)"},
        {"@", "point_light 0 0 0 1 1 1", "unknown keyword 'point_light' (did you mean 'po"},
        {"@", "size: 8 4", "unknown keyword 'size:' (did you mean 'size'?)"},
        {"light k 1 1 1 @", "twosidd;x;k", "unknown material '@'"},
        {"light k 1 1 1 m twosided", "", "unknown word 'twosided'"},
        {"sphere 0 0 0 1 m\xc3\xa9", "", "unknown material 'm?\?'"},
        // Numbers outside the range of their quantity.
        {"sphere 0 0 0 @ m", "-1;0;-0.0", "radius must be positive, not '@'"},
        {"sphere 0 0 0 1e-200 l", "", "radius "},  // its square would vanish
        {"box @ 1 1 0 0 0 0 m", "0", "width must be positive, not '@'"},
        {"box 1 @ 1 0 0 0 0 m", "-2", "height must be positive, not '@'"},
        {"box 1 1 @ 0 0 0 0 m", "-1", "depth must be positive, not '@'"},
        {"exposure @", "0;-1", "exposure must be positive, not '@'"},
        {"glass g @", "0;-1.5", "index of refraction must be positive, not '@'"},
        {"depth @", "-1;1.5;1000001;99999999999999999999", "'@' is not a whole number"},
        {"diffuse n .5 @ .5", "-.1", "a colour must not be negative: '@'"},
        {"@", "phong n 0 0 0 0 0 -1 1;mirror n -1 0 0;light n 0 -1 0;pointlight 0 0 0 1 -1 1",
         "a colour must not be negative: '-1'"},
        {"@", "diffuse n .5 1.001 .5;mirror n 1 1 1.001;phong n .6 0 0 .401 0 0 5",
         "reflects more than it receives"},
        {"phong n .1 .1 .1 .1 .1 .1 @", "-1", "the exponent must not be negative"},
        {"phong n .1 .1 .1 .1 .1 .1 @", "1e20", "'@' is too large"},
        {"sphere 0 0 @ 1 m", "1e31", "'@' is too large"},
        // Materials, and statements that may occur only once.
        {"sphere 0 0 0 1 glas", "", "unknown material 'glas'\n"},
        {"triangle 0 0 0 1 0 0 0 1 0 x", "", "unknown material 'x'"},
        {"quad 0 0 0 1 0 0 0 1 0 M", "", "unknown material 'M'"},
        {"box 1 1 1 0 0 0 0 x", "", "unknown material 'x'"},
        {"@ m 1 1 1", "diffuse;light", "a second material 'm'"},
        {"mirror l 1 1 1", "", "a second material 'l'"},
        {"size 8 4", "", "a second size"},
    };
    const Refusal scenes[] = {
        {"", " no camera"},
        {"# nothing but words\n\n", " no camera"},
        {"size 8 4\ndiffuse m 1 1 1\n\nsphere 0 0 0 1 m\n# end\n", " no camera"},
        {camera, " empty scene"},
        {camera + "light l 1 1 1\npointlight 0 0 0 1 1 1\n", " empty scene"},
        {camera + "diffuse m 1 1 1\ntriangle 0 0 0 1 1 1 2 2 2 m\n", " empty scene"},
        {"camrea 0 0 5 0 0 0 40\n", "1: unknown keyword 'camrea' (did you mean 'camera'?)"},
        {"\r\n# c\r\n\r\n\t tringle\r\n",
         "4: unknown keyword 'tringle' (did you mean 'triangle'?)"},
        // Invalid characters and garbage.
        {"\x7f"
         "ELF\x02\x01\x01" +
             nul + nul + "\xff\xfe\n",
         "1: unknown keyword '?ELF"},
        {"\x89PNG\r\n\x1a\n" + nul + nul, "1: unknown keyword '?PNG'"},
        {nul, "1: unknown keyword '?'"},
        {pfm(1, 1, {1, 1, 1}), "1: unknown keyword 'PF'"},
        {std::string(1 << 20, 'x'), "1: unknown keyword 'xxx"},
        {"sphere" + std::string(1 << 20, ' ') + "1" + std::string(1 << 20, ' '), "1: too few"},
        {good + "diffuse grey 1 1 1\nsphere 0 0 0 1 gray\n",
         "8: unknown material 'gray' (did you mean 'grey'?)"},
        {"sphere 0 0 0 1 m\n" + good, "1: unknown material 'm'"},
        {good + "\n" + camera, "8: a second camera"},
        {good + "depth 1\ndepth 1\n", "8: a second depth"},
        {good + "exposure 1\nexposure 1\n", "8: a second exposure"},
    };
    const std::vector<Family> first_lines = {
        // Sizes are checked before memory is allocated.
        {"size @ 1000000", "1000000", "'@' is not a whole number from 1 to 65536"},
        {"size 65536 65536", "", "an image of 65536x65536 has more than 1073741824 pixels"},
        {"size 65536 16385", "", "an image of 65536x16385 has more than"},
        {"size @ 1", "65537;0", "'@' is not a whole number from 1 to 65536"},
        {"size 8 @", "-4;4.5;4294967297", "'@' is not a whole number from 1"},
        // Cameras that see nothing.
        {"camera 0 0 5 0 0 0 @", "0;180;-40", "field of view must be between 0 and 180"},
        {"camera @ 40", "0 5 0 0 0 0;3 -5 2 3 0 2;1 2 3 1 2 3",
         "the camera must look somewhere, and not along y"},
    };
    const Place place("");
    place.write("out/file.png", "old");
    place.write("out/file.pfm", "old");
    auto expect = [&](const std::string& scene, const std::string& why) {
        place.write("file.scene", scene);
        expect_refusal(place, "penumbra file.scene", "file.scene:" + why);
    };
    for (const auto& [statement, why] : members(statements)) expect(good + statement, "7: " + why);
    for (const auto& [line, why] : members(first_lines)) expect(line, "1: " + why);
    for (const auto& [scene, why] : scenes) expect(scene, why);
    place.write("file.scene", good);  // valid by itself
    place.render("");
    CHECK(place.read("out/file.pfm") != "old");
}

TEST_CASE("every statement is refused with a word too few or too many, or a number that is none") {
    const Place place("");
    auto expect = [&](const Words& statement, const std::string& why) {
        place.write("file.scene", around(Command(statement).line()));
        expect_refusal(place, "penumbra file.scene", "file.scene:2: " + why);
    };
    std::set<std::string> known, tried = {"mesh"};  // meshes are tested in obj_test.cpp
    for (const Statement& s : grammar) known.emplace(s.keyword);

    // words_test.cpp has all that is no number.
    const Refusal bad_numbers[] = {
        {"nan", "is not a number"}, {"inf", "is too large"}, {"1e999", "is too large"}};
    for (const std::string& text : shortest) {
        const Words words = split(text);
        const std::string& keyword = words[0];
        tried.insert(keyword);
        Place(around(text)).render("--size 2x2 --spp 1 -o a.pfm");

        expect({keyword}, "too few words (0): " + keyword);
        expect(Words(words.begin(), words.end() - 1), "too few words (");
        Words shorter = words;
        shorter.erase(shorter.begin() + 1);
        expect(shorter, "too few words (" + std::to_string(words.size() - 2) + "): " + keyword);
        Words longer = words;
        for (size_t extra = keyword == "light" ? 3 : 1; extra > 0; --extra) longer.push_back("m");
        expect(longer, "too many words (" + std::to_string(longer.size() - 1) + "): " + keyword);
        longer = words;
        longer.insert(longer.end() - 1, keyword == "light" ? 3 : 1, "1");
        expect(longer, "too many words (");

        const bool count = keyword == "size" || keyword == "depth" || keyword == "samples";
        for (size_t i = 1; i < words.size(); ++i)
            for (const auto& [number, why] : bad_numbers) {
                if (!is_number(words[i])) continue;
                Words wrong = words;
                wrong[i] = number;
                expect(wrong, "'" + number + "' " + (count ? "is not a whole number" : why));
            }
    }
    CHECK(tried == known);
}

TEST_CASE("an option that is wrong is refused, wherever it stands, and no file is touched") {
    const Place place(good);
    place.write("point.scene", good + "pointlight 0 3 0  1 1 1\n");
    place.write("out/file.png", "old");
    place.write("out/file.pfm", "old");
    place.write("old.pfm", "old");
    place.write("folder.png/a", "");
    place.write("built.scene", "mesh build/a.obj 1 0 0 0\n");
    const std::string long_name(1000, 'a');

    expect_refusals(
        place, "penumbra",
        {{"", "no scene given"},
         {"--spp 4", "no scene given"},
         {"''", "the scene's name is empty"},
         {"missing.scene", "missing.scene: cannot open: No such file or directory"},
         {"missing/file.scene", "missing/file.scene: cannot open: No such file or directory"},
         {"file.scene/file.scene", "file.scene/file.scene: cannot open: Not a directory"},
         {"built.scene", "built.scene:1: build/a.obj: not made yet: make build/a.obj"},
         {"out", "out: is a directory"},
         {".", ".: is a directory"},
         {long_name, long_name + ": cannot open: File name too long"},
         {"file.scene file.scene", "two scenes: 'file.scene' and 'file.scene'"},
         {"file.scene --quiet point.scene", "two scenes: 'file.scene' and 'point.scene'"},
         {"--light none point.scene", "point.scene:7: --light none: rays never hit a point light"},
         {"--help --bogus", "unknown option '--bogus'"},
         {"--help --spp 0", "--spp: '0' is not a whole number"}});

    for (const auto& [words, why] : members({
             {"-o missing/a.png", "", "missing/a.png: cannot write: No such file or directory"},
             {"-o file.scene/a.png", "", "file.scene/a.png: cannot write: Not a directory"},
             {"-o folder.png", "", "folder.png: is a directory"},
             {"-o @.pfm", long_name, "@.pfm: cannot write: File name too lo"},
             {"-o old.pfm -o missing/a.pfm", "", "missing/a.pfm: cannot write: "},
             {"--size 4x5 --pixel 4,0", "", "--pixel: outside the image"},
             {"--size 5x4 --pixel 0,4", "", "--pixel: outside the image"},
             {"--rows 1-4 -o a.pfm", "", "--rows: the picture has rows 0-3"},
             {"--size 65536x16384 --replications 1024 -o a.pfm", "",
              "65536x16384 pixels do not fit"},
         }))
        expect_refusal(place, "penumbra " + words + " file.scene", why);
    for (const auto& [words, why] : refused_words())
        expect_refusal(place, "penumbra " + words + " file.scene", why);

    // Each option without its value; with a wrong value before or after a right one.
    for (const std::string& row : parts_of(
             "-o a.png a.gif;--spp 1 0;--time 1 0;--light mis miss;--error 1% 100%;"
             "--replications adaptive 0;--rows 0-1 1;--keep a.film a;--depth 1 -1;--roulette 1 2;"
             "--seed 1 one;--threads 1 0;--size 2x2 2;--exposure 1 0;--direction bsdf brdf;"
             "--sampler halton haltan;--view depth dept;--pixel 1,1 1;--sample 1 -1")) {
        const Words words = split(row);
        const std::string &option = words[0], right = " " + words[1], wrong = " " + words[2];
        expect_refusals(place, "penumbra",
                        {{"file.scene " + option, option + ": needs a value"},
                         {option + wrong + " " + option + right + " file.scene", option + ": "},
                         {option + right + " file.scene " + option + wrong, option + ": "}});
    }

    const Place blocked(good);  // the default outputs cannot be written
    blocked.write("out", "not a directory");
    expect_refusal(blocked, "penumbra file.scene", "out: ");
    fs::remove(blocked.path / "out");
    expect_refusal(blocked, "penumbra --spp 0 file.scene", "--spp: ");
    CHECK_FALSE(blocked.has("out"));
    blocked.write("out/file.png/a", "");
    expect_refusal(blocked, "penumbra file.scene", "out/file.png: is a directory");
}

TEST_CASE("what is not a regular file is not read, and what cannot be read is told") {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    folder.write("a.scene", good + "mesh pipe 1 0 0 0 m\n");
    folder.write("b.scene", good + "mesh /dev/zero 1 0 0 0 m\n");
    expect_refusals(folder, "penumbra",
                    {{"pipe", "pipe: is not a regular file"},
                     {"/dev/zero", "/dev/zero: is not a regular file"},
                     {"a.scene", "a.scene:7: pipe: is not a regular file"},
                     {"b.scene", "b.scene:7: /dev/zero: is not a regular file"}});
    expect_refusal(folder, "compare pipe pipe", "pipe: is not a regular file");
    CHECK(expect_exit(folder, "penumbra /proc/self/mem", 1).err ==
          "/proc/self/mem: cannot read: Input/output error\n");
}

TEST_CASE("names of files reach the terminal without control characters, on one line") {
    const Folder folder;
    const std::string name = "a\x1b[2J\nb\x7f";
    const Words line = {"penumbra", name};
    expect_refusal(folder, line, "a?[2J?b?: cannot open: No such file");
    folder.write(name, "mesh c\x1b[2J 1 0 0 0\n");
    expect_refusal(folder, line, "a?[2J?b?:1: c?[2J: cannot open: No such file");
    expect_refusal(folder, line + Words{"-o", name + "/a.png"}, "a?[2J?b?:1: ");
    folder.write(name, good);
    const Outcome o = expect_success(folder, line + split("-o \x1b.pfm --spp 1"));
    CHECK(summary(o.err).scene == "a?[2J?b?");
    CHECK(contains(o.err, "\nwrote ?.pfm\n"));
}
