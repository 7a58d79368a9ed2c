// keep/film_file_test.cpp  .film files return what was written, or are refused with their names
#include "keep/film_file.h"

#include <sys/stat.h>

#include "base/system_calls.h"
#include "text/complaint.h"
#include "text/folder.h"

namespace {

const Facts head = {{"scene", "scenes/a b.scene"}, {"options", ""}, {"size", "3x2"}};

template <class T>
std::span<const std::byte> bytes_of(const T& numbers) {
    return std::as_bytes(std::span(numbers));
}

void write_film(const std::string& path, const Facts& facts, const std::string& numbers) {
    write_film_file(path, facts, {bytes_of(numbers)});
}

template <class T>
std::vector<T> read(FilmReader& film, size_t count) {
    std::vector<T> numbers(count);
    film.read(std::as_writable_bytes(std::span(numbers)));
    return numbers;
}

// Why a file is refused, without its name; "" if all of it is read.
std::string refusal(const Folder& folder, const std::string& name) {
    const std::string start = folder / name + ": ", why = complaint([&] {
                                                        FilmReader film(folder / name);
                                                        read<char>(film, film.left());
                                                    });
    CHECK((why.empty() || why.starts_with(start)));
    return why.substr(std::min(why.size(), start.size()));
}

struct Sample {
    Folder folder;
    std::string bytes;
    explicit Sample(const std::string& numbers = "0123456789 and so on") {
        write_film(folder / "a.film", head, numbers);
        bytes = folder.read("a.film");
    }
    // Why a film of these bytes is refused.
    std::string refused(const std::string& other) const {
        folder.write("a.film", other);
        return refusal(folder, "a.film");
    }
};

}  // namespace

TEST_CASE("a film is read as it was written: its lines in their order, its numbers bit by bit") {
    const Folder folder;
    const std::vector<double> many(100000, 1e-310);  // exceeds one write call
    const std::vector<float> few = {NAN, -0.0f, 1e-42f};
    write_film_file(folder / "a.film", head,
                    {bytes_of(few), {}, bytes_of(many), bytes_of(std::string("x"))});
    FilmReader film(folder / "a.film");
    CHECK(film.head() == head);
    CHECK(film.said("scene") == "scenes/a b.scene");
    CHECK(film.said("options") == "");
    CHECK(film.said("spp") == "not known");
    CHECK(film.left() == 12 + 800000 + 1);
    const auto back = read<float>(film, 3);
    CHECK(std::memcmp(back.data(), few.data(), 12) == 0);
    CHECK(read<double>(film, 100000) == many);
    CHECK(read<char>(film, 1) == std::vector<char>{'x'});
    CHECK(film.left() == 0);
    CHECK_THROWS_AS(read<char>(film, 1), UserError);
    CHECK(folder.files() == 1);
}

TEST_CASE("`head` shows a film's first lines; films of version 10 stay what they are") {
    const Sample film("abc");
    // A program in another language computed the checksum.
    CHECK(film.bytes ==
          "penumbra film 10\nbytes 00000000000000000003\nchecksum 50feca0aaa5a1aa0\n"
          "scene scenes/a b.scene\noptions \nsize 3x2\n\nabc");
}

TEST_CASE("numbers of a head: at the start of a value, or after a character of it") {
    const Folder folder;
    const Facts facts = {{"rows", "3-15"}, {"time", "0.25"},  {"no", "x"},
                         {"less", "-1"},   {"much", "1e300"}, {"nan", "nan"}};
    write_film(folder / "a.film", facts, "");
    const FilmReader film(folder / "a.film");
    CHECK(film.number("rows", 100) == 3);
    CHECK(film.number("rows", 100, '-') == 15);
    CHECK(film.number("rows", 15, '-') == 15);
    CHECK(film.number("time") == 0.25);
    // The character after which a number stands is not there: 3-15 is no 3x3.
    CHECK_THROWS_AS(film.number("rows", 100, 'x'), UserError);
    CHECK_THROWS_WITH_AS(film.number("rows", 14, '-'),
                         (folder / "a.film" + ": invalid rows '3-15'").c_str(), UserError);
    for (const char* key : {"no", "less", "much", "nan", "missing"})
        CHECK_THROWS_AS(film.number(key), UserError);
}

