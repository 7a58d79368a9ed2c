// film/film_file_test.cpp  .film files hold what was written, or are refused by name
#include "film/film_file.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <functional>

#include "base/folder.h"
#include "base/system_calls.h"

namespace {

FilmHeader header() {
    FilmHeader h;
    h.set("scene", "scenes/a b.scene");
    h.set("options", "");
    h.set("size", "3x2");
    return h;
}

void write_film(const std::string& path, const FilmHeader& h, const std::string& numbers) {
    FilmWriter film(path, h);
    film.append(numbers.data(), numbers.size());
    film.commit();
}

// Why it is refused, without its name; "" if all of it is read.
std::string refusal(const Folder& folder, const std::string& name) {
    try {
        FilmReader film(folder / name);
        film.check();
        film.read<char>(film.left());
        return "";
    } catch (const UserError& e) {
        const std::string why = e.what(), start = folder / name + ": ";
        CHECK(why.starts_with(start));
        return why.substr(std::min(why.size(), start.size()));
    }
}

// What is said if films cannot be written, "" if they can.
std::string failure(const std::function<void()>& work) {
    try {
        work();
        return "";
    } catch (const SystemError& e) {
        return e.what();
    }
}

// A folder with one film, and its bytes.
struct Sample {
    Folder folder;
    std::string bytes;
    explicit Sample(const std::string& numbers = "0123456789 and so on") {
        write_film(folder / "a.film", header(), numbers);
        bytes = folder.read("a.film");
    }
};

}  // namespace

TEST_CASE("a film is read as it was written: its lines in their order, its numbers bit by bit") {
    const Folder folder;
    const std::vector<double> many(100000, 1e-310);  // more than one call writes
    const std::vector<float> few = {NAN, -0.0f, 1e-42f};
    {
        FilmWriter film(folder / "a.film", header());
        for (int i = 0; i < 3; ++i) film.append(&few[size_t(i)], sizeof few[0]);
        film.append(std::vector<int>{});
        film.append(many);
        film.append("x", 1);
        film.commit();
    }
    FilmReader film(folder / "a.film");
    CHECK(film.header().entries == header().entries);
    CHECK(film.header().find("scene") == "scenes/a b.scene");
    CHECK(film.header().find("options") == "");
    CHECK(film.header().find("spp") == std::nullopt);
    for (int time = 0; time < 2; ++time) {
        film.check();  // begins anew
        CHECK(film.left() == 12 + 800000 + 1);
        const auto back = film.read<float>(3);
        CHECK(std::memcmp(back.data(), few.data(), 12) == 0);
        CHECK(film.read<double>(100000) == many);
        char x = 0;
        film.read(&x, 1);
        CHECK(x == 'x');
        CHECK(film.left() == 0);
    }
    CHECK_THROWS_AS(film.read<char>(1), UserError);
    char more = 0;
    CHECK_THROWS_AS(film.read(&more, 1), UserError);
    CHECK_THROWS_AS(film.read<double>(SIZE_MAX / 4), UserError);  // and no room is made for them
    CHECK(folder.files() == 1);
}

TEST_CASE("`head` shows a film's first lines; films of version 1 stay what they are") {
    const Sample film("abc");
    // The checksum by a program in another language.
    CHECK(film.bytes ==
          "penumbra film 1\nbytes 00000000000000000003\nchecksum 7dc0f03976e8ec38\n"
          "scene scenes/a b.scene\noptions \nsize 3x2\n\nabc");
}

TEST_CASE("a key is a word and a value a line; one that is set twice has the second value") {
    FilmHeader h = header();
    h.set("size", "4x4");
    CHECK(h.find("size") == "4x4");
    CHECK(h.entries.size() == 3);
    for (const char* key : {"", "a b", "a\n"}) CHECK_THROWS_AS(h.set(key, "x"), UserError);
    CHECK_THROWS_AS(h.set("a", "x\ny"), UserError);
    const Folder folder;
    h.set("long", std::string(1 << 16, 'x'));  // FilmReader would not read as far
    CHECK_THROWS_AS(FilmWriter(folder / "a.film", h), UserError);
    CHECK(folder.files() == 0);
}

TEST_CASE("a film without lines, or without numbers, is one") {
    const Folder folder;
    write_film(folder / "a.film", {}, "");
    CHECK(refusal(folder, "a.film") == "");
    FilmReader film(folder / "a.film");
    CHECK(film.header().entries.empty());
    CHECK(film.left() == 0);
}

TEST_CASE("a film's sum is that of its bytes, in whatever pieces they come") {
    std::string bytes;
    for (int i = 0; i < 100; ++i) bytes += char(i * i);
    Checksum whole;
    whole.add(bytes.data(), bytes.size());
    for (size_t piece = 1; piece < 40; ++piece) {
        Checksum sum;
        for (size_t from = 0; from < bytes.size(); from += piece)
            sum.add(bytes.data() + from, std::min(piece, bytes.size() - from));
        CHECK(sum.value() == whole.value());
    }
    Checksum longer = whole;  // zeros, as the last word is filled with
    longer.add("\0", 1);
    CHECK(longer.value() != whole.value());
}

