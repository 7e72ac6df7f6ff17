#include "sim/run/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/forces/extension_law.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/model/particle_name.hpp"
#include "sim/step/energy_input.hpp"
#include "sim/step/trace.hpp"

namespace unravel::sim {

namespace {

constexpr std::size_t most_named = 16;
// Springs that come and go faster than a step can tell put energy in. Where they have, those that are slack
// by less than this share resist, too, which only ever takes energy; it would brake all slack cloth
// elsewhere.
constexpr double calming_band = 0.02;
// Energy that a step may add, as a share of what the run has to spend.
constexpr double rounding_share = 1e-10;
// A gain of so many times that, a thousandth of what the run has to spend, is worth dividing the step for.
constexpr double notable_gain = 1e7;
// Halvings of a step that gains as much however it is linearised.
constexpr int step_halvings = 3;

std::string advice_for(Criterion criterion, const StepOptions& options, double h) {
    const bool explicit_springs = options.integrator != Integrator::implicit;
    switch (criterion) {
        case Criterion::not_finite:
        case Criterion::energy:
            return explicit_springs
                       ? fmt::format("take a smaller step than {} s, or solver.integrator = \"implicit\"", h)
                       : fmt::format("take a smaller step than {} s", h);
        case Criterion::strain:
            return fmt::format(
                "raise cloth.material.stretch, lower its density, or take a smaller step than {} s", h);
        case Criterion::unsolved:
            return fmt::format(
                "raise solver.max_iterations (now {}), take a smaller step, or soften what is stiffest",
                options.solve.max_iterations);
        case Criterion::pinched:
            break;  // says it itself
    }
    return "";
}

// The `most_named` particles of greatest f, of those for which it is above `low`, the worst first.
template <typename F>
std::vector<std::uint32_t> worst_particles(std::size_t n, double low, const F& f) {
    std::vector<std::pair<double, std::uint32_t>> worst;
    for (std::uint32_t p = 0; p < n; ++p) {
        const double value = f(p);
        if (!(value <= low)) worst.emplace_back(std::isfinite(value) ? value : Guard::infinite, p);
    }
    const std::size_t kept = std::min(most_named, worst.size());
    std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(kept), worst.end(),
                      [](const auto& a, const auto& b) {
                          return a.first != b.first ? a.first > b.first : a.second < b.second;
                      });
    std::vector<std::uint32_t> particles;
    for (std::size_t k = 0; k < kept; ++k) particles.push_back(worst[k].second);
    return particles;
}

double strain_of(const ClothModel& model, const std::vector<Vec3>& x, std::uint32_t s) {
    return spring_strain((x[model.springs.j[s]] - x[model.springs.i[s]]).norm(), model.springs.rest[s]);
}

// A solve ends at a share of what all springs pull together. Where some pull so much harder than a particle's
// own inertia, κ of Eq. (7), that share moves the others about; hard damping is seen to do so from here on.
constexpr double tolerable_kappa = 1e3;

// The tolerance that the hardest springs ask for, in words, where the scene's is looser; else empty.
std::string finer_solves(const ClothModel& model, const StepOptions& options, double h) {
    const ExtensionSprings& springs = model.springs;
    double hardest = 0;
    for (std::uint32_t s = 0; s < springs.size(); ++s)
        hardest = std::max(hardest, kappa_between(h, model.mass[springs.i[s]], model.mass[springs.j[s]],
                                                  springs.stiffness[s], springs.damping[s]));
    const double wanted = tolerable_kappa / hardest;
    if (options.integrator == Integrator::explicit_ || options.solve.tolerance <= wanted) return "";
    return fmt::format("lower solver.tolerance to {:.0e} (now {}), or soften what is stiffest or damped most",
                       0.01 * wanted, options.solve.tolerance);
}

struct Judgement {
    const ClothModel& model;
    const StepOptions& options;
    const ClothState& after;
    double h;
    StepFailure failure;

    [[noreturn]] void stop(Criterion criterion, const std::string& what) {
        failure.criterion = criterion;
        const std::string finer =
            criterion == Criterion::unsolved ? std::string() : finer_solves(model, options, h);
        failure.advice = finer.empty() ? advice_for(criterion, options, h) : finer;
        throw SimulationError(fmt::format("step {} (from {:.6g} s, {:.6g} s long): {}; {}", failure.step,
                                          failure.t, h, what, failure.advice),
                              failure);
    }

    void judge_finite(const StepReport& report) {
        if (std::isfinite(report.kinetic) && std::isfinite(report.potential)) return;
        failure.value = report.kinetic;
        failure.limit = std::numeric_limits<double>::max();
        failure.particles = worst_particles(model.size(), std::sqrt(failure.limit), [&](std::uint32_t p) {
            return std::max(after.x[p].cwiseAbs().maxCoeff(), after.v[p].cwiseAbs().maxCoeff());
        });
        stop(Criterion::not_finite,
             failure.particles.empty()
                 ? std::string("the energy is not finite")
                 : particle_name(model, failure.particles.front()) + " has left the numbers");
    }

