// app/refused_words.h  options that are wrong for every scene and folder
#pragma once
#include "base/cases.h"

inline std::vector<Refusal> refused_words() {
    std::vector<Family> families = {
        {"@ 4", "--sp;--spq", "unknown option '@' (did you mean '--spp'?)"},
        {"@ 4", "--deph", "unknown option '@' (did you mean '--depth'?)"},
        {"@ 4", "--thread", "unknown option '@' (did you mean '--threads'?)"},
        {"@ mis", "--ligth", "unknown option '@' (did you mean '--light'?)"},
        {"@", "-x;-O", "unknown option '@' (did you mean '-o'?)"},
        {"@", "-", "unknown option '@'"},
        {"--quiet=@", "1", "--quiet: takes no value"},
        {"--spp=@", "many", "--spp: '@' is not a whole number"},
        {"@", "--quiett", "unknown option '@' (did you mean '--quiet'?)"},
        {"--light @", "nope", "--light: unknown value '@' (did you mean 'none'?)"},
        {"--light @", "mix", "--light: unknown value '@' (did you mean 'mis'?)"},
        {"--light @", "MIS;none|nee;~", "--light: unknown value '@'"},
        {"--direction @", "bdsf", "--direction: unknown value '@' (did you mean 'bsdf'?)"},
        {"--direction @", "unifrom", "--direction: unknown value '@' (did you mean 'u"},
        {"-o @", "a.jpg;a.PNG;a;~", "-o: '@' must end in .png, .pfm or .hdr"},
        {"-o @", "a.txt -o a.png;a.png -o a.txt", "-o: 'a.txt' must end in"},
        // Sizes and counts.
        {"--size @x1000000", "1000000", "--size: '@' is not a whole number from 1 to"},
        {"--size @", "65536x65536", "--size: an image of @ has more than 1073741824"},
        {"--size @", "65536x16385", "--size: an image of @ has more than"},
        {"--size @x1", "65537", "--size: '@' is not a whole number"},
        {"--size @", "4;4*4;~", "--size: '@' is not WIDTHxHEIGHT"},
        {"--size @",
         "0x4;4x0;-1x4;4x-1;x4;4x;x;4x4x4;4.0x4;4X4;0x10x4;4x1e1;nanx4;99999999999999999999x1",
         "--size: '"},
        {"--threads @", "1025", "--threads: '@' is not a whole number from 1 to"},
        {"--threads @", "0", "--threads: '@' is not a whole number"},
        {"--seed @", "18446744073709551616", "--seed: '@' is not a whole number"},
        {"--depth @", "1000001;4294967296", "--depth: '@' is not a whole number"},
        {"--spp @", "0;1099511627777;18446744073709551615", "--spp: '@' is not a whole number"},
        {"--replications @", "0;1025", "--replications: '@' is not a whole number"},
        {"--roulette @", "1.1", "--roulette: '@' is more than 100 %"},
        {"--roulette @", "-0.1", "--roulette: '@' is negative"},
        {"--error @", "0;100%;1;-1%;nan", "--error: '"},
        {"--pixel @", "7", "--pixel: '@' is not X,Y"},
        {"--pixel 7,@", "8,9", "--pixel: '@' is not a whole number"},
        {"--pixel 7,8 --sample 1,@", "2,3;1025", "--sample: '@' is not a whole number"},
        {"--pixel 7,8 --sample 1,", "", "--sample: '' is not a whole number"},
        {"--keep @", "a.pfm", "--keep: '@' must end in .film"},
        {"--rows @ -o a.pfm", "2", "--rows: '@' is not FIRST-LAST"},
        {"--rows @ -o a.pfm", "2-1", "--rows: '@' ends before it begins"},
        {"--rows 7- -o a.pfm", "", "--rows: '' is not a whole number"},
        // Combinations of options.
        {"--sample 1", "", "--sample: needs --pixel X,Y (for samples per pixel use --spp N)"},
        {"--pixel 1,2 --keep a.film", "", "--keep: cannot be combined with --pixel"},
        {"--error 1% --view @", "normal;bvh", "--error: needs --view radiance"},
        {"--error 1% --replications 1", "", "--error: needs --replications 2 or more, or adaptive"},
        {"--rows 1-2", "", "--rows: needs --keep F.film, which build/merge takes, or -o"},
    };
    for (const std::string option : {"--spp", "--depth", "--seed", "--threads"})
        families.push_back({option + " @",
                            "-1;many;1.5;~;1e3;0x10;+1;1x;nan;inf;99999999999999999999999",
                            option + ": '@' is not a whole number"});
    for (const std::string option : {"--time", "--exposure"})
        for (const auto& [values, why] : {std::pair{"0;-1", "is not positive"},
                                          {"inf;1e999;1e31", "is too large"},
                                          {"soon;nan;1.0x;0x1p3;~;+-1;1s", "is not a number"}})
            families.push_back({option + " @", values, option + ": '@' " + why});
    return members(families);
}
