// fuzz/fuzz.cpp  the entry point for libFuzzer: --target=NAME selects a target of targets.h,
// --seeds=FOLDER also writes its seeds there, and ends
#include <cstdlib>

#include "fuzz/targets.h"

namespace {

const fuzz::Target* target = nullptr;

// Prints the names of targets, and their shares of the time in hundredths.
[[noreturn]] void list() {
    for (const fuzz::Target& t : fuzz::targets) std::printf("%s %u\n", t.name, t.share);
    std::exit(0);
}

[[noreturn]] void write_seeds(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    for (const auto& [name, bytes] : fuzz::seeds_of(target->name))
        std::ofstream(folder / name, std::ios::binary) << bytes;
    std::exit(0);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
    constexpr std::string_view option = "--target=", seeds = "--seeds=";
    for (int i = 1; i < *count; ++i) {
        const std::string_view word = (*words)[i];
        if (word == "--list") list();
        if (word.starts_with(option)) target = fuzz::find(word.substr(option.size()));
        if (word.starts_with(seeds) && target) write_seeds(word.substr(seeds.size()));
    }
    if (target) return 0;
    std::fprintf(stderr, "fuzz: needs --target=NAME, one of those that --list tells\n");
    std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    target->run({reinterpret_cast<const char*>(data), size});
    return 0;
}
