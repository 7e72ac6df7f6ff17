#include <cmath>

#include "tool/bench/measure_steps.hpp"
#include "tool/bench/speed_report.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json spread_json(const Spread& s) {
    return {{"median", s.median}, {"low", s.low}, {"high", s.high}, {"runs", s.runs}};
}

Json step_json(const StepRecord& step) {
    Json json{{"name", step.name}, {"threads", step.threads}};
    if (!step.left_out.empty()) json["left_out"] = step.left_out;
    if (step.seconds.runs == 0) return json;
    json["seconds"] = spread_json(step.seconds);
    json["substeps"] = step.substeps;
    json["iterations"] = step.iterations;
    for (const auto& [name, slot] : step_stages) json["stages"][name] = step.stages.*slot;
    return json;
}

Json solve_json(const SolveRecord& solve) {
    Json json{{"name", solve.name}, {"threads", solve.threads}, {"ours", solve.ours}};
    if (!solve.left_out.empty()) json["left_out"] = solve.left_out;
    if (solve.seconds.runs == 0) return json;
    json["seconds"] = spread_json(solve.seconds);
    json["set_up"] = solve.set_up;
    json["iterations"] = solve.iterations;
    json["residual"] = number(solve.residual);
    json["seconds_per_row_and_iteration"] = number(solve.row_iteration);
    json["bytes_per_row_and_iteration"] = number(solve.row_bytes);
    return json;
}

Json account_json(const Account& account) {
    Json json{{"work", account.work()},
              {"span", account.span()},
              {"serial_share_of_the_largest", account.serial},
              {"components_alone", number(account.components_alone())}};
    json["speed_up"] = Json::object();
    for (const int threads : {2, 4, 8, 16, 32, 64})
        json["speed_up"][std::to_string(threads)] = number(account.speed_up(threads));
    return json;
}

}  // namespace

Json speed_json(const SpeedBench& bench) {
    Json json{{"scene", bench.scene},
              {"processor", bench.processor},
              {"threads", bench.threads},
              {"seconds", bench.seconds},
              {"triad_gb_per_s",
               {{"memory_one", bench.memory_triad[0]},
                {"memory_all", bench.memory_triad[1]},
                {"cache_one", bench.cache_triad[0]},
                {"cache_all", bench.cache_triad[1]}}}};
    json["sizes"] = Json::array();
    for (const SizeRecord& size : bench.sizes) {
        Json s{{"particles", size.particles},
               {"grid", size.grid},
               {"step", size.step},
               {"start", size.start},
               {"max_strain", size.max_strain},
               {"p99_strain", size.p99_strain},
               {"rows", size.rows},
               {"components", size.components},
               {"largest", size.largest},
               {"constrained", size.constrained}};
        for (const StepRecord& step : size.steps) s["steps"].push_back(step_json(step));
        for (const SolveRecord& solve : size.solves) s["solves"].push_back(solve_json(solve));
        s["memory"]["peak"] = number(size.memory.peak);
        for (const auto& [name, bytes] : size.memory.arrays) s["memory"]["arrays"][name] = bytes;
        s["account"] = account_json(size.account);
        json["sizes"].push_back(std::move(s));
    }
    json["exponents"]["step"] = number(step_law(bench, nullptr, bench.threads).exponent);
    for (const auto& [name, slot] : step_stages)
        json["exponents"][name] = number(step_law(bench, slot, bench.threads).exponent);
    json["goals"] = Json::array();
    for (const Goal& goal : judge_goals(bench)) {
        json["goals"].push_back({{"what", goal.what},
                                 {"bound", goal.bound},
                                 {"reached", goal.reached},
                                 {"met", goal.met < 0 ? Json(nullptr) : Json(goal.met == 1)}});
    }
    return json;
}

}  // namespace unravel::tool
