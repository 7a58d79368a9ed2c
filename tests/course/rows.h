// course/rows.h  numbers as they go through the pipe, row by row
#pragma once
#include <span>
#include <vector>

namespace penumbra::course {

using In = std::span<const double>;
using Out = std::vector<double>;

// Numbers, vectors, lists and rows as one row.
template <class... Parts>
Out row(const Parts&... parts) {
    Out all;
    auto add = [&](const auto& part) {
        if constexpr (requires { part.z; })
            all.insert(all.end(), {double(part.x), double(part.y), double(part.z)});
        else if constexpr (requires { part.x; })
            all.insert(all.end(), {double(part.x), double(part.y)});
        else if constexpr (requires { part.begin(); })
            all.insert(all.end(), part.begin(), part.end());
        else
            all.push_back(double(part));
    };
    (add(parts), ...);
    return all;
}

}  // namespace penumbra::course
