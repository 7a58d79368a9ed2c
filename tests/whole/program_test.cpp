// whole/program_test.cpp  the programs as their user meets them: refusals, files, Ctrl-C,
// determinism
#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <set>
#include <thread>

#include "app/options.h"
#include "base/program.h"
#include "film/image.h"
#include "world/scene_file.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// ---- A place to work, and programs to run there -------------------------------------------------

// A directory of its own, removed at the end.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "penumbra-program-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path); }

    void write(const std::string& name, const std::string& bytes) const {
        fs::create_directories((path / name).parent_path());
        std::ofstream(path / name, std::ios::binary) << bytes;
    }
    bool has(const std::string& name) const { return fs::exists(path / name); }
    std::string read(const std::string& name) const {
        REQUIRE(has(name));
        return read_file((path / name).string());
    }
    // Of two files; a failed CHECK prints no bytes.
    bool same(const std::string& a, const std::string& b) const { return read(a) == read(b); }
    Image image(const std::string& name) const { return read_pfm((path / name).string()); }
    // Everything that is there, with its bytes.
    std::map<std::string, std::string> all() const {
        std::map<std::string, std::string> found;
        for (const auto& entry : fs::recursive_directory_iterator(path))
            found[fs::relative(entry.path(), path).string()] =
                entry.is_directory() ? "a directory" : read_file(entry.path().string());
        return found;
    }
};

struct Outcome {
    int status = -1;  // of an exit
    int signal = 0;   // or what killed it
    std::string out, err;
};

// A program that runs in a folder, its stderr a pipe or a terminal.
class Process {
public:
    struct Setting {
        bool terminal = false;
        rlim_t largest_file = RLIM_INFINITY;
    };

    Process(const Folder& folder, const std::string& program, const Words& words, Setting setting) {
        const char* suffix = std::getenv("PROGRAM_SUFFIX");
        const std::string path = fs::absolute("build/" + program + (suffix ? suffix : "")).string();
        std::vector<char*> argv{const_cast<char*>(path.c_str())};
        for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
        argv.push_back(nullptr);

        int out[2], err[2];
        REQUIRE(::pipe2(out, O_CLOEXEC) == 0);
        if (setting.terminal) {
            err[0] = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
            REQUIRE(err[0] >= 0);
            REQUIRE(::grantpt(err[0]) == 0);
            REQUIRE(::unlockpt(err[0]) == 0);
            err[1] = ::open(::ptsname(err[0]), O_RDWR | O_NOCTTY | O_CLOEXEC);
            REQUIRE(err[1] >= 0);
            termios plain;  // without \n -> \r\n
            ::tcgetattr(err[1], &plain);
            plain.c_oflag &= ~tcflag_t(OPOST);
            ::tcsetattr(err[1], TCSANOW, &plain);
        } else {
            REQUIRE(::pipe2(err, O_CLOEXEC) == 0);
        }
        pid_ = ::fork();
        REQUIRE(pid_ >= 0);
        if (pid_ == 0) {
            std::signal(SIGINT, SIG_DFL);
            const rlimit limit{setting.largest_file, setting.largest_file};
            if (setting.largest_file != RLIM_INFINITY) {
                std::signal(SIGXFSZ, SIG_IGN);
                ::setrlimit(RLIMIT_FSIZE, &limit);
            }
            if (::chdir(folder.path.c_str()) == 0 && ::dup2(out[1], 1) == 1 &&
                ::dup2(err[1], 2) == 2)
                ::execv(path.c_str(), argv.data());
            ::_exit(127);
        }
        ::close(out[1]);
        ::close(err[1]);
        from_ = {out[0], err[0]};
    }
    Process(const Folder& folder, const std::string& program, const Words& words)
        : Process(folder, program, words, Setting()) {}
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        for (int fd : from_) ::close(fd);
    }

    // Reads what the program prints, until it is enough (true) or for so many seconds, or all that
    // will ever come (false).
    template <class Enough>
    bool listen(double seconds, Enough enough) {
        using clock = std::chrono::steady_clock;
        const auto end = clock::now() + std::chrono::duration<double>(seconds);
        while (!enough(outcome_)) {
            pollfd fds[] = {{open_[0] ? from_[0] : -1, POLLIN, 0},
                            {open_[1] ? from_[1] : -1, POLLIN, 0}};
            const auto left =
                std::chrono::duration_cast<std::chrono::milliseconds>(end - clock::now());
            if (ended() || left.count() <= 0) return false;
            ::poll(fds, 2, int(left.count()) + 1);
            for (size_t i = 0; i < 2; ++i) {
                if (fds[i].revents == 0) continue;
                char buffer[4096];
                const ssize_t n = ::read(from_[i], buffer, sizeof buffer);
                open_[i] = n > 0;
                if (n > 0) (i == 0 ? outcome_.out : outcome_.err).append(buffer, size_t(n));
            }
        }
        return true;
    }

    bool ended() const { return !open_[0] && !open_[1]; }
    void interrupt() const { ::kill(pid_, SIGINT); }

    // Waits for its end; kills it after a minute.
    Outcome finish() {
        listen(60, [](const Outcome&) { return false; });
        if (!ended()) ::kill(pid_, SIGKILL);
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = 0;
        if (WIFEXITED(status)) outcome_.status = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) outcome_.signal = WTERMSIG(status);
        return outcome_;
    }

private:
    pid_t pid_ = 0;
    std::array<int, 2> from_{-1, -1};  // its stdout and stderr
    std::array<bool, 2> open_{true, true};
    Outcome outcome_;
};

Outcome run(const Folder& folder, const std::string& program, const Words& words) {
    return Process(folder, program, words).finish();
}

bool terminal_to_be_had() {
    const int trial = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (trial >= 0) ::close(trial);
    return trial >= 0;
}

