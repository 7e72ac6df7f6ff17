// libFuzzer target of the readers of meshes. The first byte chooses the format, the rest is the file. Any
// bytes have to end in a mesh whose numbers are all in range, or in a fault; what was read is mended and
// checked as a body's and a cloth's is, and an animated figure is posed.
//
//   CXX=clang++ cmake -S . -B build/fuzz -G Ninja -DUNRAVEL_BUILD_FUZZ=ON
//   cmake --build build/fuzz --target mesh_fuzz
//   mkdir -p build/meshes && build/fuzz/mesh_fuzz build/meshes tests/fuzz/meshes

#include <cstdlib>
#include <span>
#include <string>

#include "sim/mesh/check_mesh.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/mesh/read_mesh.hpp"
#include "sim/mesh/repair.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

void require(bool sound) {
    if (!sound) std::abort();
}

void require_in_range(const PolygonMesh& mesh) {
    require(mesh.file_vertex.size() == mesh.positions.size());
    require(mesh.file_face.size() == mesh.faces.size() && mesh.face_part.size() == mesh.faces.size());
    require(mesh.vertex_line.empty() || mesh.vertex_line.size() == mesh.positions.size());
    require(mesh.face_line.empty() || mesh.face_line.size() == mesh.faces.size());
    for (const PolygonMesh::Face& face : mesh.faces) {
        require(face.corners == 3 || face.corners == 4);
        for (std::size_t k = 0; k < face.corners; ++k) {
            require(face.vertex[k] < mesh.positions.size());
            require(face.uv[k] == no_index || face.uv[k] < mesh.uvs.size());
        }
    }
    for (const auto& [a, b] : mesh.lines) require(a < mesh.positions.size() && b < mesh.positions.size());
    for (const auto& [name, vertices] : mesh.groups)
        for (const std::uint32_t v : vertices) require(v < mesh.positions.size());
}

void use(PolygonMesh mesh, std::shared_ptr<const Figure> figure) {
    MeshMessages said;
    require_in_range(mesh);
    PolygonMesh cloth = mesh;
    drop_flat_faces(cloth, said);
    drop_unused_vertices(cloth, said);
    turn_alike(cloth, said);
    check_cloth_mesh(cloth, false, said);
    require_in_range(cloth);
    if (said.faults.empty()) make_mesh_cloth(std::move(cloth), 1, UpAxis::z);
    said = {};
    merge_coincident(mesh, said);
    drop_flat_faces(mesh, said);
    drop_unused_vertices(mesh, said);
    turn_alike(mesh, said);
    cap_holes(mesh, 1e300, said);
    turn_outward(mesh, said);
    check_solid_mesh(mesh, true, said);
    require_in_range(mesh);
    if (!said.faults.empty()) return;
    MeshSolid body;
    finish_solid(body, std::move(mesh), {}, {}, std::move(figure));
    body.tree.nearest({0.1, 0.2, 0.3}, 1e9);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    constexpr const char* names[] = {"a.obj", "a.ply", "a.stl", "a.glb", "a.gltf"};
    const std::string name = names[data[0] % 5];
    const std::string animation = data[0] / 5 % 2 == 0 || name[2] != 'g' ? "" : "walk";
    MeshMessages said;
    std::shared_ptr<const Figure> figure;
    PolygonMesh mesh = parse_mesh(name, std::span(data + 1, size - 1), said, animation, figure);
    if (said.faults.empty()) use(std::move(mesh), std::move(figure));
    return 0;
}
