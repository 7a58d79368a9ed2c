// mesh/mtl.h  2  materials of MTL files
#pragma once
#include <optional>

#include "text/files.h"
#include "world/bsdf.h"

namespace penumbra::mesh {

// The words of a line of an OBJ or MTL file.  '#' begins a comment at the start or after a blank.
struct ObjLine {
    std::vector<std::string_view> words;

    explicit ObjLine(std::string_view line) {
        constexpr std::string_view space = " \t\v\f";
        words.reserve(8);
        for (size_t end = 0, start; (start = line.find_first_not_of(space, end)) != line.npos;) {
            if (line[start] == '#') break;
            end = std::min(line.find_first_of(space, start), line.size());
            words.push_back(line.substr(start, end - start));
        }
    }
    std::string_view operator[](size_t i) const { return words[i]; }
    size_t size() const { return words.size(); }
    // All words but the first: a name may hold blanks.
    std::string name() const {
        if (size() < 2) return {};
        return {words[1].data(), words.back().data() + words.back().size()};
    }
};

// Calls read(line, number) for every line that has words; a backslash joins it with the next,
// unless it ends a comment.
template <class Read>
void read_obj_lines(const std::string& path, Read read) {
    std::string joined;
    uint32_t first = 0;
    read_lines(read_file(path) + "\n\n", path, [&](std::string_view line, uint32_t number) {
        const size_t start = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t");
        if (start == line.npos) line = "";
        const bool goes_on = !line.empty() && line[end] == '\\' &&
                             std::string_view("#go").find(line[start]) == line.npos;
        if (joined.empty()) first = number;
        if (goes_on || !joined.empty()) joined += line;
        if (goes_on) return void(joined[joined.find_last_of('\\')] = ' ');
        const ObjLine whole(joined.empty() ? line : joined);
        if (whole.size() > 0) read(whole, first);
        joined.clear();
    });
}

// A material of an MTL file.  Glass has no colour, mirrors only that of Ks.
struct Mtl {
    std::optional<rgb> kd;
    rgb ks, Le;
    real exponent = 0;
    int illum = 2;
    std::optional<real> ior, opacity, transparency;

    // False if Penumbra has nothing like it.
    bool read(const ObjLine& l) {
        const std::string_view keyword = l[0], last = l.words.back();
        auto number = [&] { return real(parse_number(last)); };
        if (l.size() < 2) return false;
        if (keyword == "illum")
            illum = int(parse_number(last, 1000));
        else if (keyword == "Ns")
            exponent = std::clamp(number(), real(0), real(1e6));
        else if (keyword == "Ni")
            ior = number();
        else if (keyword == "d")
            opacity = number();
        else if (keyword == "Tr")
            transparency = number();
        else if (keyword == "Kd" || keyword == "Ks" || keyword == "Ke")
            (keyword == "Kd" ? kd.emplace() : keyword == "Ks" ? ks : Le) = colour(l);
        else
            return false;
        return true;
    }

    // One number is grey.
    static rgb colour(const ObjLine& l) {
        rgb c;
        for (size_t k = 0; k < 3; ++k)
            c.*axis[k] = std::max(real(0), real(parse_number(l[std::min(k + 1, l.size() - 1)])));
        return c;
    }

    bool is_clear() const { return opacity.value_or(1 - transparency.value_or(0)) < 1; }
    bool is_glass() const {
        return illum == 4 || illum == 6 || illum == 7 || illum == 9 || (is_clear() && ior > 1);
    }
    bool is_mirror() const { return (illum == 3 || illum == 5) && max_of(ks) > 0; }

    // A material of which nothing is said is grey.
    bool is_blank() const { return !kd && max_of(ks + Le) == 0 && !is_glass(); }
    rgb diffuse() const { return is_blank() ? rgb{0.5, 0.5, 0.5} : kd.value_or(rgb{}); }

    // Reflects no more than it receives.
    real albedo() const {
        return max_of(is_glass()    ? rgb{}
                      : is_mirror() ? ks
                      : illum > 1   ? diffuse() + ks
                                    : diffuse());
    }
    Material material() const {
        Material m;
        m.Le = Le;
        const real scale = albedo() > 1 ? below_one / albedo() : 1;
        if (is_glass())
            m.scattering = Glass(ior > 0 ? *ior : real(1.5));
        else if (is_mirror())
            m.scattering = Mirror(ks * scale);
        else if (illum > 1)
            m.scattering = Rough(diffuse() * scale, ks * scale, exponent);
        else
            m.scattering = Rough(diffuse() * scale);
        return m;
    }
};

}  // namespace penumbra::mesh