TEST_CASE("a film without lines, or without numbers, is one") {
    const Folder folder;
    write_film(folder / "a.film", {}, "");
    CHECK(refusal(folder, "a.film") == "");
    FilmReader film(folder / "a.film");
    CHECK(film.head().empty());
    CHECK(film.left() == 0);
}

TEST_CASE("a film's sum is that of its bytes, in whatever pieces they come") {
    std::string bytes;
    for (int i = 0; i < 100; ++i) bytes += char(i * i);
    Checksum whole;
    whole.add(bytes_of(bytes));
    for (size_t piece = 1; piece < 40; ++piece) {
        Checksum sum;
        for (size_t from = 0; from < bytes.size(); from += piece)
            sum.add(bytes_of(bytes.substr(from, piece)));
        CHECK(sum.text() == whole.text());
    }
    Checksum longer = whole;
    longer.add(bytes_of(std::string(1, '\0')));
    CHECK(longer.text() != whole.text());
}

TEST_CASE("no part of a film passes for a whole one, nor does one with more behind it") {
    const Sample film;
    CHECK(film.refused(film.bytes) == "");
    for (size_t length = 0; length < film.bytes.size(); ++length) {
        INFO(length, " bytes");
        CHECK(film.refused(film.bytes.substr(0, length)) ==
              (length > 0 ? "is cut short" : "is not a film"));
    }
    for (const std::string& more : {std::string("x"), std::string(1, '\0'), film.bytes})
        CHECK(film.refused(film.bytes + more) == "is longer than it says");
}

TEST_CASE("a film with any bit flipped is refused, and says why") {
    const Sample film;
    const size_t lines = first_lines(0, {}).size(), numbers = film.bytes.size() - 20;
    for (size_t bit = 0; bit < 8 * film.bytes.size(); ++bit) {
        std::string bytes = film.bytes;
        bytes[bit / 8] = char(bytes[bit / 8] ^ (1 << bit % 8));
        const std::string why = film.refused(bytes);
        INFO("bit ", bit, ": ", why);
        CHECK(why != "");
        if (bit / 8 >= numbers || (bit / 8 >= 43 && bit / 8 < lines))
            CHECK(why == "is damaged (its checksum differs)");
        if (bit / 8 < 14) CHECK(why == "is not a film");
    }
}

TEST_CASE("what is no film, or of another version, is refused by name") {
    const Sample film;
    const Folder& folder = film.folder;
    const std::string rest = film.bytes.substr(17);
    for (const std::string& bytes :
         {std::string("PF\n1 1\n-1.0\n"), std::string(100000, 'x'), std::string(100000, '\n'),
          "penumbra film 10" + std::string(100000, '1'), "penumbra film\n" + rest})
        CHECK(film.refused(bytes) == "is not a film");
    for (const std::string version : {"1", "2", "3", "4", "5", "6", "7", "8", "9", "77"})
        CHECK(film.refused("penumbra film " + version + "\n" + rest) ==
              "is of another Penumbra: format version " + version + ", not 10");
    CHECK(film.refused(first_lines(100000, {}) + std::string(100000, 'x')) == "is cut short");
    CHECK(refusal(folder, "missing.film").starts_with("cannot open: "));
    REQUIRE(::mkfifo((folder / "pipe.film").c_str(), 0600) == 0);
    CHECK(refusal(folder, "pipe.film") == "is not a regular file");
    CHECK(refusal(folder, "") == "is a directory");
}

TEST_CASE("a film is on the disk before it has its name, and its name is before it is written") {
    const Folder folder;
    const auto calls = calls_of({}, [&] { write_film(folder / "a.film", {}, "abc"); });
    const std::string size = std::to_string(folder.read("a.film").size());
    CHECK(calls == std::vector<std::string>{"write", "write", "fsync " + size, "close", "rename",
                                            "fsync folder", "close"});
}
