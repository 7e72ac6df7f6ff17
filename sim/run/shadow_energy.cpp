#include "sim/run/shadow_energy.hpp"

#include <algorithm>
#include <vector>

namespace unravel::sim {

ShadowTerms shadow_terms(const ClothModel& model, ForceMemory& forces, const ClothState& state, double h) {
    std::vector<Vec3> force(model.size()), x(model.size());
    // v·f with f at x + ahead v.
    const auto power_at = [&](double ahead) {
        for (std::size_t p = 0; p < x.size(); ++p) x[p] = state.x[p] + ahead * state.v[p];
        conservative_forces(model, x, forces, force);
        double power = 0;
        for (std::size_t p = 0; p < model.size(); ++p) power += force[p].dot(state.v[p]);
        return power;
    };
    const double ahead = power_at(h), power = power_at(0);
    double squares = 0;
    for (std::size_t p = 0; p < model.size(); ++p) squares += force[p].squaredNorm() / model.mass[p];
    for (const PinnedGroup& pin : model.pins)
        for (const std::uint32_t p : pin.particles) squares -= force[p].squaredNorm() / model.mass[p];
    return {0.5 * h * power, h * h / 12 * ((power - ahead) / h + squares)};
}

double energy_scale(const ClothModel& model, const ClothState& state, const StepReport& start) {
    double weight = 0, size = 0;
    for (const double m : model.mass) weight += m * model.gravity.norm();
    for (const ClothPatch& patch : model.cloths) size = std::max({size, patch.size[0], patch.size[1]});
    double strained = start.potential;
    for (std::size_t p = 0; p < model.size(); ++p) strained += model.mass[p] * model.gravity.dot(state.x[p]);
    return start.kinetic + std::max(strained, 0.0) + weight * size;
}

}  // namespace unravel::sim
