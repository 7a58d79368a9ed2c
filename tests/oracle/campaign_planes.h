// oracle/campaign_planes.h  points of the plane, of triangles, and of boxes of up to 5 dimensions
#pragma once
#include <cstdint>

#include "campaign.h"
#include "campaign_lines.h"

namespace campaign {

template <class T>
using Pair = std::pair<T, T>;

template <class T>
T square_of(Pair<T> p) {
    return p.first * p.first + p.second * p.second;
}

template <class T>
void discs(Codes& codes) {
    const Family<T> add{codes, "discs, polygons"};
    auto disc = [](Pair<T> p) { return square_of(p) <= 1 ? 1 / pi<T> : 0; };
    add("disc, polar", polar_disc<T>).pdf(disc);
    add("disc, by squares", concentric_disc<T>).pdf(disc);
    add("disc, points of the square", [](T u, T v) -> std::optional<Pair<T>> {
        const T x = 2 * u - 1, y = 2 * v - 1;
        if (x * x + y * y > 1) return {};
        return {{x, y}};
    }).pdf([](Pair<T> p) { return square_of(p) <= 1 ? T(0.25) : T(0); });
    struct Lens {
        T x, y, r;
    };
    for (const auto& c : {Lens{0, 0, T(1e-3)}, {0, 0, T(1e3)}, {100, -30, 2}}) {
        const T x = c.x, y = c.y, r = c.r;
        add(say("disc of radius %g at (%g, %g)", r, x, y), [=](T u, T v) {
            const auto p = concentric_disc(u, v);
            return Pair<T>{x + r * p.first, y + r * p.second};
        }).pdf([=](Pair<T> p) {
            const T dx = (p.first - x) / r, dy = (p.second - y) / r;
            return dx * dx + dy * dy <= 1 ? 1 / (pi<T> * r * r) : 0;
        });
    }
    add("annulus", [](T u, T v) {
        return on_circle(std::sqrt(T(0.49) + u * T(0.51)), v);
    }).pdf([](Pair<T> p) {
        const T s = square_of(p);
        return s >= T(0.49) && s <= 1 ? 1 / (T(0.51) * pi<T>) : 0;
    });
    add("ellipse 10 : 1", [](T u, T v) {
        const auto p = polar_disc(u, v);
        return Pair<T>{10 * p.first, p.second};
    }).pdf([](Pair<T> p) {
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
        add(say("polygon of %d, three numbers", n), [=](T which, T u, T v) {
            return inside(int(which * T(n)), u, v);
        }).pdf(pdf);
        add(say("polygon of %d, two numbers", n), [=](T u, T v) {
            const int i = std::min(n - 1, int(u * T(n)));
            return inside(i, u * T(n) - T(i), v);
        }).pdf(pdf);
    }
    add("parallelogram", [](T u, T v) {
        return Pair<T>{u + T(0.8) * v, T(0.3) * v};
    }).pdf([](Pair<T> p) {
        const T v = p.second / T(0.3), u = p.first - T(0.8) * v;
        return u >= 0 && u <= 1 && v >= 0 && v <= 1 ? 1 / T(0.3) : 0;
    });
}

template <class T>
void triangles(Codes& codes) {
    const Family<T> add{codes, "triangles"};
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
                case 0: ax = bcx, ay = bcy, bx = cax, by = cay, cx = abx, cy = aby; break;
                case 1: bx = abx, by = aby, cx = cax, cy = cay; break;
                case 2: ax = abx, ay = aby, cx = bcx, cy = bcy; break;
                default: ax = cax, ay = cay, bx = bcx, by = bcy;
            }
        }
        return Pair<T>{(ax + bx + cx) / 3, (ay + by + cy) / 3};
    };
    add("by a root, plane", root).pdf(inside);
    add("by quarters of one number, plane", digits).pdf(inside);
    const oracle::Triangle<2> corner({0, 0}, {1, 0}, {0, 1});
    add("by a root", root).on(corner, inside);
    add("by least distortion", flat).on(corner, inside);
    add("folded", folded).on(corner, inside);
    add("by quarters of one number", digits).on(corner, inside);
    for (const double thin : {1.0, 0.02}) {
        const oracle::Triangle<3> t({0, 0, 1}, {2, 0, 0}, {2 * (1 - thin), thin, 0});
        const T b = T(2 * (1 - thin)), c = T(thin);
        // Half the length of (2, 0, -1) x (2 (1 - thin), thin, -1) = (thin, 2 thin, 2 thin).
        const T density = T(2 / (3 * thin));
        add(say("in space, %g thin", thin), [=](T u, T v) {
            const T r = std::sqrt(u);
            return Vec<T>{r * ((1 - v) * 2 + v * b), r * v * c, 1 - r};
        }).on(t, [density](Vec<T>) { return density; });
    }
}

