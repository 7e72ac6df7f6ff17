#include "sim/linear/system.hpp"

#include <cmath>

#include "sim/linear/assemble_stencils.hpp"

namespace unravel::sim {

namespace {

// What one implicit spring puts into A and b.
struct Coupling {
    double a;              // h² t
    double scale;          // h² (k_s − t) + h k_d, on ûûᵀ
    double along, across;  // k_s − t and t, on drift
    Vec3 u;
};

Coupling coupling_of(const SpringFamily& family, std::uint32_t s, double h) {
    const auto [u, t] = line_of(family, s);
    const double k = family.springs->stiffness[s];
    return {h * h * t, h * h * (k - t) + h * family.springs->damping[s], k - t, t, u};
}

}  // namespace

void assemble(const Couplings& couplings, const Load& load, const Components& components,
              const Constraints& constraints, double h, System& out,
              std::span<const std::uint8_t> elsewhere) {
    const std::size_t n = load.mass.size();
    // In the undecomposed system the fully constrained have rows like any other; S keeps them from moving.
    const std::uint32_t solved = components.start.back();
    out.row_of.resize(n);
    out.start.resize(n + 1);
    out.diagonal.resize(n);
    out.b.resize(n);
    out.elsewhere.assign(elsewhere.begin(), elsewhere.end());
    const auto left_out = [&](std::size_t row, std::uint32_t p) {
        return !solved_in(out, components, row) && !constraints.find(p);
    };
    parallel_each(
        n, [&](std::size_t row) { out.row_of[components.order[row]] = static_cast<std::uint32_t>(row); });
    const auto moved_to_b = [&](std::uint32_t row, std::uint32_t other) {
        return row < solved && out.row_of[other] >= solved;
    };

    out.start[0] = 0;
    parallel_each(n, [&](std::size_t r) {
        const auto row = static_cast<std::uint32_t>(r);
        const std::uint32_t p = components.order[row];
        std::uint32_t count = 0;
        out.start[row + 1] = 0;
        if (left_out(row, p)) return;
        for (const SpringFamily& family : couplings.springs) {
            family.adjacency->each(p, [&](std::uint32_t s, std::uint32_t other) {
                count += family.forces->state[s] == SpringState::implicit && !moved_to_b(row, other);
            });
        }
        out.start[row + 1] = count;
    });
    for (std::size_t row = 0; row < n; ++row) out.start[row + 1] += out.start[row];
    out.entries.resize(out.start[n]);

    parallel_each(n, [&](std::size_t r) {
        const auto row = static_cast<std::uint32_t>(r);
        const std::uint32_t p = components.order[row];
        if (left_out(row, p)) return;
        Mat3 diagonal = load.mass[p] * Mat3::Identity();
        Vec3 b = load.impulse[p];
        std::uint32_t e = out.start[row];
        for (const SpringFamily& family : couplings.springs) {
            const std::span<const Vec3> drift = family.drift.empty() ? load.drift : family.drift;
            family.adjacency->each(p, [&](std::uint32_t s, std::uint32_t other) {
                if (family.forces->state[s] != SpringState::implicit) return;
                const Coupling c = coupling_of(family, s, h);
                diagonal.noalias() += c.scale * c.u * c.u.transpose();
                diagonal.diagonal().array() += c.a;
                const Vec3 g = drift[other] - drift[p];
                b += h * (c.across * g + c.along * c.u.dot(g) * c.u);
                if (moved_to_b(row, other)) {
                    const Vec3& z = constraints.find(other)->z;
                    b += c.a * z + c.scale * c.u.dot(z) * c.u;
                } else {
                    out.entries[e++] = {out.row_of[other], c.a, std::sqrt(c.scale) * c.u};
                }
            });
        }
        out.diagonal[row] = diagonal;
        out.b[row] = b;
    });
    assemble_stencils(couplings.stencils, load, components, constraints, h, out);
}

}  // namespace unravel::sim
