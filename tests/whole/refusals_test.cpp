// whole/refusals_test.cpp  what is refused, in one line, with no file touched
#include <sys/stat.h>

#include <set>

#include "app/options.h"
#include "whole/process.h"
#include "world/scene_file.h"

namespace {

// The shortest form of every statement; material m is there.
const std::map<std::string, std::string> shortest = {
    {"size", "size 8 4"},
    {"camera", "camera 0 0 5 0 0 0 40"},
    {"depth", "depth 3"},
    {"samples", "samples 3"},
    {"exposure", "exposure 2"},
    {"diffuse", "diffuse n .1 .2 .3"},
    {"phong", "phong n .1 .2 .3 .4 .5 .6 7"},
    {"mirror", "mirror n .7 .8 .9"},
    {"glass", "glass n 1.5"},
    {"light", "light n 1 2 3"},
    {"pointlight", "pointlight 3 3 3 1 2 3"},
    {"sphere", "sphere 1 2 3 .5 m"},
    {"triangle", "triangle 0 0 0 1 0 0 0 1 0 m"},
    {"quad", "quad 0 0 0 1 0 0 0 1 0 m"},
    {"box", "box 1 2 3 45 4 5 6 m"},
};

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
    const std::pair<std::string, std::string> rows[] = {
        // Nothing, or not enough.
        {"", " no camera"},
        {"# nothing but words\n\n", " no camera"},
        {"size 8 4\ndiffuse m 1 1 1\n\nsphere 0 0 0 1 m\n# end\n", " no camera"},
        {camera, " empty scene"},
        {camera + "light l 1 1 1\npointlight 0 0 0 1 1 1\n", " empty scene"},
        {camera + "diffuse m 1 1 1\ntriangle 0 0 0 1 1 1 2 2 2 m\n", " empty scene"},
        // Unknown words.
        {good + "spere 0 0 0 1 m\n", "7: unknown keyword 'spere' (did you mean 'sphere'?)"},
        {"camrea 0 0 5 0 0 0 40\n", "1: unknown keyword 'camrea' (did you mean 'camera'?)"},
        {good + "Quad 0 0 0 1 0 0 0 1 0 m\n", "7: unknown keyword 'Quad' (did you mean 'quad'?)"},
        {good + "point_light 0 0 0 1 1 1\n", "7: unknown keyword 'point_light' (did you mean 'po"},
        {good + "size: 8 4\n", "7: unknown keyword 'size:' (did you mean 'size'?)"},
        {"\r\n# c\r\n\r\n\t tringle\r\n",
         "4: unknown keyword 'tringle' (did you mean 'triangle'?)"},
        {good + "light k 1 1 1 twosidd\n", "7: unknown material 'twosidd'"},
        {good + "light k 1 1 1 m twosided\n", "7: unknown word 'twosided'"},
        // Rubbish.
        {"\x7f"
         "ELF\x02\x01\x01" +
             nul + nul + "\xff\xfe\n",
         "1: unknown keyword '?ELF"},
        {"\x89PNG\r\n\x1a\n" + nul + nul, "1: unknown keyword '?PNG'"},
        {nul, "1: unknown keyword '?'"},
        {pfm(1, 1, {1, 1, 1}), "1: unknown keyword 'PF'"},
        {std::string(1 << 20, 'x'), "1: unknown keyword 'xxx"},
        {"sphere" + std::string(1 << 20, ' ') + "1" + std::string(1 << 20, ' '), "1: too few"},
        {good + "sphere 0 0 0 1 m\xc3\xa9\n",
         "7: unknown material 'm?"
         "?'"},
        // Numbers that are not what they measure.
        {good + "sphere 0 0 0 -1 m\n", "7: radius must be positive, not '-1'"},
        {good + "sphere 0 0 0 0 m\n", "7: radius must be positive, not '0'"},
        {good + "sphere 0 0 0 -0.0 m\n", "7: radius must be positive, not '-0.0'"},
        {good + "sphere 0 0 0 1e-200 l\n", "7: radius "},  // its square would vanish
        {good + "box 0 1 1 0 0 0 0 m\n", "7: width must be positive, not '0'"},
        {good + "box 1 -2 1 0 0 0 0 m\n", "7: height must be positive, not '-2'"},
        {good + "box 1 1 -1 0 0 0 0 m\n", "7: depth must be positive, not '-1'"},
        {good + "exposure 0\n", "7: exposure must be positive, not '0'"},
        {good + "exposure -1\n", "7: exposure must be positive, not '-1'"},
        {good + "glass g 0\n", "7: index of refraction must be positive, not '0'"},
        {good + "glass g -1.5\n", "7: index of refraction must be positive, not '-1.5'"},
        {good + "depth -1\n", "7: '-1' is not a whole number"},
        {good + "depth 1.5\n", "7: '1.5' is not a whole number"},
        {good + "depth 1000001\n", "7: '1000001' is not a whole number"},
        {good + "depth 99999999999999999999\n", "7: '99999999999999999999' is not a whole number"},
        {good + "diffuse n .5 -.1 .5\n", "7: a colour must not be negative: '-.1'"},
        {good + "phong n 0 0 0 0 0 -1 1\n", "7: a colour must not be negative: '-1'"},
        {good + "mirror n -1 0 0\n", "7: a colour must not be negative: '-1'"},
        {good + "light n 0 -1 0\n", "7: a colour must not be negative: '-1'"},
        {good + "pointlight 0 0 0 1 -1 1\n", "7: a colour must not be negative: '-1'"},
        {good + "diffuse n .5 1.001 .5\n", "7: reflects more than it receives"},
        {good + "mirror n 1 1 1.001\n", "7: reflects more than it receives"},
        {good + "phong n .6 0 0 .401 0 0 5\n", "7: reflects more than it receives"},
        {good + "phong n .1 .1 .1 .1 .1 .1 -1\n", "7: the exponent must not be negative"},
        {good + "phong n .1 .1 .1 .1 .1 .1 1e20\n", "7: '1e20' is too large"},
        {good + "sphere 0 0 1e31 1 m\n", "7: '1e31' is too large"},
        // Sizes, before anything is allocated.
        {"size 1000000 1000000\n" + camera, "1: '1000000' is not a whole number from 1 to 65536"},
        {"size 65536 65536\n" + camera,
         "1: an image of 65536x65536 has more than 1073741824 pixels"},
        {"size 65536 16385\n" + camera, "1: an image of 65536x16385 has more than"},
        {"size 65537 1\n" + camera, "1: '65537' is not a whole number from 1 to 65536"},
        {"size 0 4\n" + camera, "1: '0' is not a whole number from 1"},
        {"size 8 -4\n" + camera, "1: '-4' is not a whole number from 1"},
        {"size 8 4.5\n" + camera, "1: '4.5' is not a whole number from 1"},
        {"size 8 4294967297\n" + camera, "1: '4294967297' is not a whole number from 1"},
        // Materials.
        {good + "sphere 0 0 0 1 glas\n", "7: unknown material 'glas'\n"},
        {good + "diffuse grey 1 1 1\nsphere 0 0 0 1 gray\n",
         "8: unknown material 'gray' (did you mean 'grey'?)"},
        {good + "triangle 0 0 0 1 0 0 0 1 0 x\n", "7: unknown material 'x'"},
        {good + "quad 0 0 0 1 0 0 0 1 0 M\n", "7: unknown material 'M'"},
        {good + "box 1 1 1 0 0 0 0 x\n", "7: unknown material 'x'"},
        {good + "light k 1 1 1 x\n", "7: unknown material 'x'"},
        {good + "light k 1 1 1 k\n", "7: unknown material 'k'"},
        {"sphere 0 0 0 1 m\n" + good, "1: unknown material 'm'"},
        {good + "diffuse m 1 1 1\n", "7: a second material 'm'"},
        {good + "mirror l 1 1 1\n", "7: a second material 'l'"},
        {good + "light m 1 1 1\n", "7: a second material 'm'"},
        // What stands only once.
        {good + "\n" + camera, "8: a second camera"},
        {good + "size 8 4\n", "7: a second size"},
        {good + "depth 1\ndepth 1\n", "8: a second depth"},
        {good + "exposure 1\nexposure 1\n", "8: a second exposure"},
        // Cameras that see nothing.
        {"camera 0 0 5 0 0 0 0\n", "1: field of view must be between 0 and 180"},
        {"camera 0 0 5 0 0 0 180\n", "1: field of view must be between 0 and 180"},
        {"camera 0 0 5 0 0 0 -40\n", "1: field of view must be between 0 and 180"},
        {"camera 0 5 0 0 0 0 40\n", "1: the camera must look somewhere, and not along y"},
        {"camera 3 -5 2 3 0 2 40\n", "1: the camera must look somewhere, and not along y"},
        {"camera 1 2 3 1 2 3 40\n", "1: the camera must look somewhere, and not along y"},
    };
    const Folder folder;
    folder.write("out/file.png", "old");
    folder.write("out/file.pfm", "old");
    for (const auto& [scene, why] : rows) {
        folder.write("file.scene", scene);
        expect_refusal(folder, "penumbra", {"file.scene"}, "file.scene:" + why);
    }
    folder.write("file.scene", good);  // which is not wrong itself
    expect_success(folder, "penumbra", {"file.scene"});
    CHECK(folder.read("out/file.pfm") != "old");
}

