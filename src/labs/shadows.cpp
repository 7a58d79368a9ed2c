// labs/shadows.cpp  3  four estimators of direct light, on images
//
//   build/shadows [--quick] [--only SCENE] [noise] [bias] [efficiency]
//
// What Heitz, Hill and McGuire (2018) say of stochastic, control variate, ratio and regression,
// seen on pixels: noise where all is lit, in penumbra and in umbra beside its prediction; the bias
// of ratio; what each brings for its time.  Tables on stdout, exit status 1 if a claim fails;
// pictures in out/shadows/.  Noise is that of the direct light of surfaces that the camera sees,
// unless told; of its green channel.

#include "app/options.h"
#include "base/program.h"
#include "base/stats.h"
#include "film/passes.h"
#include "labs/plot.h"
#include "shadow/shadow.h"
#include "world/scene_file.h"

namespace {

constexpr const char* names[4] = {"stochastic", "control", "ratio", "regression"};
constexpr Estimator estimators[4] = {Estimator::stochastic, Estimator::control, Estimator::ratio,
                                     Estimator::regression};
const unsigned threads = std::max(1u, std::thread::hardware_concurrency());

struct Plan {
    std::string only = {};                // one scene
    int shrink = 2;                       // of the sides of the images that are measured
    uint64_t look = 1024;                 // samples to find the regions
    uint64_t spp = 64, trials = 1024;     // in penumbra; of these per estimate
    uint64_t bias_trials = 64;            // of 4096 samples
    uint64_t seeds = 3, render_spp = 64;  // whole renders
    size_t most_pixels = 200;             // of a region
};

std::string text(const char* format, auto... values) {
    char line[512];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

int failures = 0;
const char* verdict(bool pass) {
    failures += !pass;
    return pass ? "ok" : "FAILS";
}

// ---- Light of single samples --------------------------------------------------------------------

struct Stage {
    Scene scene;
    Technique technique;
    Pattern pattern;
};

Stage load(const std::string& name, Polygons polygons, int shrink) {
    Stage v{read_scene("scenes/" + name + ".scene").scene, {}, {SamplerKind::independent, 1}};
    v.scene.size = {v.scene.size.width / shrink, v.scene.size.height / shrink};
    for (Light& l : v.scene.lights) l.by_angle = polygons == Polygons::angle;
    v.technique.light = LightMode::nee;
    return v;
}

// Direct light that the camera sees by sample i of a pixel.
Shadowed first_light(const Stage& v, int x, int y, uint64_t i) {
    const Start at = start(v.scene, v.pattern, x, y, i);
    return shadowed(v.scene, step(v.scene, v.technique, {at.ray, at.ray.o}, at.sampler));
}

void add(ShadowMoments& m, const Shadowed& s) {
    m.add(double(s.U.y), double(s.w.y), double(s.wV.y));
}

// ---- Regions ------------------------------------------------------------------------------------

enum Region { lit, penumbra, umbra, mixed, none };
constexpr const char* region_names[5] = {"lit", "penumbra", "umbra", "between", "other"};

struct Regions {
    int width = 0, height = 0;
    std::vector<double> visible;  // sum of w V over sum of w
    std::vector<Region> of;

    std::vector<PixelIndex> pixels(Region r, size_t most) const {
        std::vector<PixelIndex> all;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (of[size_t(y * width + x)] == r) all.push_back({x, y});
        if (all.size() <= most) return all;
        std::vector<PixelIndex> some;
        for (size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
        return some;
    }
};

// Lit and umbra: no sample of the pixel or of its neighbours says otherwise.
Regions find_regions(const Stage& v, uint64_t samples) {
    const int w = v.scene.size.width, h = v.scene.size.height;
    Regions r{w, h, std::vector<double>(size_t(w * h)), std::vector<Region>(size_t(w * h), none)};
    std::vector<char> seen(
        size_t(w * h));  // bit 0: something visible, 1: something occluded, 2: no U
    auto row = [&](int y) {
        for (int x = 0; x < w; ++x) {
            ShadowMoments m;
            char& bits = seen[size_t(y * w + x)];
            for (uint64_t i = 0; i < samples; ++i) {
                const Shadowed s = first_light(v, x, y, (uint64_t(1) << 40) + i);
                add(m, s);
                if (s.w.y > 0) bits = char(bits | (s.wV.y > 0 ? 1 : 2));
                if (!(s.U.y > 0)) bits = char(bits | 4);
            }
            r.visible[size_t(y * w + x)] = visible_part(m);
        }
    };
    parallel_rows(h, threads, row, [](double) {});
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            char bits = 0;
            for (int j = std::max(0, y - 1); j <= std::min(h - 1, y + 1); ++j)
                for (int i = std::max(0, x - 1); i <= std::min(w - 1, x + 1); ++i)
                    bits = char(bits | seen[size_t(j * w + i)]);
            const size_t at = size_t(y * w + x);
            const double V = r.visible[at];
            if (bits == 1)
                r.of[at] = lit;
            else if (bits == 2)
                r.of[at] = umbra;
            else if (!(seen[at] & 4) && V >= 0.1 && V <= 0.9)
                r.of[at] = penumbra;
            else if (!(seen[at] & 4))
                r.of[at] = mixed;
        }
    return r;
}

// ---- Noise beside its prediction ----------------------------------------------------------------

// Of one pixel.
struct Noise {
    double U = 0;
    std::array<Moments, 4> value, beyond_U;  // the estimates; without the pixel's own antialiasing
    std::array<double, 4> predicted{};       // variance
    bool shadow = false;                     // some sample is occluded
    uint64_t blind = 0;                      // estimates none of whose samples found light
};

// Var(w V - beta (w - U)) / n from all the pixel's samples; where U is the same all over the pixel,
// Var(w V), Var(w (1 - V)), Var(w (V - R)) and (1 - corr^2) Var(w V).
Noise measure(const Stage& v, PixelIndex p, uint64_t spp, uint64_t trials) {
    Noise noise;
    ShadowMoments all;
    Moments wV;
    for (uint64_t t = 0; t < trials; ++t) {
        ShadowMoments m;
        for (uint64_t i = 0; i < spp; ++i) {
            const Shadowed s = first_light(v, p.x, p.y, t * spp + i);
            add(m, s);
            wV.add(double(s.wV.y));
            noise.shadow = noise.shadow || s.wV.y < s.w.y;
        }
        all = merge(all, m);
        noise.blind += m.w <= 0;
        for (size_t e = 0; e < 4; ++e) {
            const double value = estimate(estimators[e], m);
            noise.value[e].add(value);
            if (m.w > 0) noise.beyond_U[e].add(value - m.U);
        }
    }
    noise.U = all.U;
    const double R = all.U > 0 ? all.wV / all.U : 0;
    const double betas[4] = {0, 1, R, all.bb > 0 ? all.b_wV / all.bb : 0};
    for (size_t e = 0; e < 4; ++e)
        noise.predicted[e] = (wV.m2 - 2 * betas[e] * all.b_wV + betas[e] * betas[e] * all.bb) /
                             double(all.n) / double(spp);
    return noise;
}

std::vector<Noise> measure(const Stage& v, const std::vector<PixelIndex>& pixels, uint64_t spp,
                           uint64_t trials) {
    std::vector<Noise> noise(pixels.size());
    if (pixels.empty()) return noise;
    auto one = [&](int i) { noise[size_t(i)] = measure(v, pixels[size_t(i)], spp, trials); };
    parallel_rows(int(pixels.size()), threads, one, [](double) {});
    return noise;
}

double quantile(std::vector<double> x, double q) {
    std::sort(x.begin(), x.end());
    return x.empty() ? NAN : x[size_t(q * double(x.size() - 1) + 0.5)];
}

void print_noise(const Stage& v, const Regions& regions, const Plan& plan) {
    std::printf(
        "| region | pixels | estimator | noise | variance, x stochastic | / predicted | pixels "
        "within 15 %% | claim |\n"
        "|---|---|---|---|---|---|---|---|\n");
    for (Region r : {lit, penumbra, umbra}) {
        const auto pixels = regions.pixels(r, plan.most_pixels);
        auto noise = measure(v, pixels, plan.spp, r == penumbra ? plan.trials : plan.trials / 8);
        // What the reference did not see.
        if (r == lit) std::erase_if(noise, [](const Noise& n) { return n.shadow; });
        uint64_t blind = 0;
        for (const Noise& n : noise) blind += n.blind;
        for (size_t e = 0; e < 4 && !noise.empty(); ++e) {
            double variance = 0, predicted = 0, U2 = 0;
            uint64_t within = 0, silent = 0;
            std::vector<double> gain;
            for (const Noise& n : noise) {
                variance += n.value[e].variance();
                predicted += n.predicted[e];
                U2 += n.U * n.U;
                gain.push_back(n.value[e].variance() / n.value[0].variance());
                within += std::abs(n.value[e].variance() / n.predicted[e] - 1) < 0.15;
                // Umbra: the estimate is 0; lit: it is the mean of U.
                silent += r == lit ? n.beyond_U[e].m2 == 0 && n.beyond_U[e].mean == 0
                                   : n.value[e].m2 == 0 && n.value[e].mean == 0;
            }
            const double part = double(within) / double(noise.size());
            std::string claim;
            if (r == penumbra) {
                claim = verdict(std::abs(variance / predicted - 1) < 0.15);
            } else if ((r == lit && (e == 1 || e == 2)) || (r == umbra && (e == 0 || e >= 2))) {
                claim = text("exactly %s in %llu%s: %s", r == lit ? "U" : "0",
                             static_cast<unsigned long long>(silent),
                             r == lit && blind ? text(", but for %llu estimates without light",
                                                      static_cast<unsigned long long>(blind))
                                                     .c_str()
                                               : "",
                             verdict(silent == noise.size()));
            }
            std::printf(
                "| %s | %zu | %s | %.4f | %s | %s | %s | %s |\n", region_names[r], noise.size(),
                names[e], std::sqrt(variance / U2 * double(plan.spp)),
                r == umbra
                    ? ""
                    : text("%.2f ... %.2f", quantile(gain, 0.1), quantile(gain, 0.9)).c_str(),
                r == penumbra ? text("%.3f", variance / predicted).c_str() : "",
                r == penumbra ? text("%.1f %%", 100 * part).c_str() : "", claim.c_str());
        }
    }
    std::fflush(stdout);
}

// ---- Bias ---------------------------------------------------------------------------------------

constexpr int steps = 13;  // N = 1 ... 4096

// Mean over trials of ratio (and regression) minus mean(w V) - beta mean(w - U), which is unbiased.
struct Bias {
    std::array<std::array<Moments, 2>, steps> excess, value;
};

Bias measure_bias(const Stage& v, PixelIndex p, uint64_t trials, int last) {
    Bias bias;
    ShadowMoments all;
    for (uint64_t i = 0; i < 4096; ++i) add(all, first_light(v, p.x, p.y, (uint64_t(1) << 41) + i));
    const double betas[2] = {all.wV / all.U, all.b_wV / all.bb};
    for (uint64_t t = 0; t < trials; ++t) {
        ShadowMoments m;
        for (int k = 0; k < last; ++k) {
            while (m.n < uint64_t(1) << k) add(m, first_light(v, p.x, p.y, t * 4096 + m.n));
            for (size_t e = 0; e < 2; ++e) {
                const double value = estimate(estimators[2 + e], m);
                bias.value[size_t(k)][e].add(value);
                bias.excess[size_t(k)][e].add(value - (m.wV - betas[e] * (m.w - m.U)));
            }
        }
    }
    return bias;
}

void print_bias(const Stage& v, const Regions& regions, const Plan& plan) {
    const auto pixels = regions.pixels(penumbra, plan.most_pixels / 2);
    std::vector<Bias> biases(pixels.size());
    auto one = [&](int i) {
        biases[size_t(i)] = measure_bias(v, pixels[size_t(i)], plan.bias_trials, steps);
    };
    parallel_rows(int(pixels.size()), threads, one, [](double) {});
    std::printf(
        "\n## The bias of ratio\n\n%zu penumbra pixels, %llu trials.  Mean: of all pixels, "
        "radiance; rms: root mean square over the pixels, its own noise taken out.\n\n"
        "| N | ratio: mean bias | N x mean | rms bias | rms noise of a pixel | rms bias / noise | "
        "regression: rms bias |\n|---|---|---|---|---|---|---|\n",
        pixels.size(), static_cast<unsigned long long>(plan.bias_trials));
    double slope_x = 0, slope_y = 0, slope_xx = 0, slope_xy = 0, points = 0;
    for (int k = 0; k < steps; ++k) {
        double mean[2] = {}, square[2] = {}, variance = 0, error2 = 0;
        const double count = double(pixels.size());
        for (const Bias& b : biases)
            for (size_t e = 0; e < 2; ++e) {
                const Moments& x = b.excess[size_t(k)][e];
                mean[e] += x.mean / count;
                const double own = x.standard_error() * x.standard_error();
                square[e] += (x.mean * x.mean - own) / count;
                if (e == 0) {
                    variance += b.value[size_t(k)][0].variance() / count;
                    error2 += own / (count * count);
                }
            }
        const double N = double(uint64_t(1) << k), rms = std::sqrt(std::max(0.0, square[0])),
                     noise = std::sqrt(variance);
        std::printf("| %.0f | %+.2e ± %.0e | %+.4f | %.2e | %.2e | %.4f | %.2e |\n", N, mean[0],
                    std::sqrt(error2), N * mean[0], rms, noise, rms / noise,
                    std::sqrt(std::max(0.0, square[1])));
        if (k >= 3 && rms > 0) {
            const double x = std::log(N), y = std::log(rms);
            slope_x += x, slope_y += y, slope_xx += x * x, slope_xy += x * y, ++points;
        }
    }
    const double slope =
        (points * slope_xy - slope_x * slope_y) / (points * slope_xx - slope_x * slope_x);
    std::printf("\nrms bias falls as N^%.2f from N = 8 on: %s\n", slope,
                verdict(std::abs(slope + 1) < 0.1));
    std::fflush(stdout);
}

// ---- Whole renders ------------------------------------------------------------------------------

struct Render {
    Image image;
    double core_seconds = 0;
};
Render render(const std::string& program, const std::string& scene, std::vector<std::string> more) {
    const std::string stem = "out/shadows/" + std::to_string(::getpid()), pfm = stem + ".pfm",
                      json = stem + ".json";
    std::vector<std::string> words = {
        program, "--quiet", "--light", "nee", "scenes/" + scene + ".scene",
        "-o",    pfm,       "--stats", json};
    words.insert(words.end(), more.begin(), more.end());
    execute(words);
    const std::string stats = read_file(json), key = "\"cpu_seconds\": ";
    Render r{read_pfm(pfm), std::stod(stats.substr(stats.find(key) + key.size()))};
    std::filesystem::remove(pfm);
    std::filesystem::remove(json);
    return r;
}

// Whole renders at equal samples, and the variance that each states of itself.
void write_renders(const std::string& program, const std::string& scene) {
    for (const char* name : names)
        for (const bool variance : {false, true}) {
            std::vector<std::string> words = {
                program,
                "--quiet",
                "--light",
                "nee",
                "--direct",
                name,
                "--polygons",
                "angle",
                "--spp",
                "16",
                "-o",
                "out/shadows/" + scene + "-" + name + (variance ? "-variance.png" : ".png"),
                "scenes/" + scene + ".scene"};
            if (variance) words.insert(words.end(), {"--view", "variance", "--exposure", "200"});
            execute(words);
        }
}

// Efficiency 1 / (variance x core seconds) over stochastic's.  Variance from seed to seed, of the
// mean of the channels; bias at this many samples is below a hundredth of it.
void print_efficiency(const std::string& program, const std::string& scene, const char* depth,
                      const Plan& plan) {
    const Stage v =
        load(scene, Polygons::angle, scene == "cornell" ? 2 * plan.shrink : plan.shrink);
    const Regions regions = find_regions(v, plan.look / 4);
    const size_t n = regions.of.size();
    for (const char* sampler : {"independent", "halton"}) {
        std::array<std::array<double, 6>, 4> variances{};
        std::array<double, 4> seconds{};
        std::array<size_t, 6> count{};
        std::vector<std::array<Moments, 4>> pixels(n);
        for (uint64_t seed = 0; seed < plan.seeds; ++seed)
            for (size_t e = 0; e < 4; ++e) {
                std::vector<std::string> more = {
                    "--direct",   names[e],
                    "--sampler",  sampler,
                    "--polygons", "angle",
                    "--seed",     std::to_string(100 + seed),
                    "--spp",      std::to_string(plan.render_spp),
                    "--size",     text("%dx%d", regions.width, regions.height)};
                if (*depth) more.insert(more.end(), {"--depth", depth});
                const Render r = render(program, scene, more);
                seconds[e] += r.core_seconds / double(plan.seeds);
                for (size_t i = 0; i < n; ++i)
                    pixels[i][e].add((double(r.image.pixels[i][0]) + double(r.image.pixels[i][1]) +
                                      double(r.image.pixels[i][2])) /
                                     3);
            }
        for (size_t i = 0; i < n; ++i) ++count[size_t(regions.of[i])];
        for (size_t e = 0; e < 4; ++e)
            for (size_t i = 0; i < n; ++i)
                for (size_t region : {size_t(regions.of[i]), size_t(5)})
                    variances[e][region] += pixels[i][e].variance();
        // Variances of 0 have no ratio.
        auto gain = [&](size_t e, size_t region) -> std::string {
            const double mine = variances[e][region], plain = variances[0][region];
            if (region < 5 && count[region] == 0) return "–";
            if (mine <= 0 || plain <= 0) return mine > 0 ? "0" : plain > 0 ? "∞" : "0/0";
            return text("%.2f", plain * seconds[0] / (mine * seconds[e]));
        };
        for (size_t e = 0; e < 4; ++e) {
            std::printf("| %s%s%s | %s | %s | %.3f |", scene.c_str(), *depth ? ", depth " : "",
                        depth, sampler, names[e], seconds[e] / seconds[0]);
            for (size_t region : {0, 1, 2, 3, 4, 5}) std::printf(" %s |", gain(e, region).c_str());
            std::printf("\n");
        }
        std::fflush(stdout);
    }
}

// ---- Pictures -----------------------------------------------------------------------------------

// Direct light by each estimator, its noise, and which pixels are what.
void write_sheet(const std::string& name, const Stage& v, double exposure) {
    constexpr int spp = 16, trials = 8;
    const int w = v.scene.size.width, h = v.scene.size.height, gap = 8;
    std::array<Image, 4> images{Image(w, h), Image(w, h), Image(w, h), Image(w, h)}, noise = images;
    Image seen(w, h);
    auto row = [&](int y) {
        for (int x = 0; x < w; ++x) {
            std::array<std::array<Moments, 4>, 3> values;
            ShadowMoments all;
            for (int t = 0; t < trials; ++t) {
                std::array<ShadowMoments, 3> m;
                for (int i = 0; i < spp; ++i) {
                    const Shadowed s = first_light(v, x, y, uint64_t(t * spp + i));
                    for (size_t c = 0; c < 3; ++c)
                        m[c].add(double(s.U.*axis[c]), double(s.w.*axis[c]), double(s.wV.*axis[c]));
                }
                all = merge(all, m[1]);
                for (size_t c = 0; c < 3; ++c)
                    for (size_t e = 0; e < 4; ++e) {
                        const double value = estimate(estimators[e], m[c]);
                        values[c][e].add(value);
                        if (t == 0) images[e].at(x, y)[c] = float(exposure * value);
                    }
            }
            for (size_t c = 0; c < 3; ++c) {
                for (size_t e = 0; e < 4; ++e)
                    noise[e].at(x, y)[c] = float(4 * exposure * std::sqrt(values[1][e].variance()));
                seen.at(x, y)[c] = float(visible_part(all));
            }
        }
    };
    parallel_rows(h, threads, row, [](double) {});
    Image sheet(5 * (w + gap) + gap, 2 * (h + 22) + gap);
    sheet.pixels.assign(sheet.pixels.size(), {0.01f, 0.01f, 0.01f});
    auto paste = [&](const Image& image, int column, int line, const std::string& words) {
        const int left = gap + column * (w + gap), top = gap + line * (h + 22);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) sheet.at(left + x, top + y) = image.at(x, y);
        draw_text(sheet, {double(left), double(top + h + 5)}, words, {0.8f, 0.8f, 0.8f});
    };
    for (int e = 0; e < 4; ++e) {
        paste(images[size_t(e)], e, 0, text("%s, %d samples", names[e], spp));
        paste(noise[size_t(e)], e, 1, "standard deviation, x 4");
    }
    paste(seen, 4, 0, "visible part");
    write_image("out/shadows/" + name + ".png", sheet, 1);
}

// The bias of ratio, 200 times: red too bright, blue too dark.
void write_bias_sheet(const Stage& v, const Regions& regions, uint64_t trials) {
    const int w = regions.width, h = regions.height, gap = 8, last = 5;
    Image sheet(last * (w + gap) + gap, h + 22 + gap);
    sheet.pixels.assign(sheet.pixels.size(), {0.01f, 0.01f, 0.01f});
    auto row = [&](int y) {
        for (int x = 0; x < w; ++x) {
            const Region r = regions.of[size_t(y * w + x)];
            const bool biased = r == penumbra || r == mixed;
            const Bias bias = biased ? measure_bias(v, {x, y}, trials, last) : Bias{};
            for (int k = 0; k < last; ++k) {
                const float b = float(200 * bias.excess[size_t(k)][0].mean);
                sheet.at(gap + k * (w + gap) + x, gap + y) = {0.5f + b, 0.5f - std::abs(b) / 2,
                                                              0.5f - b};
            }
        }
    };
    parallel_rows(h, threads, row, [](double) {});
    for (int k = 0; k < last; ++k)
        draw_text(sheet, {double(gap + k * (w + gap)), double(gap + h + 5)}, text("N = %d", 1 << k),
                  {0.8f, 0.8f, 0.8f});
    write_image("out/shadows/bias.png", sheet, 1);
}

void print_all_noise(const Plan& plan) {
    const struct {
        const char* scene;
        Polygons polygons;
    } configurations[] = {{"penumbra", Polygons::area},
                          {"panel", Polygons::area},
                          {"panel", Polygons::angle},
                          {"lanterns", Polygons::angle}};
    std::printf(
        "\nNoise: standard deviation of one sample over U, root mean square over the region.  "
        "Variance: "
        "10th ... 90th percentile of the pixels; sum over pixels / sum of predictions.\n");
    for (const auto& [scene, polygons] : configurations) {
        if (!plan.only.empty() && plan.only != scene) continue;
        const char* how = polygons == Polygons::area ? "area" : "angle";
        std::printf("\n## %s, quads by %s\n\n", scene, how);
        const Stage small = load(scene, polygons, plan.shrink);
        // Many lights: the predictions are those of many samples.
        Plan here = plan;
        if (small.scene.lights.size() > 8) here.spp *= 4, here.trials /= 2, here.most_pixels /= 2;
        std::printf("%llu samples an estimate.\n\n", static_cast<unsigned long long>(here.spp));
        print_noise(small, find_regions(small, plan.look), here);
        const Stage whole = load(scene, polygons, plan.shrink / 2);
        write_sheet(text("%s-%s", scene, how), whole, double(whole.scene.exposure));
    }
}

void print_all_efficiency(const std::string& program, const Plan& plan) {
    for (const std::string scene : {"penumbra", "panel", "lanterns"})
        if (plan.only.empty() || plan.only == scene) write_renders(program, scene);
    std::printf(
        "\n## Efficiency, x stochastic\n\n%llu samples, %llu seeds, whole renders, quads by "
        "angle\n\n| scene | sampler | estimator | time | lit | penumbra | umbra | between | other "
        "| whole image |\n|---|---|---|---|---|---|---|---|---|---|\n",
        static_cast<unsigned long long>(plan.render_spp),
        static_cast<unsigned long long>(plan.seeds));
    for (const auto& [scene, depth] : {std::pair{"penumbra", "1"},
                                       {"penumbra", ""},
                                       {"panel", ""},
                                       {"lanterns", ""},
                                       {"coursework", ""},
                                       {"cornell", ""}})
        if (plan.only.empty() || plan.only == scene) print_efficiency(program, scene, depth, plan);
}

int run(const std::string& self, const std::vector<std::string>& words) {
    Plan plan;
    bool noise = false, bias = false, efficiency = false;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "--quick")
            plan = {plan.only, 8, 128, 64, 64, 8, 2, 16, 20};
        else if (word == "--only" && i + 1 < words.size())
            plan.only = words[++i];
        else if (word == "noise")
            noise = true;
        else if (word == "bias")
            bias = true;
        else if (word == "efficiency")
            efficiency = true;
        else
            throw UserError(
                unknown("word", word, {"--quick", "--only", "noise", "bias", "efficiency"}));
    }
    if (!noise && !bias && !efficiency) noise = bias = efficiency = true;
    std::filesystem::path program = self;  // build/shadows-float runs build/penumbra-float
    program.replace_filename(program.filename().string().replace(0, 7, "penumbra"));
    if (::access(program.c_str(), X_OK) != 0)
        throw UserError(program.string() + ": cannot run; say  make programs");
    std::filesystem::create_directories("out/shadows");

    std::printf("# Four estimators of direct light\n");
    if (noise) print_all_noise(plan);
    if (bias) {
        const Stage v = load("penumbra", Polygons::area, plan.shrink);
        const Regions regions = find_regions(v, plan.look);
        print_bias(v, regions, plan);
        write_bias_sheet(v, regions, 4 * plan.bias_trials);
    }
    if (efficiency) print_all_efficiency(program, plan);
    std::printf("\n%d claims failed; pictures in out/shadows/\n", failures);
    return failures > 0;
}

}  // namespace

int main(int argc, char** argv) {
    return exit_status([&] { return run(argv[0], {argv + 1, argv + argc}); });
}
