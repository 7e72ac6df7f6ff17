#pragma once

#include <string>
#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

struct Tick {
    double value = 0;
    std::string label;  ///< empty: a small tick
};

/// Ticks of a linear axis: about `wanted` multiples of 1, 2 or 5 times a power of ten within [from, to].
std::vector<Tick> linear_ticks(double from, double to, int wanted);

/// Ticks of a logarithmic axis, from > 0: decades, labelled as powers of ten where there are many, and 2 and
/// 5 between them where there are few.
std::vector<Tick> log_ticks(double from, double to);

/// "10⁻³".
std::string power_of_ten(int exponent);

}  // namespace unravel::tool
