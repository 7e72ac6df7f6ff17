#pragma once

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// What is done to a mesh before it is checked. Each that changes something is told by one note with its
/// count, in the file's own numbers. Later ones rely on the earlier.

/// Vertices at one and the same place, or nearer than numbers of six digits tell (1e-5 of the shortest side
/// of a face), become one, the first of them; corners keep their own texture vertices. Those that a seam
/// (l line) joins stay two. Where many lie in one place, all of them.
void merge_coincident(PolygonMesh& mesh, MeshMessages& said);

/// Faces that name a vertex twice or have no area to speak of (1e-12 of the largest face), and all but the
/// first of faces with the same vertices, are dropped.
void drop_flat_faces(PolygonMesh& mesh, MeshMessages& said);

/// Vertices that no face has are dropped, from groups and seams, too.
void drop_unused_vertices(PolygonMesh& mesh, MeshMessages& said);

/// Neighbours that face opposite ways are turned to face the same way, the fewest of each piece. A piece for
/// which there is none (a Möbius strip) stays as it is.
void turn_alike(PolygonMesh& mesh, MeshMessages& said);

/// Closed pieces whose faces look inward are turned; not one that lies in the box around another, which may
/// be that one's hollow.
void turn_outward(PolygonMesh& mesh, MeshMessages& said);

/// Holes, as border_loops() gives them, are closed by faces between the vertices that are there: all of them,
/// or those of which the area is at most `largest` of the surface's.
void cap_holes(PolygonMesh& mesh, double largest, MeshMessages& said);

/// Pairs of vertices that merge_coincident() would make one: (later, first), sorted.
std::vector<std::array<std::uint32_t, 2>> coincident_vertices(const PolygonMesh& mesh);

/// Keeps the faces of an object or a group (empty: of any), with what belongs to them. False: there is none.
bool keep_part(PolygonMesh& mesh, const std::string& object, const std::string& group);

/// Area of a face: of a quad that is not flat, half the cross product of its diagonals.
double face_area(const std::vector<Vec3>& positions, const PolygonMesh::Face& face);

}  // namespace unravel::sim
