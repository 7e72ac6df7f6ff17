#include "tool/base/spread.hpp"

#include <algorithm>

namespace unravel::tool {

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values.front(), values.back(), static_cast<int>(values.size())};
}

}  // namespace unravel::tool
