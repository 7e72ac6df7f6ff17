#include "sim/solids/profile.hpp"

#include <cmath>
#include <numbers>

namespace unravel::sim {

void add_grid(ShapeSurface& surface, int rows, int columns,
              const std::function<void(int, int, Eigen::Vector3f&, Eigen::Vector3f&)>& point) {
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c <= columns; ++c) {
            Eigen::Vector3f position, normal;
            point(r, c, position, normal);
            surface.positions.push_back(position);
            surface.normals.push_back(normal);
        }
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const std::uint32_t a = first + static_cast<std::uint32_t>(r * (columns + 1) + c), b = a + 1,
                                d = a + static_cast<std::uint32_t>(columns) + 1, e = d + 1;
            surface.indices.insert(surface.indices.end(), {a, d, b, b, d, e});
        }
}

void add_arc(std::vector<ProfilePoint>& profile, float centre, float y, float radius, float from, float to,
             int segments) {
    for (int i = 0; i <= segments; ++i) {
        const float angle = from + (to - from) * static_cast<float>(i) / static_cast<float>(segments),
                    s = std::sin(angle), c = std::cos(angle);
        profile.push_back({centre + radius * s, y + radius * c, s, c});
    }
}

ShapeSurface turn(const std::vector<ProfilePoint>& profile, int sectors) {
    ShapeSurface surface;
    add_grid(surface, static_cast<int>(profile.size()) - 1, sectors,
             [&](int r, int c, Eigen::Vector3f& p, Eigen::Vector3f& n) {
                 const ProfilePoint& at = profile[static_cast<std::size_t>(r)];
                 const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(c) /
                                     static_cast<float>(sectors),
                             x = std::sin(angle), z = std::cos(angle);
                 p = {at.radius * x, at.y, at.radius * z};
                 n = {at.normal_radial * x, at.normal_y, at.normal_radial * z};
             });
    return surface;
}

}  // namespace unravel::sim
