#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/forces/coefficients.hpp"
#include "sim/forces/stencil.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Bending that is linear in curvature: three or four particles whose weighted sum y = Σ w_k x_k vanishes
/// where they lie flat, however they are moved and turned, and is else the surface's second derivative times
/// an area that the stencil is made for. Energy ½ c |y|², quadratic in positions (Bergou, Wardetzky, Harmon,
/// Zorin & Grinspun, "A quadratic bending model for inextensible surfaces", 2006): forces −c w_k y are
/// linear, their Jacobian is constant and semidefinite.
///
/// On grids of cells a × b the energy ½ B ∫ |x_uu|² + 2 |x_uv|² + |x_vv|² is that of x₋ − 2x + x₊ along both
/// directions of threads, c = B b/a³ and B a/b³, and of the twist of every cell, c = 2 B/(a b). Rolled to a
/// cylinder of any direction the cloth then holds ½ B κ² per area, and a narrow strip bends as a wide one.
struct CurvatureStencils {
    std::vector<std::array<std::uint32_t, 4>> p;  ///< (stencils) particles; of three the first once more
    std::array<Coefficients, 4> w;                ///< (stencils) weights; the last is 0 where there are three
    Coefficients stiffness;                       ///< (stencils) c [N/m]
    std::size_t size() const { return p.size(); }
    std::uint32_t count(std::size_t s) const { return w[3][s] == 0 ? 3 : 4; }
    void add(std::span<const std::uint32_t> particles, std::span<const double> weights, double c);
    std::size_t bytes() const;
};

/// Particles a, b, c in a line at even distances; and a cell's four, in order round it.
inline constexpr std::array<double, 3> line_weights{1, -2, 1};
inline constexpr std::array<double, 4> twist_weights{1, -1, 1, -1};

/// y of one stencil [m]. (particles)
inline Vec3 bend_of(const CurvatureStencils& stencils, std::size_t s, std::span<const Vec3> x) {
    Vec3 y = Vec3::Zero();
    for (std::uint32_t k = 0; k < stencils.count(s); ++k) y += stencils.w[k][s] * x[stencils.p[s][k]];
    return y;
}

/// The stencils of each particle.
struct CurvatureParts {
    struct Part {
        std::uint32_t stencil, slot;
    };
    std::vector<std::uint32_t> start;  ///< (particles + 1) particle p's are parts [start[p], start[p+1])
    std::vector<Part> parts;           ///< sorted by stencil
    std::size_t bytes() const { return start.size() * sizeof(std::uint32_t) + parts.size() * sizeof(Part); }
};
CurvatureParts parts_of(const CurvatureStencils& stencils, std::size_t particles);

/// Adds −w_k of `pull`, (stencils) c y [N], to each particle. (particles)
void add_curvature(const CurvatureStencils& stencils, const CurvatureParts& parts, std::span<const Vec3> pull,
                   std::span<Vec3> force);

/// A stencil as the linear system takes it.
Stencil curvature_stencil(const CurvatureStencils& stencils, std::size_t s);

}  // namespace unravel::sim
