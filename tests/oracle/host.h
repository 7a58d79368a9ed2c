// oracle/host.h  appendix: the vectors, samplers and densities of calling code, read without their
// types
#pragma once
#include "checks.h"

namespace oracle::detail {

template <size_t N>
auto elements(const auto& at) {
    return [&]<size_t... I>(std::index_sequence<I...>) {
        return std::array{at(std::integral_constant<size_t, I>())...};
    }
    (std::make_index_sequence<N>());
}
// A vector may be smaller than three of its elements.
template <class V, class Element>
constexpr size_t size_of = sizeof(V) == 2 * sizeof(Element) ? 2 : 3;

// The coordinates of a number, pair, array, vector or colour, in its own type.
template <class V>
auto coordinates(const V& v) {
    if constexpr (std::is_arithmetic_v<V>)
        return std::array{v};
    else if constexpr (requires { V::SizeAtCompileTime; })
        return elements<size_t(V::SizeAtCompileTime)>([&](auto i) { return v[long(i())]; });
    else if constexpr (requires { v.x() + v.y() + v.z(); })
        return std::array{v.x(), v.y(), v.z()};
    else if constexpr (requires { v.x + v.y + v.z; })
        return std::array{v.x, v.y, v.z};
    else if constexpr (requires { v.X + v.Y + v.Z; })
        return std::array{v.X, v.Y, v.Z};
    else if constexpr (requires { v.getX() + v.getY() + v.getZ(); })
        return std::array{v.getX(), v.getY(), v.getZ()};
    else if constexpr (requires { v.r + v.g + v.b; })
        return std::array{v.r, v.g, v.b};
    else if constexpr (requires { v.x() + v.y(); })
        return std::array{v.x(), v.y()};
    else if constexpr (requires { v.x + v.y; })
        return std::array{v.x, v.y};
    else if constexpr (requires { v.X + v.Y; })
        return std::array{v.X, v.Y};
    else if constexpr (requires { v.real() + v.imag(); })
        return std::array{v.real(), v.imag()};
    else if constexpr (requires { std::tuple_size<V>::value; })
        return std::apply([](auto... c) { return std::array{c...}; }, v);
    else if constexpr (requires { v[size_t()] + v[size_t()]; })
        return elements<size_of<V, std::decay_t<decltype(v[size_t()])>>>(
            [&](auto i) { return v[decltype(i)::value]; });
    else if constexpr (requires { v(0) + v(0); })
        return elements<size_of<V, std::decay_t<decltype(v(0))>>>(
            [&](auto i) { return v(int(i())); });
    else {
        static_assert(
            !sizeof(V),
            "the oracle cannot read the coordinates of this vector: give it x, y, z, or []");
        return std::array{0.0};
    }
}
template <class V>
using Coordinates = decltype(detail::coordinates(std::declval<const V&>()));
template <class V>
constexpr size_t coordinates_of() {
    return std::tuple_size_v<Coordinates<V>>;
}

template <class V>
auto point(const V& v) {
    Point<coordinates_of<V>()> p;
    const Coordinates<V> own = detail::coordinates(v);
    for (size_t k = 0; k < p.size(); ++k) p[k] = double(own[k]);
    return p;
}
template <class V, size_t... I>
V of_host(const auto& c, std::index_sequence<I...>) {
    using T = Coordinate<V>;
    if constexpr (requires { V{T(c[I])...}; })
        return V{T(c[I])...};
    else if constexpr (requires { V(T(c[I])...); })
        return V(T(c[I])...);
    else {
        V v{};
        if constexpr (requires { v[size_t()] = T(); })
            ((v[I] = T(c[I])), ...);
        else if constexpr (requires { v(int()) = T(); })
            ((v(int(I)) = T(c[I])), ...);
        else
            static_assert(!sizeof(V),
                          "the oracle cannot make this vector from its coordinates: give it a "
                          "constructor of them");
        return v;
    }
}
template <class V, size_t N>
V of_host(const Point<N>& c) {
    return detail::of_host<V>(c, std::make_index_sequence<N>());
}

// The numbers of an array; of colours, their channels, one after the other.
template <class Array>
std::vector<double> numbers_in(const Array& array) {
    static_assert(
        requires { std::size(array); },
        "a check does not know where this array ends: pass std::span(pointer, length)");
    std::vector<double> numbers;
    for (size_t i = 0; i < std::size(array); ++i)
        if constexpr (requires { double(array[i]); })
            numbers.push_back(double(array[i]));
        else if constexpr (requires { double(array[i][i]) + double(std::size(array[i])); })
            for (double x : detail::numbers_in(array[i])) numbers.push_back(x);
        else
            for (double x : detail::point(array[i])) numbers.push_back(x);
    return numbers;
}

// f takes numbers of type A as they are, or one argument that {them} initialises.  Braces do not
// convert a double to a float, and so tell which of the two f wants.
enum class Taken { not_at_all, exactly, converted, in_braces };
template <class F, class A, size_t... I>
constexpr Taken taken(std::index_sequence<I...>) {
    if (requires(F & f, A a) { f({((void)I, a)}...); }) return Taken::exactly;
    if (requires(F & f, A a) { f(((void)I, a)...); }) return Taken::converted;
    if (requires(F & f, A a) { f({((void)I, a)...}); }) return Taken::in_braces;
    return Taken::not_at_all;
}
template <class F, class A, size_t D>
constexpr Taken takes = detail::taken<F, A>(std::make_index_sequence<D>());

// call() converts them to float: 1 - 2^-54 would become 1.
template <class F, size_t D>
constexpr bool takes_floats = takes<F, double, D> != Taken::exactly &&
                              (takes<F, float, D> == Taken::exactly ||
                               takes<F, double, D> == Taken::not_at_all);

template <class F, size_t D>
auto call(F& f, const Point<D>& u) {
    return [&]<size_t... I>(std::index_sequence<I...>) {
        using A = std::conditional_t<takes_floats<F, D>, float, double>;
        if constexpr (takes<F, A, D> == Taken::in_braces)
            return f({A(u[I])...});
        else
            return f(A(u[I])...);
    }
    (std::make_index_sequence<D>());
}

// The number of arguments of f; 0 if it draws by itself.
template <class F, size_t D = 8>
constexpr size_t numbers_of() {
    if constexpr (D == 0 || takes<F, double, D> != Taken::not_at_all ||
                  takes<F, float, D> == Taken::in_braces)
        return D;
    else
        return numbers_of<F, D - 1>();
}

// A sampler may return nothing: an optional or a pointer.
template <class R>
constexpr bool may_fail = requires(const R& r) {
    r ? *r : *r;
};
template <class R>
const auto& arrived(const R& r) {
    if constexpr (may_fail<R>)
        return *r;
    else
        return r;
}

// What a sampler returns may have parts: a point or direction, a density, a value.  They are
// members of these names, or elements of a tuple or pair: its first that is no number has the
// point, its first number is the density.  A tuple of numbers alone is a point.
template <class R, class Get, class... More>
constexpr auto member_of(const R& r, Get get, More... more) {
    if constexpr (requires { get(r); })
        return &get(r);
    else if constexpr (sizeof...(More) > 0)
        return detail::member_of(r, more...);
    else
        return nullptr;
}
#define ORACLE_MEMBER(name)                                                 \
    [](const auto& r) -> const auto& requires requires {                    \
        r.name;                                                             \
        requires !std::is_pointer_v<std::remove_cvref_t<decltype(r.name)>>; \
    }                                                                       \
    { return r.name; }
template <class R>
constexpr auto direction_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(wi), ORACLE_MEMBER(wo), ORACLE_MEMBER(direction),
                             ORACLE_MEMBER(dir), ORACLE_MEMBER(w), ORACLE_MEMBER(point));
}
template <class R>
constexpr auto density_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(pdf), ORACLE_MEMBER(prob),
                             ORACLE_MEMBER(probability));
}
template <class R>
constexpr auto f_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(f), ORACLE_MEMBER(value), ORACLE_MEMBER(eval),
                             ORACLE_MEMBER(bsdf), ORACLE_MEMBER(brdf));
}
template <class R>
constexpr auto weight_of(const R& r) {
    return detail::member_of(r, ORACLE_MEMBER(weight), ORACLE_MEMBER(throughput),
                             ORACLE_MEMBER(attenuation));
}
#undef ORACLE_MEMBER
template <class Pointer>
constexpr bool found = !std::is_null_pointer_v<Pointer>;

