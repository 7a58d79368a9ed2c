// labs/techniques.cpp  6  the gain of cosine sampling, Halton points and next-event estimation
//
//   build/techniques [--quick]
#include "base/stats.h"
#include "labs/grid.h"
#include "labs/naive_halton.h"
#include "text/scene_file.h"

namespace {
using namespace penumbra;

const std::string scene = "scenes/coursework.scene", uniform = "uniform", cosine = "+ cosine",
                  halton = "+ Halton", nee = "+ NEE", cosine_halton = "cosine + Halton",
                  cosine_nee = "cosine + NEE", halton_nee = "Halton + NEE", all_three = "all three",
                  mis = "all three, MIS", stratified = "stratified, cosine + NEE",
                  naive = "naive Halton", naive_both = "naive, cosine + NEE";

std::vector<Setting> settings(const std::string& self) {
    auto words = [](const char* sampler, const char* direction, const char* light) {
        return text("--replications 1 --sampler %s --direction %s --light %s", sampler, direction,
                    light);
    };
    const std::string own = self + " --render";
    return {{uniform, words("independent", "uniform", "none")},
            {cosine, words("independent", "bsdf", "none")},
            {halton, words("halton", "uniform", "none")},
            {nee, words("independent", "uniform", "nee")},
            {cosine_halton, words("halton", "bsdf", "none")},
            {cosine_nee, words("independent", "bsdf", "nee")},
            {halton_nee, words("halton", "uniform", "nee")},
            {all_three, words("halton", "bsdf", "nee")},
            {mis, words("halton", "bsdf", "mis")},
            {stratified, words("stratified", "bsdf", "nee")},
            {naive, words("halton", "uniform", "none"), own},
            {naive_both, words("halton", "bsdf", "nee"), own}};
}

// Renders with naive Halton points.
Rendered render(const std::vector<std::string>& words) {
    Technique t;
    t.direction = value_of(words, "--direction") == "bsdf" ? Direction::bsdf : Direction::uniform;
    t.light = value_of(words, "--light") == "nee" ? LightMode::nee : LightMode::none;
    const uint64_t spp = parse_count(value_of(words, "--spp"), 1, UINT32_MAX);
    const double start = processor_seconds();
    Image image = naive_halton::render(read_scene(words.at(0)).scene, t, spp);
    return {std::move(image), {{"cpu_seconds", processor_seconds() - start}}};
}

// Correlation about zero of the errors g - f of horizontally adjacent pixels.
double neighbours(const Image& f, const Image& g) {
    double together = 0, alone = 0;
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x + 1 < f.width; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const double a = double(g.at(x, y)[c]) - double(f.at(x, y)[c]),
                             b = double(g.at(x + 1, y)[c]) - double(f.at(x + 1, y)[c]);
                together += a * b;
                alone += (a * a + b * b) / 2;
            }
    return together / alone;
}

// Adds the image's mean over the reference's, and the variance of this ratio.  Pixels are
// independent, because each has its own randomisation.  Channels are not, and count as one.
void measure(Row& r, const Image& image, const Truth& f) {
    const double mean = image_mean(f.image), n = double(image.pixels.size());
    r.of["ratio"] = r["mean"] / mean;
    r.of["ratio variance"] = sqr(r["off"] / mean) * image_mean(f.image, 2) / n;
    r.of["neighbours"] = neighbours(f.image, image);
}

double z_of(const Rows& rows) {
    return (mean(rows, "ratio") - 1) /
           std::sqrt(mean(rows, "ratio variance") / double(rows.size()));
}

std::string all_settings(Page& page, const Rows& rows) {
    Lines lines;
    for (const auto& [name, some] : grouped(rows, of_setting)) {
        const bool is_naive = name.starts_with("naive");
        const double z = z_of(some);
        lines.push_back({name, told(jackknife(some, relative_error), "%.4f"),
                         gain(rows, name, uniform, efficiency), text("%.4f", mean(some, "ratio")),
                         is_naive ? "" : text("%+.1f", z), is_naive ? "" : text("%.2g", p_of_z(z)),
                         is_naive ? "" : page.verdict(p_of_z(z) > 1e-6)});
    }
    return table({"technique", "relative RMSE, 64 samples", "efficiency, × uniform",
                  "mean / reference", "z", "p", ""},
                 lines);
}

// A contact sheet of crops.  Whole images would be large, because noise does not compress.
Svg pictures(const std::string& program, const std::vector<Setting>& all, const std::string& spp) {
    std::vector<PlotPicture> shown;
    for (const Setting& s : all) {
        const Image image = rendering(text(
            "%s %s %s --spp %s", s.program.empty() ? program : s.program, scene, s.words, spp));
        shown.push_back({part_of(image, 50, 0, {168, image.height}), s.name, spp + " samples"});
    }
    return contact_sheet(shown, 4, 0.6);  // the scene's exposure
}

int study(const Scope& scope) {
    const std::string program = scope.beside();
    Page page(scope, "techniques");
    const uint64_t spp = scope.quick ? 16 : 64, seeds = scope.quick ? 2 : 8;
    const Subject subject{"coursework", scene, 64 * spp};
    const std::vector<Setting> all = settings(scope.self), naives(all.end() - 2, all.end());
    RenderGrid grid("techniques", program);
    grid.measure = measure;
    const Rows equal = grid.run({subject}, all, {spp}, seeds),
               limits = grid.run({subject}, naives, {spp, 8 * spp, 64 * spp}, 1);
    page.set("table", all_settings(page, equal));
    page.plot("techniques", pictures(program, all, text("%.0f", double(spp))));
    page.set("naive", table(limits, of_setting, of_count, [](const Rows& r) {
                 return text("%.4f, mean %.4f", relative_error(r), mean(r, "ratio"));
             }));
    auto gain_of = [&](const std::string& a, const std::string& b) {
        return over(equal, a, b, efficiency);
    };
    const std::pair<const char*, double> gains[] = {
        {"nee", gain_of(nee, uniform)},
        {"cosine", gain_of(cosine, uniform)},
        {"halton", gain_of(halton, uniform)},
        {"both", gain_of(cosine_nee, uniform)},
        {"product", gain_of(cosine, uniform) * gain_of(nee, uniform)},
        {"halton on cosine", gain_of(cosine_halton, cosine)},
        {"halton on nee", gain_of(halton_nee, nee)},
        {"halton on both", gain_of(all_three, cosine_nee)},
        {"mis", gain_of(mis, all_three)},
        {"all", gain_of(mis, uniform)}};
    for (const auto& [word, x] : gains) page.set(word, text("%.1f", x));
    for (const auto& [word, name] :
         {std::pair{"neighbours naive", naive}, std::pair{"neighbours uniform", uniform},
          std::pair{"neighbours halton", halton}})
        page.set(word, text("%.3f", mean(by_setting(equal, name), "neighbours")));
    page.set("seeds", text("%.0f", double(seeds)));
    return page.finish();
}

}  // namespace

int main(int argc, char** argv) {
    const Lab lab{
        "techniques", "Measures the gain of cosine sampling, Halton points and NEE.", {}, render};
    return experiment(argc, argv, lab, study);
}
