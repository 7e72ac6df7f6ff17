#pragma once

#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// Median, and the whole spread, of repeated measurements.
struct Spread {
    double median = 0, low = 0, high = 0;
    int runs = 0;
};

/// Of at least one value.
Spread spread_of(std::vector<double> values);

}  // namespace unravel::tool
