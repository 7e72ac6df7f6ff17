#include "sim/step/plan_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace unravel::sim {

namespace {

using Json = nlohmann::ordered_json;

const char* path_name(bool by_rows) {
    return by_rows ? "rows" : "general";
}

// Where all that is not swept is one with how the substeps' forces are taken.
bool term_by_rows(const StepPlan& plan, const ForcePlan::Term& planned) {
    return plan.way == StepPlan::Way::swept || planned.by_rows;
}

const std::string& term_because(const StepPlan& plan, const ForcePlan::Term& planned) {
    return plan.way == StepPlan::Way::swept ? plan.way_because : planned.because;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> plan_words(const StepPlan& plan) {
    std::vector<std::pair<std::string, std::string>> words;
    words.emplace_back("integrator",
                       fmt::format("{}: {}", scheme_of(plan.integrator).name, plan.integrator_because));
    words.emplace_back("steps",
                       fmt::format("{}{}: {}", way_name(plan.way),
                                   plan.substeps > 1 ? fmt::format(" in {} substeps", plan.substeps) : "",
                                   plan.way_because));
    const bool coupled = plan.way == StepPlan::Way::coupled;
    for (const ForcePlan::Term& planned : plan.forces.terms) {
        words.emplace_back(planned.term->name,
                           fmt::format("{}, by the {} path: {}",
                                       planned.implicit && coupled ? "split or implicit" : "explicit",
                                       path_name(term_by_rows(plan, planned)), term_because(plan, planned)));
    }
    for (const StepPlan::Cloth& cloth : plan.cloths) {
        words.emplace_back("cloth " + cloth.name, fmt::format("forces by the {} path: {}; solver: {}, as {}",
                                                              path_name(cloth.by_rows), cloth.forces_because,
                                                              cloth.solver, cloth.solver_because));
    }
    return words;
}

Json plan_json(const StepPlan& plan) {
    Json json{{"integrator", scheme_of(plan.integrator).name},
              {"integrator_because", plan.integrator_because},
              {"steps", way_name(plan.way)},
              {"steps_because", plan.way_because},
              {"substeps", plan.substeps},
              {"forces", Json::array()},
              {"cloths", Json::array()}};
    for (const ForcePlan::Term& planned : plan.forces.terms) {
        json["forces"].push_back({{"name", planned.term->name},
                                  {"path", path_name(term_by_rows(plan, planned))},
                                  {"because", term_because(plan, planned)},
                                  {"implicit", planned.implicit && plan.way == StepPlan::Way::coupled}});
    }
    for (const StepPlan::Cloth& cloth : plan.cloths) {
        json["cloths"].push_back({{"name", cloth.name},
                                  {"path", path_name(cloth.by_rows)},
                                  {"because", cloth.forces_because},
                                  {"solver", cloth.solver},
                                  {"solver_because", cloth.solver_because}});
    }
    return json;
}

}  // namespace unravel::sim
