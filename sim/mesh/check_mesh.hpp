#pragma once

#include <vector>

#include "sim/mesh/obj.hpp"

namespace unravel::sim {

/// Everything that keeps a mesh from being cloth, each with its vertices or faces (numbered from 1, as in the
/// file), its line and a fix: no faces, vertices that no face uses or that lie on one another, faces that
/// name a vertex twice or have no area, edges of more than two faces, and neighbours that face opposite
/// ways. Adds at most `most` faults.
void check_cloth_mesh(const ObjMesh& mesh, std::vector<MeshFault>& faults, std::size_t most = 8);

/// The same for a body that cloth meets: besides, it must be closed and its faces must look outward.
void check_solid_mesh(const ObjMesh& mesh, std::vector<MeshFault>& faults, std::size_t most = 8);

/// Area of a face: of a quad that is not flat, half the cross product of its diagonals.
double face_area(const std::vector<Vec3>& positions, const ObjMesh::Face& face);

}  // namespace unravel::sim
