// radiosity/mesh.h  2  faces cut into triangles; their vertices hold the illuminance
#pragma once
#include <unistd.h>

#include "radiosity/facets.h"

namespace penumbra {

// ---- Faces --------------------------------------------------------------------------------------

// A parallelogram a b c d, which two triangles (a, b, c) and (a, c, d) of the scene are, or one
// triangle a b c; cut into a grid of columns x rows cells along ab and ad, or into rows^2
// triangles.
struct Face {
    uint32_t shape = 0;  // the first of it
    bool quad = false;
    vec3 a, b, c, d;
    vec3 n;          // the shape's own normal
    real error = 0;  // of its points, see Surface
    uint32_t columns = 1, rows = 1;
    uint32_t vertex = 0, element = 0;  // the first of it
    uint32_t vertices() const {
        return quad ? (columns + 1) * (rows + 1) : (rows + 1) * (rows + 2) / 2;
    }
    uint32_t elements() const { return quad ? 2 * columns * rows : rows * rows; }
    real area() const { return length(cross(b - a, (quad ? d : c) - a)) * (quad ? 1 : real(0.5)); }
};

// The face that begins with shape i, not yet cut.
inline Face face_at(const Scene& s, uint32_t i) {
    const Shape& t = s.shapes[i];
    Face f{i, false, t.a, t.b, t.c, t.c, unit(area_vector(t)), rounding_error(t)};
    if (i + 1 == s.shapes.size() || s.material_of[i + 1] != s.material_of[i] ||
        s.light_of[i + 1] != s.light_of[i])
        return f;
    const Shape& u = s.shapes[i + 1];
    const bool closes = max_abs((t.a - t.b) + (t.c - u.c)) <= f.error;
    if (u.a == t.a && u.b == t.c && closes) {
        f.quad = true, f.d = u.c;
        f.error = std::max(f.error, rounding_error(u));
    }
    return f;
}

// The fewest cells without an edge longer than H; a triangle has a power of two of rows, so that it
// can be quartered.  Double, because there may be too many.
struct Grid {
    double columns = 1, rows = 1;
};
inline Grid grid_of(const Face& f, double H) {
    const double room = H * (1 + 1e-9);  // for the rounding of an H that is a side over n
    auto longest = [](vec3 x, vec3 y) { return std::max(double(length(x)), double(length(y))); };
    if (!f.quad) {
        const double edge = std::max(longest(f.b - f.a, f.c - f.b), double(length(f.a - f.c)));
        double n = 1;
        while (edge / n > room) n *= 2;
        return {n, n};
    }
    // A cell's diagonal is at least as long as the longer side of it over the root of 2, so start
    // there and cut what is longer.
    const vec3 u = f.b - f.a, v = f.d - f.a;
    Grid g{std::ceil(double(length(u)) / room), std::ceil(double(length(v)) / room)};
    auto part = [](vec3 x, double n) { return x / real(n); };
    while (g.columns * g.rows < 1e12) {
        const vec3 x = part(u, g.columns), y = part(v, g.rows);
        if (std::max(longest(x, y), double(length(x + y))) <= room) break;
        if (length(x) > length(y))  // one more; of thousands a thousandth, not to be long
            g.columns = std::max(g.columns + 1, std::ceil(g.columns * 1.001));
        else
            g.rows = std::max(g.rows + 1, std::ceil(g.rows * 1.001));
    }
    return g;
}

// ---- The mesh -----------------------------------------------------------------------------------

struct Mesh {
    std::vector<Face> faces;
    std::vector<uint32_t> face_of;                 // of each shape
    std::vector<vec3> at;                          // where the light of each vertex is received
    std::vector<std::array<uint32_t, 3>> corners;  // vertices of each element
    size_t vertices() const { return at.size(); }
    size_t elements() const { return corners.size(); }
};

// Three vertices and what each counts at a point between them.
struct Between {
    std::array<uint32_t, 3> vertex;
    std::array<real, 3> weight;
};

// Vertex (i, j) of a face's grid.
inline uint32_t vertex_at(const Face& f, uint32_t i, uint32_t j) {
    if (f.quad) return f.vertex + j * (f.columns + 1) + i;
    return f.vertex + (j * (2 * f.rows + 3 - j)) / 2 + i;
}

// The vertices of triangle `half` of cell (i, j): 0, the nearer to ab (of a quad), to a (of a
// triangle), or 1.
inline std::array<uint32_t, 3> triangle_at(const Face& f, uint32_t i, uint32_t j, uint32_t half) {
    const uint32_t p = vertex_at(f, i, j), q = vertex_at(f, i + 1, j);
    if (f.quad) {
        const uint32_t r = vertex_at(f, i + 1, j + 1);
        return half ? std::array{p, r, vertex_at(f, i, j + 1)} : std::array{p, q, r};
    }
    if (half) return {vertex_at(f, i + 1, j + 1), vertex_at(f, i, j + 1), q};
    return {p, q, vertex_at(f, i, j + 1)};
}
inline uint32_t element_at(const Face& f, uint32_t i, uint32_t j, uint32_t half) {
    return f.element + (f.quad ? 2 * (j * f.columns + i) : j * (2 * f.rows - j) + 2 * i) + half;
}

// Where a hit lies among the vertices: hats of its triangle's corners.
inline Between between(const Mesh& mesh, const Hit& hit) {
    const Face& f = mesh.faces[mesh.face_of[hit.id]];
    const bool second = hit.id != f.shape;
    real s = f.quad ? second ? hit.v : hit.v + hit.w : hit.v;
    real t = f.quad ? second ? hit.v + hit.w : hit.w : hit.w;
    auto split = [](real& x, uint32_t n) {  // into the cell's number and the position in it
        x = std::max(real(0), x * real(n));
        const uint32_t i = std::min(uint32_t(x), n - 1);
        x = std::min(x - real(i), real(1));
        return i;
    };
    const uint32_t i = split(s, f.columns);
    uint32_t j = split(t, f.rows);
    if (f.quad) {
        const bool half = t > s;
        const std::array<real, 3> w =
            half ? std::array{1 - t, s, t - s} : std::array{1 - s, s - t, t};
        return {triangle_at(f, i, j, half), w};
    }
    if (i + j >= f.rows) j = f.rows - 1 - i, t = 1 - s;  // by rounding, beyond bc
    const bool half = s + t > 1 && i + j + 1 < f.rows;
    if (!half && s + t > 1) t = 1 - s;
    const std::array<real, 3> w =
        half ? std::array{s + t - 1, 1 - s, 1 - t} : std::array{1 - s - t, s, t};
    return {triangle_at(f, i, j, half), w};
}

// ---- Construction -------------------------------------------------------------------------------

// Corner (i, j) of the grid, which may lie between its points.
inline vec3 point_at(const Face& f, real i, real j) {
    const real s = i / real(f.columns), t = j / real(f.rows);
    return (1 - s - t) * f.a + s * f.b + t * (f.quad ? f.d : f.c);
}

// Vertices on a face's border receive light a thousandth of a cell within it: there, surfaces that
// meet it at an edge fill the half of the sky that they fill in the limit, and no ray starts within
// them.
inline vec3 receives_at(const Face& f, uint32_t i, uint32_t j) {
    constexpr real inside = real(1) / 1024;
    auto clamped = [=](uint32_t k, uint32_t n) {
        return std::clamp(real(k), inside, real(n) - inside);
    };
    if (f.quad) return point_at(f, clamped(i, f.columns), clamped(j, f.rows));
    const real n = real(f.rows), s = std::max(real(i), inside), t = std::max(real(j), inside),
               r = std::max(real(f.rows - i - j), inside), sum = s + t + r;
    return point_at(f, s / sum * n, t / sum * n);
}

// The size of a mesh; double, because it may be too large to exist.
struct Sizes {
    double faces = 0, elements = 0, vertices = 0;
};
inline Sizes sizes(const Scene& s, double H) {
    Sizes sum;
    for (uint32_t i = 0; i < s.shapes.size(); ++i) {
        if (const real r = s.shapes[i].r; r > 0) {  // a sphere: at most, if facets are cut again
            const double n = facets_of_sphere(r, H), edge = edge_of_facets(r, quarterings(r, H));
            double rows = 1;
            while (edge / rows > H) rows *= 2;
            sum.faces += n, sum.elements += n * rows * rows;
            sum.vertices += n * (rows + 1) * (rows + 2) / 2;
            continue;
        }
        const Face f = face_at(s, i);
        const auto [n, m] = grid_of(f, H);
        ++sum.faces;
        sum.elements += f.quad ? 2 * n * m : n * n;
        sum.vertices += f.quad ? (n + 1) * (m + 1) : (n + 1) * (n + 2) / 2;
        i += f.quad;
    }
    return sum;
}

// Bytes per face, element and vertex, for the mesh itself and for the data of a method.  A face has
// up to two shapes in the scene, with their part of its BVH, and a light.
struct Bytes {
    double face = sizeof(Face) + sizeof(Light) + 2 * (2 * sizeof(Shape) + 64),
           element = 3 * sizeof(uint32_t), vertex = sizeof(vec3);
    double of(const Sizes& s) const {
        return s.faces * face + s.elements * element + s.vertices * vertex;
    }
};

// Throws UserError if the mesh exceeds the memory or the range of its indices.
inline void check_fits(const Scene& s, double H, const Bytes& bytes, double memory) {
    auto fits = [&](double h) {
        const Sizes n = sizes(s, h);
        return std::max(n.elements, n.vertices) < 0x1p30 && bytes.of(n) <= memory;
    };
    if (fits(H)) return;
    double wider = H;
    for (int k = 0; k < 200 && !fits(wider); ++k) wider *= 1.25;
    char text[200];
    std::snprintf(text, sizeof text,
                  "edges of %.3g would be %.3g triangles and take %.3g GB of %.3g GB memory; ", H,
                  sizes(s, H).elements, bytes.of(sizes(s, H)) / 1e9, memory / 1e9);
    const std::string what = text;
    if (!fits(wider)) throw UserError(what + "no mesh would fit");
    std::snprintf(text, sizeof text, "%.3g would fit", wider);
    throw UserError(what + text);
}

// Adds the elements of a face, in their order.
inline void add_elements(Mesh& mesh, const Face& f) {
    for (uint32_t j = 0; j < f.rows; ++j)
        for (uint32_t i = 0; i < (f.quad ? f.columns : f.rows - j); ++i) {
            mesh.corners.push_back(triangle_at(f, i, j, 0));
            if (f.quad || i + 1 < f.rows - j) mesh.corners.push_back(triangle_at(f, i, j, 1));
        }
}

// The mesh of a scene of triangles, no edge longer than H.
inline Mesh make_mesh(const Scene& s, double H) {
    Mesh mesh;
    mesh.face_of.resize(s.shapes.size());
    for (uint32_t i = 0; i < s.shapes.size(); ++i) {
        Face f = face_at(s, i);
        const auto [columns, rows] = grid_of(f, H);
        f.columns = uint32_t(columns), f.rows = uint32_t(rows);
        f.vertex = uint32_t(mesh.at.size()), f.element = uint32_t(mesh.corners.size());
        add_elements(mesh, f);
        mesh.face_of[i] = uint32_t(mesh.faces.size());
        for (uint32_t y = 0; y <= f.rows; ++y)
            for (uint32_t x = 0; x <= (f.quad ? f.columns : f.rows - y); ++x)
                mesh.at.push_back(receives_at(f, x, y));
        if (f.quad) mesh.face_of[++i] = uint32_t(mesh.faces.size());
        mesh.faces.push_back(f);
    }
    return mesh;
}

}  // namespace penumbra