TEST_CASE("no part of a film passes for a whole one") {
    const Sample film;
    for (size_t length = 0; length < film.bytes.size(); ++length) {
        film.folder.write("a.film", film.bytes.substr(0, length));
        INFO(length, " bytes");
        CHECK(refusal(film.folder, "a.film") == (length > 0 ? "is cut short" : "no film"));
    }
    film.folder.write("a.film", film.bytes);
    CHECK(refusal(film.folder, "a.film") == "");
}

TEST_CASE("a film with more behind it is none") {
    const Sample film;
    for (const std::string& more : {std::string("x"), std::string(1, '\0'), film.bytes}) {
        film.folder.write("a.film", film.bytes + more);
        CHECK(refusal(film.folder, "a.film") == "is longer than it says");
    }
}

TEST_CASE("a film with any bit flipped is refused, and says why") {
    const Sample film;
    const size_t lines = film_file::first_lines(0, 0).size(), numbers = film.bytes.size() - 20;
    for (size_t bit = 0; bit < 8 * film.bytes.size(); ++bit) {
        std::string bytes = film.bytes;
        bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
        film.folder.write("a.film", bytes);
        const std::string why = refusal(film.folder, "a.film");
        INFO("bit ", bit, ": ", why);
        CHECK(why != "");
        if (bit / 8 >= numbers) CHECK(why == "is damaged (its checksum differs)");
        if (bit / 8 >= 43 && bit / 8 < lines) CHECK(why == "is damaged (its checksum differs)");
        if (bit / 8 < 14) CHECK(why == "no film");
    }
}

TEST_CASE("what is no film, or of another version, is refused by name") {
    const Sample film;
    const Folder& folder = film.folder;
    const std::string rest = film.bytes.substr(16);
    for (const std::string& bytes :
         {std::string("PF\n1 1\n-1.0\n"), std::string(100000, 'x'), std::string(100000, '\n'),
          "penumbra film 1" + std::string(100000, '1'), "penumbra film\n" + rest}) {
        folder.write("a.film", bytes);
        CHECK(refusal(folder, "a.film") == "no film");
    }
    folder.write("a.film", "penumbra film 2\n" + rest);
    CHECK(refusal(folder, "a.film") == "of another version (2)");
    const std::string first = film_file::first_lines(100000, 0);
    folder.write("a.film", first + std::string(100000, 'x'));
    CHECK(refusal(folder, "a.film") == "is damaged (its head has no end)");
    folder.write("a.film", film_file::first_lines(0, 0) + "word\n\n");
    CHECK(refusal(folder, "a.film") == "is damaged (its head is none)");
    CHECK(refusal(folder, "missing.film").starts_with("cannot open: "));
    REQUIRE(::mkfifo((folder / "pipe.film").c_str(), 0600) == 0);
    CHECK(refusal(folder, "pipe.film") == "is no regular file");
    CHECK(refusal(folder, "") == "is a directory");
}

TEST_CASE("nothing of a damaged film is read, though nobody asked whether it is one") {
    Sample film;
    film.bytes.back() ^= 1;
    film.folder.write("a.film", film.bytes);
    const std::string path = film.folder / "a.film",
                      why = path + ": is damaged (its checksum differs)";
    char first = '?';
    CHECK_THROWS_WITH_AS(FilmReader(path).read(&first, 1), why.c_str(), UserError);
    CHECK(first == '?');
    CHECK_THROWS_WITH_AS(FilmReader(path).read<char>(1), why.c_str(), UserError);
}

TEST_CASE("a film that cannot be written whole leaves the old one, and nothing beside it") {
    const Sample film;
    const std::string path = film.folder / "a.film";
    {
        FilmWriter unfinished(path, header());
        unfinished.append("new", 3);
    }
    rlimit old_limit;
    REQUIRE(getrlimit(RLIMIT_FSIZE, &old_limit) == 0);
    auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    for (size_t size : {size_t(2000), size_t(5000000)}) {  // seen at the end, and on the way
        const rlimit limit{1000, old_limit.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
        const std::string why = failure([&] { write_film(path, {}, std::string(size, 'x')); });
        setrlimit(RLIMIT_FSIZE, &old_limit);
        CHECK(why == path + ": cannot write: File too large");
    }
    std::signal(SIGXFSZ, old_handler);
    CHECK(film.folder.read("a.film") == film.bytes);
    CHECK(film.folder.files() == 1);
}

TEST_CASE("a film is on the disk before it has its name, and its name is before it is written") {
    const Folder folder;
    const auto calls = calls_of({}, [&] { write_film(folder / "a.film", {}, "abc"); });
    const std::string size = std::to_string(folder.read("a.film").size());
    CHECK(calls == std::vector<std::string>{"write", "pwrite", "fsync " + size, "close", "rename",
                                            "fsync folder", "close"});
}

TEST_CASE("no film is written into a pipe, and that is known before") {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "pipe.film").c_str(), 0600) == 0);
    CHECK_THROWS_AS(check_film(folder / "pipe.film"), UserError);
    CHECK_THROWS_AS(check_film("/dev/null"), UserError);
    CHECK_THROWS_AS(check_film(folder / "missing/a.film"), UserError);
    check_film(folder / "a.film");
    CHECK(folder.files() == 1);
}
