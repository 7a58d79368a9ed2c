// course/judge_2.cpp  judges week 2: warps and densities
#include "course/judge.h"

using namespace penumbra;
using namespace course;
using oracle::pi;

namespace {

// ---- Directions ---------------------------------------------------------------------------------

// Pairs of the numbers from two lists, with more numbers after each.
Rows pairs(const Out& numbers, const Out& more) {
    Rows u;
    for (double x : numbers)
        for (double y : numbers) u.add(row(x, y, more));
    return u;
}
// Middles of the cells of a grid in the square of random numbers.
Rows grid(const Out& more = {}, int n = 16) {
    Out middles;
    for (int i = 0; i < n; ++i) middles.push_back((i + 0.5) / n);
    return pairs(middles, more);
}
// The square's corners, places of two of its sides and of its diagonals, where maps change from one
// formula to another: 0 is a random number, and 1 is not.
Rows corners(const Judge& j, const Out& more = {}) {
    const double last = 1 - j.epsilon;
    Rows u = pairs({0, last}, more);
    for (int i = 0; i < 256; ++i)
        for (double side : {0.0, last})
            u.add(row(side, (i + 0.5) / 256, more)), u.add(row((i + 0.5) / 256, side, more));
    for (int i = 1; i < 256; ++i)
        u.add(row(i / 256.0, i / 256.0, more)), u.add(row(i / 256.0, 1 - i / 256.0, more));
    return u;
}

// So many digits are enough: a right solution may compute in float.
double digits(const Judge& j) { return std::max(64 * j.epsilon, 0x1p-20); }

// What directions are on average over a fine grid, by any right map of the square the same to 1e-4;
// z and z^2 are expected.  Mistakes are told by the averages to two digits.
void on_average(Judge& j, const std::string& which, const std::string& sample, const Out& more,
                double z, double z2) {
    const Rows directions = j.ask(sample, grid(more, 256));
    const char* names[] = {"z", "z^2", "x", "y", "x y", "x^2 - y^2", "x^2 + y^2 + z^2"};
    const double expected[] = {z, z2, 0, 0, 0, 0, 1};
    Out means(8);
    for (size_t i = 0; i < directions.size(); ++i) {
        const auto [x, y, z_] = triple(directions[i]);
        const double terms[] = {
            z_, z_ * z_, x, y, x * y, x * x - y * y, x * x + y * y + z_ * z_, std::abs(x)};
        for (size_t k = 0; k < 8; ++k) means[k] += terms[k] / double(directions.size());
    }
    size_t first = 0;
    while (first < 7 && std::abs(means[first] - expected[first]) < 5e-4) ++first;
    const bool right = first == 7;
    std::string seen = right ? ""
                             : oracle::say("the mean of %s is %.4g, %.4g expected", names[first],
                                           means[first], expected[first]);
    // Directions of density cos^k have these two means: (k+1)/(k+2) of z and (k+1)/(k+3) of z^2.
    const auto power = [](double mean) { return (2 * mean - 1) / (1 - mean); };
    const double k = power(means[0]);
    if (first < 2 && z > 0 && k > -0.5 && std::abs(means[1] - (k + 1) / (k + 3)) < 1e-3 &&
        std::abs(means[6] - 1) < 5e-4)
        seen += oracle::say(": looks like a density that is the power %.3g of the cosine, not %.3g",
                            k, power(z));
    else if (first >= 2 && first < 6)
        seen += "; z is as it should be, and the turn round the axis is not";
    for (double& m : means) m = std::round(50 * m) / 50;
    j.remember(row(right, means));
    j.exact(which + " are as they should be, on average over the square", right, seen);
}

// Directions that samplers make of these numbers.
void expect_unit(Judge& j, const std::string& which,
                 const std::vector<std::pair<std::string, Rows>>& asked, bool upper = false) {
    Worst lengths;
    double lowest = 1;
    for (const auto& [sample, at] : asked) {
        const Rows directions = j.ask(sample, at);
        for (size_t i = 0; i < directions.size(); ++i) {
            const Triple w = triple(directions[i]);
            const double by = std::abs(dot(w, w) - 1);
            lengths.see(by,
                        oracle::say("at u = (%.4g, %.4g) the square of the length is off by %.3g",
                                    at[i][0], at[i][1], by));
            lowest = -worse(-lowest, -w[2]);
        }
    }
    const bool right = lengths.off < digits(j);
    j.exact(which + " have length 1" + (upper ? " and are above the horizon" : ""),
            right && (!upper || lowest >= 0),
            right ? oracle::say("the lowest z is %.6g", lowest) : lengths.seen);
}

// The integral over the upper hemisphere of what depends on the cosine c alone, by Simpson's rule
// in s, c = 1 - s^4: so it is as exact for narrow lobes.
const int steps = 400;
double cosine_at(int i) { return std::max(1 - std::pow(i / double(steps), 4), 1e-12); }
double over_hemisphere(const Out& values) {
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
        const double s = i / double(steps), weight = i == 0 || i == steps ? 1 : i % 2 ? 4 : 2;
        sum += weight / (3 * steps) * 4 * s * s * s * 2 * pi * values[size_t(i)];
    }
    return sum;
}
double over_hemisphere(Judge& j, const std::string& pdf, const Out& more = {}) {
    const Rows at = rows_of(steps + 1, [&](size_t i) { return row(cosine_at(int(i)), more); });
    return over_hemisphere(j.ask(pdf, at).numbers);
}

