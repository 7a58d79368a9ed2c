// base/allocations.h  the number of memory allocations; main.cpp counts them
#pragma once
#include <atomic>
#include <cstddef>

extern std::atomic<size_t> allocations;
