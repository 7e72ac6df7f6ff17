#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// A cloth's mesh as the simulator uses it. A cell is a quad of the file, two triangles of it that make a
/// nearly rectangular quad between them (so that a triangulated grid is the grid), or a triangle that found
/// no partner. Everything is numbered as in the file, from 0.
struct MeshCloth {
    struct Cell {
        std::uint8_t corners = 0;
        std::array<std::uint32_t, 4> vertex;  ///< counter-clockwise from the front; triangles: last unused
        std::array<std::uint32_t, 4> uv;      ///< into `uvs`, or no_index
    };
    struct Edge {
        std::uint32_t a, b;                 ///< a < b
        std::array<std::uint32_t, 2> cell;  ///< on its sides; the second is no_index along a border
    };
    std::vector<Vec3> rest;  ///< (vertices) m, y up: the file's positions, turned and scaled
    std::vector<Vec2> uvs;   ///< (texture vertices) as in the file
    std::vector<PolygonMesh::Face> faces;
    std::vector<Cell> cells;
    std::vector<Edge> edges;                          ///< of cells, sorted by (a, b)
    std::vector<std::array<std::uint32_t, 2>> seams;  ///< vertices sewn together, sorted
    std::map<std::string, std::vector<std::uint32_t>> groups;

    double length(const Edge& edge) const { return (rest[edge.b] - rest[edge.a]).norm(); }
    double area(const Cell& cell) const;
    /// Edge lengths of the box around it. [m]
    Vec3 extent() const;
};

/// Makes a cloth of a mesh without faults.
MeshCloth make_mesh_cloth(PolygonMesh mesh, double scale, UpAxis up);

/// A position of a file, scaled, with y up: z-up files are turned about x, so that (x, y, z) is (x, z, −y).
Vec3 from_file(const Vec3& x, double scale, UpAxis up);

/// Area that belongs to each vertex: a fourth of its quads, a third of its triangles. (vertices) [m²]
std::vector<double> vertex_areas(const MeshCloth& mesh);

}  // namespace unravel::sim