// Points or directions from two numbers and perhaps more have this density, on this domain.
template <class Density, class... Domain>
oracle::Verdict dense(Judge& j, const std::string& sample, const Out& more, const Triple& meanwhile,
                      Density density, const oracle::Options& o, const Domain&... domain) {
    return j.batched({sample}, [&](oracle::Random& random, auto& known) {
        auto draw = [&](double u, double v) {
            return triple(known[0](row(u, v, more), row(meanwhile)));
        };
        return oracle::expect_density(random, draw, density, domain..., o);
    });
}

// Directions are as dense as a function of the cosine says, that is 0 below the horizon and need
// not integrate to 1.
template <class Shape>
oracle::Verdict follows(Judge& j, const std::string& sample, Shape shape, const Out& more = {}) {
    Out values;
    for (int i = 0; i <= steps; ++i) values.push_back(shape(cosine_at(i)));
    const double sum = over_hemisphere(values);
    return dense(j, sample, more, {0, 0, 1},
                 [&](const Triple& w) { return w[2] > 0 ? shape(w[2]) / sum : 0.0; },
                 {.sees = 0.05, .tolerance = 1e-6 + 1e4 * j.epsilon, .axis = {0, 0, 1}});
}

// ---- 2.1, 2.2 -----------------------------------------------------------------------------------

void uniform(Judge& j) {
    const std::string half = "sample_uniform_hemisphere", whole = "sample_uniform_sphere";
    const Rows upper = j.ask(half, grid());
    const Out p = j.probe("pdf_uniform_hemisphere", {{1}, {0.7}, {0.1}, {-0.5}}).numbers;
    const Out q = j.probe("pdf_uniform_sphere", {}).numbers;
    expect_unit(j, "all directions",
                {{half, grid()}, {whole, grid()}, {half, corners(j)}, {whole, corners(j)}});
    double lowest = 1;
    for (size_t i = 0; i < upper.size(); ++i) lowest = -worse(-lowest, -upper[i][2]);
    j.exact("directions of the hemisphere are above the horizon", lowest >= 0,
            oracle::say("one has z = %.6g", lowest));
    j.exact(
        "the hemisphere's density is the same at every height, and 0 below the horizon",
        p[0] == p[1] && p[1] == p[2] && p[3] == 0,
        oracle::say("%.6g straight up, %.6g near the horizon, %.6g below it", p[0], p[2], p[3]));
    j.number("the hemisphere's density integrates to 1",
             over_hemisphere(j, "pdf_uniform_hemisphere"), 1, 1e-4);
    j.number("the sphere's density integrates to 1", q[0] * 4 * pi, 1, digits(j));
    on_average(j, "directions of the hemisphere", half, {}, 0.5, 1 / 3.0);
    on_average(j, "directions of the sphere", whole, {}, 0, 1 / 3.0);
    j.statistical("directions of the hemisphere are uniform",
                  follows(j, half, [](double) { return 1.0; }));
    j.statistical("directions of the sphere are uniform",
                  dense(j, whole, {}, {0, 0, 1}, [](const Triple&) { return 1 / (4 * pi); },
                        {.sees = 0.05, .tolerance = 1e4 * j.epsilon}));
}

