#include "render/sampling.hpp"

#include <cmath>
#include <numbers>

namespace unravel::render {

namespace {

/// Digits of k in this base, mirrored at the point.
float mirrored(int k, int base) {
    float value = 0, share = 1;
    for (; k > 0; k /= base) {
        share /= static_cast<float>(base);
        value += share * static_cast<float>(k % base);
    }
    return value;
}

/// k-th value of the golden sequence of this step, from a start of its own.
float golden(int k, double step, double start) {
    double whole = 0;
    return static_cast<float>(std::modf(start + step * k, &whole));
}

Vec2f on_disk(float radius2, float turn) {
    const float angle = 2 * std::numbers::pi_v<float> * turn, radius = std::sqrt(radius2);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace

Sample sample_at(int k) {
    // Inverses of the plastic number and of its square.
    constexpr double first = 0.7548776662466927, second = 0.5698402909980532;
    Sample sample;
    sample.pixel = Vec2f(golden(k, first, 0.5), golden(k, second, 0.5)) - Vec2f(0.5f, 0.5f);
    sample.lamp = on_disk(mirrored(k + 1, 2), mirrored(k + 1, 3));
    sample.lens = on_disk(mirrored(k + 1, 5), mirrored(k + 1, 7));
    const float height = golden(k, second, 0.31), turn = golden(k, first, 0.17);
    const Vec2f across = on_disk(1 - height * height, turn);
    sample.sky = {across.x(), height, across.y()};
    return sample;
}

}  // namespace unravel::render
