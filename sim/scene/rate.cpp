#include "sim/scene/rate.hpp"

#include <fmt/format.h>

#include <numeric>

namespace unravel::sim {

Rate::Rate(int numerator, int denominator)
    : num(numerator / std::gcd(numerator, denominator)),
      den(denominator / std::gcd(numerator, denominator)) {}

std::string rate_text(const Rate& rate) {
    return rate.whole() ? fmt::format("{}", rate.num) : fmt::format("{}/{}", rate.num, rate.den);
}

std::string step_text(const Rate& rate, long long steps_per_frame) {
    return fmt::format("{}/{}", rate.den, rate.num * steps_per_frame);
}

}  // namespace unravel::sim
