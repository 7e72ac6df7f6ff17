#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/model/model.hpp"

namespace unravel::sim {

/// A cloth's faces as they are drawn and exported, whether it is a grid or a mesh.
struct ClothSurface {
    struct Face {
        std::uint8_t corners = 0;             ///< 3 or 4
        std::array<std::uint32_t, 4> vertex;  ///< particle − patch.first; counter-clockwise from the front
        std::array<std::uint32_t, 4> uv;      ///< into `uvs`, or no_index
    };
    std::vector<Face> faces;  ///< of a mesh: as in its file
    std::vector<Vec2> uvs;    ///< of a mesh: as in its file; of a grid: [0, 1]², a tube's seam column twice
    /// Metres that a unit of uv is long, along each: of a mesh the scale that keeps its area.
    Vec2 metres{1, 1};
};

ClothSurface surface_of(const ClothPatch& patch);

}  // namespace unravel::sim