// The k-th element of a tuple that is a number with a point, or that is none: flags, indices and
// enumerators are neither.  The tuple's size if there is no such.
template <class T, bool number>
constexpr bool is_kind =
    number ? std::is_floating_point_v<T> : !std::is_arithmetic_v<T> && !std::is_enum_v<T>;
template <class R, bool number>
constexpr size_t element(size_t k) {
    return []<size_t... I>(std::index_sequence<I...>, size_t k) {
        const bool is[] = {is_kind<std::decay_t<std::tuple_element_t<I, R>>, number>...};
        size_t i = 0;
        while (i < sizeof...(I) && (!is[i] || k-- > 0)) ++i;
        return i;
    }
    (std::make_index_sequence<std::tuple_size_v<R>>(), k);
}
template <class R>
constexpr bool is_tuple() {
    if constexpr (requires(const R& r) { std::tuple_size<R>::value, r[0]; })
        return false;  // an array
    else if constexpr (requires { std::tuple_size<R>::value; })
        return element<R, false>(0) < std::tuple_size_v<R>;
    else
        return false;
}
template <size_t I, class R>
constexpr auto at_index(const R& r) {
    if constexpr (I < std::tuple_size_v<R>)
        return &std::get<I>(r);
    else
        return nullptr;
}

// A structure with a direction, or a point and its density.
template <class R>
constexpr bool has_parts = requires(const R& r) {
    detail::point(*detail::direction_of(r));
    requires !std::is_arithmetic_v<std::decay_t<decltype(*detail::direction_of(r))>> ||
        found<decltype(detail::density_of(r))>;
};
template <class R>
const auto& beside(const R& r) {
    if constexpr (is_tuple<R>())
        return std::get<element<R, false>(0)>(r);
    else
        return r;
}
template <class R>
const auto& point_in(const R& r) {
    const auto& parts = detail::beside(r);
    if constexpr (has_parts<std::decay_t<decltype(parts)>>)
        return *detail::direction_of(parts);
    else
        return parts;
}
template <class R>
auto pdf_in(const R& r) {
    using Parts = std::decay_t<decltype(detail::beside(r))>;
    if constexpr (has_parts<Parts> &&
                  found<decltype(detail::density_of(std::declval<const Parts&>()))>)
        return detail::density_of(detail::beside(r));
    else if constexpr (is_tuple<R>())
        return at_index<element<R, true>(0)>(r);
    else
        return nullptr;
}
// A value without a name: the second that is no number, or else the number after the density.
template <class R>
auto unnamed_in(const R& r) {
    if constexpr (!is_tuple<R>())
        return nullptr;
    else if constexpr (element<R, false>(1) < std::tuple_size_v<R>)
        return at_index<element<R, false>(1)>(r);
    else
        return at_index<element<R, true>(
            found<decltype(detail::density_of(detail::beside(r)))> ? 0 : 1)>(r);
}

