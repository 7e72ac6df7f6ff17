#include "sim/mesh/figure.hpp"

#include <algorithm>
#include <cmath>

namespace unravel::sim {

namespace {

// A quaternion of a file: x, y, z, w.
Eigen::Quaterniond quaternion(const double* xyzw) {
    const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    return q.norm() > 0 ? q.normalized() : Eigen::Quaterniond::Identity();
}

void store(const Eigen::Quaterniond& q, std::span<double> out) {
    out[0] = q.x();
    out[1] = q.y();
    out[2] = q.z();
    out[3] = q.w();
}

// Between keys k and k + 1, a share s of the way.
void sample_between(const Figure::Channel& channel, std::size_t k, double s, std::span<double> out) {
    const std::size_t width = channel.width;
    if (channel.interpolation != Figure::Interpolation::cubic) {
        const double *a = &channel.values[k * width], *b = a + width;
        if (channel.interpolation == Figure::Interpolation::step) {
            std::copy(a, a + width, out.begin());
        } else if (channel.path == Figure::Path::rotation) {
            store(quaternion(a).slerp(s, quaternion(b)), out);
        } else {
            for (std::size_t c = 0; c < width; ++c) out[c] = a[c] + s * (b[c] - a[c]);
        }
        return;
    }
    const double span = channel.times[k + 1] - channel.times[k];
    const double *a = &channel.values[3 * k * width], *b = a + 3 * width;
    const double h01 = s * s * (3 - 2 * s), h10 = s * (1 - s) * (1 - s), h11 = s * s * (s - 1);
    for (std::size_t c = 0; c < width; ++c)
        out[c] = (1 - h01) * a[width + c] + h01 * b[width + c] + span * (h10 * a[2 * width + c] + h11 * b[c]);
}

}  // namespace

void sample_channel(const Figure::Channel& channel, double t, std::span<double> out) {
    const std::vector<double>& times = channel.times;
    const auto next = std::upper_bound(times.begin(), times.end(), t);
    if (next == times.begin() || next == times.end()) {
        const std::size_t k = next == times.begin() ? 0 : times.size() - 1;
        const std::size_t at = channel.interpolation == Figure::Interpolation::cubic ? 3 * k + 1 : k;
        std::copy_n(channel.values.begin() + static_cast<std::ptrdiff_t>(at * channel.width), channel.width,
                    out.begin());
    } else {
        const auto k = static_cast<std::size_t>(next - times.begin()) - 1;
        sample_between(channel, k, (t - times[k]) / (times[k + 1] - times[k]), out);
    }
    if (channel.path == Figure::Path::rotation) store(quaternion(out.data()), out);
}

double Figure::duration() const {
    double last = 0;
    for (const Channel& channel : channels) last = std::max(last, channel.times.back());
    return last;
}

void Figure::pose(double t, std::vector<Vec3>& out) const {
    std::vector<Node> now = nodes;
    std::vector<double> value;
    for (const Channel& channel : channels) {
        value.resize(channel.width);
        sample_channel(channel, t, value);
        Node& node = now[channel.node];
        if (channel.path == Path::translation) node.translation = Vec3(value.data());
        if (channel.path == Path::scale) node.scale = Vec3(value.data());
        if (channel.path == Path::rotation) node.rotation = quaternion(value.data());
        if (channel.path == Path::weights) node.weights = value;
    }
    std::vector<Eigen::Affine3d> world(now.size());
    for (std::size_t n = 0; n < now.size(); ++n) {
        const Node& node = now[n];
        Eigen::Affine3d local = node.matrix;
        if (!node.has_matrix) {
            local.linear() = node.rotation.toRotationMatrix() * node.scale.asDiagonal();
            local.translation() = node.translation;
        }
        world[n] = node.parent == no_node ? local : world[node.parent] * local;
    }
    out = positions;
    std::vector<Eigen::Affine3d> joints;
    for (const Piece& piece : pieces) {
        const std::vector<double>& weights = now[piece.node].weights;
        for (std::size_t m = 0; m < std::min(weights.size(), piece.targets.size()); ++m) {
            if (weights[m] == 0) continue;
            for (std::uint32_t v = 0; v < piece.count; ++v)
                out[piece.first + v] += weights[m] * piece.targets[m][v].cast<double>();
        }
        if (piece.skin == no_node) {
            for (std::uint32_t v = 0; v < piece.count; ++v)
                out[piece.first + v] = world[piece.node] * out[piece.first + v];
            continue;
        }
        // A skinned mesh stands where its joints do: its own node's place is not looked at.
        const Skin& skin = skins[piece.skin];
        joints.clear();
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            joints.push_back(world[skin.joints[j]] * skin.inverse_bind[j]);
        for (std::uint32_t v = 0; v < piece.count; ++v) {
            Vec3 moved(0, 0, 0);
            for (std::uint32_t i = piece.first_influence[v]; i < piece.first_influence[v + 1]; ++i)
                moved +=
                    piece.influences[i].weight * (joints[piece.influences[i].joint] * out[piece.first + v]);
            out[piece.first + v] = moved;
        }
    }
}

}  // namespace unravel::sim
