// shadow/shadow_test.cpp  the unshadowed term against light samples; four estimators against closed
// forms
#include "shadow/shadow.h"

#include "base/closed_forms.h"
#include "base/moments.h"
#include "shadow/checks.h"
#include "text/scene_file.h"

namespace {

// A surface that no ray can hit, seen straight from above, and its light samples.
struct Receiver {
    Scene scene;
    Surface x;
    Frame local;
    Material material;

    // The step of a path at the receiver, with direct light only.
    VertexEvents sample(uint64_t i, uint64_t seed = 1) const {
        const SamplerSettings settings{SamplerKind::independent, seed};
        VertexEvents e;
        e.met = true, e.vertex = Vertex{{}, x, &material, 1, local, {0, 0, 1}};
        e.direct = direct_light(scene, {Direction::bsdf, LightMode::nee, 0}, e.vertex,
                                Sampler(settings, 0, i), 0);
        return e;
    }
    Shadowed shadowed_sample(uint64_t i, uint64_t seed = 1) const {
        return shadowed(scene, sample(i, seed));
    }
    // The red channel of n samples, from sample i on.
    ShadowMoments moments(uint64_t n, uint64_t& i, const std::string& seed) const {
        return moments_of(n, [&, this] {
            const Shadowed s = shadowed_sample(i++, oracle::seed_of(seed));
            return std::array{s.U.x, s.w.x, s.wV.x};
        });
    }
    bool has_none() const {
        const Shadowed s = shadowed_sample(0);
        return s.U == rgb{} && s.w == rgb{};
    }
};

// Statements describe lights and obstacles about the origin.
Receiver receiver(const std::string& statements, vec3 n = {0, 1, 0}) {
    const std::string before =
        "camera 0 0 9  0 0 0  40\ndiffuse black 0 0 0\nsphere 0 -99 0  1  black\n";
    Receiver r;
    r.scene = parse_scene(before + statements, "test").scene;
    r.x = {{0, 0, 0}, unit(n), 0};
    r.local = frame(r.x.n);
    r.material.scattering = Rough({0.5, 0.25, 0.125});
    return r;
}

// Sphere light of radiance 1 at distance 2, radius 1 (s = 0.5), in direction `degrees` from +y.
std::string sphere_at(double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return oracle::say("light lamp 1 1 1\nsphere %.17g %.17g 0  1  lamp\n", 2 * std::sin(a),
                       2 * std::cos(a));
}

// Half of that sphere, at 30 degrees, behind a wall across the axis with its edge on the axis.  The
// visible half is on the side of h = +-(cos 30, -sin 30, 0).
std::string knife_edge(int side) {
    const double c = std::cos(std::numbers::pi / 6), s = 0.5;
    // Corner on the axis at distance 0.8, 4 to the front; edges 8 along z and 4 towards -h.
    return sphere_at(30) + oracle::say("quad %.17g %.17g -4   0 0 8   %.17g %.17g 0   black\n",
                                       0.8 * s, 0.8 * c, -4 * side * c, 4 * side * s);
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
        const uint64_t seed = oracle::seed_of(std::string("direct U ") + c.name), n = 75000;
        std::array<Moments, 3> m;
        rgb U;
        for (uint64_t i = 0; i < n; ++i) {
            const Shadowed s = r.shadowed_sample(i, seed);
            U = s.U;
            for (size_t k = 0; k < 3; ++k) m[k].add(double(s.w.*axis[k]));
        }
        for (size_t k = 0; k < 3; ++k) {
            oracle::Estimate w = estimate(m[k]);
            w.standard_error = std::hypot(w.standard_error, (single ? 1e-5 : 1e-12) * w.mean);
            EXPECT(oracle::expect_mean(double(U.*axis[k]), w)
                       .of(oracle::say("%s, channel %zu", c.name, k)),
                   0.13);
        }
    }
}

