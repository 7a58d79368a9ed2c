// course/judge_R.cpp  judges the radiosity project: shooting, and a particle's walk
#include "course/judge.h"

using namespace penumbra;
using namespace course;

namespace {

// ---- R.1 ----------------------------------------------------------------------------------------

// See answers_R.cpp: a box of 2 x 3 x 1; all walls emit, or the ceiling alone.
struct Room {
    double rho[3] = {0.5, 0.2, 0}, L[3] = {1, 2, 3};
    bool lamp = false, faces = false;
    double side = 2.2;
    double shots = 1200;
};
Out numbers_of(const Room& r) {
    return row(Out(r.rho, r.rho + 3), Out(r.L, r.L + 3), r.lamp, r.faces, r.side, r.shots);
}
struct Shot {
    double elements, shots, unshot;
    double least[3], greatest[3], part[3];  // E; its integral over the emitted power
};
Shot shot_of(In x) {
    return {x[0], x[1], x[2], {x[3], x[6], x[9]}, {x[4], x[7], x[10]}, {x[5], x[8], x[11]}};
}
Shot shoot(Judge& j, const Room& r) { return shot_of(j.ask("shoot", numbers_of(r))); }

const char* off = "it is off by %.3g of itself";

// The farthest E of any wall in any channel from pi L / (1 - rho), as a part of it.
double furnace_off(const Shot& s, const Room& r) {
    double most = 0;
    for (size_t c = 0; c < 3; ++c) {
        const double E = oracle::pi * r.L[c] / (1 - r.rho[c]);
        for (double came : {s.least[c], s.greatest[c]}) most = worse(most, std::abs(came / E - 1));
    }
    return most;
}

// See answers_R.cpp: load, with the corners of M, of what was shot before and so on of an element.
constexpr size_t head = 12, per_element = 38;
struct Element {
    In x;
    double area() const { return x[0]; }
    Triple M(size_t k) const { return triple(x, 1 + 3 * k); }
    Triple before(size_t k) const { return triple(x, 10 + 3 * k); }
    Triple L(size_t k) const { return triple(x, 19 + 3 * k); }
    Triple shot(size_t k) const { return triple(x, 28 + 3 * k); }
    double sent() const { return x[37]; }
};
template <class Of>
Triple mean_of_corners(Of of) {
    return 1 / 3.0 * (of(0) + of(1) + of(2));
}

void loading(Judge& j) {
    const double digits = 1e3 * j.epsilon;
    double sent = 0, shot = 0, noted = 0, mean = 0, whole = 0, quarters = 0, filled = 0;
    for (const bool back : {false, true})
        for (const bool leaf : {true, false})
            for (const bool triangle : {false, true}) {
                const Out out = j.ask("load", Out{double(triangle), double(back), double(leaf), 7});
                Triple sum{};
                double area = 0;
                for (size_t at = head; at + per_element <= out.size(); at += per_element) {
                    const Element e{In(out).subspan(at, per_element)};
                    if (leaf && at > head) break;
                    for (size_t k = 0; k < 3; ++k) {
                        const Triple L = 1 / oracle::pi * (e.M(k) - e.before(k));
                        sent = worse(sent, length(e.L(k) - L));
                        shot = worse(shot, length(e.shot(k) - e.M(k)));
                    }
                    const Triple M = mean_of_corners([&](size_t k) { return e.M(k); }),
                                 L = mean_of_corners([&](size_t k) { return e.L(k); });
                    noted = worse(noted, std::abs(e.sent() - (M[0] + M[1] + M[2]) / 3));
                    sum = sum + e.area() * L, area += e.area();
                }
                double& of = leaf ? mean : triangle ? quarters : whole;
                of = worse(of, length(triple(out) - 1 / area * sum));
                for (size_t k = 0; !leaf && k < 3; ++k)
                    filled = worse(filled, length(triple(out, 3 + 3 * k) - triple(out)));
                // By an element, and by the face that is uneven, mistakes are told.
                if (triangle && !leaf) j.remember({out[0], out[1]});
                if (!triangle)
                    j.remember({out[0], out[1], out[3], out[6], out[head + 19], out[head + 22],
                                out[head + 28], out[head + 37]});
            }
    const char* by = "it is off by %.3g";
    j.below("an element sends (M - shot) / pi at each corner, its front and its back", sent, digits,
            by);
    j.below("when an element has shot, all of M counts as shot, corner by corner", shot, digits,
            by);
    j.below("the mean of M over corners and channels is noted in sent_", noted, digits, by);
    j.below("an element returns the mean of its three corners", mean, digits, by);
    j.below("a wall of 2 x 3 cells returns the mean of its parts, weighted by their areas", whole,
            digits, by);
    j.below("a triangle returns the mean of its four parts", quarters, digits, by);
    j.below("a triangle writes the mean of its parts to all three corners", filled, digits, by);
}

void shooting(Judge& j) {
    loading(j);
    const double rest = 1e-6;  // of the light may be unsent, and some 10 times as much of E
    const double digits = std::max(1e-9, 1e5 * j.epsilon);
    Room furnace, black, lamp, whole, first;
    black.rho[0] = black.rho[1] = 0;
    lamp.lamp = true;
    lamp.rho[0] = 0.6, lamp.rho[1] = lamp.rho[2] = 0.3;
    first = whole = lamp;
    first.shots = 2;
    whole.faces = true, whole.shots = 200;
    const Rows of_furnace = j.probe("shoot", Rows(numbers_of(furnace))),
               of_lamp = j.probe("shoot", Rows(numbers_of(lamp))),
               of_whole = j.probe("shoot", Rows(numbers_of(whole)));
    j.below("a room whose walls emit alike: E = pi L / (1 - rho) everywhere",
            furnace_off(shot_of(of_furnace[0]), furnace), 100 * rest + digits, off);
    const Shot dark = shoot(j, black);
    j.exact("black walls that emit shoot once each, then nothing is left",
            dark.shots == dark.elements && dark.unshot <= 1e-9,
            oracle::say("%g shots of %g elements, %.3g unshot", dark.shots, dark.elements,
                        dark.unshot));
    const Shot lit = shot_of(of_lamp[0]), by_faces = shot_of(of_whole[0]);
    double apart = 0;
    for (size_t c = 0; c < 3; ++c)
        apart = worse(apart, std::abs(by_faces.part[c] / lit.part[c] - 1));
    // Between black walls the lamp's elements are all that shoots.
    Room alone = lamp;
    alone.rho[0] = alone.rho[1] = alone.rho[2] = 0;
    first.shots = shoot(j, alone).shots;
    const Shot direct = shoot(j, first);
    double reflected = 0, emitted = 0;
    for (size_t c = 0; c < 3; ++c) {
        emitted += lamp.L[c];
        reflected += lamp.rho[c] * lamp.L[c] * direct.part[c];
    }
    j.number("when the lamp has shot, what walls reflect of it is unsent", direct.unshot,
             reflected / emitted, digits);
    j.below("whole faces come to what elements come to", apart, 0.03, off);
    double before = 1, rise = 0;
    for (double k : {1, 2, 3, 5, 8, 13, 21, 34, 55}) {
        first.shots = k;
        const double now = shoot(j, first).unshot;
        rise = worse(rise, now - before);
        before = now;
    }
    j.exact(
        "every shot leaves less to be sent, and in the end nothing",
        rise < 0 + 1e-9 && lit.unshot >= 0 && lit.unshot <= rest && lit.shots < lamp.shots,
        oracle::say("it rises by %.3g; %.3g unshot after %g shots", rise, lit.unshot, lit.shots));
}

// ---- R.2 ----------------------------------------------------------------------------------------

// What answers_R.cpp says of a walk.
enum At {
    rays = 0,
    emitted = 1,
    absorbed = 4,
    escaped = 7,
    stops = 10,
    sum = 11,
    second = 14,
    greatest = 17,
    cosine = 20,
    then = 22,  // at the second stop
    along = 23
};

Rows walks(Judge& j, const Out& albedo, size_t n) {
    Rows in;
    const double seed = std::floor(1e9 * j.random());
    for (size_t i = 0; i < n; ++i) in.add({albedo[0], albedo[1], albedo[2], double(i), seed});
    return j.ask("walk", in);
}

void walking(Judge& j) {
    Rows fixed;
    for (int i = 0; i < 4; ++i) fixed.add({0.8, 0.5, 0.2, double(i), 7});
    for (int i = 0; i < 4; ++i) fixed.add({0.2, 0.8, 0.5, double(i), 7});
    // But for directions, which depend on how 2.2 uses its numbers.
    const Rows known = j.ask("walk", fixed);
    for (size_t i = 0; i < known.size(); ++i)
        j.remember(Out(known[i].begin(), known[i].begin() + cosine));
    const Rows black = walks(j, {0, 0, 0}, 64);
    double least_stops = 1, most_stops = 1, other_rays = 1, brought = 1, kept = 1;
    for (size_t i = 0; i < black.size(); ++i) {
        const In w = black[i];
        least_stops = std::min(least_stops, w[stops]), most_stops = std::max(most_stops, w[stops]);
        if (w[rays] != 1) other_rays = w[rays];
        if (w[sum] != w[emitted]) brought = w[sum] / w[emitted];
        if (w[absorbed] != w[emitted]) kept = w[absorbed] / w[emitted];
    }
    j.exact("black walls: a walk has one stop", least_stops == 1 && most_stops == 1,
            oracle::say("one has %g", least_stops < 1 ? least_stops : most_stops));
    j.number("black walls: a walk returns one ray", other_rays, 1, 0);
    j.number("hit is told of all of the power that arrives", brought, 1, 0);
    j.number("black walls absorb all of the power that arrives", kept, 1, 0);
    const Out albedo = {0.8, 0.5, 0.2};
    constexpr size_t n = 30000;
    const Rows coloured = walks(j, albedo, n);
    double lost = 0;
    size_t away = 0;
    for (size_t i = 0; i < n; ++i) {
        away += coloured[i][escaped] > 0;
        for (size_t c = 0; c < 3; ++c) {
            const double e = coloured[i][emitted + c];
            const double left = e - coloured[i][absorbed + c] - coloured[i][escaped + c];
            lost = worse(lost, std::abs(left / e));
        }
    }
    j.none("nothing escapes from a closed room", away, "%zu of 30000 particles do");
    j.below("of every particle, emitted = absorbed + escaped", lost, 1e4 * j.epsilon, off);
    // The greatest power of any particle, in parts of what was emitted.
    const auto most_of = [](const Rows& some) {
        double most = 0;
        for (size_t i = 0; i < some.size(); ++i)
            for (size_t c = 0; c < 3; ++c)
                most = worse(most, some[i][greatest + c] / some[i][emitted + c]);
        return most;
    };
    const auto gained = [&](const Out& of) { return most_of(walks(j, of, 200)); };
    const double own = 1 + 1e4 * j.epsilon;
    const char* gain = "one has %.4g times its own";
    j.below("no particle gains power on walls that reflect 4/5 at most", most_of(coloured), own,
            gain);
    const double on_blue = gained({0.5, 0.2, 0.8}), on_green = gained({0.2, 0.8, 0.5});
    j.below(
        "no particle gains power on green walls, nor on blue ones: the greatest channel decides",
        worse(on_blue, on_green), own, gain);
    j.below("no particle gains power on walls that reflect 99 %: 0.98 is for white ones alone",
            gained({0.99, 0.99, 0.99}), own, gain);
    const char* names[] = {"red, albedo .8: all stops bring 5 times what is emitted",
                           "green, albedo .5: all stops bring twice what is emitted",
                           "blue, albedo .2: all stops bring 1.25 times what is emitted"};
    for (size_t c = 0; c < 3; ++c)
        j.mean(names[c], 1 / (1 - albedo[c]), coloured,
               [c](In w) { return w[sum + c] / w[emitted + c]; });
    j.mean("the second stop of blue light brings a fifth of the first", 0.2, coloured,
           [](In w) { return w[second + 2] / w[emitted + 2]; });
    // Rows of walks with so many stops.
    const auto with_stops = [&](double least) {
        Rows some;
        for (size_t i = 0; i < n; ++i)
            if (coloured[i][stops] >= least) some.add(Out(coloured[i].begin(), coloured[i].end()));
        return some;
    };
    const Rows went = with_stops(2), far = with_stops(3);
    const auto mean_if_many = [&](const std::string& what, double truth, const Rows& rows,
                                  auto of) {
        if (rows.size() < 1000)
            j.statistical(what, oracle::detail::failure("hardly any goes on"));
        else
            j.mean(what, truth, rows, of);
    };
    mean_if_many("those that go on leave by Lambert's law: the mean cosine is 2/3", 2 / 3.0, went,
                 [](In w) { return w[cosine]; });
    mean_if_many("the new direction does not depend on the old one", 0, far,
                 [](In w) { return w[along]; });
    mean_if_many("two stops have directions that do not depend on each other", 0, far,
                 [](In w) { return (w[cosine] - 2 / 3.0) * (w[then] - 2 / 3.0); });
    // Means in tenths, whatever the numbers.
    double turn = 0, straight = 0;
    for (size_t i = 0; i < went.size(); ++i) turn += went[i][cosine] / double(went.size());
    for (size_t i = 0; i < far.size(); ++i) straight += far[i][along] / double(far.size());
    j.remember({std::round(10 * turn), std::round(10 * straight)});
    const Rows white = walks(j, {1, 1, 1}, 200);
    double all = 0;
    for (size_t i = 0; i < white.size(); ++i) all += white[i][stops] / 200;
    j.exact("walks between white walls end, too", all > 2 && all < 1000,
            oracle::say("they have %.3g stops", all));
    Worst carried, balance;
    for (size_t i = 0; i < white.size(); ++i)
        for (size_t c = 0; c < 3; ++c) {
            const In w = white[i];
            const double e = w[emitted + c], has = w[second + c] / e,
                         stays = (w[absorbed + c] + w[escaped + c]) / e;
            if (w[stops] >= 2)
                carried.see(std::abs(has - 1 / 0.98), oracle::say("%.6g times as much", has));
            balance.see(std::abs(stays - 1), oracle::say("%.6g of it is", stays));
        }
    j.worst(
        "what leaves a white wall has 1 / 0.98 of the power that came, for the one in 50 that ends",
        carried, 1e4 * j.epsilon);
    j.worst("what is emitted between white walls is absorbed or escapes, gains set against losses",
            balance, 1e6 * j.epsilon);
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv, {{"R.1", shooting}, {"R.2", walking}});
}
