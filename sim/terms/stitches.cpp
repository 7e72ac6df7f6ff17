#include "sim/terms/stitches.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

void thread_stitches(const ClothModel& model, StitchMemory& own) {
    const Stitches& all = model.stitches;
    own.springs.i = all.i;
    own.springs.j = all.j;
    own.springs.stiffness.own() = all.stiffness;
    own.springs.damping.own() = all.damping;
    own.springs.rest.own().resize(all.size());
    own.springs.stretch_count = all.size();  // split as the threads of the cloth are
    own.adjacency = adjacency_of(model.size(), all.i, all.j);
}

void pull_stitches(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) {
    const Stitches& all = model.stitches;
    StitchMemory& own = memory.stitches;
    if (own.springs.size() != all.size()) thread_stitches(model, own);
    std::vector<double>& rest = own.springs.rest.own();
    for (std::size_t s = 0; s < all.size(); ++s) {
        const double left =
            all.closed[s] > 0 ? std::max(1.0 - (at.t_end - model.begin) / all.closed[s], 0.0) : 0.0;
        rest[s] = left * all.start[s];
    }
    extension_forces(own.springs, model.mass, at.x, at.v, at.settings.h, at.settings.splitting, 0.0,
                     own.forces);
}

void add_stitches(const ClothModel&, const ForceMemory& memory, std::span<Vec3> force) {
    add_by_spring(memory.stitches.adjacency, memory.stitches.forces.force, force);
}

void couple_stitches(const ClothModel&, const ForcesAt& at, const ForceMemory& memory, StepCouplings& out) {
    const StitchMemory& own = memory.stitches;
    out.springs.push_back({&own.springs, &own.adjacency, &own.forces, at.drift_from_start});
}

// With the rest lengths that they shrink to in the step: what these add at its beginning, and what stays of
// it at its end. Not measured, because it is no longer there once they have closed.
double work_of_closing(const ClothModel&, const StepEnds& step, ForceMemory& memory) {
    const ExtensionSprings& stitches = memory.stitches.springs;
    const auto energy = [&](std::size_t s, std::span<const Vec3> x) {
        return extension_energy((x[stitches.j[s]] - x[stitches.i[s]]).norm(), stitches.rest[s],
                                stitches.stiffness[s]);
    };
    double released = 0;
    for (std::size_t s = 0; s < stitches.size(); ++s) released += energy(s, step.x) - energy(s, step.x_next);
    return std::max(released, 0.0);
}

void list_seams(const Scene& scene, std::vector<Effect>& effects) {
    std::size_t seams = 0;
    for (const Cloth& cloth : scene.cloths) seams += cloth.geometry ? cloth.geometry->seams.size() : 0;
    effects.push_back(
        {"seams", seams > 0,
         seams > 0 ? fmt::format("a mesh has {} stitches (l lines)", seams) : "no mesh has seams (l lines)"});
}

}  // namespace

const ForceTerm stitch_term{.name = "stitches",
                            .acts = [](const ClothModel& model) { return model.stitches.size() > 0; },
                            .evaluate = pull_stitches,
                            .add = add_stitches,
                            .couple = couple_stitches,
                            .may_be_implicit = [](const ClothModel&, const ForceSettings&) { return true; },
                            .put_in = work_of_closing,
                            .time = &StageTimes::collision,
                            .effects = list_seams};

}  // namespace unravel::sim
