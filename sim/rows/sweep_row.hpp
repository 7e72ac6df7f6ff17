#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "sim/forces/extension.hpp"
#include "sim/scene/math.hpp"

namespace unravel::sim {

/// Kernels of the explicit sweep (sim/sweep/): each works on a row of a grid, one array per coordinate, and
/// is vectorised along it. A family of springs joins base column i of row a with column i of row b; whoever
/// calls shifts the arrays so that this is so.

using ConstRow = std::array<const double*, 3>;  ///< x, y, z
using Row = std::array<double*, 3>;

struct RowState {
    ConstRow x, v;  ///< m, m/s
    RowState from(std::ptrdiff_t column) const {
        return {{x[0] + column, x[1] + column, x[2] + column}, {v[0] + column, v[1] + column, v[2] + column}};
    }
};

inline Row from(const Row& row, std::ptrdiff_t column) {
    return {row[0] + column, row[1] + column, row[2] + column};
}

/// Adds stretch or shear forces of `count` springs (sim/forces/extension.hpp) to fa, their opposites to fb
/// [N].
///   stiffness, damping  (springs) N/m, N·s/m;  rest  m
void extension_row(const RowState& a, const RowState& b, double rest, const double* stiffness,
                   const double* damping, std::size_t count, const Row& fa, const Row& fb);

/// The same, and what each spring does in an implicit–explicit step (paper Sec. 3.5), as extension_forces()
/// has it.
///   is_explicit  (springs) 1 where κ is within the threshold, else 0
///   taut         (springs) 1: will be taut at the step's end, 2: nearly; or null
///   reach        m, length up to which a slack spring that is implicit stays inactive, (1 − band) L
///   state        (springs) written; null where another does
void split_row(const RowState& a, const RowState& b, double rest, const double* stiffness,
               const double* damping, const double* is_explicit, const std::uint8_t* taut, double reach,
               std::size_t count, const Row& fa, const Row& fb, SpringState* state);

/// Marks springs longer than L: taut[i] = 1 where the ends' distance is, 0 elsewhere.
void mark_row(const ConstRow& a, const ConstRow& b, double rest, std::size_t count, std::uint8_t* taut);

/// The same for bend springs (sim/forces/bend.hpp): `arc` is 4 k_b/L² [N], `slope` the limited c_b [N/m],
/// `crossing` the length below which the arc's push is the weaker [m].
void bend_row(const RowState& a, const RowState& b, double rest, const double* arc, const double* slope,
              const double* crossing, std::size_t count, const Row& fa, const Row& fb);

/// One particle of each of a row of curvature stencils: where it is, what it gets, and its weight.
struct RowPart {
    ConstRow x;  ///< m
    Row f;       ///< N
    double w;
};

/// Adds the forces −c w_k Σ w x of `count` curvature stencils (sim/forces/curvature.hpp) of three or four
/// particles to each part's.
///   stiffness  (stencils) c [N/m]
void curvature_row(std::span<const RowPart> parts, const double* stiffness, std::size_t count);

/// What the air needs to know (sim/forces/air.hpp).
struct RowWind {
    Vec3 velocity{0, 0, 0};
    double density = 0, drag = 0, lift = 0;
    double h = 0;  ///< s, as in air_forces()
};

/// Adds the air's forces on `count` cells between rows a and b, a quarter to each corner, to fa and fb [N].
///   mass_a, mass_b  (count + 1) kg
void air_row(const RowState& a, const RowState& b, const double* mass_a, const double* mass_b,
             const RowWind& wind, std::size_t count, const Row& fa, const Row& fb);

/// v' = v + h (g + f/m), x' = x + h v' (paper Eq. 3); f is zeroed for its next use.
void advance_row(const Row& x, const Row& v, const Row& f, const double* inverse_mass, const Vec3& gravity,
                 double h, std::size_t count);

/// The largest |v|² of a row [m²/s²]; not a number where one is not.
double largest_squared_speed(const ConstRow& v, std::size_t count);

}  // namespace unravel::sim