void cosine_hemisphere(Judge& j) {
    const std::string sample = "sample_cosine_hemisphere", pdf = "pdf_cosine_hemisphere";
    const Out p = j.probe(pdf, {{1}, {0.5}, {0}, {-0.5}}).numbers;
    expect_unit(j, "directions", {{sample, grid()}, {sample, corners(j)}}, true);
    j.exact("the density at 60 degrees is half of that straight up",
            near(2 * p[1], p[0], digits(j)),
            oracle::say("it is %.6g at 60 degrees and %.6g straight up", p[1], p[0]));
    j.number("the density integrates to 1", over_hemisphere(j, pdf), 1, 1e-4);
    j.exact("the density below the horizon is 0", p[3] == 0,
            oracle::say("it is %.6g at a cosine of -0.5", p[3]));
    on_average(j, "directions", sample, {}, 2 / 3.0, 0.5);
    j.statistical("directions follow the cosine", follows(j, sample, [](double c) { return c; }));
}

// ---- 2.3 ----------------------------------------------------------------------------------------

// From the lengths of the sides (Heron).
double area(const Triple& e, const Triple& f) {
    const double a = length(e), b = length(f), c = length(e - f), s = (a + b + c) / 2;
    return std::sqrt(s * (s - a) * (s - b) * (s - c));
}

void triangle(Judge& j) {
    const Triple e{2, 0, 0.5}, f{0.3, 1.5, -0.25}, right{3, 0, 0}, angle{0, 4, 0};
    const Rows points = j.ask("sample_triangle", grid(row(e, f), 128));
    const Rows p = j.probe("pdf_triangle_area", {row(right, angle), row(e, f)});

    const oracle::Triangle<3> t{{0, 0, 0}, e, f};
    Out means(6);
    double outside = 0, nearest[3] = {0, 0, 0}, off = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const Triple x = triple(points[i]);
        const auto [s, part] = t.coordinates(x);
        const double of[3] = {1 - s, s * (1 - part), s * part};
        off = worse(off, length(x - t.at({s, part})));
        for (size_t k = 0; k < 3; ++k) {
            outside = of[k] >= outside ? outside : of[k];
            nearest[k] = std::max(nearest[k], of[k]);
            means[k] += of[k] / double(points.size());
            means[3 + k] += of[k] * of[k] / double(points.size());
        }
    }
    double unlike = 0;
    for (size_t k = 0; k < 6; ++k)
        unlike = worse(unlike, std::abs(means[k] - (k < 3 ? 1 / 3.0 : 1 / 6.0)));
    const auto shares = [&](const char* of, double each, size_t k) {
        return oracle::say(
            "the means of %s of the corners 0, e and f are %.3g, %.3g and %.3g, each "
            "%.3g expected",
            of, means[k], means[k + 1], means[k + 2], each);
    };
    double first = 0;  // of the coordinates themselves
    for (size_t k = 0; k < 3; ++k) first = worse(first, std::abs(means[k] - 1 / 3.0));
    const std::string seen = first < 1e-3 ? shares("squares of the coordinates", 1 / 6.0, 3)
                                          : shares("the coordinates", 1 / 3.0, 0);
    std::sort(means.begin(), means.begin() + 3), std::sort(means.begin() + 3, means.end());
    for (double& m : means) m = std::round(100 * m) / 100;
    j.remember(row(unlike < 1e-3, means));
    j.exact("points are points of the triangle", outside > -digits(j) && off < digits(j),
            oracle::say("a barycentric coordinate is %.6g, a distance from the plane %.3g", outside,
                        off));
    j.exact("all corners have the same share, on average over the square", unlike < 1e-3, seen);
    const double least = std::min({nearest[0], nearest[1], nearest[2]});
    j.exact("no corner is left out", least > 0.8,
            oracle::say("one corner's coordinate is never above %.3g", least));
    j.number("1 / density of the right triangle with legs of 3 and 4 is its area", 1 / p.numbers[0],
             6, digits(j));
    const Pose pose = any_pose(j.random);
    j.number("a triangle that is turned in space keeps its density",
             6 * j.ask("pdf_triangle_area", row(pose.turned(right), pose.turned(angle)))[0], 1,
             digits(j));
    j.number("density times area is 1 whatever the angle", p.numbers[1] * area(e, f), 1, digits(j));
    j.statistical("points follow one over the area",
                  dense(
                      j, "sample_triangle", row(e, f), 1 / 3.0 * e,
                      [&](const Triple&) { return 1 / area(e, f); },
                      {.sees = 0.05, .tolerance = 1e4 * j.epsilon}, t));
}

