#include "sim/solids/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
        const double h01 = s * s * (3 - 2 * s), h10 = s * (1 - s) * (1 - s), h11 = s * s * (s - 1);
        value = (1 - h01) * channels(motion[k]) + h01 * channels(motion[k + 1]) +
                span * (h10 * slope_at(motion, k) + h11 * slope_at(motion, k + 1));
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

Pose solid_pose(const Solid& solid, double t) {
    Pose pose = Pose::Identity();
    pose.linear() = rotation_from_degrees(solid.rotation);
    pose.translation() = solid.center;
    if (!solid.motion.empty()) {
        pose.translation() = moved_point(solid.motion, solid.pivot, solid.center, t);
        pose.linear() = rotation_from_degrees(sample_motion(solid.motion, t).degrees) * pose.linear();
    }
    return pose;
}

}  // namespace unravel::sim
