#include "sim/terms/bending.hpp"

#include <algorithm>

#include "sim/forces/curvature_split.hpp"
#include "sim/terms/measure.hpp"
#include "sim/terms/row_version.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

bool has_bends(const ClothModel& model) {
    return model.bends.size() > 0 || model.curvature.size() > 0;
}

// Arcs are explicit until a step evaluates them otherwise.
void limit_bends(const ClothModel& model, double h, ForceMemory& memory) {
    memory.bending.is_implicit = false;
    limit_bend(model.bends, model.mass, h, memory.bending.limit);
}

void split_curvature(const ClothModel& model, const ForceSettings& settings, CurvatureSplit& split) {
    split.settings.band = settings.band;  // it has no say
    if (split.settings == settings && split.is_implicit.size() == model.curvature.size()) return;
    split.settings = settings;
    split.is_implicit =
        implicit_curvature(model.curvature, model.springs, model.mass, settings.h, settings.splitting);
    split.implicit.clear();
    for (std::size_t s = 0; s < model.curvature.size(); ++s) {
        if (split.is_implicit[s] != 0) split.implicit.push_back(curvature_stencil(model.curvature, s));
    }
}

void evaluate_arcs(const ClothModel& model, const ForcesAt& at, BendingMemory& own) {
    if (own.adjacency.start.size() != model.size() + 1)
        own.adjacency = adjacency_of(model.size(), model.bends.i, model.bends.j);
    if (own.is_implicit) {
        limit_bend(model.bends, model.mass, 0.0, own.unlimited);
        bend_jacobians(model.bends, own.unlimited, at.linearised_at(), own.implicit);
    } else {
        own.force.resize(model.bends.size());
        bend_forces(model.bends, own.limit, at.x, own.force);
    }
}

// Linear forces are the same wherever they are linearised; explicit ones are those at x*.
void evaluate_curvature(const ClothModel& model, const ForcesAt& at, BendingMemory& own) {
    const CurvatureStencils& stencils = model.curvature;
    if (own.parts.start.size() != model.size() + 1) own.parts = parts_of(stencils, model.size());
    own.pull.resize(stencils.size());
    parallel_each(stencils.size(), [&](std::size_t s) {
        const std::span<const Vec3> x = own.split.is_implicit[s] != 0 ? at.linearised_at() : at.x;
        own.pull[s] = stencils.stiffness[s] * bend_of(stencils, s, x);
    });
}

void evaluate_bends(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) {
    BendingMemory& own = memory.bending;
    split_curvature(model, at.settings, own.split);
    own.is_implicit = at.settings.splitting.bend_threshold < 0 || !own.split.implicit.empty();
    evaluate_arcs(model, at, own);
    evaluate_curvature(model, at, own);
}

void add_bends(const ClothModel& model, const ForceMemory& memory, std::span<Vec3> force) {
    const BendingMemory& own = memory.bending;
    add_by_spring(own.adjacency, own.is_implicit ? own.implicit.forces.force : own.force, force);
    add_curvature(model.curvature, own.parts, own.pull, force);
}

void couple_bends(const ClothModel& model, const ForcesAt&, const ForceMemory& memory, StepCouplings& out) {
    const BendingMemory& own = memory.bending;
    const bool curves = !own.split.implicit.empty();
    if (own.is_implicit) {
        out.bending = {&model.curvature, own.split.is_implicit, out.springs.size(),
                       curves ? out.stencils.size() : BendCouplings::none};
    }
    out.springs.push_back({&own.implicit.springs, &own.adjacency, &own.implicit.forces});
    if (curves) out.stencils.push_back({own.split.implicit});
}

bool may_be_implicit(const ClothModel& model, const ForceSettings& settings) {
    if (settings.splitting.bend_threshold < 0) return true;
    const auto implicit =
        implicit_curvature(model.curvature, model.springs, model.mass, settings.h, settings.splitting);
    return std::ranges::find(implicit, 1) != implicit.end();
}

void add_curvature_of_row(const RowPass& pass, std::size_t row) {
    const GridRows& cloth = pass.cloth;
    for (std::size_t k = 0; k < curvature_stencils.size(); ++k) {
        const GridStencil& stencil = curvature_stencils[k];
        const std::size_t last = row + static_cast<std::size_t>(stencil.rows);
        if (last >= cloth.rows() || last < pass.first) continue;
        std::array<RowPart, 4> parts;
        for (std::size_t p = 0; p < stencil.count; ++p) {
            const auto [column, down] = stencil.at[p];
            const std::size_t of = row + static_cast<std::size_t>(down);
            parts[p] = {cloth.at(of).from(column).x, from(pass.forces.row(of), column), stencil.w[p]};
        }
        curvature_row(std::span(parts).first(stencil.count), pass.tables.curvature[k].row(row),
                      base_columns(cloth.patch, stencil.columns));
    }
}

