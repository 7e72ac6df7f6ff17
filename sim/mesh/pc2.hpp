#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// A PC2 point cache ("POINTCACHE2", version 1): a header, then the positions of every point for every
/// sample as little-endian floats.
struct Pc2Header {
    std::int32_t points = 0;
    float start = 0;  ///< frame of the first sample
    float rate = 1;   ///< samples per frame
    std::int32_t samples = 0;
};
inline constexpr std::size_t pc2_header_bytes = 32;

std::vector<std::uint8_t> pc2_header(const Pc2Header& header);

/// Reads a whole file of `points` points into (samples, points) [units of the file]. Returns what is wrong,
/// or nothing. No more than `limit` bytes are taken for the positions.
std::string read_pc2(std::span<const std::uint8_t> bytes, std::size_t points, std::size_t limit,
                     Pc2Header& header, std::vector<std::vector<Vec3>>& out);

}  // namespace unravel::sim
