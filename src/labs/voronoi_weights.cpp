// labs/voronoi_weights.cpp  4  does it pay to weigh a pixel's samples by their Voronoi cells?
//
//   build/voronoi_weights [--size WxH] [--most N] [--scene NAME] [--quick]
//
// The rendering results of Vandewiele et al. 2025, "Voronoi integration of the rendering equation",
// on scenes/cornell.scene and scenes/cornellglossy.scene: 64 ... N samples a pixel, next-event
// estimation.  Every weighting gets the same samples.  Writes voronoi.md and voronoi-SCENE.svg.
#include "base/option.h"
#include "labs/maps.h"
#include "labs/voronoi_pixels.h"

namespace {

using namespace pixels;
using Row = std::vector<std::string>;
constexpr uint64_t replicates = 200;

// ---- The report ---------------------------------------------------------------------------------

void explain(Report& report, const Scope& plan, const std::vector<Result>& all) {
    report.say("# Pixels weighed by Voronoi cells");
    report.say(text(
        "Vandewiele et al. (2025) weigh the samples of a pixel by the areas A of their Voronoi "
        "cells: by cells that sites in a strip around the pixel bound, divided by ΣA (`vor`), "
        "without those that leave the strip (`fvor`), clipped to the pixel (`cvor`), or of the "
        "pixel repeated (`torus`); `mc` has equal weights.  These are the Cornell boxes with a "
        "ball of glass and with a glossy one at %d×%d, with next-event estimation and 64 to %d "
        "samples a pixel.  All of them get the same independent samples (seed 1: 8 sets of 64, 4 "
        "of 256, one of any more); `stratified` has samples of its own, of equal weights, in "
        "jittered strata of at most 256 cells (seed 2).",
        plan.size.width, plan.size.height, int(plan.most)));
    std::string noise;
    for (const Result& r : all)
        noise +=
            text("%s%.1e (%s)", noise.empty() ? "" : ", ",
                 (r.reference.mean[0] + r.reference.mean[1] + r.reference.mean[2]) / 3, r.name);
    report.say(text(
        "MSE is the mean squared error over pixels and channels against references of 8192 samples "
        "by Halton points and multiple importance sampling, whose own squared error, on average "
        "%s, is subtracted.",
        noise));
}

void print_errors(Report& report, const std::vector<Result>& all) {
    report.say("## Squared error");
    report.say("Ratios: MSE of mc over that of the other; in brackets at equal time.");
    Row head = {"scene", "samples", "MSE of mc"};
    for (size_t t = 1; t < techniques; ++t) head.push_back(names[t]);
    report.head(head);
    double path = 0;
    std::vector<double> cells, parts;  // times of cells, and these as parts of all
    uint64_t redraws = 0, fallbacks = 0;
    for (const Result& r : all)
        for (size_t k = 0; k < r.ns.size(); ++k) {
            Row row = {r.name, std::to_string(r.ns[k]), text("%.3e", r.of[k][mc].mse())};
            path = r.time(k, mc);
            for (size_t t = 1; t < techniques; ++t) {
                const double gain = r.gain(k, t), time = r.time(k, t) / path;
                row.push_back(text("%.2f (%.2f)", gain, gain / time));
                if (t == stratified) continue;
                parts.push_back(1 - 1 / time), cells.push_back(r.of[k][t].time());
                redraws += r.of[k][t].redraws, fallbacks += r.of[k][t].fallbacks;
            }
            report.row(row);
        }
    report.end_of_table();
    report.say(text(
        "Tessellation takes %.0f–%.0f %% of the time of a pixel: a path costs %.1f µs, a cell with "
        "what its weight needs %.2f–%.2f.  Strips were drawn again %d times, and weights fell back "
        "to 1/n %d times.",
        100 * quantile(parts, 0), 100 * quantile(parts, 1), 1e6 * path, 1e6 * quantile(cells, 0),
        1e6 * quantile(cells, 1), int(redraws), int(fallbacks)));
}

void print_regions(Report& report, const std::vector<Result>& all) {
    const uint64_t last = all[0].ns.back();
    report.say("## Where the gain comes from");
    report.say(
        text("Ratios of squared errors, mc over the other, at 64 and at %d samples, of the "
             "pixels by what 64 camera rays meet in them.",
             int(last)));
    Row head = {"scene", "region", "of the pixels", text("of mc's MSE at %d", int(last))};
    for (size_t t = 1; t < techniques; ++t) head.push_back(names[t]);
    report.head(head);
    for (const Result& r : all)
        for (size_t region = 0; region < regions; ++region) {
            const PixelEstimates& tally = r.of.back()[mc];
            if (tally.count[region] == 0) continue;
            Row row = {r.name, region_names[region],
                       text("%.2f %%", 100 * tally.count[region] / tally.values()),
                       text("%.1f %%", 100 * tally.squares[region] / tally.sum())};
            for (size_t t = 1; t < techniques; ++t)
                row.push_back(
                    text("%.2f, %.2f", r.gain(0, t, region), r.gain(r.ns.size() - 1, t, region)));
            report.row(row);
        }
    report.end_of_table();
}

// Whether it holds for all scenes and numbers of samples.
template <class Claim>
bool always(const std::vector<Result>& all, Claim claim) {
    bool holds = true;
    for (const Result& r : all)
        for (size_t k = 0; k < r.ns.size(); ++k) holds = holds && claim(r, k);
    return holds;
}

void print_verdict(Report& report, const std::vector<Result>& all) {
    auto verdict = [&](auto claim, const char* words) {
        report.say(report.verdict(always(all, claim), "Confirmed", "**Refuted**") + words);
    };
    report.say("## Verdict");
    verdict([](auto& r, size_t k) { return r.gain(k, cvor) > 1.5; },
            ": in an image the weights halve the squared error, roughly, as published.");
    verdict(
        [](auto& r, size_t k) {
            return r.gain(k, cvor, light_border) > 2 && r.gain(k, cvor, plain) < 1 &&
                   r.gain(0, cvor, ball) < 1;
        },
        ": all of that is in the few pixels that the border of the light crosses, and grows with "
        "the samples there.  Nearly everywhere else, on diffuse surfaces above all, the weights "
        "*raise* the error: unequal weights amplify noise that the position in the pixel does not "
        "explain.  On the balls they do so at 64 samples, too: what a ball reflects, sampled at "
        "random, is such noise (a few bright samples carry it, so that its ratios at many samples "
        "say little).");
    verdict([](auto& r, size_t k) { return r.gain(k, stratified) > r.gain(k, cvor); },
            ": whoever wants the gain takes `--sampler stratified`, which brings more, needs no "
            "tessellation and has no bias.  Only at the border of the light do cells leave strata "
            "behind with many samples: there both errors fall as n^(−3/2), but strata end at 256 "
            "cells, from where on theirs falls as 1/n; and they depend on where an edge parallel "
            "to them cuts a row.");
}

// ---- One pixel ----------------------------------------------------------------------------------

// The pixel of that region where clipped cells take away most variance; on a plain surface just one
// in the middle.
PixelSample telling_pixel(const Result& r, Region region) {
    PixelSample best;
    double most = -INFINITY;
    for (int y = 0; y < r.scene.size.height; ++y)
        for (int x = 0; x < r.scene.size.width; ++x) {
            const auto &plainly = r.variance[mc].at(x, y), &weighed = r.variance[cvor].at(x, y);
            if (!(plainly[0] > 0) || region_of(r.scene, {x, y}) != region) continue;
            double gained = 0;
            for (size_t c = 0; c < 3; ++c) gained += double(plainly[c]) - double(weighed[c]);
            if (region == plain)
                gained = -std::hypot(x - r.scene.size.width / 2, y - r.scene.size.height / 3);
            if (gained > most) most = gained, best = {x, y};
        }
    return best;
}

using Spreads = std::vector<std::array<Moments, techniques>>;  // by n

// Of the mean of the channels.
Spreads replicate(const Result& r, PixelSample p) {
    Spreads all(r.ns.size());
    auto grey = [](const Mean& m) { return (m[0] + m[1] + m[2]) / 3; };
    Weigher weigher;
    for (uint64_t seed = 100; seed < 100 + replicates; ++seed) {
        const Samples s = draw_samples(r.scene, {SamplerKind::independent, seed}, p, r.ns.back());
        for (size_t k = 0; k < r.ns.size(); ++k) {
            for (size_t t = 0; t < weightings.size(); ++t)
                all[k][t].add(grey(weighted(weigher, t, s, {0, r.ns[k]}, seed)));
            all[k][stratified].add(grey(by_strata(r.scene, seed, p, r.ns[k])));
        }
    }
    return all;
}

void print_pixel(Report& report, const Result& r, PixelSample p, const Spreads& spreads) {
    report.say(text("### %s: pixel (%d, %d) at the border of the light", r.name, p.x, p.y));
    report.say(text("Mean ± deviation of %d replicates (seeds 100 …).", int(replicates)));
    Row head = {"samples"};
    head.insert(head.end(), std::begin(names), std::end(names));
    report.head(head);
    for (size_t k = 0; k < r.ns.size(); ++k) {
        Row row = {std::to_string(r.ns[k])};
        for (const Moments& m : spreads[k]) row.push_back(plus_minus(m, "%.3f"));
        report.row(row);
    }
    report.end_of_table();
}

// ---- Pictures -----------------------------------------------------------------------------------

// Of 3x3 pixels.
Image gain_map(const Result& r, const Map& map) {
    const Image &plainly = r.variance[mc], &weighed = r.variance[cvor];
    return painted(plainly.width, plainly.height, [&](int x, int y) {
        double above = 0, below = 0;
        for (int j = std::max(0, y - 1); j <= std::min(plainly.height - 1, y + 1); ++j)
            for (int i = std::max(0, x - 1); i <= std::min(plainly.width - 1, x + 1); ++i)
                for (size_t c = 0; c < 3; ++c) {
                    above += double(weighed.at(i, j)[c]);
                    below += double(plainly.at(i, j)[c]);
                }
        return map(above > 0 && below > 0 ? above / below : 1);
    });
}

// The clipped cells of 256 samples, as bright as what was seen there.
void draw_cells(Svg& sheet, Place at, const Scene& scene, PixelSample p) {
    const Samples s = draw_samples(scene, {SamplerKind::independent, 5}, p, 256);
    double most = 0;
    for (rgb L : s.L) most = std::max(most, double(max_of(L)));
    auto tone = [&](real v) { return int(to_byte(0.9 * std::sqrt(double(v) / most))); };
    auto on_sheet = [&](Site q) {
        return Place{at.x + picture_width * q.x, at.y + picture_width * q.y};
    };
    std::vector<std::vector<Place>> outlines;
    ConvexPolygon polygon;
    for (size_t i = 0; i < s.places.size(); ++i) {
        const Site site = s.places[i];
        polygon.start(seen_from(site, {{0, 0}, {1, 1}}));
        for (size_t j = 0; j < s.places.size(); ++j)
            if (j != i) polygon.cut(bisector(s.places[j] - site, uint32_t(j)));
        auto& outline = outlines.emplace_back();
        for (const Corner& c : polygon.outline())
            outline.push_back(on_sheet({site.x + c.p.x, site.y + c.p.y}));
        const rgb L = s.L[i];
        sheet.area(outline, text("#%02x%02x%02x", tone(L.x), tone(L.y), tone(L.z)).c_str());
    }
    for (const auto& outline : outlines) sheet.line(outline, svg::colours[1], 0.7);
    for (Site site : s.places) sheet.dot(on_sheet(site), svg::colours[2], 1.5);
}

void draw_spreads(Svg& sheet, Place corner, const Result& r, const Spreads& spreads) {
    std::vector<double> n;
    for (uint64_t k : r.ns) n.push_back(double(k));
    const double middle = spreads.back()[stratified].mean,
                 most = std::ceil(1.3 * std::sqrt(spreads[0][mc].variance()));
    Plot plot(sheet, corner, {200, 226}, {"samples", n.front(), n.back(), true, n},
              {"radiance", std::round(middle) - most, std::round(middle) + most, false},
              "border of the light: mean ± deviation");
    size_t colour = 0;
    for (size_t t : {mc, vor, cvor, stratified}) {
        std::vector<double> mean, deviation;
        for (const auto& at_n : spreads) {
            mean.push_back(at_n[t].mean);
            deviation.push_back(std::sqrt(at_n[t].variance()));
        }
        plot.spread(n, mean, deviation, svg::colours[colour++], names[t]);
    }
}

Svg sheet_of(const Result& r, const Spreads& spreads) {
    const Map map{
        {"variance of cvor / that of mc, 3×3 pixels", 0.25, 4, true, {0.25, 0.5, 1, 2, 4}},
        blue_to_red};
    Svg sheet(3 * 288 + 70, 650);
    draw_picture(sheet, {16, 25}, "reference", r.reference.image, double(r.scene.exposure));
    draw_picture(sheet, {304, 25}, "what clipped cells bring at 64 samples", gain_map(r, map), 1);
    draw_scale(sheet, {332, 291}, 200, map);
    draw_spreads(sheet, {650, 25}, r, spreads);
    double left = 16;
    for (Region region : {light_border, ball, plain}) {
        const PixelSample p = telling_pixel(r, region);
        sheet.words({left, 373}, text("%s: pixel (%d, %d)", region_names[region], p.x, p.y));
        draw_cells(sheet, {left, 380}, r.scene, p);
        left += 288;
    }
    return sheet;
}

}  // namespace

