// course/judge_R.cpp  judges the radiosity project: shooting, and a particle's walk
#include "course/judge.h"

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
        for (double came : {s.least[c], s.greatest[c]})
            most = came == came ? std::max(most, std::abs(came / E - 1)) : oracle::infinity;
    }
    return most;
}

void shooting(Judge& j) {
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
        rise = now == now ? std::max(rise, now - before) : oracle::infinity;
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
    sideways = 21
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
    j.probe("walk", fixed);
    const Rows black = walks(j, {0, 0, 0}, 64);
    bool once = true;
    for (size_t i = 0; i < black.size(); ++i)
        once = once && black[i][stops] == 1 && black[i][rays] == 1 &&
               black[i][sum] == black[i][emitted] && black[i][absorbed] == black[i][emitted];
    j.exact("black walls: one stop with all of the power, which is absorbed", once);
    const Out albedo = {0.8, 0.5, 0.2};
    constexpr size_t n = 30000;
    const Rows coloured = walks(j, albedo, n);
    double lost = 0, growth = 0;
    for (size_t i = 0; i < n; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double e = coloured[i][emitted + c];
            const double left = e - coloured[i][absorbed + c] - coloured[i][escaped + c];
            lost = left == left ? std::max(lost, std::abs(left / e)) : oracle::infinity;
            growth = worse(growth, coloured[i][greatest + c] / e);
        }
    j.below("of every particle, emitted = absorbed + escaped", lost, 1e4 * j.epsilon, off);
    j.below("no particle gains power on walls that reflect 4/5 at most", growth,
            1 + 1e4 * j.epsilon, "one has %.4g times its own");
    const char* names[] = {"red, albedo .8: all stops bring 5 times what is emitted",
                           "green, albedo .5: twice", "blue, albedo .2: 1.25 times"};
    for (size_t c = 0; c < 3; ++c)
        j.mean(names[c], 1 / (1 - albedo[c]), coloured,
               [c](In w) { return w[sum + c] / w[emitted + c]; });
    j.mean("the second stop of blue light brings a fifth of the first", 0.2, coloured,
           [](In w) { return w[second + 2] / w[emitted + 2]; });
    Rows went;
    for (size_t i = 0; i < n; ++i)
        if (coloured[i][stops] > 1) went.add(Out(coloured[i].begin(), coloured[i].end()));
    const std::string leave = "those that go on leave by Lambert's law: the mean cosine is 2/3";
    if (went.size() < 1000)
        j.statistical(leave, oracle::failure("hardly any goes on"));
    else
        j.mean(leave, 2 / 3.0, went, [](In w) { return w[cosine]; });
    const Rows white = walks(j, {1, 1, 1}, 200);
    double all = 0;
    for (size_t i = 0; i < white.size(); ++i) all += white[i][stops] / 200;
    j.exact("walks between white walls end, too", all > 2 && all < 1000,
            oracle::say("they have %.3g stops", all));
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv, {{"R.1", shooting}, {"R.2", walking}});
}
