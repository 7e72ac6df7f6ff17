#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// A figure of a glTF file: meshes at the nodes of a tree, bent by the joints of a skeleton and by morph
/// targets, which an animation moves (glTF 2.0, 3.7 and appendix C). Metres, y up, seconds.
struct Figure {
    struct Node {
        std::uint32_t parent = no_node;  ///< stands before its children
        Vec3 translation{0, 0, 0};       ///< of the parent's frame [m]
        Eigen::Quaterniond rotation{1, 0, 0, 0};
        Vec3 scale{1, 1, 1};
        Eigen::Affine3d matrix = Eigen::Affine3d::Identity();
        bool has_matrix = false;      ///< instead of the three; such a node is never animated
        std::vector<double> weights;  ///< (targets of its mesh) of the morph targets
    };
    /// A joint that moves a vertex.
    struct Influence {
        std::uint32_t joint = 0;  ///< of the piece's skin
        double weight = 0;        ///< all of a vertex sum to 1
    };
    struct Skin {
        std::vector<std::uint32_t> joints;          ///< nodes
        std::vector<Eigen::Affine3d> inverse_bind;  ///< (joints) from the mesh's frame to the joint's
    };
    /// The vertices of a mesh at a node.
    struct Piece {
        std::uint32_t node = 0, skin = no_node;
        std::uint32_t first = 0, count = 0;                 ///< its vertices
        std::vector<std::vector<Eigen::Vector3f>> targets;  ///< (targets, count) what each adds [m]
        std::vector<std::uint32_t> first_influence;         ///< (count + 1) into `influences`
        std::vector<Influence> influences;
    };
    enum class Path : std::uint8_t { translation, rotation, scale, weights };
    enum class Interpolation : std::uint8_t { step, linear, cubic };
    /// A node's quantity over time.
    struct Channel {
        std::uint32_t node = 0;
        Path path = Path::translation;
        Interpolation interpolation = Interpolation::linear;
        std::size_t width = 3;       ///< numbers of one value
        std::vector<double> times;   ///< (keys) s, rising
        std::vector<double> values;  ///< (keys, width); cubic: (keys, 3, width), tangents about each value
    };
    static constexpr std::uint32_t no_node = 0xFFFFFFFF;

    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<Piece> pieces;
    std::vector<Vec3> positions;    ///< (vertices) in their mesh's own frame, without targets [m]
    std::vector<Channel> channels;  ///< of the animation that is played; empty: it stands still

    /// Last key of all channels. [s]
    double duration() const;
    /// Where its vertices are at time t: before the first key as at it, after the last as at that. (vertices)
    void pose(double t, std::vector<Vec3>& out) const;
};

/// A channel's value at time t, into `out` (width): between keys held, on a straight line (rotations: on the
/// shorter arc), or on a cubic Hermite spline of which the tangents are scaled by the time between the keys
/// (glTF 2.0, appendix C).
void sample_channel(const Figure::Channel& channel, double t, std::span<double> out);

}  // namespace unravel::sim
