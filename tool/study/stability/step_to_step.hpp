#pragma once

#include <cstdint>
#include <vector>

#include "sim/run/simulate.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// What changes from one step to the next although nothing should: springs that turn between explicit and
/// implicit (flicker), contacts that friction catches or lets go (chatter), contacts that open or close
/// (jitter).
class StepToStep {
public:
    struct Shares {
        double flicker = 0;              ///< of the springs
        double chatter = 0, jitter = 0;  ///< of the contacts before and after
    };
    /// Compares what the simulation stands at with what it stood at in the last call.
    Shares next(const Simulation& simulation);

private:
    std::vector<SpringState> springs_;
    std::vector<Contact> contacts_;
};

}  // namespace unravel::tool
