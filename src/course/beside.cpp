// course/beside.cpp  3  a student's picture, the expected one, and their difference, side by side
//
//   beside IMAGE.pfm EXPECTED.pfm SIDE-BY-SIDE.png   prints d_rel and the mean of each channel
//   beside IMAGE.pfm EXPECTED.pfm                    prints both for a page, with a slider
//   beside                                           prints what a page with sliders ends with
#include "keep/pair.h"
#include "keep/read_pfm.h"
#include "text/program.h"

namespace {
using namespace penumbra;

using Channels = std::array<double, 3>;

Channels mean_of(const Image& image) {
    Channels mean{};
    for (const auto& pixel : image.pixels)
        for (size_t c = 0; c < 3; ++c) mean[c] += double(pixel[c]) / double(image.pixels.size());
    return mean;
}

// The image, what is expected, and grey plus twice the difference.
Image side_by_side(const Image& f, const Image& F, double white) {
    const int w = f.width;
    Image all(3 * w, f.height);
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < w; ++x) {
            const auto &a = all.at(x, y) = f.at(x, y), &b = all.at(x + w, y) = F.at(x, y);
            for (size_t c = 0; c < 3; ++c)
                all.at(x + 2 * w, y)[c] = float(white / 5 + 2 * (double(a[c]) - double(b[c])));
        }
    return all;
}

int run(const std::vector<std::string>& words) {
    if (words.empty()) return std::fwrite(pair_viewer.data(), 1, pair_viewer.size(), stdout), 0;
    if (words.size() > 3 || words.size() < 2)
        throw UserError("usage: beside [IMAGE.pfm EXPECTED.pfm [SIDE-BY-SIDE.png]]");
    const Image f = read_pfm(words[0]), F = read_pfm(words[1]);
    if (f.width != F.width || f.height != F.height) throw UserError("the pictures have two sizes");
    if (words.size() == 2) {
        std::puts(html_of({f, F, "yours", "expected", {f.width / 2, f.height / 2}}).c_str());
        return 0;
    }
    const double white = white_of(F);
    write_image(words[2], side_by_side(f, F, white), 1 / white);
    const Channels a = mean_of(f), b = mean_of(F);
    std::printf("d_rel %.3g %%; mean %.4g %.4g %.4g, expected %.4g %.4g %.4g\n", 100 * d_rel(F, f),
                a[0], a[1], a[2], b[0], b[1], b[2]);
    return 0;
}

}  // namespace

int main(int argc, char** argv) try { return finished(run({argv + 1, argv + argc})); } catch (...) {
    return failed();
}
