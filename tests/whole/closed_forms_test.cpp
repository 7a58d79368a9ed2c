// whole/closed_forms_test.cpp  scenes of known radiance, by every technique, at one significance
#include "app/options.h"
#include "base/cases.h"
#include "base/moments.h"
#include "oracle/expect.h"
#include "path/paths.h"
#include "text/scene_file.h"
#include "whole/known_scenes.h"

using namespace closed_forms;

namespace {

// The options as a user writes them: a new option takes one more row.
const char* const samplers[] = {"--sampler independent", "--sampler stratified", "--sampler halton",
                                "--sampler sobol"};
std::vector<std::string> techniques() {
    std::vector<std::string> all;
    for (const char* roulette : {"", " --roulette 1"})
        for (const char* direction : {"--direction uniform", "--direction bsdf"})
            for (const char* light : {" --light none", " --light nee", " --light mis"})
                all.push_back(std::string(direction) + light + roulette);
    return all;
}

Options options_of(const std::string& said) {
    Options o;
    OptionTable table = option_table(o);
    parse_options(table, o, split(said + " --quiet scene"));
    return o;
}

const char* why_empty(const Known& k, const Scene& scene, const Options& o, bool first) {
    if (scene.depth == 0 && !first) return unscattered;
    if (o.technique.light == LightMode::none && k.no_none) return k.no_none;
    if (o.technique.light == LightMode::nee && k.no_nee) return k.no_nee;
    if (o.technique.light == LightMode::nee && o.technique.roulette == 1 && scene.depth == 1)
        return idle;
    return nullptr;
}

// One sample of the known radiance.
double measure(const Known& k, const Scene& scene, const Options& o,
               const SamplerSettings& settings, uint64_t sample) {
    if (!k.start) return double(mean_of(radiance(scene, o.technique, settings, 0, 0, sample)));
    const Sampler sampler(settings, 0, sample);
    const vec2 u = sampler.get2(film_x);
    return double(mean_of(Li(scene, o.technique, k.start(u), sampler)));
}

// A cell of the matrix: the reason why it is empty, or its verdict.
struct Cell {
    const char* empty = nullptr;
    oracle::Verdict verdict;
    double score = 0;    // standard normal if correct
    double error = 0;    // standard error relative to the truth
    bool exact = false;  // only rounding errors
};

// The standard normal number with the p-value of t with df degrees of freedom.
double normal_score(double t, double df) {
    return std::copysign(oracle::detail::where_equal(oracle::p_of_z, oracle::p_of_t(t, df)), t);
}

// n independent samples, or n in 64 randomisations if samples are dependent.  Samples are bounded
// (cells with unbounded ones stay empty).  So only skewness can mislead the t-test, and it keeps
// its alpha from n = 1000 skewness^2 on.
Cell check(const Known& k, const Scene& scene, const Options& o, uint64_t n) {
    const bool independent = o.sampler == SamplerKind::independent;
    const int replicates = independent ? 1 : 64;
    const uint64_t points = n / uint64_t(replicates);
    SamplerSettings settings = sampler_settings(o.sampler, o.seed, scene.depth);
    Moments samples, means;
    oracle::Draws draws;
    for (int i = 0; i < replicates; ++i, ++settings.seed) {
        Moments of_one;
        for (uint64_t j = 0; j < points; ++j) {
            const double x = measure(k, scene, o, settings, j);
            of_one.add(x), draws.add(x);
        }
        samples.merge(of_one);
        means.add(of_one.mean);
    }
    Cell cell;
    oracle::Estimate e = estimate(independent ? samples : means);
    const double rounding = 256 * double(ulp) * k.truth;
    cell.exact = e.standard_error < rounding;
    e.standard_error = std::hypot(e.standard_error, rounding);
    const double needed = cell.exact ? 0 : 1000 * std::pow(draws.skewness(), 2);
    cell.verdict = needed <= double(samples.n)
                       ? oracle::expect_mean(k.truth, e)
                       : oracle::detail::failure(
                             oracle::say("%.0f samples needed for their skewness", needed));
    cell.score = normal_score((e.mean - k.truth) / e.standard_error, e.df);
    cell.error = e.standard_error / k.truth;
    return cell;
}

// One verdict for all cells of a scene, which share its truth and most of the program.  The sum of
// m standard normals over sqrt m is standard normal (Stouffer 1949).  A common relative bias shifts
// it by the sum of bias / error over sqrt m.
struct Pooled {
    double score = 0;
    oracle::Verdict verdict{true, 1, 0, "exact"};
};
Pooled pooled(const std::vector<Cell>& cells) {
    double sum = 0, power = 0, m = 0;
    for (const Cell& c : cells)
        if (!c.empty && !c.exact) ++m, sum += c.score, power += 1 / c.error;
    if (m == 0) return {};
    return {sum / std::sqrt(m), oracle::expect_mean(1, {1 + sum / power, std::sqrt(m) / power})};
}

void print_matrix(const std::vector<Known>& rows, const std::vector<std::vector<Cell>>& matrix,
                  const std::vector<Pooled>& all) {
    const std::vector<std::string> columns = techniques();
    std::vector<const char*> reasons;
    auto letter_of = [&](const char* reason) {
        auto found = std::find(reasons.begin(), reasons.end(), reason);
        if (found == reasons.end()) found = reasons.insert(found, reason);
        return char('a' + (found - reasons.begin()));
    };
    std::printf("Sigmas off the closed form; ==: exact but for rounding\n");
    for (size_t t = 0; t < columns.size(); ++t)
        std::printf("  %c  %s\n", int('A' + t), columns[t].c_str());
    for (size_t s = 0; s < std::size(samplers); ++s) {
        std::printf("%-32s", samplers[s]);
        for (size_t t = 0; t < columns.size(); ++t) std::printf("%5c", int('A' + t));
        std::puts("");
        for (size_t r = 0; r < rows.size(); ++r) {
            std::string line = oracle::say("%-32s", rows[r].name);
            for (size_t t = 0; t < columns.size(); ++t) {
                const Cell& c = matrix[r][s * columns.size() + t];
                line += c.empty   ? oracle::say("  (%c)", letter_of(c.empty))
                        : c.exact ? "   =="
                                  : oracle::say("%+5.1f", c.score);
            }
            std::puts(line.c_str());
        }
    }
    for (size_t i = 0; i < reasons.size(); ++i)
        std::printf("  (%c)  %s\n", int('a' + i), reasons[i]);
    std::printf("%-32s  sigmas  smallest bias seen with 99.9 %% power\n", "all cells of a scene");
    for (size_t r = 0; r < rows.size(); ++r) {
        const auto& [score, verdict] = all[r];
        std::printf("%-32s   %+4.1f   %.2g %%\n", rows[r].name, score, 100 * verdict.delta_min);
    }
}

}  // namespace

