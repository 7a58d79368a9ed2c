// text/complaint.h  the messages of errors
#pragma once
#include <string>

#include "text/words.h"

namespace penumbra {

// Returns the message of the error that `work` throws; "" if it throws none.
template <class Error = UserError>
std::string complaint(const auto& work) {
    try {
        work();
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}

}  // namespace penumbra

using namespace penumbra;
