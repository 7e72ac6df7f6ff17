#include "sim/terms/gravity.hpp"

#include <fmt/format.h>

#include "sim/terms/measure.hpp"

namespace unravel::sim {

namespace {

void push_down(const ClothModel& model, const ForcesAt&, ForceMemory&, std::span<Vec3> force) {
    parallel_each(force.size(), [&](std::size_t p) { force[p] += model.mass[p] * model.gravity; });
}

void measure_height(const ClothModel& model, std::span<const Vec3> x, const ForceMemory&,
                    MeasureWorkspace& ws, StepReport& report) {
    report.potential -=
        ws.sum(x.size(), [&](std::size_t p) { return model.mass[p] * model.gravity.dot(x[p]); });
}

void list_gravity(const Scene& scene, std::vector<Effect>& effects) {
    const bool on = !scene.gravity.isZero();
    effects.push_back(
        {"gravity", on, on ? fmt::format("{} m/s²", scene.gravity.norm()) : "gravity = [0, 0, 0]"});
}

}  // namespace

double height_energy(const ClothModel& model, std::span<const Vec3> x) {
    double energy = 0;
    for (std::size_t p = 0; p < model.size(); ++p) energy -= model.mass[p] * model.gravity.dot(x[p]);
    return energy;
}

const ForceTerm gravity_term{.name = "gravity",
                             .acts = [](const ClothModel& model) { return !model.gravity.isZero(); },
                             .push = push_down,
                             .part_of_rows = true,
                             .measure = measure_height,
                             .effects = list_gravity};

}  // namespace unravel::sim