    void judge_strain(const StepReport& report, double limit) {
        if (report.max_strain <= limit) return;
        std::vector<double> worst(model.size(), 0.0);
        double most = -1;
        for (std::uint32_t s = 0; s < model.springs.stretch_count; ++s) {
            const double strain = strain_of(model, after.x, s);
            for (const std::uint32_t p : {model.springs.i[s], model.springs.j[s]})
                worst[p] = std::max(worst[p], strain);
            if (strain <= most) continue;
            most = strain;
            failure.spring = s;
        }
        failure.value = report.max_strain;
        failure.limit = limit;
        failure.particles = worst_particles(model.size(), limit, [&](std::uint32_t p) { return worst[p]; });
        stop(Criterion::strain,
             fmt::format("the stretch spring from {} to {} would be {:.3g} times its rest length (at most "
                         "{:.3g})",
                         particle_name(model, model.springs.i[*failure.spring]),
                         particle_name(model, model.springs.j[*failure.spring]), 1 + most, 1 + limit));
    }

    void judge_energy(const StepReport& report, double limit) {
        failure.value = report.kinetic + height_energy(model, after.x);
        if (failure.value <= limit) return;
        failure.limit = limit;
        failure.particles = worst_particles(
            model.size(), 0.0, [&](std::uint32_t p) { return model.mass[p] * after.v[p].squaredNorm(); });
        stop(Criterion::energy,
             fmt::format("the energy of motion would grow to {:.3g} J (at most {:.3g} J), by more than "
                         "anything puts in; {}",
                         failure.value, limit,
                         failure.particles.empty()
                             ? std::string("it is lifted")
                             : particle_name(model, failure.particles.front()) + " is the fastest"));
    }

    void judge_solution(const StepReport& report, const StepTrace& trace, double limit) {
        if (report.converged) return;
        for (std::size_t c = 0; c < trace.solves.size(); ++c) {
            const ComponentSolve& solve = trace.solves[c];
            if (solve.converged || solve.residual <= limit) continue;
            failure.value = solve.residual;
            failure.limit = limit;
            const auto label = static_cast<std::int32_t>(c);
            failure.particles = worst_particles(model.size(), -1.0, [&](std::uint32_t p) {
                return trace.components.label[p] == label ? trace.dv[p].norm() : -1.0;
            });
            stop(Criterion::unsolved,
                 fmt::format("conjugate gradients left a residual of {:.3g} (at most {:.3g}) after {} "
                             "iterations in the component of {} particles around {}",
                             failure.value, limit, solve.iterations, trace.components.size(c),
                             particle_name(model, failure.particles.front())));
        }
    }
};

}  // namespace

const char* criterion_name(Criterion criterion) {
    constexpr const char* names[] = {"not_finite", "strain", "energy", "unsolved", "pinched"};
    return names[static_cast<int>(criterion)];
}

namespace {

// What springs and motion may hold because positions end at their last bits [J].
double energy_of_rounding(const ClothModel& model, const ClothState& state, double h) {
    const double off = position_rounding(state.x);
    double energy = 0;
    for (const double k : model.springs.stiffness.values()) energy += 0.5 * k * off * off;
    for (const double m : model.mass) energy += 0.5 * m * off * off / (h * h);
    return energy;
}

}  // namespace

Guard make_guard(const ClothModel& model, const ClothState& start, double h) {
    Guard guard;
    StepReport report;
    MeasureWorkspace scratch;
    ForceMemory forces;
    prepare_terms(model, h, forces);
    measure(model, forces, start, scratch, report);
    guard.strain += std::max(report.max_strain, 0.0);
    double weight = 0, size = 0, skin = 0;
    for (const double m : model.mass) weight += m * model.gravity.norm();
    for (const ClothPatch& patch : model.cloths) size = std::max({size, patch.size[0], patch.size[1]});
    const double height = height_energy(model, start.x), springs = report.potential - height;
    for (const Solid& solid : model.solids) skin = std::max(skin, solid.offset);
    const double spent = report.kinetic + springs + weight * (size + skin);
    const double of_rounding = energy_of_rounding(model, start, h);
    guard.energy = height + 2.0 * (spent + of_rounding);
    guard.total = report.kinetic + report.potential;
    guard.rounding = rounding_share * spent + of_rounding;
    return guard;
}

