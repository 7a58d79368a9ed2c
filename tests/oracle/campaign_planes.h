// oracle/campaign_planes.h  points of the plane, of triangles, and of boxes of up to 5 dimensions
#pragma once
#include <cstdint>

#include "campaign.h"
#include "campaign_lines.h"

namespace campaign {

template <class T>
using Pair = std::pair<T, T>;

template <class T>
void discs(Codes& codes) {
    const std::string family = "discs, polygons";
    auto disc = [](Pair<T> p) {
        return p.first * p.first + p.second * p.second <= 1 ? 1 / pi<T> : 0;
    };
    add<T>(codes, family, "disc, polar", polar_disc<T>, disc);
    add<T>(codes, family, "disc, by squares", concentric_disc<T>, disc);
    add<T>(
        codes, family, "disc, points of the square",
        [](T u, T v) -> std::optional<Pair<T>> {
            const T x = 2 * u - 1, y = 2 * v - 1;
            if (x * x + y * y > 1) return {};
            return Pair<T>{x, y};
        },
        [](Pair<T> p) { return p.first * p.first + p.second * p.second <= 1 ? T(0.25) : T(0); });
    struct Lens {
        T x, y, r;
    };
    for (const auto& c : {Lens{0, 0, T(1e-3)}, {0, 0, T(1e3)}, {100, -30, 2}}) {
        const T x = c.x, y = c.y, r = c.r;
        add<T>(
            codes, family, say("disc of radius %g at (%g, %g)", r, x, y),
            [=](T u, T v) {
                const auto p = concentric_disc(u, v);
                return Pair<T>{x + r * p.first, y + r * p.second};
            },
            [=](Pair<T> p) {
                const T dx = (p.first - x) / r, dy = (p.second - y) / r;
                return dx * dx + dy * dy <= 1 ? 1 / (pi<T> * r * r) : 0;
            });
    }
    add<T>(
        codes, family, "annulus",
        [](T u, T v) {
            const T r = std::sqrt(T(0.49) + u * T(0.51)), phi = 2 * pi<T> * v;
            return Pair<T>{r * std::cos(phi), r * std::sin(phi)};
        },
        [](Pair<T> p) {
            const T s = p.first * p.first + p.second * p.second;
            return s >= T(0.49) && s <= 1 ? 1 / (T(0.51) * pi<T>) : 0;
        });
    add<T>(
        codes, family, "ellipse 10 : 1",
        [](T u, T v) {
            const auto p = polar_disc(u, v);
            return Pair<T>{10 * p.first, p.second};
        },
        [](Pair<T> p) {
            const T x = p.first / 10;
            return x * x + p.second * p.second <= 1 ? 1 / (10 * pi<T>) : 0;
        });
    // Blades of an aperture: which triangle, and where in it.
    for (const int n : {3, 5}) {
        auto corner = [n](int i) {
            return Pair<T>{std::cos(2 * pi<T> * T(i) / T(n)), std::sin(2 * pi<T> * T(i) / T(n))};
        };
        auto inside = [=](int i, T u, T v) {
            const auto a = corner(i), b = corner(i + 1);
            const T r = std::sqrt(u);
            return Pair<T>{r * ((1 - v) * a.first + v * b.first),
                           r * ((1 - v) * a.second + v * b.second)};
        };
        auto pdf = [n](Pair<T> p) {
            for (int i = 0; i < n; ++i) {
                const T phi = pi<T> * T(2 * i + 1) / T(n);
                if (p.first * std::cos(phi) + p.second * std::sin(phi) > std::cos(pi<T> / T(n)))
                    return T(0);
            }
            return 2 / (T(n) * std::sin(2 * pi<T> / T(n)));
        };
        add<T>(
            codes, family, say("polygon of %d, three numbers", n),
            [=](T which, T u, T v) { return inside(int(which * T(n)), u, v); }, pdf);
        add<T>(
            codes, family, say("polygon of %d, two numbers", n),
            [=](T u, T v) {
                const int i = std::min(n - 1, int(u * T(n)));
                return inside(i, u * T(n) - T(i), v);
            },
            pdf);
    }
    add<T>(
        codes, family, "parallelogram",
        [](T u, T v) {
            return Pair<T>{u + T(0.8) * v, T(0.3) * v};
        },
        [](Pair<T> p) {
            const T v = p.second / T(0.3), u = p.first - T(0.8) * v;
            return u >= 0 && u <= 1 && v >= 0 && v <= 1 ? 1 / T(0.3) : 0;
        });
}

template <class T>
void triangles(Codes& codes) {
    const std::string family = "triangles";
    auto inside = [](Pair<T> p) {
        return p.first >= 0 && p.second >= 0 && p.first + p.second <= 1 ? 2 : 0;
    };
    auto root = [](T u, T v) {
        const T r = std::sqrt(u);
        return Pair<T>{1 - r, v * r};
    };
    // Heitz 2019.
    auto flat = [](T u, T v) {
        return v > u ? Pair<T>{u / 2, v - u / 2} : Pair<T>{u - v / 2, v / 2};
    };
    auto folded = [](T u, T v) { return u + v > 1 ? Pair<T>{1 - u, 1 - v} : Pair<T>{u, v}; };
    // One number, two of its bits a quarter (Basu, Owen 2015).
    auto digits = [](T u) {
        T ax = 0, ay = 0, bx = 1, by = 0, cx = 0, cy = 1;
        const uint32_t bits = uint32_t(double(u) * 0x1p32);
        for (int i = 30; i >= 0; i -= 2) {
            const T abx = (ax + bx) / 2, aby = (ay + by) / 2, bcx = (bx + cx) / 2,
                    bcy = (by + cy) / 2, cax = (cx + ax) / 2, cay = (cy + ay) / 2;
            switch (bits >> i & 3) {
                case 0:
                    ax = bcx, ay = bcy, bx = cax, by = cay, cx = abx, cy = aby;
                    break;
                case 1:
                    bx = abx, by = aby, cx = cax, cy = cay;
                    break;
                case 2:
                    ax = abx, ay = aby, cx = bcx, cy = bcy;
                    break;
                default:
                    ax = cax, ay = cay, bx = bcx, by = bcy;
            }
        }
        return Pair<T>{(ax + bx + cx) / 3, (ay + by + cy) / 3};
    };
    add<T>(codes, family, "by a root, plane", root, inside);
    add<T>(codes, family, "by quarters of one number, plane", digits, inside);
    const oracle::Triangle<2> corner({0, 0}, {1, 0}, {0, 1});
    add<T>(codes, family, "by a root", root, inside, corner);
    add<T>(codes, family, "by least distortion", flat, inside, corner);
    add<T>(codes, family, "folded", folded, inside, corner);
    add<T>(codes, family, "by quarters of one number", digits, inside, corner);
    for (const double thin : {1.0, 0.02}) {
        const oracle::Triangle<3> t({0, 0, 1}, {2, 0, 0}, {2 * (1 - thin), thin, 0});
        const T b = T(2 * (1 - thin)), c = T(thin);
        // Half the length of (2, 0, -1) x (2 (1 - thin), thin, -1) = (thin, 2 thin, 2 thin).
        const T density = T(2 / (3 * thin));
        add<T>(
            codes, family, say("in space, %g thin", thin),
            [=](T u, T v) {
                const T r = std::sqrt(u);
                return Vec<T>{r * ((1 - v) * 2 + v * b), r * v * c, 1 - r};
            },
            [density](Vec<T>) { return density; }, t);
    }
}

template <class T>
void surfaces(Codes& codes) {
    const std::string family = "densities of the plane";
    struct Bell {
        T x, y, a, b;
    };
    for (const auto& c : {Bell{0, 0, 1, 1}, {0, 0, 1, T(0.1)}, {50, -20, T(0.01), T(0.01)}}) {
        const T x = c.x, y = c.y, a = c.a, b = c.b;
        add<T>(
            codes, family, say("normal at (%g, %g), widths %g and %g", x, y, a, b),
            [=](T u, T v) {
                const T r = std::sqrt(-2 * std::log(1 - u)), phi = 2 * pi<T> * v;
                return Pair<T>{x + a * r * std::cos(phi), y + b * r * std::sin(phi)};
            },
            [=](Pair<T> p) { return normal_pdf(p.first - x, a) * normal_pdf(p.second - y, b); });
    }
    add<T>(
        codes, family, "normal by Marsaglia's disc",
        [](T u, T v) -> std::optional<Pair<T>> {
            const T x = 2 * u - 1, y = 2 * v - 1, s = x * x + y * y;
            if (s >= 1 || s == 0) return {};
            const T r = std::sqrt(-2 * std::log(s) / s);
            return Pair<T>{r * x, r * y};
        },
        [](Pair<T> p) { return pi<T> / 4 * normal_pdf(p.first) * normal_pdf(p.second); });
    add<T>(
        codes, family, "r^-3 beyond 1",
        [](T u, T v) {
            const T r = 1 / (1 - u), phi = 2 * pi<T> * v;
            return Pair<T>{r * std::cos(phi), r * std::sin(phi)};
        },
        [](Pair<T> p) {
            const T r = std::hypot(p.first, p.second);
            return r >= 1 ? 1 / (2 * pi<T> * r * r * r) : 0;
        });
    for (const T degrees : {T(1), T(2)})
        add<T>(
            codes, family, say("Student's t in the plane, %g degrees", degrees),
            [=](T u, T v) {
                const T r = std::sqrt(degrees * (std::pow(1 - u, -2 / degrees) - 1));
                const T phi = 2 * pi<T> * v;
                return Pair<T>{r * std::cos(phi), r * std::sin(phi)};
            },
            [=](Pair<T> p) {
                const T s = p.first * p.first + p.second * p.second;
                return std::pow(1 + s / degrees, -1 - degrees / 2) / (2 * pi<T>);
            });
    add<T>(
        codes, family, "tents",
        [](T u, T v) {
            auto tent = [](T x) {
                return x < T(0.5) ? std::sqrt(2 * x) - 1 : 1 - std::sqrt(2 - 2 * x);
            };
            return Pair<T>{tent(u), tent(v)};
        },
        [](Pair<T> p) {
            return std::max(T(0), 1 - std::abs(p.first)) * std::max(T(0), 1 - std::abs(p.second));
        });
    add<T>(
        codes, family, "exponentials of rates 1 and 100",
        [](T u, T v) {
            return Pair<T>{-std::log1p(-u), -std::log1p(-v) / 100};
        },
        [](Pair<T> p) {
            return exponential_pdf(p.first, T(1)) * exponential_pdf(p.second, T(100));
        });
    add<T>(
        codes, family, "normal of widths 1 and 1e-3, three numbers",
        [](T which, T u, T v) {
            const T width = which < T(0.5) ? 1 : T(1e-3);
            const T r = width * std::sqrt(-2 * std::log(1 - u)), phi = 2 * pi<T> * v;
            return Pair<T>{r * std::cos(phi), r * std::sin(phi)};
        },
        [](Pair<T> p) {
            return (normal_pdf(p.first) * normal_pdf(p.second) +
                    normal_pdf(p.first, T(1e-3)) * normal_pdf(p.second, T(1e-3))) /
                   2;
        });
    add<T>(
        codes, family, "exponent of the radius, singular at 0",
        [](T u, T v) {
            const T phi = 2 * pi<T> * v;
            return Pair<T>{u * std::cos(phi), u * std::sin(phi)};
        },
        [](Pair<T> p) {
            const T r = std::hypot(p.first, p.second);
            return r > 0 && r <= 1 ? 1 / (2 * pi<T> * r) : 0;
        });
}

template <class T>
void squares(Codes& codes) {
    const std::string family = "tables of the square";
    const oracle::Square square;
    add<T>(
        codes, family, "uniform",
        [](T u, T v) {
            return Pair<T>{u, v};
        },
        [](Pair<T>) { return T(1); }, square);
    add<T>(
        codes, family, "uniform, plane",
        [](T u, T v) {
            return Pair<T>{u, v};
        },
        [](Pair<T> p) {
            return p.first >= 0 && p.first < 1 && p.second >= 0 && p.second < 1 ? 1 : 0;
        });
    using Four = std::array<T, 4>;
    for (const Four& w : {Four{1, 2, 3, 4}, {0, 0, 0, 1}, {1, 0, 0, 100}, {1, 1, 1, 1}})
        add<T>(
            codes, family, say("bilinear, %g %g %g %g", w[0], w[1], w[2], w[3]),
            [w](T u, T v) {
                const T y = linear_sample(v, w[0] + w[1], w[2] + w[3]);
                return Pair<T>{
                    linear_sample(u, (1 - y) * w[0] + y * w[2], (1 - y) * w[1] + y * w[3]), y};
            },
            [w](Pair<T> p) {
                const auto [x, y] = p;
                const T sum =
                    (1 - y) * ((1 - x) * w[0] + x * w[1]) + y * ((1 - x) * w[2] + x * w[3]);
                return 4 * sum / (w[0] + w[1] + w[2] + w[3]);
            },
            square);
    auto table = [&](const std::string& name, size_t width, const std::vector<double>& weights,
                     const auto&... domain) {
        const Tiles<T> tiles(width, weights);
        add<T>(
            codes, family, name, [tiles](T u, T v) { return tiles.sample(u, v); },
            [tiles](Pair<T> p) { return tiles.pdf(p); }, domain...);
    };
    table("2 x 2", 2, {1, 2, 3, 4}, square);
    table("4 x 4, plane", 4, unequal(16, 3));
    for (const size_t width : {4, 8, 16, 32})
        for (const double largest : {1.0, 1e3})
            table(say("%zu x %zu, up to %g", width, width, largest), width,
                  unequal(width * width, largest), square);
    for (const size_t width : {2, 8, 16}) {
        std::vector<double> board;
        for (size_t i = 0; i < width * width; ++i) board.push_back(double((i + i / width) % 2));
        table(say("chessboard %zu x %zu", width, width), width, board, square);
    }
    add<T>(
        codes, family, "diagonal strip",
        [](T u, T v) {
            const T x = u + (v - T(0.5)) / 5;
            return Pair<T>{u, x - std::floor(x)};
        },
        [](Pair<T> p) {
            const T d = p.second - p.first;
            const T off = std::abs(d - std::round(d));
            return off <= T(0.1) ? 5 : 0;
        },
        square);
}

// ---- More dimensions
// -----------------------------------------------------------------------------

template <class T, size_t D>
using Point = std::array<T, D>;

template <class T, size_t D>
oracle::Box<D> cube(double a, double b) {
    oracle::Box<D> box;
    box.lower.fill(a), box.upper.fill(b);
    return box;
}

// A density of each coordinate, and numbers that have it.
template <class T, size_t D, class Sample, class Pdf>
void product(Codes& codes, const std::string& name, double a, double b, Sample sample, Pdf pdf) {
    auto each = [=](auto... u) { return Point<T, D>{sample(u)...}; };
    auto all = [=](const Point<T, D>& x) {
        T density = 1;
        for (T c : x) density *= pdf(c);
        return density;
    };
    const std::string title = say("%zu dimensions, ", D) + name;
    const std::string family = "boxes";
    if constexpr (D == 1)
        add<T>(
            codes, family, title, [=](T u) { return Point<T, D>{sample(u)}; }, all,
            cube<T, D>(a, b));
    if constexpr (D == 3)
        add<T>(
            codes, family, title, [=](T u, T v, T w) { return each(u, v, w); }, all,
            cube<T, D>(a, b));
    if constexpr (D == 4)
        add<T>(
            codes, family, title, [=](T u, T v, T w, T s) { return each(u, v, w, s); }, all,
            cube<T, D>(a, b));
    if constexpr (D == 5)
        add<T>(
            codes, family, title, [=](T u, T v, T w, T s, T t) { return each(u, v, w, s, t); }, all,
            cube<T, D>(a, b));
}
template <class T, size_t D>
void products(Codes& codes) {
    product<T, D>(
        codes, "uniform", -1, 2, [](T u) { return 3 * u - 1; }, [](T) { return 1 / T(3); });
    product<T, D>(
        codes, "linear", 0, 1, [](T u) { return std::sqrt(u); }, [](T x) { return 2 * x; });
    product<T, D>(
        codes, "exponential", 0, 4, [](T u) { return -std::log1p(u * std::expm1(T(-4))); },
        [](T x) { return std::exp(-x) / -std::expm1(T(-4)); });
    const Steps<T> steps{Table<T>({1, 0, 5, 2})};
    product<T, D>(
        codes, "steps", 0, 1, [steps](T u) { return steps.sample(u); },
        [steps](T x) { return steps.pdf(x); });
}

template <class T, size_t D>
void simplex(Codes& codes) {
    auto sorted = [](Point<T, D> x) {
        std::sort(x.begin(), x.end());
        return x;
    };
    T factorial = 1;
    for (size_t i = 2; i <= D; ++i) factorial *= T(i);
    auto pdf = [factorial](const Point<T, D>& x) {
        return std::is_sorted(x.begin(), x.end()) ? factorial : T(0);
    };
    const std::string name = say("%zu dimensions, simplex by sorting", D);
    if constexpr (D == 3)
        add<T>(
            codes, "boxes", name,
            [=](T u, T v, T w) {
                return sorted({u, v, w});
            },
            pdf, cube<T, D>(0, 1));
    if constexpr (D == 4)
        add<T>(
            codes, "boxes", name,
            [=](T u, T v, T w, T s) {
                return sorted({u, v, w, s});
            },
            pdf, cube<T, D>(0, 1));
    if constexpr (D == 5)
        add<T>(
            codes, "boxes", name,
            [=](T u, T v, T w, T s, T t) {
                return sorted({u, v, w, s, t});
            },
            pdf, cube<T, D>(0, 1));
}

template <class T>
void balls(Codes& codes) {
    auto ball = [](T density) {
        return [density](const auto& x) {
            T s = 0;
            for (T c : x) s += c * c;
            return s <= 1 ? density : T(0);
        };
    };
    add<T>(
        codes, "boxes", "3 dimensions, ball",
        [](T u, T v, T w) {
            const Vec<T> d = std::cbrt(w) * polar(1 - 2 * u, 2 * pi<T> * v);
            return Point<T, 3>{d.x, d.y, d.z};
        },
        ball(3 / (4 * pi<T>)), cube<T, 3>(-1, 1));
    add<T>(
        codes, "boxes", "4 dimensions, ball",
        [](T u, T v, T w, T s) {
            const T r = std::sqrt(std::sqrt(s)), a = r * std::sqrt(u), b = r * std::sqrt(1 - u);
            return Point<T, 4>{a * std::cos(2 * pi<T> * v), a * std::sin(2 * pi<T> * v),
                               b * std::cos(2 * pi<T> * w), b * std::sin(2 * pi<T> * w)};
        },
        ball(2 / (pi<T> * pi<T>)), cube<T, 4>(-1, 1));
    add<T>(
        codes, "boxes", "5 dimensions, ball by rejection",
        [](T a, T b, T c, T d, T e) -> std::optional<Point<T, 5>> {
            Point<T, 5> x{a, b, c, d, e};
            T s = 0;
            for (T& k : x) k = 2 * k - 1, s += k * k;
            if (s > 1) return {};
            return x;
        },
        ball(T(1) / 32), cube<T, 5>(-1, 1));
}

template <class T>
void planes(Codes& codes) {
    discs<T>(codes);
    triangles<T>(codes);
    surfaces<T>(codes);
    squares<T>(codes);
    products<T, 1>(codes);
    products<T, 3>(codes);
    products<T, 4>(codes);
    products<T, 5>(codes);
    simplex<T, 3>(codes);
    simplex<T, 4>(codes);
    simplex<T, 5>(codes);
    balls<T>(codes);
}

}  // namespace campaign