TEST_CASE("every statement is refused with a word too few or too many, or a number that is none") {
    const Folder folder;
    auto expect = [&](const Words& statement, const std::string& why) {
        std::string line;
        for (const std::string& word : statement) line.append(word).append(" ");
        folder.write("file.scene", around(line));
        expect_refusal(folder, "penumbra", {"file.scene"}, "file.scene:2: " + why);
    };
    std::set<std::string> known;
    for (const Statement& s : grammar) known.emplace(s.keyword);
    known.erase("mesh");  // in obj_test.cpp
    CHECK(known.size() == shortest.size());

    const std::vector<std::pair<std::string, std::string>> bad_numbers = {
        {"nan", "is not finite"},      {"inf", "is not finite"},    {"1e999", "is out of range"},
        {"1.0x", "is not a number"},   {"-inf", "is not finite"},   {"-1e999", "is out of range"},
        {"one", "is not a number"},    {"0x10", "is not a number"}, {"1,5", "is not a number"},
        {"--1", "is not a number"},    {"+-1", "is not a number"},  {"1e", "is not a number"},
        {"++1", "is not a number"},    {"1e31", "is too large"},    {"-", "is not a number"},
        {"infinity", "is not finite"}, {"NAN", "is not finite"},    {"1.5.2", "is not a number"}};
    size_t other = 3;
    for (const auto& [keyword, text] : shortest) {
        CHECK(known.contains(keyword));
        const Words words = split(text);
        folder.write("file.scene", around(text));
        expect_success(folder, "penumbra", split("--size 2x2 --spp 1 -o a.pfm file.scene"));
        fs::remove(folder.path / "a.pfm");

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

        // The first three everywhere, of the others one.
        for (size_t i = 1; i < words.size(); ++i) {
            if (!is_number(words[i])) continue;
            other = other + 1 < bad_numbers.size() ? other + 1 : 3;
            for (size_t k : {size_t(0), size_t(1), size_t(2), other}) {
                const auto& [number, why] = bad_numbers[k];
                Words wrong = words;
                wrong[i] = number;
                const bool count = keyword == "size" || keyword == "depth" || keyword == "samples";
                expect(wrong, "'" + number + "' " + (count ? "is not a whole number" : why));
            }
        }
    }
}

