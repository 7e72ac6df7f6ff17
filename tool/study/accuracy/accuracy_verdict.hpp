#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/plot/plot.hpp"
#include "tool/study/accuracy/accuracy.hpp"

namespace unravel::tool {

/// What the points of a study say.

/// One method's points from large steps to small.
struct AccuracyCurve {
    std::string method;
    std::vector<const AccuracyPoint*> points;
    /// log2 of the error's fall where the step is halved, at the two smallest steps that are clear of the
    /// floor; absent where there are none.
    std::optional<double> order;
};
std::vector<AccuracyCurve> curves_of(const std::vector<AccuracyPoint>& points, double floor);

/// The processor that most points were timed on, the first of them in the alphabet where there are several.
std::string processor_of_most(const std::vector<AccuracyPoint>& points);

/// Times of different processors make no front: keeps the points of processor_of_most(), and broken ones,
/// which have no time. Returns in words what was left out and what to do; empty where nothing was.
std::string leave_out_other_processors(std::vector<AccuracyPoint>& points);

/// Points that no other beats in both time and error, from cheap to accurate.
std::vector<const AccuracyPoint*> pareto_front(const std::vector<AccuracyPoint>& points);

/// Seconds at which a curve reaches an error, interpolated between its points on log scales; absent where
/// it does not reach it, or is better from its first point on.
std::optional<double> seconds_at(const AccuracyCurve& curve, double error);

/// The study in a table and a sentence or two.
std::string accuracy_table(const std::vector<AccuracyPoint>& points, const AccuracyReference& reference,
                           double error, const Rate& fps);
std::string recommendation(const std::vector<AccuracyPoint>& points, double error, double seconds_simulated,
                           const Rate& fps);

/// Error over time, or over RVMs.
enum class CostAxis { time, rvm };
Plot accuracy_plot(const std::vector<AccuracyPoint>& points, const AccuracyReference& reference,
                   const std::string& scene, double seconds_simulated, const Rate& fps, CostAxis axis);

/// The page: plots within it, table, sentence.
std::string accuracy_page(const std::vector<AccuracyPoint>& points, const AccuracyReference& reference,
                          const std::string& scene, double seconds_simulated, const Rate& fps, double error);

}  // namespace unravel::tool
