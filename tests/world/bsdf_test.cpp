// world/bsdf_test.cpp  scattering at surfaces: densities, energy, reciprocity, laws of reflection
#include "world/bsdf.h"

#include "base/approx.h"
#include "oracle/expect.h"

namespace {

using std::numbers::pi_v;

Material rough(real kd, real ks, real exponent) {
    return {Rough({kd, kd, kd}, {ks, ks, ks}, exponent)};
}
Material glass(real ior) { return {Glass(ior)}; }

// A direction at the given cosine; `cosines` has normal, oblique and grazing ones.
vec3 at_cosine(real z) { return spherical(z, std::sqrt((1 - z) * (1 + z)), real(0.7)); }
constexpr real cosines[] = {1, real(0.6), real(0.05), real(1e-3)};

// The albedo for light from wo: int f cos dw, by quadrature about the mirror direction in bands of
// doubling width.
double albedo(const Material& m, vec3 wo) {
    oracle::Sphere f;
    f.fit({}, oracle::detail::point(reflect(wo)));
    const double precise = single ? std::max(1e-5, double(m.as<Rough>()->exponent * ulp)) : 1e-9;
    const int depth = single ? 13 : 24;
    auto ring = [&](double theta) {
        auto along = [&](double phi) {
            const oracle::Triple w = f.at({theta, phi});
            return w[2] > 0 ? double(eval(m, wo, {real(w[0]), real(w[1]), real(w[2])}).x) * w[2]
                            : 0;
        };
        double sum = 0;
        for (int i = 0; i < 8; ++i)
            sum += oracle::integral(along, i * pi_v<double> / 4, (i + 1) * pi_v<double> / 4,
                                    oracle::Agreement{precise, precise, depth, false});
        return sum * std::sin(theta);
    };
    double sum = 0;
    for (double from = 0, to = 1e-4; from < pi_v<double>;
         from = to, to = std::min(2 * to, pi_v<double>))
        sum += oracle::integral(ring, from, to, oracle::Agreement{precise, precise, depth, true});
    return sum;
}

}  // namespace

TEST_CASE("directions follow pdf: diffuse, lobe and mixture, exponents 0 to 10^5, grazing too") {
    oracle::Random random(seed_here());
    auto expect = [&](const Material& m, vec3 wo, Direction direction, const std::string& name) {
        oracle::Options o;
        o.axis = oracle::detail::point(direction == Direction::bsdf ? reflect(wo) : vec3{0, 0, 1});
        o.n = 8000;
        o.name = name;
        auto draw_one = [&](double u, double v) {
            const vec2 at{real(u), real(v)};
            const BsdfSample s = sample(m, wo, true, real(random()), at, direction);
            CHECK(s.f == eval(m, wo, s.wi));
            CHECK(s.pdf == pdf(m, wo, s.wi, direction));
            return s.wi;
        };
        auto density = [&](vec3 wi) { return pdf(m, wo, wi, direction); };
        EXPECT(oracle::expect_density(random, draw_one, density, o), 0.13);
    };
    struct Row {
        double kd, ks;
        std::vector<double> exponents;
    };
    for (const auto& [kd, ks, exponents] :
         {Row{0.5, 0, {0}}, {0, 0.9, {20, 1e5}}, {0.3, 0.6, {0, 1, 20, 1e3, 1e5}}})
        for (double exponent : exponents)
            for (real z : cosines) {
                const Material m = rough(real(kd), real(ks), real(exponent));
                const std::string name =
                    oracle::say("kd %g, ks %g, exponent %g, cos %g", kd, ks, exponent, double(z));
                expect(m, at_cosine(z), Direction::bsdf, name);
                if (exponent == 20) expect(m, at_cosine(z), Direction::uniform, name + ", uniform");
            }
}

TEST_CASE("a rough surface reflects kd + ks at normal incidence, never more") {
    for (real exponent : {real(0), real(1), real(20), real(1e3), real(1e5)})
        for (real z : cosines) {
            const double a = albedo(rough(real(0.25), real(0.5), exponent), at_cosine(z));
            const double rounding = single ? std::max(1e-4, 16.0 * exponent * ulp) : 1e-6;
            INFO("exponent ", exponent, ", cos ", z, ": ", a);
            CHECK(a <= 0.75 + rounding);
            if (z == 1) CHECK(std::abs(a - 0.75) < rounding);
        }
}

TEST_CASE("rough surfaces are reciprocal: f(wo, wi) = f(wi, wo), and black from below") {
    oracle::Random random(seed_here());
    const Material m = rough(real(0.2), real(0.7), 30);
    for (int i = 0; i < 10000; ++i) {
        const vec2 u{real(random()), real(random())}, v{real(random()), real(random())};
        const vec3 a = sample_uniform_hemisphere(u), b = sample_uniform_hemisphere(v);
        CHECK(max_abs(eval(m, a, b) - eval(m, b, a)) <= 64 * ulp * max_of(eval(m, a, b)));
        CHECK(max_of(eval(m, a, {b.x, b.y, -b.z})) == 0);
    }
    // At 90 degrees and more from the mirror direction the lobe is 0, also for exponent 0.
    const Material lobe = rough(0, 1, 0);
    CHECK(eval(lobe, at_cosine(real(0.1)), at_cosine(real(0.1))).x == 0);
    CHECK(eval(lobe, {0, 0, 1}, {0, 0, 1}).x == 1 / pi);
}

