// keep/p_of_z.h  1  the p-value of z
#pragma once
#include <cmath>

// Two-sided, of a standard normal z.
inline double p_of_z(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }
