#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/grid_springs.hpp"
#include "sim/kernels/stencil_kernels.hpp"
#include "sim/linear/system.hpp"

namespace unravel::sim {

struct CurvatureStencils;

/// A component's system A Δv = b (Eq. 5) on the rows of the grid that it covers, never assembled: a spring is
/// a I + w wᵀ, four floats,
///   a = h² t,   w = √(h² (k_s − t) + h k_d) û,
/// found by stencil. Nodes that are not the component's, or have no free direction, are masked: P = 0 there,
/// so that no search direction ever moves them, and what they do to their neighbours is in the first
/// residual.
///
/// Springs in single precision are off by one part in 2²⁴ each, A by the same share of itself in the energy
/// norm; b and x are kept in double, and residuals that decide are evaluated in double.
struct GridSystem {
    StencilGrid grid;  ///< of the rows that the component covers; points into the fields below
    std::uint32_t component = 0;
    std::uint32_t first_particle = 0;  ///< node (i, j) is particle first_particle + j·nu + i
    std::uint32_t rows = 0;            ///< of the component
    double stiffest = 0;               ///< largest coupling over the mass of its lighter end
    std::vector<float> couplings, mass, D, P;
    std::vector<float> active;  ///< (1 number per node) 1, or 0 where masked; rings closed
    std::vector<std::int32_t> slot;
    std::vector<double> directions;
    std::vector<float> bends;   ///< (3 numbers per node) as StencilGrid has them; empty: none
    std::vector<double> shift;  ///< field of 3, scratch of bending
    std::vector<double> b, x;   ///< fields of 3; x starts as S y + (I − S) z and ends as the solution
    std::uint32_t particle(int i, int j) const {
        return first_particle + static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(grid.nu) +
               static_cast<std::uint32_t>(i);
    }
    std::size_t field(int numbers) const;  ///< floats of a field
};

/// Bands of rows that one task takes at a time: a few thousand nodes.
struct RowBands {
    int count = 1, rows = 1, all = 1;
    explicit RowBands(const StencilGrid& g, int at_least = 1);
    int begin(int band) const { return band * rows; }
    int end(int band) const { return begin(band) + rows < all ? begin(band) + rows : all; }
};

/// Implicit bending of cloth on grids (sim/forces/curvature.hpp). Arcs between neighbours lie along the
/// threads' springs, and are part of their blocks.
struct GridBending {
    const CurvatureStencils* stencils = nullptr;
    std::span<const std::uint8_t> is_implicit;  ///< (stencils)
    const ExtensionSprings* arcs = nullptr;  ///< stiffness: the push's slope, 0 where there is none; or null
    bool any() const { return stencils && !is_implicit.empty(); }
};

/// Fills `out` with component c, whose particles all belong to `springs`; the family says where its springs
/// are linearised (`at`), and arcs likewise. `guess` is (particles) [m/s].
void load_grid_system(const GridSprings& springs, const SpringFamily& family, const Load& load,
                      const Components& components, std::uint32_t c, const Constraints& constraints,
                      std::span<const Vec3> guess, double h, GridSystem& out,
                      const GridBending& bending = {});

}  // namespace unravel::sim
