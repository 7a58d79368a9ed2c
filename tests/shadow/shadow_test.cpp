// shadow/shadow_test.cpp  the unshadowed term against light samples; four estimators against closed
// forms
#include "shadow/shadow.h"

#include "base/moments.h"
#include "film/fill.h"
#include "oracle/expect.h"
#include "shadow/population.h"
#include "world/scene_file.h"

namespace {

constexpr bool single = sizeof(real) == 4;

// A surface that no ray can hit, seen straight from above: what its light samples bring.
struct Receiver {
    Scene scene;
    Surface x;
    Frame local;
    Material material;

    // What happens at the receiver, as far as direct light goes.
    Step sample(uint64_t i, uint64_t seed = 1) const {
        const Pattern pattern{SamplerKind::independent, seed};
        Step e;
        e.met = true, e.x = Vertex{{}, x, &material, 1, local, {0, 0, 1}};
        e.direct =
            direct_light(scene, {Direction::bsdf, LightMode::nee}, e.x, Sampler(pattern, 0, i), 0);
        return e;
    }
    Shadowed shadowed_sample(uint64_t i, uint64_t seed = 1) const {
        return shadowed(scene, sample(i, seed));
    }
};

// Statements are lights and obstacles about the origin.
Receiver receiver(const std::string& statements, vec3 n, bool by_angle = false) {
    Receiver r;
    r.scene =
        parse_scene(
            "camera 0 0 9  0 0 0  40\ndiffuse black 0 0 0\nsphere 0 -99 0  1  black\n" + statements,
            "test")
            .scene;
    for (Light& l : r.scene.lights) l.by_angle = by_angle;
    r.x = {{0, 0, 0}, unit(n), 0};
    r.local = frame(r.x.n);
    r.material.kd = {real(0.5), real(0.25), real(0.125)};
    return r;
}

// Sphere light of radiance 1 at distance 2, radius 1 (s = 0.5), in direction `degrees` from +y.
std::string sphere_at(double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return oracle::say("light lamp 1 1 1\nsphere %.17g %.17g 0  1  lamp\n", 2 * std::sin(a),
                       2 * std::cos(a));
}

// Half of that sphere, at 30 degrees, behind a wall across the axis whose edge meets the axis; the
// visible half is the one on the side of h = +-(cos 30, -sin 30, 0).
std::string knife_edge(int side) {
    const double c = std::cos(std::numbers::pi / 6), s = 0.5;
    // Corner on the axis at distance 0.8, 4 to the front; edges 8 along z and 4 towards -h.
    return sphere_at(30) + oracle::say("quad %.17g %.17g -4   0 0 8   %.17g %.17g 0   black\n",
                                       0.8 * s, 0.8 * c, -4 * side * c, 4 * side * s);
}
double knife_edge_irradiance(int side) {
    const double pi_ = std::numbers::pi, s = 0.5, sigma = std::asin(s), c30 = std::cos(pi_ / 6);
    return pi_ / 2 * s * s * c30 + (sigma - s * std::sqrt(1 - s * s)) * -side * 0.5;
}

const char* const many = R"(
light red 3 1 0.5
light green 0.5 4 1
light blue 1 1 6 twosided
quad -1 1.5 -1   0.5 0 0.1   0 0 0.5   red
sphere 1 2 0.5   0.4   green
triangle 0.5 -0.4 1  1.5 0.8 1.2  0.2 1 1.4   blue
quad 1 0.3 -1  0 0.8 0.3  0.5 0.1 0   blue
pointlight 0 3 0   5 5 5
)";

}  // namespace