// "--spp 1 ''" is three words, the last of them empty.
Words split(const std::string& line) {
    Words words;
    std::istringstream in(line);
    for (std::string word; in >> word;) words.push_back(word == "''" ? "" : word);
    return words;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

// ---- What to expect of a run --------------------------------------------------------------------

// Refused: exit status 2, one printable line that says why, and not a file made, changed or left.
void expect_refusal(const Folder& folder, const std::string& program, const Words& words,
                    const std::string& why) {
    const auto before = folder.all();
    const Outcome o = run(folder, program, words);
    std::string line;
    for (const std::string& word : words) line.append(" ").append(word, 0, 100);
    INFO(program, line, "\nexpected: ", why, "\nstderr:   ", o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 2);
    CHECK(o.out == "");
    CHECK(o.err.starts_with(why));
    CHECK(o.err.size() < 300 + why.size());
    const bool printable = std::all_of(o.err.begin(), o.err.end(),
                                       [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); });
    CHECK(printable);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK(o.err.back() == '\n');
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}

// Done: exit status 0.
Outcome expect_success(const Folder& folder, const std::string& program, const Words& words) {
    const Outcome o = run(folder, program, words);
    std::string line;
    for (const std::string& word : words) line.append(" ").append(word);
    INFO(program, line, "\nstderr: ", o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 0);
    CHECK(o.out == "");
    return o;
}

bool all_finite(const Image& image) {
    for (const auto& pixel : image.pixels)
        for (float channel : pixel)
            if (!std::isfinite(channel)) return false;
    return !image.pixels.empty();
}

struct Summary {
    std::string scene;
    unsigned long long samples = 0, non_finite = 1;
    double seconds = -1, speed = -1;
    bool interrupted = false, found = false;
};

// Of the last line.
Summary summary(const std::string& err) {
    Summary s;
    if (!err.ends_with('\n')) return s;
    const size_t start = err.find_last_of("\n\r", err.size() - 2) + 1, name = err.find(": ", start);
    if (name == err.npos) return s;
    s.scene = err.substr(start, name - start);
    int end = 0;
    const std::string rest = err.substr(name);
    const int read =
        std::sscanf(rest.c_str(), ": %llu samples per pixel, %lf s, %lf Mrays/s, %llu non-finite%n",
                    &s.samples, &s.seconds, &s.speed, &s.non_finite, &end);
    s.interrupted = contains(rest, "(interrupted)");
    s.found = read == 4 && (rest.substr(size_t(end)) == "\n" || s.interrupted);
    return s;
}

// ---- Scenes -------------------------------------------------------------------------------------

const std::string camera = "camera 0 0 5  0 0 0  40\n";
const std::string good = "size 8 4\n" + camera +
                         "diffuse m .5 .5 .5\n"
                         "light l 1 1 1\n"
                         "sphere 0 0 0  1  m\n"
                         "sphere 0 5 0  1  l\n";  // six lines

// A closed box of mirrors, no light: a path ends only with the scene's depth.
std::string hall_of_mirrors(const std::string& size, int depth) {
    return "size " + size + "\n" + camera + "depth " + std::to_string(depth) +
           "\nmirror m 1 1 1\nbox 20 20 20  7  -10 -10 -10  m\n";
}

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

std::string pfm(int width, int height, const std::vector<float>& from_top_left) {
    std::string bytes = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    const size_t row = 3 * size_t(width);
    for (size_t y = size_t(height); y-- > 0;)
        bytes.append(reinterpret_cast<const char*>(from_top_left.data() + y * row),
                     row * sizeof(float));
    return bytes;
}

}  // namespace

// ---- Refused ------------------------------------------------------------------------------------