TEST_CASE("the closed forms have their published values") {
    auto near = [](double a, double b, double digits) {
        return std::abs(a - b) <= 0.5000001 * digits;
    };
    auto cosine = [](double degrees) { return std::cos(degrees * Pi / 180); };
    CHECK(near(sphere_irradiance(0.5, cosine(75)), 0.221200880053, 1e-12));
    CHECK(near(sphere_irradiance(0.5, cosine(90)), 0.090586073706, 1e-12));
    CHECK(near(sphere_irradiance(0.5, cosine(105)), 0.017924877377, 1e-12));
    CHECK(near(half_sphere_irradiance(0.5, cosine(30), 0.5), 0.385380, 1e-6));
    CHECK(near(half_sphere_irradiance(0.5, cosine(30), -0.5), 0.294794, 1e-6));
    CHECK(near(polygon_irradiance({{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}), 1.740839502734,
               1e-12));
    CHECK(near(polygon_irradiance({{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}), 0.350188287714,
               1e-12));
    CHECK(near(opposed(1, 1), 0.199824895698, 1e-12));
    CHECK(near(perpendicular(1, 1), 0.200043776075, 1e-12));
    CHECK(near(coaxial(1, 2, 1.5), 0.601653344388, 1e-12));
    CHECK(near(rectangle_solid_angle(1, 1), 4 * Pi / 6, 1e-14));
    // A sphere grazing the horizon, from both sides; a disc overhead.
    CHECK(near(sphere_irradiance(0.5, 0.5 - 1e-9), sphere_irradiance(0.5, 0.5), 1e-8));
    CHECK(near(element_to_disc(1e-4, 1, 2), 0.2, 1e-8));
}

TEST_CASE("every technique finds every closed form") {
    const std::vector<Known> rows = known_scenes();
    std::vector<std::vector<Cell>> matrix;
    std::vector<Pooled> all;  // for each row
    double chi2 = 0, scores = 0;
    for (const Known& k : rows) {
        const Scene scene = parse_scene(k.text, k.name).scene;
        std::vector<Cell> cells;
        for (const char* sampler : samplers)
            for (const std::string& technique : techniques()) {
                const std::string said = sampler + (" " + technique);
                Options o = options_of(said);
                o.seed = oracle::seed_of(k.name + said);
                Cell cell;
                cell.empty = why_empty(k, scene, o, technique == techniques()[0]);
                if (!cell.empty) {
                    const bool by_chance = o.technique.light == LightMode::none;
                    cell = check(k, scene, o, uint64_t(by_chance ? k.chance : k.aimed) * 4096);
                    EXPECT(cell.verdict.of(oracle::say("%s, %s", k.name, said.c_str())),
                           by_chance ? 0.22 : 0.15);
                    if (!cell.exact) chi2 += cell.score * cell.score, ++scores;
                }
                cells.push_back(cell);
            }
        all.push_back(pooled(cells));
        EXPECT(all.back().verdict.of(oracle::say("%s, all techniques", k.name)), 0.015);
        matrix.push_back(cells);
    }
    print_matrix(rows, matrix, all);
    // If the standard errors are right, the scores are standard normal.
    const double above = oracle::detail::p_of_chi2(chi2, scores),
                 p = 2 * std::min(above, 1 - above);
    ++oracle::statistical_checks;
    oracle::alpha_spent += 1e-6;
    INFO("chi-squared of all sigmas: ", chi2, " of ", scores, " degrees of freedom, p = ", p);
    CHECK(p > 1e-6);
}