TEST_CASE("direct: U is the mean of w, for every light, tilt, side and way to sample") {
    const struct {
        const char* name;
        std::string scene;
        vec3 n;
        bool by_angle;
    } cases[] = {
        {"sphere, 30", sphere_at(30), {0, 1, 0}, false},
        {"sphere, cut by the horizon, 75", sphere_at(75), {0, 1, 0}, false},
        {"sphere, 90", sphere_at(90), {0, 1, 0}, false},
        {"sphere, 105", sphere_at(105), {0, 1, 0}, false},
        {"sphere close by", "light lamp 1 1 1\nsphere 0 1.01 0  1  lamp\n", {0, 1, 0.5}, false},
        {"quad overhead",
         "light lamp 1 2 1\nquad -1 1 -1  2 0 0  0 0 2  lamp\n",
         {0, 1, 0.1},
         false},
        {"the same by angle",
         "light lamp 1 2 1\nquad -1 1 -1  2 0 0  0 0 2  lamp\n",
         {0, 1, 0.1},
         true},
        {"quad, cut by the horizon",
         "light lamp 1 2 1\nquad 1 -1 1  0 2 0  0 0 -2  lamp\n",
         {0, 1, 0},
         false},
        {"the same by angle",
         "light lamp 1 2 1\nquad 1 -1 1  0 2 0  0 0 -2  lamp\n",
         {0, 1, 0},
         true},
        {"oblique parallelogram",
         "light lamp 1 2 1\nquad 1 -0.3 -1  0.1 2 0.5  0 0 2  lamp\n",
         {0.3, 1, 0},
         true},
        {"triangle",
         "light lamp 2 1 1\ntriangle 1 0 0  1 1.5 -0.4  0.7 0.4 0.9  lamp\n",
         {0, 1, 0},
         true},
        {"a tube",
         "light lamp 1e6 1e6 1e6\nquad -.4 1 0  .8 0 0  0 0 1e-6  lamp\n",
         {0, 1, 0.1},
         false},
        {"many", many, {0, 1, 0.2}, false},
        {"many by angle", many, {0.2, 1, 0.2}, true},
    };
    for (const auto& c : cases) {
        const Receiver r = receiver(c.scene, c.n, c.by_angle);
        const uint64_t seed = oracle::seed_of(std::string("direct U ") + c.name), n = 150000;
        uint64_t i = 0;
        oracle::Estimate w[3];
        std::array<Moments, 3> m;
        rgb U;
        for (; i < n; ++i) {
            const Shadowed s = r.shadowed_sample(i, seed);
            U = s.U;
            for (size_t k = 0; k < 3; ++k) m[k].add(double(s.w.*axis[k]));
        }
        for (size_t k = 0; k < 3; ++k) {
            w[k] = estimate(m[k]);
            w[k].standard_error =
                std::hypot(w[k].standard_error, (single ? 1e-5 : 1e-12) * w[k].mean);
            const oracle::Verdict v = oracle::expect_mean(double(U.*axis[k]), w[k]);
            INFO(std::string(c.name), ", channel ", k, ": ", v.text);
            CHECK(v.pass);
            CHECK(v.delta_min < 0.09);
        }
    }
}

TEST_CASE("direct: the sphere at 75 and 105 degrees, with albedo and radiance") {
    // A second light, below the horizon, sends nothing.
    Receiver r = receiver(sphere_at(75) + "sphere 0 -9 0  1  lamp\n", {0, 1, 0});
    const double E = 0.221200880053 / std::numbers::pi;
    const rgb U = r.shadowed_sample(0).U;
    const double epsilon = single ? 2e-5 : 5e-11;
    CHECK(double(U.x) == doctest::Approx(0.5 * E).epsilon(epsilon).scale(0));
    CHECK(double(U.y) == doctest::Approx(0.25 * E).epsilon(epsilon).scale(0));
    CHECK(double(U.z) == doctest::Approx(0.125 * E).epsilon(epsilon).scale(0));
    r = receiver(sphere_at(105), {0, 1, 0});
    CHECK(double(r.shadowed_sample(0).U.x) ==
          doctest::Approx(0.5 * 0.017924877377 / std::numbers::pi).epsilon(epsilon).scale(0));
}

TEST_CASE("direct: with nothing in the way w V is w; with all in the way 0") {
    const Receiver open = receiver(many, {0, 1, 0.2});
    const Receiver closed =
        receiver(std::string(many) + "sphere 0 0 0  0.01  black\n", {0, 1, 0.2});
    int found = 0;
    for (uint64_t i = 0; i < 500; ++i) {
        const Shadowed s = open.shadowed_sample(i), dark = closed.shadowed_sample(i);
        found += s.w.x > 0;
        CHECK(s.wV == s.w);
        CHECK(s.U - (s.w - s.wV) == s.U);
        CHECK(dark.U == s.U);
        CHECK(dark.w == s.w);
        CHECK(dark.wV == rgb{});
    }
    CHECK(found > 100);
}

