#pragma once

#include <string_view>

#include "sim/mesh/polygon_mesh.hpp"

namespace unravel::sim {

/// Reads a Wavefront OBJ file's text: its topology, nothing split, merged or reordered, but for faces of more
/// than four corners and quads that are not convex, which are cut. Every number is rounded exactly once
/// (std::from_chars), so that what was written with 17 digits comes back as it was.
///
/// Lines end in LF, CR or both, and go on after a backslash. Elements may refer to vertices that come later.
/// A group has as many names as its line has words, and their whole, blanks included, is one more. Normals,
/// materials and smoothing groups are passed over, words that are no polygon mesh's with a note. `l` lines
/// are seams, and so are Codim-IPC's `stitch a b c ratio`, from 0: a is sewn to b or c, whichever is nearer.
///
/// A number that is none, an index out of range or a limit (sim/scene/limits.hpp) is a fault with its line.
PolygonMesh parse_obj(std::string_view text, MeshMessages& said);

}  // namespace unravel::sim
