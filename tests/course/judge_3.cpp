// course/judge_3.cpp  judges week 3: the path
#include "course/judge_3_light.h"
#include "course/judge_3_scenes.h"

using namespace penumbra;
using namespace course;

namespace {

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
// Other code counts rays by it: each vertex once, with the path that arrived there.
void visits_of_all(Judge& j) {
    const Stuff mirror{Stuff::mirror, {}, {0.5, 0.5, 0.5}};
    build(j, 7, {ball({0, 0, 0}, 2, mirror)});
    const Out within = question({}, 1, ray({0.3, 0.1, -0.2}, {0.48, 0.6, 0.64}));
    const Out eight = j.probe("visits", Rows(within)).numbers;
    build(j, 7, {ball({0, 0, 0}, 1, mirror)});
    const Out away = question({}, 1, ray({0, 0, 4}, {0, 0, -1}));
    const Out two = j.probe("visits", Rows(away)).numbers;
    j.number("the path is followed to its end: visit is called at each of 8 vertices", eight[0], 8,
             0);
    j.number(
        "visit is called for a ray that meets nothing, too: at a mirror, and for the ray that it "
        "sends away",
        two[0], 2, 0);
    j.number("visit is called with the path that arrived at the vertex: how often of 8",
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
    const Step first = take_step(j, t, 1, path_state({0, 0, 4.5}, {0, 0, -1}));
    colour(j, "light found by aiming counts in full where the eye looks", triple(L[0]),
           first.direct);
    const Step mirrored = take_step(j, t, 1, path_state({0, 0.02, 4}, {0, 0, 1}));
    const Step seen = take_step(j, t, 1, mirrored.next);
    colour(j, "light found by aiming counts half in a mirror that takes half", triple(L[1]),
           0.5 * seen.direct);
}

// A lamp on which another one shines.
void a_lamp_is_lit(Judge& j) {
    const Stuff lamp = glowing({3, 2, 1}, {Stuff::rough, {0.2, 0.5, 0.8}});
    build(j, 2, {ball({0, 0, 0}, 1, lamp), point_light({4, 1, 3}, {300, 200, 100})});
    const Technique t{by_aiming, uniform};
    const Rows L = j.probe("Li", Rows(question(t, 1, ray({0, 0, 4.5}, {0, 0, -1}))));
    const Step s = take_step(j, t, 1, path_state({0, 0, 4.5}, {0, 0, -1}));
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
        const Step floor = take_step(j, t, seed, path_state(eye, d));
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
    all_near(j, "light found by chance counts by its weight, beside that by aiming", came, both);
}

void sum_over_a_path(Judge& j) {
    visits_of_all(j);
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
    return path_state(o, unit(to), before, k);
}

void of_a_mirror(Judge& j) {
    const Triple ks{0.3, 0.6, 0.9}, before{0.5, 0.25, 2};
    build(j, 8, {ball({0, 0, 0}, 1, {Stuff::mirror, {}, ks})});
    const Rows b = j.probe("throughput", {question({}, 1, towards_a_ball(2)),
                                          question({}, 1, towards_a_ball(2, before, 3))});
    const Step s = take_step(j, {}, 1, towards_a_ball(2));
    const std::vector<oracle::Factor> factors{{"the cosine", std::abs(s.wi[2])}};
    colour(j, "a mirror of reflectance (0.3, 0.6, 0.9)", triple(b[0]), ks, factors);
    colour(
        j,
        "a mirror of reflectance (0.3, 0.6, 0.9) at the end of a path of throughput (0.5, 0.25, 2)",
        triple(b[1]), ks * before, factors);
}

// Whatever the direction and its density are: f |cos| / pdf of them, times what was before.
struct Scatterings {
    std::vector<Step> steps;
    Out came, expected;
    Worst factor;
    void look(Judge& j, const Technique& t, uint64_t seed, const Out& from, const Triple& before) {
        const Step s = take_step(j, t, seed, from);
        if (!s.goes_on || !(s.pdf > 0)) return;
        steps.push_back(s);
        const Triple truth = s.factor() * before;
        came.push_back(s.beta[0]), expected.push_back(truth[0]);
        factor.see(
            length(s.beta - truth) / std::max(1e-9, length(truth)),
            oracle::say("by f = %.4g, a cosine of %.4g and pdf = %.4g, %.6g expected, %.6g came",
                        s.f[0], s.wi[2], s.pdf, truth[0], s.beta[0]));
    }
    void judge(Judge& j, const std::string& what) const {
        j.exact(what, !came.empty() && factor.off <= tolerance(j), factor.seen);
    }
};

void of_a_rough_ball(Judge& j) {
    const Triple kd{0.2, 0.5, 0.8};
    build(j, 8, {ball({0, 0, 0}, 1, {Stuff::rough, kd})});
    const Out from = towards_a_ball(2);
    // Directions are those of other exercises; a formula is told whatever they are.
    Out came;
    std::array<Out, 8> formulas;
    for (Directions d : {by_bsdf, uniform}) {
        Scatterings s;
        for (uint64_t seed = 1; seed <= 200; ++seed)
            s.look(j, {by_chance, d}, seed, from, {1, 1, 1});
        s.judge(j, d == uniform ? "f |cos| / pdf of a rough ball, if directions are uniform"
                                : "f |cos| / pdf of a rough ball, if they follow the cosine");
        for (const Step& e : s.steps) {
            const double f = e.f[0], cos = std::abs(e.wi[2]);
            const double values[] = {f * cos / e.pdf,
                                     f * cos * e.pdf,
                                     cos / e.pdf,
                                     f * -dot(triple(from, 3), e.normal) / e.pdf,
                                     f * std::abs(e.along[2]) / e.pdf,
                                     f * cos * cos / e.pdf,
                                     f / e.pdf,
                                     f * cos};
            came.push_back(e.beta[0]);
            for (size_t k = 0; k < formulas.size(); ++k) formulas[k].push_back(values[k]);
        }
    }
    if (!came.empty())
        for (const Out& formula : formulas) j.remember_factor(came, formula);
}

// Balls of one stuff after the other in any pose, met from outside or inside.
void of_any_ball(Judge& j, bool outside) {
    const char* names[] = {"a rough", "a glossy", "a mirroring", "a glass"};
    for (int kind = 0; kind < 4; ++kind) {
        Scatterings s;
        for (int i = 0; i < 16; ++i) {
            const Pose pose = any_pose(j.random, std::ldexp(1, i % 3 * 10 - 10));
            const Stuff stuffs[] = {{Stuff::rough, any_colour(j)},
                                    {Stuff::rough, any_colour(j), any_colour(j), 8},
                                    {Stuff::mirror, {}, any_colour(j)},
                                    {Stuff::glass, {}, {}, 0, 1.5}};
            build(j, 20, {ball(pose.at({}), pose.scale, stuffs[kind])});
            const Triple n = any_direction(j.random), before = any_colour(j);
            const Triple o = outside ? 2 * n + 0.5 * in_cube(j.random) : 0.5 * in_cube(j.random);
            const Triple to = 0.5 * any_direction(j.random);
            const int k = int(10 * j.random());
            s.look(j, {by_chance, i % 2 ? uniform : by_bsdf}, any_seed(j),
                   path_state(pose.at(o), pose.turned(unit(to - o)), before, k), before);
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

// ---- 3.5 Russian roulette -----------------------------------------------------------------------

// Paths from a seed on, their throughput where roulette has a threshold, and the numbers it draws.
Rows asked_of_roulette(double threshold, size_t n, uint64_t first, const Out& from) {
    return rows_of(n, [&](size_t i) {
        return question({by_chance, by_bsdf, threshold}, first + i, from);
    });
}
struct Fates {
    Rows beta;
    Out number;
    Fates(Judge& j, double threshold, size_t n, const Out& from) {
        const uint64_t first = any_seed(j);
        beta = j.ask("throughput", asked_of_roulette(threshold, n, first, from));
        number = j.ask("number", rows_of(n,
                                         [&](size_t i) {
                                             return Out{double(first + i), 2, 6};
                                         }))
                     .numbers;
    }
    bool lives(size_t i) const { return beta[i][2] > 0; }
};

// Whoever is dim dies often: the number that roulette draws says when.
void fate_of_the_dim(Judge& j, double threshold, const Triple& before, double chance) {
    const Fates f(j, threshold, 20000, towards_a_ball(2, before, 2));
    size_t low = 0, high = 0, alive = 0;  // those of other fates, if low or high numbers save
    for (size_t i = 0; i < f.beta.size(); ++i) {
        alive += f.lives(i);
        low += f.lives(i) != (f.number[i] < chance),
            high += f.lives(i) != (f.number[i] >= 1 - chance);
    }
    j.exact("of the dim as few survive as the law says", std::min(low, high) == 0,
            oracle::say("of 20000 paths with a chance of %.3g about %.0f should, and %zu do",
                        chance, 20000 * chance, alive));
}

// A mirror, which takes part of the path's throughput and no random number.
void roulette(Judge& j) {
    const double T = 2;
    const Triple before{0.4, 1.2, 1.6};
    build(j, 8, {ball({0, 0, 0}, 1, {Stuff::mirror, {}, {0.5, 0.5, 0.5}})});
    const Out from = towards_a_ball(2, before, 2);
    const auto asked = [&](double threshold, size_t n) {
        return asked_of_roulette(threshold, n, 1, from);
    };
    j.probe("throughput", asked(0.7 * T, 6));
    const Rows many = j.ask("throughput", asked(T, 64));
    double survivors = 0;
    for (size_t i = 0; i < many.size(); ++i) survivors += many[i][2] > 0;
    j.remember({survivors});
    const Out ended = j.ask("ended_by_roulette", asked(T, 64)).numbers;
    const double told = double(std::count(ended.begin(), ended.end(), 1));
    j.probe("throughput", asked(0.05, 1));
    const Triple without = triple(j.ask("throughput", question({}, 1, from)));
    const Triple whole = without[2] > 0 ? without : 0.5 * before;
    j.exact("where the threshold is 0 nobody dies", without[2] > 0, "a path was ended");
    const double chance = whole[2] / T;

    j.exact("a path that roulette ends says so: End::roulette", told + survivors == 64,
            oracle::say("of %g that end %g do", 64 - survivors, told));
    const Rows inside =
        j.ask("throughput_in_glass", asked_of_roulette(T / 4, 64, 1, row(from, 4.0)));
    double least = T;
    for (size_t i = 0; i < inside.size(); ++i)
        if (inside[i][2] > 0) least = std::min(least, inside[i][2]);
    j.number("in glass, too, no survivor has less than `threshold`, here 4 `technique.roulette`",
             least, T, tolerance(j));

    const Rows bright = j.ask("throughput", asked(0.9 * whole[2], 64));
    bool untouched = true;
    for (size_t i = 0; i < bright.size(); ++i) untouched &= triple(bright[i]) == whole;
    j.exact("a path whose largest channel is above the threshold goes on as it is", untouched,
            "one of 1.1 times the threshold was ended, or changed");

    const size_t n = 100000;
    const Fates f(j, T, n, from);
    size_t alive = 0;
    double highest_alive = 0, lowest_alive = 1, highest_dead = 0, lowest_dead = 1;
    Triple survivor{};
    for (size_t i = 0; i < n; ++i) {
        alive += f.lives(i);
        if (f.lives(i)) survivor = triple(f.beta[i]);
        double& high = f.lives(i) ? highest_alive : highest_dead;
        double& low = f.lives(i) ? lowest_alive : lowest_dead;
        high = std::max(high, f.number[i]), low = std::min(low, f.number[i]);
    }
    colour(j, "who survives has the threshold in its largest channel, and its colour", survivor,
           (1 / chance) * whole);
    j.exact(
        "the number that roulette draws decides, and nothing else",
        alive > 0 && alive < n && (highest_alive <= lowest_dead || highest_dead <= lowest_alive),
        oracle::say("of %zu paths %zu survive, with numbers of %.3g to %.3g", n, alive,
                    lowest_alive, highest_alive));
    fate_of_the_dim(j, T, 0.01 * before, 0.01 * chance);
    j.mean("share of paths that survive", chance, f.beta,
           [](In b) { return b[2] > 0 ? 1.0 : 0.0; });
    j.mean("mean throughput, the dead counted as 0", whole[0], f.beta, [](In b) { return b[0]; });
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
    const Rows b = j.ask("sample_glass", rows_of(512, [&](size_t i) {
                             return at_glass(ior, outside, (double(i) + 0.5) / 512, cosine);
                         }));
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
    const struct {
        bool outside;
        double cosine, reflectance;
    } known[] = {{true, 1, 0.04},
                 {true, 0.5, 0.0891867128022121},
                 {true, 1 / std::sqrt(3.25), 0.0739644970414201},
                 {false, 0.8, 0.1141411002213539},
                 {true, 0.001, 0.9942055725085013}};
    Worst reflected;
    for (const auto& k : known) {
        const double off = std::abs(ways(j, 1.5, k.outside, k.cosine).reflected - k.reflectance);
        reflected.see(
            off, oracle::say("off by %.6g where %.6g is reflected, at a cosine of %.4g %s", off,
                             k.reflectance, k.cosine, k.outside ? "from outside" : "from inside"));
    }
    j.worst("glass reflects as much as Fresnel's law says", reflected, tolerance(j));
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
    j.exact("glass of any index obeys the laws of Snell and Fresnel", seen.empty(), seen);
}

void glass(Judge& j) {
    j.probe("sample_glass", {at_glass(1.5, true, 0.01, 0.5), at_glass(1.5, true, 0.9, 0.5),
                             at_glass(1.5, false, 0.9, 0.8), at_glass(1.5, false, 0.7, 0.5),
                             at_glass(2, true, 0.9, 0.5)});
    directions_of_glass(j);
    reflectance_of_glass(j);
    const Ways total = ways(j, 1.5, false, 0.5);
    j.exact("beyond the critical angle glass reflects all, always",
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
    j.number("at a cosine of 0.3, R is the probability to be reflected", slanted.pdf_reflected, R,
             tolerance(j, 1e3));
    j.number("probabilities of both ways add up to", slanted.pdf_reflected + slanted.pdf_refracted,
             1, tolerance(j, 64));
    of_any_glass(j);
    const Rows b =
        j.ask("sample_glass",
              rows_of(100000, [&](size_t) { return at_glass(1.5, true, j.random(), 0.3); }));
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
