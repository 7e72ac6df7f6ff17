#pragma once

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// What keeps a mesh, mended as far as it was asked for (repair.hpp), from being cloth, each with its line
/// and a fix: no faces, edges of more than two faces, neighbours that can't be turned alike, and, unless the
/// scene says that they stay `apart`, vertices that lie on one another.
void check_cloth_mesh(const PolygonMesh& mesh, bool apart, MeshMessages& said);

/// The same for a body that cloth meets, which must be `closed` besides where it has an inside.
void check_solid_mesh(const PolygonMesh& mesh, bool closed, MeshMessages& said);

}  // namespace unravel::sim
