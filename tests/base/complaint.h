// base/complaint.h  why something cannot be done
#pragma once
#include <string>

#include "base/words.h"

// The message of the error that `work` throws; "" if it throws none.
template <class Error = UserError>
std::string complaint(const auto& work) {
    try {
        work();
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}
