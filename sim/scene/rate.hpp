#pragma once

#include <string>

namespace unravel::sim {

/// Frames per second as a fraction of whole numbers: 30, or 30000/1001 as film and television have it.
/// Without a common divisor.
struct Rate {
    int num = 30, den = 1;
    Rate() = default;
    Rate(int whole) : num(whole) {}
    Rate(int numerator, int denominator);

    double per_second() const { return static_cast<double>(num) / den; }
    /// s, when frame k is due: rounded once.
    double time_of(int frame) const { return static_cast<double>(frame) * den / num; }
    bool whole() const { return den == 1; }
    bool operator==(const Rate&) const = default;
};

/// "30", "30000/1001".
std::string rate_text(const Rate& rate);

/// A frame cut into equal steps, as a scene may say it: "1/240", "1001/240000" [s].
std::string step_text(const Rate& rate, long long steps_per_frame);

}  // namespace unravel::sim
