// app/option_checks.h  3  words to options, and which of them go together
#pragma once
#include "app/options.h"

// Whether maps serve what is asked for.
inline void check_maps(const Options& o) {
    const std::string indirect = as_written(option_table, o, "--indirect");
    if (o.indirect == Indirect::path) {
        for (const Text name : {"--mesh", "--particles"})
            if (is_given(o, name))
                throw UserError(std::string(name) +
                                ": needs --indirect map, control or regression");
        return;
    }
    if (o.direct != Estimator::stochastic)
        throw UserError(indirect + ": needs --direct stochastic");
    if (o.film != Weighting::mc) throw UserError(indirect + ": needs --film mc");
    if (o.view != View::radiance && o.view != View::variance)
        throw UserError(indirect + ": needs --view radiance or variance");
    for (const Text name : {"--depth", "--roulette"})
        if (is_given(o, name))
            throw UserError(indirect + ": has no " + std::string(name) +
                            ": light is scattered without end");
}

// Whether there is an error to stop at.
inline void check_error(const Options& o) {
    if (o.error == 0) return;
    if (o.sampler == SamplerKind::halton_naive)
        throw UserError("--error: --sampler halton-naive is not random: its error is not known");
    if (o.sets == 1) throw UserError("--error: needs --sets 2 or more, or noise");
    if (o.film != Weighting::mc)
        throw UserError(as_written(option_table, o, "--film") +
                        ": needs --spp, not --error: all samples of a pixel at once");
}

// Whether a part can be rendered alone, and what becomes of it.
inline void check_part(const Options& o) {
    if (is_given(o, "--every") && o.checkpoint.empty())
        throw UserError("--every: goes with --checkpoint FILE");
    for (const Text name : {"--checkpoint", "--resume", "--rows", "--samples"})
        if (o.replay && is_given(o, name))
            throw UserError(std::string(name) + ": goes without --pixel");
    const bool kept = !o.resume.empty() || !o.checkpoint.empty();
    if (kept && o.indirect != Indirect::path && o.seconds > 0 && o.particles == 0)
        throw UserError(
            "--checkpoint: maps that --time fills are others in every run: give "
            "--particles");
    const Text part = o.rows ? "--rows" : "--samples";
    if (!o.rows && !o.samples) return;
    if (o.seconds > 0 || o.error > 0)
        throw UserError(std::string(part) + ": all parts of a picture end by --spp, not by " +
                        (o.error > 0 ? "--error" : "--time"));
    if (o.checkpoint.empty() && (o.samples || o.outputs.empty()))
        throw UserError(std::string(part) + ": needs --checkpoint FILE, which build/merge takes");
    if (o.film == Weighting::mc) return;
    if (o.samples)
        throw UserError("--samples: " + as_written(option_table, o, "--film") +
                        " needs all samples of a pixel at once");
    if (sets_of(o) == sets_by_noise)
        throw UserError("--rows: " + as_written(option_table, o, "--film") + " needs --sets N");
}

// What single options do not tell.
inline void check_together(const Options& o) {
    if (o.sample && !o.replay) throw UserError("--sample: goes with --pixel X,Y");
    if (o.view == View::variance && o.sets == 1)
        throw UserError("--view variance: needs --sets 2 or more, or noise");
    if (o.set && !o.replay) throw UserError("--set: goes with --pixel X,Y");
    if (o.sampler == SamplerKind::halton_naive && (o.sets > 1 || o.view == View::variance))
        throw UserError((o.sets > 1 ? std::string("--sets") : std::string("--view variance")) +
                        ": --sampler halton-naive is not random: all sets of it are alike");
    if (o.direct != Estimator::stochastic && o.technique.light != LightMode::nee)
        throw UserError(as_written(option_table, o, "--direct") + ": needs --light nee");
    check_error(o);
    need_scene(o);
    check_part(o);
    check_maps(o);
    if (o.film == Weighting::mc) return;
    const std::string film = as_written(option_table, o, "--film");
    if (o.sampler != SamplerKind::independent)
        throw UserError(film + ": needs --sampler independent");
    if (o.seconds > 0)
        throw UserError(film + ": needs --spp, not --time: all samples of a pixel at once");
    if (o.spp > (1 << 20)) throw UserError(film + ": at most 1048576 samples per pixel");
    if (o.direct != Estimator::stochastic) throw UserError(film + ": needs --direct stochastic");
}

// Throws UserError about the first word that cannot be used.
inline Options parse_options(const std::vector<std::string>& words) {
    Options o = parse_words(option_table, words);
    if (o.help) return o;
    check_together(o);
    return o;
}
