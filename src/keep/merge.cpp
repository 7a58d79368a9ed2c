// keep/merge.cpp  4  build/merge: merges films of bands and of other seeds into one picture
#include <deque>

#include "app/render.h"
#include "app/threads.h"
#include "keep/keep.h"
#include "text/program.h"

namespace {
using namespace penumbra;

constexpr const char* before_options =
    "usage: merge [options] PART.film...\n\nMerges films of `penumbra --keep PART.film` into "
    "one\npicture: bands (--rows A-B), and independent renders of them (--seed N).\n\n"
    "Bands with a fixed number of --replications make the picture of one render, bit for bit.\n"
    "Bands with --replications adaptive choose weights by their own rows: the picture "
    "is\nunbiased, "
    "but not identical.  Films of other seeds add replications to each pixel.\n\n";

struct Part {
    std::string path, seed, rows;
    int first, last;  // rows
};

// Throws UserError unless the parts, from the top, make up the picture.  Bands of the same rows
// have different seeds.
void check_cover(const std::vector<Part>& parts, int height) {
    int next = 0;
    for (size_t k = 0; k <= parts.size(); ++k) {
        const int first = k < parts.size() ? parts[k].first : height;
        if (first > next)
            throw UserError("rows " + std::to_string(next) + "-" + std::to_string(first - 1) +
                            " are missing");
        if (k == parts.size()) return;
        const Part &p = parts[k], &before = parts[k > 0 ? k - 1 : 0];
        if (p.rows == before.rows && p.seed != before.seed) continue;
        if (first < next)
            throw UserError(p.rows == before.rows
                                ? "rows " + p.rows + " of seed " + p.seed +
                                      " appear twice: " + before.path + " and " + p.path
                                : "rows " + p.rows + " of " + p.path + " overlap rows " +
                                      before.rows + " of " + before.path);
        next = p.last + 1;
    }
}

// Merges row by row; memory holds the picture, and of each film a row and a weight per pixel.
Image merge(const std::vector<Part>& parts, Size size, Run& run) {
    MissedLight unseen;
    Image image(size.width, size.height);
    for (size_t k = 0; k < parts.size();) {
        const auto [path, seed, rows, first, last] = parts[k];
        std::deque<FilmPixels> films;
        for (; k < parts.size() && parts[k].rows == rows; ++k)
            films.emplace_back(parts[k].path, Size{size.width, last - first + 1});
        double all = 0;
        for (const FilmPixels& f : films) all += f.film().samples_per_pixel();
        for (const FilmPixels& f : films)
            unseen.add(f.film().near, double(f.film().min_samples_done()),
                       f.film().samples_per_pixel() / all);
        for (int y = first; y <= last && !interrupted; ++y)
            for (int x = 0; x < size.width; ++x) {
                Pixel p;
                for (FilmPixels& f : films) f.add_next(p);
                run.error.add(p);
                run.spp += p.samples, run.replications += p.K;
                image.at(x, y) = {float(p.value(0)), float(p.value(1)), float(p.value(2))};
            }
    }
    run.spp /= run.error.pixels, run.replications /= run.error.pixels;
    auto missed = [&] { return unseen.doubt(run.error.d2(), run.error.norm(), run.error.pixels); };
    run.doubt =
        in_words(doubt_of({}, run.error, [&](auto&, auto&) { return !missed().empty(); }), missed);
    return image;
}

// A later version may know other views.
View view_in(const FilmReader& file) {
    try {
        return value_of(views, "view", file.said("view"));
    } catch (const UserError& e) {
        file.refuse(e.what());
    }
}

// The program; returns its exit status, throws UserError and SystemError.
int program(const std::vector<std::string>& words) {
    CommonOptions o;
    std::vector<std::string> paths;
    OptionTable table = without(output_rows(o, "out/NAME.png, out/NAME.pfm") + general_rows(o),
                                {"--threads", "--size"});
    parse_words(table, words, [&](const std::string& word) { paths.push_back(word); });
    if (print_manual(o, table, before_options, "")) return 0;
    if (paths.empty()) throw UserError("no parts given (try --help)");

    const FilmReader any(paths[0]);
    Facts picture = any.head();  // without the seed and the facts after it
    const auto seed = std::ranges::find(picture, "seed", [](auto& fact) { return fact[0]; });
    picture.erase(seed, picture.end());
    const Size size{int(any.number("size", 65536)), int(any.number("size", 65536, 'x'))};
    Run run;
    run.replications = 0;
    std::vector<Part> parts;
    for (const std::string& path : paths) {
        const FilmReader file(path);
        check_agrees(file, picture, " as in " + paths[0], any.said("name"));
        check_agrees(file, {{"precision", sizeof(real) == 4 ? "float" : "double"}});
        if (file.said("complete") != "yes")
            file.refuse("is not complete: resume it with penumbra --keep " + path);
        const double last = file.number("rows", size.height - 1, '-');
        parts.push_back({path, file.said("seed"), file.said("rows"), int(file.number("rows", last)),
                         int(last)});
        if (double(file.left()) < sizeof(Sum) * (last - parts.back().first + 1) * size.width)
            file.refuse("is too short for its size");  // before there is a picture of that size
        const Spent spent = spent_in(file);
        run.seconds += spent.seconds, run.cpu_seconds += spent.cpu_seconds, run.rays += spent.rays;
    }
    std::ranges::stable_sort(parts, {},
                             [](const Part& p) { return std::tie(p.first, p.last, p.seed); });
    check_cover(parts, size.height);
    o.scene = any.said("name");
    const View view = view_in(any);
    run.is_radiance = !view.of;
    const auto outputs = outputs_of(o, "out/NAME" + suffix_of(view), paths, {}, size);
    catch_interrupt();
    const Image image = merge(parts, size, run);
    if (interrupted) return 128 + interrupted;  // and no file is written
    write_images(outputs, image, o.exposure ? *o.exposure : any.number("exposure"),
                 o.exposure ? Shades::as_they_are : view.shades);
    json::Object stats = asked_for(table, o.scene, size);
    add_run(stats, run, size);
    if (!o.stats.empty()) write_file(o.stats, stats.text());
    tell(o, summary(o.scene, run));
    tell_written(o, outputs);
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    return finished(program({argv + 1, argv + argc}));
} catch (...) {
    return failed();
}
