// labs/indirect_draw.cpp  6  program that renders images with paths that end on maps or continue
#include "labs/indirect_draw.h"

#include "base/json.h"

int main(int argc, char** argv) {
    indirect::Asked a;
    std::string image, stats;
    auto count = [](uint64_t& n) {
        return [&n](const std::string& word) { n = parse_count(word, 0, uint64_t(1) << 40); };
    };
    const Lab lab{
        "indirect_draw",
        "Renders an image with paths that end on illumination maps, or continue there.",
        {{"--scene", "FILE", "", [&](auto& word) { a.scene = word; }},
         {"--way", "WAY", "whole:0.25|map|control|regression|over:t",
          [&](auto& word) { a.way = word; }},
         {"--size", "WxH", "",
          [&](auto& word) {
              const size_t x = word.find('x');
              a.size = parse_size(word.substr(0, x), x == word.npos ? "" : word.substr(x + 1));
          }},
         {"--sampler", "independent|sobol", "",
          [&](auto& word) {
              a.sampler = word == "sobol" ? SamplerKind::sobol : SamplerKind::independent;
          }},
         {"--mesh", "H", "", [&](auto& word) { a.H = parse_number(word, HUGE_VAL); }},
         {"--particles", "N", "", count(a.particles)},
         {"--spp", "N", "", count(a.spp)},
         {"--seed", "N", "", count(a.seed)},
         {"--threads", "N", "", [&](auto& n) { a.threads = unsigned(parse_count(n, 1, 1024)); }},
         {"--quiet", "", "", [](auto&) {}},
         {"-o", "FILE.pfm", "", [&](auto& word) { image = word; }},
         {"--stats", "FILE.json", "", [&](auto& word) { stats = word; }}}};
    return lab_main(argc, argv, lab, [&] {
        const indirect::Drawn d = indirect::draw(a);
        write_image(image, d.image, 1);
        json::Object object;
        object.add("cpu_seconds", json::number(d.cpu_seconds));
        object.add("map_cpu_seconds", json::number(d.map_cpu_seconds));
        object.add("map_error", json::number(d.map_error));
        object.add("map_triangles", json::number(d.triangles));
        object.add("bias", json::string(d.is_biased ? "biased" : "unbiased"));
        write_file(stats, object.text());
        return 0;
    });
}
