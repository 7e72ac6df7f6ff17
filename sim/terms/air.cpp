#include "sim/terms/air.hpp"

#include "sim/terms/row_version.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

void push_air(const ClothModel& model, const ForcesAt& at, ForceMemory& memory, std::span<Vec3> force) {
    AirMemory& own = memory.air;
    if (own.cells.start.size() != model.size() + 1) own.cells = air_cells(model);
    own.force.resize(own.cells.corners.size());
    air_forces(own.cells, *model.wind, at.t, at.settings.h, model.mass, at.x, at.v, own.force);
    add_air(own.cells, own.force, force);
}

void blow_at_row(const RowPass& pass, std::size_t row) {
    if (row + 1 >= pass.cloth.rows()) return;
    air_row(pass.cloth.at(row), pass.cloth.at(row + 1), pass.tables.mass.row(row),
            pass.tables.mass.row(row + 1), pass.wind, static_cast<std::size_t>(pass.cloth.patch.cells_u()),
            pass.forces.row(row), pass.forces.row(row + 1));
}
const RowVersion air_rows{.reach = 1, .present = nullptr, .add = blow_at_row};

// Still air only takes.
bool blows(const ClothModel& model) {
    return model.wind && (!model.wind->velocity.isZero() || !model.wind->keyframes.empty());
}

void list_wind(const Scene& scene, std::vector<Effect>& effects) {
    const bool on = scene.wind.has_value();
    effects.push_back({"wind", on, on ? "[wind]" + place_text(scene.wind->place) : "no [wind]"});
}

}  // namespace

const ForceTerm air_term{.name = "air",
                         .acts = [](const ClothModel& model) { return model.wind.has_value(); },
                         .push = push_air,
                         .rows = &air_rows,
                         .feeds = blows,
                         .time = &StageTimes::air,
                         .effects = list_wind};

}  // namespace unravel::sim
