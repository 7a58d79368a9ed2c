// course/judge_3_light.h  judges 3.3 and 3.4: light by aiming at it, and weights of both ways
#pragma once
#include "course/judge_3_scenes.h"

namespace penumbra::course {
namespace {

// ---- 3.3 Light by aiming at it ------------------------------------------------------------------

const Triple albedo{0.2, 0.5, 0.8};
const Out ground = ball({0, 0, -10}, 10, {Stuff::rough, albedo});

// The eye looks from the side at the origin, where the ground's normal is z.
Out aimed(const Technique& t, uint64_t seed) {
    return question(t, seed, ray({-0.3, 0, 0.4}, {0.6, 0, -0.8}));
}

void from_a_point(Judge& j) {
    const Triple I{3, 2, 1}, at{1, 2, 2};  // 3 away, by a cosine of 2/3
    const Stuff rough{Stuff::rough, albedo};
    const Triple truth = (2 / 27.0 / oracle::pi) * albedo * I;
    build(j, 4, {ground, point_light(at, I)});
    const Rows L = j.probe("direct_light", {aimed({by_aiming}, 1), aimed({by_both}, 1)});
    const std::vector<oracle::Factor> factors{{"the distance squared", 9}, {"the cosine", 2 / 3.0}};
    colour(j, "a point light's intensity, distance and cosine", triple(L[0]), truth, factors);
    build(j, 4, {ground, point_light(at, I), ball({0.5, 1, 1}, 0.2, rough)});
    const Rows hidden = j.probe("direct_light", Rows(aimed({by_aiming}, 1)));
    const double in_the_way = j.ask("light_sample", aimed({by_aiming}, 1)).at(22);
    build(j, 4, {ground, point_light(at, I), ball({1.5, 3, 3}, 0.2, rough)});
    const Rows beyond = j.probe("direct_light", Rows(aimed({by_aiming}, 1)));
    const double behind = j.ask("light_sample", aimed({by_aiming}, 1)).at(22);
    colour(j, "nothing of a point light comes past an obstacle", triple(hidden[0]), {0, 0, 0});
    colour(j, "all of a point light comes if an obstacle is behind it", triple(beyond[0]),
           triple(L[0]));
    j.exact("`occluded` says whether something is in the way", in_the_way == 1 && behind == 0,
            oracle::say("%g where something is, %g where nothing is", in_the_way, behind));
    colour(j, "no share of a point light is left to rays that cannot meet it", triple(L[1]), truth);
    build(j, 4, {ground, point_light(at, 1e6 * I)});
    const Out strong = j.ask("direct_light", aimed({by_aiming}, 1));
    colour(j, "a light a million times as strong", triple(strong), 1e6 * truth);
    j.limit();
}

// A lamp far above a ball: seen from a point of its upper side.
void no_surface_shades_itself(Judge& j) {
    const double far = 1e4;
    build(
        j, 4,
        {ball({0, 0, 0}, 1, {Stuff::rough, albedo}), point_light({0, 0, far}, {far * far, 0, 0})});
    const auto from = [](const Triple& n) { return question({by_aiming}, 1, ray(3 * n, -1 * n)); };
    const auto on_the_ball = [](double z, double turns) {
        const double r = std::sqrt(1 - z * z), phi = 2 * oracle::pi * turns;
        return Triple{r * std::cos(phi), r * std::sin(phi), z};
    };
    j.probe("direct_light", rows_of(3, [&](size_t i) {
                return from(on_the_ball(0.3 + 0.2 * int(i), 0.1 + 0.37 * int(i)));
            }));
    const auto dark = [&](oracle::Random& random) {
        const Rows L = j.ask("direct_light", rows_of(400, [&](size_t) {
                                 const double turns = random(), z = 0.1 + 0.9 * random();
                                 return from(on_the_ball(z, turns));
                             }));
        size_t n = 0;
        for (size_t i = 0; i < L.size(); ++i) n += L[i][0] <= 0;
        return n;
    };
    oracle::Random fixed(1);
    j.remember({double(dark(fixed) > 0)});
    j.none("no surface is in its own way", dark(j.random),
           "%zu of 400 points are dark in broad light");
}

// The eye aims at one of two; each is worth 1 over the chance to be aimed at.
void from_two_points(Judge& j) {
    const Triple a = (2 / 27.0 / oracle::pi) * Triple{3, 2, 1} * albedo;    // 3 away
    const Triple b = (2 / 108.0 / oracle::pi) * Triple{4, 8, 16} * albedo;  // 6 away
    build(j, 4, {ground, point_light({1, 2, 2}, {3, 2, 1}), point_light({-4, 2, 4}, {4, 8, 16})});
    const Technique t{by_aiming};
    j.probe("direct_light", {aimed(t, 1), aimed(t, 2)});
    const Rows L =
        j.ask("direct_light", rows_of(4000, [&](size_t) { return aimed(t, any_seed(j)); }));
    double chance_of_a = 0, chance_of_b = 0;
    for (size_t i = 0; i < L.size(); ++i)
        if (L[i][0] * a[2] > L[i][2] * a[0] * 0.99)
            chance_of_a = a[0] / L[i][0];
        else
            chance_of_b = b[0] / L[i][0];
    j.number("chances by which two lights' samples are divided add up to",
             chance_of_a + chance_of_b, 1, tolerance(j));
    j.mean("mean of one of two lights: their sum", a[1] + b[1], L, [](In x) { return x[1]; });
}

// ---- Any scene ----

// What a light sample is made of (answers_3.cpp), and what came of it.
struct LightSample {
    double chance, pdf, cosine, of_rays;
    bool delta;
    Triple f, L, x, y, came;
    double told_pdf, told_weight;
    double weight(const Technique& t) const {
        const double p = chance * pdf, q = of_rays;
        return t.light == by_both && !delta ? p * p / (p * p + q * q) : 1;
    }
    Triple expected(const Technique& t) const {
        return cosine / (chance * pdf) * weight(t) * (f * L);
    }
};
LightSample light_sample(In r) {
    return {r[0],         r[1],          r[3],          r[4],          r[2] != 0, triple(r, 5),
            triple(r, 8), triple(r, 11), triple(r, 14), triple(r, 17), r[20],     r[21]};
}

// Of 32 paths to where the eye looks: green of light samples, and what it should be.
std::pair<Out, Out> green_of_samples(Judge& j, const Technique& t) {
    Out came, expected;
    for (uint64_t seed = 1; seed <= 32; ++seed) {
        const LightSample s = light_sample(j.ask("light_sample", aimed(t, seed)));
        if (!(s.pdf > 0) || s.cosine < 0.01) continue;
        came.push_back(s.came[1]), expected.push_back(s.expected(t)[1]);
    }
    j.remember_factor(came, expected);
    return {came, expected};
}

// A lamp that fills much of the sky: its sample in full, and beside rays that may meet it.
void from_a_lamp(Judge& j) {
    build(j, 4, {ground, ball({0, 0, 4}, 3.2, glowing({1, 2, 3}))});
    const auto [full, of_full] = green_of_samples(j, {by_aiming, uniform});
    all_near(j, "a lamp's L f cos / pdf", full, of_full);
    const auto [share, of_share] = green_of_samples(j, {by_both, uniform});
    all_near(j, "its share of that beside rays that may meet it", share, of_share);
    // Of two lamps the weight knows the chance, too.
    build(
        j, 4,
        {ground, ball({0, 3, 4}, 2, glowing({1, 2, 3})), ball({0, -3, 4}, 2, glowing({6, 5, 4}))});
    green_of_samples(j, {by_both, uniform});
}

struct Ball {
    Triple centre;
    double r;
    // How far from its surface the segment from x to y stays; negative: it goes through.
    double clear_of(const Triple& x, const Triple& y) const {
        const Triple d = y - x, to = centre - x;
        const double along = std::clamp(dot(to, d) / dot(d, d), 0.0, 1.0);
        return length(to - along * d) - r;
    }
};

// A ball seen from outside, or a room within one, among lamps and point lights of unequal powers,
// with balls in the way.
void of_any_scene(Judge& j, bool inside, double scale, Several& lit, Several& share, Several& dark,
                  Several& told) {
    const Pose pose = any_pose(j.random, scale);
    Stuff stuff{Stuff::rough, 0.5 * any_colour(j)};
    if (j.random() < 0.5) stuff.ks = 0.5 * any_colour(j), stuff.exponent = 6;
    const double size = inside ? 12 : 1;
    std::vector<Ball> lamps, others;
    std::vector<Out> things;
    const auto place = [&](const Triple& at, double r, const Stuff& m, std::vector<Ball>& list) {
        things.push_back(ball(pose.at(at), scale * r, m));
        list.push_back({pose.at(at), scale * r});
    };
    for (int i = 0; i < 8; ++i) place(3.2 * any_direction(j.random), 0.7, {}, others);
    things.push_back(ball(pose.at({}), scale * size, stuff));
    for (int i = 0; i < 2; ++i)
        place(7 * any_direction(j.random), 1, glowing(std::pow(30, j.random()) * any_colour(j)),
              lamps);
    for (int i = 0; i < 2; ++i)
        things.push_back(
            point_light(pose.at(5 * any_direction(j.random)),
                        40 * scale * scale * std::pow(30, j.random()) * any_colour(j)));
    build(j, 4, things);
    for (int i = 0; i < 48; ++i) {
        Triple n = any_direction(j.random), w = any_direction(j.random);
        if ((dot(n, w) < 0) != inside) w = -1.0 * w;
        if (std::abs(dot(n, w)) < 0.2) continue;
        const Technique t{i % 2 ? by_both : by_aiming, i % 4 < 2 ? uniform : by_bsdf};
        const LightSample s = light_sample(j.ask(
            "light_sample",
            question(t, any_seed(j), ray(pose.at(size * n + 0.5 * w), -1.0 * pose.turned(w)))));
        if (!(s.pdf > 0) || s.cosine < 1e-3 || length(s.f) < 1e-6) continue;
        double clear = oracle::infinity;
        for (const Ball& b : others) clear = std::min(clear, b.clear_of(s.x, s.y) / scale);
        for (const Ball& b : lamps)
            if (std::abs(length(s.y - b.centre) / b.r - 1) > 1e-3)
                clear = std::min(clear, b.clear_of(s.x, s.y) / scale);
        if (std::abs(clear) < 0.01) continue;
        const Triple expected = s.expected(t);
        const double error = tolerance(j) * length(expected);
        const std::string seen = oracle::say("%.6g expected, %.6g came, %.4g times as much",
                                             expected[1], s.came[1], s.came[1] / expected[1]);
        if (clear < 0)
            dark.see(length(s.came) == 0, oracle::say("%.6g came", s.came[1]));
        else
            (t.light == by_both && !s.delta ? share : lit)
                .see(length(s.came - expected) <= error, seen);
        if (clear > 0)
            told.see(near(s.told_pdf / (s.chance * s.pdf), 1, tolerance(j)) &&
                         near(s.told_weight, s.weight(t), tolerance(j)),
                     oracle::say("pdf = %.6g and weight = %.6g expected, %.6g and %.6g came",
                                 s.chance * s.pdf, s.weight(t), s.told_pdf, s.told_weight));
    }
}

void from_any_light(Judge& j) {
    Several lit, share, dark, inside, sizes, told;
    for (int i = 0; i < 12; ++i) of_any_scene(j, false, 1, lit, share, dark, told);
    for (int i = 0; i < 12; ++i) of_any_scene(j, true, 1, inside, inside, inside, told);
    for (int i = 0; i < 12; ++i)
        of_any_scene(j, i % 4 < 2, i % 2 ? 0x1p30 : 0x1p-30, sizes, sizes, sizes, told);
    j.all("of lights of unequal powers, each counts by f L cos over its chance and density", lit);
    j.all("under MIS each of these lights counts by its weight, too", share);
    j.all("what a ball hides is dark", dark);
    j.all("lights count alike from within a ball, where normals point away", inside);
    j.all("a scene a billion times as small or large is lit alike", sizes);
    j.limit();
    j.all("direct_light returns the density and the weight", told);
    j.limit();
}

void light_by_aiming(Judge& j) {
    from_a_point(j);
    no_surface_shades_itself(j);
    from_two_points(j);
    from_a_lamp(j);
    from_any_light(j);
}

// ---- 3.4 Both, weighted -------------------------------------------------------------------------

// A light's shape, a point of it and the light's normal there, met by a ray from the origin.
struct Place {
    double shape;
    Triple p, n;
    double k = 1;
};

Out met(const Technique& t, double pdf, const Place& y) {
    const Out s = path_state({0, 0, 0}, unit(y.p), {1, 1, 1}, int(y.k), pdf, {0, 0, 1});
    return row(t.numbers(), s, y.shape, y.p, y.n);
}

double weight(Judge& j, const Technique& t, double pdf, const Place& y) {
    return j.probe("weight_of_emission", Rows(met(t, pdf, y))).numbers[0];
}

// The density with which light samples go there, as the program itself says.
double density(Judge& j, const Technique& t, const Place& y) {
    const Out both = j.ask("likelihood", met(t, 1, y));
    return both[0] * both[1];
}

void of_one_lamp(Judge& j) {
    const Stuff lamp = glowing({1, 1, 1});
    build(j, 4, {ball({0, 0, 4}, 2, lamp)});
    const Place y{0, {0, 0, 2}, {0, 0, -1}}, seen{0, {0, 0, 2}, {0, 0, -1}, 0};
    j.number("the weight where nobody aims", weight(j, {by_chance}, 0.3, y), 1, 0);
    const double eye = weight(j, {by_aiming}, oracle::infinity, seen),
                 in_mirror = weight(j, {by_aiming}, oracle::infinity, y),
                 both = weight(j, {by_both}, oracle::infinity, y);
    j.exact("lamps that the eye sees, straight or in a mirror, weigh 1",
            eye == 1 && in_mirror == 1 && both == 1,
            oracle::say("they weigh %.6g and %.6g", eye, in_mirror));
    j.number("the weight where light is found by aiming alone", weight(j, {by_aiming}, 0.3, y), 0,
             0);
    weight(j, {by_both}, 0.3, y), weight(j, {by_both}, 5, y);
    const double q = density(j, {by_both}, y);
    const auto of = [&](double p) { return j.ask("weight_of_emission", met({by_both}, p, y))[0]; };
    j.number("the weight of a ray three times as likely as the light sample", of(3 * q), 0.9,
             tolerance(j, 64));
    j.number("the weight of a ray a third as likely", of(q / 3), 0.1, tolerance(j, 64));
}

// Samples of a ball's light do not go to its inside: who stands there meets it by chance alone.
void within_a_lamp(Judge& j) {
    Stuff lamp = glowing({1, 1, 1});
    lamp.twosided = true;
    build(j, 4, {ball({0, 0, 0}, 5, lamp)});
    const Place y{0, {0, 0, 5}, {0, 0, 1}};
    const double aiming = weight(j, {by_aiming}, 0.3, y), both = weight(j, {by_both}, 0.3, y);
    j.exact("a light that cannot be aimed at from there weighs 1",
            near(aiming, 1, tolerance(j, 4)) && near(both, 1, tolerance(j, 4)),
            oracle::say("it weighs %.6g, and %.6g where both ways are used", aiming, both));
}

void of_two_lamps(Judge& j) {
    const Stuff dim = glowing({1, 1, 1}), bright = glowing({5, 5, 5});
    build(j, 4, {ball({3, 0, 4}, 1, dim), quad({-3, -1, 3}, {0, 2, 0}, {2, 0, 0}, bright)});
    const std::vector<Place> places = {{0, {2.4, 0, 3.2}, {-0.6, 0, -0.8}},
                                       {1, {-2.5, 0.5, 3}, {0, 0, -1}}};
    const Technique t{by_both};
    for (const Place& y : places) weight(j, t, 0.3, y);
    double off = 0;
    for (const Place& y : places)
        off =
            worse(off, std::abs(j.ask("weight_of_emission", met(t, density(j, t, y), y))[0] - 0.5));
    j.exact("of two lamps: 1/2 where both ways are as likely", off <= tolerance(j, 64),
            oracle::say("off by %.6g", off));
}

// Lamps that shine on each other: seen from one of them the other is the likelier.
void of_facing_lamps(Judge& j) {
    const Stuff dim = glowing({1, 1, 1}), bright = glowing({5, 5, 5});
    build(j, 4, {ball({3, 0, 4}, 1, dim), ball({-3, 0, 4}, 1, bright)});
    weight(j, {by_both}, 0.3, {0, {2.4, 0, 3.2}, {-0.6, 0, -0.8}});
}

// Lamps of both kinds among balls that are none, in any order and pose.
void of_any_lamp(Judge& j) {
    Worst weight;
    for (int i = 0; i < 40; ++i) {
        const Pose pose = any_pose(j.random, std::ldexp(1, i % 3 * 8 - 8));
        const Stuff lamp = glowing(std::pow(30, j.random()) * Triple{1, 2, 3});
        std::vector<Out> things;
        std::vector<Place> places;
        double shapes = 0;
        for (int k = 0; k < 6; ++k) {
            const Triple at = 6 * any_direction(j.random), u = any_direction(j.random);
            const Triple v = unit(cross(u, at)), n = unit(cross(u, v));
            if (k == 2 || k == 5) {
                things.push_back(quad(pose.at(at), pose.scale * pose.turned(u),
                                      pose.scale * pose.turned(v), lamp));
                const Triple y = at + j.random() * u + j.random() * v;
                places.push_back({shapes, pose.at(y), unit(cross(pose.turned(u), pose.turned(v)))});
                shapes += 2;
            } else {
                things.push_back(ball(pose.at(at), pose.scale, k % 2 ? lamp : Stuff{}));
                const Triple m = dot(n, at) < 0 ? n : -1.0 * n;
                if (k % 2) places.push_back({shapes, pose.at(at + m), pose.turned(m)});
                ++shapes;
            }
        }
        build(j, 4, things);
        for (Place y : places) {
            // From a point near the middle, with a normal towards the lamp.
            const Triple from = pose.at(0.5 * in_cube(j.random));
            const Technique t{i % 4 ? by_both : by_aiming};
            const double p = std::pow(100, 2 * j.random() - 1);
            const Out s = path_state(from, unit(y.p - from), {1, 1, 1}, 1 + i % 5, p,
                                  unit(unit(y.p - from) + 0.5 * any_direction(j.random)));
            const Out asked = row(t.numbers(), s, y.shape, y.p, y.n);
            const Out both = j.ask("likelihood", asked);
            const double q = both[0] * both[1], came = j.ask("weight_of_emission", asked)[0];
            const double truth = t.light == by_aiming ? q <= 0 : p * p / (p * p + q * q);
            weight.see(std::abs(came - truth),
                       oracle::say("densities of %.4g by chance and %.4g by aiming: %.6g expected, "
                                   "%.6g came",
                                   p, q, truth, came));
        }
    }
    j.worst("of many lamps, beside balls that are none: any densities", weight, tolerance(j, 1e4));
}

void both_weighted(Judge& j) {
    of_one_lamp(j);
    of_two_lamps(j);
    of_facing_lamps(j);
    of_any_lamp(j);
    within_a_lamp(j);
}

}  // namespace
}  // namespace penumbra::course
