// film/film.h  5  where samples gather
#pragma once
#include <atomic>
#include <mutex>
#include <optional>
#include <tuple>

#include "film/passes.h"
#include "film/pixels.h"

// A sample that no image can hold.
struct NonFinite {
    uint64_t sample = UINT64_MAX;
    int x = 0, y = 0;
    uint32_t set = 0;
};

// Pixels take their samples in order: the image is the same however passes and threads divide them.
// A pass adds in place, block by block; until it is complete the image and its error are those
// without it.  Each set of a pixel's samples is a Pixel of its own: it has a type Sample,
// add(i, sample) for sample i, fits(sample), whether that is finite and stays so in a file,
// spread(i, sample), by how much the squared distances of samples to their mean grow with sample i,
// noise(n, spread), the variance of the mean as n samples and the sum of that tell it, and a Value:
// value(pixel, n, channel) is what n samples say.
template <class Pixel>
class Film {
public:
    using Sample = typename Pixel::Sample;
    using Value = typename Pixel::Value;

    explicit Film(Size s, Value value = {}, Shows shows = Shows::values)
        : size(s),
          value_(value),
          shows_(shows),
          blocks_{size_t(s.width) * size_t(s.height)},
          next_terms_(blocks_.count()) {
        state_.first.assign(blocks_.pixels, Pixel());
        state_.spread.resize(blocks_.pixels);
        state_.others_of.resize(blocks_.count());
        state_.ahead.resize(blocks_.count());
        state_.terms.resize(blocks_.count());
        state_.image = Image(s.width, s.height);
    }

    const Size size;
    size_t number_of_pixels() const { return blocks_.pixels; }
    size_t blocks() const { return blocks_.count(); }
    uint64_t samples() const { return state_.samples; }  // of every set

    // Goes on from what another film of this size was, a complete pass or not: state() is that. Two
    // are never in memory at once.
    template <class State>
    void restore(State state) {
        state_ = {};
        state_ = state();
        state_.image.width = size.width, state_.image.height = size.height;
        state_.image.pixels.resize(number_of_pixels(), {NAN, NAN, NAN});
        count_others();
        for (size_t b = 0; b < blocks(); ++b)
            if (state_.ahead[b])
                next_terms_[b] = terms_of_block(b, samples() + state_.pass, true);
            else if (samples() > 0)
                state_.terms[b] = terms_of_block(b, samples(), others_are_complete());
    }

    // ---- Passes ----

    // Of a pass that was interrupted when some blocks had its samples.
    std::optional<uint64_t> unfinished_pass() const {
        const auto& ahead = state_.ahead;
        if (std::find(ahead.begin(), ahead.end(), true) == ahead.end()) return {};
        return state_.pass;
    }

    void begin_pass(uint64_t n) { state_.pass = n; }

    // n more samples for block b: L(x, y, i, set) is sample i of a set of pixel (x, y).  Sets that
    // were added since the last pass begin with sample 0.  Once `interrupted`, or if L throws, the
    // block stays as it was, and the pass must not end.
    template <class Radiance>
    void add_block(size_t b, uint64_t n, Radiance L) {
        if (state_.ahead[b]) return;
        Changed block = copy_of(b);
        for (size_t i = blocks_.begin(b), k = 0; i < blocks_.end(b); ++i)
            for (uint32_t set = 0; set < sets(i).count(); ++set) {
                const bool is_first = set == 0;
                Pixel& pixel = is_first ? block.first[i - blocks_.begin(b)] : block.others[k++];
                double* spread =
                    is_first && has_spread() ? &block.spread[i - blocks_.begin(b)] : nullptr;
                if (!add_samples(pixel, spread, i, set, n, L)) return;
            }
        develop(b);
        put_back(b, block);
        next_terms_[b] = terms_of_block(b, state_.samples + n, true);
        state_.ahead[b] = true;
    }

    // A block that nobody wrote has no number in any pixel, which is an error and no black dot.
    void end_pass(uint64_t n) {
        for (size_t b = 0; b < blocks(); ++b)
            if (!state_.ahead[b])
                for (size_t i = blocks_.begin(b); i < blocks_.end(b); ++i)
                    state_.first[i] = Pixel::unwritten();
        state_.terms = next_terms_;
        state_.ahead.assign(blocks(), false);
        state_.samples += n;
        state_.samples_of_others = state_.samples;
        state_.pass = 0;
    }

    // ---- Sets ----

    bool has_sets() const { return !state_.sets.empty(); }

    // From now on; once, between passes.  Until the next pass ends there is only the first of each.
    void add_sets(std::vector<Sets> sets) {
        state_.sets = std::move(sets);
        state_.sets_after = samples();
        state_.spread = std::vector<double>();  // with its memory
        state_.others.assign(count_others(), Pixel::unwritten());
        state_.samples_of_others = 0;
    }

    // What sets_where_noise_is() is told; with room for that of more pixels.
    std::vector<double> noise(size_t more = 0) const {
        std::vector<double> noise;
        noise.reserve(number_of_pixels() + more);
        for (size_t i = 0; i < number_of_pixels(); ++i)
            noise.push_back(state_.first[i].noise(samples(), state_.spread[i]));
        return noise;
    }

    double sets_per_pixel() const {
        const double others = others_are_complete() ? double(state_.others.size()) : 0;
        return 1 + others / double(number_of_pixels());
    }

