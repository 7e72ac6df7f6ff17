#include "sim/step/energy_input.hpp"

#include <algorithm>
#include <limits>

#include "sim/constraints/friction.hpp"
#include "sim/constraints/pins.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/sdf.hpp"
#include "sim/step/stage.hpp"

namespace unravel::sim {

namespace {

StepEnds ends_of(const ClothState& after, const StepWorkspace& ws) {
    return {ws.plan.forces.settings, ws.before.t, ws.before.x, ws.before.v, after.x, after.v};
}

double input_of_forces(const ClothModel& model, const StepEnds& ends, StepWorkspace& ws) {
    double input = 0;
    each_term(model, [&](const ForceTerm& term) {
        if (term.put_in) input += term.put_in(model, ends, ws.forces.memory);
    });
    return input;
}

// A solid that stands still takes only; putting particles out of it is no work that the cloth may keep.
bool moves(const Solid& solid) {
    return solid.moves() || (solid.geometry && solid.geometry->deforms());
}

// Of a step of several parts: whether anything that may have put energy in was there at all.
bool anything_acted(const ClothModel& model, const ClothState& after, const StepReport& report,
                    StepWorkspace& ws) {
    const ClothState& before = ws.before;
    const auto moved = [&](const PinnedGroup& pin) {
        const std::uint32_t p = pin.particles.front();
        return holds(pin, after.t) && after.x[p] != before.x[p];
    };
    StepEnds ends = ends_of(after, ws);
    ends.settings = ws.plan.step.forces.settings;
    const bool touched =
        report.contacts > 0 || !before.contacts.empty() || !ws.contact.surfaces.stencils.empty();
    return (touched && std::ranges::any_of(model.solids, moves)) || std::ranges::any_of(model.pins, moved) ||
           input_of_forces(model, ends, ws) > 0;
}

// What pins and solids did: the impulses of constraints and of friction, along the way.
double work_of_constraints(const ClothModel& model, const ClothState& after, StepWorkspace& ws) {
    const ClothState& before = ws.before;
    const ContactStage& contact = ws.contact;
    find_reactions(model, ws);
    const std::span<const Constraint> all = ws.constraints.all();
    const auto work = [&](std::size_t k, std::uint32_t p, std::span<const Touch> touches) {
        Vec3 impulse = contact.reactions.impulse[k];
        for (const Touch& touch : touches) impulse += friction_impulse(touch, all[k], after.v[p]);
        return impulse.dot(after.x[p] - before.x[p]) / ws.stage.h_force;
    };
    double pins = 0, solids = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const std::uint32_t p = all[k].particle;
        const std::span<const Touch> touches = std::ranges::equal_range(
            contact.touches, p, {}, [](const Touch& t) { return t.contact.particle; });
        const auto moved = [&](const Touch& touch) { return moves(model.solids[touch.contact.solid]); };
        if (touches.empty()) {
            pins += work(k, p, touches);
        } else if (std::ranges::any_of(touches, moved)) {
            solids += work(k, p, touches);
        }
    }
    return std::max(pins, 0.0) + std::max(solids, 0.0);
}

// What moving solids did through edges and faces: pushes and friction as the solve had them, along the way.
double work_on_surfaces(const ClothModel& model, StepWorkspace& ws) {
    const SurfaceContactWorkspace& surfaces = ws.contact.surfaces;
    const Stage& stage = ws.stage;
    double work = 0;
    for (std::size_t k = 0; k < surfaces.stencils.size(); ++k) {
        const Stencil& c = surfaces.stencils[k];
        if (!moves(model.solids[static_cast<std::size_t>(surfaces.solid[k])])) continue;
        Vec3 way = Vec3::Zero(), change = Vec3::Zero();
        for (std::uint32_t i = 0; i < c.count; ++i) {
            const std::uint32_t p = c.p[i];
            const Vec3& dv = ws.linear.dv[p];
            way += c.w[i] * (ws.base()[p] + stage.h * (stage.v_at[p] + dv) - ws.before.x[p]);
            change += c.w[i] * dv;
        }
        Vec3 force = surfaces.force[k];
        if (surfaces.state[k] == SpringState::implicit) {
            const double along = c.along * c.u.dot(way) + c.damping_along * c.u.dot(change);
            force -= along * c.u + c.damping_across * (change - c.u.dot(change) * c.u);
        }
        work += force.dot(way);
    }
    return std::max(work, 0.0);
}

// Whether cloth touched cloth between surfaces. What layers hold between them is measured by nobody, and what
// is stopped after the solve is not mended by solving again.
bool layers_touched(const StepWorkspace& ws) {
    return std::ranges::any_of(ws.contact.surfaces.solid, [](std::int32_t solid) { return solid < 0; });
}

// Whether a particle at x, at the step's end, is inside a solid that moves.
bool in_moving_solid(const ClothModel& model, const SolidPoses& poses, const Vec3& x) {
    for (std::size_t s = 0; s < model.solids.size(); ++s) {
        const Solid& solid = model.solids[s];
        if (!moves(solid) || poses.reach[s].is_outside(x)) continue;
        const Vec3 local = poses.next[s].inverse(Eigen::Isometry) * x;
        if (nearest_surface(solid, poses.of(solid, s), true, local, 0.0).distance < 0) return true;
    }
    return false;
}

// What putting particles back out of moving solids (keep_outside()) has added to the step as it was solved.
double gain_of_putting_back(const ClothModel& model, const ClothState& after, const StepReport& report,
                            StepWorkspace& ws) {
    if (std::ranges::none_of(model.solids, moves)) return 0;
    std::vector<Vec3> x(model.size()), v(model.size());
    bool any = false;
    for (std::size_t p = 0; p < model.size(); ++p) {
        v[p] = ws.stage.v_at[p] + ws.linear.dv[p];
        x[p] = ws.base()[p] + ws.stage.h * v[p];
        if (x[p] == after.x[p]) continue;
        if (in_moving_solid(model, ws.contact.poses, x[p])) {
            any = true;
        } else {
            x[p] = after.x[p];
            v[p] = after.v[p];
        }
    }
    if (!any) return 0;
    StepReport solved;
    measure(model, ws.forces.memory, x, v, ws.measure, solved);
    return std::max(0.0, report.kinetic + report.potential - solved.kinetic - solved.potential);
}

}  // namespace

