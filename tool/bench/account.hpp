#pragma once

#include <string>
#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// A stage that is a loop over particles or springs.
struct StageWork {
    std::string name;
    double seconds = 0;  ///< on one thread
    double serial = 0;   ///< share that more threads don't shorten, as measured
};

/// A level of the largest component's preconditioner: its share of that component's work, and into how many
/// tasks its loops fall.
struct LevelWork {
    double share = 1;
    int tasks = 1;
};

/// What a step costs and what of it must happen one after the other, from one thread's costs, so that its
/// time on more threads can be foretold.
///
/// Work W is all that one thread does. Span S is what no number of threads shortens: of every stage its
/// serial share, and of the solve its longest component, which is not cut further than its levels have tasks.
/// On p threads
///   stage     T(p) = T₁ (s + (1 − s)/p)
///   largest   T(p) = Σ over levels  T₁ share (s + (1 − s)/min(p, tasks))
///   solve     T(p) = max(largest, all components/p)
/// and the step is their sum. s comes from one against `threads` threads of the same run, so it also holds
/// what these took from each other in memory bandwidth and by other programs.
struct Account {
    std::vector<StageWork> stages;                              ///< all but the solve
    std::vector<double> components;                             ///< s on one thread, the largest first
    std::vector<LevelWork> levels = std::vector<LevelWork>(1);  ///< of the largest component
    double serial = 0;                                          ///< share of the largest component's work
    double work() const;                                        ///< s
    double span() const;                                        ///< s
    double time(int threads) const;                             ///< s
    double speed_up(int threads) const { return work() / time(threads); }
    /// Of tasks over components alone, as the paper has them: W over the sum of the stages and the largest
    /// component, none of it cut.
    double components_alone() const;
};

/// s of T(p) = T₁ (s + (1 − s)/p), within [0, 1].
double serial_share(double one, double many, int threads);

/// Levels of a multigrid of `depth` levels over a grid of `rows` × `columns`, each a quarter of the one above
/// it in work, cut into bands of `band` nodes.
std::vector<LevelWork> levels_of_grid(int columns, int rows, int depth, int band);

/// The model in words, for the output.
extern const char* const account_words;

}  // namespace unravel::tool