TEST_CASE("direct: the knife edge by four estimators") {
    CHECK(knife_edge_irradiance(-1) == doctest::Approx(0.385380).epsilon(1e-6));
    CHECK(knife_edge_irradiance(1) == doctest::Approx(0.294794).epsilon(1e-6));
    for (int side : {-1, 1})
        for (Estimator e :
             {Estimator::stochastic, Estimator::control, Estimator::ratio, Estimator::regression}) {
            const Receiver r = receiver(knife_edge(side), {0, 1, 0});
            uint64_t i = 0;
            // The bias of ratio and regression at 512 is below a tenth of what the test sees.
            const oracle::Verdict v =
                oracle::expect_mean(0.5 * knife_edge_irradiance(side) / std::numbers::pi, 400, [&] {
                    ShadowMoments m;
                    for (int k = 0; k < 512; ++k) {
                        const Shadowed s = r.shadowed_sample(i++, oracle::seed_of("knife edge"));
                        m.add(double(s.U.x), double(s.w.x), double(s.wV.x));
                    }
                    return estimate(e, m);
                });
            INFO("side ", side, ", estimator ", int(e), ": ", v.text);
            CHECK(v.pass);
            CHECK(v.delta_min < 0.03);
        }
}

TEST_CASE("direct: at the knife edge N times the bias of ratio tends to its constant") {
    // w is proportional to the cosine, uniform over the cone: its moments by midpoints.
    const int side = -1, steps = 400;
    const double pi_ = std::numbers::pi, cos_max = std::sqrt(0.75);
    const Frame f = frame({real(0.5), real(std::cos(pi_ / 6)), 0});
    double ww = 0, wwV = 0, W = 0, S = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double z = 1 - (i + 0.5) / steps * (1 - cos_max), t = std::sqrt(1 - z * z),
                         phi = 2 * pi_ * (j + 0.5) / steps;
            const vec3 wi = f.to_world({real(t * std::cos(phi)), real(t * std::sin(phi)), real(z)});
            const double w = double(wi.y) / (steps * steps),
                         h = side * (double(wi.x) * std::cos(pi_ / 6) - double(wi.y) * 0.5);
            W += w;
            ww += double(wi.y) * w;
            S += h > 0 ? w : 0;
            wwV += h > 0 ? double(wi.y) * w : 0;
        }
    const ShadowPopulation p{W, S, ww, wwV, 0, 0};
    // In units of the cosine: 0.5 / pi times the solid angle of the cone, times it.
    const double unit_ = 0.5 / pi_ * 2 * pi_ * (1 - cos_max),
                 constant = p.bias(Estimator::ratio) * unit_;
    const Receiver r = receiver(knife_edge(side), {0, 1, 0});
    uint64_t i = 0;
    const double R = S / W;
    const oracle::Verdict v = oracle::expect_bias_decay(constant, 8, 1000, [&](uint64_t n) {
        double sum = 0;
        for (int k = 0; k < 16; ++k) {
            ShadowMoments m;
            while (m.n < n) {
                const Shadowed s = r.shadowed_sample(i++, oracle::seed_of("knife edge bias"));
                m.add(double(s.U.x), double(s.w.x), double(s.wV.x));
            }
            sum += ratio(m) - (m.wV - R * (m.w - m.U));
        }
        return sum / 16;
    });
    INFO("constant ", constant, ": ", v.text);
    CHECK(v.pass);
    CHECK(v.delta_min < 0.5);
}

TEST_CASE("direct: parts add up to the plain sample, lobes and point lights among them") {
    Receiver r =
        receiver(std::string(many) + "quad -2 0.7 -2  2.1 0 0  0 0 4  black\n", {0, 1, 0.2});
    r.material.ks = {real(0.25), real(0.5), real(0.125)};
    r.material.exponent = 3;
    int lobes = 0, shadows = 0;
    for (uint64_t i = 0; i < 500; ++i) {
        const DirectLight d = r.sample(i).direct;
        const Shadowed s = r.shadowed_sample(i);
        lobes += max_of(d.L - s.wV) > 0;
        shadows += d.occluded;
        // What is left: the lobe, and light that has no closed form.
        if (!d.light) continue;
        const bool known = has_closed_form(*d.light, r.x);
        const vec3 wi = r.local.to_local(d.sample.wi);
        const rgb f = eval(r.material, {0, 0, 1}, wi) - (known ? r.material.kd / pi : rgb{});
        const rgb rest = d.occluded ? rgb{} : f * d.sample.L * (wi.z / d.pdf);
        CHECK(double(max_abs(d.L - s.wV - rest)) <= 8 * double(ulp) * double(max_abs(d.L)));
    }
    CHECK(lobes > 100);
    CHECK(shadows > 50);
}

