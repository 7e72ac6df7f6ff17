#pragma once

#include "sim/run/simulate.hpp"
#include "tool/base/names.hpp"
#include "tool/bench/speed.hpp"

namespace unravel::tool {

/// Resident memory from its making on, at its highest [bytes]. Where the system can't forget an earlier peak,
/// the present size counts.
class MemoryWatch {
public:
    MemoryWatch();
    double peak() const;

private:
    double before_ = 0;
    bool forgot_ = false;
};

/// What a simulation's arrays hold [bytes per particle], by kind, and under "rest" what `peak` [bytes] has
/// beyond them; peak and rest of large problems only.
MemoryRecord account_memory(const Simulation& simulation, double peak);

}  // namespace unravel::tool
