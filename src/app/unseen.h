// app/unseen.h  1  light that samples may have missed, if -DWITH_UNSEEN: with src/unseen
#pragma once
#include "film/loop.h"
#include "path/pathtracer.h"
#include "text/named_scene.h"

#ifdef WITH_UNSEEN
#include "unseen/unseen.h"
#else
namespace penumbra {
inline std::vector<std::string> hidden_lights(const NamedScene&) { return {}; }
struct Unseen {
    void add(const std::vector<NearMisses>&, double, double) {}
    std::string doubt(double, double, double) const { return ""; }
};
struct Witness {
    Witness(const Scene&, const Technique&, int, int, const std::vector<uint32_t>&) {}
    std::vector<NearMisses> near_misses(double) const { return {}; }
    std::vector<size_t> noisy() const { return {}; }
    static std::string why_unknown(const Film&, const ImageError&) { return ""; }
    NoVisitor visitor(Tally&) const { return {}; }
};
}  // namespace penumbra
#endif
