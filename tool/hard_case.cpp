#include "tool/hard_case.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/explicit_limit.hpp"
#include "sim/scene/load.hpp"
#include "sim/simulate.hpp"
#include "sim/solids/sdf.hpp"

namespace unravel {

namespace {

// A particle on a solid's very surface is inside by rounding.
constexpr double rounding = 1e-12;

// The energy that a run moves: by how much its least may differ from its start.
double energy_scale(const Simulation& simulation, const StepReport& first) {
    double weight = 0, size = 0;
    for (const double m : simulation.model.mass) weight += m * simulation.model.gravity.norm();
    for (const ClothPatch& patch : simulation.model.cloths)
        size = std::max({size, patch.size[0], patch.size[1]});
    double strained = first.potential;
    for (std::size_t p = 0; p < simulation.model.size(); ++p)
        strained += simulation.model.mass[p] * simulation.model.gravity.dot(simulation.state.x[p]);
    return first.kinetic + std::max(strained, 0.0) + weight * size;
}

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
        for (std::size_t k = 0; k < pin.particles.size(); ++k) {
            const Vec3 there = moved_point(pin.motion, pin.centre, pin.start[k], state.t);
            error = std::max(error, (state.x[pin.particles[k]] - there).norm());
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

void measure_run(const Scene& scene, int frames, Simulation& simulation, HardOutcome& out) {
    StepReport start;
    MeasureWorkspace scratch;
    limit_bend(simulation.model.bends, simulation.model.mass, scene.solver.step, simulation.ws.bend_limit);
    measure(simulation.model, simulation.ws.bend_limit, simulation.state, scratch, start);
    const double scale = energy_scale(simulation, start);
    double least = start.kinetic + start.potential;
    tbb::task_arena one(1), two(2);
    Simulation other = start_simulation(scene);
    for (int frame = 1; frame < frames; ++frame) {
        FrameRecord record;
        two.execute([&] { record = next_record(simulation); });
        one.execute([&] { next_record(other); });
        out.hash = state_hash(simulation.state);
        out.same_bits = out.same_bits && state_hash(other.state) == out.hash;
        for (const StepReport& r : record.reports) {
            ++out.steps;
            out.max_strain = std::max(out.max_strain, r.max_strain);
            out.cg_most = std::max(out.cg_most, r.cg_iterations_max);
            out.unconverged += !r.converged;
            const double energy = r.kinetic + r.potential;
            if (scale > 0) out.energy_rise = std::max(out.energy_rise, (energy - least) / scale);
            least = std::min(least, energy);
        }
        const std::vector<char> pinned = pinned_particles_at(simulation.model, simulation.state.t);
        out.penetration = std::max(out.penetration, deepest(simulation.model, simulation.state, pinned));
        out.pin_error = std::max(out.pin_error, pin_error(simulation.model, simulation.state));
        out.final_speed = 0;
        for (std::size_t p = 0; p < simulation.model.size(); ++p) {
            if (pinned[p] == 0) out.final_speed = std::max(out.final_speed, simulation.state.v[p].norm());
        }
    }
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
            measure_run(scene, planned, simulation, out);
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

}  // namespace unravel
