// labs/seeds.h  3  error and time of renders over seeds, one choice beside another
#pragma once
#include "app/options.h"
#include "labs/lab.h"

// Images of one scene that differ in their seeds alone, and the processor seconds of each.
struct Series {
    std::vector<Image> images;
    std::vector<double> seconds;
};

// Of this thread.
inline double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// But cornell36obj, which is cornell36 again.
inline std::vector<std::string> all_scenes() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator("scenes"))
        if (entry.path().extension() == ".scene" && entry.path().stem() != "cornell36obj")
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

// ---- Error and efficiency -----------------------------------------------------------------------

// Mean square of a series' mean image, over pixels and channels.
inline double mean_square(const Series& s) {
    double sum = 0;
    const size_t pixels = s.images[0].pixels.size();
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            Moments m;
            for (const Image& image : s.images) m.add(double(image.pixels[i][c]));
            sum += m.mean * m.mean;
        }
    return sum / (3 * double(pixels));
}

// Variance of a number between seeds, mean over pixels and channels, unbiased; without one seed.
inline double variance_between(const Series& s, size_t without = SIZE_MAX) {
    double sum = 0;
    const size_t pixels = s.images[0].pixels.size();
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            Moments m;
            for (size_t k = 0; k < s.images.size(); ++k)
                if (k != without) m.add(double(s.images[k].pixels[i][c]));
            sum += m.variance();
        }
    return sum / (3 * double(pixels));
}

// Median; without one seed.
inline double seconds_without(const Series& s, size_t without = SIZE_MAX) {
    std::vector<double> seconds = s.seconds;
    if (without < seconds.size()) seconds.erase(seconds.begin() + ptrdiff_t(without));
    return median(seconds);
}

// A number of all seeds, and how far it would be from the truth: the standard error of its
// logarithm, from what it is without each of the seeds (jackknife: Quenouille 1956, Tukey 1958).
struct Estimate {
    double value = 0, log_error = 0;
};
inline Estimate over_seeds(size_t seeds, const std::function<double(size_t without)>& number) {
    Moments m;
    for (size_t k = 0; k < seeds; ++k) m.add(std::log(number(k)));
    return {number(SIZE_MAX), std::sqrt(double(seeds - 1) / double(seeds) * m.m2)};
}
inline std::string told(const Estimate& e, const char* format) {
    return text("%s ± %s", text(format, e.value), text(format, e.value * e.log_error));
}

// Of many scenes: geometric mean, least and greatest.
struct Overall {
    double log_sum = 0, log_variance = 0, n = 0;
    std::pair<double, std::string> least = {HUGE_VAL, ""}, greatest = {0, ""};

    void add(double value, double log_error, const std::string& scene) {
        log_sum += std::log(value);
        log_variance += log_error * log_error;
        ++n;
        least = std::min(least, {value, scene});
        greatest = std::max(greatest, {value, scene});
    }
    Estimate mean() const { return {std::exp(log_sum / n), std::sqrt(log_variance) / n}; }
};

// ---- Choices ------------------------------------------------------------------------------------

// Words that a user of penumbra adds to the default.
struct Choice {
    std::string name;
    std::vector<std::string> words;
};

inline Choice choice_of(const std::string& name) {
    std::istringstream in(name);
    Choice choice{name, {}};
    for (std::string word; in >> word;) choice.words.push_back(word);
    return choice;
}

// What can be said after an option that has a few words to choose from, but for the default.
inline std::vector<Choice> alternatives(const std::string& name) {
    Options o;
    OptionTable table = option_table(o);
    const Option& option = row(table, name);
    std::vector<Choice> choices;
    for (const Text word : words_of(option.value))
        if (word != option.otherwise) choices.push_back(choice_of(name + " " + std::string(word)));
    return choices;
}