TEST_CASE("direct: what has no closed form stays as sampled") {
    // A point light.
    const Receiver point = receiver("pointlight 0 1 0  2 2 2\n", {0, 1, 0});
    CHECK(point.shadowed_sample(0).U == rgb{});
    CHECK(point.shadowed_sample(0).w == rgb{});
    CHECK(double(point.sample(0).direct.L.x) == doctest::Approx(0.5 / std::numbers::pi * 2));
    // From within a sphere, and from a point on it, or in the plane of a quad.
    const char* const around[] = {
        "light lamp 1 1 1 twosided\nsphere 0 1 0  2  lamp\n",
        "light lamp 1 1 1 twosided\nsphere 0 1 0  1  lamp\n",
        "light lamp 1 1 1 twosided\nquad -1 0 -1  0 0 2  2 0 0  lamp\n",
    };
    for (const char* scene : around) {
        Receiver r = receiver(scene, {0, 1, 0});
        r.x.error = 16 * ulp;
        for (uint64_t i = 0; i < 50; ++i) {
            CHECK(r.shadowed_sample(i).U == rgb{});
            CHECK(r.shadowed_sample(i).w == rgb{});
        }
    }
    // The back of a light; a surface without a diffuse part.
    const Receiver back =
        receiver("light lamp 1 1 1\nquad -1 1 -1  0 0 2  2 0 0  lamp\n", {0, 1, 0});
    CHECK(back.shadowed_sample(0).U == rgb{});
    Receiver gloss = receiver(sphere_at(30), {0, 1, 0});
    gloss.material = {Material::Kind::rough, {}, {1, 1, 1}, 5, 1, {}, false};
    CHECK(gloss.shadowed_sample(0).U == rgb{});
    CHECK(gloss.shadowed_sample(0).w == rgb{});
    CHECK(max_of(gloss.sample(0).direct.L) > 0);
    // Mirrors; paths that do not scatter.
    Receiver mirror = receiver(sphere_at(30), {0, 1, 0});
    mirror.material.kind = Material::Kind::mirror;
    CHECK(mirror.shadowed_sample(0).U == rgb{});
    Receiver dark = receiver(sphere_at(30), {0, 1, 0});
    CHECK(dark.shadowed_sample(0).U.x > 0);
    dark.scene.depth = 0;
    CHECK(dark.shadowed_sample(0).U == rgb{});
}

TEST_CASE("direct: a film of moments counts whole passes, and all samples of a set together") {
    oracle::Random random(oracle::seed_of("shadow film"));
    std::array<std::array<ShadowMoments, 3>, 2> sets;
    auto draw = [&](int x, int y, uint64_t, uint32_t set) {
        ShadowSample sample{{1, 1, 1}, {}};
        for (size_t c = 0; c < 3; ++c) {
            auto& [U, w, wV] = sample.first;
            U.*axis[c] = real(1 + random());
            w.*axis[c] = real(U.*axis[c] * (real(0.5) + real(random())));
            wV.*axis[c] = random() < 0.5 ? w.*axis[c] : 0;
            if (x != 1 || y != 0) continue;
            const double u = double(U.*axis[c]), W = double(w.*axis[c]), V = double(wV.*axis[c]);
            sets[set][c].add(u, W, V);
        }
        return sample;
    };
    auto moments_of = [&](Film<ShadowPixel>& film) {
        sets = {};
        film.add_sets({{1, 0}, {2, 0}, {1, 0}, {1, 0.5}});
        for (uint64_t n : {1, 3, 8}) whole_pass(film, n, draw);
        // A pass that is not finished.
        film.begin_pass(1);
        add_blocks(film, 0, 2, 1, [](int, int, uint64_t, uint32_t) {
            return ShadowSample{{9, 9, 9}, {{9, 9, 9}, {9, 9, 9}, {9, 9, 9}}};
        });
        return sets;
    };
    for (Estimator e : {Estimator::ratio, Estimator::regression}) {
        Film<ShadowPixel> values({2, 2}, {e}), variances({2, 2}, {e}, Shows::variances);
        const auto of_values = moments_of(values), of_variances = moments_of(variances);
        const Image &image = values.image(), &variance = variances.image();
        for (size_t c = 0; c < 3; ++c) {
            const double sum = estimate(e, of_values[0][c]) + estimate(e, of_values[1][c]);
            CHECK(double(image.at(1, 0)[c]) == doctest::Approx(1 + sum / 2));
            const double a = estimate(e, of_variances[0][c]), b = estimate(e, of_variances[1][c]);
            // (a - b)^2 / 2 is the variance of one of them, of which two are shown.
            CHECK(double(variance.at(1, 0)[c]) ==
                  doctest::Approx((a - b) * (a - b) / 4).epsilon(1e-4).scale(0));
        }
        CHECK(std::isnan(variance.at(0, 0)[0]));
    }
}

