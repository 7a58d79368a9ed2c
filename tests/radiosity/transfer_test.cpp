// radiosity/transfer_test.cpp  form factors against closed forms, reciprocity and energy; shadows
#include "radiosity/transfer.h"

#include "base/closed_forms.h"
#include "radiosity/rooms.h"

using namespace rooms;

namespace {

constexpr double Pi = std::numbers::pi;

Receiver receiver(vec3 p, vec3 n, real error = 0) { return {{p, n, error}, frame(n)}; }
Receiver receiver(const Mesh& mesh, const Face& f, uint32_t v) {
    return receiver(mesh.at[v], f.n, f.error);
}

// The shooting and receiving parts of a scene.
struct Parts : Meshed {
    Trees trees{mesh};
    using Meshed::Meshed;

    Source source(size_t face) const { return {mesh.faces[face].n, mesh.faces[face].error}; }
    // Irradiance from the front of a face whose elements have radiance 1.
    double from(const Receiver& to, size_t face) const {
        Transfer transfer(scene);
        const Corners one{{grey(1), grey(1), grey(1)}};
        double sum = 0;
        for (uint32_t e = 0; e < mesh.faces[face].elements(); ++e) {
            const Node& node = trees[trees.leaf(mesh.faces[face].element + e)];
            sum += double(transfer.from_element(to, source(face), node, one).x);
        }
        return sum;
    }
    // The integral over a face's front of its irradiance from another one.
    double flux(size_t other, const Face& to) const {
        IlluminationMap map(number_of_sides(mesh));
        for (uint32_t v = to.vertex; v < to.vertex + to.vertices(); ++v)
            map[2 * v] = grey(from(receiver(mesh, to, v), other));
        return double(integral(mesh, map, to, false).x);
    }
};

// Errors at H, H / 2, H / 4: second order divides each by four.
void check_second_order(const std::array<double, 3>& errors) {
    INFO("errors ", errors[0], " ", errors[1], " ", errors[2]);
    for (size_t k : {0, 1}) CHECK(std::abs(std::log2(errors[k] / errors[k + 1]) - 2) <= 0.05);
}

}  // namespace

TEST_CASE("in a closed box what a vertex sees sums to 1: within a face, on its edges, in corners") {
    const Parts parts(room({3, 2, 4}, diffuse(grey(0.5))), 1.3);
    Transfer transfer(parts.scene);
    for (size_t face = 0; face < 6; ++face)
        for (uint32_t k = 0; k < parts.mesh.faces[face].vertices(); ++k) {
            const Face& f = parts.mesh.faces[face];
            const Receiver to = receiver(parts.mesh, f, f.vertex + k);
            double by_elements = 0, by_wholes = 0;
            for (size_t other = 0; other < 6; ++other) {
                if (other == face) continue;
                by_elements += parts.from(to, other);
                const Node& whole = parts.trees[parts.trees.first(other)];
                by_wholes +=
                    double(transfer.from_whole(to, parts.source(other), whole, grey(1), 4).y);
            }
            CAPTURE(face);
            CAPTURE(k);
            CHECK(by_elements / Pi == approx(1, 1e-12, 2e-3));
            CHECK(by_wholes / Pi == approx(1, 1e-12, 2e-3));
        }
}

