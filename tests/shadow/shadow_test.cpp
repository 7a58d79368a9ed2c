// shadow/shadow_test.cpp  the unshadowed term against light samples; four estimators against closed
// forms
#include "shadow/shadow.h"

#include "base/moments.h"
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
        e.direct = direct_light(scene, {Direction::bsdf, LightMode::nee, 0}, e.x,
                                Sampler(pattern, 0, i), 0);
        return e;
    }
    Shadowed shadowed_sample(uint64_t i, uint64_t seed = 1) const {
        return shadowed(scene, sample(i, seed));
    }
};

// Statements are lights and obstacles about the origin.
Receiver receiver(const std::string& statements, vec3 n) {
    Receiver r;
    r.scene =
        parse_scene(
            "camera 0 0 9  0 0 0  40\ndiffuse black 0 0 0\nsphere 0 -99 0  1  black\n" + statements,
            "test")
            .scene;
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

TEST_CASE("direct: U is the mean of w, for every light, tilt and side") {
    const struct {
        const char* name;
        std::string scene;
        vec3 n;
    } cases[] = {
        {"sphere, 30", sphere_at(30), {0, 1, 0}},
        {"sphere, cut by the horizon, 75", sphere_at(75), {0, 1, 0}},
        {"sphere, 90", sphere_at(90), {0, 1, 0}},
        {"sphere, 105", sphere_at(105), {0, 1, 0}},
        {"sphere close by", "light lamp 1 1 1\nsphere 0 1.01 0  1  lamp\n", {0, 1, 0.5}},
        {"quad overhead", "light lamp 1 2 1\nquad -1 1 -1  2 0 0  0 0 2  lamp\n", {0, 1, 0.1}},
        {"quad, cut by the horizon",
         "light lamp 1 2 1\nquad 1 -1 1  0 2 0  0 0 -2  lamp\n",
         {0, 1, 0}},
        {"oblique parallelogram",
         "light lamp 1 2 1\nquad 1 -0.3 -1  0.1 2 0.5  0 0 2  lamp\n",
         {0.3, 1, 0}},
        {"triangle",
         "light lamp 2 1 1\ntriangle 1 0 0  1 1.5 -0.4  0.7 0.4 0.9  lamp\n",
         {0, 1, 0}},
        {"a tube", "light lamp 1e6 1e6 1e6\nquad -.4 1 0  .8 0 0  0 0 1e-6  lamp\n", {0, 1, 0.1}},
        {"many", many, {0, 1, 0.2}},
    };
    for (const auto& c : cases) {
        const Receiver r = receiver(c.scene, c.n);
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

TEST_CASE("direct: the value of a pixel is that of the moments of all its samples") {
    oracle::Random random(oracle::seed_of("shadow pixel"));
    ShadowPixel pixel;
    ShadowMoments moments[3];
    double rest[3] = {};
    constexpr int n = 12;
    for (int i = 0; i < n; ++i) {
        ShadowSample sample;
        for (size_t c = 0; c < 3; ++c) {
            auto& [U, w, wV] = sample.first;
            U.*axis[c] = real(1 + random());
            w.*axis[c] = real(U.*axis[c] * (real(0.5) + real(random())));
            wV.*axis[c] = random() < 0.5 ? w.*axis[c] : 0;
            sample.rest.*axis[c] = real(random());
            rest[c] += double(sample.rest.*axis[c]) / n;
            moments[c].add(double(U.*axis[c]), double(w.*axis[c]), double(wV.*axis[c]));
        }
        pixel.add(sample);
    }
    for (Estimator e :
         {Estimator::stochastic, Estimator::control, Estimator::ratio, Estimator::regression})
        for (size_t c = 0; c < 3; ++c)
            CHECK(double(pixel.value(e).*axis[c]) ==
                  doctest::Approx(rest[c] + estimate(e, moments[c])).epsilon(1e-6));
}
