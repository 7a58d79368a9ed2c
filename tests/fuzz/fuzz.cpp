// fuzz/fuzz.cpp  the entry point for libFuzzer: --target=NAME selects a target of targets.h
#include <cstdlib>

#include "fuzz/targets.h"

namespace {

const fuzz::Target* target = nullptr;

// Prints the names of targets, and their shares of the time in hundredths.
[[noreturn]] void list() {
    for (const fuzz::Target& t : fuzz::targets) std::printf("%s %u\n", t.name, t.share);
    std::exit(0);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
    constexpr std::string_view option = "--target=";
    for (int i = 1; i < *count; ++i) {
        if (std::string_view((*words)[i]) == "--list") list();
        if (const std::string_view word = (*words)[i]; word.starts_with(option))
            target = fuzz::find(word.substr(option.size()));
    }
    if (target) return 0;
    std::fprintf(stderr, "fuzz: needs --target=NAME, one of those that --list tells\n");
    std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    target->run({reinterpret_cast<const char*>(data), size});
    return 0;
}