TEST_CASE("an option that is wrong is refused, wherever it stands, and no file is touched") {
    const Folder folder;
    folder.write("file.scene", good);
    folder.write("point.scene", good + "pointlight 0 3 0  1 1 1\n");
    folder.write("out/file.png", "old");
    folder.write("out/file.pfm", "old");
    folder.write("old.pfm", "old");
    folder.write("folder.png/a", "");
    const std::string long_name(1000, 'a');

    std::vector<std::pair<std::string, std::string>> rows = {
        // The scene.
        {"", "no scene given"},
        {"--spp 4", "no scene given"},
        {"''", "the scene's name is empty"},
        {"missing.scene", "missing.scene: cannot open: No such file or directory"},
        {"missing/file.scene", "missing/file.scene: cannot open: No such file or directory"},
        {"file.scene/file.scene", "file.scene/file.scene: cannot open: Not a directory"},
        {"out", "out: is a directory"},
        {".", ".: is a directory"},
        {long_name, long_name + ": cannot open: File name too long"},
        {"file.scene file.scene", "two scenes: 'file.scene' and 'file.scene'"},
        {"file.scene --quiet point.scene", "two scenes: 'file.scene' and 'point.scene'"},
        {"--light none point.scene", "point.scene:7: --light none: rays never hit a point light"},
        // Unknown words.
        {"--sp 4 file.scene", "unknown option '--sp' (did you mean '--spp'?)"},
        {"--deph 4 file.scene", "unknown option '--deph' (did you mean '--depth'?)"},
        {"--thread 4 file.scene", "unknown option '--thread' (did you mean '--threads'?)"},
        {"--ligth mis file.scene", "unknown option '--ligth' (did you mean '--light'?)"},
        {"--spp=4 file.scene", "unknown option '--spp=4' (did you mean '--spp'?)"},
        {"-x", "unknown option '-x' (did you mean '-o'?)"},
        {"-O a.png file.scene", "unknown option '-O' (did you mean '-o'?)"},
        {"- file.scene", "unknown option '-'"},
        {"file.scene --quiett", "unknown option '--quiett' (did you mean '--quiet'?)"},
        {"--help --bogus", "unknown option '--bogus'"},
        {"--help --spp 0", "--spp: '0' is not a whole number"},
        {"--light nope file.scene", "--light: unknown value 'nope' (did you mean 'none'?)"},
        {"--light MIS file.scene", "--light: unknown value 'MIS'"},
        {"--light '' file.scene", "--light: unknown value ''"},
        {"--direction bdsf file.scene", "--direction: unknown value 'bdsf' (did you mean 'bsdf'?)"},
        {"--direction unifrom file.scene", "--direction: unknown value 'unifrom' (did you mean 'u"},
        // Outputs.
        {"-o missing/a.png file.scene", "missing/a.png: cannot write: No such file or directory"},
        {"-o file.scene/a.png file.scene", "file.scene/a.png: cannot write: Not a directory"},
        {"-o folder.png file.scene", "folder.png: is a directory"},
        {"-o " + long_name + ".pfm file.scene", long_name + ".pfm: cannot write: File name too lo"},
        {"-o old.pfm -o missing/a.pfm file.scene", "missing/a.pfm: cannot write: "},
        {"-o a.jpg file.scene", "-o: 'a.jpg' ends neither in .png nor in .pfm"},
        {"-o a.PNG file.scene", "-o: 'a.PNG' ends neither in .png nor in .pfm"},
        {"-o a file.scene", "-o: 'a' ends neither in .png nor in .pfm"},
        {"-o '' file.scene", "-o: '' ends neither in .png nor in .pfm"},
        {"-o a.txt -o a.png file.scene", "-o: 'a.txt' ends neither"},
        {"-o a.png -o a.txt file.scene", "-o: 'a.txt' ends neither"},
        // Sizes.
        {"--size 1000000x1000000 file.scene", "--size: '1000000' is not a whole number from 1 to"},
        {"--size 65536x65536 file.scene",
         "--size: an image of 65536x65536 has more than 1073741824"},
        {"--size 65536x16385 file.scene", "--size: an image of 65536x16385 has more than"},
        {"--size 65537x1 file.scene", "--size: '65537' is not a whole number"},
        {"--size 4 file.scene", "--size: '4' is not WIDTHxHEIGHT"},
        {"--size 4*4 file.scene", "--size: '4*4' is not WIDTHxHEIGHT"},
        {"--size '' file.scene", "--size: '' is not WIDTHxHEIGHT"},
    };
    for (const char* size : {"0x4", "4x0", "-1x4", "4x-1", "x4", "4x", "x", "4x4x4", "4.0x4", "4X4",
                             "0x10x4", "4x1e1", "nanx4", "99999999999999999999x1"})
        rows.push_back({"--size " + std::string(size) + " file.scene", "--size: '"});

    const std::map<std::string, int> counts = {// and the least of each
                                               {"--spp", 1},
                                               {"--depth", 0},
                                               {"--seed", 0},
                                               {"--threads", 1}};
    for (auto [option, least] : counts)
        for (const std::string value : {"0", "-1", "many", "1.5", "''", "1e3", "0x10", "+1", "1x",
                                        "nan", "inf", "99999999999999999999999"})
            if (value != "0" || least > 0)
                rows.push_back(
                    {option + " " + value + " file.scene",
                     option + ": '" + (value == "''" ? "" : value) + "' is not a whole"});
    rows.push_back(
        {"--threads 1025 file.scene", "--threads: '1025' is not a whole number from 1 to"});
    rows.push_back(
        {"--seed 18446744073709551616 file.scene", "--seed: '18446744073709551616' is n"});
    rows.push_back(
        {"--depth 4294967296 file.scene", "--depth: '4294967296' is not a whole number"});
    rows.push_back({"--roulette 1.1 file.scene", "--roulette: '1.1' is more than 100 %"});
    rows.push_back({"--roulette -0.1 file.scene", "--roulette: '-0.1' is negative"});
    rows.push_back(
        {"--spp 18446744073709551615 file.scene", "--spp: '18446744073709551615' is no"});

    const std::pair<std::string, std::string> amounts[] = {
        {"0", "is not positive"},    {"-1", "is not positive"},    {"nan", "is not finite"},
        {"inf", "is not finite"},    {"1e999", "is out of range"}, {"1e31", "is too large"},
        {"soon", "is not a number"}, {"1.0x", "is not a number"},  {"0x1p3", "is not a number"},
        {"''", "is not a number"},   {"+-1", "is not a number"},   {"1s", "is not a number"}};
    for (const std::string option : {"--time", "--exposure"})
        for (const auto& [value, why] : amounts)
            rows.push_back({option + " " + value + " file.scene",
                            option + ": '" + (value == "''" ? "" : value) + "' " + why});

    rows.push_back({"--sample 1 file.scene", "--sample: goes with --pixel X,Y"});
    rows.push_back({"--size 4x5 --pixel 4,0 file.scene", "--pixel: outside the image"});
    rows.push_back({"--pixel 1,2,3 file.scene", "--pixel: '2,3' is not a whole number"});
    rows.push_back({"--size 5x4 --pixel 0,4 file.scene", "--pixel: outside the image"});
    rows.push_back({"--pixel 1,2 --keep a.film file.scene", "--keep: goes without --pixel"});
    rows.push_back({"--keep a.pfm file.scene", "--keep: 'a.pfm' does not end in .film"});
    rows.push_back({"--error 1% --sets 1 file.scene", "--error: needs --sets 2 or more, or adap"});
    rows.push_back({"--rows 1-2 file.scene", "--rows: needs --keep F.film, which build/merge"});
    rows.push_back({"--rows 1-4 -o a.pfm file.scene", "--rows: the picture has rows 0-3"});
    rows.push_back({"--rows 2 -o a.pfm file.scene", "--rows: '2' is not FIRST-LAST"});
    rows.push_back({"--rows 2-1 -o a.pfm file.scene", "--rows: '2-1' ends before it begins"});
    rows.push_back(
        {"--size 65536x16384 --sets 1024 -o a.pfm file.scene", "65536x16384 pixels do not fit"});

    // Every option: without its value; wrong, though a right one follows or goes before.
    const std::map<std::string, std::pair<std::string, std::string>> right_and_wrong = {
        {"-o", {"a.png", "a.gif"}},
        {"--spp", {"1", "0"}},
        {"--time", {"1", "0"}},
        {"--light", {"mis", "miss"}},
        {"--error", {"1%", "100%"}},
        {"--sets", {"adaptive", "0"}},
        {"--rows", {"0-1", "1"}},
        {"--keep", {"a.film", "a"}},
        {"--depth", {"1", "-1"}},
        {"--roulette", {"1", "2"}},
        {"--seed", {"1", "one"}},
        {"--threads", {"1", "0"}},
        {"--size", {"2x2", "2"}},
        {"--exposure", {"1", "0"}},
        {"--direction", {"bsdf", "brdf"}},
        {"--sampler", {"halton", "haltan"}},
        {"--view", {"depth", "dept"}},
        {"--pixel", {"1,1", "1"}},
        {"--sample", {"1", "-1"}}};
    for (const auto& [option, values] : right_and_wrong) {
        const auto& [right, wrong] = values;
        rows.push_back({"file.scene " + option, option + ": needs a value"});
        rows.push_back(
            {option + " " + wrong + " " + option + " " + right + " file.scene", option + ": "});
        rows.push_back(
            {option + " " + right + " file.scene " + option + " " + wrong, option + ": "});
    }
    for (const auto& [line, why] : rows) expect_refusal(folder, "penumbra", split(line), why);

    const Folder blocked;  // the default outputs have no place to go
    blocked.write("file.scene", good);
    blocked.write("out", "not a directory");
    expect_refusal(blocked, "penumbra", {"file.scene"}, "out: ");
    fs::remove(blocked.path / "out");
    expect_refusal(blocked, "penumbra", split("--spp 0 file.scene"), "--spp: ");
    CHECK_FALSE(blocked.has("out"));
    blocked.write("out/file.png/a", "");
    expect_refusal(blocked, "penumbra", {"file.scene"}, "out/file.png: is a directory");
}