    // Of pixel number `index`; pixel(index, set) is one of them.
    Sets sets(size_t index) const { return has_sets() ? state_.sets[index] : Sets{}; }
    bool others_are_complete() const { return has_sets() && state_.samples_of_others == samples(); }
    const Pixel& pixel(size_t index, uint32_t set) const {
        const size_t b = index / blocks_.size();
        size_t other = state_.others_of[b];
        for (size_t i = blocks_.begin(b); i < index; ++i) other += sets(i).count() - 1;
        return set > 0 ? state_.others[other + set - 1] : state_.first[index];
    }

    // ---- What it holds ----

    // How many samples did not fit, and the first of them.
    uint64_t non_finite() const { return non_finite_; }
    const NonFinite& first_non_finite() const { return first_non_finite_; }

    // After the last pass that was ended; NaN before the first.
    const Image& image() {
        for (size_t b = 0; b < blocks(); ++b)
            if (!state_.ahead[b]) develop(b);
        return state_.image;
    }
    Image take_image() {
        image();
        return std::move(state_.image);
    }
    ErrorTerms terms() const {
        ErrorTerms sum;
        for (const ErrorTerms& t : state_.terms) sum += t;
        return sum;
    }

    const Value& value() const { return value_; }
    const FilmState<Pixel>& state() const { return state_; }

private:
    const Value value_;
    const Shows shows_;
    const Blocks blocks_;
    FilmState<Pixel> state_;
    std::vector<ErrorTerms> next_terms_;  // of blocks that are ahead
    std::atomic<uint64_t> non_finite_ = 0;
    NonFinite first_non_finite_;
    std::mutex mutex_;

    // How many there are; notes where those of blocks begin.
    size_t count_others() {
        size_t others = 0;
        state_.others_of.resize(blocks());
        for (size_t b = 0; b < blocks(); ++b) {
            state_.others_of[b] = others;
            for (size_t i = blocks_.begin(b); i < blocks_.end(b); ++i)
                others += sets(i).count() - 1;
        }
        return others;
    }

    bool has_spread() const { return !state_.spread.empty(); }

    // ---- A block of a pass ----

    struct Changed {
        std::vector<Pixel> first, others;
        std::vector<double> spread;
    };
    size_t end_of_others(size_t b) const {
        return b + 1 < blocks() ? state_.others_of[b + 1] : state_.others.size();
    }
    Changed copy_of(size_t b) const {
        auto part = [](const auto& all, size_t from, size_t to) {
            return std::decay_t<decltype(all)>(all.begin() + ptrdiff_t(from),
                                               all.begin() + ptrdiff_t(to));
        };
        Changed c{part(state_.first, blocks_.begin(b), blocks_.end(b)),
                  part(state_.others, state_.others_of[b], end_of_others(b)),
                  {}};
        if (has_spread()) c.spread = part(state_.spread, blocks_.begin(b), blocks_.end(b));
        return c;
    }
    void put_back(size_t b, const Changed& c) {
        auto put = [](const auto& part, auto& all, size_t at) {
            std::copy(part.begin(), part.end(), all.begin() + ptrdiff_t(at));
        };
        put(c.first, state_.first, blocks_.begin(b));
        put(c.others, state_.others, state_.others_of[b]);
        if (has_spread()) put(c.spread, state_.spread, blocks_.begin(b));
    }

    // Answers false once `interrupted`.
    template <class Radiance>
    bool add_samples(Pixel& pixel, double* spread, size_t index, uint32_t set, uint64_t n,
                     Radiance& L) {
        const int x = int(index % size_t(size.width)), y = int(index / size_t(size.width));
        const uint64_t before = set > 0 ? state_.samples_of_others : state_.samples;
        if (before == 0) pixel = Pixel();
        for (uint64_t i = before; i < state_.samples + n; ++i) {
            if (interrupted) return false;
            const Sample value = L(x, y, i, set);
            if (!Pixel::fits(value)) report({i, x, y, set});
            if (spread) *spread += pixel.spread(i, value);
            pixel.add(i, value);
        }
        return true;
    }

    // Calls see(index, sets of that pixel) for the block's pixels; without others: of the first.
    template <class See>
    void look(size_t b, bool with_others, See see) const {
        const Pixel* others = state_.others.data() + state_.others_of[b];
        for (size_t i = blocks_.begin(b); i < blocks_.end(b); ++i) {
            const Sets all = with_others ? sets(i) : Sets{};
            see(i, SetsOfPixel<Pixel>{all, &state_.first[i], others});
            others += all.count() - 1;
        }
    }
    void develop(size_t b) {
        look(b, others_are_complete(), [&](size_t i, const auto& pixel) {
            state_.image.pixels[i] = picture_of(pixel, value_, samples(), shows_);
        });
    }
    ErrorTerms terms_of_block(size_t b, uint64_t n, bool with_others) const {
        ErrorTerms sum;
        look(b, with_others, [&](size_t, const auto& pixel) { sum += terms_of(pixel, value_, n); });
        return sum;
    }

    void report(const NonFinite& bad) {
        std::lock_guard lock(mutex_);
        ++non_finite_;
        auto order = [](const NonFinite& b) { return std::tuple(b.sample, b.set, b.y, b.x); };
        if (order(bad) < order(first_non_finite_)) first_non_finite_ = bad;
    }
};

template <class Pixel>
ImageError error_of(const Film<Pixel>& film) {
    return film.terms().error();
}

// What its samples say of a pixel, in a channel.
template <class Pixel>
auto value_in(const Film<Pixel>& film) {
    return [value = film.value(), n = film.samples()](const Pixel& p, size_t c) {
        return value(p, n, c);
    };
}
