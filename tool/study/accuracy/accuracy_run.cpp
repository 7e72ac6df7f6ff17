#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "base/whole_file.hpp"
#include "sim/run/simulate.hpp"
#include "sim/step/explicit_limit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/study/accuracy/accuracy.hpp"

namespace unravel::tool {

namespace {

// Particles farther out than this many diagonals say that a run has blown up, long before it overflows.
constexpr double far_out = 100;
// A run that explicit springs bring nearer to their limit of stability than this is no reference.
constexpr double safe_share = 0.5;
// Steps a frame by which a reference's cost is foretold, and the fewest of one.
constexpr int probe_steps = 32, coarsest_reference = 32;
// So many times as many steps as the first reference takes an explicit one at most.
constexpr int finer_explicit = 16;

double median_of(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

bool in_sight(const std::vector<Vec3>& x, double limit) {
    return std::all_of(x.begin(), x.end(), [&](const Vec3& p) { return p.squaredNorm() < limit * limit; });
}

// Frames until the two trajectories part.
int comparable_frames(const Trajectory& a, const Trajectory& b, double diagonal, int least) {
    int frames = 0;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
        if (static_cast<int>(k) >= least && distance({a[k]}, {b[k]}, diagonal) > parted) break;
        frames = static_cast<int>(k) + 1;
    }
    return frames;
}

// What precedes the positions in a reference's file.
struct ReferenceHeader {
    char kind[8] = {'u', 'n', 'r', 'e', 'f', '0', '0', '4'};
    std::int32_t steps_per_frame = 0, frames = 0;
    std::int32_t first_frame = 0, asked = 0;
    std::int32_t second_is_explicit = 1, second_steps_per_frame = 0;
    std::uint64_t particles = 0;
    double floor = 0;
};
constexpr std::size_t largest_reference = std::size_t{4} << 30;

AccuracySetting reference_setting(Integrator integrator, int steps_per_frame) {
    AccuracySetting setting;
    setting.integrator = integrator;
    setting.steps_per_frame = steps_per_frame;
    setting.tolerance = 1e-9;
    return setting;
}

// Where the scene's own solver has the cloth at a frame. Throws SimulationError.
Placement placement_at(const Scene& scene, int frame) {
    Simulation simulation = start_simulation(scene);
    settle(simulation);
    for (int k = 0; k < frame; ++k) next_record(simulation);
    return {simulation.state.x, simulation.state.v};
}

double seconds_a_step(const AccuracyRun& run) {
    return run.point.median() / std::max<double>(1, static_cast<double>(run.point.steps));
}

// The scheme that shares least with the first, of those that bear the step. Explicit steps are of first order
// where the first reference is of second, and cheap: as many as take the time that a step of the first does
// [s].
AccuracySetting second_reference(const Scene& scene, const AccuracyReference& reference, double seconds,
                                 const std::function<bool()>& keep_on) {
    const int steps_per_frame = reference.first.steps_per_frame;
    StepOptions options = step_options(scene.solver);
    options.integrator = Integrator::explicit_;
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    int finer = 1;
    while (finer <= finer_explicit &&
           !(explicit_limit(model, options, 1.0 / (scene.clip.fps.per_second() * steps_per_frame * finer))
                 .share < safe_share))
        finer *= 2;
    if (finer > finer_explicit) return reference_setting(Integrator::bdf2, steps_per_frame);
    const double each = seconds_a_step(
        run_setting(scene, reference_setting(Integrator::explicit_, finer * steps_per_frame), 1, keep_on,
                    reference.start, scene.clip.fps.time_of(reference.first_frame)));
    while (finer < finer_explicit && 2 * finer * each < seconds) finer *= 2;
    return reference_setting(Integrator::explicit_, finer * steps_per_frame);
}

}  // namespace

double AccuracyPoint::median() const {
    return median_of(seconds);
}
double AccuracyPoint::fastest() const {
    return seconds.empty() ? 0 : *std::min_element(seconds.begin(), seconds.end());
}
double AccuracyPoint::quantile(double share) const {
    if (seconds.empty()) return 0;
    std::vector<double> sorted = seconds;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}
double AccuracyPoint::slowest() const {
    return seconds.empty() ? 0 : *std::max_element(seconds.begin(), seconds.end());
}

double diagonal_of(const Scene& scene) {
    double diagonal = 0;
    for (const Cloth& cloth : scene.cloths)
        diagonal = std::max(diagonal, std::hypot(cloth.size[0], cloth.size[1]));
    return diagonal;
}

double distance(const Trajectory& a, const Trajectory& b, double diagonal) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
        for (std::size_t p = 0; p < a[k].size(); ++p) sum += (a[k][p] - b[k][p]).squaredNorm();
        count += a[k].size();
    }
    return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count)) / diagonal;
}

