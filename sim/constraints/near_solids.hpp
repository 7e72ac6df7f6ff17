#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "sim/constraints/contact.hpp"

namespace unravel::sim {

/// Which solids some particles are near, asked of all of them at once: what is far from their box is far from
/// each. Of more than 64 solids those beyond are taken for near.
class NearSolids {
public:
    bool none() const { return bits_ == 0; }
    bool has(std::size_t solid) const { return solid >= counted || (bits_ >> solid & 1) != 0; }

    /// Those that particles at x, of velocities v, may touch in a step of h seconds in which they may speed
    /// up by `faster` [m/s] (SolidReach::is_far()).
    static NearSolids to_touch(std::span<const SolidReach> reach, std::span<const Vec3> x,
                               std::span<const Vec3> v, double h, double faster) {
        double fastest = 0;
        for (const Vec3& each : v) fastest = std::max(fastest, each.squaredNorm());
        const double ahead = h * (std::sqrt(fastest) + faster);
        return find(reach, x, [&](const SolidReach& r, const Box& box) {
            if (r.plane) return box.above(r.now, r.normal) > r.skin + ahead;
            return (1.0 - r.turn) * box.distance(r.now) > r.radius + r.skin + r.travel + ahead;
        });
    }

    /// Those that particles at x may be in at the end of the step (SolidReach::is_outside()).
    static NearSolids to_be_in(std::span<const SolidReach> reach, std::span<const Vec3> x) {
        return find(reach, x, [](const SolidReach& r, const Box& box) {
            return r.plane ? box.above(r.next, r.normal) >= 0 : box.distance(r.next) >= r.radius;
        });
    }

private:
    static constexpr std::size_t counted = 64;

    struct Box {
        Vec3 low, high;
        double distance(const Vec3& point) const {
            return (low - point).cwiseMax(point - high).cwiseMax(0.0).norm();
        }
        // Of its lowest corner along a unit normal.
        double above(const Vec3& point, const Vec3& normal) const {
            const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
            return normal.dot(middle - point) - normal.cwiseAbs().dot(half);
        }
    };

    template <typename IsFar>
    static NearSolids find(std::span<const SolidReach> reach, std::span<const Vec3> x, const IsFar& is_far) {
        NearSolids near;
        if (x.empty()) return near;
        Box box{x.front(), x.front()};
        for (const Vec3& each : x) {
            box.low = box.low.cwiseMin(each);
            box.high = box.high.cwiseMax(each);
        }
        // A box's own rounding must not make far what touches.
        const Vec3 rounding = 1e-12 * box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs());
        box.low -= rounding;
        box.high += rounding;
        for (std::size_t s = 0; s < std::min(reach.size(), counted); ++s)
            near.bits_ |= std::uint64_t{!is_far(reach[s], box)} << s;
        if (reach.size() > counted) near.bits_ |= std::uint64_t{1} << (counted - 1);
        return near;
    }

    std::uint64_t bits_ = 0;  // of the first 64
};

}  // namespace unravel::sim
