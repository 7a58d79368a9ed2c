// labs/trade_radiosity.h  5  what build/radiosity brings: error and seconds of its three methods
#pragma once
#include "labs/trade_errors.h"
#include "labs/trade_runs.h"
#include "radiosity/shooting.h"

namespace trade {

// A point, and the image that it is of.
struct Look {
    TradePoint point;
    Image image;
};

// As build/radiosity has it by default: edges of a 32nd of the diagonal, 2 x 2 rays a pixel.
struct Room {
    Scene scene;
    Mesh mesh;
    double seconds = 0;  // that this took
};
inline Room room_of(const Ground& g, const Bytes& bytes) {
    const double before = processor_seconds(), H = edge_length(g.file(), g.scene, {}, 32, bytes);
    Room room{faceted(g.scene, H).scene, {}};
    room.mesh = make_mesh(room.scene, H);
    room.seconds = processor_seconds() - before;
    return room;
}

// `spp` is what the point is a point of.
inline Look look(const Room& room, const IlluminationMap& map, double spp, double seconds,
                 const Reference& f) {
    const double before = processor_seconds();
    Look l{{spp}, radiance_image(room.scene, room.mesh, map, 2, all_cores())};
    l.point.seconds = room.seconds + seconds + processor_seconds() - before;
    const Error e = error_of({l.image}, f);
    l.point.error = e.value, l.point.error_se = e.standard_error;
    return l;
}

// One run, looked at on its way; after `most` seconds by the clock it ends.
inline std::vector<Look> by_shooting(const Ground& g, Shooter shooter, const Reference& f,
                                     double most) {
    const Room room = room_of(g, Shooting::bytes());
    Shooting run(room.scene, room.mesh, shooter, all_cores());
    std::vector<Look> looks;
    double seconds = 0;
    for (const double unshot : {0.5, 0.1, 0.03, 0.01, 0.001}) {
        const double before = processor_seconds();
        run.run({unshot, most, 0}, [](const Shooting&) {});
        seconds += processor_seconds() - before;
        if (run.unshot() > unshot) break;
        looks.push_back(look(room, run.map(), 1 / unshot, seconds, f));
    }
    return looks;
}

inline std::vector<Look> by_particles(const Ground& g, const Reference& f, double most) {
    const Room room = room_of(g, Particles::bytes());
    std::vector<Look> looks;
    CommonOptions o;
    o.quiet = true;
    double spent = 0;
    for (const uint64_t n : {4096, 16384, 65536, 262144, 1048576}) {
        if (5 * spent > most * all_cores()) break;
        const double before = processor_seconds();
        const Pattern pattern = Particles::pattern(SamplerKind::halton, 1, n);
        const Walked walked = walk_all(room.scene, room.mesh, pattern, {n, 0}, o);
        spent = processor_seconds() - before;
        looks.push_back(look(room, walked.map, double(n), spent, f));
    }
    return looks;
}

// All methods on a scene of its own size.
struct Method {
    TradeSetting setting;
    std::vector<Look> looks;
};
inline std::vector<Method> by_radiosity(const Ground& g, const Reference& f, double most) {
    std::vector<Method> all;
    auto add = [&](const char* name, std::vector<Look> looks) {
        TradeSetting s{std::string("radiosity --method ") + name, false, false, false};
        for (const Look& l : looks) s.points.push_back(l.point);
        if (looks.size() < 5)
            s.dropped = "after " + text("%zu", looks.size()) + " points: too slow";
        all.push_back({s, std::move(looks)});
    };
    add("shooting", by_shooting(g, Shooter::element, f, most));
    add("hierarchy", by_shooting(g, Shooter::face, f, most));
    add("particles", by_particles(g, f, most));
    return all;
}

}  // namespace trade
