#include "sim/mesh/pc2.hpp"

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace unravel::sim {

namespace {

static_assert(std::endian::native == std::endian::little, "point caches are little-endian");
constexpr char magic[12] = "POINTCACHE2";

}  // namespace

std::vector<std::uint8_t> pc2_header(const Pc2Header& header) {
    std::vector<std::uint8_t> out(pc2_header_bytes);
    const std::int32_t version = 1;
    std::memcpy(out.data(), magic, sizeof magic);
    std::memcpy(out.data() + 12, &version, 4);
    std::memcpy(out.data() + 16, &header.points, 4);
    std::memcpy(out.data() + 20, &header.start, 4);
    std::memcpy(out.data() + 24, &header.rate, 4);
    std::memcpy(out.data() + 28, &header.samples, 4);
    return out;
}

std::string read_pc2(std::span<const std::uint8_t> bytes, std::size_t points, std::size_t limit,
                     Pc2Header& header, std::vector<std::vector<Vec3>>& out) {
    if (bytes.size() < pc2_header_bytes || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
        return "it is no PC2 file";
    std::memcpy(&header.points, bytes.data() + 16, 4);
    std::memcpy(&header.start, bytes.data() + 20, 4);
    std::memcpy(&header.rate, bytes.data() + 24, 4);
    std::memcpy(&header.samples, bytes.data() + 28, 4);
    if (header.points < 0 || static_cast<std::size_t>(header.points) != points)
        return fmt::format("it has {} points, the mesh {} vertices", header.points, points);
    if (header.samples < 1) return "it has no samples";
    const std::size_t sample = 3 * sizeof(float) * points, samples = static_cast<std::size_t>(header.samples);
    if (points == 0 || samples > (bytes.size() - pc2_header_bytes) / sample)
        return fmt::format("it ends before its {} samples do", samples);
    if (samples * points * sizeof(Vec3) > limit)
        return fmt::format("{} samples of {} points are more than a run can hold", samples, points);
    out.assign(samples, std::vector<Vec3>(points));
    const std::uint8_t* from = bytes.data() + pc2_header_bytes;
    for (std::vector<Vec3>& positions : out) {
        for (Vec3& x : positions) {
            float xyz[3];
            std::memcpy(xyz, from, sizeof xyz);
            from += sizeof xyz;
            x = {xyz[0], xyz[1], xyz[2]};
            if (!x.allFinite()) return "a position in it is not finite";
        }
    }
    return {};
}

}  // namespace unravel::sim
