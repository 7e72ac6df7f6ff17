#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Something wrong with a mesh: where in its file, what, and what would be right.
struct MeshFault {
    int line = 0;      ///< 1-based; 0: the file as a whole
    std::string what;  ///< "face 12 has no area"
    std::string hint;  ///< may be empty
};

/// Stands for "none" among indices.
inline constexpr std::uint32_t no_index = 0xFFFFFFFF;

/// A Wavefront OBJ file as it is written: its topology, nothing split, merged, triangulated or reordered.
/// Indices are from 0 here and from 1 in the file and in messages.
struct ObjMesh {
    struct Face {
        std::uint8_t corners = 0;             ///< 3 or 4
        std::array<std::uint32_t, 4> vertex;  ///< into `positions`; the last is unused in a triangle
        std::array<std::uint32_t, 4> uv;      ///< into `uvs`, or no_index
    };
    std::vector<Vec3> positions;                         ///< (vertices) exactly as the file's decimals round
    std::vector<Vec2> uvs;                               ///< (texture vertices)
    std::vector<Face> faces;                             ///< counter-clockwise from the front
    std::vector<std::array<std::uint32_t, 2>> lines;     ///< segments of `l` elements
    std::vector<int> vertex_line, face_line, line_line;  ///< where each stands in the file
    std::map<std::string, std::vector<std::uint32_t>> groups;  ///< vertices of `g` and `o`, sorted
};

/// Reads a text. Every number is rounded exactly once (std::from_chars), so that what was written with 17
/// digits comes back as it was; nothing is guessed: a line that is no OBJ, an index out of range or a limit
/// (sim/scene/limits.hpp) becomes a fault with its line, and reading stops after `most` of them. Free-form
/// curves and surfaces are refused, materials, normals and smoothing groups passed over.
ObjMesh parse_obj(std::string_view text, std::vector<MeshFault>& faults, std::size_t most = 8);

}  // namespace unravel::sim
