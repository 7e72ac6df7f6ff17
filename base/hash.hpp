#pragma once

#include <cstddef>
#include <cstdint>

namespace unravel {

/// FNV-1a of bytes, continued from `seed`.
inline std::uint64_t hash_bytes(const void* data, std::size_t size,
                                std::uint64_t seed = 14695981039346656037ull) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    std::uint64_t hash = seed;
    for (std::size_t k = 0; k < size; ++k) hash = (hash ^ bytes[k]) * 1099511628211ull;
    return hash;
}

}  // namespace unravel
