#pragma once

#include <span>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/mesh_solid.hpp"

namespace unravel::sim {

/// What a person wants to know of a mesh before trusting that it is what was meant.
struct MeshFacts {
    Vec3 extent{0, 0, 0};  ///< m, edge lengths of the box around it
    std::size_t vertices = 0;
    double spacing = 0;                               ///< m, middle value of the lengths of its edges
    std::vector<std::vector<std::uint32_t>> borders;  ///< border_loops(); of a body: none
};

MeshFacts facts_of(const MeshCloth& mesh);
MeshFacts facts_of(const MeshSolid& body);

/// "1.2 x 0.6 x 0.31 m, 9210 vertices 15 mm apart, 3 holes of 68, 28, 28 edges".
std::string facts_text(const MeshFacts& facts);

}  // namespace unravel::sim
