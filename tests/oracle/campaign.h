// oracle/campaign.h  right samplers and densities, each with its name, and a check by the oracle
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "oracle.h"
#include "textbook.h"

namespace campaign {

using oracle::say;
using textbook::pi;
using textbook::polar;
using textbook::Vec;

struct Code {
    std::string family, name;
    std::function<oracle::Verdict(oracle::Random&, const oracle::Options&)> check;
    double tolerance = 0;
};
using Codes = std::vector<Code>;

// Functions whose types are those of all samplers with these numbers: the checks are compiled once.
template <class R, class T, size_t... I, class F>
auto function_of(const F& f, std::index_sequence<I...>) {
    return std::function<R(decltype(static_cast<void>(I), T())...)>(f);
}

template <class Result>
struct PlaceOf {
    using type = Result;
};
template <class Place>
struct PlaceOf<std::optional<Place>> {
    using type = Place;
};

// A family of codes with numbers T: add(name, sample).pdf(density) adds a code to it.
template <class T>
struct Family {
    Codes& codes;
    std::string family;

    template <class Sample>
    auto operator()(const std::string& name, Sample sample) const {
        const char* number = std::is_same_v<T, float> ? ", float" : ", double";
        return Sampler<Sample>{codes, family, family + ": " + name + number, sample};
    }
    // An object that knows both.
    template <class Object, class... Domain>
    void both(const std::string& name, const Object& o, const Domain&... domain) const {
        (*this)(name, std::bind_front(&Object::sample, o))
            .pdf(std::bind_front(&Object::pdf, o), domain...);
    }

    template <class Sample>
    struct Sampler {
        Codes& codes;
        std::string family, name;
        Sample sample;

        // Samples are points, or nothing; on the domain, or on the usual one.
        template <class Pdf, class... Domain>
        void pdf(const Pdf& density, const Domain&... domain) const {
            constexpr size_t numbers = oracle::detail::numbers_of<Sample>();
            using Result = decltype(oracle::detail::call(sample, oracle::Point<numbers>{}));
            const auto sampler =
                function_of<Result, T>(sample, std::make_index_sequence<numbers>());
            const std::function<T(const typename PlaceOf<Result>::type&)> p = density;
            add([=](oracle::Random& random, const oracle::Options& options) {
                return oracle::expect_density(random, sampler, p, domain..., options);
            });
        }
        template <class Domain, class Pdf>
        void on(const Domain& domain, const Pdf& density) const {
            pdf(density, domain);
        }
        // Samples are choices of one of `count`.
        void chance(size_t count, const std::function<T(int)>& probability) const {
            const std::function<int(T)> choose = sample;
            add([=](oracle::Random& random, const oracle::Options& options) {
                return oracle::expect_choice(random, choose, probability, count, options);
            });
        }

    private:
        template <class Check>
        void add(const Check& check) const {
            codes.push_back({family, name, check});
        }
    };
};

// An orthonormal basis about z (Duff et al. 2017).
template <class T>
struct Frame {
    Vec<T> x, y, z;
    explicit Frame(Vec<T> n) : z(n) {
        const T sign = std::copysign(T(1), z.z), a = -1 / (sign + z.z), b = z.x * z.y * a;
        x = {1 + sign * z.x * z.x * a, sign * b, -sign * z.x};
        y = {b, sign + z.y * z.y * a, -z.y};
    }
    Vec<T> world(Vec<T> w) const { return w.x * x + w.y * y + w.z * z; }
    Vec<T> local(Vec<T> w) const { return {dot(w, x), dot(w, y), dot(w, z)}; }
};

// A number for logarithms and reciprocals.
template <class T>
T positive(T u) {
    return std::max(u, T(0x1p-30));
}

// The point at the part v of a circle.
template <class T>
std::pair<T, T> on_circle(T r, T v) {
    const T phi = 2 * pi<T> * v;
    return {r * std::cos(phi), r * std::sin(phi)};
}
// A direction of this cosine, likewise.
template <class T>
Vec<T> about_z(T cosine, T v) {
    return polar(cosine, 2 * pi<T> * v);
}

// Uniform in the unit disc, by polar coordinates, and by squares (Shirley, Chiu 1997).
template <class T>
std::pair<T, T> polar_disc(T u, T v) {
    return on_circle(std::sqrt(u), v);
}
template <class T>
std::pair<T, T> concentric_disc(T u, T v) {
    const T x = 2 * u - 1, y = 2 * v - 1;
    if (x == 0 && y == 0) return {0, 0};
    const bool wide = std::abs(x) > std::abs(y);
    const T r = wide ? x : y, phi = wide ? pi<T> / 4 * (y / x) : pi<T> / 2 - pi<T> / 4 * (x / y);
    return {r * std::cos(phi), r * std::sin(phi)};
}

// A normal number (Box, Muller 1958).
template <class T>
T normal(T u, T v) {
    return std::sqrt(-2 * std::log(1 - u)) * std::cos(2 * pi<T> * v);
}
template <class T>
T normal_pdf(T x, T sigma = 1) {
    return std::exp(-x * x / (2 * sigma * sigma)) / (sigma * std::sqrt(2 * pi<T>));
}

// Weights of a table, and the cell that a number falls into, with where in it.
template <class T>
struct Table {
    std::vector<T> sums = {0};
    explicit Table(const std::vector<double>& weights) {
        double total = 0, sum = 0;
        for (double w : weights) total += w;
        for (double w : weights) sums.push_back(T((sum += w) / total));
        sums.back() = 1;
        for (size_t i = size(); i-- > 0 && weights[i] == 0;) sums[i] = 1;
    }
    size_t size() const { return sums.size() - 1; }
    T probability(size_t i) const { return sums[i + 1] - sums[i]; }
    std::pair<size_t, T> choose(T u) const {
        const size_t i =
            size_t(std::upper_bound(sums.begin(), sums.end() - 1, u) - sums.begin()) - 1;
        const T part = (u - sums[i]) / probability(i);
        return {i, std::min(part, 1 - std::numeric_limits<T>::epsilon() / 2)};
    }
};

// Piecewise constant over the unit interval, and over the unit square, row by row.
template <class T>
struct Steps {
    Table<T> table;
    T sample(T u) const {
        const auto [i, part] = table.choose(u);
        return (T(i) + part) / T(table.size());
    }
    T pdf(T x) const {
        if (!(x >= 0 && x < 1)) return 0;
        const size_t i = std::min(table.size() - 1, size_t(x * T(table.size())));
        return table.probability(i) * T(table.size());
    }
};
template <class T>
struct Tiles {
    Steps<T> rows;
    std::vector<Steps<T>> columns;
    Tiles(size_t width, const std::vector<double>& weights) : rows{Table<T>({1.0})} {
        std::vector<double> sums;
        for (size_t i = 0; i < weights.size(); i += width) {
            std::vector<double> row(weights.begin() + long(i), weights.begin() + long(i + width));
            double sum = 0;
            for (double w : row) sum += w;
            if (sum == 0) row.assign(width, 1);  // never chosen
            columns.push_back({Table<T>(row)});
            sums.push_back(sum);
        }
        rows = {Table<T>(sums)};
    }
    size_t row(T y) const { return std::min(columns.size() - 1, size_t(y * T(columns.size()))); }
    std::pair<T, T> sample(T u, T v) const {
        const T y = rows.sample(v);
        return {columns[row(y)].sample(u), y};
    }
    T pdf(std::pair<T, T> p) const {
        const T density = rows.pdf(p.second);
        return density > 0 ? density * columns[row(p.second)].pdf(p.first) : 0;
    }
};

}  // namespace campaign
