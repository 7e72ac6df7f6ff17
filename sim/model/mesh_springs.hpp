#pragma once

#include <cstdint>

#include "sim/forces/air.hpp"
#include "sim/forces/bend.hpp"
#include "sim/forces/curvature.hpp"
#include "sim/forces/extension.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Springs of a mesh, such that a mesh and a grid of the same cloth behave alike: on a mesh that is a grid,
/// of quads or of their triangles, they are the grid's own springs and constants (model.hpp).
///
///   stretch  along every edge. A quad of area A gives k = E A/(2 L̄ L) − G L̄ L/A to an edge of length L, L̄
///   the
///            mean of it and the opposite one, which of rectangles is the grid's (sim/model/moduli.hpp); a
///            triangle k = 8/9 E A/L² (after Van Gelder 1998, whose E A/L² is that of a strip free to
///            narrow). E is that of the edge's direction in the texture: E_u cos² + E_v sin², or the mean of
///            both where there is none.
///   shear    along both diagonals d of every quad, k = G d²/A. Triangles are braced by their own edges: they
///            shear as an isotropic sheet of Poisson's ratio 1/3 would, of shear modulus E/3.
///   bend     stencils that are linear in curvature (sim/model/mesh_curvature.hpp), and arcs along every
///   edge,
///            k_b = B w with w the width that the edge stands for. By buckling alone, around every vertex
///            with quads, between the far ends of edges and diagonals that run straight
///            on through it, of the length that they have laid flat; across every edge of two triangles,
///            between the vertices opposite it. Constants are such that a cylinder of any direction has the
///            energy ½ B κ² per area.
///
/// Regions apply to springs whose ends are all in the region's group. `first` is the particle of vertex 0.
void add_mesh_stretch(const Cloth& cloth, std::uint32_t first, ExtensionSprings& springs);
/// Tells of quads whose diagonals have less than the shear modulus.
void note_mesh_shear(const Cloth& cloth, std::vector<std::string>& notes);
void add_mesh_shear(const Cloth& cloth, std::uint32_t first, ExtensionSprings& springs);
void add_mesh_curvature(const Cloth& cloth, std::uint32_t first, CurvatureStencils& stencils);
void add_mesh_arcs(const Cloth& cloth, std::uint32_t first, BendSprings& bends);
/// Bending by buckling alone.
void add_mesh_bends(const Cloth& cloth, std::uint32_t first, BendSprings& bends);

/// Density times area of each vertex. (vertices) [kg]
std::vector<double> mesh_masses(const Cloth& cloth);

/// The cells as air meets them; triangles repeat their last corner.
void add_mesh_air(const MeshCloth& mesh, std::uint32_t first, AirCells& air);

/// Whether vertex belongs to the group; a group that is not there has no vertices.
bool in_group(const MeshCloth& mesh, const std::string& group, std::uint32_t vertex);

}  // namespace unravel::sim
