#include "sim/mesh/read_mesh.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "sim/mesh/gltf.hpp"
#include "sim/mesh/obj.hpp"
#include "sim/mesh/ply.hpp"
#include "sim/mesh/stl.hpp"

namespace unravel::sim {

namespace {

std::string lower_ending(const std::string& name) {
    const std::size_t dot = name.find_last_of("./");
    std::string ending = dot == std::string::npos || name[dot] == '/' ? "" : name.substr(dot);
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return ending;
}

}  // namespace

PolygonMesh parse_mesh(const std::string& name, std::span<const std::uint8_t> bytes, MeshMessages& said,
                       const std::string& animation, std::shared_ptr<const Figure>& figure) {
    const std::string ending = lower_ending(name);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (ending == ".glb" || ending == ".gltf") return parse_gltf(bytes, animation, said, figure);
    if (!animation.empty()) said.fault(0, "it has no animations", "only glTF files have: .glb or .gltf");
    if (ending == ".obj") return parse_obj(text, said);
    if (ending == ".ply") return parse_ply(bytes, said);
    if (ending == ".stl") return parse_stl(bytes, said);
    said.fault(
        0, ending.empty() ? "its name has no ending" : fmt::format("no mesh is read from '{}' files", ending),
        "export it as OBJ, PLY, STL or GLB");
    return {};
}

}  // namespace unravel::sim
