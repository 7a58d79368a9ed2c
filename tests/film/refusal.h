// film/refusal.h  why something is refused
#pragma once
#include <string>

#include "base/words.h"

// The message of the error that `work` throws.
template <class Work>
std::string refusal(Work work) {
    try {
        work();
    } catch (const UserError& e) {
        return e.what();
    }
    return "no refusal";
}