AccuracyRun run_setting(const Scene& scene, const AccuracySetting& setting, int frames,
                        const std::function<bool()>& keep_on, const Placement& start, double t0) {
    Scene variant = scene;
    variant.solver.integrator = setting.integrator;
    // Explicit steps in one go, as fast as they can be: a step a frame, in parts.
    const bool in_parts = setting.integrator == Integrator::explicit_;
    const int steps = in_parts ? 1 : setting.steps_per_frame;
    variant.solver.step = 1.0 / (scene.clip.fps.per_second() * steps);
    variant.solver.substeps = in_parts ? setting.steps_per_frame : 1;
    variant.solver.threshold = setting.threshold;
    variant.solver.tolerance = setting.tolerance;
    variant.solver.activation = setting.activation;
    variant.solver.activation_band = setting.band;
    variant.solver.bend = setting.bend;
    variant.solver.adaptive.reset();
    Simulation simulation = start_simulation(variant);
    if (!start.x.empty()) {
        simulation.state = initial_state(start);
        simulation.state.t = t0;
    }
    simulation.options.solve.stop = InterruptWatch::flag();
    const double limit = far_out * diagonal_of(scene);

    AccuracyRun run;
    run.point.setting = setting;
    double seconds = 0;
    try {
        for (int frame = 0; frame < frames; ++frame) {
            if (!keep_on()) {
                run.stopped = true;
                return run;
            }
            for (int k = 0; k < steps; ++k) {
                // Strain and energy are looked at where a frame ends: more often they would cost more than
                // a small step.
                simulation.options.measure = k + 1 == steps;
                const StepReport report = step(simulation.model, simulation.options, variant.solver.step,
                                               simulation.state, simulation.ws);
                seconds += report.times.step();
                run.point.rvm += report.rvm;
                run.point.steps += static_cast<std::uint64_t>(setting.steps_per_frame / steps);
                if (!simulation.options.measure) continue;
                run.point.max_strain = std::max(run.point.max_strain, report.max_strain);
                run.point.lowest = report.lowest;
                run.point.energy = report.kinetic + report.potential;
            }
            if (!in_sight(simulation.state.x, limit)) {
                run.point.broke = true;
                break;
            }
            run.trajectory.push_back(simulation.state.x);
        }
    } catch (const SimulationError&) {
        run.point.broke = true;
    } catch (const Stopped&) {
        run.stopped = true;
        return run;
    }
    run.point.seconds = {seconds};
    return run;
}

AccuracySetting scene_setting(const Scene& scene) {
    AccuracySetting setting;
    const Solver& solver = scene.solver;
    setting.integrator = solver.integrator;
    const bool in_parts = solver.integrator == Integrator::explicit_;
    setting.steps_per_frame = steps_per_frame(scene) * (in_parts ? std::max(1, solver.substeps) : 1);
    setting.threshold = solver.threshold;
    setting.tolerance = solver.tolerance;
    setting.activation = solver.activation;
    setting.band = solver.activation_band;
    setting.bend = solver.bend;
    return setting;
}