// An index, alone or with its probability: a pair, a tuple, or a structure.
template <class R>
long long index_in(const R& r) {
    if constexpr (requires { static_cast<long long>(r); })
        return static_cast<long long>(r);
    else if constexpr (requires { std::get<0>(r); })
        return static_cast<long long>(std::get<0>(r));
    else {
        static_assert(
            requires { static_cast<long long>(r.index); },
            "choose returns an index, a pair or tuple of it and its probability, or a structure "
            "with index and pdf");
        return static_cast<long long>(r.index);
    }
}
template <class R>
auto probability_in(const R& r) {
    if constexpr (requires { std::get<1>(r); })
        return &std::get<1>(r);
    else
        return detail::density_of(r);
}

template <class Choose, class Probability>
auto chooser(Choose& choose, Probability& probability) {
    constexpr size_t M = numbers_of<Choose>();
    using R = decltype(detail::call(choose, Point<M>{}));
    using Said = decltype(detail::probability_in(std::declval<const R&>()));
    return Model<M, 1>{[&choose](const Point<M>& u) -> std::optional<Drawn<1>> {
                           const R r = detail::call(choose, u);
                           Drawn<1> drawn{Point<1>{double(detail::index_in(r))},
                                          std::numeric_limits<double>::quiet_NaN()};
                           if constexpr (found<Said>)
                               drawn.pdf = double(*detail::probability_in(r));
                           return drawn;
                       },
                       [&probability](const Point<1>& i) { return double(probability(int(i[0]))); },
                       found<Said>,
                       false,
                       takes_floats<Choose, M>,
                       unit_of(std::remove_cv_t<std::remove_pointer_t<Said>>{}),
                       unit_of(decltype(probability(0)){})};
}