TEST_CASE("opposed and perpendicular plates: area means come to the closed forms as H^2 falls") {
    // A plate of 2 x 1 on the floor, and half as much above it, or on the wall beyond its shorter
    // edge.  By symmetry, the half above gets half of what all above would, 2 F.
    for (bool opposed : {true, false}) {
        CAPTURE(opposed);
        const real up = opposed;
        const Scene s =
            scene_of_quads({{{}, {2, 0, 0}, {0, 1, 0}}, {{0, 0, up}, {0, 1, 0}, {up, 0, 1 - up}}});
        // The same in both directions, by reciprocity.
        const double flux =
            opposed ? closed_forms::opposed(2, 1) : 2 * closed_forms::perpendicular(2, 1);
        std::array<double, 3> there, back, apart;
        for (size_t k = 0; k < 3; ++k) {
            const Parts parts(s, std::sqrt(2) * (1 + 1e-6) / std::exp2(double(k + 2)));
            const double to_b = parts.flux(0, parts.mesh.faces[1]) / Pi,
                         to_a = parts.flux(1, parts.mesh.faces[0]) / Pi;
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

TEST_CASE("an element's radiance is linear: a receiver close by sees where it is bright") {
    const Parts parts(one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 9);
    // The integral of L cos cos / d^2 over the triangle by midpoints, for a receiver that faces
    // down.
    auto truth = [](vec3 p, auto L) {
        constexpr int n = 512;
        double sum = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double x = (i + 0.5) / n, y = (1 - x) * (j + 0.5) / n;
                const double d2 = sqr(x - double(p.x)) + sqr(y - double(p.y)) + sqr(double(p.z));
                sum += L(x, y) * (1 - x) * sqr(double(p.z) / d2);
            }
        return sum / (n * n);
    };
    const Corners L{{grey(1), grey(0), grey(4)}};
    for (vec3 p : {vec3{real(0.1), real(0.1), real(0.05)}, vec3{real(0.3), real(0.4), real(0.3)},
                   vec3{real(-0.2), real(0.8), 1}, vec3{real(0.9), 2, 3}}) {
        CAPTURE(p.z);
        Transfer transfer(parts.scene);
        const Receiver to = receiver(p, {0, 0, -1});
        const double E = double(transfer.from_element(to, parts.source(0), parts.trees[0], L).y);
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

TEST_CASE("what is hidden sends exactly nothing; by quarters, what is hidden in part") {
    const Quad source{{-1, -1, 4}, {2, 0, 0}, {0, 2, 0}},
        panel{{real(-0.5), -1, 2}, {real(0.5), 0, 0}, {0, 2, 0}};
    const Parts parts(scene_of_quads({source, panel}), 99);
    // From (x, 0, 0) the panel hides the centres of two quarters; if x < 0, also that of the whole.
    auto half = [](double x) {
        return closed_forms::polygon_irradiance(
                   {{-1 - x, 4, -1}, {1 - x, 4, -1}, {1 - x, 4, 1}, {-1 - x, 4, 1}}) /
               2;
    };
    const vec3 aside{real(-0.3), 0, 0}, under{real(-0.25), 0, real(1.9)};
    const struct {
        vec3 p;
        real up;
        int asked;  // rays
        double L, E;
        uint64_t rays;
    } rows[] = {{{}, 1, 4, 1, half(0), 4},
                {aside, 1, 1, 1, 0, 1},
                {aside, 1, 4, 1, half(-0.3), 4},
                {under, 1, 1, 1, 0, 1},
                {under, 1, 4, 1, 0, 4},
                {{}, -1, 4, 1, 0, 0},  // no ray to what is behind the receiver,
                {{}, 1, 4, 0, 0, 0}};  // nor to what has no light
    for (const auto& row : rows) {
        CAPTURE(&row - rows);
        Transfer transfer(parts.scene);
        const Source from{{0, 0, -1}, parts.source(0).error};
        const rgb E = transfer.from_whole(receiver(row.p, {0, 0, row.up}), from, parts.trees[0],
                                          grey(row.L), row.asked);
        CHECK(double(E.x) == approx(row.E, 1e-12, 1e-4).scale(row.E > 0 ? 0 : 1e-300));
        CHECK(transfer.rays == row.rays);
    }
}

TEST_CASE("an element gets four shadow rays within eight radii, one beyond; its parts one each") {
    const Parts parts(one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 9);
    const Node& node = parts.trees[0];
    const std::tuple<double, uint64_t, uint64_t> rows[] = {
        {8.01, 1, 1}, {7.99, 4, 4},  {4.01, 4, 4},     {3.99, 4, 4},  // four quarters
        {2.5, 4, 4},  {1.5, 16, 16}, {0.1, 101, 4096}, {1e-4, 1, 4096}};
    for (const auto& [radii, least, most] : rows) {
        Transfer transfer(parts.scene);
        const vec3 p = node.centre + vec3{0, 0, real(radii)} * node.radius;
        transfer.from_element(receiver(p, {0, 0, -1}), parts.source(0), node,
                              {{grey(1), grey(1), grey(1)}});
        CAPTURE(p.z);
        CHECK(transfer.rays >= least);
        CHECK(transfer.rays <= most);
    }
}

TEST_CASE("what is cut by the horizon sends what is above it") {
    const Parts parts(scene_of_quads({{{3, -1, -1}, {0, 2, 0}, {0, 0, 4}}}), 99);
    const Source from{{-1, 0, 0}, parts.source(0).error};
    for (double z : {-0.5, 0.0, 1.5, 2.4, 2.9}) {
        CAPTURE(z);
        Transfer transfer(parts.scene);
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
