// radiosity/transfer_test.cpp  form factors against closed forms, reciprocity and energy; shadows
#include "radiosity/transfer.h"

#include "base/rng.h"
#include "oracle/expect.h"
#include "radiosity/exact.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

constexpr double Pi = std::numbers::pi;

Receiver receiver(vec3 p, vec3 n, real error = 0) { return {{p, n, error}, frame(n)}; }
Receiver receiver(const Mesh& mesh, const Face& f, uint32_t v) {
    return receiver(mesh.at[v], f.n, f.error);
}

// The shooting and receiving parts of a scene.
struct Parts {
    const Scene& scene;
    Mesh mesh;
    Trees trees;
    Parts(const Scene& s, double H) : scene(s), mesh(make_mesh(s, H)), trees(mesh) {}

    // Irradiance from the front of an element of radiance 1.
    double from(const Receiver& to, const Face& f, uint32_t e) const {
        Transfer transfer(scene);
        const Corners one{{grey(1), grey(1), grey(1)}};
        return double(transfer.from_element(to, {f.n, f.error}, trees[trees.leaf(e)], one).x);
    }
    double from(const Receiver& to, const Face& f) const {
        double sum = 0;
        for (uint32_t e = f.element; e < f.element + f.elements(); ++e) sum += from(to, f, e);
        return sum;
    }
    // The integral over a face's front of its irradiance from another face of radiance 1.
    template <class From>
    double flux(const Face& to, From irradiance) const {
        IlluminationMap map(number_of_sides(mesh));
        for (uint32_t v = to.vertex; v < to.vertex + to.vertices(); ++v)
            map[2 * v] = grey(irradiance(receiver(mesh, to, v)));
        return double(integral(mesh, map, to, false).x);
    }
    double flux(const Face& from_this, const Face& to) const {
        return flux(to, [&](const Receiver& x) { return from(x, from_this); });
    }
};

// Errors at H, H / 2, H / 4: second order divides each by four.
void check_second_order(const std::array<double, 3>& errors, double give = 0.05) {
    INFO("errors ", errors[0], " ", errors[1], " ", errors[2]);
    CHECK(std::abs(std::log2(errors[0] / errors[1]) - 2) <= give);
    CHECK(std::abs(std::log2(errors[1] / errors[2]) - 2) <= give);
}

}  // namespace

TEST_CASE("in a closed box what a vertex sees sums to 1: within a face, on its edges, in corners") {
    const Scene s = room({3, 2, 4}, diffuse(grey(0.5)));
    const Parts parts(s, 1.3);
    Transfer transfer(s);
    for (const Face& f : parts.mesh.faces)
        for (uint32_t v = f.vertex; v < f.vertex + f.vertices(); ++v) {
            const Receiver to = receiver(parts.mesh, f, v);
            double by_elements = 0, by_wholes = 0;
            for (const Face& from : parts.mesh.faces) {
                if (&from == &f) continue;
                by_elements += parts.from(to, from);
                for (uint32_t e = from.element; e < from.element + from.elements(); ++e) {
                    const Node& whole = parts.trees[parts.trees.leaf(e)];
                    by_wholes +=
                        double(transfer.from_whole(to, {from.n, from.error}, whole, grey(1), 4).y);
                }
            }
            CAPTURE(v);
            CHECK(by_elements / Pi == approx(1, 1e-12, 2e-3));
            CHECK(by_wholes / Pi == approx(1, 1e-12, 2e-3));
        }
}

TEST_CASE("opposed and perpendicular plates: area means come to the closed forms as H^2 falls") {
    // A plate of 2 x 1 on the floor, and half as much above it, or on the wall beyond its shorter
    // edge.  By symmetry, the half above gets half of what all above would, 2 F.
    for (bool opposed : {true, false}) {
        CAPTURE(opposed);
        Scene s;
        const uint32_t d = add(s, diffuse(grey(0.5)));
        add_quad(s, {}, {2, 0, 0}, {0, 1, 0}, d);
        add_quad(s, {0, 0, real(opposed)}, {0, 1, 0}, {real(opposed), 0, real(!opposed)}, d);
        prepare(s);
        // The same in both directions, by reciprocity.
        const double flux =
            opposed ? closed_forms::opposed(2, 1) : 2 * closed_forms::perpendicular(2, 1);
        std::array<double, 3> there, back, apart;
        for (size_t k = 0; k < 3; ++k) {
            const Parts parts(s, std::sqrt(2) * (1 + 1e-6) / std::exp2(double(k + 2)));
            const Face &a = parts.mesh.faces[0], &b = parts.mesh.faces[1];
            const double to_b = parts.flux(a, b) / Pi, to_a = parts.flux(b, a) / Pi;
            there[k] = std::abs(to_b / flux - 1), back[k] = std::abs(to_a / flux - 1);
            apart[k] = std::abs(to_b - to_a) / flux;
        }
        // Each vertex is exact, so that only the means over receivers err: by the trapezoidal rule.
        check_second_order(there), check_second_order(back);
        CHECK(back[2] < 1e-3);
        // For parallel plates the error is at the border, in the same proportion on both.
        if (!opposed) check_second_order(apart);
    }
}

