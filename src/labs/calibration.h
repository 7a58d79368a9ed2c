// labs/calibration.h  5  an error estimate against the true error
#pragma once
#include "labs/rows.h"

namespace penumbra::calibration {

inline double true_d(const Row& r) { return std::sqrt(std::max(0.0, r["d2"])); }

inline double by_spread(const Row& r) { return r["d_rel_by_spread"]; }

// Judges an estimate, to a factor of two.  The true error is unknown if the reference's own error
// is most of the distance between image and reference.
enum class Verdict { right, too_low, too_high, unknown };
inline bool is_known(const Row& r) { return r["own"] < 0.8 * r["off"]; }
inline Verdict verdict(const Row& r, double stated) {
    if (!is_known(r) || std::isnan(stated)) return Verdict::unknown;
    if (2 * stated < true_d(r)) return Verdict::too_low;
    return stated > 2 * true_d(r) ? Verdict::too_high : Verdict::right;
}

inline bool is_hinted(const Row& r) { return std::isnan(r["d_rel"]); }
inline bool is_understated(const Row& r) { return verdict(r, r["d_rel"]) == Verdict::too_low; }

// True if --error ended the run, and not another limit.
inline bool is_reached(const Row& r) { return r["error"] == 1 && !is_hinted(r); }

// The error that options request: 0.1 for "--error 10% --spp 1024", 0 without --error.
inline double asked_in(const std::string& setting) {
    const std::vector<std::string> words = words_in(setting);
    for (size_t k = 0; k + 1 < words.size(); ++k)
        if (words[k] == "--error") return std::strtod(words[k + 1].c_str(), nullptr) / 100;
    return 0;
}

// The set of a scene: "blind hard" for "blind hard/lake".
inline std::string set_of(const std::string& scene) { return scene.substr(0, scene.find('/')); }

// The share of runs that satisfy `which`, among runs with a known true error.
template <class Which>
double share(const Rows& rows, Which which) {
    const Rows known = where(rows, is_known);
    return double(where(known, which).size()) / double(known.size());
}

}  // namespace penumbra::calibration
