#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace unravel::sim {

/// What a step was stopped by.
enum class Criterion {
    not_finite,  ///< a position, velocity or energy is no number any more
    strain,    ///< a stretch spring is longer than any cloth gets: the run has exploded or the cloth is torn
    energy,    ///< mechanical energy grew by more than anything puts in
    unsolved,  ///< conjugate gradients ended far from the solution
    pinched,   ///< what is prescribed drives cloth through cloth
};

/// "not_finite", "strain", "energy", "unsolved", "pinched".
const char* criterion_name(Criterion criterion);

/// Why a step can't go on.
struct StepFailure {
    Criterion criterion = Criterion::not_finite;
    std::uint64_t step = 0;                ///< the step that failed, 1 for the first
    double t = 0;                          ///< s, at its beginning
    double h = 0;                          ///< s
    std::vector<std::uint32_t> particles;  ///< those it shows in, the worst first
    std::optional<std::uint32_t> spring;   ///< of the extension springs, where one is to blame
    double value = 0, limit = 0;           ///< what the criterion looks at, and what it may be
    std::string advice;                    ///< what to change
};

/// A step that can't go on: what() says which step, which particle, which criterion, and what to change.
class SimulationError : public std::runtime_error {
public:
    SimulationError(const std::string& what, StepFailure failure)
        : std::runtime_error(what), failure_(std::move(failure)) {}
    const StepFailure& failure() const { return failure_; }

private:
    StepFailure failure_;
};

}  // namespace unravel::sim
