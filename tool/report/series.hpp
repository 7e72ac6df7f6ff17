#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "sim/model/report.hpp"
#include "tool/base/names.hpp"
#include "tool/report/page.hpp"

namespace unravel::tool {

/// The page's plots and numbers: a list over frames for each quantity. Counts of work and times are sums over
/// the frame's steps, strain the largest of them, all else what the last step left; null where there is none.
nlohmann::ordered_json page_series(const std::vector<PageFrame>& frames, std::span<const StepReport> reports,
                                   const ClothModel& model);

/// One line about the whole run.
std::string page_summary(const Scene& scene, const ClothModel& model, const std::vector<PageFrame>& frames,
                         std::span<const StepReport> reports, const std::string& status);

/// What a user should know before trusting the run, a sentence each.
std::vector<std::string> page_warnings(const Scene& scene, const ClothModel& model,
                                       const std::vector<PageFrame>& frames,
                                       std::span<const StepReport> reports, const std::string& status);

}  // namespace unravel::tool
