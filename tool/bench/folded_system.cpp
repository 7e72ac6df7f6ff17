#include "tool/bench/folded_system.hpp"

#include <cmath>

#include "sim/linear/preconditioner.hpp"

namespace unravel::tool {

namespace {

double norm_in(const std::vector<Mat3>& measure, const Eigen::VectorXd& r) {
    double sum = 0;
    for (std::size_t k = 0; k < measure.size(); ++k) {
        const Vec3 at = r.segment<3>(static_cast<Eigen::Index>(3 * k));
        sum += at.dot(measure[k] * at);
    }
    return std::sqrt(sum);
}

}  // namespace

double FoldedSystem::residual(const Eigen::VectorXd& y) const {
    const double whole = norm_in(measure, b);
    return whole > 0 ? norm_in(measure, b - A * y) / whole : 0.0;
}

Eigen::VectorXd FoldedSystem::unknowns(std::span<const Vec3> dv) const {
    Eigen::VectorXd y(b.size());
    for (std::size_t k = 0; k < rows(); ++k)
        y.segment<3>(static_cast<Eigen::Index>(3 * k)) = dv[particles[k]] - prescribed[k];
    return y;
}

FoldedSystem fold(const StepSystem& step, const System& rows) {
    const Components& components = step.components;
    const std::uint32_t count = components.start.back();
    FoldedSystem out;
    out.particles.assign(components.order.begin(), components.order.begin() + count);
    std::vector<Mat3> S(count, Mat3::Identity());
    out.prescribed.assign(count, Vec3::Zero());
    for (std::uint32_t row = 0; row < count; ++row) {
        const Constraint* c = step.constraints.find(out.particles[row]);
        if (!c) continue;
        S[row] = c->S;
        out.prescribed[row] = c->z - c->S * c->z;
    }
    BlockPreconditioner stopping;
    build_preconditioner(Preconditioner::constrained_block, rows, components, step.constraints, stopping);
    out.measure.assign(stopping.inverse.begin(), stopping.inverse.begin() + count);

    std::vector<Vec3> z(components.order.size(), Vec3::Zero());
    std::copy(out.prescribed.begin(), out.prescribed.end(), z.begin());
    const auto size = static_cast<Eigen::Index>(3 * count);
    out.b.resize(size);
    out.start.resize(size);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(9 * (count + rows.start[count]));
    const auto add = [&](std::uint32_t r, std::uint32_t c, const Mat3& block) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                entries.emplace_back(static_cast<int>(3 * r) + i, static_cast<int>(3 * c) + j, block(i, j));
    };
    for (std::uint32_t row = 0; row < count; ++row) {
        const auto at = static_cast<Eigen::Index>(3 * row);
        out.b.segment<3>(at) = S[row] * (rows.b[row] - row_times(rows, row, z));
        out.start.segment<3>(at) = S[row] * step.guess[out.particles[row]];
        const double own = rows.diagonal[row].trace() / 3;
        add(row, row, S[row] * rows.diagonal[row] * S[row] + own * (Mat3::Identity() - S[row]));
        for (std::uint32_t e = rows.start[row]; e < rows.start[row + 1]; ++e) {
            const System::Entry& entry = rows.entries[e];
            const Mat3 block = entry.a * Mat3::Identity() + entry.w * entry.w.transpose();
            add(row, entry.column, -(S[row] * block * S[entry.column]));
        }
        for (const System::Block& block : rows.blocks_of(row))
            add(row, block.column, S[row] * block.K.matrix() * S[block.column]);
    }
    out.A.resize(size, size);
    out.A.setFromTriplets(entries.begin(), entries.end());
    return out;
}

}  // namespace unravel::tool
