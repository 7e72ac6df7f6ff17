#include "sim/terms/air.hpp"

#include <algorithm>

#include "sim/terms/row_version.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

const AirCells& cells_of(const ClothModel& model, AirMemory& own) {
    if (own.cells.start.size() != model.size() + 1) own.cells = air_cells(model);
    return own.cells;
}

void find_forces(const ClothModel& model, const ForceSettings& settings, double t, std::span<const Vec3> x,
                 std::span<const Vec3> v, AirMemory& own) {
    const AirCells& cells = cells_of(model, own);
    own.force.resize(cells.corners.size());
    air_forces(cells, *model.wind, t, settings.all_explicit ? settings.h : 0.0, model.mass, x, v, own.force);
}

void push_air(const ClothModel& model, const ForcesAt& at, ForceMemory& memory, std::span<Vec3> force) {
    find_forces(model, at.settings, at.t, at.x, at.v, memory.air);
    add_air(memory.air.cells, memory.air.force, force);
}

void stiffen_air(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) {
    AirMemory& own = memory.air;
    find_stiff_air(cells_of(model, own), *model.wind, at.t, at.settings.h, model.mass, at.x, at.v, own.stiff);
}

void answer_air(const ClothModel&, const ForcesAt& at, ForceMemory& memory) {
    answer_stiff_air(at.v, memory.air.stiff);
}

void add_answer(const ClothModel&, const ForceMemory& memory, std::span<Vec3> force) {
    const StiffAir& stiff = memory.air.stiff;
    for (std::size_t s = 0; s < stiff.cells.size(); ++s) {
        const Stencil& cell = stiff.cells[s];
        for (std::uint32_t k = 0; k < cell.count; ++k) force[cell.p[k]] += cell.w[k] * stiff.answer[s];
    }
}

void couple_air(const ClothModel&, const ForcesAt&, const ForceMemory& memory, StepCouplings& out) {
    if (!memory.air.stiff.cells.empty()) out.stencils.push_back({memory.air.stiff.cells});
}

void blow_at_row(const RowPass& pass, std::size_t row) {
    if (row + 1 >= pass.cloth.rows()) return;
    air_row(pass.cloth.at(row), pass.cloth.at(row + 1), pass.tables.mass.row(row),
            pass.tables.mass.row(row + 1), pass.wind, static_cast<std::size_t>(pass.cloth.patch.cells_u()),
            pass.forces.row(row), pass.forces.row(row + 1));
}
const RowVersion air_rows{.reach = 1, .present = nullptr, .add = blow_at_row};

// Still air only takes.
bool blows(const Wind& wind) {
    return !wind.velocity.isZero() || !wind.keyframes.empty();
}

// Along the way that each cell's middle has gone.
double work_of_wind(const ClothModel& model, const StepEnds& step, ForceMemory& memory) {
    if (!blows(*model.wind)) return 0;
    AirMemory& own = memory.air;
    find_forces(model, step.settings, step.t, step.x, step.v, own);
    const auto way = [&](const std::array<std::uint32_t, 4>& corners) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t k = 0; k < corner_count(corners); ++k)
            sum += step.x_next[corners[k]] - step.x[corners[k]];
        return Vec3(sum / static_cast<double>(corner_count(corners)));
    };
    double work = 0;
    for (std::size_t c = 0; c < own.force.size(); ++c) work += own.force[c].dot(way(own.cells.corners[c]));
    answer_stiff_air(step.v_next, own.stiff);
    for (std::size_t s = 0; s < own.stiff.cells.size(); ++s)
        work += own.stiff.answer[s].dot(way(own.stiff.cells[s].p));
    return std::max(work, 0.0);
}

void list_wind(const Scene& scene, std::vector<Effect>& effects) {
    const bool there = scene.wind.has_value(), on = there && acts(*scene.wind);
    const std::string table = there ? "[wind]" + place_text(scene.wind->place) : "no [wind]";
    effects.push_back(
        {"wind", on, on || !there ? table : table + " has no density, or neither drag nor lift"});
}

}  // namespace

const ForceTerm air_term{.name = "air",
                         .acts = [](const ClothModel& model) { return model.wind.has_value(); },
                         .push = push_air,
                         .stiffen = stiffen_air,
                         .evaluate = answer_air,
                         .add = add_answer,
                         .couple = couple_air,
                         .rows = &air_rows,
                         .put_in = work_of_wind,
                         .time = &StageTimes::air,
                         .effects = list_wind};

}  // namespace unravel::sim
