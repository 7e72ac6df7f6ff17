#pragma once

#include <cstdint>

namespace unravel::sim {

/// Uniform in [−1, 1), a pure function of seed and index (SplitMix64, Steele et al. 2014): the same on every
/// machine.
inline double seeded_uniform(std::uint64_t seed, std::uint64_t index) {
    std::uint64_t z = seed * 0x9e3779b97f4a7c15ull + index * 0xd1b54a32d192ed03ull + 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1.0p-52 - 1.0;
}

}  // namespace unravel::sim
