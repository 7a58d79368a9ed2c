// oracle/campaign.cpp  does the oracle refuse right code?  Many codes, many seeds, at alpha = 1e-3
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "campaign_directions.h"
#include "campaign_lights.h"
#include "campaign_lines.h"
#include "campaign_lobes.h"
#include "campaign_planes.h"

namespace campaign {

constexpr double alpha = 1e-3, sees = 0.05;

template <class T>
Codes all() {
    Codes codes;
    directions<T>(codes);
    lobes<T>(codes);
    lights<T>(codes);
    lines<T>(codes);
    planes<T>(codes);
    choices<T>(codes);
    return codes;
}

// Of families whose borders cut across all coordinates, which takes long to integrate, every other
// code is tried in double, and those between in float.
Codes all() {
    const std::set<std::string> slow = {"boxes",
                                        "discs, polygons",
                                        "lights by area",
                                        "maps of the environment",
                                        "spherical polygons",
                                        "tables of the square",
                                        "triangles"};
    Codes codes;
    for (const Codes& some : {all<double>(), all<float>()}) {
        std::map<std::string, size_t> begun;
        const bool single = some[0].name.ends_with("float");
        for (const Code& code : some)
            if (slow.count(code.family) == 0 || begun[code.family]++ % 2 == size_t(single))
                codes.push_back(code);
    }
    return codes;
}

struct Tally {
    int codes = 0, runs = 0, refused = 0, at_default = 0;  // refused at 1e-3, and also at 1e-6
    int codes_refused_often = 0;
    double seconds = 0;
    std::string first_refusal;
    void operator+=(const Tally& t) {
        codes += t.codes, runs += t.runs, refused += t.refused, at_default += t.at_default;
        codes_refused_often += t.codes_refused_often, seconds += t.seconds;
    }
};

// The number of refusals that a right oracle exceeds with this probability, of so many runs.
int bound(int runs, double probability) {
    int k = 0;
    while (oracle::p_at_least(k + 1, double(runs), alpha) > probability) ++k;
    return k;
}
// 3 of 100 runs of one code; 52 of 30 000 in all.
int bound_of_code(int runs) { return bound(runs, 1e-5); }
int bound_of_all(int runs) { return bound(runs, 1.5e-4); }

oracle::Verdict verdict(const Code& code, int seed, double significance) {
    oracle::Random random(oracle::seed_of(code.name + " " + std::to_string(seed)));
    oracle::Options options;
    options.alpha = significance;
    options.sees = sees;
    options.tolerance = code.tolerance;
    return code.check(random, options);
}

Tally run(const Code& code, int seeds) {
    Tally tally;
    tally.codes = 1;
    const auto begin = std::chrono::steady_clock::now();
    for (int seed = 0; seed < seeds; ++seed) {
        const oracle::Verdict v = verdict(code, seed, alpha);
        ++tally.runs;
        if (v.pass) continue;
        if (tally.refused++ == 0)
            tally.first_refusal = say("seed %d: ", seed) + v.text.substr(0, v.text.find('\n')) +
                                  " [" + oracle::detail::say_p(v.p) + "]";
        tally.at_default += !verdict(code, seed, 1e-6).pass;
    }
    tally.codes_refused_often = tally.refused > bound_of_code(seeds);
    tally.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return tally;
}

std::string row(const std::string& name, const Tally& t) {
    return say("| %s | %d | %d | %d | %.1f | %d | %d |\n", name.c_str(), t.codes, t.runs, t.refused,
               alpha * t.runs, t.at_default, t.codes_refused_often);
}

bool accepted(const Tally& t) {
    return t.runs > 0 && t.refused <= bound_of_all(t.runs) && t.at_default == 0 &&
           t.codes_refused_often == 0;
}

void write_report(const std::string& path, int seeds,
                  const std::vector<std::pair<std::string, Tally>>& families, const Tally& sum,
                  const std::vector<std::string>& bad) {
    std::ofstream file(path);
    file
        << "# False positives of the oracle\n\nHow often does the oracle refuse correct samplers?  "
        << (accepted(sum) ? "**As often as it promises.**" : "**More often than it promises.**")
        << say(" It refused %d of %d runs of %d correct samplers with\ntheir densities at a "
               "significance of 1e-3 (%.0f expected, at most %d accepted), ",
               sum.refused, sum.runs, sum.codes, alpha * sum.runs, bound_of_all(sum.runs))
        << say("%d at 1e-6 (none accepted),\nand %d codes more than %d times in %d seeds (none "
               "accepted).\n\n",
               sum.at_default, sum.codes_refused_often, bound_of_code(seeds), seeds)
        << "Written by `make oracle-campaign" << (seeds == 100 ? "" : say(" SEEDS=%d", seeds))
        << "`.  A code is a sampler with its density, in float or in double.  A run is one check\n"
           "of a code with `{.alpha = 1e-3, "
        << say(".sees = %g}`", sees)
        << " and a seed that follows from its name and number.  \"Refused at 1e-6\" is a\n"
           "check with the same seed at a significance of 1e-6.  `build/oracle-campaign --codes` "
           "lists all codes.\n"
           "\n| family | codes | runs | refused at 1e-3 | expected | refused at 1e-6 | codes "
           "refused too often |\n|---|---|---|---|---|---|---|\n";
    for (const auto& [name, tally] : families) file << row(name, tally);
    file << row("all", sum);
    if (!bad.empty()) file << "\nRefused too often, or at 1e-6:\n\n";
    for (const std::string& name : bad) file << "* " << name << "\n";
    if (!file.flush()) std::fprintf(stderr, "campaign: cannot write %s\n", path.c_str());
}

int main(int count, char** words) {
    int seeds = 100;
    std::string only, report;
    bool list = false;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const bool more = i + 1 < count;
        if (word == "--codes")
            list = true;
        else if (word == "--only" && more)
            only = words[++i];
        else if (word == "--report" && more)
            report = words[++i];
        else if (word == "--seeds" && more && std::atoi(words[i + 1]) > 0)
            seeds = std::atoi(words[++i]);
        else {
            std::fputs("campaign [--only SUBSTRING] [--seeds N] [--report FILE] [--codes]\n",
                       stderr);
            return 2;
        }
    }
    oracle::pictures = "";
    std::set<std::string> names;
    std::vector<std::pair<std::string, Tally>> families;
    Tally sum;
    std::vector<std::string> bad;
    for (const Code& code : all()) {
        if (!names.insert(code.name).second) {
            std::fprintf(stderr, "campaign: two codes named %s\n", code.name.c_str());
            return 2;
        }
        if (code.name.find(only) == std::string::npos) continue;
        if (list) {
            std::printf("%s\n", code.name.c_str());
            continue;
        }
        const Tally tally = run(code, seeds);
        sum += tally;
        auto family = families.begin();
        while (family != families.end() && family->first != code.family) ++family;
        if (family == families.end()) family = families.insert(family, {code.family, {}});
        family->second += tally;
        const bool wrong = tally.codes_refused_often || tally.at_default;
        if (wrong) bad.push_back(code.name);
        std::printf("%-4s %d of %d refused, %d at 1e-6, %.0f ms  %s\n", wrong ? "BAD" : "ok",
                    tally.refused, tally.runs, tally.at_default, 1e3 * tally.seconds / seeds,
                    code.name.c_str());
        if (tally.refused > 0) std::printf("     %s\n", tally.first_refusal.c_str());
        std::fflush(stdout);
    }
    if (list) return 0;
    std::printf("%s%.0f s; at most %d of a code, %d in all, none at 1e-6\n",
                row("all", sum).c_str(), sum.seconds, bound_of_code(seeds), bound_of_all(sum.runs));
    if (!report.empty()) write_report(report, seeds, families, sum, bad);
    return accepted(sum) ? 0 : 1;
}

}  // namespace campaign

int main(int count, char** words) { return campaign::main(count, words); }
