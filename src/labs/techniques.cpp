// labs/techniques.cpp  5  what each of three techniques brings
//
//   build/techniques [--reference FILE.pfm] [--time S] [--quick]
//
// Renders scenes/coursework.scene with importance sampling of the cosine (and the lobe), Halton
// points and next-event estimation (NEE), alone and together, and compares the images with a
// reference.  Exit status 1 if an image's mean is not the reference's.
#include "labs/p_of_z.h"
#include "labs/technique_renders.h"

namespace {

using namespace techniques;

// ---- What follows -------------------------------------------------------------------------------

using Number = std::function<double(const Result&)>;

Moments moments(const Results& results, const Number& number) {
    Moments m;
    for (const Result& r : results) m.add(number(r));
    return m;
}

// Seed by seed; naive points have but one result.
Moments ratio(const Results& a, const Results& b, const Number& number) {
    Moments m;
    for (size_t k = 0; k < a.size(); ++k)
        m.add(number(a[k]) / number(b[std::min(k, b.size() - 1)]));
    return m;
}

struct Agreement {
    double z = 0, p = 1;  // of the worst of three channels
};

// Is the image mean right?  Its variance is the sum over the pixels of the spread of each over the
// seeds: every pixel has its own randomisation, so pixels are independent, and thousands of them
// make normal what a few seeds' means are not.
Agreement agreement(const Results& results, const Rendering& reference) {
    Agreement worst;
    const double n = double(results.size()), pixels = double(reference.image.pixels.size());
    for (size_t c = 0; c < 3; ++c) {
        auto channel = [&](const Rendering& r) { return stats(r.stats, "mean_radiance")[c]; };
        auto image_mean = [&](const Result& r) { return channel(r.rendering); };
        double variances = 0;
        for (size_t i = 0; i < reference.image.pixels.size(); ++i) {
            auto pixel = [&](const Result& r) { return double(r.rendering.image.pixels[i][c]); };
            variances += moments(results, pixel).variance();
        }
        const double own = stats(reference.stats, "variance_of_mean")[c],
                     error = std::sqrt(variances / (pixels * pixels * n) + own),
                     z = (moments(results, image_mean).mean - channel(reference)) / error,
                     p = p_of_z(z);
        if (p <= worst.p) worst = {z, p};
    }
    return worst;
}

// Correlation of the errors g - f of horizontal neighbours, about zero.
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

// ---- The report ---------------------------------------------------------------------------------

double d_rel_of_reference(const Study& s) {
    double sum = 0;
    for (double v : stats(s.reference.stats, "variance_of_mean")) sum += v / 3;
    return std::sqrt(sum * double(s.reference.image.pixels.size()) / s.mean_square);
}

void tell_what(Report& report, const Study& s) {
    report.say(text(R"(# Three techniques, measured

`%s` is rendered with uniform directions that find light by chance, then with
importance sampling of the cosine (and the lobe), Halton points and next-event estimation (NEE), alone
and together.  The images g are compared with the reference f, `%s` of %.0f samples per
pixel, over all N numbers, three a pixel: d_rel = √(1/N Σ(f−g)²) / √(1/N Σf²) (Khodulev 1996, ch. 5);
its own is %.5f.  ± is the standard deviation over seeds: %.0f at equal samples, %.0f at equal time; the
naive points know no seed.)",
                    scene, s.plan.reference, double(s.reference.samples()), d_rel_of_reference(s),
                    double(s.plan.seeds), double(s.plan.fewer_seeds)));
}

// Parts of the images, since noise does not compress.
void tell_images(Report& report, const Study& s) {
    auto picture = [](const Rendering& r, const char* name, double d_rel) {
        return Picture{part_of(r.image, 50, 0, {168, r.image.height}), name,
                       text("d_rel %.4f, %.0f spp", d_rel, double(r.samples()))};
    };
    std::vector<Picture> pictures;
    for (size_t t : {uniform, cosine, nee, cosine_nee, halton, cosine_halton, halton_nee, all_three,
                     naive, naive_both, mis})
        pictures.push_back(picture(s.equal[t][0].rendering, all[t].name, s.equal[t][0].d_rel));
    pictures.push_back(picture(s.reference, "reference", d_rel_of_reference(s)));
    report.picture("techniques", contact_sheet(pictures, 4, exposure), "Parts of the images");
}

void tell_table(Report& report, const Study& s) {
    report.head({"technique", text("d_rel, %.0f samples", double(s.plan.spp)),
                 text("d_rel, %g s", s.plan.seconds), text("samples in %g s", s.plan.seconds),
                 "efficiency, × uniform", "mean / reference", "z", "p", ""});
    for (size_t t = 0; t < all.size(); ++t) {
        std::vector<std::string> cells = {
            all[t].name,
            plus_minus(moments(s.equal[t], &Result::d_rel), "%.4f"),
            plus_minus(moments(s.timed[t], &Result::d_rel), "%.4f"),
            text("%.0f", moments(s.timed[t], &Result::samples).mean),
            plus_minus(ratio(s.equal[uniform], s.equal[t], &Result::cost), "%.2f"),
            text("%.4f", moments(s.equal[t], &Result::radiance).mean / mean(s.reference))};
        if (t < naive) {
            const auto [z, p] = agreement(s.equal[t], s.reference);
            for (const std::string& cell :
                 {text("%+.1f", z), text("%.2g", p), report.verdict(p > 1e-6)})
                cells.push_back(cell);
        }
        cells.resize(9);
        report.row(cells);
    }
    report.end_of_table();
    report.say(
        R"(Efficiency is 1 / (d_rel² × core seconds) at equal samples, seed by seed over uniform's.  z is the
image's mean against the reference's in standard errors of both, of three channels the worst; p is
Student's and must be above 10⁻⁶, but for the naive points.  Seconds are of a shared machine, whose
load may have changed meanwhile: efficiency, which counts core seconds, is more to be trusted.)");
}

