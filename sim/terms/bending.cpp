#include "sim/terms/bending.hpp"

#include <algorithm>

#include "sim/terms/measure.hpp"
#include "sim/terms/row_version.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

bool has_bends(const ClothModel& model) {
    return model.bends.size() > 0;
}

void limit_bends(const ClothModel& model, double h, ForceMemory& memory) {
    limit_bend(model.bends, model.mass, h, memory.bending.limit);
}

void evaluate_bends(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) {
    BendingMemory& own = memory.bending;
    if (own.adjacency.start.size() != model.size() + 1)
        own.adjacency = adjacency_of(model.size(), model.bends.i, model.bends.j);
    own.is_implicit = at.settings.bend_is_implicit;
    if (own.is_implicit) {
        bend_jacobians(model.bends, own.limit, at.linearised_at(), own.implicit);
    } else {
        own.force.resize(model.bends.size());
        bend_forces(model.bends, own.limit, at.x, own.force);
    }
}

void add_bends(const ClothModel&, const ForceMemory& memory, std::span<Vec3> force) {
    const BendingMemory& own = memory.bending;
    add_by_spring(own.adjacency, own.is_implicit ? own.implicit.forces.force : own.force, force);
}

void couple_bends(const ClothModel&, const ForcesAt&, const ForceMemory& memory, StepCouplings& out) {
    out.springs.push_back(
        {&memory.bending.implicit.springs, &memory.bending.adjacency, &memory.bending.implicit.forces});
}

void add_bends_of_row(const RowPass& pass, std::size_t row) {
    each_family(pass, row, bend_families,
                [&](std::size_t k, const RowState& a, const RowState& b, std::size_t count, const Row& fa,
                    const Row& fb) {
                    const GridTables::Bend& t = pass.tables.bend[k];
                    if (!t.any) return;
                    bend_row(a, b, t.rest, t.arc.row(row), t.slope.row(row), t.crossing.row(row), count, fa,
                             fb);
                });
}
const RowVersion bend_rows_version{.reach = 2,
                                   .present =
                                       [](const GridTables& tables) {
                                           return std::ranges::any_of(
                                               tables.bend, [](const GridTables::Bend& b) { return b.any; });
                                       },
                                   .add = add_bends_of_row};

void measure_bends(const ClothModel& model, std::span<const Vec3> x, const ForceMemory& memory,
                   MeasureWorkspace& ws, StepReport& report) {
    const BendSprings& bends = model.bends;
    const BendLimit& limit = memory.bending.limit;
    report.potential += ws.sum(bends.size(), [&](std::size_t s) {
        const double length = (x[bends.j[s]] - x[bends.i[s]]).norm();
        return bend_energy(length, bends.rest[s], bends.stiffness[s], limit.slope[s], limit.crossing[s]);
    });
}

bool bends_at_all(const Cloth& cloth) {
    double most = cloth.material.bend;
    for (const Region& region : cloth.regions) {
        if (region.material && !cloth.geometry) most = std::max(most, region.material->bend);
    }
    return most > 0 && (cloth.geometry || cloth.particles[0] > 2 || cloth.particles[1] > 2);
}

void list_bending(const Scene& scene, std::vector<Effect>& effects) {
    const bool on = std::ranges::any_of(scene.cloths, bends_at_all);
    effects.push_back({"bend", on, on ? "a cloth has bending stiffness" : "no cloth has bending stiffness"});
}

}  // namespace

const ForceTerm bending_term{
    .name = "bending",
    .acts = has_bends,
    .prepare = limit_bends,
    .evaluate = evaluate_bends,
    .add = add_bends,
    .couple = couple_bends,
    .may_be_implicit = [](const ForceSettings& settings) { return settings.bend_is_implicit; },
    .rows = &bend_rows_version,
    .measure = measure_bends,
    .effects = list_bending};

}  // namespace unravel::sim