TEST_CASE("a scene that is wrong is refused with its line, and no file is touched") {
    const std::string nul(1, '\0');
    const std::pair<std::string, std::string> rows[] = {
        // Nothing, or not enough.
        {"", "1: no camera"},
        {"# nothing but words\n\n", "1: no camera"},
        {"size 8 4\ndiffuse m 1 1 1\n\nsphere 0 0 0 1 m\n# end\n", "4: no camera"},
        {camera, "1: empty scene"},
        {camera + "light l 1 1 1\npointlight 0 0 0 1 1 1\n", "3: empty scene"},
        {camera + "diffuse m 1 1 1\ntriangle 0 0 0 1 1 1 2 2 2 m\n", "3: empty scene"},
        // Unknown words.
        {good + "spere 0 0 0 1 m\n", "7: unknown keyword 'spere' (did you mean 'sphere'?)"},
        {"camrea 0 0 5 0 0 0 40\n", "1: unknown keyword 'camrea' (did you mean 'camera'?)"},
        {good + "Quad 0 0 0 1 0 0 0 1 0 m\n", "7: unknown keyword 'Quad' (did you mean 'quad'?)"},
        {good + "point_light 0 0 0 1 1 1\n", "7: unknown keyword 'point_light' (did you mean 'po"},
        {good + "size: 8 4\n", "7: unknown keyword 'size:' (did you mean 'size'?)"},
        {"\r\n# c\r\n\r\n\t tringle\r\n",
         "4: unknown keyword 'tringle' (did you mean 'triangle'?)"},
        {good + "light k 1 1 1 twosidd\n", "7: undefined material 'twosidd'"},
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
         "7: undefined material 'm?"
         "?'"},
        // Numbers that are not what they measure.
        {good + "sphere 0 0 0 -1 m\n", "7: radius must be positive, not -1"},
        {good + "sphere 0 0 0 0 m\n", "7: radius must be positive, not 0"},
        {good + "sphere 0 0 0 -0.0 m\n", "7: radius must be positive, not -0.0"},
        {good + "sphere 0 0 0 1e-200 l\n", "7: radius "},  // its square would vanish
        {good + "box 0 1 1 0 0 0 0 m\n", "7: width must be positive, not 0"},
        {good + "box 1 -2 1 0 0 0 0 m\n", "7: height must be positive, not -2"},
        {good + "box 1 1 -1 0 0 0 0 m\n", "7: depth must be positive, not -1"},
        {good + "exposure 0\n", "7: exposure must be positive, not 0"},
        {good + "exposure -1\n", "7: exposure must be positive, not -1"},
        {good + "glass g 0\n", "7: index of refraction must be positive, not 0"},
        {good + "glass g -1.5\n", "7: index of refraction must be positive, not -1.5"},
        {good + "depth -1\n", "7: '-1' is not a whole number"},
        {good + "depth 1.5\n", "7: '1.5' is not a whole number"},
        {good + "depth 1000001\n", "7: '1000001' is not a whole number"},
        {good + "depth 99999999999999999999\n", "7: '99999999999999999999' is not a whole number"},
        {good + "diffuse n .5 -.1 .5\n", "7: a colour must not be negative: -.1"},
        {good + "phong n 0 0 0 0 0 -1 1\n", "7: a colour must not be negative: -1"},
        {good + "mirror n -1 0 0\n", "7: a colour must not be negative: -1"},
        {good + "light n 0 -1 0\n", "7: a colour must not be negative: -1"},
        {good + "pointlight 0 0 0 1 -1 1\n", "7: a colour must not be negative: -1"},
        {good + "diffuse n .5 1.001 .5\n", "7: reflects more than it receives"},
        {good + "mirror n 1 1 1.001\n", "7: reflects more than it receives"},
        {good + "phong n .6 0 0 .401 0 0 5\n", "7: reflects more than it receives"},
        {good + "phong n .1 .1 .1 .1 .1 .1 -1\n", "7: the exponent must not be negative"},
        {good + "phong n .1 .1 .1 .1 .1 .1 1e20\n", "7: '1e20' is too large"},
        {good + "sphere 0 0 1e31 1 m\n", "7: '1e31' is too large"},
        // Sizes, before anything is allocated.
        {"size 1000000 1000000\n" + camera, "1: '1000000' is not a whole number from 1 to 65536"},
        {"size 65536 65536\n" + camera, "1: an image of 65536x65536 has more than 33554432 pixels"},
        {"size 8192 4097\n" + camera, "1: an image of 8192x4097 has more than"},
        {"size 65537 1\n" + camera, "1: '65537' is not a whole number from 1 to 65536"},
        {"size 0 4\n" + camera, "1: '0' is not a whole number from 1"},
        {"size 8 -4\n" + camera, "1: '-4' is not a whole number from 1"},
        {"size 8 4.5\n" + camera, "1: '4.5' is not a whole number from 1"},
        {"size 8 4294967297\n" + camera, "1: '4294967297' is not a whole number from 1"},
        // Materials.
        {good + "sphere 0 0 0 1 glas\n", "7: undefined material 'glas'"},
        {good + "triangle 0 0 0 1 0 0 0 1 0 x\n", "7: undefined material 'x'"},
        {good + "quad 0 0 0 1 0 0 0 1 0 M\n", "7: undefined material 'M'"},
        {good + "box 1 1 1 0 0 0 0 x\n", "7: undefined material 'x'"},
        {good + "light k 1 1 1 x\n", "7: undefined material 'x'"},
        {good + "light k 1 1 1 k\n", "7: undefined material 'k'"},
        {"sphere 0 0 0 1 m\n" + good, "1: undefined material 'm'"},
        {good + "diffuse m 1 1 1\n", "7: a second material 'm'"},
        {good + "mirror l 1 1 1\n", "7: a second material 'l'"},
        {good + "light m 1 1 1\n", "7: a second material 'm'"},
        // What stands only once.
        {good + "\n" + camera, "8: a second camera, after line 2"},
        {good + "size 8 4\n", "7: a second size, after line 1"},
        {good + "depth 1\ndepth 1\n", "8: a second depth, after line 7"},
        {good + "exposure 1\nexposure 1\n", "8: a second exposure, after line 7"},
        // Cameras that see nothing.
        {"camera 0 0 5 0 0 0 0\n", "1: field of view must be between 0 and 180"},
        {"camera 0 0 5 0 0 0 180\n", "1: field of view must be between 0 and 180"},
        {"camera 0 0 5 0 0 0 -40\n", "1: field of view must be between 0 and 180"},
        {"camera 0 5 0 0 0 0 40\n", "1: the camera must look somewhere, and not along y"},
        {"camera 3 -5 2 3 0 2 40\n", "1: the camera must look somewhere, and not along y"},
        {"camera 1 2 3 1 2 3 40\n", "1: the camera must look somewhere, and not along y"},
        {good + "sphere 1 0 5 3 l\nsphere 9 9 9 1 m\n",
         "7: the camera is inside this sphere light"},
        {good + "sphere 0 0 3 2 l\n", "7: the camera is inside this sphere light"},  // on it
        {"light l 1 1 1 twosided\nsphere 0 0 5 1 l\n" + camera,
         "2: the camera is inside this sphere light"},
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
        {"--light none point.scene", "--light none: "},
        // Unknown words.
        {"--sp 4 file.scene", "unknown option '--sp' (did you mean '--spp'?)"},
        {"--deph 4 file.scene", "unknown option '--deph' (did you mean '--depth'?)"},
        {"--thread 4 file.scene", "unknown option '--thread' (did you mean '--threads'?)"},
        {"--ligth mis file.scene", "unknown option '--ligth' (did you mean '--light'?)"},
        {"--spp=4 file.scene", "unknown option '--spp=4' (did you mean '--spp'?)"},
        {"-h", "unknown option '-h'"},
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
        {"--direct ratio file.scene", "--direct ratio: needs --light nee"},
        {"--direct control --light none file.scene", "--direct control: needs --light nee"},
        {"--light mis --direct regression file.scene", "--direct regression: needs --light nee"},
        {"--light nee --direct rato file.scene", "--direct: unknown value 'rato' (did you mean 'r"},
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
        {"--size 65536x65536 file.scene", "--size: an image of 65536x65536 has more than 33554432"},
        {"--size 8192x4097 file.scene", "--size: an image of 8192x4097 has more than"},
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
                                               {"--roulette", 1},
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
    rows.push_back({"--roulette 4294967297 file.scene", "--roulette: '4294967297' is not a whole"});
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
    rows.push_back({"--size 4x4 --pixel 4,0 file.scene", "--pixel: outside the image"});
    rows.push_back({"--pixel 1,2,3 file.scene", "--pixel: '2,3' is not a whole number"});

    // Every option: without its value; wrong, though a right one follows or goes before.
    const std::map<std::string, std::pair<std::string, std::string>> right_and_wrong = {
        {"-o", {"a.png", "a.gif"}},
        {"--spp", {"1", "0"}},
        {"--time", {"1", "0"}},
        {"--light", {"mis", "miss"}},
        {"--direct", {"stochastic", "stochastc"}},
        {"--polygons", {"angle", "angel"}},
        {"--depth", {"1", "-1"}},
        {"--roulette", {"1", "0"}},
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

// ---- Accepted -----------------------------------------------------------------------------------

TEST_CASE("odd scenes are accepted: every pixel is finite, and what is dropped is counted") {
    const std::string in_the_plane = "quad 0 0 0 1 2 3 2 4 6 m\n";
    struct Row {
        std::string scene, options, warning;
        int width, height;
    };
    const Row rows[] = {
        {good, "", "", 8, 4},
        {good + "triangle 0 0 0 1 1 1 2 2 2 m\n", "", "1 triangle without area was dropped", 8, 4},
        {good + "triangle 1 2 3 1 2 3 1 2 3 m\n" + in_the_plane + "triangle 0 0 0 1 0 0 1 0 0 l\n",
         "", "4 triangles without area were dropped", 8, 4},
        {good + "quad 0 0 0 0 0 0 0 1 0 l\n", "", "2 triangles without area were dropped", 8, 4},
        {camera + "size 8 4\ndiffuse m 1 1 1\nsphere 0 0 0 1 m\n", "",
         "no light: all will be black", 8, 4},
        {camera + "size 1 1\nlight l 1 1 1\nsphere 0 0 0 1 l\n", "", "", 1, 1},
        {camera + "size 16384 1\nlight l 1 1 1\nsphere 0 0 0 1 l\n", "", "", 16384, 1},
        {camera + "size 1 16384\nlight l 1 1 1\nsphere 0 0 0 1 l\n", "", "", 1, 16384},
        {good, "--size 1x1", "", 1, 1},
        {good, "--size 16384x1", "", 16384, 1},
        {good, "--size 3x5", "", 3, 5},
        // Inside a ball that is no light, inside a box of light, and a turned one: coplanar points.
        {good + "glass g 1.5\nsphere 0 0 5 1 g\n", "", "", 8, 4},
        {good + "box 1 1 1 0 -.5 -.5 4.5 l\n", "", "", 8, 4},
        {camera +
             "size 8 4\ndiffuse m .5 .5 .5\nlight l 1 1 1 twosided m\nbox 9 9 9 30 -7 -4 -4 l\n",
         "--spp 200", "", 8, 4},
        {camera +
             "size 8 4\ndiffuse m .5 .5 .5\nlight l 1 1 1 twosided m\nbox 9 9 9 30 -7 -4 -4 l\n",
         "--spp 200 --light nee --direction uniform", "", 8, 4},
        // Extremes of every number.
        {good + "phong p .5 .5 .5 .5 .5 .5 1e6\nphong q 0 0 0 1 1 1 0\nsphere 1 0 0 1 p\n"
                "sphere -1 0 0 1 q\n",
         "--spp 200", "", 8, 4},
        {good + "glass g 1\nglass h 1e-3\nglass i 1e3\nsphere 1 0 0 1 g\nsphere -1 0 0 1 h\n"
                "sphere 0 1 0 1 i\n",
         "--spp 200", "", 8, 4},
        {good + "sphere 0 -1e8 0 99999999 m\nsphere 1 2 1 1e-8 l\n", "", "", 8, 4},
        {good + "depth 0\nexposure 1e-30\n", "", "", 8, 4},
        {good + "depth 1000000\nexposure 1e30\n", "", "", 8, 4},
        {good, "--depth 0 --exposure 1e-30 --seed 18446744073709551615 --threads 1024", "", 8, 4},
        {good, "--depth 1000000 --exposure 1e30 --seed 0 --threads 1 --roulette 1", "", 8, 4},
        {good, "--spp 3 --time 1e30 --roulette 1000000", "", 8, 4},
        {good, "--spp 1099511627776 --time 1e-9", "", 8, 4},
        {good, "--light none --direction uniform", "", 8, 4},
        {good, "--light none --light nee --direction uniform --direction bsdf", "", 8, 4},
    };
    for (const Row& row : rows) {
        const Folder folder;
        folder.write("file.scene", row.scene);
        INFO(row.scene, row.options);
        const Outcome o = expect_success(
            folder, "penumbra", split("--spp 8 " + row.options + " -o a.pfm -o a.png file.scene"));
        const Image image = folder.image("a.pfm");
        CHECK(image.width == row.width);
        CHECK(image.height == row.height);
        CHECK(all_finite(image));
        CHECK(summary(o.err).found);
        CHECK(summary(o.err).non_finite == 0);
        const std::string warning = "file.scene: warning: " + row.warning + "\n";
        CHECK(contains(o.err, row.warning.empty() ? "warning" : warning) == !row.warning.empty());
        CHECK(folder.all().size() == 3);
    }
}

TEST_CASE("a scene's meaning does not depend on its line ends, comments, blanks or name") {
    auto replaced = [](std::string text, const std::string& what, const std::string& by) {
        for (size_t i = 0; (i = text.find(what, i)) != text.npos; i += by.size())
            text.replace(i, what.size(), by);
        return text;
    };
    const Folder folder;
    folder.write("good.scene", good);
    expect_success(folder, "penumbra", split("--spp 2 -o good.pfm good.scene"));
    const std::string scenes[] = {
        replaced(good, "\n", "\r\n"),
        replaced(good, " ", "\t"),
        replaced(good, "\n", "# comment with 'words' 1 2 3\n\n  # another\n"),
        replaced(good, "\n", "   \n\n\n\t"),
        good.substr(0, good.size() - 1),
        replaced(good, ".5", "+5e-1"),
        "# sphere\n" + good + "# size 3 3\n#",
        good + "light other 3 3 3\n",  // nothing is made of it
    };
    for (const std::string& scene : scenes)
        for (const std::string name :
             {"a.scene", "a folder/a scene's \"name\" .scene", "--/a", "a"}) {
            INFO(name, ":\n", scene);
            folder.write(name, scene);
            const Words words{"--spp", "2", "-o", "an image.pfm", "./" + name};
            expect_success(folder, "penumbra", words);
            CHECK(folder.same("an image.pfm", "good.pfm"));
            fs::remove(folder.path / "an image.pfm");
        }
}

// ---- Behaviour ----------------------------------------------------------------------------------

TEST_CASE("--help names every option on one page of stdout") {
    const Folder folder;
    for (const char* line : {"--help", "--help file.scene", "--spp 3 --quiet --help"}) {
        const Outcome o = run(folder, "penumbra", split(line));
        CHECK(o.status == 0);
        CHECK(o.err == "");
        for (const char* word : {"penumbra [options] SCENE",
                                 "-o FILE",
                                 "--spp N",
                                 "--time S",
                                 "uniform|bsdf",
                                 "--direction",
                                 "--light none|nee|mis",
                                 "--direct stochastic|control|ratio|regression",
                                 "--polygons area|angle",
                                 "--film mc|vor|fvor|cvor|torus",
                                 "--depth N",
                                 "--roulette K",
                                 "--seed N",
                                 "--threads N",
                                 "--size WxH",
                                 "--exposure E",
                                 "--quiet",
                                 "--help",
                                 ".png",
                                 ".pfm"}) {
            INFO(std::string(word));
            CHECK(contains(o.out, word));
        }
        CHECK(o.out.ends_with("\n"));
        CHECK(std::count(o.out.begin(), o.out.end(), '\n') <= 60);
        std::istringstream lines(o.out);
        for (std::string text; std::getline(lines, text);) CHECK(text.size() <= 80);
    }
    CHECK(folder.all().empty());
}

TEST_CASE("--quiet prints nothing, but errors") {
    const Folder folder;
    folder.write("file.scene", good + "triangle 0 0 0 1 1 1 2 2 2 m\n");
    const Outcome o = expect_success(folder, "penumbra", split("--quiet --spp 2 file.scene"));
    CHECK(o.err == "");
    expect_refusal(folder, "penumbra", split("--quiet --spp 0 file.scene"), "--spp: '0'");
    folder.write("bad.scene", "x");
    expect_refusal(folder, "penumbra", split("--quiet bad.scene"), "bad.scene:1: unknown keyword");
}

TEST_CASE("without -o the images are out/NAME.png and out/NAME.pfm; with it, those alone") {
    const Folder folder;
    folder.write("deep/down/my.first scene.scene", good);
    expect_success(folder, "penumbra", {"--spp", "2", "deep/down/my.first scene.scene"});
    CHECK(folder.has("out/my.first scene.png"));
    CHECK(folder.has("out/my.first scene.pfm"));
    CHECK(folder.all().size() == 6);  // with three directories

    const Folder other;
    other.write("file.scene", good);
    expect_success(other, "penumbra",
                   split("-o a.pfm -o b.png --spp 2 -o c.pfm -o a.pfm file.scene -o d.png"));
    CHECK(other.all().size() == 5);
    CHECK(other.same("a.pfm", "c.pfm"));
    CHECK(other.same("b.png", "d.png"));
    other.write("default.pfm", folder.read("out/my.first scene.pfm"));
    other.write("default.png", folder.read("out/my.first scene.png"));
    CHECK(other.same("a.pfm", "default.pfm"));
    CHECK(other.same("b.png", "default.png"));
    CHECK(other.read("a.pfm").starts_with("PF\n8 4\n"));
    CHECK(other.read("b.png").starts_with("\x89PNG"));
}

TEST_CASE("the summary is one line: samples, seconds, Mrays/s, non-finite") {
    const Folder folder;
    folder.write("file.scene", good);
    for (const auto& [options, samples] : std::map<std::string, unsigned>{
             {"", 64}, {"--spp 7", 7}, {"--spp 9 --spp 7 --time 1e6", 7}}) {
        const Outcome o = expect_success(folder, "penumbra", split(options + " file.scene"));
        INFO(o.err);
        const Summary s = summary(o.err);
        REQUIRE(s.found);
        CHECK(s.scene == "file.scene");
        CHECK(s.samples == samples);
        CHECK(s.seconds >= 0);
        CHECK(s.speed > 0);
        CHECK(s.non_finite == 0);
        CHECK_FALSE(s.interrupted);
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    }
}

TEST_CASE("--time stops before --spp is reached; 64 samples are meant only if neither is given") {
    const Folder folder;
    folder.write("file.scene", good);
    const Outcome o =
        expect_success(folder, "penumbra", split("--spp 1000000000 --time 0.1 file.scene"));
    CHECK(summary(o.err).samples > 0);
    CHECK(summary(o.err).samples < 1000000000);
    folder.write("few.scene", good + "samples 3\n");
    CHECK(summary(expect_success(folder, "penumbra", {"few.scene"}).err).samples == 3);
    CHECK(summary(expect_success(folder, "penumbra", split("--spp 5 few.scene")).err).samples == 5);
    const Outcome timed = expect_success(folder, "penumbra", split("--time 0.2 few.scene"));
    CHECK(summary(timed.err).samples > 3);
}

TEST_CASE("--exposure changes the PNG, by the command line before the scene, and never the PFM") {
    const Folder folder;
    folder.write("a.scene",
                 camera + "size 4 4\nlight l .18 .18 .18\nsphere 0 0 0 4 l\nexposure 2\n");
    const std::pair<std::string, int> rows[] = {
        {"", 162}, {"--exposure 1", 118}, {"--exposure 9", 255}};
    for (const auto& [options, byte] : rows) {
        expect_success(folder, "penumbra", split(options + " -o a.png -o a.pfm a.scene"));
        CHECK(folder.image("a.pfm").at(2, 2) == std::array<float, 3>{.18f, .18f, .18f});
        const std::string png = folder.read("a.png");
        int w = 0, h = 0, n = 0;
        stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                                                int(png.size()), &w, &h, &n, 3);
        REQUIRE(pixels != nullptr);
        CHECK(int(pixels[0]) == byte);
        stbi_image_free(pixels);
    }
}

TEST_CASE("on a terminal a bar shows time elapsed and time left, and goes; --quiet: no bar") {
    if (!terminal_to_be_had()) {
        MESSAGE("this machine lends no pseudo-terminal: not tested");
        return;
    }
    const Folder folder;
    folder.write("file.scene", good);
    Process loud(folder, "penumbra", split("--spp 1000000000 --time 0.5 --threads 1 file.scene"),
                 {.terminal = true});
    const Outcome o = loud.finish();
    INFO(o.err);
    CHECK(o.status == 0);
    for (const char* part :
         {"\r[", "###", "...]", " samples per pixel, ", " s elapsed, ", " s left"})
        CHECK(contains(o.err, part));
    const size_t erased = o.err.rfind("\r\033[K");
    REQUIRE(erased != o.err.npos);
    CHECK(o.err.find("file.scene: ", erased) == erased + 4);
    CHECK(summary(o.err).samples > 0);

    Process quiet(folder, "penumbra", split("--quiet --time 0.25 --threads 1 file.scene"),
                  {.terminal = true});
    CHECK(quiet.finish().err == "");
}

TEST_CASE("a sample that no image can hold: exit status 1, told where, nothing written") {
    // A lamp of 1e30 at 1e-6 of a quad that just fills pixel 2,1: 1e41, too much for float.
    const Folder folder;
    folder.write(
        "file.scene",
        "size 3 2\ncamera 0 0 3.2e-6  0 0 0  3.579821\ndiffuse m .5 .5 .5\n"
        "quad .5e-7 -1e-7 0  1e-7 0 0  0 1e-7 0  m\npointlight 1e-7 0 1e-6 1e30 1e30 1e30\n");
    folder.write("out/file.pfm", "old");
    for (const char* options : {"", "--threads 3", "--quiet"}) {
        const auto before = folder.all();
        const Outcome o = run(folder, "penumbra", split(std::string(options) + " file.scene"));
        INFO(o.err);
        CHECK(o.signal == 0);
        CHECK(o.status == 1);
        CHECK(contains(o.err, " not finite, the first at pixel 2,1 sample 0"));
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
        const bool untouched = folder.all() == before;
        CHECK(untouched);
    }
}

TEST_CASE("a disk that fills up: exit status 1, and the old image is whole") {
    const Folder folder;
    folder.write("file.scene", good);
    folder.write("a.pfm", "old");
    const auto before = folder.all();
    Process process(folder, "penumbra", split("--size 64x64 --spp 1 -o a.pfm file.scene"),
                    {.largest_file = 4096});
    const Outcome o = process.finish();
    CHECK(o.signal == 0);
    CHECK(o.status == 1);
    CHECK(contains(o.err, "a.pfm: cannot write: "));
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}

// ---- Ctrl-C -------------------------------------------------------------------------------------

TEST_CASE("Ctrl-C writes the passes completed so far, with their true sample count") {
    const Folder folder;
    folder.write("file.scene", good + "quad -9 -1 -9  0 0 18  18 0 0  m\n");
    Outcome o;
    // A busy machine may not have begun: then again, with more patience.
    for (double patience = 0.25; patience < 20 && !folder.has("a.pfm"); patience *= 3) {
        Process process(folder, "penumbra",
                        split("--spp 1000000000 --size 33x17 -o a.pfm -o a.png file.scene"));
        process.listen(patience, [](const Outcome&) { return false; });
        process.interrupt();
        o = process.finish();
    }
    INFO(o.err);
    CHECK(o.signal == 0);
    CHECK(o.status == 130);
    CHECK(folder.all().size() == 3);
    const Summary s = summary(o.err);
    REQUIRE(s.found);
    CHECK(s.interrupted);
    REQUIRE(s.samples > 0);
    CHECK(s.samples < 1000000000);
    // A run that was asked for as many gives the same image, bit by bit.
    expect_success(folder, "penumbra",
                   {"--spp", std::to_string(s.samples), "--size", "33x17", "-o", "b.pfm", "-o",
                    "b.png", "file.scene"});
    CHECK(folder.same("a.pfm", "b.pfm"));
    CHECK(folder.same("a.png", "b.png"));
}

TEST_CASE("Ctrl-C before the first pass is complete leaves no file; where no terminal is, no bar") {
    const Folder folder;
    folder.write("file.scene", hall_of_mirrors("64 4096", 5000));  // minutes a pass, 50 ms a row
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
    folder.write("file.scene", hall_of_mirrors("1000 1", 1000000));  // minutes a row
    const auto before = folder.all();
    auto never = [](const Outcome&) { return false; };
    Outcome o;
    double seconds = 0;
    // A busy machine may not have begun the row: then again, with more patience.
    for (double patience = 0.1; patience < 20 && o.signal == 0; patience *= 3) {
        Process process(folder, "penumbra", split("-o a.pfm file.scene"));
        process.listen(patience, never);
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < 50 && !process.ended(); ++i) {  // signals that follow too soon are one
            process.interrupt();
            process.listen(0.02, never);
        }
        o = process.finish();
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        CHECK(contains(o.err, "no light"));
    }
    CHECK(o.signal == SIGINT);
    CHECK(seconds < 10);
    const bool untouched = folder.all() == before;
    CHECK(untouched);
}

