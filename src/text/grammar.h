// text/grammar.h  2  the statements of a scene's file: one table
//
// Parsing, messages and the table of reference/scenes.md all follow from `grammar`.
#pragma once
#include <sstream>
#include <string>
#include <vector>

#include "text/words.h"

// One statement a line, keyword first, material last; '#' starts a comment.
struct Statement {
    enum Kind { setting, material, content } kind;  // a setting stands once
    std::string_view keyword, words, meaning;
    std::string_view otherwise = {};  // without it; "": nothing
};

inline constexpr Statement grammar[] = {
    {Statement::setting, "size", "WIDTH HEIGHT", "width and height in pixels, which are square",
     "256 128"},
    {Statement::setting, "camera", "EYE_X EYE_Y EYE_Z  TARGET_X TARGET_Y TARGET_Z  VERTICAL_FOV",
     "pinhole camera; +y is up; field of view in degrees"},
    {Statement::setting, "depth", "BOUNCES", "maximum number of bounces; 0: emission only", "8"},
    {Statement::setting, "samples", "PER_PIXEL", "default samples per pixel", "64"},
    {Statement::setting, "exposure", "FACTOR", "factor from radiance to PNG", "1"},
    {Statement::material, "diffuse", "NAME  R G B", "albedo ρ: f = ρ/π"},
    {Statement::material, "phong",
     "NAME  DIFFUSE_R DIFFUSE_G DIFFUSE_B  LOBE_R LOBE_G LOBE_B  EXPONENT",
     "f = ρ/π + ρ' (n+2)/(2π) cosⁿ of the angle to the mirror direction"},
    {Statement::material, "mirror", "NAME  R G B", "reflectance"},
    {Statement::material, "glass", "NAME  INDEX_OF_REFRACTION",
     "smooth dielectric, Fresnel; 1 outside"},
    {Statement::material, "light", "NAME  R G B  [twosided] [MATERIAL]",
     "emits this radiance; reflects like MATERIAL, or not at all"},
    {Statement::content, "pointlight", "X Y Z  R G B", "intensity: radiance × length²"},
    {Statement::content, "sphere", "X Y Z  RADIUS  MATERIAL", "emits outwards"},
    {Statement::content, "triangle", "AX AY AZ  BX BY BZ  CX CY CZ  MATERIAL",
     "emits on the side of (B−A)×(C−A)"},
    {Statement::content, "quad", "X Y Z  UX UY UZ  VX VY VZ  MATERIAL",
     "a parallelogram: a corner and two edges; emits on the side of U×V"},
    {Statement::content, "mesh", "FILE.obj  SCALE  X Y Z  [turn DEGREES_ABOUT_Y] [z_up] [MATERIAL]",
     "polygons, scaled, z made y by `z_up`, rotated about y, moved; MATERIAL is for faces whose "
     "own "
     "is missing; FILE is relative to the scene's folder, in quotes if it has blanks"},
    {Statement::content, "box", "WIDTH HEIGHT DEPTH  DEGREES_ABOUT_Y  X Y Z  MATERIAL",
     "axis-aligned with a corner at the origin, then rotated about y and moved; emits outwards"},
};

// The statement that these words are; throws UserError if there is none, or if they are too few or
// too many.
inline const Statement& statement_of(const std::vector<std::string>& words) {
    std::vector<std::string_view> known;
    for (const Statement& s : grammar) {
        known.push_back(s.keyword);
        if (s.keyword != words[0]) continue;
        size_t least = 0, most = 0;
        std::istringstream in{std::string(s.words)};
        bool needed = true;  // those that are not come last
        for (std::string word; in >> word; ++most) least += needed = needed && word[0] != '[';
        const size_t found = words.size() - 1;
        if (found >= least && found <= most) return s;
        throw UserError("too " + std::string(found < least ? "few" : "many") + " words (" +
                        std::to_string(found) + "): " + words[0] + " " + std::string(s.words));
    }
    throw UserError(unknown("keyword", words[0], known));
}
