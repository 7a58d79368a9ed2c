// whole/extremes_scene_test.cpp  a scene at any place, size and brightness
#include "oracle/oracle.h"
#include "path/paths.h"
#include "text/scene_file.h"
#include "whole/extremes.h"

namespace {

// Lights of every kind and every material; lengths are multiplied by k, then translated.
std::string room(double k, vec3 move = {}, double brightness = 1, bool point_light = true) {
    auto number = [](double x) { return oracle::say("%.17g ", x); };
    auto length = [&](double x) { return number(k * x); };
    auto edge = [&](double x, double y, double z) { return length(x) + length(y) + length(z); };
    auto point = [&](double x, double y, double z) {
        return number(k * x + double(move.x)) + number(k * y + double(move.y)) +
               number(k * z + double(move.z));
    };
    auto light = [&](double x) {
        return number(x * brightness) + number(x / 2 * brightness) + number(x / 4 * brightness);
    };
    std::string s = "size 32 16\ndepth 4\n";
    s += "camera " + point(0, 1.5, 6) + point(0, 0.8, 0) + "50\n";
    s += "diffuse white 0.7 0.6 0.5\nphong gloss 0.2 0.3 0.3 0.5 0.4 0.5 40\n";
    s += "mirror mirror 0.8 0.9 0.9\nglass glass 1.5\n";
    s += "light ball " + light(6) + "\nlight panel " + light(2) + "white\n";
    if (point_light) s += "pointlight " + point(1, 3, 2) + light(3 * k * k) + "\n";
    s += "quad " + point(-5, 0, -5) + edge(0, 0, 10) + edge(10, 0, 0) + "white\n";
    s += "quad " + point(-5, 0, -3) + edge(10, 0, 0) + edge(0, 5, 0) + "gloss\n";
    s += "quad " + point(-1, 3.5, -1) + edge(2, 0, 0) + edge(0, 0, 2) + "panel\n";
    s += "triangle " + point(-2, 0, 1) + point(-1, 0, 1) + point(-1.5, 1, 0.5) + "gloss\n";
    s += "sphere " + point(-1.6, 1.6, 0) + length(0.4) + "ball\n";
    s += "sphere " + point(-0.6, 0.6, 0.5) + length(0.6) + "mirror\n";
    s += "sphere " + point(1.2, 0.7, 0.2) + length(0.7) + "glass\n";
    return s;
}

// The radiance of every sample of every pixel.
std::vector<rgb> samples_of(const std::string& text, int spp) {
    const Scene scene = parse_scene(text, "extreme").scene;
    const SamplerSettings settings{SamplerKind::independent, oracle::seed_of("room")};
    std::vector<rgb> samples;
    for (int y = 0; y < scene.size.height; ++y)
        for (int x = 0; x < scene.size.width; ++x)
            for (int i = 0; i < spp; ++i)
                samples.push_back(radiance(scene, {Direction::bsdf, LightMode::mis, 0}, settings, x,
                                           y, uint64_t(i)));
    return samples;
}

constexpr int room_spp = 8;
std::vector<rgb> room_samples(double k, vec3 move = {}, double brightness = 1) {
    return samples_of(room(k, move, brightness), room_spp);
}

const std::vector<rgb>& plain_room() {
    static const std::vector<rgb> samples = room_samples(1);
    return samples;
}

// Counts samples that differ from factor times the others, bit for bit.
double different(const std::vector<rgb>& a, real factor, const std::vector<rgb>& b) {
    int n = 0;
    for (size_t i = 0; i < a.size(); ++i) n += !(a[i] * factor == b[i]);
    return n;
}

double mean_of_all(const std::vector<rgb>& samples) {
    double sum = 0;
    for (rgb L : samples) sum += double(L.x) + double(L.y) + double(L.z);
    return sum / (3 * double(samples.size()));
}

double room_scaled(int by) { return different(plain_room(), 1, room_samples(std::ldexp(1.0, by))); }

// The largest and smallest lengths of a scene file.  The scene has no point light: its intensity
// would overflow.
double room_at_its_limits() {
    const int most = is_double ? 96 : 26;
    auto at = [](int by) { return samples_of(room(std::ldexp(1.0, by), {}, 1, false), room_spp); };
    const auto samples = at(0);
    return different(samples, 1, at(most)) + different(samples, 1, at(-most));
}

double room_brighter(int by) {
    return different(plain_room(), std::ldexp(real(1), by),
                     room_samples(1, {}, std::ldexp(1.0, by)));
}

double room_mean(double k, real move) {
    return relative(mean_of_all(room_samples(k, {move, -move, move})), mean_of_all(plain_room()));
}

// Lights as faint and as bright, as small and as large as they can be: one, two, or so many that
// there are groups of groups.  Counts scenes with a sample that is not finite.
double faint_and_bright(bool balls) {
    const double faintest = double(std::numeric_limits<real>::denorm_min());
    const double least = double(std::numeric_limits<real>::min()), smallest = 2.1 / max_length;
    auto lamp = [=](double y, double d) {
        return balls ? oracle::say("sphere 0 %.17g 0  %.17g  ", y, d / 2)
                     : oracle::say("quad %.17g %.17g %.17g  %.17g 0 0  0 0 %.17g  ", -d / 2, y,
                                   -d / 2, d, d);
    };
    int n = 0;
    for (const double a : {faintest, 1e3 * faintest, least, 1.0, 1e30})
        for (const double b : {faintest, least, 1.0, 1e30})
            for (const double size : {smallest, 1e-6, 1.0, 1e6})
                for (const int others : {0, 1, int(max_members)}) {
                    std::string s = "size 8 4\ndepth 3\ncamera 0 1 6  0 1 0  60\n";
                    s += oracle::say("light a %.17g 0 0\nlight b %.17g %.17g 0\n", a, b, b / 3);
                    s += "diffuse m .5 .5 .5\nquad -5 0 -5  0 0 10  10 0 0  m\n";
                    s += "quad -5 0 -3  10 0 0  0 9 0  m\n" + lamp(3, size) + "a\n";
                    for (int i = 0; i < others; ++i) s += lamp(4 + i * (1 + size), 1) + "b\n";
                    const auto samples = samples_of(s, 2);
                    n += !std::ranges::all_of(samples, [](rgb L) { return is_finite(L); });
                }
    return n;
}

// rho = 1 - 1e-7 and Le = 1 everywhere, 1e4 bounces: L = (1 - rho^(D+1)) / (1 - rho).
double white_furnace() {
    const Scene scene = parse_scene(
                            "camera 0 0 1.8  0 0.1 0  60\ndepth 10000\n"
                            "diffuse white 0.9999999 0.9999999 0.9999999\n"
                            "light glow 1 1 1 twosided white\n"
                            "box 4 3 4  0  -2 -1.5 -2  glow\n",
                            "furnace")
                            .scene;
    const Technique chance{Direction::bsdf, LightMode::none, 0};
    const SamplerSettings settings{SamplerKind::independent, oracle::seed_of("white furnace")};
    const big truth = -std::expm1(10001 * std::log1p(-1e-7L)) / 1e-7L;
    Worst worst;
    for (uint64_t i = 0; i < 10; ++i)
        worst.see(relative(radiance(scene, chance, settings, 3, 2, i).x, truth));
    return worst.value;
}

}  // namespace

