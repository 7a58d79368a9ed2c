// text/files_test.cpp  reading, atomic writing and naming of files
#include "text/files.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "base/system_calls.h"
#include "text/complaint.h"
#include "text/folder.h"

namespace {

std::string unread(const std::string& path, bool any_kind = false, size_t most = 1 << 30) {
    return complaint([&] { read_file(path, any_kind, most); });
}

pid_t dead_process() {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    ::waitpid(child, nullptr, 0);
    return child;
}

}  // namespace

TEST_CASE("a file is read to its end; an error on the way is none") {
    const Folder folder;
    const std::string bytes = std::string(200000, 'x') + '\0' + "end";
    folder.write("a", bytes);
    CHECK(read_file(folder / "a") == bytes);
    folder.write("empty", "");
    CHECK(read_file(folder / "empty") == "");
    // No memory is mapped at address 0.
    CHECK(complaint<SystemError>([] { read_file("/proc/self/mem"); }) ==
          "/proc/self/mem: cannot read: Input/output error");
    CHECK(unread(folder / "b").ends_with("/b: cannot open: No such file or directory"));
}

TEST_CASE("what does not end is refused once it is longer than files may be") {
    const Folder folder;
    folder.write("long", std::string(200'001, 'x'));
    CHECK(unread(folder / "long", false, 200'000).ends_with("/long: is longer than 200000 bytes"));
    CHECK(read_file(folder / "long", false, 200'001).size() == 200'001);
}

TEST_CASE("bytes are read in pieces, fewer at the end") {
    const Folder folder;
    folder.write("a", std::string(100000, 'x') + "end");
    std::ifstream in = open_file(folder / "a");
    std::string piece(60000, '.');
    auto next = [&] {
        return read_from(in, folder / "a", std::as_writable_bytes(std::span(piece)));
    };
    CHECK(next() == 60000);
    CHECK(next() == 40003);
    CHECK(piece.substr(39999, 5) == "xendx");
    CHECK(next() == 0);
}

TEST_CASE("only regular files are read: a pipe would keep us waiting, a device never end") {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(unread(folder / "pipe").ends_with("/pipe: is not a regular file"));
    CHECK(unread("/dev/zero") == "/dev/zero: is not a regular file");
    CHECK(unread(folder.path.string(), true).ends_with(": is a directory"));
    CHECK(read_file("/dev/null", true) == "");
}

TEST_CASE("a link stays, and what it leads to is written; one that leads nowhere is replaced") {
    const Folder folder;
    folder.write("deep/old", "old");
    fs::create_symlink("deep/old", folder / "a");
    fs::create_symlink("../a", folder / "deep/b");
    fs::create_symlink("deep/b", folder / "c");
    fs::create_symlink("deep/new", folder / "nowhere");
    for (const char* name : {"a", "c", "nowhere"}) {
        check_writable(folder / name);
        write_file(folder / name, name);
        CHECK(folder.read(name) == name);
        if (name[1] == '\0') CHECK(folder.read("deep/old") == name);
    }
    for (const char* name : {"a", "deep/b", "c"}) CHECK(fs::is_symlink(folder / name));
    CHECK(fs::is_regular_file(fs::symlink_status(folder / "nowhere")));
    CHECK(folder.files() == 6);
}

TEST_CASE("a pipe is written to, and not replaced") {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
    REQUIRE(reader >= 0);
    check_writable(folder / "pipe");
    write_file(folder / "pipe", "bytes");
    char bytes[9] = {};
    CHECK(::read(reader, bytes, sizeof bytes) == 5);
    CHECK(std::string(bytes) == "bytes");
    ::close(reader);
    CHECK(fs::is_fifo(folder / "pipe"));
    CHECK(folder.files() == 1);
    CHECK(is_stream("/dev/stdout"));  // even if it leads to a file
    CHECK(!is_stream(folder / "a"));
}

TEST_CASE("what goes to an open file, as stdout may be, follows what it has; it stays the same") {
    const Folder folder;
    folder.write("a", "before");
    const int fd = ::open((folder / "a").c_str(), O_WRONLY);
    REQUIRE(fd >= 0);
    write_file("/dev/fd/" + std::to_string(fd), " after");
    CHECK(folder.read("a") == "before after");
    CHECK(folder.files() == 1);
    ::close(fd);
}

TEST_CASE("a name may be as long as names can be") {
    const Folder folder;
    const std::string name(255, 'a');
    check_writable(folder / name);
    write_file(folder / name, "x");
    CHECK(folder.read(name) == "x");
    CHECK(folder.files() == 1);
}

TEST_CASE("what a killed process left beside a file goes; what a living one writes stays") {
    const Folder folder;
    const std::string dead = std::to_string(dead_process()), parent = std::to_string(::getppid());
    char host[65] = "";
    ::gethostname(host, 64);
    const std::string nobody = ".a.pfm." + std::string(host) + ".part";
    for (const std::string& name :
         {nobody + dead, ".b.pfm." + std::string(host) + ".part" + dead, nobody, nobody + parent,
          "a.pfm.part" + dead, ".a.pfm.another" + std::string(host) + ".part" + dead})
        folder.write(name, "half");
    REQUIRE(temporary_path(folder / "a.pfm") == folder / (nobody + std::to_string(::getpid())));
    check_writable(folder / "a.pfm");
    CHECK_FALSE(folder.has(nobody + dead));
    CHECK(folder.files() == 5);
    // An earlier process with the same number left this file; none of its bytes may survive.
    std::ofstream(temporary_path(folder / "a.pfm")) << "half";
    write_file(folder / "a.pfm", "x");
    CHECK(folder.read("a.pfm") == "x");
    CHECK(folder.files() == 6);
}

TEST_CASE("a file has one name, however it is written") {
    const Folder folder;
    folder.write("deep/a", "");
    folder.write("deep/b", "");
    fs::create_symlink("deep/b", folder / "link");
    CHECK(true_name(folder / "deep/../deep/./a") == true_name(folder / "deep/a"));
    CHECK(true_name(folder / "link") == true_name(folder / "deep/b"));
    CHECK(true_name(folder / "b") != true_name(folder / "deep/b"));
    CHECK(true_name(folder / "new") == true_name(folder / "deep/../new"));
    CHECK(true_name("a") == true_name("./a"));
    CHECK(true_name("a") == true_name((fs::current_path() / "a").string()));
}

TEST_CASE("a file that cannot be written whole leaves the old one, and nothing beside it") {
    const Folder folder;
    const std::string path = folder / "a.pfm";
    write_file(path, "old");
    CHECK(read_file(path) == "old");
    write_file(path, "new and longer");
    CHECK(read_file(path) == "new and longer");
    CHECK(folder.files() == 1);

    // The disk is full after 1000 bytes, so that writing fails part of the way.
    for (size_t size : {size_t(2000), size_t(1000000)}) {
        rlimit old_limit;
        REQUIRE(getrlimit(RLIMIT_FSIZE, &old_limit) == 0);
        auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{1000, old_limit.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
        const std::string error =
            complaint<SystemError>([&] { write_file(path, std::string(size, 'x')); });
        setrlimit(RLIMIT_FSIZE, &old_limit);
        std::signal(SIGXFSZ, old_handler);
        CHECK(error.starts_with(path + ": cannot write: "));
        CHECK(read_file(path) == "new and longer");
        CHECK(folder.files() == 1);
    }

    fs::create_directory(folder / "b.pfm");  // the last step, renaming, fails
    CHECK_THROWS_AS(write_file(folder / "b.pfm", "x"), SystemError);
    CHECK(folder.files() == 2);
    CHECK(fs::is_empty(folder / "b.pfm"));
    fs::create_directory(temporary_path(path));  // the first step fails
    CHECK_THROWS_AS(write_file(path, "x"), SystemError);
    CHECK(read_file(path) == "new and longer");
}

TEST_CASE("pieces, small or large, are one file in their order") {
    const Folder folder;
    std::string expected;
    std::vector<std::string> texts;
    for (size_t size : {1, 1000000, 1, 70000, 2000000, 0, 3}) {
        texts.emplace_back(size, char('a' + expected.size() % 26));
        expected += texts.back();
    }
    Pieces pieces;
    for (const std::string& text : texts) pieces.push_back(std::as_bytes(std::span(text)));
    write_file(folder / "a", pieces);
    CHECK(folder.read("a") == expected);
    write_file(folder / "a", Pieces{});
    CHECK(folder.read("a") == "");
    CHECK(folder.files() == 1);
}

TEST_CASE("a device that takes nothing is an error, and no file") {
    CHECK(complaint<SystemError>([] { write_file("/dev/full", "x"); }) ==
          "/dev/full: cannot write: No space left on device");
    CHECK(fs::is_character_file("/dev/full"));
    write_file("/dev/null", "x");
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("to be durable is: bytes on the disk, then the name, then the folder") {
    const Folder folder;
    const auto calls = calls_of({}, [&] { write_file(folder / "a", "bytes"); });
    using Calls = std::vector<std::string>;
    CHECK(calls == Calls{"write", "fsync 5", "close", "rename", "fsync folder", "close"});
}

TEST_CASE("whatever fails on the way to a file is an error with its name") {
    const Folder folder;
    const std::string path = folder / "a";
    for (const char* call : {"write", "fsync 5", "close", "rename", "fsync folder"}) {
        folder.write("a", "old");
        INFO(call);
        auto work = [&] { write_file(path, "bytes"); };
        auto with = [&](int error) {
            return complaint<SystemError>([&] { calls_of({{}, call, error}, work); });
        };
        CHECK(with(EIO) == path + ": cannot write: Input/output error");
        const bool late = std::string(call) == "fsync folder";  // the file is already renamed
        CHECK(folder.read("a") == (late ? "bytes" : "old"));
        CHECK(folder.files() == 1);
        if (std::string(call) != "rename") CHECK(with(EINTR) == "");  // the call is repeated
        if (late) CHECK(with(EINVAL) == "");
    }
}

TEST_CASE("a call that writes less than it was given is followed by another") {
    const Folder folder;
    calls_of({{}, "", 0, 2}, [&] { write_file(folder / "a", "hello"); });
    CHECK(folder.read("a") == "hello");
}

TEST_CASE("asking whether a file can be written changes nothing") {
    const Folder folder;
    folder.write("a.pfm", "old");
    check_writable(folder / "a.pfm");
    check_writable(folder / "b.pfm");
    CHECK(read_file(folder / "a.pfm") == "old");
    CHECK(folder.files() == 1);
    fs::create_symlink("loop", folder / "loop");
    for (const std::string name : {"missing/a.pfm", "a.pfm/a.pfm", ".", "loop"})
        CHECK_THROWS_AS(check_writable(folder / name), UserError);
    CHECK_THROWS_AS(check_writable(folder / std::string(1000, 'a')), UserError);
    CHECK(fs::is_symlink(folder / "loop"));
}
