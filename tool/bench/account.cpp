#include "tool/bench/account.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace unravel::tool {

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

double shortened(double serial, double by) {
    return serial + (1 - serial) / by;
}

double step_time(const Account& account, double threads) {
    double time = 0;
    for (const StageWork& stage : account.stages) time += stage.seconds * shortened(stage.serial, threads);
    if (account.components.empty()) return time;
    double largest = 0;
    for (const LevelWork& level : account.levels)
        largest += level.share * shortened(account.serial, std::min<double>(threads, level.tasks));
    largest *= account.components.front();
    const double all = std::accumulate(account.components.begin(), account.components.end(), 0.0);
    return time + std::max(largest, all / threads);
}

}  // namespace

const char* const account_words =
    "A stage is a loop that p threads shorten to s + (1 - s)/p of its time on one, s measured on one thread "
    "against all of this machine's, so that it holds what they take from each other in memory bandwidth. In "
    "the solve each component is a task. The largest is cut further: level by level of its multigrid into as "
    "many tasks as the level has bands of rows, the same s within each. The solve takes as long as its "
    "largest "
    "component or as all of them shared evenly, whichever is longer. Span is the time left with no end of "
    "threads.";

double Account::work() const {
    return step_time(*this, 1);
}

double Account::span() const {
    return step_time(*this, no_limit);
}

double Account::time(int threads) const {
    return step_time(*this, threads);
}

double Account::components_alone() const {
    double time = 0;
    for (const StageWork& stage : stages) time += stage.seconds;
    return work() / (time + (components.empty() ? 0 : components.front()));
}

double serial_share(double one, double many, int threads) {
    if (threads < 2 || !(one > 0)) return 1;
    const double p = threads;
    return std::clamp((many / one - 1 / p) / (1 - 1 / p), 0.0, 1.0);
}

std::vector<LevelWork> levels_of_grid(int columns, int rows, int depth, int band) {
    std::vector<LevelWork> levels;
    double work = 1, all = 0;
    for (int k = 0; k < std::max(depth, 1); ++k) {
        const int per_task = std::max(1, band / std::max(columns, 1));
        levels.push_back({work, std::max(1, (rows + per_task - 1) / per_task)});
        all += work;
        work /= 4;
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
    }
    for (LevelWork& level : levels) level.share /= all;
    return levels;
}

}  // namespace unravel::tool