TEST_CASE("lobes are chosen in proportion to ks and kd") {
    CHECK(rough(real(0.25), real(0.75), 5).as<Rough>()->lobe_probability() == real(0.75));
    CHECK(rough(real(0.5), 0, 5).as<Rough>()->lobe_probability() == 0);
    CHECK(rough(0, real(0.1), 5).as<Rough>()->lobe_probability() == 1);
    CHECK(rough(0, 0, 5).as<Rough>()->lobe_probability() == 0);
}

TEST_CASE("mirrors: wi = (-x, -y, z), f cos / pdf = the reflectance, eval and pdf are 0") {
    const rgb reflectance{real(0.25), real(0.5), real(0.75)};
    const Material m{Mirror(reflectance)};
    for (real z : cosines) {
        const vec3 wo = at_cosine(z);
        const BsdfSample s = sample(m, wo, true, 0, {}, Direction::bsdf);
        CHECK(s.wi == vec3{-wo.x, -wo.y, wo.z});
        CHECK(max_abs(s.f * (s.wi.z / s.pdf) - reflectance) <= 2 * ulp);
        CHECK(max_of(eval(m, wo, s.wi)) == 0);
        CHECK(pdf(m, wo, s.wi, Direction::bsdf) == 0);
    }
}

TEST_CASE("Fresnel: normal incidence, Brewster's angle, grazing, the same from both sides") {
    for (real n : {real(1.1), real(1.5), real(2.4)}) {
        CHECK(fresnel(1, 1, 1 / n) ==
              doctest::Approx(double(sqr((n - 1) / (n + 1)))).epsilon(1e-5));
        // At the Brewster angle, tan = n, the parallel part of the reflection is 0 and the other is
        // ((n^2 - 1) / (n^2 + 1))^2.  The mean of both is half of that.
        const real c = 1 / std::sqrt(1 + n * n), cos_t = std::sqrt(1 - (1 - c * c) / (n * n));
        const double brewster = double(sqr((n * n - 1) / (n * n + 1))) / 2;
        CHECK(fresnel(c, cos_t, 1 / n) == doctest::Approx(brewster).epsilon(1e-5));
        CHECK(fresnel(cos_t, c, n) == doctest::Approx(brewster).epsilon(1e-5));
        CHECK(fresnel(0, std::sqrt(1 - 1 / (n * n)), 1 / n) == 1);
    }
}

TEST_CASE(
    "glass: Snell's law, Fresnel's part, radiance by the square of the index, no energy lost") {
    oracle::Random random(seed_here());
    for (real n : {real(1), real(1.5), real(2.4), real(0.7)})
        for (bool outside : {true, false})
            for (real z : {real(1), real(0.8), real(0.3), real(1e-3)}) {
                const Material m = glass(n);
                const vec3 wo = at_cosine(z);
                const real eta = outside ? 1 / n : n, sin2_t = sqr(eta) * (1 - z * z);
                const BsdfSample up = sample(m, wo, outside, 0, {}, Direction::bsdf);
                const BsdfSample down = sample(m, wo, outside, below_one, {}, Direction::bsdf);
                INFO("index ", n, ", outside ", outside, ", cos ", z);
                if (sin2_t >= 1) {  // total reflection
                    CHECK(down.wi == reflect(wo));
                    CHECK(std::abs(down.f.x * down.wi.z / down.pdf - 1) < 4 * ulp);
                    continue;
                }
                CHECK(down.wi.z < 0);
                CHECK(std::abs(length(down.wi) - 1) < 16 * ulp);
                CHECK(std::abs(down.wi.x + eta * wo.x) < 8 * ulp);
                CHECK(std::abs(down.wi.y + eta * wo.y) < 8 * ulp);
                const real through = down.f.x * -down.wi.z / down.pdf;
                CHECK(std::abs(through - sqr(eta)) < 16 * ulp * sqr(eta));
                // The same part is transmitted back along the path, and the radiance is the
                // original one: f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2.
                const BsdfSample back =
                    sample(m, -down.wi, !outside, below_one, {}, Direction::bsdf);
                const real slope = 1 + 1 / z;  // slope of the Fresnel term near grazing
                CHECK(std::abs(back.pdf - down.pdf) < 64 * ulp * slope);
                CHECK(length(back.wi + wo) < 64 * ulp * slope);
                CHECK(std::abs(back.f.x * -back.wi.z / back.pdf * through - 1) < 64 * ulp);
                if (n == 1) {
                    CHECK(1 - down.pdf <= sqr(4 * ulp / (z * z)));  // rounding of cos_t
                    continue;
                }
                CHECK(up.wi == reflect(wo));
                CHECK(std::abs(up.f.x * up.wi.z / up.pdf - 1) < 4 * ulp);
                CHECK(std::abs(up.pdf + down.pdf - 1) < 4 * ulp);
                if (up.pdf < real(0.01) || up.pdf > real(0.99)) continue;
                uint64_t counts[2] = {};
                for (int i = 0; i < 20000; ++i)
                    ++counts[sample(m, wo, outside, real(random()), {}, Direction::bsdf).wi.z < 0];
                EXPECT(oracle::expect_counts(counts, std::array{double(up.pdf), double(down.pdf)}),
                       0.1);
            }
}

TEST_CASE("emission: on the front only, unless it is two-sided") {
    Material m;
    CHECK(!m.emits());
    m.Le = {0, 0, 2};
    CHECK(m.emits());
    for (real cosine : {real(0.1), real(0), real(-0.1)})
        CHECK(emitted(m, cosine) == (cosine > 0 ? m.Le : rgb{}));
    m.twosided = true;
    CHECK(emitted(m, real(-0.1)) == m.Le);
}
