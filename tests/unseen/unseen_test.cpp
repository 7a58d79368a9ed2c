// unseen/unseen_test.cpp  light that samples may have missed: near misses, lights in view, the
// verdict
#include "unseen/unseen.h"

#include "base/moments.h"
#include "film/fill.h"
#include "oracle/expect.h"
#include "path/paths.h"
#include "world/geometry.h"
#include "world/prepare.h"

namespace {

Scene with_light(const Light& l) {
    Scene s;
    s.lights = {l};
    prepare(s);
    return s;
}

Material perfect_mirror() { return {Mirror({1, 1, 1})}; }

// A mirror as the floor, a ball light above it outside the view, a black wall behind.
NamedScene mirror_scene(real r, bool direct = false) {
    NamedScene s;
    s.size = {8, 8};
    s.depth = 2;
    s.camera = look_at({0, 1, 0}, direct ? vec3{-0.4, 0.8, 2} : vec3{0, 0, 1}, 60);
    Material light;
    light.Le = {3, 2, 1};
    add_material(s, perfect_mirror(), "m");
    add_material(s, light, "l");
    add_quad(s, {-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, 0);
    add_sphere(s, {0.2, 1.1, 2}, r, 1);
    s.line_of_light = {7};
    prepare(s);
    return s;
}

// The near misses of n samples per pixel, divided among K replications.
std::vector<NearMisses> misses_of(const Scene& s, const Technique& t, uint64_t n, double K = 1) {
    const LightRecorder recorder(s, t, 0, s.size.height);
    Tally tally;
    tally.share = 1 / K, tally.near = recorder.near_misses(1);
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    for (int y = 0; y < s.size.height; ++y)
        for (int x = 0; x < s.size.width; ++x)
            for (uint64_t i = 0; i < n; ++i)
                radiance(s, t, settings, x, y, i, recorder.visitor(tally));
    return tally.near;
}
LightsInView in_view(const Scene& s) {
    return lights_in_view(s, {0, s.size.height}, {}, Aims(s), 4096);
}

// The greatest d^2 that light of square u could more than double, in a picture of square `norm2`:
// where (d^2 + u) / (F^2 + u) = 4 d^2 / F^2 for the truth F^2 = norm2 - d^2 of what was found.
double doubled_from(double u, double norm2) {
    const double b = 3 * norm2 + 5 * u;
    return (b - std::sqrt(b * b - 12 * u * norm2)) / 6;
}
// The sum of a power of c at a growth, for the first group.
double c(const std::vector<NearMisses>& of, size_t k, size_t power = 0) {
    return value_of(of[0].sum[k][power]);
}

}  // namespace

TEST_CASE(
    "a ray meets a grown light where it would meet a disc of its area, from its bright side") {
    oracle::Random random(seed_here());
    auto in = [&](double a, double b) { return real(a + (b - a) * random()); };
    auto vector = [&] { return vec3{in(-1, 1), in(-1, 1), in(-1, 1)}; };
    int met = 0, missed = 0;
    for (int i = 0; i < 30000; ++i) {
        const real thin = i % 2 ? 1 : real(0.01);
        const vec3 p = vector(), u = real(0.02) * vector(), v = real(0.02) * thin * vector();
        Light l = i % 3 == 0   ? Light(p, SphereLight{in(0.001, 0.01)})
                  : i % 3 == 1 ? Light(p, TriangleLight{u, v})
                               : Light(p, QuadLight{u, v});
        l.twosided = i % 2 != 0;
        l = with_light(l).lights[0];
        const vec3 o = 3 * vector();
        const Ray ray{o, unit(l.centre + in(0, 1) * vector() - o), in(1, 5)};
        const uint32_t mask = growths_met(l, ray);
        const real area = length(cross(u, v)) / (i % 3 == 1 ? 2 : 1);
        const real r = i % 3 == 0 ? l.as<SphereLight>()->r : std::sqrt(area / pi);
        const vec3 n = i % 3 == 0 ? -ray.d : unit(cross(u, v)), to = l.centre - o;
        const real t = dot(to, n) / dot(ray.d, n), off = length(to - ray.d * t);
        auto meets = [&](real s) {
            return t > 0 && t < ray.tmax && off < s * r && s * r < length(to) &&
                   (l.twosided || dot(n, ray.d) < 0);
        };
        for (size_t k = 0; k < growths; ++k) {
            const real s = real(1 << k), part = real(1e-4);
            const bool expected = meets(s);
            // Rounding may differ here.
            if (meets(s * (1 - part)) != meets(s * (1 + part))) continue;
            CHECK(bool(mask >> k & 1) == expected);
            (expected ? met : missed) += 1;
        }
    }
    CHECK(met > 20000);
    CHECK(missed > 30000);
    CHECK(growths_met(Light({}, PointLight(), {1, 1, 1}), {{0, 0, 1}, {0, 0, -1}}) == 0);
}

TEST_CASE("the unit of squares is the greatest radiance of a group, or intensity of a point") {
    const Light point({0, 1, 1}, PointLight(), {1, 2, 4});
    CHECK(in_view(with_light(point)).groups[0].L2 == doctest::Approx(21.0 / 3));
}

TEST_CASE("the part of pixels that lights cover, in view of the eye") {
    for (real r : {real(0.001), real(0.01), real(0.1)}) {
        const NamedScene s = mirror_scene(r, true);
        const LightsInView view =
            lights_in_view(s, {0, s.size.height}, {}, Aims(s), 4096, s.line_of_light);
        const vec3 f = s.lights[0].p - s.camera.eye;
        const double pixel = 2 * double(s.camera.tan_half) / s.size.height;
        const double cosine = double(dot(unit(f), s.camera.forward));
        const double cap =
            2 * std::numbers::pi * (1 - std::sqrt(1 - double(r) * double(r) / double(dot(f, f))));
        const double area = cap / (pixel * pixel * cosine * cosine * cosine);
        CHECK(view.groups[0].area == doctest::Approx(area).epsilon(0.02));
        CHECK(view.groups[0].L2 == doctest::Approx(14.0 / 3));
        CHECK(view.groups[0].line == 7);
        if (r < real(0.05))
            CHECK(view.groups[0].a == doctest::Approx(area * (1 - area)).epsilon(0.02));
        // The noisy pixels are those of the light; bands of rows partition them.
        CHECK(view.noisy.size() == (r < real(0.05) ? 1 : 4));
        auto area_of = [&](const Band& band) {
            return lights_in_view(s, band, {}, Aims(Scene()), 0).groups[0].area;
        };
        double parts = 0;
        for (int row = 0; row < s.size.height; row += 2) parts += area_of({row, 2});
        CHECK(parts == doctest::Approx(area_of({0, s.size.height})));
    }
    // A light that covers 16 pixels is not small.
    const LightsInView large = in_view(mirror_scene(real(0.9), true));
    CHECK(large.groups[0].area > 16);
    CHECK(large.noisy.empty());
    // A light seen only in mirrors, or behind something, does not count.
    CHECK(in_view(mirror_scene(real(0.1))).groups[0].area == 0);
    Scene hidden = mirror_scene(real(0.1), true);
    add_quad(hidden, {-1, -1, 1}, {2, 0, 0}, {0, 4, 0}, 0);
    prepare(hidden);
    CHECK(in_view(hidden).groups[0].area == 0);
}

TEST_CASE("near misses tell the light that is met, at every growth") {
    // The mean of c / s^2 does not depend on s while the light stays small.
    const auto e = misses_of(mirror_scene(real(0.08)), {}, 10000);
    const double met = c(e, 0);
    REQUIRE(met > 1000);  // hits: five standard deviations are less than a quarter
    for (size_t k = 1; k < 3; ++k) {
        const double told = c(e, k) / std::pow(4.0, k);
        CHECK(told == doctest::Approx(met).epsilon(5 / std::sqrt(met)));
        CHECK(c(e, k) > 2 * c(e, k - 1));
    }
    // For a perfect mirror c and its square are 1.
    CHECK(c(e, 0, 1) == doctest::Approx(met));
    // The replications of a pixel share its near misses.
    const auto half = misses_of(mirror_scene(real(0.08)), {}, 10000, 2);
    CHECK(c(half, 0) == doctest::Approx(met / 4));
    CHECK(c(half, 0, 1) == doctest::Approx(met / 16));
    // Hits by eye rays do not count as chance hits.
    const auto direct = misses_of(mirror_scene(real(0.02), true), {}, 100);
    CHECK(c(direct, 0) < direct[0].area * 100);
}

TEST_CASE("a film sums near misses by replications and weights, whatever the threads") {
    const NamedScene s = mirror_scene(real(0.3), true);
    const LightRecorder recorder(s, {}, 0, 8, s.line_of_light);
    REQUIRE(!recorder.noisy().empty());
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    // No light grows that much here: the sum holds 1 / (K w) for each sample.
    const SampleFunction L = [&](const PixelSample& p, Tally& tally) {
        tally.near[0].sum[growths - 1][0] += fixed_point(tally.share);
        return radiance(s, {}, settings, p.x, p.y, p.i * 3 + p.replication,
                        recorder.visitor(tally));
    };
    Plan plan{s.size};
    plan.replications = 3, plan.samples = 8, plan.noisy = recorder.noisy();
    plan.near = recorder.near_misses(3 * 4);
    Watch watch;
    watch.elapsed = [] { return 0; };
    auto filled_by = [&](unsigned threads) {
        Film f = make_film(s.size, 3, true);
        f.near = plan.near, plan.threads = threads;
        CHECK(Loop(f, plan, L, watch).run() == Stop::samples);
        return f;
    };
    const Film f = filled_by(1);
    CHECK(same(filled_by(3), f));
    double shares = 0, squares = 0;
    for (size_t i = 0; i < f.pixels(); ++i) shares += double(f.samples(i) - 4) / f.weight[i];
    for (size_t i : recorder.noisy()) CHECK(f.weight[i] >= 4);
    CHECK(value_of(f.near[0].sum[growths - 1][0]) == doctest::Approx(shares));
    CHECK((f.near[0].K == 12 && f.near[0].line == 7));
    // A near miss by the mirror is worth the square of its share.
    for (size_t i = 0; i < f.pixels(); ++i)
        for (uint32_t k = 0; k < 3; ++k)
            for (uint64_t n = 4; n < f.samples(i); ++n) {  // after the pilot
                const PixelSample p = f.sample_of(i, n, k);
                Tally tally;
                tally.near = recorder.near_misses(1);
                radiance(s, {}, settings, p.x, p.y, n * 3 + k, recorder.visitor(tally));
                squares += c(tally.near, 2) / sqr(3.0 * f.weight[i]);
            }
    CHECK(squares > 0);
    CHECK(c(f.near, 2) == doctest::Approx(squares));
    // The verdict is that of n samples of each replication of weight 1.
    MissedLight unseen;
    unseen.add(f.near, 8);
    ImageError black = error_of(f);
    CHECK(LightRecorder::why_unknown(f, black) == unseen.doubt(black.d2(), black.norm(), 64));
    black.variances = {};
    CHECK(LightRecorder::why_unknown(f, black) == unseen.doubt(0, black.norm(), 64));
    CHECK(LightRecorder::why_unknown(f, black) != "");
}

TEST_CASE("near misses count behind mirrors alone, also after a rough surface") {
    NamedScene s = mirror_scene(real(0.05));
    s.materials[0] = {Rough({0.5, 0.5, 0.5})};
    // With a mirror above, paths go from the floor by the mirror to the light.
    add_material(s, perfect_mirror(), "above");
    add_quad(s, {-9, 3, -9}, {18, 0, 0}, {0, 0, 18}, 2);
    s.depth = 3;
    prepare(s);
    const auto by_mirror = misses_of(s, {}, 2000);
    CHECK(c(by_mirror, 4) > 0);
    // Where light is aimed at there are none, though the lobe is narrow.
    s.materials[2] = {Rough({}, {1, 1, 1}, 1000)};
    const auto gloss = misses_of(s, {}, 2000);
    for (size_t k = 0; k < growths; ++k) CHECK(c(gloss, k) == 0);
}

TEST_CASE("what came of a light is its part of the radiance behind surfaces that are no mirrors") {
    // The eye sees a rough wall, and beside it the ceiling in a grey mirror; of two lamps the wall
    // meets one by chance, too.
    NamedScene s = mirror_scene(real(0.4), true);
    s.materials[0] = {Mirror({0.5, 0.5, 0.5})}, s.depth = 3;
    add_material(s, {Rough({0.5, 0.5, 0.5})}, "rough");
    add_quad(s, {-9, 3, -9}, {18, 0, 0}, {0, 0, 18}, 2);
    add_quad(s, {-9, 0, 5}, {0, 3, 0}, {18, 0, 0}, 2);
    add_sphere(s, {-1, real(1.1), 3}, real(0.05), 1);
    prepare(s);
    const std::vector<size_t> each = {0, 1};
    const std::vector<uint8_t> sizes = area_classes(s);
    std::vector<NearMisses> groups(2);
    for (NearMisses& g : groups)
        for (size_t k = 0; k < classes; ++k) g.from_eye[k].sum = double(k % 2 * k), g.L2 = 3;
    for (size_t k = 0; k < classes; ++k)
        groups[0].from_light[k].sum = 2, groups[1].from_light[k].sum = 0.25;
    Tally tally;
    tally.share = 0.25, tally.near.resize(2);
    const SamplerSettings settings{SamplerKind::independent, seed_here()};
    const Technique technique;
    std::array<std::array<double, classes>, 2> came{}, came_in{}, squares{};
    std::array<std::array<uint64_t, classes>, 2> hits{};
    int in_mirror = 0, met = 0, blocked = 0;
    for (uint64_t i = 0; i < 64000; ++i) {
        bool is_seen = false;
        size_t before = 0;  // class of the shape that the path left
        NearMissVisitor misses{s, groups, each, sizes, tally};
        radiance(s, technique, settings, int(i % 8), int(i / 8 % 8), i,
                 [&](const PathState& path, const VertexEvents& e) {
                     misses(path, e);
                     if (path.k == 0) is_seen = e.met && !e.vertex.material->is_delta();
                     in_mirror += e.direct.light && !is_seen, blocked += e.direct.occluded;
                     auto add = [&](size_t light, rgb L, size_t size) {
                         if (!(max_of(L) > 0)) return;
                         came[light][size] += is_seen ? double(mean_of(L)) / 4 : 0;
                         const size_t k = class_of(double(mean_of(L)));
                         came_in[light][k] += double(mean_of(L)) / 4, ++hits[light][k];
                         squares[light][k] += mean_square(L) / 3 / 16;
                     };
                     if (path.k > 0 && max_of(e.Le) > 0)
                         ++met, add(size_t(s.light_of[e.vertex.hit.id]),
                                    path.beta * e.Le * e.weight, before);
                     if (e.direct.light)
                         add(size_t(e.direct.light - s.lights.data()), path.beta * e.direct.L,
                             class_of(s.shapes[e.vertex.hit.id]));
                     if (e.met) before = class_of(s.shapes[e.vertex.hit.id]);
                 });
    }
    CHECK(in_mirror > 100);
    CHECK(met > 100);
    CHECK(blocked > 100);
    auto same = [](uint64_t fixed, const Brought& of, double sum) {
        if (of.sum == 0) CHECK(fixed == 0);
        if (of.sum == 0) return;
        CHECK(std::abs(std::ldexp(double(fixed), -40) * of.sum - sum) <=
              1e-6 * sum + 64000 * 0x1p-40 * of.sum);
    };
    for (size_t g = 0; g < 2; ++g) {
        int places = 0, unknown = 0;
        for (size_t k = 0; k < classes; ++k) {
            (groups[g].from_eye[k].sum > 0 ? places : unknown) += came_in[g][k] > 0;
            same(tally.near[g].from_light[k].came, groups[g].from_light[k], came[g][k]);
            CHECK(tally.near[g].from_eye[k].hits == hits[g][k]);
            same(tally.near[g].from_eye[k].came, groups[g].from_eye[k], came_in[g][k]);
            CHECK(value_of(tally.near[g].squares[k]) ==
                  doctest::Approx(0x1p20 * squares[g][k]).epsilon(1e-9));
        }
        CHECK(places > 0);
        CHECK(unknown > 0);
        CHECK(std::ranges::count_if(came[g], [](double x) { return x > 0; }) > 1);
    }
    // Of a light that brings nothing nothing came; one path brings at most 2^20.
    for (size_t k = 0; k < classes; ++k)
        groups[0].from_light[k].sum = 0, groups[1].from_light[k].sum = 1e-300;
    tally.near = std::vector<NearMisses>(2);
    for (uint64_t i = 0; i < 64; ++i)
        radiance(s, technique, settings, int(i % 8), int(i / 8), i,
                 NearMissVisitor{s, groups, each, sizes, tally});
    uint64_t of_second = 0;
    for (size_t k = 0; k < classes; ++k) {
        CHECK(tally.near[0].from_light[k].came == 0);
        of_second |= tally.near[1].from_light[k].came;
    }
    CHECK(of_second > 0);
    CHECK(of_second % (uint64_t(1) << 60) == 0);
    const auto limited = [](uint64_t x) { return std::min(x, uint64_t(1) << 62); };
    Tally both = tally, many = tally;
    both.add(tally);
    for (int i = 0; i < 64; ++i) many.add(Tally(many));
    for (size_t k = 0; k < classes; ++k) {
        CHECK(both.near[1].from_light[k].came == limited(2 * tally.near[1].from_light[k].came));
        CHECK(many.near[1].from_light[k].came >= tally.near[1].from_light[k].came);
        CHECK(both.near[1].from_eye[k].came == limited(2 * tally.near[1].from_eye[k].came));
        CHECK(both.near[1].from_eye[k].hits == 2 * tally.near[1].from_eye[k].hits);
        CHECK(both.near[1].squares[k] == 2 * tally.near[1].squares[k]);
    }
}

TEST_CASE("a light whose own paths bring more than those from the eye is in doubt") {
    // It sends 8 +- 1 to 25 pixels, a mean square of 2 / 25; the eye's paths, of t = 4 samples,
    // have a part of it.
    auto doubt = [](double part, double d2, std::vector<double> weights = {1},
                    bool is_from_eye = false) {
        NearMisses lamp{12, 1, 4, 0, 0};
        (is_from_eye ? lamp.from_eye : lamp.from_light)[5] = {8, 2, 1, uint64_t(part * 4 * 0x1p40),
                                                              10};
        MissedLight u;
        for (const double w : weights) u.add({lamp}, 4, w);
        return u.doubt(d2, 2, 25);
    };
    CHECK(doubt(0.62, 0) ==
          "paths from the eye bring less than paths from the light of line 12; light not yet found "
          "may amount to 8 %");
    CHECK(doubt(0.63, 0).empty());  // three standard errors
    CHECK(doubt(0.62, 0, {1}, true) ==
          "paths from the eye that aim bring more of the light of line 12; light not yet found "
          "may amount to 8 %");
    // Twice the square of the part that is missing.
    const double u = 2 * 2 * sqr(0.75) / 25;
    CHECK(!doubt(0.25, doubled_from(u, 4) * 0.999).empty());
    CHECK(doubt(0.25, doubled_from(u, 4) * 1.001).empty());
    // Films of other seeds say the same; bands add up.
    CHECK(!doubt(0.25, doubled_from(u, 4) * 0.999, {0.25, 0.75}).empty());
    CHECK(doubt(0.25, doubled_from(u, 4) * 1.001, {0.25, 0.75}).empty());
    CHECK(!doubt(0.25, doubled_from(2 * u, 4) * 0.999, {1, 1}).empty());
    CHECK(doubt(0.25, doubled_from(2 * u, 4) * 1.001, {1, 1}).empty());
    CHECK(!doubt(0.7, 0, {1, 1}).empty());  // 16 +- 1.4
    CHECK(doubt(0.8, 0, {1, 1}).empty());
}

TEST_CASE("light of a few bright paths is in doubt, though all of it came to both halves alike") {
    // The sum of squares of the hits is 1.
    auto doubt = [](uint64_t hits, double d2 = 0, std::vector<double> weights = {1},
                    double t = 16) {
        NearMisses lamp{12, 8, 4, 0, 0};
        lamp.from_eye[5].hits = hits;
        lamp.squares[5] = fixed_point(0x1p20 * 16 * 16 / 4);
        MissedLight u;
        for (const double w : weights) u.add({lamp}, t, w);
        return u.doubt(d2, 2, 25);
    };
    CHECK(doubt(9) ==
          "the light of line 12 by rare bright paths was hit 9 times; light not yet found may "
          "amount to 10 %");
    CHECK(doubt(10).empty());
    CHECK(!doubt(4, doubled_from(1 / 25.0, 4) * 0.999).empty());
    CHECK(doubt(4, doubled_from(1 / 25.0, 4) * 1.001).empty());
    // Of films of other seeds, and of bands, the hits add up.
    CHECK(!doubt(4, doubled_from(0.5 / 25, 4) * 0.999, {0.5, 0.5}).empty());
    CHECK(doubt(4, doubled_from(0.5 / 25, 4) * 1.001, {0.5, 0.5}).empty());
    CHECK(doubt(5, 0, {0.5, 0.5}).empty());
    // A 32nd of 512 samples of a pixel; films of other seeds have more, bands have other pixels.
    CHECK(!doubt(15, 0, {1}, 64).empty());
    CHECK(doubt(16, 0, {1}, 64).empty());
    CHECK(!doubt(15, 0, {0.5, 0.5}, 64).empty());
    CHECK(doubt(16, 0, {0.5, 0.5}, 64).empty());
    CHECK(!doubt(7, 0, {1, 1}, 64).empty());
    CHECK(doubt(8, 0, {1, 1}, 64).empty());
    CHECK(!doubt(4, doubled_from(2 / 25.0, 4) * 0.999, {1, 1}).empty());
    CHECK(doubt(4, doubled_from(2 / 25.0, 4) * 1.001, {1, 1}).empty());
}

TEST_CASE(
    "light is in doubt while few samples met it, and what is missing could double the error") {
    NearMisses lamp{12, 8, 4, 100, 0};
    auto doubt = [&](double hits, int near, double d2, double t = 1) {
        NearMisses of_film = lamp;
        of_film.sum.fill({fixed_point(near), fixed_point(near)});
        of_film.sum[0].fill(fixed_point(hits));
        MissedLight u;
        u.add({of_film}, t);
        return u.doubt(d2, 2, 25);
    };
    // Six near misses at s = 2, each with c = 1, give 4 * 6 / 4 over 25 pixels.
    CHECK(
        doubt(0, 6, 0.01) ==
        "the light of line 12 by way of mirrors or glass was hit 0 times; light not yet found may "
        "amount to 24 %");
    CHECK(doubt(10, 10, 0.01).empty());  // enough hits
    CHECK(doubt(0, 4, 0).empty());       // too few to judge
    CHECK(!doubt(0, 5, 0).empty());
    // The unseen light has about three times the observed variance.
    CHECK(!doubt(0, 6, doubled_from(6 / 25.0, 4) * 0.999).empty());
    CHECK(doubt(0, 6, doubled_from(6 / 25.0, 4) * 1.001).empty());
    CHECK(doubt(0, 6, doubled_from(6 / 25.0 / 4, 4) * 0.999, 2).size() > 0);
    CHECK(doubt(0, 6, doubled_from(6 / 25.0 / 4, 4) * 1.001, 2).empty());
    // Eye rays see a light that covers a part of a pixel.
    lamp = {0, 8, 4, 0.1, 0.09};
    CHECK(
        doubt(0, 0, 0, 12) ==
        "a light, smaller than a pixel, was hit 10 times; light not yet found may amount to 0.6 %");
    CHECK(doubt(0, 0, 0, 12.6).empty());
    // Of 8000 samples 500 are few.
    lamp = {0, 8, 4, 0.0624, 0.05};
    CHECK(!doubt(0, 0, 0, 1000).empty());
    lamp = {0, 8, 4, 0.0626, 0.05};
    CHECK(doubt(0, 0, 0, 1000).empty());
    // Films of other seeds have more samples of a pixel, bands have other pixels.
    auto is_known = [](double area, double weight) {
        MissedLight u;
        for (int film = 0; film < 2; ++film) u.add({{0, 8, 4, area, 0.05}}, 500, weight);
        return u.doubt(0, 2, 25).empty();
    };
    CHECK(!is_known(0.0624, 0.5));
    CHECK(is_known(0.0626, 0.5));
    CHECK(!is_known(0.0312, 1));
    CHECK(is_known(0.0313, 1));
}

TEST_CASE("no light that is missing can double an error of half the picture") {
    // A truth F^2 = 1 of what was found, and missing light from a thousandth of it to a million
    // times as much: it is in doubt if the relative error over the whole truth is more than twice
    // the one that the halves tell.
    int in_doubt = 0, known = 0;
    for (double u = 1e-3; u < 1e6; u *= 1.7)
        for (double error = 0.01; error < 3; error *= 1.3) {
            const double d2 = error * error;
            const bool doubles = std::sqrt((d2 + u) / (1 + u)) > 2 * error;
            NearMisses lamp{12, 1, 4, 0, 0};
            lamp.from_light[2] = {1, u / 2};  // counted twice
            MissedLight unseen;
            unseen.add({lamp}, 1);
            CHECK(unseen.doubt(d2, std::sqrt(1 + d2), 1).empty() != doubles);
            CHECK(!(doubles && error >= 0.5));
            (doubles ? in_doubt : known) += 1;
        }
    CHECK(in_doubt > 100);
    CHECK(known > 100);
    // Where all is noise, the halves tell so.
    NearMisses lamp{12, 1, 4, 0, 0};
    lamp.from_light[2] = {1, 0.5};
    MissedLight unseen;
    unseen.add({lamp}, 1);
    CHECK(unseen.doubt(4, 1, 1).empty());
}

TEST_CASE("films of one picture add up") {
    NearMisses lamp{3, 4, 1, 0.1, 0.09};
    lamp.sum.fill({fixed_point(40), fixed_point(40)});
    lamp.sum[0].fill(fixed_point(3));
    for (const auto& [films, why] :
         {std::pair{1, "was hit 3 times; light not yet found may amount to 158 %"},
          {3, "was hit 9 times; light not yet found may amount to 91 %"},
          {4, "smaller than a pixel"}}) {
        MissedLight u;
        for (int i = 0; i < films; ++i) u.add({lamp}, 2, 1.0 / films);
        CHECK(u.doubt(0, 1, 1).c_str() == doctest::Contains(why));
    }
    // Films of more samples count for more: 6 hits of 8 samples of each replication, not of 2.
    MissedLight u;
    u.add({lamp}, 2, 0.2), u.add({lamp}, 8, 0.8);
    CHECK(u.doubt(0, 1, 1) ==
          "the light of line 3 by way of mirrors or glass was hit 6 times; light not yet found may "
          "amount to 45 %");
}

TEST_CASE("many lights share groups, and one near miss in many counts for all") {
    NamedScene few = mirror_scene(real(0.02)), many = few;
    for (int i = 0; i < 999; ++i) add_sphere(many, {real(0.2), 50, 2}, real(1e-6), 1);
    many.line_of_light.resize(1000, 8);
    prepare(many);
    CHECK(in_view(many).groups.size() == max_light_groups);
    const auto one = misses_of(few, {}, 2000), all = misses_of(many, {}, 2000);
    CHECK(c(all, 0) == c(one, 0));  // actual hits
    const double expected = c(one, 6), sigma = std::sqrt(expected * 1000);
    CHECK(std::abs(c(all, 6) - expected) < 4 * sigma);
    CHECK(c(all, 6) > 0);
}

TEST_CASE("of many lights the brightest have groups of their own") {
    Scene s;
    for (int i = 0; i < 300; ++i) add_light(s, {{}, PointLight(), {real(i % 150), 1, 1}});
    const std::vector<size_t> group_of = light_groups(s);
    std::vector<std::vector<size_t>> members(max_light_groups);
    for (size_t i = 0; i < 300; ++i) members.at(group_of[i]).push_back(i);
    size_t most = 0;
    for (const auto& group : members) {
        most = std::max(most, group.size());
        if (std::ranges::any_of(group, [](size_t i) { return i % 150 >= 86; }))
            CHECK(group.size() == 1);
        // Neighbours share: those of 300 / 128 numbers.
        CHECK((group.empty() || group.back() - group.front() < 3));
    }
    CHECK(most == 3);
    s.lights.erase(s.lights.begin() + 256, s.lights.end());
    const std::vector<size_t> alone = light_groups(s);
    for (size_t i = 0; i < 256; ++i) CHECK(alone[i] == i);
}