TEST_CASE("in a closed box all that a shot sends arrives, but for an error of the order of H^2") {
    const Scene s = room({2, 1, 1}, diffuse(grey(0.5)));
    std::array<double, 3> wall, middle, mean;
    for (size_t k = 0; k < 3; ++k) {
        const Parts parts(s, std::sqrt(2) * (1 + 1e-6) / std::exp2(double(k + 2)));
        const Face& f = parts.mesh.faces[0];
        REQUIRE(f.elements() == 64u << (2 * k));
        double all = 0, off = 0;
        const uint32_t at = 2 * ((f.rows / 2) * f.columns + f.columns / 2);
        for (uint32_t e = 0; e < f.elements(); ++e) {
            double arrived = 0;
            for (const Face& to : parts.mesh.faces)
                if (&to != &f)
                    arrived += parts.flux(
                        to, [&](const Receiver& x) { return parts.from(x, f, f.element + e); });
            arrived /= Pi * double(area_of(f)), all += arrived / f.elements();
            off += std::abs(arrived - 1) / f.elements();
            if (e == at) middle[k] = std::abs(arrived - 1);
        }
        wall[k] = std::abs(all - 1), mean[k] = off;
    }
    check_second_order(wall), check_second_order(middle, 0.2);
    CHECK(wall[2] < 1e-4);
    CHECK(middle[2] < 3e-3);
    // The light from an element at an edge to a few vertices of the adjacent face has a relative
    // error that does not depend on H.  Such elements are 1/n of all.  Errors of neighbours cancel,
    // or the walls would not be so exact.
    INFO(mean[0], " ", mean[1], " ", mean[2]);
    CHECK(std::log2(mean[1] / mean[2]) == doctest::Approx(1).epsilon(0.25));
    CHECK(mean[2] < 0.02);
}

TEST_CASE("an element's radiance is linear: a receiver close by sees where it is bright") {
    const Scene s = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Parts parts(s, 9);
    const Node& node = parts.trees[0];
    // Lambert's sum over 4^8 parts of one radiance each.
    auto truth = [&](vec3 p, auto value) {
        double sum = 0;
        const int n = 256;
        auto part = [&](double x0, double y0, double x1, double y1, double x2, double y2) {
            const double px = double(p.x), py = double(p.y), pz = double(p.z);
            // The receiver faces down: its +y is -z here.
            sum += value((x0 + x1 + x2) / 3, (y0 + y1 + y2) / 3) *
                   closed_forms::polygon_irradiance(
                       {{x0 - px, pz, y0 - py}, {x1 - px, pz, y1 - py}, {x2 - px, pz, y2 - py}});
        };
        for (int j = 0; j < n; ++j)
            for (int i = 0; i + j < n; ++i) {
                const double x = double(i) / n, y = double(j) / n, h = 1.0 / n;
                part(x, y, x + h, y, x, y + h);
                if (i + j + 1 < n) part(x + h, y + h, x, y + h, x + h, y);
            }
        return sum;
    };
    const Corners L{{grey(1), grey(0), grey(4)}};
    for (vec3 p : {vec3{real(0.1), real(0.1), real(0.05)}, vec3{real(0.3), real(0.4), real(0.3)},
                   vec3{real(-0.2), real(0.8), 1}, vec3{real(0.9), 2, 3}}) {
        CAPTURE(p.z);
        Transfer transfer(s);
        const Receiver to = receiver(p, {0, 0, -1});
        const double E = double(transfer.from_element(to, {{0, 0, 1}, 0}, node, L).y);
        const double exact = truth(p, [](double x, double y) { return 1 - x - y + 4 * y; });
        // Parts are smaller than a quarter of their distance.  So their error is less than a
        // sixteenth of the differences of radiance: 1 % and less.  Beyond four radii the element is
        // one part.
        const double flat = truth(p, [](double, double) { return 5.0 / 3; });
        CHECK(E == approx(p.z < 2 ? exact : flat, 0.012, 0.012));
        CHECK(std::abs(flat / exact - 1) > 0.04);
        if (p.z < real(0.5)) CHECK(E == approx(exact, 3e-3, 3e-3));
    }
}