TEST_CASE("sets that float cannot tell apart have a variance of their own") {
    // Samples 1 and 1 + 2^-23 of one set, of mean 1 + 2^-24, which float rounds to 1; 1 of another.
    Film<ShadowPixel> film({1, 1}, {Estimator::ratio}, Shows::variances);
    film.add_sets({{2, 0}});
    whole_pass(film, 2, [](int, int, uint64_t i, uint32_t set) {
        const real x = i == 1 && set == 0 ? 1 + std::ldexp(real(1), -23) : 1;
        return ShadowSample{{x, x, x}, {}};
    });
    CHECK(film.image().at(0, 0)[0] == std::ldexp(1.0f, -48) / 4);
}

TEST_CASE("direct: the noise of a pixel is that of light and of shadows as if they were coins") {
    // Independent samples: U is 1, w is uniform over [1/2, 3/2] (variance 1/12), V a coin of R =
    // 1/4, the rest uniform over [0, 1].  Shadows: E[w^2] R (1 - R), E[w^2] = 13/12.
    oracle::Random random(seed_here());
    Moments noise;
    const uint64_t n = 16;
    for (int trial = 0; trial < 12000; ++trial) {
        ShadowPixel p;
        double spread = 0;
        for (uint64_t i = 0; i < n; ++i) {
            const real w = real(0.5 + random()), V = random() < 0.25, rest = real(random());
            const ShadowSample sample{{rest, 0, 0}, {{1, 0, 0}, {w, 0, 0}, {w * V, 0, 0}}};
            spread += p.spread(i, sample);
            p.add(i, sample);
        }
        noise.add(p.noise(n, spread) * double(n));
    }
    // R (1 - R) of R from n samples is smaller by R (1 - R) / n, and a little for the spread of w.
    const double R1R = 0.25 * 0.75, shadows = 13 / 12.0 * R1R * (1 - 1.1 / double(n));
    EXPECT(oracle::expect_mean(1 / 12.0 + shadows, estimate(noise, double(ulp))), 0.02);
    ShadowPixel lit, dark;
    double of_lit = 0, of_dark = 0;  // how far their light without shadows spreads
    for (uint64_t i = 0; i < n; ++i) {
        const real w = real(0.5 + random());
        const ShadowSample seen{{}, {{1, 1, 1}, {w, w, w}, {w, w, w}}},
            hidden{{}, {{1, 1, 1}, {w, w, w}, {}}};
        of_lit += lit.spread(i, seen), of_dark += dark.spread(i, hidden);
        lit.add(i, seen);
        dark.add(i, hidden);
    }
    CHECK(lit.noise(n, of_lit) == 0);
    CHECK(dark.noise(n, of_dark) == 0);
    CHECK(ShadowPixel().noise(1, 0) == 0);
}

TEST_CASE("direct: a sample whose moments are no numbers does not fit a film") {
    const rgb one{1, 1, 1}, bad{1, NAN, 1};
    CHECK(ShadowPixel::fits({one, {one, one, one}}));
    CHECK_FALSE(ShadowPixel::fits({bad, {one, one, one}}));
    CHECK_FALSE(ShadowPixel::fits({one, {bad, one, one}}));
    CHECK_FALSE(ShadowPixel::fits({one, {one, bad, one}}));
}