// ---- Determinism --------------------------------------------------------------------------------

TEST_CASE("an image depends on the seed, and not on threads, passes or the run") {
    const Folder folder;
    folder.write("file.scene",
                 good +
                     "phong p .2 .2 .2 .5 .5 .5 20\nglass g 1.5\nquad -9 -1 -9  0 0 18  18 0 0  p\n"
                     "sphere 1 0 1 .5 g\npointlight 2 3 3  5 5 5\n");
    auto image = [&](const std::string& options) {
        expect_success(folder, "penumbra",
                       split("--spp 5 --size 33x17 " + options + " -o a.pfm -o a.png file.scene"));
        return folder.read("a.pfm") + folder.read("a.png");
    };
    const std::string one = image("--threads 1");
    for (const char* options : {"--threads 1", "--threads 2", "--threads 3", "--threads 7",
                                "--threads 100", "", "--seed 0", "--time 1e6", "--quiet"}) {
        INFO(std::string(options));
        const bool same = image(options) == one;
        CHECK(same);
    }
    const std::string ratio = image("--light nee --direct ratio --threads 1");
    for (const char* options : {"--threads 3", "--time 1e6"}) {
        const bool same = image(std::string("--light nee --direct ratio ") + options) == ratio;
        CHECK(same);
    }
    std::set<std::string> different{one, ratio};
    for (const char* options :
         {"--seed 1", "--seed 2", "--seed 18446744073709551615", "--spp 6", "--spp 4",
          "--light nee", "--direction uniform", "--depth 1", "--light nee --direct control",
          "--light nee --direct regression --spp 8"})
        different.insert(image(options));
    CHECK(different.size() == 12);
}