int main(int argc, char** argv) {
    Scope plan;
    const Lab lab{
        "voronoi_weights",
        "Weighs pixels' samples by their Voronoi cells, as published and beside strata.",
        {{"--size", "WxH", "of the images (256x256); needs references of that size",
          [&](const std::string& s) {
              const auto [width, height] = parts_of(s, 'x', "WIDTHxHEIGHT");
              plan.size = parse_size(width, height);
          }},
         {"--most", "N", "samples a pixel (256; published: 4096)",
          [&](const std::string& s) { plan.most = parse_count(s, 64, 1 << 16); }},
         {"--scene", "NAME", "only this one", [&](const std::string& s) { plan.scenes = {s}; }},
         {"--quick", "", "every 11th row of pixels; writes into out/, not reference/",
          [&](const std::string&) { plan.quick = true, plan.every = 11; }}}};
    return lab_main(argc, argv, lab, [&] {
        Report report(report_folder(plan.quick || plan.scenes.size() < 2), "voronoi");
        std::vector<Result> all;
        for (const std::string& name : plan.scenes) all.push_back(measure(name, plan));
        explain(report, plan, all);
        print_errors(report, all);
        print_regions(report, all);
        print_verdict(report, all);
        report.say("## One pixel");
        for (const Result& r : all) {
            const PixelSample p = telling_pixel(r, light_border);
            const Spreads spreads = replicate(r, p);
            print_pixel(report, r, p, spreads);
            report.picture("voronoi-" + r.name, sheet_of(r, spreads),
                           "Where cells bring something in " + r.name);
        }
        report.say(made_by(argc, argv));
        return report.finish();
    });
}
