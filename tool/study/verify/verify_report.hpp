#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tool/study/verify/verify_case.hpp"

namespace unravel::tool {

/// One row per case and setting: expected, the measured range over all grids and steps, the tolerance.
std::string verify_summary(const std::vector<VerifyOutcome>& outcomes);

/// The summary, and a table of every line of every case.
std::string verify_markdown(const std::vector<VerifyOutcome>& outcomes);

/// The same as a page with the plots, which needs no other file.
std::string verify_html(const std::vector<VerifyOutcome>& outcomes);

nlohmann::ordered_json verify_json(const std::vector<VerifyOutcome>& outcomes);

/// A case on one line of a terminal, and the lines of it that do not hold.
std::string terminal_text(const VerifyOutcome& outcome);

}  // namespace unravel::tool