// ---- 2.4 ----------------------------------------------------------------------------------------

void phong_lobe(Judge& j) {
    const std::string sample = "sample_phong_lobe", pdf = "pdf_phong_lobe";
    const Out p = j.probe(pdf, {{1, 3}, {0.5, 3}, {0.9, 50}, {-0.5, 2}, {0.5, 0}}).numbers;
    expect_unit(j, "directions",
                {{sample, grid({3})},
                 {sample, grid({50})},
                 {sample, corners(j, {0})},
                 {sample, corners(j, {1000})}},
                true);
    j.exact("with n = 3 the density at 60 degrees is an eighth of that on the axis",
            near(8 * p[1], p[0], digits(j)),
            oracle::say("it is %.6g at 60 degrees and %.6g on the axis", p[1], p[0]));
    j.exact("the density behind the lobe is 0, for even n, too", p[3] == 0,
            oracle::say("it is %.6g at a cosine of -0.5 with n = 2", p[3]));
    const double of_all = j.ask(pdf, Rows(Out{-0.5, 0})).numbers.at(0);
    j.exact("the density behind the lobe is 0 for n = 0, where the lobe is a hemisphere",
            of_all == 0, oracle::say("it is %.6g at a cosine of -0.5", of_all));
    j.limit();
    Worst integral;
    for (double n : {0.0, 1.0, 2.5, 20.0, 400.0}) {
        const double sum = over_hemisphere(j, pdf, {n});
        integral.see(std::abs(sum - 1), oracle::say("with n = %g it is %.9g, 1 expected", n, sum));
    }
    j.worst("the density integrates to 1, whatever n is", integral, 1e-4);
    for (double n : {3.0, 50.0})
        on_average(j, oracle::say("directions with n = %.0f", n), sample, {n}, (n + 1) / (n + 2),
                   (n + 1) / (n + 3));
    std::string unlike;
    for (const auto& [n, c] : {std::pair(2.5, 0.25), {1000.0, 255 / 256.0}}) {
        const Out at = j.ask(pdf, Rows{{1, n}, {c, n}}).numbers;
        const Rows directions = j.ask(sample, grid({n}, 64));
        double z = 0;
        for (size_t i = 0; i < directions.size(); ++i)
            z += directions[i][2] / double(directions.size());
        j.remember({at[1] / at[0]});
        if (!unlike.empty()) continue;
        if (!near(at[1] / at[0] / std::pow(c, n), 1, 1e-3))
            unlike = oracle::say(
                "with n = %g the density at a cosine of %.4g is %.4g of that on the "
                "axis, %.4g expected",
                n, c, at[1] / at[0], std::pow(c, n));
        else if (!near((1 - z) * (n + 2), 1, 0.02))
            unlike = oracle::say("with n = %g the mean of z is %.6g, %.6g expected", n, z,
                                 (n + 1) / (n + 2));
    }
    j.exact("n may be a fraction, and as large as 1000", unlike.empty(), unlike);
    j.limit();
    for (double n : {2.0, 60.0})
        j.statistical(
            oracle::say("with n = %.0f directions follow the n-th power of the cosine", n),
            follows(j, sample, [n](double c) { return std::pow(c, n); }, {n}));
}

// ---- 2.5 ----------------------------------------------------------------------------------------

// From the axis, in parts of the cone's own sin^2.
double part_of_cone(In w, double sin2) { return (w[0] * w[0] + w[1] * w[1]) / sin2; }

// By its rings, of 2 pi sin(theta) d theta each.
double solid_angle_of_rings(double sin2) {
    return 2 * pi *
           oracle::integral([](double theta) { return std::sin(theta); }, 0,
                            std::asin(std::sqrt(sin2)), {.noise = 1e-12});
}

