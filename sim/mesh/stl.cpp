#include "sim/mesh/stl.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <numeric>
#include <string_view>

#include "sim/scene/limits.hpp"

namespace unravel::sim {

namespace {

constexpr std::size_t stl_header = 84, stl_triangle = 50;

// Corners of triangles, three by three. Returns what is wrong.
std::string binary_corners(std::span<const std::uint8_t> bytes, std::size_t count, std::vector<Vec3>& out) {
    out.reserve(3 * count);
    for (std::size_t t = 0; t < count; ++t) {
        const std::uint8_t* from = bytes.data() + stl_header + t * stl_triangle + 12;
        for (int corner = 0; corner < 3; ++corner, from += 12) {
            float xyz[3];
            std::memcpy(xyz, from, sizeof xyz);
            out.emplace_back(xyz[0], xyz[1], xyz[2]);
        }
    }
    return {};
}

std::string text_corners(std::string_view text, std::vector<Vec3>& out) {
    constexpr std::string_view blanks = " \t\r\n\v\f";
    const auto word = [&]() {
        text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
        const std::string_view found = text.substr(0, text.find_first_of(blanks));
        text.remove_prefix(found.size());
        return found;
    };
    for (std::string_view found = word(); !found.empty(); found = word()) {
        if (found != "vertex") continue;
        Vec3 x;
        for (double& value : x) {
            std::string_view digits = word();
            if (digits.starts_with('+')) digits.remove_prefix(1);
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
            if (digits.empty() || end != digits.data() + digits.size() ||
                error == std::errc::invalid_argument)
                return fmt::format("corner {} has no three numbers", out.size() + 1);
            if (error == std::errc::result_out_of_range) value = 0;
        }
        if (out.size() >= 6 * std::size_t{max_particles}) return "it has more triangles than a run can hold";
        out.push_back(x);
    }
    return out.size() % 3 == 0 ? "" : "its last triangle has no three corners";
}

// Gives each corner the number of its place, by the order in which places come first.
std::vector<std::uint32_t> number_places(const std::vector<Vec3>& corners, std::vector<Vec3>& places) {
    std::vector<std::uint32_t> order(corners.size()), first(corners.size()), number(corners.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
        return std::lexicographical_compare(corners[a].data(), corners[a].data() + 3, corners[b].data(),
                                            corners[b].data() + 3);
    };
    std::stable_sort(order.begin(), order.end(), less);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && corners[order[k]] == corners[order[k - 1]];
        first[order[k]] = same ? first[order[k - 1]] : order[k];
    }
    for (std::uint32_t c = 0; c < corners.size(); ++c) {
        if (first[c] == c) {
            number[c] = static_cast<std::uint32_t>(places.size());
            places.push_back(corners[c]);
        } else {
            number[c] = number[first[c]];
        }
    }
    return number;
}

}  // namespace

PolygonMesh parse_stl(std::span<const std::uint8_t> bytes, MeshMessages& said) {
    PolygonMesh mesh;
    mesh.parts.emplace_back();
    std::uint32_t count = 0;
    if (bytes.size() >= stl_header) std::memcpy(&count, bytes.data() + stl_header - 4, sizeof count);
    const bool binary = bytes.size() >= stl_header && (bytes.size() - stl_header) / stl_triangle >= count &&
                        (count > 0 || bytes.size() == stl_header) &&
                        (bytes.size() == stl_header + std::size_t{count} * stl_triangle ||
                         std::memcmp(bytes.data(), "solid", 5) != 0);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::vector<Vec3> corners;
    std::string what;
    if (binary && count > 2 * std::size_t{max_particles})
        what = "it has more triangles than a run can hold";
    else if (binary)
        what = binary_corners(bytes, count, corners);
    else if (text.starts_with("solid"))
        what = text_corners(text, corners);
    else
        what = bytes.size() >= stl_header ? fmt::format("it ends before its {} triangles do", count)
                                          : "it is no STL file";
    for (const Vec3& x : corners) {
        if (!what.empty()) break;
        if (!x.allFinite() || x.cwiseAbs().maxCoeff() > largest_coordinate)
            what = fmt::format("a coordinate is not finite or beyond {:g}", largest_coordinate);
    }
    if (!what.empty()) {
        said.fault(0, what, "export it again");
        corners.clear();
    }
    const std::vector<std::uint32_t> number = number_places(corners, mesh.positions);
    for (std::uint32_t t = 0; 3 * t + 2 < number.size(); ++t) {
        const PolygonMesh::Face face{3,
                                     {number[3 * t], number[3 * t + 1], number[3 * t + 2], no_index},
                                     {no_index, no_index, no_index, no_index}};
        mesh.add_face(face, 0, t, 0);
    }
    if (mesh.positions.size() > std::size_t{max_particles})
        said.fault(0, fmt::format("more than {} vertices", max_particles),
                   "that is more than a run can hold");
    finish_numbering(mesh);
    return mesh;
}

}  // namespace unravel::sim
