#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/image.hpp"
#include "sim/linear/components.hpp"
#include "sim/model/model.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// Where a block matrix has its 3×3 blocks (paper Figs 3–5).
struct Pattern {
    std::string title;
    std::uint32_t rows = 0;                               ///< block rows, and columns
    std::vector<std::array<std::uint32_t, 2>> entries{};  ///< row, column; the diagonal and both triangles
    std::vector<std::array<std::uint32_t, 2>> blocks{};   ///< outlined: rows [begin, end) of a component
};

/// A of the fully implicit scheme: every spring of the cloth couples its ends, bend springs included (Fig.
/// 3).
Pattern implicit_pattern(const ClothModel& model);

/// A of a step as assembled, in particle order: springs handled implicitly (Fig. 4). `springs` (stretch and
/// shear); `extra`: pairs of temporary springs handled implicitly.
Pattern step_pattern(const ClothModel& model, const std::vector<SpringState>& springs,
                     const std::vector<std::array<std::uint32_t, 2>>& extra);

/// The same with rows reordered by component, which are outlined (Fig. 5). Rows of the fully constrained come
/// last; their couplings are left out, as the solver has them in b.
Pattern reordered_pattern(const Pattern& pattern, const Components& components);

/// Drawings: a dot per block where it can be seen, else the density of blocks per pixel.
std::string pattern_svg(const Pattern& pattern);
Image pattern_image(const Pattern& pattern, double scale = 2);

}  // namespace unravel::tool
