#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// Something wrong with a mesh: where in its file, what, and what would be right.
struct MeshFault {
    int line = 0;      ///< 1-based; 0: the file as a whole, or a format without lines
    std::string what;  ///< "face 12 has no area"
    std::string hint;  ///< may be empty
};

/// What is told of a mesh while it is read, mended and checked.
struct MeshMessages {
    std::vector<MeshFault> faults;   ///< the mesh can't be used
    std::vector<std::string> notes;  ///< what was passed over or mended, each kind once with its count
    std::size_t most = 8;            ///< faults that are kept

    bool full() const { return faults.size() >= most; }
    void fault(int line, std::string what, std::string hint = {}) {
        if (!full()) faults.push_back({line, std::move(what), std::move(hint)});
    }
};

/// Stands for "none" among indices.
inline constexpr std::uint32_t no_index = 0xFFFFFFFF;

/// Farther than this from the origin is a slip or a wrong unit, and squares of it are still safe.
inline constexpr double largest_coordinate = 1e7;

/// A mesh as its file has it, whatever the format. Indices are from 0 here and from 1 in messages, where
/// vertices and faces have the file's own numbers also once some were dropped, merged or cut.
struct PolygonMesh {
    struct Face {
        std::uint8_t corners = 0;             ///< 3 or 4
        std::array<std::uint32_t, 4> vertex;  ///< into `positions`; the last is unused in a triangle
        std::array<std::uint32_t, 4> uv;      ///< into `uvs`, or no_index
    };
    /// The names that hold for a face: those of `o` lines, and those of `g` lines.
    struct Part {
        std::vector<std::string> objects, groups;
    };
    std::vector<Vec3> positions;                      ///< (vertices) exactly as the file's decimals round
    std::vector<Vec2> uvs;                            ///< (texture vertices) v upwards
    std::vector<Face> faces;                          ///< counter-clockwise from the front
    std::vector<std::array<std::uint32_t, 2>> lines;  ///< segments of `l` elements: seams
    std::vector<Part> parts;
    std::vector<std::uint32_t> face_part;                      ///< (faces) into `parts`
    std::map<std::string, std::vector<std::uint32_t>> groups;  ///< vertices by every name, sorted

    std::vector<std::uint32_t> file_vertex, file_face;  ///< (vertices), (faces) which of the file they are
    std::vector<int> vertex_line, face_line;  ///< where each stands in the file; empty: it has no lines
    std::size_t file_vertices = 0;            ///< in the file: its samples have as many
    std::size_t flat_faces = 0;               ///< faces of no three corners, which are not among `faces`

    int line_of_vertex(std::size_t v) const { return vertex_line.empty() ? 0 : vertex_line[v]; }
    int line_of_face(std::size_t f) const { return face_line.empty() ? 0 : face_line[f]; }
    void add_face(const Face& face, std::uint32_t part, std::uint32_t number, int line);
};

inline void PolygonMesh::add_face(const Face& face, std::uint32_t part, std::uint32_t number, int line) {
    faces.push_back(face);
    face_part.push_back(part);
    file_face.push_back(number);
    if (line > 0) face_line.push_back(line);
}

/// "1 vertex", "12 vertices".
std::string counted(std::size_t count, const char* one, const char* many);

/// Adds a face of any number of corners, cut into triangles and quads where it has more than four or is not
/// convex (cut_polygon.hpp); one whose corners are no three points is counted as flat. True: it was cut.
bool add_polygon(PolygonMesh& mesh, std::vector<std::uint32_t> vertex, std::vector<std::uint32_t> uv,
                 std::uint32_t part, std::uint32_t number, int line);

/// Notes how many faces add_polygon() has cut; nothing where there are none.
void note_cut_faces(std::size_t cut, MeshMessages& said);

/// Sorts and makes unique the vertices of every group, and takes the file's numbering for the mesh's own.
void finish_numbering(PolygonMesh& mesh);

}  // namespace unravel::sim
