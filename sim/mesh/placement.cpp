#include "sim/mesh/placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/scene/random.hpp"

namespace unravel::sim {

Eigen::Matrix3d rotation_matrix(const Vec3& degrees) {
    const Vec3 angle = degrees * (std::numbers::pi / 180);
    return (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

Vec2 particle_uv(const Cloth& cloth, int i, int j) {
    const auto [nu, nv] = cloth.particles;
    const auto along = [](int index, int count) { return count > 1 ? double(index) / (count - 1) : 0.5; };
    return {cloth.wrap == Wrap::tube ? double(i) / nu : along(i, nu), along(j, nv)};
}

namespace {

/// Before the cloth is turned and moved.
Vec3 unrotated(const Cloth& cloth, int i, int j) {
    if (cloth.geometry) return cloth.geometry->rest[static_cast<std::size_t>(i)];
    const Vec2 uv = particle_uv(cloth, i, j);
    const double width = cloth.size[0] * cloth.placed_scale[0];
    const double length = cloth.size[1] * cloth.placed_scale[1];
    Vec3 local(0, 0, (uv.y() - 0.5) * length);
    if (cloth.wrap == Wrap::tube) {
        // v runs along +z and the front faces out, so u turns from +y (its top) towards +x.
        const double angle = 2 * std::numbers::pi * uv.x();
        // The ring whose chords, not arcs, add up to the circumference: its springs start at their rest
        // lengths.
        const int nu = cloth.particles[0];
        const double radius = width / nu / (2 * std::sin(std::numbers::pi / nu));
        local.x() = radius * std::sin(angle);
        local.y() = radius * std::cos(angle);
    } else {
        local.x() = (uv.x() - 0.5) * width;
    }
    return local;
}

}  // namespace

Vec3 placed_particle(const Cloth& cloth, int i, int j) {
    return cloth.center + rotation_matrix(cloth.rotation) * unrotated(cloth, i, j);
}

Vec3 started_particle(const Cloth& cloth, int i, int j) {
    const Vec3 x = placed_particle(cloth, i, j);
    if (cloth.jitter == 0) return x;
    const auto index = static_cast<std::uint64_t>(j) * static_cast<std::uint64_t>(cloth.particles[0]) +
                       static_cast<std::uint64_t>(i);
    const Vec3 up = rotation_matrix(cloth.rotation) * Vec3::UnitY();
    return x + cloth.jitter * seeded_uniform(cloth.seed, index) * up;
}

std::vector<Vec3> placed_particles(const Cloth& cloth) {
    const auto [nu, nv] = cloth.particles;
    const Eigen::Matrix3d rotation = rotation_matrix(cloth.rotation);
    std::vector<Vec3> out;
    out.reserve(static_cast<std::size_t>(nu) * static_cast<std::size_t>(nv));
    for (int j = 0; j < nv; ++j) {
        for (int i = 0; i < nu; ++i) out.push_back(cloth.center + rotation * unrotated(cloth, i, j));
    }
    return out;
}

bool pin_catches(const Cloth& cloth, const Pin& pin, int i, int j) {
    constexpr double slack = 1e-9;
    const auto [nu, nv] = cloth.particles;
    const Vec2 uv = particle_uv(cloth, i, j);
    switch (pin.target) {
        case PinTarget::corner:
            return i == (pin.name.starts_with("u1") ? nu - 1 : 0) &&
                   j == (pin.name.ends_with("v1") ? nv - 1 : 0);
        case PinTarget::edge:
            if (pin.name.starts_with("u")) return i == (pin.name.ends_with("1") ? nu - 1 : 0);
            return j == (pin.name.ends_with("1") ? nv - 1 : 0);
        case PinTarget::particles:
            return i >= pin.range[0] && i <= pin.range[1] && j >= pin.range[2] && j <= pin.range[3];
        case PinTarget::box:
            return (uv.array() >= pin.box.low.array() - slack).all() &&
                   (uv.array() <= pin.box.high.array() + slack).all();
        case PinTarget::disc: {
            Vec2 off = uv - pin.disc.center;
            if (cloth.wrap == Wrap::tube) off.x() -= std::round(off.x());  // the shorter way round
            return std::hypot(off.x() * cloth.size[0], off.y() * cloth.size[1]) <= pin.disc.radius + slack;
        }
        case PinTarget::group: {
            const auto found = cloth.geometry->groups.find(pin.group);
            return found != cloth.geometry->groups.end() &&
                   std::binary_search(found->second.begin(), found->second.end(),
                                      static_cast<std::uint32_t>(i));
        }
        case PinTarget::within: {
            const Vec3 x = placed_particle(cloth, i, j);
            return (x.array() >= pin.within.low.array() - slack).all() &&
                   (x.array() <= pin.within.high.array() + slack).all();
        }
    }
    return false;
}

std::vector<std::size_t> pinned_particles(const Cloth& cloth, const Pin& pin) {
    const auto [nu, nv] = cloth.particles;
    std::vector<std::size_t> out;
    for (int j = 0; j < nv; ++j) {
        for (int i = 0; i < nu; ++i) {
            if (pin_catches(cloth, pin, i, j))
                out.push_back(std::size_t(j) * std::size_t(nu) + std::size_t(i));
        }
    }
    return out;
}

Eigen::Isometry3d start_pose(const Solid& solid) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation_matrix(solid.rotation);
    pose.translation() = solid.center;
    if (solid.motion.empty()) return pose;
    const Keyframe& first = solid.motion.front();
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = rotation_matrix(first.rotation);
    moved.translation() = solid.pivot + first.position - moved.linear() * solid.pivot;
    return moved * pose;
}

}  // namespace unravel::sim
