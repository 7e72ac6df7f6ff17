#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/model/report.hpp"

namespace unravel::sim {

/// A column of stats.csv: its name, what it means, and its value in a row.
struct StatsColumn {
    const char* name;
    const char* meaning;
    std::string (*text)(const StepReport&);
    bool timing = false;  ///< differs from run to run
};

/// All columns, in the file's order.
std::span<const StatsColumn> stats_columns();

/// The file's first line.
std::string stats_header();
/// One line per step. Numbers are written so that they read back to the same bits.
std::string stats_rows(std::span<const StepReport> reports);

/// Puts the stage times of an earlier stats.csv into reports of the same steps (frame records hold none).
/// Rows that do not parse are left alone.
void take_times(const std::string& csv, std::span<StepReport> reports);

}  // namespace unravel::sim