namespace {

double total_energy(const StepReport& report) {
    return report.kinetic + report.potential;
}

// Linearises the step again until it ends with no more energy than it began with, or until its end is met;
// keeps that where it holds less.
StepReport take_again(const ClothModel& model, const StepOptions& options, double h, double energy,
                      const StepReport& first, ClothState& state, StepWorkspace& ws) {
    StepOptions thorough = options;
    thorough.energy_limit = energy;
    thorough.activation_band = std::max(options.activation_band, calming_band);
    ClothState once = state;
    std::swap(state, ws.before);
    const StepReport second = step(model, thorough, h, state, ws);
    const bool better = total_energy(second) < total_energy(first);
    if (!better) std::swap(state, once);
    StepReport report = better ? second : first;
    // How far the end was met shows in the energy.
    const StepTrace trace = trace_of(model, ws);
    report.converged =
        better ? std::ranges::all_of(trace.solves, &ComponentSolve::converged) : first.converged;
    report.cg_iterations = first.cg_iterations + second.cg_iterations;
    report.cg_iterations_max = std::max(first.cg_iterations_max, second.cg_iterations_max);
    report.rvm = first.rvm + second.rvm;
    if (first.rvm_whole) report.rvm_whole = *first.rvm_whole + second.rvm_whole.value_or(0);
    report.times = first.times;
    report.times += second.times;
    report.rejected = 1;
    return report;
}

struct HeldStep {
    StepReport report;
    double input = 0;  // J, put in, of what there is more of than before
    double gain = 0;   // J, beyond what may be
};

// One step, taken again where it has to be, from a state of `total` energy [J].
HeldStep whole_step(const ClothModel& model, const StepOptions& options, double h, double total,
                    double rounding, ClothState& state, StepWorkspace& ws) {
    HeldStep held;
    StepReport& report = held.report;
    report = step(model, options, h, state, ws);
    const auto gain_beyond = [&](double energy) { return total_energy(report) - energy - rounding; };
    if (!options.measure || !(gain_beyond(total) > 0) || !std::isfinite(total_energy(report))) return held;
    held.input = energy_input(model, state, report, ws);
    double allowed = total + held.input;
    if (ws.linear.coupled && gain_beyond(allowed) > 0) {
        allowed += energy_swing(model, state, ws);
        if (gain_beyond(allowed) > 0) report = take_again(model, options, h, allowed, report, state, ws);
        held.gain = std::max(0.0, gain_beyond(allowed));
    }
    // What is not counted has put in what is there.
    held.input = std::min(held.input, std::max(0.0, total_energy(report) - total));
    return held;
}

// Adds another attempt's work, or that of the part before, to a report.
void add_work(const StepReport& other, StepReport& report) {
    report.cg_iterations += other.cg_iterations;
    report.cg_iterations_max = std::max(report.cg_iterations_max, other.cg_iterations_max);
    report.rvm += other.rvm;
    if (report.rvm_whole) report.rvm_whole = *report.rvm_whole + other.rvm_whole.value_or(0);
    report.times += other.times;
    report.rejected += other.rejected;
}

// The same, in halves where it gains notably, and those in halves, as long as that makes it less. Not of
// multistep schemes, which look back on steps of one size.
HeldStep held_step(const ClothModel& model, const StepOptions& options, double h, double total,
                   double rounding, int halvings, ClothState& state, StepWorkspace& ws) {
    HeldStep whole = whole_step(model, options, h, total, rounding, state, ws);
    const bool multistep = scheme_of(ws.plan.step.integrator).multistep;
    if (!(whole.gain > notable_gain * rounding) || halvings == 0 || multistep) return whole;
    const ClothState start = ws.before;
    ClothState end = state;
    const auto keep_whole = [&] {
        std::swap(state, end);
        ws.before = start;
        plan_step(model, options, h, ws);
        ++whole.report.rejected;
        return whole;
    };
    state = start;
    HeldStep first, second;
    try {
        first = held_step(model, options, 0.5 * h, total, rounding, halvings - 1, state, ws);
        second =
            held_step(model, options, 0.5 * h, total_energy(first.report), rounding, halvings - 1, state, ws);
    } catch (const SimulationError&) {
        return keep_whole();
    }
    if (!(first.gain + second.gain < whole.gain)) return keep_whole();
    HeldStep held = second;
    held.input += first.input;
    held.gain += first.gain;
    add_work(first.report, held.report);
    add_work(whole.report, held.report);
    ++held.report.rejected;
    held.report.converged = first.report.converged && second.report.converged;
    held.report.step = state.step = whole.report.step;
    held.report.t = state.t = whole.report.t;
    held.report.h = state.h_previous = h;
    parallel_each(model.size(), [&](std::size_t p) { state.dv[p] = state.v[p] - start.v[p]; });
    ws.before = start;
    plan_step(model, options, h, ws);  // what is told of a step is not its last part's
    return held;
}

}  // namespace

StepReport guarded_step(const ClothModel& model, const StepOptions& options, double h, ClothState& state,
                        StepWorkspace& ws, Guard& guard) {
    const HeldStep held = held_step(model, options, h, guard.total, guard.rounding, step_halvings, state, ws);
    const StepReport& report = held.report;
    if (!options.measure) return report;
    Judgement judgement{model, options, state, h, {}};
    judgement.failure.step = report.step;
    judgement.failure.t = ws.before.t;
    judgement.failure.h = h;
    try {
        judgement.judge_finite(report);
        judgement.judge_strain(report, guard.strain);
        judgement.judge_energy(report, guard.energy + held.input);
        judgement.judge_solution(report, trace_of(model, ws), guard.residual);
    } catch (const SimulationError&) {
        std::swap(state, ws.before);
        throw;
    }
    guard.total = total_energy(report);
    guard.energy += held.input;
    return report;
}

}  // namespace unravel::sim
