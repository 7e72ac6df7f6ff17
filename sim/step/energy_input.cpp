#include "sim/step/energy_input.hpp"

#include <algorithm>
#include <limits>

#include "sim/constraints/pins.hpp"
#include "sim/constraints/touch_groups.hpp"
#include "sim/step/stage.hpp"

namespace unravel::sim {

namespace {

constexpr double uncounted = std::numeric_limits<double>::infinity();

bool blows(const ClothModel& model) {
    if (!model.wind) return false;
    const Wind& wind = *model.wind;
    const bool moves = !wind.velocity.isZero() || !wind.keyframes.empty();
    return moves && wind.density > 0 && (wind.drag > 0 || wind.lift > 0);
}

// Of a step whose parts are not looked into: whether anything that may have put energy in was there at all.
bool anything_acted(const ClothModel& model, const ClothState& before, const ClothState& after,
                    const StepReport& report, const StepWorkspace& ws) {
    const auto moved = [&](const PinnedGroup& pin) {
        const std::uint32_t p = pin.particles.front();
        return holds(pin, after.t) && after.x[p] != before.x[p];
    };
    return blows(model) || report.contacts > 0 || ws.self.springs.size() > 0 ||
           std::any_of(model.pins.begin(), model.pins.end(), moved);
}

// What pins and solids did: the impulses of constraints and of friction, along the way.
double work_of_contact(const ClothModel& model, const ClothState& before, const ClothState& after,
                       StepWorkspace& ws) {
    find_reactions(model, ws);
    double pins = 0, solids = 0;
    const std::span<const Constraint> all = ws.constraints.all();
    for (std::size_t k = 0; k < all.size(); ++k) {
        const std::uint32_t p = all[k].particle;
        const double work = ws.reaction[k].dot(after.x[p] - before.x[p]) / ws.stage.h_force;
        const bool touches =
            std::ranges::binary_search(ws.touches, p, {}, [](const Touch& t) { return t.contact.particle; });
        (touches ? solids : pins) += work;
    }
    for (const Touch& touch : ws.touches) {
        const std::uint32_t p = touch.contact.particle;
        const Vec3 friction = -touch.drag_added * tangential(touch, after.v[p]);
        solids += friction.dot(after.x[p] - before.x[p]) / ws.stage.h_force;
    }
    return std::max(pins, 0.0) + std::max(solids, 0.0);
}

// What temporary springs let go of: those of this step, as they were and as they are.
double release_of_temporary_springs(const ClothModel& model, const ClothState& before,
                                    const ClothState& after, const SelfCollisionWorkspace& self) {
    const auto energy = [&](std::size_t s, const std::vector<Vec3>& x) {
        const double e = (x[self.springs.j[s]] - x[self.springs.i[s]]).norm() - self.springs.rest[s];
        const bool acts = s < model.stitches.size() ? e > 0 : e < 0;
        return acts ? 0.5 * self.springs.stiffness[s] * e * e : 0.0;
    };
    double released = 0;
    for (std::size_t s = 0; s < self.springs.size(); ++s)
        released += energy(s, before.x) - energy(s, after.x);
    return std::max(released, 0.0);
}

double work_of_wind(const ClothModel& model, const ClothState& before, const ClothState& after, double h,
                    StepWorkspace& ws) {
    if (ws.air_cells.start.size() != model.size() + 1) ws.air_cells = air_cells(model);
    ws.air.resize(ws.air_cells.corners.size());
    air_forces(ws.air_cells, *model.wind, before.t, h, model.mass, before.x, before.v, ws.air);
    double work = 0;
    for (std::size_t c = 0; c < ws.air.size(); ++c) {
        const auto& corners = ws.air_cells.corners[c];
        const std::size_t count = corner_count(corners);
        Vec3 way = Vec3::Zero();
        for (std::size_t k = 0; k < count; ++k) way += after.x[corners[k]] - before.x[corners[k]];
        work += ws.air[c].dot(way) / static_cast<double>(count);
    }
    return std::max(work, 0.0);
}

// Whether a particle is elsewhere than the step itself had it (keep_outside()).
bool any_put_back(const ClothState& after, const StepWorkspace& ws) {
    for (std::size_t p = 0; p < after.x.size(); ++p) {
        const Vec3 v = ws.stage.v_at[p] + ws.dv[p];
        if (after.x[p] != Vec3(ws.base[p] + ws.stage.h * v)) return true;
    }
    return false;
}

}  // namespace

double energy_input(const ClothModel& model, const ClothState& after, const StepReport& report,
                    StepWorkspace& ws) {
    const ClothState& before = ws.before;
    if (report.substeps > 1 || ws.swept)
        return anything_acted(model, before, after, report, ws) ? uncounted : 0.0;
    if (!model.solids.empty() && any_put_back(after, ws)) return uncounted;
    double input = work_of_contact(model, before, after, ws);
    if (model.has_temporary_springs())
        input += release_of_temporary_springs(model, before, after, ws.self);
    if (blows(model)) input += work_of_wind(model, before, after, report.h, ws);
    return input;
}

}  // namespace unravel::sim