void tell_gains(Report& report, const Study& s) {
    auto gain = [&](size_t a, size_t b) {
        return ratio(s.equal[b], s.equal[a], &Result::cost).mean;
    };
    auto less_noise = [](const Series& of, size_t a, size_t b) {
        return plus_minus(ratio(of[b], of[a], &Result::mse), "%.2f");
    };
    const double product = gain(cosine, uniform) * gain(nee, uniform);
    report.say(text(R"(## What each brings

* NEE alone is %.1f times as efficient as uniform directions, importance sampling %.1f times, Halton
  points %.1f times.
* NEE and importance sampling together are %.1f times as efficient, and the product would be %.1f: both
  cure the noise of directions that miss the lights.
* Halton points bring %.1f times on top of importance sampling, %.1f on top of NEE, %.1f on top of both.
* MIS brings another %.1f times: light samples seldom hit the narrow Phong lobes, in which scattered rays
  find the lights.
* Independent numbers have %s times the squared error of Halton points at %.0f samples
  with uniform directions and NEE, %s times with cosine and NEE.)",
                    gain(nee, uniform), gain(cosine, uniform), gain(halton, uniform),
                    gain(cosine_nee, uniform), product, gain(cosine_halton, cosine),
                    gain(halton_nee, nee), gain(all_three, cosine_nee), gain(mis, all_three),
                    less_noise(s.many, halton_nee, nee), double(s.plan.many),
                    less_noise(s.many, all_three, cosine_nee)));
}

void tell_naive(Report& report, const Study& s) {
    report.say(R"(## Why a naive Halton seems useless

A first attempt uses bases 2 and 3 again at every bounce and the same points in every pixel.)");
    report.head({"naive points", "samples", "d_rel", "mean / reference"});
    for (size_t name : {naive, naive_both})
        for (const Series* of : {&s.equal, &s.eighth, &s.limit}) {
            const Result& r = (*of)[name][0];
            report.row({all[name].name, text("%.0f", double(r.rendering.samples())),
                        text("%.4f", r.d_rel),
                        text("%.4f", mean(r.rendering) / mean(s.reference))});
        }
    report.end_of_table();
    const Results& independent = s.equal[uniform];
    const Result &first = s.equal[naive][0], &last = s.limit[naive][0];
    const Image& f = s.reference.image;
    auto times = [&](size_t name) {
        return plus_minus(ratio(independent, s.equal[name], &Result::mse), "%.2f");
    };
    report.say(text(
        R"(1. The same bases at every bounce make later directions functions of earlier ones, so that the image
   converges to another limit: at %.0f samples its d_rel is %.4f, where independent numbers
   would be at %.4f.
2. The same points in every pixel turn noise into the discs of the picture: errors of neighbouring pixels
   (from the naive points' own limit) correlate by %.3f, those of independent numbers by %.3f, of
   our Halton points by %.3f.  The eye sees patterns where d_rel sees small errors.
3. One noisy image hardly shows what they bring: at %.0f samples of uniform the squared error of
   independent numbers is %s times that of naive points and %s times that of ours.
4. With NEE the mean may be right while the image is not: a test of means alone would let it pass.)",
        double(s.plan.limit), last.d_rel,
        independent[0].d_rel * std::sqrt(double(s.plan.spp) / double(s.plan.limit)),
        neighbours(last.rendering.image, first.rendering.image),
        neighbours(f, independent[0].rendering.image),
        neighbours(f, s.equal[halton][0].rendering.image), double(s.plan.spp), times(naive),
        times(halton)));
}

int study(const std::string& program, const Effort& plan) {
    Report report(report_folder(plan.quick), "techniques");
    const Study s = render_all(program, plan);
    tell_what(report, s);
    tell_images(report, s);
    tell_table(report, s);
    tell_gains(report, s);
    tell_naive(report, s);
    report.say(made_by(plan.quick ? "build/techniques --quick" : "build/techniques"));
    return report.finish();
}

}  // namespace

int main(int argc, char** argv) {
    Effort plan;
    auto set_seconds = [&](const std::string& s) {
        plan.seconds = parse_number(s);
        if (!(plan.seconds > 0)) throw UserError("--time: " + in_quotes(s) + " is not positive");
    };
    auto make_quick = [&](auto&) { plan = {true, plan.reference, 2, 2, 16, 32, 256, 0.2}; };
    const Lab lab{"techniques",
                  "Measures what cosine, Halton points and next-event estimation bring.",
                  {{"--reference", "FILE.pfm", "compare with this image, beside its FILE.json",
                    [&](auto& file) { plan.reference = file; }},
                   {"--time", "S", "seconds a render at equal time (5)", set_seconds},
                   {"--quick", "", "fewer runs, into out/", make_quick}}};
    return lab_main(argc, argv, lab, [&] { return study(renderer_beside(lab, argv[0]), plan); });
}
