#include "sim/forces/curvature.hpp"

namespace unravel::sim {

void CurvatureStencils::add(std::span<const std::uint32_t> particles, std::span<const double> weights,
                            double c) {
    std::array<std::uint32_t, 4>& ends = p.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
        ends[k] = k < particles.size() ? particles[k] : particles[0];
        w[k].push_back(k < particles.size() ? weights[k] : 0.0);
    }
    stiffness.push_back(c);
}

std::size_t CurvatureStencils::bytes() const {
    std::size_t sum = p.size() * sizeof(p[0]) + stiffness.bytes();
    for (const Coefficients& weights : w) sum += weights.bytes();
    return sum;
}

CurvatureParts parts_of(const CurvatureStencils& stencils, std::size_t particles) {
    CurvatureParts out;
    out.start.assign(particles + 1, 0);
    const auto each = [&](const auto& f) {
        for (std::uint32_t s = 0; s < stencils.size(); ++s) {
            for (std::uint32_t k = 0; k < stencils.count(s); ++k) f(s, k, stencils.p[s][k]);
        }
    };
    each([&](std::uint32_t, std::uint32_t, std::uint32_t p) { ++out.start[p + 1]; });
    for (std::size_t p = 0; p < particles; ++p) out.start[p + 1] += out.start[p];
    out.parts.resize(out.start.back());
    std::vector<std::uint32_t> next(out.start.begin(), out.start.end() - 1);
    each([&](std::uint32_t s, std::uint32_t k, std::uint32_t p) { out.parts[next[p]++] = {s, k}; });
    return out;
}

void add_curvature(const CurvatureStencils& stencils, const CurvatureParts& parts, std::span<const Vec3> pull,
                   std::span<Vec3> force) {
    parallel_each(force.size(), [&](std::size_t p) {
        for (std::uint32_t k = parts.start[p]; k < parts.start[p + 1]; ++k) {
            const auto [s, slot] = parts.parts[k];
            force[p] -= stencils.w[slot][s] * pull[s];
        }
    });
}

Stencil curvature_stencil(const CurvatureStencils& stencils, std::size_t s) {
    Stencil out;
    out.count = stencils.count(s);
    for (std::uint32_t k = 0; k < out.count; ++k) {
        out.p[k] = stencils.p[s][k];
        out.w[k] = stencils.w[k][s];
    }
    out.along = out.across = stencils.stiffness[s];
    return out;
}

}  // namespace unravel::sim