// The rim is as wide as digits are lost: where sin^2 is 0.99, that adds 6 times as much to the
// cone.
oracle::Verdict uniform_in_cone(Judge& j, double sin2) {
    const double density = 1 / solid_angle_of_rings(sin2), rim = 1 + digits(j);
    return dense(j, "sample_cone", {sin2}, {0, 0, 1},
                 [&](const Triple& w) {
                     return w[2] > 0 && part_of_cone(In(w), sin2) <= rim ? density : 0.0;
                 },
                 {.sees = 0.05, .tolerance = 10 * digits(j) + 1e4 * j.epsilon, .axis = {0, 0, 1}});
}

void cone(Judge& j) {
    const double wide = 0.36, star = 1e-20;
    const std::string sample = "sample_cone";
    const Rows inner = j.ask(sample, grid({wide})), close = j.ask(sample, grid({star}));
    const Out angle = j.probe("solid_angle_cone", {{1}, {0.75}, {wide}, {star}}).numbers;
    const Out p = j.probe("pdf_cone", {{1}, {wide}, {star}}).numbers;
    const std::vector<Rows> w{inner, j.ask(sample, corners(j, {wide}))};
    double most = 0, least = 1, mean = 0;
    for (const Rows& rows : w)
        for (size_t i = 0; i < rows.size(); ++i) {
            const double part = part_of_cone(rows[i], wide);
            most = worse(most, part), least = -worse(-least, -part);
        }
    for (size_t i = 0; i < close.size(); ++i)
        mean += part_of_cone(close[i], star) / double(close.size());
    expect_unit(j, "directions", {{sample, grid({wide})}, {sample, corners(j, {wide})}}, true);
    // What sin^2 is at the rim says what the parameter was taken for.
    const double rim = most * wide, cosine = std::sqrt(1 - wide);
    std::string cause;
    for (const auto& [sin2, taken] :
         {std::pair(wide * wide, "sin^2 being taken for the sine"),
          {1 - wide * wide, "sin^2 being taken for the cosine"},
          {1 - std::pow(1 - wide, 2), "a cosine of 1 - sin^2, whose root is forgotten"},
          {1 - wide, "the sine being taken for the cosine"},
          {1.0, "a cosine that may be anything from 0 to 1"}})
        if (near(rim, sin2, 1e-3)) cause = std::string(": looks like ") + taken;
    j.exact(
        "directions fill the cone, from its axis to its rim, and no more",
        most <= 1 + digits(j) && most > 0.9 && least < 0.1,
        oracle::say("at the rim the cosine is %.3g and sin^2 %.3g, %.3g and %.3g expected; next "
                    "to the axis sin^2 is %.3g",
                    std::sqrt(std::max(0.0, 1 - rim)), rim, cosine, wide, least * wide) +
            cause);
    j.number("a cone of 90 degrees has the solid angle of a hemisphere", angle[0] / pi, 2,
             digits(j));
    j.number("a cone of 60 degrees has half the solid angle of a hemisphere", angle[1] / pi, 1,
             digits(j));
    j.number("density times solid angle is 1", p[1] * angle[2], 1, digits(j));
    const double narrow = 0x1p-11;
    j.number("a cone of 1.3 degrees has the solid angle of all its rings",
             j.ask("solid_angle_cone", Out{narrow})[0] / solid_angle_of_rings(narrow), 1,
             digits(j));
    j.limit();
    // So small a cone is a disc, whose radius is the sine.
    const double flat = angle[3] / (pi * star), both = p[2] * angle[3];
    j.exact("the cone of a star keeps its digits",
            std::abs(flat - 1) < 1e-6 && std::abs(both - 1) < 1e-6 && std::abs(mean - 0.5) < 0.01,
            oracle::say("for sin^2 = 1e-20 the solid angle is %.7g times that of a flat disc, and "
                        "sin^2 of directions %.5g of it on average",
                        flat, mean));
    j.limit();
    j.remember({flat, std::round(50 * mean) / 50});
    on_average(j, "directions", sample, {wide}, 0.9, 2.44 / 3);
    for (double sin2 : {wide, 0.99})
        j.statistical(oracle::say("with sin^2 = %.2g directions are uniform in the cone", sin2),
                      uniform_in_cone(j, sin2));
}

// ---- 2.6 ----------------------------------------------------------------------------------------

// A parallelogram, seen from a point.
struct Seen {
    Triple corner, u, v, from;
    Out at(double a, double b, double scale = 1) const {
        return row(scale * corner, scale * u, scale * v, scale * from, a, b);
    }
};

