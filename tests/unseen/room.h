// unseen/room.h  a room with a ball, for tests of light that is hard to find
#pragma once
#include "world/scene.h"

namespace penumbra {

// A room that the eye sees from inside, with one light; half of it is glossy, and a ball of
// `material` stands in it.
inline Scene room(const Light* point, const Material& ball) {
    Scene s;
    s.size = {6, 4};
    s.depth = 5;
    s.camera = look_at({0, 1, real(2.8)}, {real(0.1), real(0.8), 0}, 50);
    Material lamp;
    lamp.Le = {4, 3, 2};
    Material both = lamp;
    both.twosided = true;
    s.materials = {
        {Rough({real(0.6), real(0.5), real(0.4)})},
        {Rough({real(0.3), real(0.3), real(0.3)}, {real(0.4), real(0.4), real(0.4)}, 20)},
        ball,
        lamp,
        both};
    add_quad(s, {-2, 0, -2}, {0, 0, 5}, {4, 0, 0}, 1);
    add_quad(s, {-2, 2, -2}, {4, 0, 0}, {0, 0, 5}, 0);
    add_quad(s, {-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, 0);
    add_quad(s, {-2, 0, -2}, {0, 2, 0}, {0, 0, 5}, 0);
    add_quad(s, {2, 0, -2}, {0, 0, 5}, {0, 2, 0}, 0);
    add_quad(s, {-2, 0, 3}, {0, 2, 0}, {4, 0, 0}, 0);
    add_sphere(s, {real(0.5), real(0.5), 0}, real(0.5), 2);
    if (point) add_light(s, *point);
    return s;
}

}  // namespace penumbra