AccuracyReference make_reference(const Scene& scene, const AccuracyWindow& window, double seconds,
                                 const std::function<bool()>& keep_on) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto left = [&] { return seconds - std::chrono::duration<double>(Clock::now() - begin).count(); };
    AccuracyReference reference;
    reference.first_frame = window.first;
    reference.asked = window.last ? *window.last - window.first : 0;
    reference.start = placement_at(scene, window.first);
    const double t0 = scene.clip.fps.time_of(window.first);
    const double fps = scene.clip.fps.per_second();
    const int all = scene.clip.frames() - 1 - window.first;
    const int wanted =
        window.last ? *window.last - window.first : std::min(all, std::max(1, static_cast<int>(fps / 2)));
    // One frame is always taken: without it there is nothing to compare.
    const auto run_until = [&](const AccuracySetting& setting, int frames, double least_left) {
        int taken = 0;
        return run_setting(
            scene, setting, frames, [&] { return keep_on() && (taken++ == 0 || left() > least_left); },
            reference.start, t0);
    };
    // An eighth of a second by moderate steps tells what a step costs.
    const double per_step =
        seconds_a_step(run_until(reference_setting(Integrator::adaptive_imex2, probe_steps),
                                 std::min(wanted, std::max(1, static_cast<int>(fps / 8))), 0.75 * seconds));
    int steps = coarsest_reference;
    while (steps < finest_reference && 2 * (2.0 * steps) * wanted * per_step < left()) steps *= 2;

    reference.first = reference_setting(Integrator::adaptive_imex2, steps);
    reference.second = second_reference(scene, reference, per_step, keep_on);
    AccuracyRun first = run_until(reference.first, wanted, 0.5 * left());
    const AccuracyRun other = run_until(reference.second, wanted, 0);
    const double diagonal = diagonal_of(scene);
    const int least = window.last ? wanted : static_cast<int>(std::ceil(least_window * fps));
    reference.frames = comparable_frames(first.trajectory, other.trajectory, diagonal, least);
    reference.trajectory = std::move(first.trajectory);
    reference.trajectory.resize(static_cast<std::size_t>(reference.frames));
    reference.floor = distance(reference.trajectory, other.trajectory, diagonal);
    return reference;
}

std::string reference_bytes(const AccuracyReference& reference) {
    ReferenceHeader header;
    header.steps_per_frame = reference.first.steps_per_frame;
    header.frames = reference.frames;
    header.first_frame = reference.first_frame;
    header.asked = reference.asked;
    header.particles = reference.trajectory.empty() ? 0 : reference.trajectory.front().size();
    header.second_is_explicit = reference.second.integrator == Integrator::explicit_;
    header.second_steps_per_frame = reference.second.steps_per_frame;
    header.floor = reference.floor;
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    for (const std::vector<Vec3>* part : {&reference.start.x, &reference.start.v})
        bytes.append(reinterpret_cast<const char*>(part->data()), part->size() * sizeof(Vec3));
    for (const std::vector<Vec3>& x : reference.trajectory)
        bytes.append(reinterpret_cast<const char*>(x.data()), x.size() * sizeof(Vec3));
    return bytes;
}

AccuracyReference read_reference(const std::filesystem::path& file, std::size_t particles) {
    const std::string bytes = read_whole_text(file, largest_reference);
    ReferenceHeader header;
    const ReferenceHeader expected;
    if (bytes.size() >= sizeof header) std::memcpy(&header, bytes.data(), sizeof header);
    const std::size_t frame_bytes = particles * sizeof(Vec3);
    if (bytes.size() < sizeof header || std::memcmp(header.kind, expected.kind, sizeof header.kind) != 0 ||
        header.particles != particles || header.frames < 0 || header.steps_per_frame < 1 ||
        header.second_steps_per_frame < 1 ||
        bytes.size() != sizeof header + static_cast<std::size_t>(header.frames + 2) * frame_bytes) {
        throw InputError(file, "is no reference of this scene; --force makes a new one");
    }
    AccuracyReference reference;
    reference.first = reference_setting(Integrator::adaptive_imex2, header.steps_per_frame);
    reference.second =
        reference_setting(header.second_is_explicit != 0 ? Integrator::explicit_ : Integrator::bdf2,
                          header.second_steps_per_frame);
    reference.frames = header.frames;
    reference.floor = header.floor;
    reference.first_frame = header.first_frame;
    reference.asked = header.asked;
    auto take = [&, at = sizeof header](std::vector<Vec3>& out) mutable {
        out.resize(particles);
        std::memcpy(static_cast<void*>(out.data()), bytes.data() + at, frame_bytes);
        at += frame_bytes;
    };
    take(reference.start.x);
    take(reference.start.v);
    for (int k = 0; k < header.frames; ++k) take(reference.trajectory.emplace_back());
    return reference;
}

}  // namespace unravel::tool
