#include "tool/study/stability/hard_case.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/constraints/pins.hpp"
#include "sim/run/shadow_energy.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/solids/sdf.hpp"
#include "sim/step/explicit_limit.hpp"
#include "tool/study/stability/step_to_step.hpp"

namespace unravel::tool {

namespace {

// A particle on a solid's very surface is inside by rounding.
constexpr double rounding = 1e-12;

double deepest(const ClothModel& model, const ClothState& state, const std::vector<char>& pinned) {
    double depth = 0;
    for (const Solid& solid : model.solids) {
        const Pose pose = solid_pose(solid, state.t);
        const Pose inverse = pose.inverse(Eigen::Isometry);
        for (std::size_t p = 0; p < model.size(); ++p) {
            if (pinned[p] == 0)
                depth = std::max(depth, -signed_distance(solid, inverse * state.x[p], nullptr));
        }
    }
    return depth > rounding ? depth : 0;
}

double pin_error(const ClothModel& model, const ClothState& state) {
    double error = 0;
    for (const PinnedGroup& pin : model.pins) {
        if (state.t > pin.release) continue;
        const PinMoment moment = pin_moment(pin, state.t);
        for (std::size_t k = 0; k < pin.particles.size(); ++k) {
            Vec3 off = state.x[pin.particles[k]] - pin_place(pin, moment, k);
            if (pin.slides()) off -= moment.slide * moment.slide.dot(off);
            error = std::max(error, off.norm());
        }
    }
    return error;
}

// Pins, for as long as they hold.
std::vector<char> pinned_particles_at(const ClothModel& model, double t) {
    std::vector<char> pinned(model.size(), 0);
    for (const PinnedGroup& pin : model.pins) {
        if (t > pin.release) continue;
        for (const std::uint32_t p : pin.particles) pinned[p] = 1;
    }
    return pinned;
}

// Follows the energy: how far it rises above its least so far. `swing`: where steps with explicit springs
// change in length, each keeps another H + h/2 v·f, and where bending is explicit and springs are not, no
// step keeps just that: no one quantity is kept by all. Whatever they keep lies between H - h/2 |v·f| and H +
// h/2 |v·f|; what rises is then the least that it can be above the most that it can have been.
class EnergyWatch {
public:
    EnergyWatch(const Scene& scene, const Simulation& simulation, bool swing) : swing_(swing) {
        StepReport start;
        MeasureWorkspace scratch;
        prepare_terms(simulation.model, scene.solver.step, forces_);
        measure(simulation.model, forces_, simulation.state, scratch, start);
        scale_ = energy_scale(simulation.model, simulation.state, start);
        least_ = start.kinetic + start.potential;
        lags_ = scene.solver.integrator == Integrator::explicit_;
    }
    /// Largest rise so far, over the energy that there is.
    double add(const Simulation& simulation, const StepReport& report) {
        double energy = report.kinetic + report.potential;
        const bool swings = swing_ && (report.explicit_ > 0 || simulation.model.curvature.size() > 0);
        ShadowTerms shadow;
        if (lags_ || swings) {
            prepare_terms(simulation.model, report.h / report.substeps, forces_);
            shadow = shadow_terms(simulation.model, forces_, simulation.state, report.h);
        }
        if (lags_) energy += shadow.first;
        const double corridor = swings ? std::abs(shadow.first) + std::abs(shadow.second) : 0;
        if (scale_ > 0) rise_ = std::max(rise_, (energy - corridor - least_) / scale_);
        least_ = std::min(least_, energy + corridor);
        return rise_;
    }

private:
    double scale_ = 0, least_ = 0, rise_ = 0;
    bool lags_ = false, swing_ = false;
    ForceMemory forces_;
};

void measure_run(const HardCase& hard, const Scene& scene, int frames, Simulation& simulation,
                 HardOutcome& out) {
    EnergyWatch energy(scene, simulation, hard.swing);
    StepToStep step_to_step;
    std::uint64_t settled = 0;  // steps of the last quarter
    tbb::task_arena one(1), two(2);
    Simulation other = start_simulation(scene);
    while (simulation.frame + 1 < frames) {
        const auto due = static_cast<std::uint64_t>(simulation.frame + 1) * simulation.steps_per_frame;
        while (simulation.state.whole_steps < due) {
            const StepReport r = two.execute([&] { return next_step(simulation); });
            ++out.steps;
            out.max_strain = std::max(out.max_strain, r.max_strain);
            out.cg_most = std::max(out.cg_most, r.cg_iterations_max);
            out.unconverged += !r.converged;
            out.again += r.rejected > 0;
            out.energy_rise = energy.add(simulation, r);
            const StepToStep::Shares shares = step_to_step.next(simulation);
            out.flicker = std::max(out.flicker, shares.flicker);
            if (4 * (simulation.frame + 1) < 3 * frames) continue;
            ++settled;
            out.chatter += shares.chatter;
            out.jitter += shares.jitter;
        }
        ++simulation.frame;
        one.execute([&] { next_record(other); });
        out.hash = state_hash(simulation.state);
        out.same_bits = out.same_bits && state_hash(other.state) == out.hash;
        const std::vector<char> pinned = pinned_particles_at(simulation.model, simulation.state.t);
        out.penetration = std::max(out.penetration, deepest(simulation.model, simulation.state, pinned));
        out.pin_error = std::max(out.pin_error, pin_error(simulation.model, simulation.state));
        out.final_speed = 0;
        for (std::size_t p = 0; p < simulation.model.size(); ++p) {
            if (pinned[p] == 0) out.final_speed = std::max(out.final_speed, simulation.state.v[p].norm());
        }
    }
    out.chatter /= static_cast<double>(std::max<std::uint64_t>(settled, 1));
    out.jitter /= static_cast<double>(std::max<std::uint64_t>(settled, 1));
}

void judge(const HardCase& hard, bool whole, HardOutcome& out) {
    const auto expect = [&](bool holds, std::string what) {
        if (!holds) out.failures.push_back(std::move(what));
    };
    using Kind = HardOutcome::Kind;
    const Kind wanted = hard.must == Must::survive  ? Kind::survived
                        : hard.must == Must::refuse ? Kind::refused
                                                    : Kind::stopped;
    if (out.kind != wanted && (whole || wanted != Kind::stopped)) {
        constexpr const char* names[] = {"survived", "refused", "stopped"};
        expect(false, fmt::format("{} where it must be {}{}{}", names[static_cast<int>(out.kind)],
                                  names[static_cast<int>(wanted)], out.says.empty() ? "" : ": ", out.says));
        return;
    }
    if (wanted != Kind::survived) {
        expect(out.kind != wanted || out.says.find(hard.says) != std::string::npos,
               fmt::format("the message does not say '{}': {}", hard.says, out.says));
        return;
    }
    expect(out.max_strain <= hard.strain,
           fmt::format("strain {:.3g} beyond its bound of {:.3g}", out.max_strain, hard.strain));
    expect(hard.fed || out.energy_rise <= hard.energy,
           fmt::format("energy rose by {:.2g} of what there is", out.energy_rise));
    expect(out.penetration <= hard.penetration,
           fmt::format("a particle is {:.3g} m inside a solid", out.penetration));
    expect(out.pin_error <= rounding, fmt::format("a pin is {:.2g} m off", out.pin_error));
    expect(out.unconverged == 0, fmt::format("CG reached its cap in {} steps", out.unconverged));
    expect(out.flicker <= hard.flicker,
           fmt::format("{:.2g} of the springs turn between explicit and implicit in one step", out.flicker));
    expect(!whole || out.chatter <= hard.chatter,
           fmt::format("friction catches or lets go {:.2g} of the contacts per step", out.chatter));
    expect(!whole || out.jitter <= hard.jitter,
           fmt::format("{:.2g} of the contacts open or close per step", out.jitter));
    expect(out.same_bits, "one thread and two threads differ");
    expect(!whole || hard.rest == 0 || out.final_speed <= hard.rest,
           fmt::format("moves at {:.2g} m/s where it should rest", out.final_speed));
}

}  // namespace

HardOutcome run_hard_case(const HardCase& hard, int frames) {
    const auto begin = std::chrono::steady_clock::now();
    HardOutcome out;
    int planned = 0;
    try {
        const Scene scene = load_scene(hard.scene, hard.set);
        planned = frames > 0 ? std::min(frames, scene.clip.frames()) : scene.clip.frames();
        out.scene = scene;
        Simulation simulation = start_simulation(scene);
        out.particles = simulation.model.size();
        if (!hard.allow_unstable)
            require_explicit_stability(simulation.model, simulation.options, scene.solver.step);
        try {
            measure_run(hard, scene, planned, simulation, out);
        } catch (const SimulationError& error) {
            out.kind = HardOutcome::Kind::stopped;
            out.says = error.what();
        }
        out.last = present_record(simulation);
    } catch (const SceneError& error) {
        out.kind = HardOutcome::Kind::refused;
        out.says = error.problems().empty() ? error.what() : error.problems().front().what;
    } catch (const UnstableStep& error) {
        out.kind = HardOutcome::Kind::refused;
        out.says = error.what();
    }
    const bool whole = out.scene && planned == out.scene->clip.frames();
    judge(hard, whole || out.kind != HardOutcome::Kind::survived, out);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace unravel::tool
