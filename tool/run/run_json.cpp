#include "tool/run/run_json.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/run/findings.hpp"
#include "sim/step/plan_text.hpp"
#include "sim/terms/effects.hpp"
#include "tool/base/machine.hpp"
#include "tool/base/version.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;

Json totals(const std::vector<StepReport>& reports, std::size_t particles) {
    std::uint64_t rvm = 0, rvm_whole = 0, iterations = 0, unconverged = 0;
    bool compared = !reports.empty();
    double max_strain = 0, max_strain_at = 0, constrained = 0, deepest = 0;
    std::optional<std::uint64_t> crossings, in_solids;
    double crossings_at = 0;
    std::uint32_t components = 0;
    StageTimes times;
    for (const StepReport& r : reports) {
        rvm += r.rvm;
        compared = compared && r.rvm_whole.has_value();
        rvm_whole += r.rvm_whole.value_or(0);
        iterations += r.cg_iterations;
        unconverged += !r.converged;
        if (r.max_strain > max_strain) {
            max_strain = r.max_strain;
            max_strain_at = r.t;
        }
        if (r.crossings && (!crossings || *r.crossings > *crossings)) {
            crossings = r.crossings;
            crossings_at = r.t;
        }
        if (r.in_solids) in_solids = std::max(in_solids.value_or(0), *r.in_solids);
        deepest = std::max(deepest, r.deepest);
        constrained += r.constrained;
        components = std::max(components, r.components);
        times.contact += r.times.contact;
        times.forces += r.times.forces;
        times.graph += r.times.graph;
        times.assembly += r.times.assembly;
        times.solve += r.times.solve;
        times.advance += r.times.advance;
        times.measure += r.times.measure;
    }
    const double rows = static_cast<double>(reports.size()) * static_cast<double>(particles);
    Json json;
    json["rvm"] = rvm;
    if (compared) {
        json["rvm_whole"] = rvm_whole;
        json["rvm_saved"] =
            rvm_whole > 0 ? 1.0 - static_cast<double>(rvm) / static_cast<double>(rvm_whole) : 0.0;
    }
    json["constrained_share"] = rows > 0 ? constrained / rows : 0.0;
    json["cg_iterations"] = iterations;
    json["unconverged_steps"] = unconverged;
    json["most_components"] = components;
    json["max_strain"] = max_strain;
    json["max_strain_at"] = max_strain_at;
    if (crossings) {
        json["crossings"] = *crossings;
        json["crossings_at"] = crossings_at;
    }
    if (in_solids) {
        json["in_solids"] = *in_solids;
        json["deepest"] = deepest;
    }
    json["seconds"] = {{"contact", times.contact},   {"forces", times.forces}, {"graph", times.graph},
                       {"assembly", times.assembly}, {"solve", times.solve},   {"advance", times.advance},
                       {"measure", times.measure},   {"step", times.step()}};
    return json;
}

}  // namespace

Json rate_json(const Rate& rate) {
    return rate.whole() ? Json(rate.num) : Json(rate_text(rate));
}

Json run_json(const Scene& scene, const Simulation& simulation, const RunSource& source, int threads,
              const std::string& status, const ClipReport* clip) {
    Json json;
    json["version"] = version();
    json["scene"] = scene.name;
    json["status"] = status;
    json["host"] = host_name();
    json["processor"] = processor_name();
    json["threads"] = threads;
    json["particles"] = simulation.model.size();
    json["springs"] = {{"stretch", simulation.model.springs.stretch_count},
                       {"shear", simulation.model.springs.size() - simulation.model.springs.stretch_count},
                       {"bend", simulation.model.bends.size() + simulation.model.curvature.size()}};
    json["fps"] = rate_json(scene.clip.fps);
    json["frames"] = source.hashes().size();
    const std::vector<StepReport> reports = source.reports();
    json["steps"] = reports.size();
    if (clip) {
        json["renderer"] = {
            {"name", clip->renderer}, {"software", clip->software}, {"why", clip->renderer_summary}};
        json["encoder"] = clip->encoders;
        json["videos"] = clip->videos;
        json["seconds"] = {{"simulate", source.seconds()},
                           {"draw", clip->draw},
                           {"write", clip->write},
                           {"encode", clip->encode}};
    }
    for (const Effect& effect : list_effects(scene)) {
        json["effects"][effect.name] = {{"on", effect.on}, {"because", effect.because}};
    }
    json["plan"] = plan_json(simulation.ws.plan.step);
    json["warnings"] = scene.notes;
    for (std::string& line : findings(scene, simulation.model, reports))
        json["warnings"].push_back(std::move(line));
    json["totals"] = totals(reports, simulation.model.size());
    for (const std::uint64_t hash : source.hashes())
        json["state_hashes"].push_back(fmt::format("{:016x}", hash));
    return json;
}

}  // namespace unravel::tool
