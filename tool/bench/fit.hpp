#pragma once

#include <limits>
#include <span>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// t = factor · n^exponent.
struct PowerLaw {
    double factor = std::numeric_limits<double>::quiet_NaN();
    double exponent = std::numeric_limits<double>::quiet_NaN();
    int points = 0;  ///< that it was fitted to
    bool known() const { return points >= 2; }
    double at(double n) const;
};

struct Measured {
    double n = 0, t = 0;
};

/// Least squares in the logarithms, over points with n ≥ `from` and t > 0. Of fewer than two different n
/// nothing is known.
PowerLaw fit_power(std::span<const Measured> points, double from = 0);

}  // namespace unravel::tool
