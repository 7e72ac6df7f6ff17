#include "sim/terms/cloth_contact.hpp"

#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

void find_and_push_apart(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) {
    self_collide(model, at.x, at.v, at.settings.h, at.settings.splitting.stretch_threshold,
                 memory.self_collision);
}

void add_pairs(const ClothModel&, const ForceMemory& memory, std::span<Vec3> force) {
    add_by_spring(memory.self_collision.adjacency, memory.self_collision.forces.force, force);
}

void couple_pairs(const ClothModel&, const ForcesAt& at, const ForceMemory& memory, StepCouplings& out) {
    const SelfCollisionWorkspace& own = memory.self_collision;
    out.springs.push_back({&own.springs, &own.adjacency, &own.forces, at.drift_from_start});
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
    .acts = [](const ClothModel& model) { return model.self_collision.has_value(); },
    .evaluate = find_and_push_apart,
    .add = add_pairs,
    .couple = couple_pairs,
    .may_be_implicit = [](const ClothModel&, const ForceSettings&) { return true; },
    .hides_energy = true,
    .count = count_pairs,
    .time = &StageTimes::collision,
    .effects = list_self_collision};

}  // namespace unravel::sim