// ---- compare ------------------------------------------------------------------------------------

namespace {

struct Comparison {
    double d = -1, d_rel = -1, ratio = -1, largest = -1;
    int x = -1, y = -1;
    bool found = false;
};

Comparison compare(const Folder& folder, const Words& words) {
    const Outcome o = run(folder, "compare", words);
    INFO(o.err);
    CHECK(o.status == 0);
    CHECK(o.err == "");
    Comparison c;
    int end = 0;
    const int read = std::sscanf(
        o.out.c_str(), "d: %lf\nd_rel: %lf\nratio of means: %lf\nlargest error: %lf at %d,%d\n%n",
        &c.d, &c.d_rel, &c.ratio, &c.largest, &c.x, &c.y, &end);
    c.found = read == 6 && size_t(end) == o.out.size();
    return c;
}

}  // namespace

TEST_CASE("compare: d, d_rel, ratio of means, largest error and where, as by hand") {
    const Folder folder;
    std::vector<float> f{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, g = f;
    g[5] = 8;  // +2 at the top right, pixel 1,0
    g[7] = 3;  // -5 at the bottom left, pixel 0,1
    folder.write("f.pfm", pfm(2, 2, f));
    folder.write("g.pfm", pfm(2, 2, g));
    // Sums: 78 and 75, squares of f: 650, of g: 623, squares of the errors: 29.
    const Comparison c = compare(folder, {"f.pfm", "g.pfm"});
    REQUIRE(c.found);
    CHECK(c.d == doctest::Approx(std::sqrt(29 / 12.0)).epsilon(1e-5));
    CHECK(c.d_rel == doctest::Approx(std::sqrt(29 / 650.0)).epsilon(1e-5));
    CHECK(c.ratio == doctest::Approx(75 / 78.0).epsilon(1e-5));
    CHECK(c.largest == 5);
    CHECK(c.x == 0);
    CHECK(c.y == 1);
    const Comparison back = compare(folder, {"g.pfm", "f.pfm"});  // the other is the reference
    REQUIRE(back.found);
    CHECK(back.d == c.d);
    CHECK(back.d_rel == doctest::Approx(std::sqrt(29 / 623.0)).epsilon(1e-5));
    CHECK(back.ratio == doctest::Approx(78 / 75.0).epsilon(1e-5));
    const Comparison same = compare(folder, {"f.pfm", "f.pfm"});
    REQUIRE(same.found);
    CHECK(same.d == 0);
    CHECK(same.d_rel == 0);
    CHECK(same.ratio == 1);
    CHECK(same.largest == 0);
    CHECK(folder.all().size() == 2);
}

TEST_CASE(
    "compare: the heat map is black where images agree, and brighter where they differ more") {
    const Folder folder;
    std::vector<float> f(18, 1.0f), g = f;
    for (size_t c = 0; c < 3; ++c) {
        g[3 * 2 + c] += 1;  // pixel 2,0
        g[3 * 3 + c] -= 4;  // pixel 0,1
    }
    folder.write("f.pfm", pfm(3, 2, f));
    folder.write("g.pfm", pfm(3, 2, g));
    for (bool differ : {true, false}) {
        compare(folder, {"f.pfm", "--heatmap", "map.png", differ ? "g.pfm" : "f.pfm"});
        const std::string png = folder.read("map.png");
        int w = 0, h = 0, n = 0;
        stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                                                int(png.size()), &w, &h, &n, 3);
        REQUIRE(pixels != nullptr);
        REQUIRE(w == 3);
        REQUIRE(h == 2);
        auto brightness = [&](int i) {
            return pixels[3 * i] + pixels[3 * i + 1] + pixels[3 * i + 2];
        };
        for (int i : {0, 1, 4, 5}) CHECK(brightness(i) == 0);
        CHECK((brightness(2) > 0) == differ);
        CHECK((brightness(3) > brightness(2)) == differ);
        stbi_image_free(pixels);
    }
}

