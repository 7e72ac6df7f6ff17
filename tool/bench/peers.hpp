#pragma once

#include <optional>
#include <string>

#include "tool/base/names.hpp"
#include "tool/bench/folded_system.hpp"

namespace unravel::tool {

/// What a solver of linear equations took for a folded system, on one thread.
struct PeerSolve {
    double set_up = 0;   ///< s: preconditioner, or ordering and factors
    double seconds = 0;  ///< s, set-up included
    int iterations = 0;  ///< 0: direct
    Eigen::VectorXd y;
};

/// Eigen's ConjugateGradient (double, diagonal), from the step's own guess, until ‖r‖ ≤ tolerance·‖b‖ or
/// `most` iterations are done.
PeerSolve solve_by_eigen_cg(const FoldedSystem& system, double tolerance, int most);
/// Eigen's SimplicialLDLT.
PeerSolve solve_by_eigen_ldlt(const FoldedSystem& system);
/// CHOLMOD, supernodal where it finds that faster. Nothing where bench/cholmod_solve.cpp was not built, or
/// where the factorisation fails.
std::optional<PeerSolve> solve_by_cholmod(const FoldedSystem& system);

/// Whether CHOLMOD is there, and if not why.
std::string cholmod_missing();

}  // namespace unravel::tool
