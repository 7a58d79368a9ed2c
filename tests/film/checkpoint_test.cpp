// film/checkpoint_test.cpp  films come out of files as they went in, or not at all
#include "film/checkpoint.h"

#include "base/folder.h"
#include "film/refusal.h"

namespace {

constexpr Size size = {5, 3};
constexpr size_t pixels = 15;

std::vector<MeanPixel> means(size_t count, double from) {
    std::vector<MeanPixel> all(count);
    for (size_t i = 0; i < count; ++i) all[i].sum = {from + double(i), NAN, -0.0};
    return all;
}

ErrorTerms terms(double from) {
    ErrorTerms t;
    t.pixels = 1, t.measured = 2, t.sum = {from, 1, 2}, t.norm2 = 3, t.square = {4, 5, 6};
    t.terms2 = 7, t.greatest = 8;
    return t;
}

// In every member other numbers.
FilmState<MeanPixel> state(bool with_sets, bool unfinished) {
    FilmState<MeanPixel> s;
    s.samples = 20, s.samples_of_others = 18, s.sets_after = 16, s.pass = unfinished ? 3 : 0;
    s.first = means(pixels, 100);
    if (!with_sets) s.spread.assign(pixels, 0.5);
    if (with_sets) {
        s.sets.assign(pixels, {1, 0});
        s.sets[2] = {3, 0}, s.sets[4] = {1, 0.25f}, s.sets[14] = {2, 0};
        s.others = means(4, 200);
    }
    s.ahead.assign(pixels, false), s.terms.assign(pixels, ErrorTerms());
    if (!unfinished) return s;
    s.ahead[3] = true;
    s.terms[3] = terms(9);
    s.image.pixels.assign(pixels, {1, 2, 3});
    return s;
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool same(const FilmState<MeanPixel>& a, const FilmState<MeanPixel>& b) {
    return a.samples == b.samples && a.samples_of_others == b.samples_of_others &&
           a.sets_after == b.sets_after && a.pass == b.pass && same(a.first, b.first) &&
           same(a.spread, b.spread) && same(a.sets, b.sets) && same(a.others, b.others) &&
           same(a.ahead, b.ahead) && same(a.terms, b.terms) && same(a.image.pixels, b.image.pixels);
}

FilmState<MeanPixel> read(const std::string& path, Size of = size) {
    FilmReader file(path);
    return read_film<MeanPixel>(file, path, of);
}

// What a film of that head and state is refused for.
void expect_refused(FilmHeader wrong, const FilmState<MeanPixel>& s, const std::string& why) {
    const Folder folder;
    const std::string path = folder / "a.film", changed = folder / "b.film";
    write_film(path, {}, s);
    FilmReader file(path);
    FilmHeader header = file.header();
    for (const auto& [key, value] : wrong.entries)
        if (value != "none")
            header.set(key, value);
        else
            std::erase_if(header.entries, [&](const auto& e) { return e.first == key; });
    FilmWriter out(changed, header);
    out.append(file.read<char>(file.left()));
    out.commit();
    CHECK(refusal([&] { read(changed); }) == changed + ": " + why);
}

struct OtherPixel : MeanPixel {
    static constexpr const char* name = "others";
};

}  // namespace

TEST_CASE("a film comes back as it was, before and after its sets, in a pass and between two") {
    const Folder folder;
    const std::string path = folder / "a.film";
    for (bool with_sets : {false, true})
        for (bool unfinished : {false, true}) {
            CAPTURE(with_sets);
            CAPTURE(unfinished);
            FilmHeader header;
            header.set("scene", "of somebody");
            write_film(path, header, state(with_sets, unfinished));
            const bool comes_back = same(read(path), state(with_sets, unfinished));
            CHECK(comes_back);
            FilmReader file(path);
            CHECK(file.header().find("scene") == "of somebody");
            CHECK(file.header().find("taken") == "20");
        }
}

TEST_CASE("a pass without samples is unfinished, too, once a block has it") {
    const Folder folder;
    FilmState<MeanPixel> s = state(true, true);
    s.pass = 0;
    write_film(folder / "a.film", {}, s);
    const bool comes_back = same(read(folder / "a.film"), s);
    CHECK(comes_back);
}

TEST_CASE("a film that could be none is refused, by what is wrong") {
    const auto s = state(true, false);
    auto changed = [](const std::string& key, const std::string& value) {
        FilmHeader h;
        h.set(key, value);
        return h;
    };
    expect_refused(changed("taken", "none"), s, "does not say its taken");
    expect_refused(changed("taken", "-1"), s,
                   "taken: '-1' is not a whole number from 0 to 18446744073709551615");
    expect_refused(changed("other-sets", "5"), s, "has other sets than it says");
    expect_refused(changed("pixels", "means of 25 bytes"), s, "holds another kind of pixels");
    expect_refused(changed("unfinished", "yes"), s, "holds less than it should");
    auto without_chance = s;
    for (Sets sets : {Sets{0, 0}, Sets{most_sets + 1, 0}, Sets{1, -0.5f}, Sets{1, 1.5f},
                      Sets{1, std::nanf("")}}) {
        without_chance.sets[2] = sets;
        expect_refused({}, without_chance, "has a pixel of impossible sets");
    }
    auto other_count = s;
    other_count.sets[2].shown = 2;
    expect_refused({}, other_count, "has other sets than it says");
}

TEST_CASE("a film of another size, or of other pixels, is refused") {
    const Folder folder;
    const std::string path = folder / "a.film";
    write_film(path, {}, state(false, true));
    CHECK(refusal([&] { read(path, {5, 2}); }) == path + ": holds more than it should");
    CHECK(refusal([&] { read(path, {5, 4}); }) == path + ": holds less than it should");
    CHECK(refusal([&] {
              FilmReader file(path);
              read_film<OtherPixel>(file, path, size);
          }) == path + ": holds another kind of pixels");
}
