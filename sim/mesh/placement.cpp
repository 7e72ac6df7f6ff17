#include "sim/mesh/placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/smooth_noise.hpp"
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

Eigen::Matrix3d cloth_rotation(const Cloth& cloth) {
    const Eigen::Matrix3d rotation = rotation_matrix(cloth.rotation);
    // Columns are where u, the front and v come to look.
    Eigen::Matrix3d facing;
    switch (cloth.facing) {
        case Facing::up:
            return rotation;
        case Facing::down:
            facing << -1, 0, 0, 0, -1, 0, 0, 0, 1;
            break;
        case Facing::front:
            facing << 1, 0, 0, 0, 0, -1, 0, 1, 0;
            break;
        case Facing::back:
            facing << -1, 0, 0, 0, 0, -1, 0, -1, 0;
            break;
        case Facing::left:
            facing << 0, -1, 0, 0, 0, -1, 1, 0, 0;
            break;
        case Facing::right:
            facing << 0, 1, 0, 0, 0, -1, -1, 0, 0;
            break;
    }
    return rotation * facing;
}

StartPlaces::StartPlaces(const Cloth& cloth) : cloth_(cloth), rotation_(cloth_rotation(cloth)) {
    if (!cloth.start) return;
    const std::size_t axis = cloth.start->from.starts_with('u') ? 0 : 1;
    line_ = make_start_line(*cloth.start, cloth.size[axis] * cloth.placed_scale[axis]);
}

StartPlaces::Spot StartPlaces::unrotated(int i, int j) const {
    if (cloth_.geometry) return {cloth_.geometry->rest[static_cast<std::size_t>(i)], Vec3::UnitY()};
    const Vec2 uv = particle_uv(cloth_, i, j);
    const double width = cloth_.size[0] * cloth_.placed_scale[0];
    const double length = cloth_.size[1] * cloth_.placed_scale[1];
    Vec3 local(0, 0, (uv.y() - 0.5) * length);
    if (cloth_.wrap == Wrap::tube) {
        // v runs along +z and the front faces out, so u turns from +y (its top) towards +x.
        const double angle = 2 * std::numbers::pi * uv.x();
        // The ring whose chords, not arcs, add up to the circumference: its springs start at their rest
        // lengths.
        const int nu = cloth_.particles[0];
        const double radius = width / nu / (2 * std::sin(std::numbers::pi / nu));
        local.x() = radius * std::sin(angle);
        local.y() = radius * std::cos(angle);
        return {local, {std::sin(angle), std::cos(angle), 0}};
    }
    local.x() = (uv.x() - 0.5) * width;
    if (!line_) return {local, Vec3::UnitY()};
    // The line takes the place of one direction; the other stays straight.
    const bool along_u = cloth_.start->from.starts_with('u'), backwards = cloth_.start->from.ends_with('1');
    const double share = along_u ? uv.x() : uv.y();
    const LinePoint point = point_along(*line_, (backwards ? 1 - share : share) * (along_u ? width : length));
    Vec3 axis = along_u ? Vec3::UnitX() : Vec3::UnitZ();
    if (backwards) axis = -axis;
    local[along_u ? 0 : 2] = 0;
    return {local + point.at.x() * axis + point.at.y() * Vec3::UnitY(),
            point.normal.x() * axis + point.normal.y() * Vec3::UnitY()};
}

Vec3 StartPlaces::placed(int i, int j) const {
    return cloth_.center + rotation_ * unrotated(i, j).at;
}

Vec3 StartPlaces::started(int i, int j) const {
    const Spot spot = unrotated(i, j);
    const Vec3 x = cloth_.center + rotation_ * spot.at;
    if (cloth_.jitter == 0 && !cloth_.wrinkles) return x;
    double off = 0;
    if (cloth_.jitter != 0) {
        const auto index = static_cast<std::uint64_t>(j) * static_cast<std::uint64_t>(cloth_.particles[0]) +
                           static_cast<std::uint64_t>(i);
        off = cloth_.jitter * seeded_uniform(cloth_.seed, index);
    }
    if (cloth_.wrinkles) {
        // By where it is in the flat cloth, so that another grid or another start shape has the same
        // wrinkles.
        const Vec2 uv = particle_uv(cloth_, i, j);
        const Vec3 flat = cloth_.geometry || cloth_.wrap == Wrap::tube
                              ? spot.at
                              : Vec3(uv.x() * cloth_.size[0], 0, uv.y() * cloth_.size[1]);
        off += cloth_.wrinkles->height * smooth_noise(cloth_.wrinkles->seed, flat / cloth_.wrinkles->size);
    }
    // White noise of a tube keeps to one direction, as it always has; wrinkles and start shapes follow the
    // normal.
    const Vec3 normal = cloth_.wrinkles || line_ ? spot.normal : Vec3(Vec3::UnitY());
    return x + off * (rotation_ * normal);
}

double StartPlaces::most_displaced() const {
    return cloth_.jitter + (cloth_.wrinkles ? cloth_.wrinkles->height : 0.0);
}

Vec3 placed_particle(const Cloth& cloth, int i, int j) {
    return StartPlaces(cloth).placed(i, j);
}

std::vector<Vec3> placed_particles(const Cloth& cloth) {
    const auto [nu, nv] = cloth.particles;
    const StartPlaces places(cloth);
    std::vector<Vec3> out;
    out.reserve(static_cast<std::size_t>(nu) * static_cast<std::size_t>(nv));
    for (int j = 0; j < nv; ++j) {
        for (int i = 0; i < nu; ++i) out.push_back(places.placed(i, j));
    }
    return out;
}

bool evenly_chosen(int index, int particles, int count, bool ring) {
    if (count <= 0 || count >= particles) return true;
    if (count == 1 && !ring) return index == (particles - 1) / 2;
    const double gaps = ring ? count : count - 1, whole = ring ? particles : particles - 1;
    const auto nearest = static_cast<double>(std::lround(index * gaps / whole));
    return std::lround(nearest * whole / gaps) == index;
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
            if (pin.name.starts_with("u"))
                return i == (pin.name.ends_with("1") ? nu - 1 : 0) && evenly_chosen(j, nv, pin.count, false);
            return j == (pin.name.ends_with("1") ? nv - 1 : 0) &&
                   evenly_chosen(i, nu, pin.count, cloth.wrap == Wrap::tube);
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
