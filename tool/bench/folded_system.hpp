#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "sim/step/solve_components.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// A step's system (Eq. 9) as any solver of linear equations takes it: three scalar rows per particle that is
/// not fully constrained, S folded in for those that are partly:
///   A' = S A S + c (I − S),   b' = S (b − A (I − S) z),   x = y + (I − S) z  with  A' y = b'.
/// c is of the size of the particle's own block, so that it changes neither condition nor solution.
struct FoldedSystem {
    Eigen::SparseMatrix<double> A;         ///< symmetric positive definite, both triangles [kg]
    Eigen::VectorXd b;                     ///< kg·m/s
    Eigen::VectorXd start;                 ///< S times the step's own guess [m/s]
    std::vector<std::uint32_t> particles;  ///< (block rows)
    std::vector<Vec3> prescribed;          ///< (block rows) (I − S) z [m/s]
    std::vector<Mat3>
        measure;  ///< (block rows) P⁻¹ S of sim/linear/preconditioner.hpp: the norm of its stopping rule

    std::size_t rows() const { return particles.size(); }
    /// ‖b' − A' y‖ / ‖b'‖ in the norm that SolveOptions::tolerance is measured in.
    double residual(const Eigen::VectorXd& y) const;
    /// y of a solution by particle [m/s].
    Eigen::VectorXd unknowns(std::span<const Vec3> dv) const;
};

/// Folds what a step has assembled in rows for all of its components.
FoldedSystem fold(const StepSystem& step, const System& rows);

}  // namespace unravel::tool