TEST_CASE("compare: two images with their variances show the same, or not") {
    const Folder folder;
    folder.write("f.pfm", pfm(2, 1, {1, 2, 3, 4, 5, 6}));
    folder.write("g.pfm", pfm(2, 1, {1, 2, 3, 4, 8, 6}));  // green sums up to 3 more
    folder.write("none.pfm", pfm(2, 1, {0, 0, 0, 0, 0, 0}));
    folder.write("v.pfm", pfm(2, 1, {1, 1, 1, 1, 1.25f, 1}));
    auto verdict = [&](const std::string& words) {
        const Outcome o = run(folder, "compare", split(words));
        CHECK(o.status == 0);
        double sigmas = -1, p = -1;
        const size_t at = o.out.find("equal means:");
        REQUIRE(at != o.out.npos);
        CHECK(std::sscanf(o.out.c_str() + at, "equal means: %lf sigma, p = %lf", &sigmas, &p) == 2);
        return std::pair{sigmas, p};
    };
    // Variance of the difference 2 x 2.25: 3 / sqrt(4.5) = 1.41 sigma, p = .1573 of one channel.
    const auto [sigmas, p] = verdict("--variances v.pfm v.pfm f.pfm g.pfm");
    CHECK(sigmas == 1.41);
    CHECK(p == 0.47);
    CHECK(verdict("g.pfm f.pfm --variances none.pfm v.pfm") == std::pair{-2.0, 0.14});
    CHECK(verdict("f.pfm f.pfm --variances none.pfm none.pfm") == std::pair{0.0, 1.0});
    CHECK(verdict("f.pfm g.pfm --variances none.pfm none.pfm").second == 0);
    // Renders: another seed shows the same, another depth does not.
    const std::string scene =
        "camera 0 1 5 0 0 0 60\ndiffuse grey 0.5 0.5 0.5\nlight lamp 9 9 9\n"
        "quad -5 0 -5 0 0 10 10 0 0 grey\nsphere 0 3 0 1 lamp\nsphere 1 0.5 1 0.5 grey\n";
    folder.write("a.scene", scene);
    const std::string options = "--quiet --size 32x16 --spp 64 --sampler independent ";
    for (const auto& [name, more] :
         {std::pair{"a", "--seed 1"}, {"b", "--seed 2"}, {"c", "--depth 0"}}) {
        std::string line = options;
        line.append(more).append(" a.scene -o ").append(name);
        std::string image = line, variance = line;
        expect_success(folder, "penumbra", split(image.append(".pfm")));
        expect_success(folder, "penumbra", split(variance.append("v.pfm --view variance")));
    }
    CHECK(verdict("a.pfm b.pfm --variances av.pfm bv.pfm").second > 1e-6);
    CHECK(verdict("a.pfm c.pfm --variances av.pfm cv.pfm").second < 1e-6);
}

