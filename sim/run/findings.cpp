#include "sim/run/findings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/model/particle_name.hpp"

namespace unravel::sim {

namespace {

// Strain from which on a user wants to be told of it.
constexpr double notable_strain = 0.2;

using Reports = std::span<const StepReport>;

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

}  // namespace

std::vector<std::string> findings(const ClothModel& model, Reports reports) {
    std::vector<std::string> lines;
    const auto strained = std::ranges::max_element(reports, {}, &StepReport::max_strain);
    if (strained != reports.end() && strained->max_strain > notable_strain) {
        lines.push_back(
            fmt::format("the thread from {} to {} was {:.0f}% longer than at rest at {:.4g} s (step {}): "
                        "stiffer cloth or a smaller step makes it less",
                        particle_name(model, model.springs.i[strained->strained]),
                        particle_name(model, model.springs.j[strained->strained]), 100 * strained->max_strain,
                        strained->t, strained->step));
    }
    const auto cloth = [](const StepReport& r) { return r.crossings.value_or(0); };
    if (const auto [first, most] = first_and_most(reports, cloth); first) {
        lines.push_back(fmt::format(
            "cloth passes through cloth from {:.4g} s on: {} there, at most {} at {:.4g} s{}", first->t,
            counted(cloth(*first), "edge", "edges"), cloth(*most), most->t,
            model.cloth_by_surfaces() ? ""
            : model.self_collision    ? "; [self_collision] method = \"surface\" keeps edges and faces apart"
                                      : "; [self_collision] keeps cloth apart"));
    }
    const auto solids = [](const StepReport& r) { return r.in_solids.value_or(0); };
    if (const auto [first, most] = first_and_most(reports, solids); first) {
        const double deepest = std::ranges::max(reports, {}, &StepReport::deepest).deepest;
        lines.push_back(fmt::format(
            "cloth passes through solids from {:.4g} s on: {} there, at most {} at {:.4g} s, and up to "
            "{:.2g} mm "
            "deep{}",
            first->t, counted(solids(*first), "edge", "edges"), solids(*most), most->t, 1e3 * deepest,
            model.solids_by_surfaces()
                ? ""
                : "; contact = \"surface\" of a solid holds edges and faces off, too"));
    }
    const auto pulling = [](const StepReport& r) { return std::uint64_t{r.pulling}; };
    if (const auto [first, most] = first_and_most(reports, pulling); first) {
        lines.push_back(fmt::format(
            "contacts with solids stayed though they pulled, first at {:.4g} s, at most {} at {:.4g} s",
            first->t, pulling(*most), most->t));
    }
    return lines;
}

}  // namespace unravel::sim
