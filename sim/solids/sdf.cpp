#include "sim/solids/sdf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/mesh_solid.hpp"

namespace unravel::sim {

namespace {

/// v / |v| without under- or overflow, `instead` where v is zero.
template <class Vector>
Vector direction(const Vector& v, const Vector& instead) {
    const double largest = v.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return instead;
    const Vector scaled = v / largest;
    return scaled / scaled.norm();
}

/// A box of the given dimension with half edges `half`; the gradient has unit length everywhere.
template <class Vector>
double box_distance(const Vector& half, const Vector& p, Vector& gradient) {
    const Vector beyond = p.cwiseAbs() - half;
    const auto sign = [&](int axis) { return p[axis] < 0 ? -1.0 : 1.0; };
    gradient.setZero();
    int nearest = 0;
    const double largest = beyond.maxCoeff(&nearest);
    if (largest <= 0) {
        gradient[nearest] = sign(nearest);
        return largest;
    }
    Vector outside = beyond.cwiseMax(0.0);
    gradient = direction<Vector>(outside, Vector::Zero());
    for (int axis = 0; axis < gradient.size(); ++axis) gradient[axis] *= sign(axis);
    return outside.stableNorm();
}

}  // namespace

double signed_distance(const Solid& solid, const Vec3& local, Vec3* gradient) {
    Vec3 normal = Vec3::UnitY();
    double distance = 0;
    switch (solid.shape) {
        case Shape::plane:
            distance = local.y();
            break;
        case Shape::sphere:
            normal = direction<Vec3>(local, Vec3::UnitY());
            distance = local.stableNorm() - solid.radius;
            break;
        case Shape::box: {
            // A rounded box is a smaller sharp box with a skin.
            const Vec3 half = (0.5 * solid.size - Vec3::Constant(solid.round)).cwiseMax(0.0);
            distance = box_distance<Vec3>(half, local, normal) - solid.round;
            break;
        }
        case Shape::cylinder: {
            // A rectangle in the half plane of distance from the axis and height.
            const Vec2 radial(local.x(), local.z());
            const Vec2 away = direction<Vec2>(radial, Vec2::UnitX());
            const Vec2 half(std::max(solid.radius - solid.round, 0.0),
                            std::max(0.5 * solid.height - solid.round, 0.0));
            Vec2 in_plane;
            distance = box_distance<Vec2>(half, Vec2(radial.stableNorm(), local.y()), in_plane) - solid.round;
            normal = Vec3(in_plane.x() * away.x(), in_plane.y(), in_plane.x() * away.y());
            break;
        }
        case Shape::capsule: {
            const double on_axis = std::clamp(local.y(), -0.5 * solid.height, 0.5 * solid.height);
            const Vec3 off = local - Vec3(0, on_axis, 0);
            normal = direction<Vec3>(off, Vec3::UnitX());
            distance = off.stableNorm() - solid.radius;
            break;
        }
        case Shape::mesh: {
            const MeshTree::Nearest nearest =
                solid.geometry->tree.nearest(local, std::numeric_limits<double>::infinity());
            normal = nearest.normal;
            distance = nearest.distance;
            break;
        }
    }
    if (gradient) *gradient = normal;
    return distance;
}

SurfacePoint nearest_surface(const Solid& solid, const DeformedSolid* deformed, bool at_end,
                             const Vec3& local, double cutoff) {
    SurfacePoint out;
    out.carried = local;
    if (solid.shape != Shape::mesh) {
        out.distance = signed_distance(solid, local, &out.normal);
        return out;
    }
    const MeshTree& tree = !deformed ? solid.geometry->tree : at_end ? deformed->next : deformed->now;
    const MeshTree::Nearest nearest = tree.nearest(local, cutoff);
    out.distance = nearest.distance;
    out.normal = nearest.normal;
    if (deformed && nearest.distance <= cutoff) {
        const std::array<std::uint32_t, 3>& corners = tree.triangle(nearest.triangle);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = corners[static_cast<std::size_t>(k)];
            const Vec3 moved = deformed->positions_next[v] - deformed->positions_now[v];
            out.carried += (at_end ? -1.0 : 1.0) * nearest.weights[k] * moved;
        }
    }
    return out;
}

double bounding_radius(const Solid& solid) {
    switch (solid.shape) {
        case Shape::sphere:
            return solid.radius;
        case Shape::box:
            return 0.5 * solid.size.norm();
        case Shape::cylinder:
            return std::hypot(solid.radius, 0.5 * solid.height);
        case Shape::capsule:
            return solid.radius + 0.5 * solid.height;
        case Shape::mesh:
            return solid.geometry->reach;
        case Shape::plane:
            break;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace unravel::sim
