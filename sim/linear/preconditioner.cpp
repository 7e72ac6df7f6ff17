#include "sim/linear/preconditioner.hpp"

#include <Eigen/LU>

namespace unravel::sim {

namespace {

// Rounding leaves an inverse unsymmetric; conjugate gradients want it otherwise.
Mat3 symmetric(const Mat3& M) {
    return 0.5 * (M + M.transpose());
}

Mat3 inverse_block(Preconditioner kind, const Mat3& C, const Constraint* constraint) {
    if (!constraint) {
        switch (kind) {
            case Preconditioner::none:
                return Mat3::Identity();
            case Preconditioner::diagonal:
                return C.diagonal().cwiseInverse().asDiagonal();
            default:
                return symmetric(C.inverse());
        }
    }
    const Mat3& S = constraint->S;
    if (constraint->free == 0) return Mat3::Zero();
    switch (kind) {
        case Preconditioner::none:
            return S;
        case Preconditioner::diagonal:
            return S * C.diagonal().cwiseInverse().asDiagonal() * S;
        case Preconditioner::block:
            return S * C.inverse() * S;
        default:
            break;
    }
    // c = trace/3 keeps the bordered block as well conditioned as C itself.
    const Mat3 bordered = S * C * S + C.trace() / 3.0 * (Mat3::Identity() - S);
    return symmetric(S * bordered.inverse() * S);
}

}  // namespace

void build_preconditioner(Preconditioner kind, const System& A, const Components& components,
                          const Constraints& constraints, BlockPreconditioner& out) {
    out.inverse.resize(A.rows());
    parallel_each(components.start.back(), [&](std::size_t row) {
        if (!solved_in(A, components, row)) return;
        out.inverse[row] = inverse_block(kind, A.diagonal[row], constraints.find(components.order[row]));
    });
}

}  // namespace unravel::sim