template <class T>
void surfaces(Codes& codes) {
    const Family<T> add{codes, "densities of the plane"};
    struct Bell {
        T x, y, a, b;
    };
    for (const auto& c : {Bell{0, 0, 1, 1}, {0, 0, 1, T(0.1)}, {50, -20, T(0.01), T(0.01)}}) {
        const T x = c.x, y = c.y, a = c.a, b = c.b;
        add(say("normal at (%g, %g), widths %g and %g", x, y, a, b), [=](T u, T v) {
            const T r = std::sqrt(-2 * std::log(1 - u)), phi = 2 * pi<T> * v;
            return Pair<T>{x + a * r * std::cos(phi), y + b * r * std::sin(phi)};
        }).pdf([=](Pair<T> p) { return normal_pdf(p.first - x, a) * normal_pdf(p.second - y, b); });
    }
    add("normal by Marsaglia's disc", [](T u, T v) -> std::optional<Pair<T>> {
        const T x = 2 * u - 1, y = 2 * v - 1, s = x * x + y * y;
        if (s >= 1 || s == 0) return {};
        const T r = std::sqrt(-2 * std::log(s) / s);
        return Pair<T>{r * x, r * y};
    }).pdf([](Pair<T> p) { return pi<T> / 4 * normal_pdf(p.first) * normal_pdf(p.second); });
    add("r^-3 beyond 1", [](T u, T v) { return on_circle(1 / (1 - u), v); }).pdf([](Pair<T> p) {
        const T r = std::hypot(p.first, p.second);
        return r >= 1 ? 1 / (2 * pi<T> * r * r * r) : 0;
    });
    for (const T degrees : {T(1), T(2)})
        add(say("Student's t in the plane, %g degrees", degrees), [=](T u, T v) {
            return on_circle(std::sqrt(degrees * (std::pow(1 - u, -2 / degrees) - 1)), v);
        }).pdf([=](Pair<T> p) {
            const T s = square_of(p);
            return std::pow(1 + s / degrees, -1 - degrees / 2) / (2 * pi<T>);
        });
    add("tents", [](T u, T v) {
        auto tent = [](T x) {
            return x < T(0.5) ? std::sqrt(2 * x) - 1 : 1 - std::sqrt(2 - 2 * x);
        };
        return Pair<T>{tent(u), tent(v)};
    }).pdf([](Pair<T> p) {
        return std::max(T(0), 1 - std::abs(p.first)) * std::max(T(0), 1 - std::abs(p.second));
    });
    add("exponentials of rates 1 and 100", [](T u, T v) {
        return Pair<T>{-std::log1p(-u), -std::log1p(-v) / 100};
    }).pdf([](Pair<T> p) {
        return exponential_pdf(p.first, T(1)) * exponential_pdf(p.second, T(100));
    });
    add("normal of widths 1 and 1e-3, three numbers", [](T which, T u, T v) {
        const T width = which < T(0.5) ? 1 : T(1e-3);
        return on_circle(width * std::sqrt(-2 * std::log(1 - u)), v);
    }).pdf([](Pair<T> p) {
        return (normal_pdf(p.first) * normal_pdf(p.second) +
                normal_pdf(p.first, T(1e-3)) * normal_pdf(p.second, T(1e-3))) /
               2;
    });
    add("exponent of the radius, singular at 0", [](T u, T v) {
        return on_circle(u, v);
    }).pdf([](Pair<T> p) {
        const T r = std::hypot(p.first, p.second);
        return r > 0 && r <= 1 ? 1 / (2 * pi<T> * r) : 0;
    });
}

