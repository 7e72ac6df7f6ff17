#pragma once

#include <cstddef>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// What the memory gives, as everything that is limited by it may be measured by: a[i] = b[i] + s·c[i] over
/// three arrays of doubles of `bytes` in all, counted as 24 bytes per element, median of several passes. GB/s
/// (10⁹).
double triad(std::size_t bytes, int threads);

/// Arrays larger than any cache, and such that stay in the last one of most machines.
inline constexpr std::size_t triad_memory = std::size_t{192} << 20, triad_cache = std::size_t{6} << 20;

}  // namespace unravel::tool
