#include "sim/linear/sweep_preconditioner.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace unravel::sim {

namespace {

// S y for each column y of a block.
Mat3 filtered(const Constraint* c, const Mat3& block) {
    return c ? Mat3(c->S * block) : block;
}

// S_row B S_column of a symmetric block
Mat3 projected(const Mat3& block, const Constraint* row, const Constraint* column) {
    return filtered(row, filtered(column, block).transpose());
}

// f(column, A_rc) for each block below the diagonal.
template <typename F>
void each_lower(const System& A, std::uint32_t row, const F& f) {
    for (std::uint32_t e = A.start[row]; e < A.start[row + 1]; ++e) {
        const System::Entry& spring = A.entries[e];
        if (spring.column < row)
            f(spring.column, Mat3(-(spring.a * Mat3::Identity() + spring.w * spring.w.transpose())));
    }
    for (const System::Block& block : A.blocks_of(row)) {
        if (block.column < row) f(block.column, block.K.matrix());
    }
}

// S C S + c (I − S), c = trace/3 as in the constrained block.
Mat3 bordered(const Mat3& C, const Constraint* c) {
    if (!c) return C;
    return c->S * C * c->S + C.trace() / 3.0 * (Mat3::Identity() - c->S);
}

}  // namespace

void build_sweeps(const System& A, const Components& components, const Constraints& constraints,
                  const BlockPreconditioner& blocks, SweepPreconditioner& out) {
    const std::size_t rows = components.start.back();
    out.inverse.assign(blocks.inverse.begin(), blocks.inverse.end());
    out.carry.resize(A.rows());
    out.start.assign(rows + 1, 0);
    parallel_each(rows, [&](std::size_t row) {
        each_lower(A, static_cast<std::uint32_t>(row),
                   [&](std::uint32_t, const Mat3&) { ++out.start[row + 1]; });
    });
    for (std::size_t row = 0; row < rows; ++row) out.start[row + 1] += out.start[row];
    out.lower.resize(out.start[rows]);
    parallel_each(rows, [&](std::size_t row) {
        const Constraint* mine = constraints.find(components.order[row]);
        auto* const first = out.lower.data() + out.start[row];
        auto* last = first;
        each_lower(A, static_cast<std::uint32_t>(row), [&](std::uint32_t column, const Mat3& block) {
            *last++ = {column, projected(block, mine, constraints.find(components.order[column]))};
        });
        std::sort(first, last, [](const auto& a, const auto& b) { return a.column < b.column; });
        // Two springs between the same particles (one of them self-collision's), or a spring and a stencil,
        // are one block; the other stays, as zero.
        for (auto* e = first; e + 1 < last; ++e) {
            if (e->column != (e + 1)->column) continue;
            (e + 1)->block += e->block;
            e->block.setZero();
        }
    });
}

void factorise(const System& A, const Components& components, const Constraints& constraints,
               std::uint32_t begin, std::uint32_t end, SweepPreconditioner& P) {
    for (std::uint32_t i = begin; i < end; ++i) {
        const Constraint* c = constraints.find(components.order[i]);
        const auto row = [&](std::uint32_t r) {
            return std::span(P.lower).subspan(P.start[r], P.start[r + 1] - P.start[r]);
        };
        const Mat3 diagonal = bordered(A.diagonal[i], c);
        Mat3 pivot = diagonal;
        for (SweepPreconditioner::Entry& e : row(i)) {
            // L_ij = Â_ij − Σ_k L_ik E_k⁻¹ L_jkᵀ over the k < j that both rows hold
            auto other = row(e.column).begin();
            for (const SweepPreconditioner::Entry& left :
                 row(i).first(static_cast<std::size_t>(&e - row(i).data()))) {
                while (other != row(e.column).end() && other->column < left.column) ++other;
                for (; other != row(e.column).end() && other->column == left.column; ++other)
                    e.block.noalias() -= left.block * P.inverse[left.column] * other->block.transpose();
            }
            pivot.noalias() -= e.block * P.inverse[e.column] * e.block.transpose();
        }
        // Without fill-in a pivot may lose its definiteness; a thousandth of the block is the least it keeps.
        const Mat3 least = pivot - 1e-3 * diagonal;
        if (Eigen::LLT<Mat3>(least).info() != Eigen::Success) pivot = diagonal;
        Mat3 inverse = pivot.llt().solve(Mat3::Identity());
        if (c) inverse = c->S * inverse * c->S;
        P.inverse[i] = 0.5 * (inverse + inverse.transpose());
    }
}

void sweep(SweepPreconditioner& P, std::uint32_t begin, std::uint32_t end, std::span<const Vec3> r,
           std::span<Vec3> z) {
    for (std::uint32_t i = begin; i < end; ++i) {
        Vec3 sum = r[i];
        for (std::uint32_t e = P.start[i]; e < P.start[i + 1]; ++e)
            sum.noalias() -= P.lower[e].block * z[P.lower[e].column];
        z[i] = P.inverse[i] * sum;
        P.carry[i].setZero();
    }
    for (std::uint32_t i = end; i-- > begin;) {
        z[i].noalias() -= P.inverse[i] * P.carry[i];
        for (std::uint32_t e = P.start[i]; e < P.start[i + 1]; ++e)
            P.carry[P.lower[e].column].noalias() += P.lower[e].block.transpose() * z[i];
    }
}

}  // namespace unravel::sim