template <class T>
void squares(Codes& codes) {
    const Family<T> add{codes, "tables of the square"};
    const oracle::Square square;
    add("uniform", [](T u, T v) { return Pair<T>{u, v}; }).on(square, [](Pair<T>) { return T(1); });
    add("uniform, plane", [](T u, T v) {
        return Pair<T>{u, v};
    }).pdf([](Pair<T> p) {
        return p.first >= 0 && p.first < 1 && p.second >= 0 && p.second < 1 ? 1 : 0;
    });
    using Four = std::array<T, 4>;
    for (const Four& w : {Four{1, 2, 3, 4}, {0, 0, 0, 1}, {1, 0, 0, 100}, {1, 1, 1, 1}})
        add(say("bilinear, %g %g %g %g", w[0], w[1], w[2], w[3]), [w](T u, T v) {
            const T y = linear_sample(v, w[0] + w[1], w[2] + w[3]);
            return Pair<T>{linear_sample(u, (1 - y) * w[0] + y * w[2], (1 - y) * w[1] + y * w[3]),
                           y};
        }).on(square, [w](Pair<T> p) {
            const auto [x, y] = p;
            const T sum = (1 - y) * ((1 - x) * w[0] + x * w[1]) + y * ((1 - x) * w[2] + x * w[3]);
            return 4 * sum / (w[0] + w[1] + w[2] + w[3]);
        });
    auto table = [&](const std::string& name, size_t width, const std::vector<double>& weights,
                     const auto&... domain) {
        add.both(name, Tiles<T>(width, weights), domain...);
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
    add("diagonal strip", [](T u, T v) {
        const T x = u + (v - T(0.5)) / 5;
        return Pair<T>{u, x - std::floor(x)};
    }).on(square, [](Pair<T> p) {
        const T d = p.second - p.first;
        const T off = std::abs(d - std::round(d));
        return off <= T(0.1) ? 5 : 0;
    });
}

// ---- More dimensions ----------------------------------------------------------------------------

template <class T, size_t D>
using Point = std::array<T, D>;

template <size_t D>
oracle::Box<D> cube(double a, double b) {
    oracle::Box<D> box;
    box.lower.fill(a), box.upper.fill(b);
    return box;
}

// A function of a point, as one of D numbers.
template <class T, size_t D, class F>
auto of_numbers(const F& f) {
    return function_of<decltype(f(Point<T, D>())), T>(
        [f](auto... u) { return f(Point<T, D>{u...}); }, std::make_index_sequence<D>());
}

template <class T, size_t D>
void products(Codes& codes) {
    const Family<T> add{codes, "boxes"};
    // A density of each coordinate, and numbers that have it.
    auto product = [&](const char* name, const oracle::Box<D>& box, auto sample, auto pdf) {
        add(say("%zu dimensions, %s", D, name), of_numbers<T, D>([=](Point<T, D> x) {
                for (T& c : x) c = sample(c);
                return x;
            }))
            .on(box, [=](const Point<T, D>& x) {
                T density = 1;
                for (T c : x) density *= pdf(c);
                return density;
            });
    };
    product(
        "uniform", cube<D>(-1, 2), [](T u) { return 3 * u - 1; }, [](T) { return 1 / T(3); });
    product(
        "linear", cube<D>(0, 1), [](T u) { return std::sqrt(u); }, [](T x) { return 2 * x; });
    product(
        "exponential", cube<D>(0, 4), [](T u) { return -std::log1p(u * std::expm1(T(-4))); },
        [](T x) { return std::exp(-x) / -std::expm1(T(-4)); });
    const Steps<T> steps{Table<T>({1, 0, 5, 2})};
    product(
        "steps", cube<D>(0, 1), [steps](T u) { return steps.sample(u); },
        [steps](T x) { return steps.pdf(x); });
}

template <class T, size_t D>
void simplex(Codes& codes) {
    T factorial = 1;
    for (size_t i = 2; i <= D; ++i) factorial *= T(i);
    auto pdf = [factorial](const Point<T, D>& x) {
        return std::is_sorted(x.begin(), x.end()) ? factorial : T(0);
    };
    const Family<T> add{codes, "boxes"};
    add(say("%zu dimensions, simplex by sorting", D), of_numbers<T, D>([](Point<T, D> x) {
            std::sort(x.begin(), x.end());
            return x;
        }))
        .on(cube<D>(0, 1), pdf);
}

template <class T>
void balls(Codes& codes) {
    const Family<T> add{codes, "boxes"};
    auto ball = [](T density) {
        return [density](const auto& x) {
            T s = 0;
            for (T c : x) s += c * c;
            return s <= 1 ? density : T(0);
        };
    };
    add("3 dimensions, ball", [](T u, T v, T w) {
        const Vec<T> d = std::cbrt(w) * about_z(1 - 2 * u, v);
        return Point<T, 3>{d.x, d.y, d.z};
    }).on(cube<3>(-1, 1), ball(3 / (4 * pi<T>)));
    add("4 dimensions, ball", [](T u, T v, T w, T s) {
        const T r = std::sqrt(std::sqrt(s)), a = r * std::sqrt(u), b = r * std::sqrt(1 - u);
        const auto [x, y] = on_circle(a, v);
        const auto [z, t] = on_circle(b, w);
        return Point<T, 4>{x, y, z, t};
    }).on(cube<4>(-1, 1), ball(2 / (pi<T> * pi<T>)));
    using Five = Point<T, 5>;
    add("5 dimensions, ball by rejection", of_numbers<T, 5>([](Five x) -> std::optional<Five> {
            T s = 0;
            for (T& k : x) k = 2 * k - 1, s += k * k;
            if (s > 1) return {};
            return x;
        }))
        .on(cube<5>(-1, 1), ball(T(1) / 32));
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
