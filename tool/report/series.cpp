#include "tool/report/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "sim/run/findings.hpp"
#include "tool/base/progress.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;
using Steps = std::span<const StepReport>;

double short_number(double value) {
    return std::stod(fmt::format("{:.5g}", value));
}

Steps steps_of(const PageFrame& frame, Steps reports) {
    if (frame.last_step == 0 || frame.last_step > reports.size()) return {};
    return reports.subspan(frame.first_step - 1, frame.last_step - frame.first_step + 1);
}

template <typename F>
double sum(Steps steps, const F& of) {
    double total = 0;
    for (const StepReport& step : steps) total += of(step);
    return total;
}

template <typename F>
double most(Steps steps, const F& of) {
    double value = 0;
    for (const StepReport& step : steps) value = std::max(value, static_cast<double>(of(step)));
    return value;
}

// A time differs from run to run beyond four digits anyway.
Json milliseconds(Steps steps, double StageTimes::*slot) {
    return short_number(1e3 * sum(steps, [&](const StepReport& r) { return r.times.*slot; }));
}

}  // namespace

Json page_series(const std::vector<PageFrame>& frames, Steps reports, const ClothModel& model) {
    const double springs = static_cast<double>(std::max<std::size_t>(model.springs.size(), 1));
    using Value = std::function<Json(Steps)>;
    const auto last = [](auto StepReport::*member) -> Value {
        return [member](Steps steps) { return Json(steps.back().*member); };
    };
    const auto total = [](auto StepReport::*member) -> Value {
        return [member](Steps steps) {
            return Json(static_cast<std::uint64_t>(
                sum(steps, [&](const StepReport& r) { return static_cast<double>(r.*member); })));
        };
    };
    const auto greatest = [](double StepReport::*member) -> Value {
        return [member](Steps steps) {
            return Json(short_number(100 * most(steps, [&](const StepReport& r) { return r.*member; })));
        };
    };
    const auto time = [](double StageTimes::*slot) -> Value {
        return [slot](Steps steps) { return milliseconds(steps, slot); };
    };
    const std::pair<const char*, Value> quantities[] = {
        {"components", last(&StepReport::components)},
        {"largest", last(&StepReport::largest)},
        {"constrained", last(&StepReport::constrained)},
        {"partly", last(&StepReport::partly)},
        {"implicit", last(&StepReport::implicit)},
        {"explicit", last(&StepReport::explicit_)},
        {"inactive", last(&StepReport::inactive)},
        {"implicit_share",
         [&](Steps steps) { return Json(short_number(100 * steps.back().implicit / springs)); }},
        {"contacts", last(&StepReport::contacts)},
        {"cg_iterations", total(&StepReport::cg_iterations)},
        {"cg_iterations_max",
         [](Steps steps) {
             return Json(most(steps, [](const StepReport& r) { return r.cg_iterations_max; }));
         }},
        {"rvm", total(&StepReport::rvm)},
        {"rvm_whole",
         [](Steps steps) {
             std::uint64_t rvm = 0;
             for (const StepReport& r : steps) {
                 if (!r.rvm_whole) return Json();
                 rvm += *r.rvm_whole;
             }
             return Json(rvm);
         }},
        {"max_strain", greatest(&StepReport::max_strain)},
        {"p99_strain", greatest(&StepReport::p99_strain)},
        {"lowest", [](Steps steps) { return Json(short_number(steps.back().lowest)); }},
        {"kinetic", [](Steps steps) { return Json(short_number(steps.back().kinetic)); }},
        {"potential", [](Steps steps) { return Json(short_number(steps.back().potential)); }},
        {"ms_solve", time(&StageTimes::solve)},
        {"ms_forces", time(&StageTimes::forces)},
        {"ms_assembly", time(&StageTimes::assembly)},
        {"ms_contact", time(&StageTimes::contact)},
        {"ms_collision", time(&StageTimes::collision)},
        {"ms_air", time(&StageTimes::air)},
        {"ms_graph", time(&StageTimes::graph)},
        {"ms_advance", time(&StageTimes::advance)},
    };
    Json series;
    for (const auto& [name, value] : quantities) {
        Json list = Json::array();
        bool present = false;
        for (const PageFrame& frame : frames) {
            const Steps steps = steps_of(frame, reports);
            list.push_back(steps.empty() ? Json() : value(steps));
            present = present || (!list.back().is_null() && list.back() != 0);
        }
        // Effects that are off have no time, and an uncompared run no whole-system count.
        if (present || name == std::string_view("components")) series[name] = std::move(list);
    }
    return series;
}

std::string page_summary(const Scene& scene, const ClothModel& model, const std::vector<PageFrame>& frames,
                         Steps reports, const std::string& status) {
    std::uint64_t rvm = 0, whole = 0;
    bool compared = !reports.empty();
    double seconds = 0;
    for (const StepReport& r : reports) {
        rvm += r.rvm;
        compared = compared && r.rvm_whole.has_value();
        whole += r.rvm_whole.value_or(0);
        seconds += r.times.step();
    }
    std::string text = fmt::format("{}: {} frames at {} per second, {} steps of {:.4g} ms, {} particles",
                                   status, frames.size(), rate_text(scene.clip.fps), reports.size(),
                                   1e3 * scene.solver.step, model.size());
    if (seconds > 0) text += fmt::format(", {} of simulation", duration_text(seconds));
    if (compared && whole > 0)
        text += fmt::format(", {:.1f}% fewer RVMs than undecomposed",
                            100 * (1 - static_cast<double>(rvm) / static_cast<double>(whole)));
    return text;
}

std::vector<std::string> page_warnings(const Scene& scene, const ClothModel& model,
                                       const std::vector<PageFrame>& frames, Steps reports,
                                       const std::string& status) {
    std::vector<std::string> warnings = scene.notes;
    const int wanted = scene.clip.frames();
    if (status != "complete" && static_cast<int>(frames.size()) < wanted) {
        warnings.push_back(fmt::format("The run was {} after {} of {} frames.",
                                       status == "failed" ? "given up" : "stopped", frames.size(), wanted));
    }
    for (std::string& line : findings(scene, model, reports)) warnings.push_back(std::move(line));
    return warnings;
}

}  // namespace unravel::tool
