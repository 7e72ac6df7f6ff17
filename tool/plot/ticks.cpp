#include "tool/plot/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace unravel::tool {

std::string power_of_ten(int exponent) {
    constexpr std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = "10";
    if (exponent < 0) text += "⁻";
    for (const char digit : std::to_string(std::abs(exponent)))
        text += raised[static_cast<std::size_t>(digit - '0')];
    return text;
}

std::vector<Tick> linear_ticks(double from, double to, int wanted) {
    const double raw = (to - from) / wanted;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10 * power;
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= raw * (1 - 1e-9)) {
            step = factor * power;
            break;
        }
    }
    std::vector<Tick> ticks;
    const double slack = 1e-9 * step;
    for (double k = std::ceil((from - slack) / step); k * step <= to + slack; ++k) {
        // 0 instead of −0, and no 0.30000000000000004.
        ticks.push_back({k * step, fmt::format("{:.6g}", k == 0 ? 0.0 : k * step)});
    }
    return ticks;
}

std::vector<Tick> log_ticks(double from, double to) {
    std::vector<Tick> ticks;
    const int first = static_cast<int>(std::floor(std::log10(from)));
    const int last = static_cast<int>(std::ceil(std::log10(to)));
    const double decades = std::log10(to / from);
    const int every = std::max(1, static_cast<int>(std::lround(decades / 7)));
    for (int e = first; e <= last; ++e) {
        for (int m = 1; m < 10; ++m) {
            const double value = m * std::pow(10.0, e);
            if (value < from * (1 - 1e-9) || value > to * (1 + 1e-9)) continue;
            const bool labelled = m == 1 ? e % every == 0 : decades < 2.2 && (m == 2 || m == 5);
            std::string label;
            if (labelled)
                label =
                    decades < 2.2 || (from > 5e-3 && to < 5e4) ? fmt::format("{:g}", value) : power_of_ten(e);
            ticks.push_back({value, std::move(label)});
        }
    }
    return ticks;
}

}  // namespace unravel::tool
