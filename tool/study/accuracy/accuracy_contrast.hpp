#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/study/accuracy/accuracy_study.hpp"
#include "tool/study/accuracy/accuracy_verdict.hpp"

namespace unravel::tool {

/// A cloth beside the same cloth many times stiffer: where each integrator wins.

/// The scene with its stretch and shear springs `times` as stiff; damping stays.
Scene stiffened(const Scene& scene, double times);

/// Cheapest time at which a method comes within an error: one of its points, or between two of them on log
/// scales [s]. Absent where it does not.
std::optional<double> cost_at(const AccuracyCurve& curve, double error);

/// Errors at which methods are compared: 1 and 3 times powers of ten, from what the coarsest runs give down
/// to what the reference can tell apart.
std::vector<double> error_levels(const AccuracyStudy& study);

/// What it costs to stay within each error, by each integrator, and which wins; in lines of text.
std::string winner_table(const AccuracyStudy& study);

/// In words: who wins where, on the soft cloth and on the stiff one, and how near adaptive IMEX comes to the
/// better of explicit and implicit.
std::string contrast_words(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times);

/// Both work–precision plots on the same axes.
std::array<Plot, 2> contrast_plots(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times);

/// The page: both plots, words, tables.
std::string contrast_page(const AccuracyStudy& soft, const AccuracyStudy& stiff, double times);

}  // namespace unravel::tool
