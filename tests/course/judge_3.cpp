// course/judge_3.cpp  judges week 3: the path
//
// Scenes stand here, beside what is known of them; the program that answers only builds them.
#include "course/judge.h"

using namespace course;

namespace {

// ---- Scenes -------------------------------------------------------------------------------------

struct Stuff {
    enum Kind { rough, mirror, glass } kind = rough;
    Triple kd{}, ks{};
    double exponent = 0, ior = 1;
    Triple Le{};
    bool twosided = false;
};

Stuff glowing(const Triple& Le, Stuff m = {}) {
    m.Le = Le;
    return m;
}

Out thing(double kind, const Triple& a, const Triple& b, const Triple& c, const Stuff& m) {
    return row(kind, a, b, c, int(m.kind), m.kd, m.ks, m.exponent, m.ior, m.Le, m.twosided);
}
Out ball(const Triple& centre, double r, const Stuff& m) {
    return thing(0, centre, {r, 0, 0}, {}, m);
}
Out quad(const Triple& p, const Triple& u, const Triple& v, const Stuff& m) {
    return thing(1, p, u, v, m);
}
Out point_light(const Triple& p, const Triple& intensity) { return thing(2, p, intensity, {}, {}); }

void build(Judge& j, int depth, const std::vector<Out>& things) {
    Out all{double(depth)};
    for (const Out& t : things) all = row(all, t);
    j.ask("scene", all);
}

// ---- Questions ----------------------------------------------------------------------------------

enum Light { by_chance, by_aiming, by_both };
enum Directions { uniform, by_bsdf };

struct Technique {
    Light light = by_chance;
    Directions directions = by_bsdf;
    double roulette = 0;
    Out numbers() const { return {double(light), double(directions), roulette}; }
};

// A path's ray that was drawn with density pdf after k scatterings, n being the normal it left.
Out segment(const Triple& o, const Triple& d, const Triple& beta = {1, 1, 1}, int k = 0,
            double pdf = oracle::infinity, const Triple& n = {}) {
    return row(o, d, o, pdf, beta, k, n);
}

// What is asked of path `seed`.
Out question(const Technique& t, uint64_t seed, const Out& more) {
    return row(t.numbers(), seed, more);
}
Out ray(const Triple& o, const Triple& d) { return row(o, d); }

// Who computes in float here and there is as right: errors of some roundings, and of 1e-6, are
// none.
double tolerance(const Judge& j, double roundings = 1e4) {
    return std::max(1e-6, roundings * j.epsilon);
}
// Which factor they are off by, if it is one for all, and what may have been forgotten.
std::string off_by(In came, In expected, const std::vector<oracle::Factor>& factors = {}) {
    double factor = 0;
    for (size_t i = 0; i < came.size(); ++i)
        if (std::abs(expected[i]) > 1e-9) factor = came[i] / expected[i];
    for (size_t i = 0; i < came.size(); ++i)
        if (!(std::abs(came[i] - factor * expected[i]) <= 1e-6 * std::abs(came[i]) + 1e-12))
            return "";
    if (factor == 0 || !std::isfinite(factor)) return "";
    return ", " + oracle::times(factor, 1e-5) + " times as much" +
           oracle::cause_of(factor, 1e-5, factors);
}
// A colour.
void colour(Judge& j, const std::string& what, const Triple& came, const Triple& expected,
            const std::vector<oracle::Factor>& factors = {}) {
    j.vector(what, came, expected, tolerance(j));
    if (!j.items.back().right) j.items.back().seen += off_by(came, expected, factors);
}

// What happened at a vertex.
struct Step {
    bool goes_on;
    double weight;
    Triple Le, direct, beta;
    Triple along, normal;  // where the path goes on, in the world
    Out next;
    Triple f, wi;  // wi is local
    double pdf;
    Triple factor() const { return std::abs(wi[2]) / pdf * f; }
};
Step step(In x) {
    return {x[1] != 0,     x[2],          triple(x, 3),  triple(x, 6),
            triple(x, 25), triple(x, 9),  triple(x, 12), Out(x.begin() + 15, x.begin() + 32),
            triple(x, 32), triple(x, 35), x[38]};
}
Step take_step(Judge& j, const Technique& t, uint64_t seed, const Out& from) {
    return step(j.ask("step", question(t, seed, from)));
}

// ---- 3.1 The sum over a path --------------------------------------------------------------------

// Within a ball that emits Le and mirrors half of what meets it, radiance is Le (2 - 2^-depth).
void within_a_hall_of_mirrors(Judge& j, const Triple& Le, const std::vector<int>& depths) {
    Stuff mirror = glowing(Le, {Stuff::mirror, {}, {0.5, 0.5, 0.5}});
    mirror.twosided = true;
    for (int depth : depths) {
        build(j, depth, {ball({0, 0, 0}, 2, mirror)});
        const Rows L =
            j.probe("Li", Rows(question({}, 1, ray({0.3, 0.1, -0.2}, {0.48, 0.6, 0.64}))));
        j.vector(oracle::say("within mirrors of half that emit %g, %d reflections", Le[0], depth),
                 triple(L[0]), (2 - std::ldexp(1, -depth)) * Le, tolerance(j));
    }
}
// Other code counts rays by it: each vertex once, with the segment that arrived there.
void account_of_all(Judge& j) {
    const Stuff mirror{Stuff::mirror, {}, {0.5, 0.5, 0.5}};
    build(j, 7, {ball({0, 0, 0}, 2, mirror)});
    const Out within = question({}, 1, ray({0.3, 0.1, -0.2}, {0.48, 0.6, 0.64}));
    const Out eight = j.probe("accounts", Rows(within)).numbers;
    build(j, 7, {ball({0, 0, 0}, 1, mirror)});
    const Out away = question({}, 1, ray({0, 0, 4}, {0, 0, -1}));
    const Out two = j.probe("accounts", Rows(away)).numbers;
    j.number("the path is followed to its end: account is told of each of 8 vertices", eight[0], 8,
             0);
    j.number("and of a ray that meets nothing: of a mirror and of the ray that it sends away",
             two[0], 2, 0);
    j.number("account is told of a vertex with the segment that arrived there: how often of 8",
             eight[1], 8, 0);
}

// A rough ball below a point light, seen straight on and by a mirror that takes half.
void a_lit_ball_and_its_image(Judge& j) {
    const Stuff moon{Stuff::rough, {0.2, 0.5, 0.8}}, mirror{Stuff::mirror, {}, {0.5, 0.5, 0.5}};
    build(j, 2,
          {ball({0, 0, 0}, 1, moon), ball({0, 0, 6}, 1, mirror),
           point_light({4, 1, 3}, {30, 20, 10})});
    const Technique t{by_aiming, uniform};
    const Out straight = ray({0, 0, 4.5}, {0, 0, -1}), image = ray({0, 0.02, 4}, {0, 0, 1});
    const Rows L = j.probe("Li", {question(t, 1, straight), question(t, 1, image)});
    const Step first = take_step(j, t, 1, segment({0, 0, 4.5}, {0, 0, -1}));
    colour(j, "light found by aiming counts in full where the eye looks", triple(L[0]),
           first.direct);
    const Step mirrored = take_step(j, t, 1, segment({0, 0.02, 4}, {0, 0, 1}));
    const Step seen = take_step(j, t, 1, mirrored.next);
    colour(j, "and half of it in a mirror that takes half", triple(L[1]), 0.5 * seen.direct);
}

// A lamp on which another one shines.
void a_lamp_is_lit(Judge& j) {
    const Stuff lamp = glowing({3, 2, 1}, {Stuff::rough, {0.2, 0.5, 0.8}});
    build(j, 2, {ball({0, 0, 0}, 1, lamp), point_light({4, 1, 3}, {300, 200, 100})});
    const Technique t{by_aiming, uniform};
    const Rows L = j.probe("Li", Rows(question(t, 1, ray({0, 0, 4.5}, {0, 0, -1}))));
    const Step s = take_step(j, t, 1, segment({0, 0, 4.5}, {0, 0, -1}));
    colour(j, "a lamp on which another one shines: what it emits, and what it reflects",
           triple(L[0]), s.weight * s.Le + s.direct);
}

// From a floor many rays meet the large lamp above it.
void a_lamp_is_met(Judge& j) {
    const Stuff lamp = glowing({1, 2, 3});
    build(j, 1, {ball({0, 0, -10}, 10, {Stuff::rough, {0.5, 0.5, 0.5}}), ball({0, 0, 3}, 2, lamp)});
    const Technique t{by_both};
    const Triple eye{8, 0, 4}, d{-2 / std::sqrt(5), 0, -1 / std::sqrt(5)};
    int met = 0;
    Out came, by_aim, emitted, by_weight;
    for (uint64_t seed = 0; seed < 64 && met < 8; ++seed) {
        const Step floor = take_step(j, t, seed, segment(eye, d));
        if (!floor.goes_on) continue;
        const Step then = take_step(j, t, seed, floor.next);
        if (then.Le[0] == 0) continue;
        const Triple L = triple(j.ask("Li", question(t, seed, ray(eye, d))));
        came.push_back(L[0]), by_aim.push_back(floor.direct[0]);
        emitted.push_back(floor.beta[0] * then.Le[0]);
        by_weight.push_back(then.weight * emitted.back());
        ++met;
    }
    // Mistakes are told by which of them it is.
    const auto remember = [&](const Out& a, const Out& b) {
        Out sum = a;
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += b[i];
        j.remember_factor(came, sum);
        return sum;
    };
    if (met == 0) return j.exact("a lamp that fills half of the sky is met", false, "no ray does");
    const Out none(came.size()), both = remember(by_aim, by_weight);
    remember(by_aim, emitted), remember(by_aim, none), remember(none, by_weight);
    size_t at = 0;
    while (at + 1 < both.size() && near(came[at], both[at], tolerance(j))) ++at;
    j.number("light found by chance counts by its weight, beside that by aiming", came[at],
             both[at], tolerance(j));
}

void sum_over_a_path(Judge& j) {
    account_of_all(j);
    within_a_hall_of_mirrors(j, {0.4, 0.3, 0.2}, {0, 1, 7});
    within_a_hall_of_mirrors(j, {40000, 30000, 20000}, {60});
    a_lit_ball_and_its_image(j);
    a_lamp_is_lit(j);
    a_lamp_is_met(j);
}

// ---- 3.2 Throughput -----------------------------------------------------------------------------

const Triple towards{0.48, 0.6, 0.64};  // unit: where the eye is, seen from the ball's centre

// The throughput of paths that were (1, 1, 1), or `before`, and met a ball of that stuff: the
// normal there is `towards`, and with aside > 0 the eye looks at it from the side.
Out towards_a_ball(double aside = 0, const Triple& before = {1, 1, 1}, int k = 0) {
    const Triple o = 5 * towards + aside * Triple{0.64, 0, -0.48};
    const Triple to = towards - o;
    return segment(o, unit(to), before, k);
}

void of_a_mirror(Judge& j) {
    const Triple ks{0.3, 0.6, 0.9}, before{0.5, 0.25, 2};
    build(j, 8, {ball({0, 0, 0}, 1, {Stuff::mirror, {}, ks})});
    const Rows b = j.probe("throughput", {question({}, 1, towards_a_ball(2)),
                                          question({}, 1, towards_a_ball(2, before, 3))});
    const Step s = take_step(j, {}, 1, towards_a_ball(2));
    const std::vector<oracle::Factor> factors{{"the cosine", std::abs(s.wi[2])}};
    colour(j, "a mirror of reflectance (0.3, 0.6, 0.9)", triple(b[0]), ks, factors);
    colour(j, "the same at the end of a path of throughput (0.5, 0.25, 2)", triple(b[1]),
           ks * before, factors);
}

// Whatever the direction and its density are: f |cos| / pdf of them, times what was before.
struct Scatterings {
    std::vector<Step> steps;
    Out came, expected;
    double off = 0;
    std::string seen;
    void look(Judge& j, const Technique& t, uint64_t seed, const Out& from, const Triple& before) {
        const Step& s = steps.emplace_back(take_step(j, t, seed, from));
        if (!s.goes_on || !(s.pdf > 0)) return;
        const Triple truth = s.factor() * before;
        came.push_back(s.beta[0]), expected.push_back(truth[0]);
        const double d = length(s.beta - truth) / std::max(1e-9, length(truth));
        if (d <= off) return;
        off = std::isnan(d) ? oracle::infinity : d;
        seen = oracle::say("by f = %.4g, a cosine of %.4g and pdf = %.4g, %.6g expected, %.6g came",
                           s.f[0], s.wi[2], s.pdf, truth[0], s.beta[0]);
    }
    void judge(Judge& j, const std::string& what) const {
        j.exact(what, !came.empty() && off <= tolerance(j), seen);
    }
};

void of_a_rough_ball(Judge& j) {
    const Triple kd{0.2, 0.5, 0.8};
    build(j, 8, {ball({0, 0, 0}, 1, {Stuff::rough, kd})});
    const Out from = towards_a_ball(2);
    Out came, usual, likely, without_f, to_the_eye, of_the_world;
    Out twice, without_cosine, not_over_pdf;
    for (Directions d : {by_bsdf, uniform}) {
        Scatterings s;
        for (uint64_t seed = 1; seed <= 200; ++seed)
            s.look(j, {by_chance, d}, seed, from, {1, 1, 1});
        s.judge(j, d == uniform ? "f |cos| / pdf of a rough ball, if directions are uniform"
                                : "f |cos| / pdf of a rough ball, if they follow the cosine");
        for (const Step& e : s.steps) {
            if (!e.goes_on || !(e.pdf > 0)) continue;
            const double f = e.f[0], cos = std::abs(e.wi[2]);
            came.push_back(e.beta[0]), usual.push_back(f * cos / e.pdf);
            likely.push_back(f * cos * e.pdf), not_over_pdf.push_back(f * cos);
            twice.push_back(f * cos * cos / e.pdf), without_cosine.push_back(f / e.pdf);
            without_f.push_back(cos / e.pdf),
                of_the_world.push_back(f * std::abs(e.along[2]) / e.pdf);
            to_the_eye.push_back(f * -dot(triple(from, 3), e.normal) / e.pdf);
        }
    }
    // Directions are those of other exercises; a formula is told whatever they are.
    if (!came.empty())
        for (const Out& formula : {usual, likely, without_f, to_the_eye, of_the_world, twice,
                                   without_cosine, not_over_pdf})
            j.remember_factor(came, formula);
}

// Balls of one stuff after the other in any pose, met from outside or inside.
void of_any_ball(Judge& j, bool outside) {
    const char* names[] = {"a rough", "a glossy", "a mirroring", "a glass"};
    for (int kind = 0; kind < 4; ++kind) {
        Scatterings s;
        for (int i = 0; i < 16; ++i) {
            const Pose pose = any_pose(j.random, std::ldexp(1, i % 3 * 10 - 10));
            const auto colour = [&] { return Triple{j.random(), j.random(), j.random()}; };
            const Stuff stuffs[] = {{Stuff::rough, colour()},
                                    {Stuff::rough, colour(), colour(), 8},
                                    {Stuff::mirror, {}, colour()},
                                    {Stuff::glass, {}, {}, 0, 1.5}};
            build(j, 20, {ball(pose.at({}), pose.scale, stuffs[kind])});
            const Triple n = any_direction(j.random), before = colour();
            const Triple o = outside ? 2 * n + 0.5 * in_cube(j.random) : 0.5 * in_cube(j.random);
            const Triple to = 0.5 * any_direction(j.random);
            const int k = int(10 * j.random());
            s.look(j, {by_chance, i % 2 ? uniform : by_bsdf}, j.random.bits() >> 32,
                   segment(pose.at(o), pose.turned(unit(to - o)), before, k), before);
        }
        s.judge(j, oracle::say("f |cos| / pdf of %s ball, %s, in any place and pose", names[kind],
                               outside ? "from outside" : "from within"));
    }
}

// A lamp that reflects, too, is hit by a path that was drawn in order to do so.
void of_a_lamp(Judge& j) {
    build(j, 8, {ball({0, 0, 0}, 1, glowing({3, 2, 1}, {Stuff::rough, {0.5, 0.5, 0.5}}))});
    Out from = towards_a_ball(2, {1, 1, 1}, 1);
    from[9] = 0.3;
    Scatterings s;
    for (uint64_t seed = 1; seed <= 8; ++seed) s.look(j, {by_aiming}, seed, from, {1, 1, 1});
    if (!s.came.empty()) j.remember_factor(s.came, s.expected);
    s.judge(j, "a lamp's albedo, whatever its light weighs");
}

void of_clear_glass(Judge& j) {
    build(j, 8, {ball({0, 0, 0}, 1, {Stuff::glass})});
    const Rows b = j.probe("throughput", Rows(question({}, 1, towards_a_ball(2))));
    colour(j, "glass of index 1 lets all light through", triple(b[0]), {1, 1, 1});
}

void throughput(Judge& j) {
    of_a_mirror(j);
    of_a_rough_ball(j);
    of_a_lamp(j);
    of_clear_glass(j);
    of_any_ball(j, true);
    of_any_ball(j, false);
}

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
    build(j, 4, {ground, point_light(at, I), ball({1.5, 3, 3}, 0.2, rough)});
    const Rows beyond = j.probe("direct_light", Rows(aimed({by_aiming}, 1)));
    colour(j, "nothing of it behind an obstacle", triple(hidden[0]), {0, 0, 0});
    colour(j, "all of it before an obstacle", triple(beyond[0]), triple(L[0]));
    colour(j, "no share of it is left to rays that cannot meet it", triple(L[1]), truth);
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
    Rows some;
    for (int i = 0; i < 3; ++i) some.add(from(on_the_ball(0.3 + 0.2 * i, 0.1 + 0.37 * i)));
    j.probe("direct_light", some);
    const auto dark = [&](oracle::Random& random) {
        Rows ask;
        for (int i = 0; i < 400; ++i) ask.add(from(on_the_ball(0.1 + 0.9 * random(), random())));
        const Rows L = j.ask("direct_light", ask);
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
    Rows ask;
    for (int i = 0; i < 4000; ++i) ask.add(aimed(t, j.random.bits() >> 32));
    const Rows L = j.ask("direct_light", ask);
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

// A lamp that fills much of the sky: its sample in full, and beside rays that may meet it.
void from_a_lamp(Judge& j) {
    build(j, 4, {ground, ball({0, 0, 4}, 3.2, glowing({1, 2, 3}))});
    for (Light light : {by_aiming, by_both}) {
        const Technique t{light, uniform};
        Out came, expected;
        for (uint64_t seed = 1; seed <= 32; ++seed) {
            const LightSample s = light_sample(j.ask("light_sample", aimed(t, seed)));
            if (!(s.pdf > 0) || s.cosine < 0.01) continue;
            came.push_back(s.came[1]), expected.push_back(s.expected(t)[1]);
        }
        j.remember_factor(came, expected);
        size_t at = 0;
        while (at + 1 < came.size() && near(came[at], expected[at], tolerance(j))) ++at;
        j.number(light == by_aiming ? "a lamp's L f cos / pdf"
                                    : "its share of that beside rays that may meet it",
                 came.at(at), expected.at(at), tolerance(j));
    }
    // Of two lamps the weight knows the chance, too.
    build(
        j, 4,
        {ground, ball({0, 3, 4}, 2, glowing({1, 2, 3})), ball({0, -3, 4}, 2, glowing({6, 5, 4}))});
    Out came, expected;
    for (uint64_t seed = 1; seed <= 32; ++seed) {
        const Technique t{by_both, uniform};
        const LightSample s = light_sample(j.ask("light_sample", aimed(t, seed)));
        if (!(s.pdf > 0) || s.cosine < 0.01) continue;
        came.push_back(s.came[1]), expected.push_back(s.expected(t)[1]);
    }
    j.remember_factor(came, expected);
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

// What was asked of light samples in scenes of one kind.
struct Asked {
    std::string what;
    size_t n = 0, wrong = 0;
    std::string first = {};
    void see(bool right, const std::string& seen) {
        ++n;
        if (!right && wrong++ == 0) first = seen;
    }
    void judge(Judge& j) const {
        j.exact(what, n > 0 && wrong == 0,
                first + oracle::say(" (%zu of %zu are wrong)", wrong, n));
    }
};

// A ball seen from outside, or a room within one, among lamps and point lights of unequal powers,
// with balls in the way.
void of_any_scene(Judge& j, bool inside, double scale, Asked& lit, Asked& share, Asked& dark,
                  Asked& told) {
    const Pose pose = any_pose(j.random, scale);
    const auto colour = [&] { return Triple{j.random(), j.random(), j.random()}; };
    Stuff stuff{Stuff::rough, 0.5 * colour()};
    if (j.random() < 0.5) stuff.ks = 0.5 * colour(), stuff.exponent = 6;
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
        place(7 * any_direction(j.random), 1, glowing(std::pow(30, j.random()) * colour()), lamps);
    for (int i = 0; i < 2; ++i)
        things.push_back(point_light(pose.at(5 * any_direction(j.random)),
                                     40 * scale * scale * std::pow(30, j.random()) * colour()));
    build(j, 4, things);
    for (int i = 0; i < 48; ++i) {
        Triple n = any_direction(j.random), w = any_direction(j.random);
        if ((dot(n, w) < 0) != inside) w = -1.0 * w;
        if (std::abs(dot(n, w)) < 0.2) continue;
        const Technique t{i % 2 ? by_both : by_aiming, i % 4 < 2 ? uniform : by_bsdf};
        const LightSample s = light_sample(j.ask(
            "light_sample", question(t, j.random.bits() >> 32,
                                     ray(pose.at(size * n + 0.5 * w), -1.0 * pose.turned(w)))));
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
    Asked lit{"of lights of unequal powers, each counts by f L cos over its chance and density"},
        share{"and under MIS by its weight"}, dark{"what a ball hides is dark"},
        inside{"the same from within a ball, where normals point away"},
        sizes{"a scene a billion times as small or large is lit alike"},
        told{"account is told the density, and the weight"};
    for (int i = 0; i < 12; ++i) of_any_scene(j, false, 1, lit, share, dark, told);
    for (int i = 0; i < 12; ++i) of_any_scene(j, true, 1, inside, inside, inside, told);
    for (int i = 0; i < 12; ++i)
        of_any_scene(j, i % 4 < 2, i % 2 ? 0x1p30 : 0x1p-30, sizes, sizes, sizes, told);
    for (const Asked* a : {&lit, &share, &dark, &inside}) a->judge(j);
    for (const Asked* a : {&sizes, &told}) a->judge(j), j.limit();
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
    const Out s = segment({0, 0, 0}, unit(y.p), {1, 1, 1}, int(y.k), pdf, {0, 0, 1});
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
    double off = 0;
    std::string seen;
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
            const Out s = segment(from, unit(y.p - from), {1, 1, 1}, 1 + i % 5, p,
                                  unit(unit(y.p - from) + 0.5 * any_direction(j.random)));
            const Out asked = row(t.numbers(), s, y.shape, y.p, y.n);
            const Out both = j.ask("likelihood", asked);
            const double q = both[0] * both[1], came = j.ask("weight_of_emission", asked)[0];
            const double truth = t.light == by_aiming ? q <= 0 : p * p / (p * p + q * q);
            if (std::abs(came - truth) <= off) continue;
            off = std::isnan(came) ? oracle::infinity : std::abs(came - truth);
            seen = oracle::say(
                "densities of %.4g by chance and %.4g by aiming: %.6g expected, "
                "%.6g came",
                p, q, truth, came);
        }
    }
    j.exact("of many lamps, beside balls that are none: any densities", off <= tolerance(j, 1e4),
            seen);
}

void both_weighted(Judge& j) {
    of_one_lamp(j);
    of_two_lamps(j);
    of_facing_lamps(j);
    of_any_lamp(j);
    within_a_lamp(j);
}

// ---- 3.5 Russian roulette -----------------------------------------------------------------------

// Whoever is dim dies often: the number that roulette draws says when.
void fate_of_the_dim(Judge& j, double threshold, const Triple& before, double chance) {
    const int n = 20000;
    const Out from = towards_a_ball(2, before, 2);
    const uint64_t first = j.random.bits() >> 32;
    Rows paths, which;
    for (int i = 0; i < n; ++i) {
        paths.add(question({by_chance, by_bsdf, threshold}, first + uint64_t(i), from));
        which.add({double(first + uint64_t(i)), 2, 6});
    }
    const Rows beta = j.ask("throughput", paths), u = j.ask("number", which);
    size_t low = 0, high = 0, alive = 0;  // those of other fates, if low or high numbers save
    for (size_t i = 0; i < beta.size(); ++i) {
        const bool lives = beta[i][2] > 0;
        alive += lives;
        low += lives != (u[i][0] < chance), high += lives != (u[i][0] >= 1 - chance);
    }
    j.exact("of the dim as few survive as the law says", std::min(low, high) == 0,
            oracle::say("of 20000 paths with a chance of %.3g about "
                        "%.0f should, and %zu do",
                        chance, n * chance, alive));
}

// A mirror, which takes part of the path's throughput and no random number.
void roulette(Judge& j) {
    const double T = 2;
    const Triple before{0.4, 1.2, 1.6};
    build(j, 8, {ball({0, 0, 0}, 1, {Stuff::mirror, {}, {0.5, 0.5, 0.5}})});
    const Out from = towards_a_ball(2, before, 2);
    const auto asked = [&](double threshold, int n, uint64_t first) {
        Rows rows;
        for (int i = 0; i < n; ++i)
            rows.add(question({by_chance, by_bsdf, threshold}, first + uint64_t(i), from));
        return rows;
    };
    j.probe("throughput", asked(0.7 * T, 6, 1));
    const Rows many = j.ask("throughput", asked(T, 64, 1));
    double survivors = 0;
    for (size_t i = 0; i < many.size(); ++i) survivors += many[i][2] > 0;
    j.remember({survivors});
    j.probe("throughput", asked(0.05, 1, 1));
    const Triple without = triple(j.ask("throughput", question({}, 1, from)));
    const Triple whole = without[2] > 0 ? without : 0.5 * before;
    j.exact("where the threshold is 0 nobody dies", without[2] > 0, "a path was ended");
    const double chance = whole[2] / T;

    const Rows bright = j.ask("throughput", asked(0.9 * whole[2], 64, 1));
    bool untouched = true;
    for (size_t i = 0; i < bright.size(); ++i) untouched &= triple(bright[i]) == whole;
    j.exact("a path whose largest channel is above the threshold goes on as it is", untouched,
            "one of 1.1 times the threshold was ended, or changed");

    const uint64_t first = j.random.bits() >> 32;
    const int n = 100000;
    const Rows beta = j.ask("throughput", asked(T, n, first));
    Rows which;
    for (int i = 0; i < n; ++i) which.add({double(first + uint64_t(i)), 2, 6});
    const Rows u = j.ask("number", which);
    double alive = 0, highest_alive = 0, lowest_alive = 1, highest_dead = 0, lowest_dead = 1;
    Triple survivor{};
    for (size_t i = 0; i < beta.size(); ++i) {
        const bool lives = beta[i][2] > 0;
        alive += lives;
        if (lives) survivor = triple(beta[i]);
        double& high = lives ? highest_alive : highest_dead;
        double& low = lives ? lowest_alive : lowest_dead;
        high = std::max(high, u[i][0]), low = std::min(low, u[i][0]);
    }
    colour(j, "who survives has the threshold in its largest channel, and its colour", survivor,
           (1 / chance) * whole);
    j.exact(
        "the number that roulette draws decides, and nothing else",
        alive > 0 && alive < n && (highest_alive <= lowest_dead || highest_dead <= lowest_alive),
        oracle::say("of %d paths %.0f survive, with numbers of %.3g to %.3g", n, alive,
                    lowest_alive, highest_alive));
    fate_of_the_dim(j, T, 0.01 * before, 0.01 * chance);
    j.mean("share of paths that survive", chance, beta, [](In b) { return b[2] > 0 ? 1.0 : 0.0; });
    j.mean("mean throughput, the dead counted as 0", whole[0], beta, [](In b) { return b[0]; });
}

// ---- 3.6 Glass ----------------------------------------------------------------------------------

// Asks for a way of light at glass; the direction to the eye has that cosine.
Out at_glass(double ior, bool outside, double u, double cosine) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {ior, double(outside), u, 0.6 * sine, 0.8 * sine, cosine};
}

// The weights f |cos| and probabilities of both ways, and where they lead: from answers to many u.
struct Ways {
    double reflected = 0, refracted = 0, pdf_reflected = 0, pdf_refracted = 0;
    Triple mirror{}, through{};
    int n_reflected = 0, n = 0;
};
Ways ways(Judge& j, double ior, bool outside, double cosine) {
    Rows ask;
    for (int i = 0; i < 512; ++i) ask.add(at_glass(ior, outside, (i + 0.5) / 512, cosine));
    const Rows b = j.ask("sample_glass", ask);
    Ways w;
    for (size_t i = 0; i < b.size(); ++i, ++w.n) {
        const Triple wi = triple(b[i]);
        const double weight = b[i][3] * std::abs(wi[2]);
        if (wi[2] > 0)
            w.reflected = weight, w.pdf_reflected = b[i][6], w.mirror = wi, ++w.n_reflected;
        else
            w.refracted = weight, w.pdf_refracted = b[i][6], w.through = wi;
    }
    return w;
}

void directions_of_glass(Judge& j) {
    bool mirror = true, through = true;
    Triple seen{}, wanted{};
    // At 60 degrees: the sine divided by 1.5, and times 1.5 from within at a cosine of 0.8.
    for (const auto& [outside, cosine, sine] :
         {std::tuple{true, 0.5, 1 / std::sqrt(3)}, std::tuple{false, 0.8, 0.9}}) {
        const Ways w = ways(j, 1.5, outside, cosine);
        const double s = std::sqrt(1 - cosine * cosine);
        mirror &= near(w.mirror, {-0.6 * s, -0.8 * s, cosine}, tolerance(j, 64));
        wanted = {-0.6 * sine, -0.8 * sine, -std::sqrt(1 - sine * sine)}, seen = w.through;
        through = near(seen, wanted, tolerance(j, 64));
        if (!through) break;
    }
    j.exact("some is mirrored", mirror, "not in the mirror direction, or nothing is");
    j.exact("the sine of what is refracted is that of Snell's law, to the other side", through,
            oracle::say("(%.4f, %.4f, %.4f) expected, (%.4f, %.4f, %.4f) came", wanted[0],
                        wanted[1], wanted[2], seen[0], seen[1], seen[2]));
}

// Reflectances of index 1.5, in numbers.
void reflectance_of_glass(Judge& j) {
    struct Known {
        bool outside;
        double cosine, reflectance;
    } at{};
    double worst = 0;
    for (const Known& k :
         std::initializer_list<Known>{{true, 1, 0.04},
                                      {true, 0.5, 0.0891867128022121},
                                      {true, 1 / std::sqrt(3.25), 0.0739644970414201},
                                      {false, 0.8, 0.1141411002213539},
                                      {true, 0.001, 0.9942055725085013}}) {
        const double off = std::abs(ways(j, 1.5, k.outside, k.cosine).reflected - k.reflectance);
        if (!(off <= worst)) worst = off, at = k;
    }
    j.exact("it reflects as much as Fresnel's law says", worst <= tolerance(j),
            oracle::say("off by %.6g where %.6g is reflected, at a cosine of %.4g %s", worst,
                        at.reflectance, at.cosine, at.outside ? "from outside" : "from inside"));
}

// The same laws for other indices, angles and both sides.
void of_any_glass(Judge& j) {
    std::string seen;
    for (int i = 0; i < 40 && seen.empty(); ++i) {
        const double n = between(j.random, 1.1, 2.5), cos = between(j.random, 0.05, 0.999);
        const bool outside = i % 2;
        const double eta = outside ? 1 / n : n, cos2_t = 1 - eta * eta * (1 - cos * cos);
        if (std::abs(cos2_t) < 0.05) continue;
        const double cos_t = std::sqrt(std::max(0.0, cos2_t));
        const double parallel = (cos - eta * cos_t) / (cos + eta * cos_t);
        const double perpendicular = (eta * cos - cos_t) / (eta * cos + cos_t);
        const double R = (parallel * parallel + perpendicular * perpendicular) / 2;
        const double T = (1 - R) * eta * eta;
        const Ways w = ways(j, n, outside, cos);
        const double error = 10 * tolerance(j);
        if (w.n_reflected > 0 && !(near(w.reflected, R, error) && near(w.pdf_reflected, R, error)))
            seen = oracle::say("R = %.6g expected, f cos = %.6g and pdf = %.6g came", R,
                               w.reflected, w.pdf_reflected);
        if (w.n_reflected < w.n &&
            !(near(w.refracted, T, error) && near(w.pdf_refracted, 1 - R, error) &&
              near(w.through[2], -cos_t, error)))
            seen = oracle::say(
                "f cos = %.6g, pdf = %.6g and a cosine of %.6g expected, %.6g, "
                "%.6g and %.6g came",
                T, 1 - R, cos_t, w.refracted, w.pdf_refracted, -w.through[2]);
        if (!seen.empty())
            seen = oracle::say("index %.4g, a cosine of %.4g %s: ", n, cos,
                               outside ? "from outside" : "from inside") +
                   seen;
    }
    j.exact("all this of glass of any index", seen.empty(), seen);
}

void glass(Judge& j) {
    j.probe("sample_glass", {at_glass(1.5, true, 0.01, 0.5), at_glass(1.5, true, 0.9, 0.5),
                             at_glass(1.5, false, 0.9, 0.8), at_glass(1.5, false, 0.7, 0.5),
                             at_glass(2, true, 0.9, 0.5)});
    directions_of_glass(j);
    reflectance_of_glass(j);
    const Ways total = ways(j, 1.5, false, 0.5);
    j.exact("beyond the critical angle it reflects all, always",
            total.n_reflected == total.n && near(total.reflected, 1, tolerance(j, 64)) &&
                near(total.pdf_reflected, 1, tolerance(j, 64)),
            oracle::say("%d of %d times, a share of %.6g", total.n_reflected, total.n,
                        total.reflected));
    const Ways in = ways(j, 1.5, true, 1), out = ways(j, 1.5, false, 1);
    j.exact("radiance that is refracted: (1 - R) over or times the index squared",
            near(in.refracted, 0.96 / 2.25, tolerance(j, 64)) &&
                near(out.refracted, 0.96 * 2.25, tolerance(j, 1e3)),
            oracle::say("straight on, %.6g expected, %.6g came; and %.6g expected, %.6g came",
                        0.96 / 2.25, in.refracted, 0.96 * 2.25, out.refracted));
    const Ways slanted = ways(j, 1.5, true, 0.3);
    const double R = 0.20775634307089783;  // of Fresnel's law
    j.number("at a cosine of 0.3, what is refracted is (1 - R) over the index squared",
             slanted.refracted, (1 - R) / 2.25, tolerance(j, 1e3));
    j.number("and R is the probability to be reflected", slanted.pdf_reflected, R,
             tolerance(j, 1e3));
    j.number("probabilities of both ways add up to", slanted.pdf_reflected + slanted.pdf_refracted,
             1, tolerance(j, 64));
    of_any_glass(j);
    Rows ask;
    for (int i = 0; i < 100000; ++i) ask.add(at_glass(1.5, true, j.random(), 0.3));
    const Rows b = j.ask("sample_glass", ask);
    j.mean("of light at a cosine of 0.3, R is reflected", R, b, [](In x) { return x[2] > 0; });
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"3.1", sum_over_a_path},
                          {"3.2", throughput},
                          {"3.3", light_by_aiming},
                          {"3.4", both_weighted},
                          {"3.5", roulette},
                          {"3.6", glass}});
}
