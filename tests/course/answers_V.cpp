// course/answers_V.cpp  answers of the Voronoi project: a cell is cut, and measured
#include "course/answers.h"
#include "voronoi/polygon.h"

using course::In, course::Out;

namespace {

// A box (lo, hi) cut by lines (d, h): corners, and which line made the edge that begins there.
Out cut(In x) {
    ConvexPolygon p;
    p.start({{x[0], x[1]}, {x[2], x[3]}});
    for (size_t i = 4; i + 3 <= x.size(); i += 3)
        p.cut({{x[i], x[i + 1]}, x[i + 2], int32_t(i - 4) / 3});
    Out corners;
    for (const Corner& c : p.outline())
        corners.insert(corners.end(), {c.p.x, c.p.y, double(c.neighbour)});
    return corners;
}

Out measured(In x) {
    std::vector<Corner> corners;
    for (size_t i = 0; i + 2 <= x.size(); i += 2) corners.push_back({{x[i], x[i + 1]}});
    const VoronoiCell cell = voronoi::measured(corners);
    return {cell.area, cell.offset.x, cell.offset.y};
}

}  // namespace

int main() { return course::answer_all({{"cut", 0, cut}, {"measured", 0, measured}}); }