TEST_CASE("compare: images that cannot be compared are refused, and nothing is written") {
    const Folder folder;
    const std::string one = pfm(1, 1, {1, 1, 1});
    folder.write("one.pfm", one);
    folder.write("two.pfm", pfm(2, 1, {1, 1, 1, 1, 1, 1}));
    folder.write("high.pfm", pfm(1, 2, {1, 1, 1, 1, 1, 1}));
    folder.write("nan.pfm", pfm(2, 1, {1, 1, 1, 1, NAN, 1}));
    folder.write("inf.pfm", pfm(1, 2, {1, 1, 1, 1, 1, -INFINITY}));
    folder.write("cut.pfm", one.substr(0, one.size() - 1));
    folder.write("head.pfm", "PF\n1 1\n");
    folder.write("last.pfm", "PF\n1 1\n-1.00");  // 12 bytes, as many as a pixel
    folder.write("long.pfm", one + "x");
    folder.write("empty.pfm", "");
    folder.write("text.pfm", "a picture\n");
    folder.write("big.pfm", "PF\n1 1\n1.0\n" + one.substr(12));  // big-endian
    folder.write("huge.pfm", "PF\n1000000 1000000\n-1.0\n");
    folder.write("minus.pfm", pfm(1, 1, {1, -1, 1}));
    const std::string not_pfm = ": not a little-endian colour PFM file",
                      usage_line = "usage: compare";
    const std::pair<std::string, std::string> rows[] = {
        {"", usage_line},
        {"one.pfm", usage_line},
        {"one.pfm one.pfm one.pfm", usage_line},
        {"one.pfm two.pfm", "sizes differ: 1x1 and 2x1"},
        {"two.pfm high.pfm", "sizes differ: 2x1 and 1x2"},
        {"one.pfm missing.pfm", "missing.pfm: cannot open: No such file or directory"},
        {"missing.pfm one.pfm", "missing.pfm: cannot open: No such file or directory"},
        {"one.pfm .", ".: is a directory"},
        {"two.pfm nan.pfm", "nan.pfm: pixel 1,0 is not finite"},
        {"nan.pfm two.pfm", "nan.pfm: pixel 1,0 is not finite"},
        {"high.pfm inf.pfm", "inf.pfm: pixel 0,1 is not finite"},
        {"one.pfm cut.pfm", "cut.pfm: 1x1 pixels do not fill the file"},
        {"long.pfm one.pfm", "long.pfm: 1x1 pixels do not fill the file"},
        {"one.pfm head.pfm", "head.pfm" + not_pfm},
        {"last.pfm last.pfm", "last.pfm" + not_pfm},
        {"one.pfm empty.pfm", "empty.pfm" + not_pfm},
        {"one.pfm text.pfm", "text.pfm" + not_pfm},
        {"one.pfm big.pfm", "big.pfm" + not_pfm},
        {"one.pfm huge.pfm", "huge.pfm: '1000000' is not a whole number from 1 to 65536"},
        {"one.pfm one.pfm --heatmap", "--heatmap: needs a value"},
        {"one.pfm one.pfm --heatmap a.pfm", "--heatmap: not a .png file: a.pfm"},
        {"one.pfm one.pfm --heatmap missing/a.png", "missing/a.png: cannot write: No such file"},
        {"one.pfm two.pfm --heatmap a.png", "sizes differ"},
        {"two.pfm nan.pfm --heatmap a.png", "nan.pfm: pixel 1,0 is not finite"},
        {"one.pfm one.pfm --variances one.pfm", "--variances: needs two files"},
        {"one.pfm one.pfm --variances one.pfm two.pfm", "sizes differ: 1x1 and 2x1"},
        {"one.pfm one.pfm --variances one.pfm minus.pfm", "minus.pfm: a variance is negative"},
        {"two.pfm two.pfm --variances two.pfm nan.pfm", "nan.pfm: pixel 1,0 is not finite"},
        {"one.pfm one.pfm --heat a.png", "unknown option '--heat' (did you mean '--heatmap'?)"},
    };
    for (const auto& [line, why] : rows) expect_refusal(folder, "compare", split(line), why);
}

TEST_CASE("a program that another runs: its failure, or that it is not there, is an error") {
    execute({"/bin/sh", "-c", "test \"$0\" = word", "word"});
    auto what = [](std::vector<std::string> words) -> std::string {
        try {
            execute(words);
        } catch (const SystemError& e) {
            return e.what();
        }
        return "";
    };
    CHECK(what({"/bin/sh", "-c", "exit 3"}) == "/bin/sh failed: exit status 3");
    CHECK(what({"/bin/sh", "-c", "kill -9 $$"}) == "/bin/sh failed: killed by signal 9");
    CHECK(what({"/nowhere"}).starts_with("/nowhere: cannot run: "));
    CHECK(exit_status([] { return 7; }) == 7);
}