TEST_CASE("direct: the sphere at 75 and 105 degrees, with albedo and radiance") {
    // A second light below the horizon contributes nothing.
    const std::string below = "sphere 0 -9 0  1  lamp\n";
    for (const auto& [scene, E] :
         {std::pair{sphere_at(75) + below, 0.221200880053}, {sphere_at(105), 0.017924877377}}) {
        const rgb U = receiver(scene).shadowed_sample(0).U;
        CHECK(double(U.x) == approx(0.5 * E / std::numbers::pi, 5e-11));
        CHECK(double(U.y) == approx(0.25 * E / std::numbers::pi, 5e-11));
        CHECK(double(U.z) == approx(0.125 * E / std::numbers::pi, 5e-11));
    }
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
    for (int side : {-1, 1})
        for (Estimator e : estimators) {
            const Receiver r = receiver(knife_edge(side));
            uint64_t i = 0;
            // The bias of ratio and regression at 512 is below a tenth of the detectable one.
            auto of_512 = [&] { return estimate(e, r.moments(512, i, "knife edge")); };
            const double E = closed_forms::half_sphere_irradiance(
                0.5, std::cos(std::numbers::pi / 6), -side * 0.5);
            EXPECT(oracle::expect_mean(0.5 * E / std::numbers::pi, 200, of_512)
                       .of(oracle::say("side %d, estimator %d", side, int(e))),
                   0.045);
        }
}

TEST_CASE("direct: parts add up to the plain sample, lobes and point lights among them") {
    Receiver r =
        receiver(std::string(many) + "quad -2 0.7 -2  2.1 0 0  0 0 4  black\n", {0, 1, 0.2});
    r.material.scattering = Rough(r.material.diffuse(), {real(0.25), real(0.5), real(0.125)}, 3);
    int lobes = 0, shadows = 0;
    for (uint64_t i = 0; i < 500; ++i) {
        const DirectLight d = r.sample(i).direct;
        const Shadowed s = r.shadowed_sample(i);
        lobes += max_of(d.L - s.wV) > 0;
        shadows += d.occluded;
        // The remainder is the lobe, and lights without a closed form.
        if (!d.light) continue;
        const bool known = has_closed_form(*d.light, r.x);
        const vec3 wi = r.local.to_local(d.sample.wi);
        const rgb f = eval(r.material, {0, 0, 1}, wi) - (known ? r.material.diffuse() / pi : rgb{});
        const rgb rest = d.occluded ? rgb{} : f * d.sample.L * (wi.z / d.pdf);
        CHECK(double(max_abs(d.L - s.wV - rest)) <= 8 * double(ulp) * double(max_abs(d.L)));
    }
    CHECK(lobes > 100);
    CHECK(shadows > 50);
}

TEST_CASE("direct: what has no closed form stays as sampled") {
    const Receiver point = receiver("pointlight 0 1 0  2 2 2\n");
    CHECK(point.has_none());
    CHECK(double(point.sample(0).direct.L.x) == doctest::Approx(0.5 / std::numbers::pi * 2));
    // Receivers lie inside a sphere, on its surface, or in the plane of a quad.
    for (const char* shape : {"sphere 0 1 0  2  lamp\n", "sphere 0 1 0  1  lamp\n",
                              "quad -1 0 -1  0 0 2  2 0 0  lamp\n"}) {
        Receiver r = receiver(std::string("light lamp 1 1 1 twosided\n") + shape);
        r.x.error = 16 * ulp;
        for (uint64_t i = 0; i < 50; ++i) {
            CHECK(r.shadowed_sample(i).U == rgb{});
            CHECK(r.shadowed_sample(i).w == rgb{});
        }
    }
    // The receiver sees the back of a light, or it has no diffuse part.
    CHECK(receiver("light lamp 1 1 1\nquad -1 1 -1  0 0 2  2 0 0  lamp\n").has_none());
    Receiver gloss = receiver(sphere_at(30)), mirror = gloss, dark = gloss;
    gloss.material = {Rough({}, {1, 1, 1}, 5)};
    CHECK(gloss.has_none());
    CHECK(max_of(gloss.sample(0).direct.L) > 0);
    // Mirrors and paths without scattering have no unshadowed term.
    mirror.material.scattering = Mirror({1, 1, 1});
    CHECK(mirror.shadowed_sample(0).U == rgb{});
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
    for (Estimator e : estimators)
        for (size_t c = 0; c < 3; ++c)
            CHECK(double(pixel.value(e).*axis[c]) ==
                  doctest::Approx(rest[c] + estimate(e, moments[c])).epsilon(1e-6));
}