TEST_CASE("a point light sends I cos / d^2, to what looks at it, if nothing is in the way") {
    Scene s;
    const uint32_t d = add(s, diffuse(grey(0.5)));
    add_quad(s, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, d);
    add_point_light(s, {0, 0, 3}, {1, 2, 7});
    prepare(s);
    const Light& light = s.lights[0];
    Transfer transfer(s);
    CHECK(transfer.from_point(receiver({}, {0, 0, 1}), light) == rgb{});  // behind the panel
    CHECK(transfer.rays == 1);
    CHECK(transfer.from_point(receiver({}, {0, 0, -1}), light) == rgb{});  // faces away: no ray
    CHECK(transfer.rays == 1);
    const vec3 p{4, 0, 0}, n = unit({-1, 0, 2});
    const rgb E = transfer.from_point(receiver(p, n), light);
    const double expected = 10 / std::sqrt(5) / 125;  // d (-4, 0, 3) of length 5
    CHECK(double(E.x) == approx(expected));
    CHECK(double(E.z) == approx(7 * expected));
    CHECK(transfer.rays == 2);
    // The receiver lies on the panel; its own plane is no obstacle.
    const rgb on =
        transfer.from_point(receiver({0, 0, 1}, {0, 0, 1}, rounding_error(s.shapes[0])), light);
    CHECK(double(on.y) == approx(0.5));
}

TEST_CASE("what is hidden sends exactly nothing; by quarters, what is hidden in part") {
    Scene s;
    const uint32_t d = add(s, diffuse(grey(0.5)));
    add_quad(s, {-1, -1, 4}, {2, 0, 0}, {0, 2, 0}, d);                  // the source
    add_quad(s, {real(-0.5), -1, 2}, {real(0.5), 0, 0}, {0, 2, 0}, d);  // hides x < 0 of it
    prepare(s);
    const Parts parts(s, 99);
    const Node& node = parts.trees[0];
    const Source from{{0, 0, -1}, parts.mesh.faces[0].error};
    auto sent = [&](const Receiver& to, const Node& what, int rays) {
        Transfer transfer(s);
        const double E = double(transfer.from_whole(to, from, what, grey(1), rays).x);
        return std::pair(E, transfer.rays);
    };
    const Receiver below = receiver({}, {0, 0, 1});
    // C-11 of each quarter: 1/4 of the square's side is 1/4 of the height.
    const double whole = 4 * (1 / std::sqrt(17) * std::atan(1 / std::sqrt(17)));
    CHECK(sent(below, node, 4).first == approx(whole / 2, 1e-12, 1e-4));
    CHECK(sent(below, node, 4).second == 4);
    CHECK(sent(below, node, 1).second == 1);
    const Receiver aside = receiver({real(-0.3), 0, 0}, {0, 0, 1});
    CHECK(sent(aside, node, 1).first == 0);  // its centre is hidden
    CHECK(sent(aside, node, 4).first > 0);
    // The panel hides the whole source.
    const Receiver under = receiver({real(-0.25), 0, real(1.9)}, {0, 0, 1});
    for (int rays : {1, 4}) {
        CHECK(sent(under, node, rays).first == 0);
        CHECK(sent(under, node, rays).second == uint64_t(rays));
    }
    // Sources behind the receiver or without light take no ray.
    CHECK(sent(receiver({}, {0, 0, -1}), node, 4) == std::pair(0.0, uint64_t(0)));
    Transfer transfer(s);
    CHECK(transfer.from_whole(below, from, node, {}, 4) == rgb{});
    CHECK(transfer.rays == 0);
}

TEST_CASE("an element gets four shadow rays within eight radii, one beyond; its parts one each") {
    const Scene s = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Parts parts(s, 9);
    const Node& node = parts.trees[0];
    const Corners one{{grey(1), grey(1), grey(1)}};
    auto rays = [&](double radii) {
        Transfer transfer(s);
        const vec3 p = node.centre + vec3{0, 0, real(radii)} * node.radius;
        transfer.from_element(receiver(p, {0, 0, -1}), {{0, 0, 1}, 0}, node, one);
        return transfer.rays;
    };
    CHECK(rays(8.01) == 1);
    CHECK(rays(7.99) == 4);
    CHECK(rays(4.01) == 4);
    CHECK(rays(3.99) == 4);  // four quarters
    CHECK(rays(2.5) == 4);
    CHECK(rays(1.5) == 16);
    CHECK(rays(0.1) > 100);
    CHECK(rays(1e-4) <= 4096);
}

TEST_CASE("what is cut by the horizon sends what is above it") {
    Scene s;
    add_quad(s, {3, -1, -1}, {0, 2, 0}, {0, 0, 4}, add(s, diffuse(grey(0.5))));
    prepare(s);
    const Parts parts(s, 99);
    const Source from{{-1, 0, 0}, parts.mesh.faces[0].error};
    for (double z : {-0.5, 0.0, 1.5, 2.4, 2.9}) {
        CAPTURE(z);
        Transfer transfer(s);
        const Receiver to = receiver({0, 0, real(z)}, {0, 0, 1});
        const double E = double(transfer.from_whole(to, from, parts.trees[0], grey(1), 4).x);
        // The closed form's +y is our z.
        const double lo = -1 - z, hi = 3 - z;
        CHECK(E == approx(closed_forms::polygon_irradiance(
                              {{3, lo, -1}, {3, lo, 1}, {3, hi, 1}, {3, hi, -1}}),
                          1e-9, 2e-3));
        CHECK(transfer.rays >= 1);
    }
}