void add_bends_of_row(const RowPass& pass, std::size_t row) {
    each_family(pass, row, pass.tables.bend_families,
                [&](std::size_t k, const RowState& a, const RowState& b, std::size_t count, const Row& fa,
                    const Row& fb) {
                    const GridTables::Bend& t = pass.tables.bend[k];
                    if (!t.any) return;
                    bend_row(a, b, t.rest, t.arc.row(row), t.slope.row(row), t.crossing.row(row), count, fa,
                             fb);
                });
    if (pass.tables.curves) add_curvature_of_row(pass, row);
}
const RowVersion bend_rows_version{
    .reach = 2,
    .present =
        [](const GridTables& tables) {
            return tables.curves ||
                   std::ranges::any_of(tables.bend, [](const GridTables::Bend& b) { return b.any; });
        },
    .add = add_bends_of_row};

void measure_bends(const ClothModel& model, std::span<const Vec3> x, const ForceMemory& memory,
                   MeasureWorkspace& ws, StepReport& report) {
    const BendSprings& bends = model.bends;
    const BendLimit& limit = memory.bending.acting();
    report.potential += ws.sum(bends.size(), [&](std::size_t s) {
        const double length = (x[bends.j[s]] - x[bends.i[s]]).norm();
        return bend_energy(length, bends.rest[s], bends.stiffness[s], limit.slope[s], limit.crossing[s]);
    });
    const CurvatureStencils& stencils = model.curvature;
    report.potential += ws.sum(stencils.size(), [&](std::size_t s) {
        return 0.5 * stencils.stiffness[s] * bend_of(stencils, s, x).squaredNorm();
    });
}

// Of quadratic energy, a stencil's or an arc's whose slope is cut, it is ½ c |Δy|².
double gain_of_explicit_bends(const ClothModel& model, const StepEnds& step, const ForceMemory& memory,
                              MeasureWorkspace& ws) {
    const BendingMemory& own = memory.bending;
    const CurvatureStencils& stencils = model.curvature;
    const double gain = ws.sum(stencils.size(), [&](std::size_t s) {
        if (own.is_implicit && own.split.is_implicit[s] != 0) return 0.0;
        const Vec3 bent = bend_of(stencils, s, step.x_next) - bend_of(stencils, s, step.x);
        return 0.5 * stencils.stiffness[s] * bent.squaredNorm();
    });
    const BendSprings& bends = model.bends;
    if (own.is_implicit || own.limit.slope.size() != bends.size()) return gain;
    return gain + ws.sum(bends.size(), [&](std::size_t s) {
        const double rest = bends.rest[s], stiffness = bends.stiffness[s], slope = own.limit.slope[s],
                     crossing = own.limit.crossing[s];
        const Vec3 d = step.x[bends.j[s]] - step.x[bends.i[s]],
                   d_next = step.x_next[bends.j[s]] - step.x_next[bends.i[s]];
        const double length = d.norm();
        double more = bend_energy(d_next.norm(), rest, stiffness, slope, crossing);
        if (length < rest && length > 0) {
            more -= bend_energy(length, rest, stiffness, slope, crossing) +
                    bend_force(length, rest, stiffness, slope) / length * d.dot(d_next - d);
        }
        return more;
    });
}

bool bends_at_all(const Cloth& cloth) {
    double most = cloth.material.bend;
    for (const Region& region : cloth.regions) {
        if (region.material && !cloth.geometry) most = std::max(most, region.material->bend);
    }
    const bool wide = cloth.particles[0] > 2 || cloth.particles[1] > 2;
    const bool twists =
        cloth.bend_model == BendModel::curvature && cloth.particles[0] * cloth.particles[1] > 1;
    return most > 0 && (cloth.geometry || wide || twists);
}

void list_bending(const Scene& scene, std::vector<Effect>& effects) {
    const bool on = std::ranges::any_of(scene.cloths, bends_at_all);
    effects.push_back({"bend", on, on ? "a cloth has bending stiffness" : "no cloth has bending stiffness"});
}

}  // namespace

const ForceTerm bending_term{.name = "bending",
                             .acts = has_bends,
                             .prepare = limit_bends,
                             .evaluate = evaluate_bends,
                             .add = add_bends,
                             .couple = couple_bends,
                             .may_be_implicit = may_be_implicit,
                             .rows = &bend_rows_version,
                             .measure = measure_bends,
                             .explicit_gain = gain_of_explicit_bends,
                             .effects = list_bending};

}  // namespace unravel::sim
