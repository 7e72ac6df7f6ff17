#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/mesh/mesh_tree.hpp"
#include "sim/mesh/obj.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// A body that cloth meets, as a mesh: at rest, and where it deforms also its samples in time.
struct MeshSolid {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< quads of the file cut along a diagonal
    std::vector<Vec3> rest;                  ///< (vertices) m, y up; where it deforms: as at t = 0
    std::vector<std::vector<Vec3>> samples;  ///< (samples, vertices) m; empty: it keeps its shape
    double fps = 30, start = 0;              ///< of the samples, as MeshFrames says
    MeshTree tree;                           ///< over `rest`
    double reach = 0;                        ///< m, from its origin to its farthest vertex, ever
    std::vector<std::string> sample_files;   ///< in the scene's folder

    bool deforms() const { return !samples.empty(); }
    /// Where the vertices are at time t: between samples on straight lines. (vertices) [m]
    void positions_at(double t, std::vector<Vec3>& out) const;
};

}  // namespace unravel::sim
