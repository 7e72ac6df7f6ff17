#pragma once

#include <cstdint>

#include "sim/model/model.hpp"

namespace unravel::sim {

/// Appends a mesh's seams to the model's stitches. Each is as stiff as the scene says, or as the cloth's
/// stiffest edge, and damped to a fifth of critical. `placement` and the model's springs must be there.
void add_stitches(const Cloth& cloth, const ClothPatch& patch, const Placement& placement, ClothModel& model);

/// Who never collides on meshes: particles two edges apart or nearer, cells' diagonals counting as edges and
/// seams as nothing, and particles nearer than the thickness along the mesh (of these at most 1,024 each).
void find_mesh_neighbours(ClothModel& model);

/// Middle value of the lengths of a mesh's edges. [m]
double typical_spacing(const MeshCloth& mesh);

}  // namespace unravel::sim
