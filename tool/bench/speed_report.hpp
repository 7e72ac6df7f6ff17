#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/bench/speed.hpp"
#include "tool/plot/plot.hpp"

namespace unravel::tool {

/// Goals and steps as tables in Markdown, which read as plain text too: what README shows.
std::string speed_summary(const SpeedBench& bench);

/// All of it: besides these, stages, solvers, iterations, memory and what more threads would bring.
std::string speed_text(const SpeedBench& bench);

/// As bench.schema.json describes it.
nlohmann::ordered_json speed_json(const SpeedBench& bench);

/// Time of a step by stage, and of a solve by solver, over n.
std::vector<Plot> speed_plots(const SpeedBench& bench);
/// A row and iteration by solver over n; the speed-up that the account foretells over threads.
std::vector<Plot> detail_plots(const SpeedBench& bench);

/// "10k", "1M".
std::string size_name(double particles);

}  // namespace unravel::tool
