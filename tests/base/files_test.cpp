// base/files_test.cpp  files are read whole, written whole or not at all, and under the right name
#include "base/files.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "base/folder.h"
#include "base/system_calls.h"

namespace {

// What is said if it cannot be done; "" if it can.
template <class Error>
std::string complaint(const auto& work) {
    try {
        work();
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}

// The number of a process that has ended.
pid_t dead_process() {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    ::waitpid(child, nullptr, 0);
    return child;
}

}  // namespace

// ---- Reading ------------------------------------------------------------------------------------

TEST_CASE("a file is read to its end; an error on the way is none") {
    const Folder folder;
    const std::string bytes = std::string(200000, 'x') + '\0' + "end";
    folder.write("a", bytes);
    CHECK(read_file(folder / "a") == bytes);
    folder.write("empty", "");
    CHECK(read_file(folder / "empty") == "");
    // Nothing is mapped at 0.
    CHECK(complaint<SystemError>([] { read_file("/proc/self/mem"); }) ==
          "/proc/self/mem: cannot read: Input/output error");
    CHECK(complaint<UserError>([&] {
              read_file(folder / "b");
          }).ends_with("/b: cannot open: No such file or directory"));
}

TEST_CASE("what does not end is refused once it is longer than it says, or than a stream may be") {
    const Folder folder;
    // Of many gigabytes, and of length 0.
    CHECK(complaint<UserError>([] { read_file("/proc/self/pagemap"); }) ==
          "/proc/self/pagemap: does not end after 0 bytes");
    CHECK(complaint<UserError>([] { read_file("/dev/zero", true); }) ==
          "/dev/zero: does not end after 268435456 bytes");
    // As long as all memory, for a file that takes none: nothing of it is read.
    folder.write("long", "");
    fs::resize_file(folder / "long", (uint64_t(1) << 32) + 1);
    CHECK(complaint<UserError>([&] {
              read_file(folder / "long");
          }).ends_with("/long: is longer than 4294967296 bytes"));
}

TEST_CASE("only regular files are read: a pipe would keep us waiting, a device never end") {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(complaint<UserError>([&] {
              read_file(folder / "pipe");
          }).ends_with("/pipe: is no regular file"));
    CHECK(complaint<UserError>([] { read_file("/dev/zero"); }) == "/dev/zero: is no regular file");
    CHECK(complaint<UserError>([&] {
              read_file(folder.path.string(), true);
          }).ends_with(": is a directory"));
    CHECK(read_file("/dev/null", true) == "");
}

// ---- Writing ------------------------------------------------------------------------------------

TEST_CASE("a link stays, and what it leads to is written, be it there or not") {
    const Folder folder;
    folder.write("deep/old", "old");
    fs::create_symlink("deep/old", folder / "a");
    fs::create_symlink("../deep/new", folder / "deep/b");
    fs::create_symlink(folder / "deep/b", folder / "c");
    for (const char* name : {"a", "c"}) {
        check_writable(folder / name);
        write_file(folder / name, name);
        CHECK(fs::is_symlink(folder / name));
    }
    CHECK(folder.read("deep/old") == "a");
    CHECK(folder.read("deep/new") == "c");
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
    CHECK(is_stream("/dev/stdout"));  // though it may lead to a file
    CHECK(!is_stream(folder / "a"));
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
    const std::string nobody = ".a.pfm.part";
    for (const std::string& name :
         {nobody + dead, ".b.pfm.part" + dead, nobody, nobody + parent, "a.pfm.part" + dead})
        folder.write(name, "half");
    REQUIRE(aside(folder / "a.pfm").ends_with("/.a.pfm.part" + std::to_string(::getpid())));
    check_writable(folder / "a.pfm");
    CHECK_FALSE(folder.has(".a.pfm.part" + dead));
    CHECK(folder.files() == 4);
}

TEST_CASE("a file has one name, however it is written") {
    const Folder folder;
    folder.write("deep/a", "");
    fs::create_symlink("deep/b", folder / "link");
    CHECK(true_name(folder / "deep/../deep/./a") == true_name(folder / "deep/a"));
    CHECK(true_name(folder / "link") == true_name(folder / "deep/b"));
    CHECK(true_name(folder / "b") != true_name(folder / "deep/b"));
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

    // A disk that is full after 1000 bytes: fails in fwrite or, buffered, only in fclose.
    for (size_t size : {size_t(2000), size_t(1000000)}) {
        rlimit old_limit;
        REQUIRE(getrlimit(RLIMIT_FSIZE, &old_limit) == 0);
        auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{1000, old_limit.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
        std::string error;
        try {
            write_file(path, std::string(size, 'x'));
        } catch (const SystemError& e) {
            error = e.what();
        }
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
    fs::create_directory(aside(path));  // the first step fails
    CHECK_THROWS_AS(write_file(path, "x"), SystemError);
    CHECK(read_file(path) == "new and longer");
}

TEST_CASE("what is written in pieces, small or large, in their order or not, is one file") {
    const Folder folder;
    std::string expected;
    OutputFile file(folder / "a");
    for (size_t size : {1, 1000000, 1, 70000, 2000000, 0, 3}) {
        const std::string piece(size, char('a' + expected.size() % 26));
        file.write(piece.data(), piece.size());
        expected += piece;
    }
    file.write_at(2, "2nd", 3);
    expected.replace(2, 3, "2nd");
    file.write("end", 3);
    expected += "end";
    file.write_at(expected.size() + 2, "!", 1);
    expected += std::string(2, '\0') + "!";
    CHECK_FALSE(folder.has("a"));
    file.commit();
    CHECK(folder.read("a") == expected);
    CHECK(folder.files() == 1);
}

TEST_CASE("there are no places in a stream") {
    OutputFile null("/dev/null");
    CHECK(complaint<SystemError>([&] { null.write_at(0, "x", 1); }) ==
          "/dev/null: cannot write: is no regular file");
    OutputFile full("/dev/full");
    full.write("x", 1);
    CHECK(complaint<SystemError>([&] { full.commit(); }) ==
          "/dev/full: cannot write: No space left on device");
    CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("what is not committed goes, and the old file stays") {
    const Folder folder;
    folder.write("a", "old");
    {
        OutputFile file(folder / "a");
        file.write_at(0, "new", 3);
        CHECK(folder.files() == 2);
    }
    CHECK(folder.files() == 1);
    CHECK(folder.read("a") == "old");
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
    for (const char* call : {"write", "pwrite", "fsync 5", "close", "rename", "fsync folder"}) {
        folder.write("a", "old");
        INFO(call);
        auto work = [&] {
            OutputFile file(path);
            file.write("byt", 3);
            file.write_at(3, "es", 2);
            file.commit();
        };
        auto with = [&](int error) {
            return complaint<SystemError>([&] { calls_of({{}, call, error}, work); });
        };
        CHECK(with(EIO) == path + ": cannot write: Input/output error");
        const bool late = std::string(call) == "fsync folder";  // it has its name by then
        CHECK(folder.read("a") == (late ? "bytes" : "old"));
        CHECK(folder.files() == 1);
        if (std::string(call) != "rename") CHECK(with(EINTR) == "");  // it is asked again
        if (late) CHECK(with(EINVAL) == "");
    }
}

TEST_CASE("a call that writes less than it was given is followed by another") {
    const Folder folder;
    calls_of({{}, "", 0, 2}, [&] {
        OutputFile file(folder / "a");
        file.write("hello", 5);
        file.write_at(1, "ipp", 3);
        file.commit();
    });
    CHECK(folder.read("a") == "hippo");
}

TEST_CASE("asking whether a file can be written changes nothing") {
    const Folder folder;
    folder.write("a.pfm", "old");
    check_writable(folder / "a.pfm");
    check_writable(folder / "b.pfm");
    CHECK(read_file(folder / "a.pfm") == "old");
    CHECK(folder.files() == 1);
    CHECK_THROWS_AS(check_writable(folder / "missing/a.pfm"), UserError);
    CHECK_THROWS_AS(check_writable(folder / "a.pfm/a.pfm"), UserError);
    CHECK_THROWS_AS(check_writable(folder.path.string()), UserError);
    CHECK_THROWS_AS(check_writable(folder / std::string(1000, 'a')), UserError);
    fs::create_symlink("loop", folder / "loop");
    CHECK_THROWS_AS(check_writable(folder / "loop"), UserError);
    CHECK(fs::is_symlink(folder / "loop"));
}
