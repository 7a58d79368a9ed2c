// app/merge.cpp  11  build/merge: parts of a picture, rendered one by one, put together
#include "app/merge.h"
#include "app/help.h"
#include "app/outputs.h"
#include "base/program.h"
#include "film/image_files.h"

namespace {

constexpr const char* before_options =
    "usage: merge [options] PART.film...\n\nPuts together the parts of a picture that `penumbra "
    "--checkpoint PART.film` has\nrendered, by --rows A-B or --samples A-B of --spp N: bands bit "
    "by "
    "bit as if all\nwere one run, samples but for rounding.\n\n";

constexpr const char* after_options = R"(
Exit status: 0 done; 1 a file could not be written; 2 the parts are not those of
one picture, or one of them is damaged, not complete, missing or there twice;
130 interrupted (Ctrl-C; 143 SIGTERM, 129 SIGHUP), which leaves no file.
)";

struct MergeOptions : CommonOptions {
    std::vector<std::string> parts;
};

using Rows = CommonRows<MergeOptions>;
const OptionTable<MergeOptions> merge_table = {
    Rows::output("out/NAME.png, out/NAME.pfm"),
    Rows::exposure(),
    Rows::stats(),
    Rows::quiet(),
    Rows::help(),
};

// The options of the run that the head tells of.
Options options_in(const PartFile& part) {
    std::vector<std::string> words;
    for (const char* name : options_of_samples)
        words.insert(words.end(), {name, part.header.find(name + 2).value_or("")});
    words.insert(words.end(), {"--roulette", part.header.find("roulette").value_or("")});
    Options o;
    try {
        o = parse_words(option_table, words);
    } catch (const UserError& e) {
        throw UserError(part.path + ": " + e.what());
    }
    o.scene = part.header.find("name").value_or("");
    o.spp = part.spp;
    return o;
}

// Each part has filled the same ones.
void maps_of_all(RunStats& all, const MapStats& maps) {
    const double seconds = all.maps ? all.maps->seconds : 0;
    const uint64_t rays = all.maps ? all.maps->rays : 0;
    all.maps = maps;
    all.maps->seconds += seconds, all.maps->rays += rays;
    all.seconds += maps.seconds, all.rays += maps.rays;
}

RunStats run_of(const std::vector<Band>& bands, const Merged& merged) {
    RunStats all;
    for (const Band& band : bands)
        for (const PartFile& p : band) {
            all.seconds += p.run.seconds, all.cpu_seconds += p.run.cpu_seconds;
            all.rays += p.run.rays;
            all.redraws += p.run.redraws, all.fallbacks += p.run.fallbacks;
            if (p.run.maps) maps_of_all(all, *p.run.maps);
        }
    all.spp = bands.front().front().spp;
    all.stopped_by = "samples";
    all.error = merged.terms.error();
    all.sets = merged.sets;
    for (size_t c = 0; c < 3; ++c)
        all.mean_radiance[c] = merged.terms.sum[c] / double(merged.terms.pixels);
    return all;
}

Merged merge_into(ImageFiles& files, const std::vector<Band>& bands, const Options& o) {
    const Shows shows = o.view == View::variance ? Shows::variances : Shows::values;
    auto row = [&](int y, const auto& pixels) {
        if (interrupted) throw Interrupted();
        files.add(y, pixels);
    };
    const bool plain = is_plain_view(o.view) || !estimates_pixels(o.direct);
    return plain ? merge<MeanPixel>(bands, {}, shows, row)
                 : merge<ShadowPixel>(bands, {o.direct}, shows, row);
}

// The program; returns its exit status, throws UserError and SystemError.
int merge_program(const std::vector<std::string>& words) {
    MergeOptions o = parse_words(merge_table, words);
    if (o.help) {
        std::printf("%s%s%s", before_options, option_lines(merge_table).c_str(), after_options);
        return 0;
    }
    if (o.parts.empty()) throw UserError("no parts given (try --help)");
    const std::vector<Band> bands = bands_of(o.parts);
    const PartFile& any = bands.front().front();
    const Options rendered = options_in(any);
    o.scene = rendered.scene;
    const auto outputs = outputs_of(o, "", {{o.parts, "a part of the picture"}}, any.picture);
    catch_interrupt();
    const double exposure =
        o.exposure ? double(*o.exposure) : parse_number(any.header.find("exposure").value_or("1"));
    ImageFiles files(outputs, any.picture, exposure);
    const RunStats run = run_of(bands, merge_into(files, bands, rendered));
    files.commit();
    const int depth = int(count_in(any.header, "depth", any.path));
    if (!o.stats.empty()) write_file(o.stats, encode_stats(rendered, any.picture, depth, run));
    if (run.maps) tell(o, summary(*run.maps));
    tell(o, summary(rendered, run));
    tell_written(o, outputs);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] {
        try {
            return merge_program({argv + 1, argv + argc});
        } catch (const Interrupted&) {  // no file was written
            return 128 + interrupted;
        }
    });
}
