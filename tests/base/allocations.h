// base/allocations.h  how often memory was allocated: main.cpp counts
#pragma once
#include <atomic>
#include <cstddef>

extern std::atomic<size_t> allocations;
