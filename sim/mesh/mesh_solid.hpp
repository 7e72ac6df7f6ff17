#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/mesh/figure.hpp"
#include "sim/mesh/mesh_tree.hpp"
#include "sim/mesh/polygon_mesh.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// A body that cloth meets, as a mesh: at rest, and where it deforms its samples in time or what poses it.
struct MeshSolid {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< quads of the file cut along a diagonal
    std::vector<Vec3> rest;                  ///< (vertices) m, y up; where it deforms: as at t = 0
    std::vector<std::vector<Vec3>> samples;  ///< (samples, vertices) m; empty: it keeps its shape
    /// Of an animated figure, instead of samples: where its vertices are at a time of the animation. [m]
    std::function<void(double t, std::vector<Vec3>& out)> pose;
    double fps = 30, start = 0;             ///< as MeshFrames says
    double period = 0;                      ///< s, after which it begins again; 0: it ends
    MeshTree tree;                          ///< over `rest`
    double reach = 0;                       ///< m, from its origin to its farthest vertex, ever
    std::vector<std::string> sample_files;  ///< in the scene's folder

    bool deforms() const { return !samples.empty() || pose; }
    /// Where the vertices are at time t: between samples on straight lines, or as posed. (vertices) [m]
    void positions_at(double t, std::vector<Vec3>& out) const;
};

/// Finishes a body of which `samples`, as its files have them (every vertex of the file, in its units), are
/// set, or that a `figure` (else null) poses: `mesh`, checked, becomes its triangles and its shape, in metres
/// with y up; a `shell` [m] its two sides.
void finish_solid(MeshSolid& body, PolygonMesh mesh, const MeshFile& file, const MeshFrames& frames,
                  std::shared_ptr<const Figure> figure);

}  // namespace unravel::sim
