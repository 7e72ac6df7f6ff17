#include "sim/run/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "sim/mesh/mesh_solid.hpp"
#include "sim/model/particle_name.hpp"

namespace unravel::sim {

namespace {

using Reports = std::span<const StepReport>;
using Line = std::optional<std::string>;

// Strain from which on a user wants to be told of it.
constexpr double notable_strain = 0.2;
// Share of the steps from which on those taken again tell of a step that is too long.
constexpr double notable_repeats = 0.05;
// What moves by more than this share of its size from frame to frame is seen to move: a pixel in a thousand.
constexpr double visible_share = 1e-3;

// Of a count: the first step that has one, and the step of the largest; null where all are zero.
template <typename Count>
std::pair<const StepReport*, const StepReport*> first_and_most(Reports reports, const Count& count) {
    const StepReport *first = nullptr, *most = nullptr;
    for (const StepReport& report : reports) {
        if (count(report) == 0) continue;
        if (!first) first = &report;
        if (!most || count(report) > count(*most)) most = &report;
    }
    return {first, most};
}

std::string counted(std::uint64_t count, const char* one, const char* several) {
    return fmt::format("{} {}", count, count == 1 ? one : several);
}

Line strain(const Scene&, const ClothModel& model, Reports reports) {
    const auto strained = std::ranges::max_element(reports, {}, &StepReport::max_strain);
    if (strained == reports.end() || strained->max_strain <= notable_strain) return {};
    return fmt::format(
        "the thread from {} to {} was {:.0f}% longer than at rest at {:.4g} s (step {}): "
        "stiffer cloth or a smaller step makes it less",
        particle_name(model, model.springs.i[strained->strained]),
        particle_name(model, model.springs.j[strained->strained]), 100 * strained->max_strain, strained->t,
        strained->step);
}

Line through_cloth(const Scene&, const ClothModel& model, Reports reports) {
    const auto count = [](const StepReport& r) { return r.crossings.value_or(0); };
    const auto [first, most] = first_and_most(reports, count);
    if (!first) return {};
    return fmt::format("cloth passes through cloth from {:.4g} s on: {} there, at most {} at {:.4g} s{}",
                       first->t, counted(count(*first), "edge", "edges"), count(*most), most->t,
                       model.cloth_by_surfaces() ? ""
                       : model.self_collision
                           ? "; [self_collision] method = \"surface\" keeps edges and faces apart"
                           : "; [self_collision] keeps cloth apart");
}

Line through_solids(const Scene&, const ClothModel& model, Reports reports) {
    const auto count = [](const StepReport& r) { return r.in_solids.value_or(0); };
    const auto [first, most] = first_and_most(reports, count);
    if (!first) return {};
    const double deepest = std::ranges::max(reports, {}, &StepReport::deepest).deepest;
    return fmt::format(
        "cloth passes through solids from {:.4g} s on: {} there, at most {} at {:.4g} s, and up to {:.2g} mm "
        "deep{}",
        first->t, counted(count(*first), "edge", "edges"), count(*most), most->t, 1e3 * deepest,
        model.solids_by_surfaces() ? ""
                                   : "; contact = \"surface\" of a solid holds edges and faces off, too");
}

Line pulling(const Scene&, const ClothModel&, Reports reports) {
    const auto count = [](const StepReport& r) { return std::uint64_t{r.pulling}; };
    const auto [first, most] = first_and_most(reports, count);
    if (!first) return {};
    return fmt::format(
        "contacts with solids stayed though they pulled, first at {:.4g} s, at most {} at {:.4g} s", first->t,
        count(*most), most->t);
}

Line unconverged(const Scene& scene, const ClothModel&, Reports reports) {
    const auto open = std::ranges::count(reports, false, &StepReport::converged);
    if (open == 0) return {};
    const StepReport& first = *std::ranges::find(reports, false, &StepReport::converged);
    const bool newton = scene.solver.integrator == Integrator::newton;
    return fmt::format(
        "{} of {} steps did not reach the tolerance {} within {} iterations{}, the first at {:.4g} s (step "
        "{}): "
        "what they left undone shows as cloth that gives; a smaller step{} gets there",
        open, reports.size(), scene.solver.tolerance, scene.solver.max_iterations,
        newton ? ", or Newton's method within its linearisations" : "", first.t, first.step,
        newton ? "" : " or more solver.max_iterations");
}

// Adaptive steps try a larger one before they take it, and are meant to.
Line taken_again(const Scene& scene, const ClothModel&, Reports reports) {
    if (scene.solver.adaptive) return {};
    const auto count = [](const StepReport& r) { return std::uint64_t{r.rejected}; };
    const auto again = std::ranges::count_if(reports, [&](const StepReport& r) { return count(r) > 0; });
    if (static_cast<double>(again) <= notable_repeats * static_cast<double>(reports.size())) return {};
    return fmt::format(
        "{} of {} steps were taken again because they would have ended with energy from nowhere, the first "
        "at "
        "{:.4g} s: {:.3g} s is long for what happens; a smaller solver.step, or [solver.adaptive], follows "
        "it",
        again, reports.size(), first_and_most(reports, count).first->t, scene.solver.step);
}

Line air_held(const Scene&, const ClothModel&, Reports reports) {
    const auto count = [](const StepReport& r) { return std::uint64_t{r.air_held}; };
    const auto [first, most] = first_and_most(reports, count);
    if (!first) return {};
    return fmt::format(
        "the wind pushes {} less than it would, first at {:.4g} s, at most {} at {:.4g} s: explicit steps so "
        "long do not bear it whole; more solver.substeps do, or an implicit integrator",
        counted(count(*first), "cell", "cells"), first->t, count(*most), most->t);
}

// Whether something other than its own weight moves the cloth at time t.
bool is_driven(const ClothModel& model, double t) {
    const auto goes_on = [&](const Motion& motion) { return !motion.empty() && motion.back().time > t; };
    const auto drives = [&](const PinnedGroup& pin) {
        return goes_on(pin.motion) || (pin.carried.by && pin.carried.by->moves()) || !pin.triangles.empty() ||
               (pin.gather != 1 && pin.gather_begin + pin.gather_time > t);
    };
    const auto pushes = [&](const Solid& solid) {
        return goes_on(solid.motion) || solid.fall || (solid.carried.by && solid.carried.by->moves()) ||
               (solid.geometry && solid.geometry->deforms());
    };
    const bool blows =
        model.wind && (!wind_velocity(*model.wind, t).isZero() || !model.wind->keyframes.empty());
    return blows || std::ranges::any_of(model.pins, drives) || std::ranges::any_of(model.solids, pushes);
}

Line still_moving(const Scene& scene, const ClothModel& model, Reports reports) {
    if (reports.empty() || is_driven(model, reports.back().t)) return {};
    const double mass = std::accumulate(model.mass.begin(), model.mass.end(), 0.0);
    const double speed = std::sqrt(2 * reports.back().kinetic / mass);
    double size = 0;
    for (const ClothPatch& patch : model.cloths) size = std::max({size, patch.size[0], patch.size[1]});
    if (speed <= visible_share * size * scene.clip.fps.per_second()) return {};
    return fmt::format(
        "the cloth still moves at the end, at {:.2g} m/s (root of the mean square): where it is "
        "to rest, a longer clip.duration or clip.settle lets it",
        speed);
}

Line untouched_solids(const Scene&, const ClothModel& model, Reports reports) {
    // Edges that lie on a solid by surfaces are counted nowhere.
    if (reports.empty() || model.solids.empty() || model.solids_by_surfaces()) return {};
    if (std::ranges::any_of(reports, [](const StepReport& r) { return r.contacts > 0; })) return {};
    return fmt::format("{} never touched by the cloth",
                       model.solids.size() == 1 ? "the solid was" : "all the solids were");
}

Line idle_self_collision(const Scene&, const ClothModel& model, Reports reports) {
    if (reports.empty() || !model.self_collision) return {};
    if (std::ranges::any_of(reports, [](const StepReport& r) { return r.self_contacts > 0; })) return {};
    return "[self_collision] never had anything to do: no layers of cloth came near each other";
}

Line powerless_wind(const Scene& scene, const ClothModel& model, Reports reports) {
    if (reports.empty() || !scene.wind || model.wind) return {};
    return "[wind] did nothing: it has no density, or neither drag nor lift";
}

}  // namespace

std::vector<std::string> findings(const Scene& scene, const ClothModel& model, Reports reports) {
    std::vector<std::string> lines;
    for (const auto& find : {strain, through_cloth, through_solids, pulling, unconverged, taken_again,
                             air_held, still_moving, untouched_solids, idle_self_collision, powerless_wind}) {
        if (Line line = find(scene, model, reports)) lines.push_back(std::move(*line));
    }
    return lines;
}

}  // namespace unravel::sim
