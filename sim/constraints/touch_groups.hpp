#pragma once

#include <Eigen/LU>
#include <span>

#include "sim/constraints/contact.hpp"

namespace unravel::sim {

/// Touches of one particle.
using Group = std::span<Touch>;

/// Calls f for each particle's touches.
template <typename T, typename F>
void for_each_group(std::span<T> touches, const F& f) {
    for (std::size_t first = 0; first < touches.size();) {
        std::size_t last = first + 1;
        while (last < touches.size() && touches[last].contact.particle == touches[first].contact.particle)
            ++last;
        f(touches.subspan(first, last - first));
        first = last;
    }
}

/// Its velocity relative to the solid, along the surface.
inline Vec3 tangential(const Touch& touch, const Vec3& v) {
    const Vec3 relative = v - touch.velocity;
    return relative - touch.normal.dot(relative) * touch.normal;
}

/// Contacts this parallel are one direction.
inline constexpr double parallel_cosine = 0.999;

inline bool same_direction(const Vec3& a, const Vec3& b) {
    return a == b || a.dot(b) > parallel_cosine;
}

/// Directions that a group takes away, as columns; parallel ones count once, and so do those of a pinch.
inline Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> taken_directions(std::span<const Touch> group) {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> N(3, 0);
    for (const Touch& touch : group) {
        if (N.cols() == 3) break;
        bool known = false;
        for (Eigen::Index k = 0; k < N.cols(); ++k)
            known = known || same_direction(N.col(k), touch.normal) ||
                    (touch.pinched && same_direction(N.col(k), -touch.normal));
        if (known) continue;
        N.conservativeResize(3, N.cols() + 1);
        N.col(N.cols() - 1) = touch.normal;
    }
    return N;
}

}  // namespace unravel::sim
