#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/study/stability/hard_case.hpp"

namespace unravel::tool {

/// A case with what became of it.
struct HardLine {
    HardCase hard;
    HardOutcome outcome;
    std::string picture;  ///< file name beside the report; empty: none
};

/// "survived", "refused", "stopped", or "FAILED" where it is not as it must be.
std::string verdict(const HardLine& line);

/// The case on one line of a terminal.
std::string terminal_line(const HardLine& line);

nlohmann::ordered_json stability_json(const HardLine& line);
nlohmann::ordered_json stability_json(const std::vector<HardLine>& lines);

/// The two tables of the README's section on reliability: what must survive, what must not.
std::string stability_markdown(const std::vector<HardLine>& lines);

/// A page with each case's picture and numbers, and the maps' pictures.
std::string stability_html(const std::vector<HardLine>& lines, const std::vector<std::string>& maps);

}  // namespace unravel::tool