TEST_CASE("extremes of scenes: no more error than they may have") {
    check_rows({
        // A few of 4096 paths may diverge where float rounds differently.
        {"scene scaled by 2^20: samples not the same, bit for bit", to_the_bit,
         of(room_scaled, 20)},
        {"scene scaled by 2^-20: samples not the same", to_the_bit, of(room_scaled, -20)},
        {"scene as large and as small as its file may say: samples not the same", to_the_bit,
         room_at_its_limits},
        {"scene scaled by 10^6: mean", within(1e-6, 1e-3), of(room_mean, 1e6, 0)},
        {"scene scaled by 10^-6: mean", within(1e-6, 1e-3), of(room_mean, 1e-6, 0)},
        {"scene moved by 10^3: mean", within(1e-6, 0.02), of(room_mean, 1, 1000)},
        {"scene moved by 10^6: mean", within(1e-6, any), of(room_mean, 1, 1e6)},
        {"radiance x 2^96 (10^29): samples not 2^96 x the same", to_the_bit, of(room_brighter, 96)},
        {"radiance x 2^-96: samples not 2^-96 x the same", to_the_bit, of(room_brighter, -96)},
        {"sphere lights, faint or bright, small or large: scenes with samples not finite",
         to_the_bit, of(faint_and_bright, true)},
        {"quad lights, faint or bright, small or large: scenes with samples not finite", to_the_bit,
         of(faint_and_bright, false)},
        {"albedo 1 - 10^-7, 10^4 scatterings: radiance", within(1e-11, 1e-3), white_furnace},
    });
}
