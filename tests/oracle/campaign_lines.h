// oracle/campaign_lines.h  numbers: slopes, tails, peaks far from 0, steps, and choices
#pragma once
#include "campaign.h"

namespace campaign {

template <class T>
T linear_sample(T u, T a, T b) {
    if (a + b == 0) return u;  // pbrt-v4 has no such line, and 0 / 0 there
    return u == 0 && a == 0 ? 0 : u * (a + b) / (a + std::sqrt((1 - u) * a * a + u * b * b));
}
template <class T>
T linear_pdf(T x, T a, T b) {
    return x >= 0 && x <= 1 ? 2 * ((1 - x) * a + x * b) / (a + b) : 0;
}

template <class T>
void slopes(Codes& codes) {
    const Family<T> add{codes, "slopes and curves"};
    for (const auto& c : {std::pair<T, T>{0, 1}, {5, 0}, {1, 3}, {1, T(1.002)}}) {
        const T a = c.first, b = c.second;
        add(say("linear, %g to %g", a, b), [a, b](T u) {
            return linear_sample(u, a, b);
        }).pdf([a, b](T x) { return linear_pdf(x, a, b); });
    }
    for (const T r : {T(0.1), T(2)})
        add(say("tent of radius %g", r), [r](T u) {
            return u < T(0.5) ? r * (linear_sample(2 * u, T(0), T(1)) - 1)
                              : r * linear_sample(2 * u - 1, T(1), T(0));
        }).pdf([r](T x) { return std::max(T(0), 1 - std::abs(x) / r) / r; });
    add("tent from 1 over 1.2 to 5", [](T u) {
        const T border = T(0.05);
        return u < border ? 1 + T(0.2) * std::sqrt(u / border)
                          : 5 - T(3.8) * std::sqrt((1 - u) / (1 - border));
    }).pdf([](T x) {
        if (x < 1 || x > 5) return T(0);
        return (x < T(1.2) ? (x - 1) / T(0.2) : (5 - x) / T(3.8)) / 2;
    });
    for (const T s : {T(0.1), T(3)})
        add(say("logistic, s = %g", s), [s](T u) {
            return -s * std::log(1 / positive(u) - 1);
        }).pdf([s](T x) {
            const T e = std::exp(-std::abs(x) / s);
            return e / (s * (1 + e) * (1 + e));
        });
    add("logistic, trimmed to (-1, 2)", [](T u) {
        const T low = 1 / (1 + std::exp(T(2))), high = 1 / (1 + std::exp(T(-4)));
        return T(-0.5) * std::log(1 / (low + u * (high - low)) - 1);
    }).pdf([](T x) {
        if (x < -1 || x > 2) return T(0);
        const T low = 1 / (1 + std::exp(T(2))), high = 1 / (1 + std::exp(T(-4)));
        const T e = std::exp(-2 * std::abs(x));
        return 2 * e / ((1 + e) * (1 + e) * (high - low));
    });
    for (const auto& c : {std::pair<T, T>{0, 1}, {-2, 5}}) {
        const T a = c.first, b = c.second;
        add(say("smoothstep from %g to %g", a,
                b),  // The density 2 (3 t^2 - 2 t^3) has the distribution 2 t^3 - t^4.
            [a, b](T u) {
                double low = 0, high = 1;
                for (int i = 0; i < 50; ++i) {
                    const double t = (low + high) / 2;
                    (t * t * t * (2 - t) < double(u) ? low : high) = t;
                }
                return a + T(low) * (b - a);
            })
            .pdf([a, b](T x) {
                const T t = (x - a) / (b - a);
                return t >= 0 && t <= 1 ? 2 * t * t * (3 - 2 * t) / (b - a) : 0;
            });
    }
    add("derivative of smoothstep", [](T u) {
        return T(0.5) - std::sin(std::asin(1 - 2 * u) / 3);
    }).pdf([](T x) { return x >= 0 && x <= 1 ? 6 * x * (1 - x) : 0; });
    add("visible wavelengths by their sensitivity", [](T u) {
        const T low = std::tanh(T(0.0072) * (360 - 538)), high = std::tanh(T(0.0072) * (830 - 538));
        return 538 + std::atanh(low + u * (high - low)) / T(0.0072);
    }).pdf([](T x) {
        if (x < 360 || x > 830) return T(0);
        const T low = std::tanh(T(0.0072) * (360 - 538)), high = std::tanh(T(0.0072) * (830 - 538));
        const T c = std::cosh(T(0.0072) * (x - 538));
        return T(0.0072) / ((high - low) * c * c);
    });
    struct Segment {
        T d, a, b;
    };
    for (const auto& c : {Segment{1, -2, 3}, {T(0.05), -1, 4}, {2, 10, 30}}) {
        const T d = c.d, a = c.a, b = c.b;
        add(say("equi-angular, %g away, (%g, %g)", d, a, b), [=](T u) {
            const T low = std::atan(a / d), high = std::atan(b / d);
            return d * std::tan(low + u * (high - low));
        }).pdf([=](T x) {
            if (x < a || x > b) return T(0);
            return d / ((std::atan(b / d) - std::atan(a / d)) * (d * d + x * x));
        });
    }
    for (const T k : {T(-0.5), T(0.5), T(3), T(20)})
        add(say("x to the power of %g", k), [k](T u) {
            return std::pow(u, 1 / (k + 1));
        }).pdf([k](T x) { return x > 0 && x <= 1 ? (k + 1) * std::pow(x, k) : 0; });
    add("arcsine", [](T u) {
        const T s = std::sin(pi<T> / 2 * u);
        return s * s;
    }).pdf([](T x) { return x > 0 && x < 1 ? 1 / (pi<T> * std::sqrt(x * (1 - x))) : 0; });
    add("middle one of three numbers", [](T a, T b, T c) {
        return std::max(std::min(a, b), std::min(std::max(a, b), c));
    }).pdf([](T x) { return x >= 0 && x <= 1 ? 6 * x * (1 - x) : 0; });
}

template <class T>
T exponential_pdf(T x, T rate) {
    return x >= 0 ? rate * std::exp(-rate * x) : 0;
}

template <class T>
void exponentials(Codes& codes) {
    const Family<T> add{codes, "exponentials"};
    for (const T rate : {T(1e-3), T(1), T(1e3)})
        add(say("rate %g", rate), [rate](T u) { return -std::log1p(-u) / rate; }).pdf([rate](T x) {
            return exponential_pdf(x, rate);
        });
    for (const auto& c : {std::pair<T, T>{1, 3}, {T(0.01), 5}, {20, 2}}) {
        const T rate = c.first, end = c.second;
        auto sample = [=](T u) { return -std::log1p(u * std::expm1(-rate * end)) / rate; };
        auto pdf = [=](T x) {
            return x <= end ? exponential_pdf(x, rate) / -std::expm1(-rate * end) : 0;
        };
        add(say("rate %g, trimmed at %g, line", rate, end), sample).pdf(pdf);
        add(say("rate %g, trimmed at %g, interval", rate, end), sample)
            .on(oracle::Interval(0, double(end)), pdf);
    }
    add("Laplace", [](T u) {
        return u < T(0.5) ? std::log(2 * positive(u)) : -std::log(2 * (1 - u));
    }).pdf([](T x) { return std::exp(-std::abs(x)) / 2; });
    add("sum of two", [](T u, T v) { return -std::log((1 - u) * (1 - v)); }).pdf([](T x) {
        return x > 0 ? x * std::exp(-x) : 0;
    });
}

template <class T>
void tails(Codes& codes) {
    const Family<T> add{codes, "heavy tails"};
    for (const auto& c : {std::pair<T, T>{0, 1}, {T(1e3), T(0.01)}, {-5, 100}}) {
        const T at = c.first, width = c.second;
        add(say("Cauchy at %g, width %g", at, width), [=](T u) {
            return at + width * std::tan(pi<T> * (u - T(0.5)));
        }).pdf([=](T x) {
            const T t = (x - at) / width;
            return 1 / (pi<T> * width * (1 + t * t));
        });
    }
    for (const T k : {T(0.3), T(0.5), T(1.1), T(3)})
        add(say("Pareto %g", k), [k](T u) { return std::pow(1 - u, -1 / k); }).pdf([k](T x) {
            return x >= 1 ? k * std::pow(x, -k - 1) : 0;
        });
    for (const T sigma : {T(0.5), T(1), T(3)})
        add(say("lognormal, sigma = %g", sigma), [sigma](T u, T v) {
            return std::exp(sigma * normal(u, v));
        }).pdf([sigma](T x) { return x > 0 ? normal_pdf(std::log(x), sigma) / x : 0; });
    add("Student's t, 2 degrees", [](T u) {
        const T w = positive(u);
        return (2 * w - 1) / std::sqrt(2 * w * (1 - w));
    }).pdf([](T x) { return std::pow(2 + x * x, T(-1.5)); });
    for (const T k : {T(0.3), T(0.6), T(4)})
        add(say("stretched exponential, %g", k), [k](T u) {
            return std::pow(-std::log1p(-positive(u)), 1 / k);
        }).pdf([k](T x) { return x > 0 ? k * std::pow(x, k - 1) * std::exp(-std::pow(x, k)) : 0; });
    add("Gumbel", [](T u) { return -std::log(-std::log(positive(u))); }).pdf([](T x) {
        return std::exp(-x - std::exp(-x));
    });
    add("Levy", [](T u, T v) {
        const T x = normal(u, v);
        return 1 / (x * x + T(1e-30));
    }).pdf([](T x) {
        return x > 0 ? std::exp(-1 / (2 * x)) / std::sqrt(2 * pi<T>) / (x * std::sqrt(x)) : 0;
    });
    add("1 / x from 1e-6 to 1e6, line", [](T u) {
        return T(1e-6) * std::exp(u * std::log(T(1e12)));
    }).pdf([](T x) { return x >= T(1e-6) && x <= T(1e6) ? 1 / (x * std::log(T(1e12))) : 0; });
    add("1 / x^2 from 1 to 100, interval", [](T u) {
        return 1 / (1 - u * T(0.99));
    }).on(oracle::Interval(1, 100), [](T x) {
        return x >= 1 && x <= 100 ? 1 / (T(0.99) * x * x) : 0;
    });
}

template <class T>
void peaks(Codes& codes) {
    const Family<T> add{codes, "peaks, mixtures of scales"};
    struct Peak {
        T at, width;
    };
    for (const auto& c : {Peak{0, 1}, {T(1e4), 1}, {-50, T(1e-3)}}) {
        const T at = c.at, width = c.width;
        add(say("normal at %g, width %g", at, width), [=](T u, T v) {
            return at + width * normal(u, v);
        }).pdf([=](T x) { return normal_pdf(x - at, width); });
    }
    add("uniform from 1000 to 1001, line", [](T u) { return 1000 + u; }).pdf([](T x) {
        return x >= 1000 && x <= 1001 ? 1 : 0;
    });
    if constexpr (std::is_same_v<T, double>) {
        add("normal at 1e6, width 1e-3", [](T u, T v) {
            return 1e6 + 1e-3 * normal(u, v);
        }).pdf([](T x) { return normal_pdf(x - 1e6, 1e-3); });
        add("logistic at 1e8, width 0.1", [](T u) {
            return 1e8 - 0.1 * std::log(1 / positive(u) - 1);
        }).pdf([](T x) {
            const T e = std::exp(-std::abs(x - 1e8) / 0.1);
            return e / (0.1 * (1 + e) * (1 + e));
        });
    }
    add("exponentials of rates 1 and 1e4", [](T u) {
        return u < T(0.5) ? -std::log1p(-2 * u) : -std::log1p(-(2 * u - 1)) / T(1e4);
    }).pdf([](T x) { return (exponential_pdf(x, T(1)) + exponential_pdf(x, T(1e4))) / 2; });
    add("normal of widths 1 and 1e-3, three numbers", [](T which, T u, T v) {
        return (which < T(0.3) ? 1 : T(1e-3)) * normal(u, v);
    }).pdf([](T x) { return T(0.3) * normal_pdf(x) + T(0.7) * normal_pdf(x, T(1e-3)); });
    add("two peaks 1000 apart", [](T u, T v) {
        return u < T(0.2) ? normal(5 * u, v) : 1000 + normal((u - T(0.2)) / T(0.8), v);
    }).pdf([](T x) { return T(0.2) * normal_pdf(x) + T(0.8) * normal_pdf(x - 1000); });
    add("free paths: half stop at a wall", [](T u) -> std::optional<T> {
        const T t = -std::log1p(-u);
        if (t > T(0.693147)) return {};
        return t;
    }).pdf([](T x) { return x <= T(0.693147) ? exponential_pdf(x, T(1)) : 0; });
}

// Weights as renderers have them: a few zeros, some much larger than others.
inline std::vector<double> unequal(size_t n, double largest) {
    std::vector<double> weights;
    for (size_t i = 0; i < n; ++i)
        weights.push_back(i % 6 == 4   ? 0
                          : i % 9 == 1 ? largest
                                       : 0.05 + std::fmod(double(i) * 0.61803, 1));
    return weights;
}

template <class T>
void steps(Codes& codes) {
    const Family<T> add{codes, "steps"};
    for (const auto& c : {std::pair<T, T>{0, 1}, {-3, 7}}) {
        const T a = c.first, b = c.second;
        auto sample = [=](T u) { return a + u * (b - a); };
        auto pdf = [=](T x) { return x >= a && x <= b ? 1 / (b - a) : 0; };
        add(say("uniform from %g to %g, line", a, b), sample).pdf(pdf);
        add(say("uniform from %g to %g, interval", a, b), sample)
            .on(oracle::Interval(double(a), double(b)), pdf);
    }
    for (const size_t n : {1, 2, 3, 7, 16, 64})
        for (const double largest : {1.0, 1000.0}) {
            if (n < 3 && largest > 1) continue;
            const Steps<T> s{Table<T>(unequal(n, largest))};
            const std::string name = say("%zu steps, up to %g, ", n, largest);
            add.both(name + "interval", s, oracle::Interval(0, 1));
            if (n == 7 || n == 64) add.both(name + "line", s);
        }
    add("comb of 16 teeth", [](T u) {
        const T tooth = std::floor(16 * u);
        return tooth + T(0.1) * (16 * u - tooth);
    }).pdf([](T x) {
        if (x < 0 || x >= 16) return T(0);
        return x - std::floor(x) <= T(0.1) ? T(0.625) : T(0);
    });
}

// An alias table (Vose 1991), which splits one number.
template <class T>
struct Alias {
    std::vector<T> keep, probability;
    std::vector<int> other;
    explicit Alias(const std::vector<double>& weights) : other(weights.size()) {
        double total = 0;
        for (double w : weights) total += w;
        std::vector<double> part;
        for (double w : weights) {
            probability.push_back(T(w / total));
            part.push_back(w / total * double(weights.size()));
        }
        std::vector<size_t> small, large;
        for (size_t i = 0; i < part.size(); ++i) (part[i] < 1 ? small : large).push_back(i);
        keep.assign(part.size(), 1);
        while (!small.empty() && !large.empty()) {
            const size_t s = small.back(), l = large.back();
            small.pop_back();
            keep[s] = T(part[s]);
            other[s] = int(l);
            part[l] -= 1 - part[s];
            if (part[l] < 1) large.pop_back(), small.push_back(l);
        }
    }
    int operator()(T u) const {
        const T x = u * T(keep.size());
        const size_t i = std::min(keep.size() - 1, size_t(x));
        return x - T(i) < keep[i] ? int(i) : other[i];
    }
};

template <class T>
void choices(Codes& codes) {
    const Family<T> add{codes, "choices"};
    for (const T p : {T(1e-3), T(0.3), T(0.5)})
        add(say("one of two, %g", p), [p](T u) { return u < p ? 0 : 1; }).chance(2, [p](int i) {
            return i == 0 ? p : 1 - p;
        });
    for (const int n : {3, 100})
        add(say("one of %d alike", n), [n](T u) {
            return std::min(n - 1, int(u * T(n)));
        }).chance(size_t(n), [n](int) { return 1 / T(n); });
    for (const size_t n : {3, 16, 64, 1000})
        for (const double largest : {1.0, 1e5}) {
            if (n == 3 && largest > 1) continue;
            const Table<T> table(unequal(n, largest));
            add(say("%zu weights up to %g, by their sums", n, largest), [table](T u) {
                return int(table.choose(u).first);
            }).chance(n, [table](int i) { return table.probability(size_t(i)); });
            const Alias<T> alias(unequal(n, largest));
            add(say("%zu weights up to %g, alias table", n, largest), alias)
                .chance(n, [alias](int i) { return alias.probability[size_t(i)]; });
        }
    add("roulette: number of the bounce", [](T u) {
        return std::min(19, int(std::log(1 - u) / std::log(T(0.7))));
    }).chance(20, [](int i) {
        return i < 19 ? T(0.3) * std::pow(T(0.7), T(i)) : std::pow(T(0.7), T(19));
    });
    add("one of three lobes, or none", [](T u) {
        return u < T(0.8) ? int(u / T(0.27)) : -1;
    }).chance(3, [](int i) { return i < 2 ? T(0.27) : T(0.26); });
}

template <class T>
void lines(Codes& codes) {
    slopes<T>(codes);
    exponentials<T>(codes);
    tails<T>(codes);
    peaks<T>(codes);
    steps<T>(codes);
}

}  // namespace campaign
