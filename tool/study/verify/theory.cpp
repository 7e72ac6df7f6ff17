#include "tool/study/verify/theory.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace unravel::tool {

namespace {

// Integrates from the clamp with a curvature there; θ' at the free end. A strip so soft that it hangs turns
// within a small part of its length, which the step has to resolve.
double curvature_at_end(double start, double length, double stiffness, int steps,
                        std::vector<std::array<double, 2>>* path) {
    const double h = length / steps;
    double theta = 0, rate = start;
    const auto bent = [&](double s, double angle) { return -stiffness * (length - s) * std::cos(angle); };
    for (int k = 0; k < steps; ++k) {
        const double s = k * h;
        if (path) path->push_back({s, theta});
        const double a1 = rate, b1 = bent(s, theta);
        const double a2 = rate + 0.5 * h * b1, b2 = bent(s + 0.5 * h, theta + 0.5 * h * a1);
        const double a3 = rate + 0.5 * h * b2, b3 = bent(s + 0.5 * h, theta + 0.5 * h * a2);
        const double a4 = rate + h * b3, b4 = bent(s + h, theta + h * a3);
        theta += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        rate += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
        // Beyond upright no strip comes; what overshoots tells so by its sign.
        if (theta > std::numbers::pi / 2) return 1;
    }
    if (path) path->push_back({length, theta});
    return rate;
}

}  // namespace

std::vector<ElasticaPoint> heavy_elastica(double length, double weight, double bend, int points) {
    const double stiffness = weight / bend;
    const int steps = 40 * points;
    // The curvature at the clamp is largest for small bends, (w/B) L²/2, and smaller for all others.
    double low = 0, high = 0.5 * stiffness * length * length;
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (curvature_at_end(middle, length, stiffness, steps, nullptr) > 0 ? high : low) = middle;
    }
    std::vector<std::array<double, 2>> path;
    curvature_at_end(low, length, stiffness, steps, &path);
    std::vector<ElasticaPoint> out{{0, 0}};
    ElasticaPoint at{0, 0};
    for (std::size_t k = 1; k < path.size(); ++k) {
        const double angle = 0.5 * (path[k][1] + path[k - 1][1]), h = path[k][0] - path[k - 1][0];
        at.across += h * std::cos(angle);
        at.down += h * std::sin(angle);
        if (k % 40 == 0) out.push_back(at);
    }
    return out;
}

double catenary_sag(double length, double span) {
    // length = 2 c sinh(span/(2 c)), sag = c (cosh(span/(2 c)) − 1)
    double low = 1e-3 * span, high = 1e6 * span;
    for (int k = 0; k < 300; ++k) {
        const double c = std::sqrt(low * high);
        (2 * c * std::sinh(span / (2 * c)) > length ? low : high) = c;
    }
    return low * (std::cosh(span / (2 * low)) - 1);
}

}  // namespace unravel::tool
