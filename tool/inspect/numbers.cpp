#include "tool/inspect/numbers.hpp"

#include <fmt/format.h>

#include "sim/linear/system.hpp"
#include "sim/step/plan_text.hpp"
#include "tool/base/exit.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

Json matrix_json(const Mat3& m) {
    return {vector_json(m.row(0)), vector_json(m.row(1)), vector_json(m.row(2))};
}

void require_index(std::int64_t index, std::size_t count, const char* what) {
    if (index >= 0 && static_cast<std::size_t>(index) < count) return;
    throw UsageError(fmt::format("--{} {}: this run has {} of them, numbered from 0", what, index, count));
}

// Where on its cloth a particle is.
Json place_json(const ClothModel& model, std::uint32_t particle) {
    for (const ClothPatch& patch : model.cloths) {
        if (particle < patch.first || particle >= patch.first + patch.count()) continue;
        const std::uint32_t local = particle - patch.first;
        if (!patch.grid()) return {{"cloth", patch.name}, {"vertex", local + 1}};
        const auto along_u = static_cast<std::uint32_t>(patch.particles[0]);
        return {{"cloth", patch.name}, {"i", local % along_u}, {"j", local / along_u}};
    }
    return nullptr;
}

}  // namespace

const char* spring_state_name(SpringState state) {
    return state == SpringState::implicit    ? "implicit"
           : state == SpringState::explicit_ ? "explicit"
                                             : "inactive";
}

Json step_numbers(const InspectedStep& step) {
    const StepReport& r = step.report;
    Json json{{"frame", step.frame},
              {"step_of_frame", step.step},
              {"steps_of_frame", step.steps},
              {"step", r.step},
              {"t", r.t},
              {"h", r.h},
              {"particles", step.record.component.size()},
              {"components", r.components},
              {"largest", r.largest},
              {"constrained", r.constrained},
              {"partly", r.partly},
              {"implicit", r.implicit},
              {"explicit", r.explicit_},
              {"inactive", r.inactive},
              {"contacts", r.contacts},
              {"cg_iterations", r.cg_iterations},
              {"cg_iterations_max", r.cg_iterations_max},
              {"rvm", r.rvm},
              {"converged", r.converged},
              {"max_strain", r.max_strain},
              {"state_hash", fmt::format("{:016x}", state_hash(step.record.state))}};
    json["plan"] = plan_json(step.trace().plan);
    json["component_list"] = Json::array();
    for (const ComponentRow& row : step.components) {
        json["component_list"].push_back(
            {{"id", row.id},
             {"color", fmt::format("#{:02x}{:02x}{:02x}", row.color.r, row.color.g, row.color.b)},
             {"particles", row.particles},
             {"boundary", row.boundary},
             {"implicit_springs", row.springs},
             {"iterations", row.solve.iterations},
             {"rvm", row.solve.rvm},
             {"residual", row.solve.residual},
             {"solver", words(row.solve.by)},
             {"solver_because", words(row.solve.because)},
             {"converged", row.solve.converged}});
    }
    return json;
}

Json spring_numbers(const InspectedStep& step, std::int64_t spring) {
    const ExtensionSprings& springs = step.simulation.model.springs;
    require_index(spring, springs.size(), "spring");
    const auto s = static_cast<std::size_t>(spring);
    const std::uint32_t i = springs.i[s], j = springs.j[s];
    const double before = (step.before.x[j] - step.before.x[i]).norm();
    const double after = (step.record.state.x[j] - step.record.state.x[i]).norm();
    return {{"spring", s},
            {"kind", s < springs.stretch_count ? "stretch" : "shear"},
            {"particles", {i, j}},
            {"components", {step.record.component[i], step.record.component[j]}},
            {"rest", springs.rest[s]},
            {"length_before", before},
            {"length_after", after},
            {"strain_before", before / springs.rest[s] - 1},
            {"strain_after", after / springs.rest[s] - 1},
            {"stiffness", springs.stiffness[s]},
            {"damping", springs.damping[s]},
            {"kappa", step.kappa[s]},
            {"threshold", step.simulation.options.threshold},
            {"state", spring_state_name(step.record.springs[s])},
            {"force", vector_json(step.spring_force[s])}};
}

Json particle_numbers(const InspectedStep& step, std::int64_t particle) {
    const ClothModel& model = step.simulation.model;
    require_index(particle, model.size(), "particle");
    const auto p = static_cast<std::uint32_t>(particle);
    const StepTrace trace = step.trace();
    // Parts of the step may have been solved without being assembled.
    System system;
    assemble(trace.couplings, trace.load, trace.components, trace.constraints, trace.h, system);
    const std::uint32_t row = system.row_of[p];
    Json json{{"particle", p},
              {"place", place_json(model, p)},
              {"mass", model.mass[p]},
              {"x_before", vector_json(step.before.x[p])},
              {"x", vector_json(step.record.state.x[p])},
              {"v", vector_json(step.record.state.v[p])},
              {"dv", vector_json(step.record.state.dv[p])},
              {"component", step.record.component[p]},
              {"free_directions", step.record.free[p]},
              {"row", row},
              {"diagonal_block", matrix_json(system.diagonal[row])},
              {"b", vector_json(system.b[row])},
              {"coupled_particles", Json::array()},
              {"contacts", Json::array()},
              {"springs", Json::array()}};
    if (const Constraint* c = trace.constraints.find(p)) {
        json["constraint"] = {{"S", matrix_json(c->S)}, {"z", vector_json(c->z)}};
    }
    for (std::uint32_t e = system.start[row]; e < system.start[row + 1]; ++e)
        json["coupled_particles"].push_back(trace.components.order[system.entries[e].column]);
    for (const Contact& c : step.record.state.contacts) {
        if (c.particle != p || c.force < 0) continue;
        json["contacts"].push_back(
            {{"solid", model.solids[c.solid].name}, {"held", c.held}, {"force", c.force}});
    }
    model.spring_adjacency.each(
        p, [&](std::uint32_t s, std::uint32_t) { json["springs"].push_back(spring_numbers(step, s)); });
    return json;
}

}  // namespace unravel::tool