// A vector of numbers, of a number or a colour.
template <class V>
std::vector<double> channels(const V& v) {
    const auto p = detail::point(v);
    return {p.begin(), p.end()};
}
template <class Sample, size_t M>
std::optional<Brought> brought(Sample& sample, const Point<M>& u) {
    const auto raw = detail::call(sample, u);
    if constexpr (may_fail<std::decay_t<decltype(raw)>>)
        if (!raw) return {};
    const auto& r = detail::arrived(raw);
    const auto& parts = detail::beside(r);
    Brought b{detail::point(detail::point_in(r)), {}, {}, {}};
    if constexpr (has_parts<std::decay_t<decltype(parts)>>) {
        if constexpr (found<decltype(detail::f_of(parts))>)
            b.f = detail::channels(*detail::f_of(parts));
        if constexpr (found<decltype(detail::weight_of(parts))>)
            b.weight = detail::channels(*detail::weight_of(parts));
    }
    if constexpr (found<decltype(detail::unnamed_in(r))>)
        b.unnamed = detail::channels(*detail::unnamed_in(r));
    return b;
}

template <class Sample, class Pdf>
auto model(Sample& sample, Pdf& pdf) {
    constexpr size_t M = numbers_of<Sample>();
    static_assert(
        M > 0 || requires { sample(); },
        "sample takes numbers u, v, ... (in expect_bsdf after wo), one argument made from {u, v, "
        "...}, or nothing; "
        "after random come sample, then pdf");
    using Raw = decltype(detail::call(sample, Point<M>{}));
    using Arrived = std::decay_t<decltype(detail::arrived(std::declval<const Raw&>()))>;
    using V = std::decay_t<decltype(detail::point_in(std::declval<const Arrived&>()))>;
    constexpr bool says_pdf = found<decltype(detail::pdf_in(std::declval<const Arrived&>()))>;
    constexpr size_t N = coordinates_of<V>();
    using T = Coordinate<V>;
    static_assert(
        requires { double(pdf(of_host<V>(Point<N>{}))); },
        "pdf takes the point or direction that sample returns, and returns a number; after random "
        "come sample, then pdf");
    return Model<M, N>{[&sample](const Point<M>& u) -> std::optional<Drawn<N>> {
                           const Raw r = detail::call(sample, u);
                           if constexpr (may_fail<Raw>)
                               if (!r) return {};
                           const auto& here = detail::arrived(r);
                           Drawn<N> drawn{detail::point(detail::point_in(here)),
                                          std::numeric_limits<double>::quiet_NaN()};
                           if constexpr (says_pdf) drawn.pdf = double(*detail::pdf_in(here));
                           return drawn;
                       },
                       [&pdf](const Point<N>& x) { return double(pdf(of_host<V>(x))); },
                       says_pdf,
                       std::is_same_v<T, float>,
                       takes_floats<Sample, M>,
                       unit_of(T{}),
                       unit_of(decltype(pdf(of_host<V>(Point<N>{}))){})};
}

}  // namespace oracle::detail
