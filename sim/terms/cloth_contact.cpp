#include "sim/terms/cloth_contact.hpp"

#include <algorithm>

#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

void find_and_push_apart(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) {
    self_collide(model, at.x, at.v, at.settings.h, at.settings.splitting.stretch_threshold,
                 memory.self_collision);
}

void add_pairs(const ClothModel&, const ForceMemory& memory, std::span<Vec3> force) {
    if (memory.self_collision.springs.size() == 0) return;
    add_by_spring(memory.self_collision.adjacency, memory.self_collision.forces.force, force);
}

void couple_pairs(const ClothModel&, const ForcesAt& at, const ForceMemory& memory, StepCouplings& out) {
    const SelfCollisionWorkspace& own = memory.self_collision;
    if (own.springs.size() == 0) return;
    out.springs.push_back({&own.springs, &own.adjacency, &own.forces, at.drift_from_start});
}

// They come and go, so that what they hold is not measured: what they let go of has come from them.
double release_pairs(const ClothModel&, const StepEnds& step, ForceMemory& memory) {
    const ExtensionSprings& pairs = memory.self_collision.springs;
    const auto energy = [&](std::size_t s, std::span<const Vec3> x) {
        const double short_by = pairs.rest[s] - (x[pairs.j[s]] - x[pairs.i[s]]).norm();
        return short_by > 0 ? 0.5 * pairs.stiffness[s] * short_by * short_by : 0.0;
    };
    double released = 0;
    for (std::size_t s = 0; s < pairs.size(); ++s) released += energy(s, step.x) - energy(s, step.x_next);
    return std::max(released, 0.0);
}

void count_pairs(const ForceMemory& memory, StepReport& report) {
    report.self_contacts = static_cast<std::uint32_t>(memory.self_collision.springs.size());
    report.self_distance = memory.self_collision.least_distance;
}

void list_self_collision(const Scene& scene, std::vector<Effect>& effects) {
    const bool on = scene.self_collision.has_value();
    effects.push_back(
        {"self_collision", on,
         on ? "[self_collision]" + place_text(scene.self_collision->place) : "no [self_collision]"});
}

}  // namespace

const ForceTerm self_collision_term{
    .name = "self-collision",
    .acts = [](const ClothModel& model) { return model.self_collision && !model.cloth_by_surfaces(); },
    .evaluate = find_and_push_apart,
    .add = add_pairs,
    .couple = couple_pairs,
    .may_be_implicit = [](const ClothModel&, const ForceSettings&) { return true; },
    .put_in = release_pairs,
    .count = count_pairs,
    .time = &StageTimes::collision,
    .effects = list_self_collision};

}  // namespace unravel::sim
