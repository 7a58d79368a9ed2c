// course/answers_V.cpp  answers of the Voronoi project: a cell is cut, and measured
#include "course/answers.h"
#include "voronoi/polygon.h"

using namespace penumbra;
using course::In, course::Out;

namespace {

// A box (lo, hi) cut by lines (d, h); before, all of its corners are known to stay, or none.
ConvexPolygon cut_by(In x, bool all_stay) {
    ConvexPolygon p;
    p.start({{x[0], x[1]}, {x[2], x[3]}});
    while (Corner* c = all_stay ? p.open_corner() : nullptr) c->stays = true;
    for (size_t i = 4; i + 3 <= x.size(); i += 3)
        p.cut({{x[i], x[i + 1]}, x[i + 2], int32_t(i - 4) / 3});
    return p;
}
// Corners, and which line made the edge that begins there.
Out cut(In x) {
    const ConvexPolygon p = cut_by(x, false);
    Out corners;
    for (const Corner& c : p.outline())
        corners.insert(corners.end(), {c.p.x, c.p.y, double(c.neighbour)});
    return corners;
}

// Of corners that stayed before, the ones that do not now.
double fresh(In x) {
    const ConvexPolygon p = cut_by(x, true);
    return double(std::count_if(p.outline().begin(), p.outline().end(),
                                [](const Corner& c) { return !c.stays; }));
}

// The edge from the first corner is due to the window, others to a neighbour.
VoronoiCell cell_of(In x) {
    std::vector<Corner> corners;
    for (size_t i = 0; i + 2 <= x.size(); i += 2) corners.push_back({{x[i], x[i + 1]}, i ? 0 : -1});
    return voronoi::measured(corners);
}
Out measured(In x) {
    const VoronoiCell cell = cell_of(x);
    return {cell.area, cell.offset.x, cell.offset.y};
}

}  // namespace

int main() {
    return course::answer_all(
        {{"cut", 0, cut}, {"open", 0, fresh}, {"measured", 0, measured}, {"rim", 0, [](In x) {
                                                                              return cell_of(x).rim;
                                                                          }}});
}
