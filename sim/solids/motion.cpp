#include "sim/solids/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/mesh/mesh_solid.hpp"

namespace unravel::sim {

namespace {

using Channels = Eigen::Matrix<double, 6, 1>;

Channels channels(const Keyframe& key) {
    Channels c;
    c << key.position, key.rotation;
    return c;
}

// Slope of the interpolant at keyframe k: Fritsch–Carlson's harmonic mean, zero where a channel turns round,
// so that nothing overshoots; zero at both ends.
Channels slope_at(const Motion& motion, std::size_t k) {
    Channels slope = Channels::Zero();
    if (k == 0 || k + 1 == motion.size()) return slope;
    const double before = motion[k].time - motion[k - 1].time, after = motion[k + 1].time - motion[k].time;
    const Channels left = (channels(motion[k]) - channels(motion[k - 1])) / before;
    const Channels right = (channels(motion[k + 1]) - channels(motion[k])) / after;
    for (int c = 0; c < 6; ++c) {
        if (left[c] * right[c] <= 0) continue;
        const double w1 = 2 * after + before, w2 = after + 2 * before;
        slope[c] = (w1 + w2) / (w1 / left[c] + w2 / right[c]);
    }
    return slope;
}

// At share s of the way from keyframe k to the next, which takes `span` seconds.
Channels between(const Motion& motion, std::size_t k, double span, double s) {
    const double h01 = s * s * (3 - 2 * s), h10 = s * (1 - s) * (1 - s), h11 = s * s * (s - 1);
    const Channels from = channels(motion[k]), to = channels(motion[k + 1]);
    switch (motion[k].interpolation) {
        case Interpolation::linear:
            return from + s * (to - from);
        case Interpolation::hold:
            return from;
        case Interpolation::ease:
            return from + h01 * (to - from);
        case Interpolation::smooth:
            break;
    }
    return (1 - h01) * from + h01 * to + span * (h10 * slope_at(motion, k) + h11 * slope_at(motion, k + 1));
}

// A frame that rides on a triangle: its first corner, its first edge, and its normal.
Pose triangle_frame(const std::vector<Vec3>& x, const std::array<std::uint32_t, 3>& corners) {
    const Vec3 edge = x[corners[1]] - x[corners[0]];
    const Vec3 normal = edge.cross(x[corners[2]] - x[corners[0]]).normalized();
    Pose frame = Pose::Identity();
    frame.linear().col(0) = edge.normalized();
    frame.linear().col(1) = normal;
    frame.linear().col(2) = frame.linear().col(0).cross(normal);
    frame.translation() = x[corners[0]];
    return frame;
}

// Bounces below this height end [m].
constexpr double last_bounce = 1e-3;

}  // namespace

Eigen::Matrix3d rotation_from_degrees(const Vec3& degrees) {
    const Vec3 a = degrees * (std::numbers::pi / 180.0);
    return (Eigen::AngleAxisd(a.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(a.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(a.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

MotionSample sample_motion(const Motion& motion, double t) {
    if (motion.empty()) return {};
    Channels value;
    if (t <= motion.front().time) {
        value = channels(motion.front());
    } else if (t >= motion.back().time) {
        value = channels(motion.back());
    } else {
        const auto next = std::upper_bound(motion.begin(), motion.end(), t,
                                           [](double time, const Keyframe& key) { return time < key.time; });
        const std::size_t k = static_cast<std::size_t>(next - motion.begin()) - 1;
        const double span = motion[k + 1].time - motion[k].time, s = (t - motion[k].time) / span;
        value = between(motion, k, span, s);
    }
    return {value.head<3>(), value.tail<3>()};
}

Vec3 moved_point(const Motion& motion, const Vec3& pivot, const Vec3& start, double t) {
    if (motion.empty()) return start;
    const MotionSample m = sample_motion(motion, t);
    // What does not move stays where it is to the last bit.
    if (m.displacement.isZero(0) && m.degrees.isZero(0)) return start;
    return pivot + m.displacement + rotation_from_degrees(m.degrees) * (start - pivot);
}

Vec3 fallen(const Fall& fall, double t) {
    double left = t - fall.time;
    if (left <= 0) return Vec3::Zero();
    const double g = fall.gravity.norm();
    const Vec3 up = -fall.gravity / g;
    if (!fall.floor) return left * fall.velocity + 0.5 * left * left * fall.gravity;
    double height = fall.drop, climb = up.dot(fall.velocity), hardest = 0;
    Vec3 sideways = fall.velocity - climb * up, moved = Vec3::Zero();
    const auto at = [&](double above) { return Vec3(moved + left * sideways + (above - fall.drop) * up); };
    while (true) {
        const double speed = std::sqrt(climb * climb + 2 * g * height), flight = (climb + speed) / g;
        if (left < flight) return at(height + (climb - 0.5 * g * left) * left);
        left -= flight;
        moved += flight * sideways;
        height = 0;
        climb = fall.bounce * speed;
        hardest = std::max(hardest, speed);
        const double depth = hardest > 0 ? fall.give * speed / hardest : 0;
        if (depth > 0) {
            // A quarter of a period down, and a slower one up.
            const double down = 0.5 * std::numbers::pi * depth / speed;
            if (left < down) return at(-depth * std::sin(left * speed / depth));
            left -= down;
            moved += down * sideways;
        }
        sideways *= fall.bounce;
        if (depth > 0) {
            const double rise = 0.5 * std::numbers::pi * depth / climb;  // ∞ of what stays where it falls
            if (left < rise) return at(-depth * std::cos(left * climb / depth));
            left -= rise;
            moved += rise * sideways;
        }
        if (climb * climb < 2 * g * last_bounce) return moved - fall.drop * up;
    }
}

Pose carried_pose(const Carried& carried, double t) {
    if (!carried.by) return Pose::Identity();
    const Solid& body = *carried.by;
    if (carried.triangle < 0) return solid_pose(body, t) * solid_pose(body, 0).inverse(Eigen::Isometry);
    std::vector<Vec3> surface;
    body.geometry->positions_at(t, surface);
    return ride_on_triangle(body, carried.triangle, surface, t);
}

Pose ride_on_triangle(const Solid& body, int triangle, const std::vector<Vec3>& surface, double t) {
    const auto& corners = body.geometry->triangles[static_cast<std::size_t>(triangle)];
    const Pose start = solid_pose(body, 0) * triangle_frame(body.geometry->rest, corners);
    return solid_pose(body, t) * triangle_frame(surface, corners) * start.inverse(Eigen::Isometry);
}

int carrying_triangle(const Solid& body, const Vec3& point) {
    if (!body.geometry || !body.geometry->deforms()) return -1;
    const Vec3 local = solid_pose(body, 0).inverse(Eigen::Isometry) * point;
    return static_cast<int>(
        body.geometry->tree.nearest(local, std::numeric_limits<double>::infinity()).triangle);
}

Pose solid_pose(const Solid& solid, double t) {
    Pose pose = Pose::Identity();
    pose.linear() = rotation_from_degrees(solid.rotation);
    pose.translation() = solid.center;
    if (!solid.motion.empty()) {
        pose.translation() = moved_point(solid.motion, solid.pivot, solid.center, t);
        pose.linear() = rotation_from_degrees(sample_motion(solid.motion, t).degrees) * pose.linear();
    }
    if (solid.fall) pose.translation() += fallen(*solid.fall, t);
    return solid.carried.by ? carried_pose(solid.carried, t) * pose : pose;
}

}  // namespace unravel::sim