double energy_input(const ClothModel& model, const ClothState& after, const StepReport& report,
                    StepWorkspace& ws) {
    if (layers_touched(ws)) return std::numeric_limits<double>::infinity();
    if (report.substeps > 1 || ws.plan.step.way == StepPlan::Way::swept) {
        const bool acted = anything_acted(model, after, report, ws);
        return acted ? std::numeric_limits<double>::infinity() : 0.0;
    }
    double input = input_of_forces(model, ends_of(after, ws), ws);
    if (!ws.constraints.all().empty()) input += work_of_constraints(model, after, ws);
    input += work_on_surfaces(model, ws);
    input += gain_of_putting_back(model, after, report, ws);
    return input;
}

double energy_swing(const ClothModel& model, const ClothState& after, StepWorkspace& ws) {
    const ClothState& before = ws.before;
    if (!before.x_previous.empty() || !after.x_previous.empty() || !ws.linear.coupled) return 0;
    const StepEnds ends = ends_of(after, ws);
    double gain = 0;
    each_term(model, [&](const ForceTerm& term) {
        if (term.explicit_gain) gain += term.explicit_gain(model, ends, ws.forces.memory, ws.measure);
    });
    const double lost = ws.measure.sum(model.size(), [&](std::size_t p) {
        return 0.5 * model.mass[p] * (after.v[p] - before.v[p]).squaredNorm();
    });
    return std::max(gain - lost, 0.0);
}

}  // namespace unravel::sim