TEST_CASE("what is no regular file is not read, and what cannot be read is told") {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    folder.write("a.scene", good + "mesh pipe 1 0 0 0 m\n");
    folder.write("b.scene", good + "mesh /dev/zero 1 0 0 0 m\n");
    const std::pair<std::string, std::string> rows[] = {
        {"pipe", "pipe: is no regular file"},
        {"/dev/zero", "/dev/zero: is no regular file"},
        {"a.scene", "a.scene:7: pipe: is no regular file"},
        {"b.scene", "b.scene:7: /dev/zero: is no regular file"}};
    for (const auto& [line, why] : rows) expect_refusal(folder, "penumbra", split(line), why);
    expect_refusal(folder, "compare", {"pipe", "pipe"}, "pipe: is no regular file");
    const Outcome o = run(folder, "penumbra", {"/proc/self/mem"});
    CHECK(o.status == 1);
    CHECK(o.err == "/proc/self/mem: cannot read: Input/output error\n");
}

TEST_CASE("names of files reach the terminal without control characters, on one line") {
    const Folder folder;
    const std::string name = "a\x1b[2J\nb\x7f";
    expect_refusal(folder, "penumbra", {name}, "a?[2J?b?: cannot open: No such file");
    folder.write(name, "mesh c\x1b[2J 1 0 0 0\n");
    expect_refusal(folder, "penumbra", {name}, "a?[2J?b?:1: c?[2J: cannot open: No such file");
    expect_refusal(folder, "penumbra", {"-o", name + "/a.png", name}, "a?[2J?b?:1: ");
    folder.write(name, good);
    const Outcome o = expect_success(folder, "penumbra", {"-o", "\x1b.pfm", "--spp", "1", name});
    CHECK(summary(o.err).scene == "a?[2J?b?");
    CHECK(contains(o.err, "\nwrote ?.pfm\n"));
}