// Of the triangle a, b, c seen from the origin (van Oosterom, Strackee 1983).
double solid_angle(const Triple& a, const Triple& b, const Triple& c) {
    return 2 * std::atan2(std::abs(dot(a, cross(b, c))),
                          length(a) * length(b) * length(c) + dot(a, b) * length(c) +
                              dot(b, c) * length(a) + dot(c, a) * length(b));
}
double solid_angle(const Seen& s) {
    const Triple a = s.corner - s.from, b = a + s.u, c = a + s.v, d = b + s.v;
    return solid_angle(a, b, c) + solid_angle(b, d, c);
}

// The mean of 1 / density over uniform points: Gauss's rule of two points in each of 64^2 cells.
double mean_of_inverse(Judge& j, const Seen& s) {
    const int n = 64;
    const double off = 0.5 / std::sqrt(3.0);
    Rows at;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            for (double x : {0.5 - off, 0.5 + off})
                for (double y : {0.5 - off, 0.5 + off}) at.add(s.at((i + x) / n, (k + y) / n));
    double sum = 0;
    for (double p : j.ask("pdf_polygon_by_area", at).numbers) sum += 1 / p;
    return sum / (4 * n * n);
}

void area_to_solid_angle(Judge& j) {
    const Seen table{{-1, -1.5, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 2}};
    const Seen slanted{{-1, 2, 3}, {2, 0.3, 0}, {0.1, -0.4, 1.5}, {0.5, -1, 2}};
    const Seen beside{{-1, 2, 3}, {2, 0.3, 0}, {0.1, -0.4, 1.5}, {9, 1, 4}};
    Seen behind = table;
    behind.from = {0, 0, -2};
    Seen edge = table;
    edge.from = {7, 0, 0};
    const std::string question = "pdf_polygon_by_area";
    const Out p = j.probe(question, {table.at(0.5, 0.5), table.at(0.1, 0.8), slanted.at(0.2, 0.7),
                                     beside.at(0.9, 0.1), behind.at(0.1, 0.8), edge.at(0.3, 0.3)})
                      .numbers;
    const double close = std::max(256 * j.epsilon, digits(j));
    j.number("the density is 2/3 straight above the middle of a light of 2 x 3, at a height of 2",
             p[0], 2 / 3.0, close);
    const Out scaled = j.ask(question, {table.at(0.1, 0.8, 8), slanted.at(0.2, 0.7, 8),
                                        table.at(0.1, 0.8, 0x1p-20)})
                           .numbers;
    const double change[] = {scaled[0] / p[1], scaled[1] / p[2], scaled[2] / p[1]};
    j.exact("where all is eight times as large, the density is the same",
            std::abs(change[0] - 1) < close && std::abs(change[1] - 1) < close,
            oracle::say("it is %.6g and %.6g times as large", change[0], change[1]));
    j.number("where all is a millionth as large, the density is the same", change[2], 1, close);
    j.limit();
    j.number("from behind the density is as large as from the front", p[4] / p[1], 1, close);
    j.exact("where the light is seen edge-on the density is 0, for no direction leads there",
            p[5] == 0, oracle::say("it is %.6g", p[5]));
    Seen grazing = table;
    grazing.from = {7, 0, 0x1p-20};
    j.number("seen at a slant of one in 7 million the density is huge, and not 0",
             j.ask(question, grazing.at(0.5, 0.5))[0] * 0x1p-20 / std::pow(49 + 0x1p-40, 1.5),
             1 / 6.0, close);
    j.limit();
    for (const auto& [where, s] : {std::pair("from above", &table),
                                   {"from one side", &slanted},
                                   {"from far beside", &beside}})
        j.number(std::string("the mean of 1 / density is the solid angle, ") + where,
                 mean_of_inverse(j, *s) / solid_angle(*s), 1, 1e-5 + 1e3 * j.epsilon);
}

}  // namespace

int main(int argc, char** argv) {
    return course::judge(argc, argv,
                         {{"2.1", uniform},
                          {"2.2", cosine_hemisphere},
                          {"2.3", triangle},
                          {"2.4", phong_lobe},
                          {"2.5", cone},
                          {"2.6", area_to_solid_angle}});
}
