#include "sim/terms/terms.hpp"

#include <algorithm>
#include <limits>

namespace unravel::sim {

void prepare_terms(const ClothModel& model, double h, ForceMemory& memory) {
    each_term(model, [&](const ForceTerm& term) {
        if (term.prepare) term.prepare(model, h, memory);
    });
}

void conservative_forces(const ClothModel& model, std::span<const Vec3> x, ForceMemory& memory,
                         std::span<Vec3> force) {
    const std::vector<Vec3> at_rest(x.size(), Vec3::Zero());
    constexpr double all = std::numeric_limits<double>::infinity();
    ForcesAt at;
    at.settings.splitting = {all, all, all};
    at.x = x;
    at.v = at_rest;
    std::ranges::fill(force, Vec3(Vec3::Zero()));
    each_term(model, [&](const ForceTerm& term) {
        if (!term.measure) return;
        if (term.push) {
            term.push(model, at, memory, force);
        } else {
            term.evaluate(model, at, memory);
            term.add(model, memory, force);
        }
    });
}

}  // namespace unravel::sim
