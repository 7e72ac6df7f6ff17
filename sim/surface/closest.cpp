#include "sim/surface/closest.hpp"

#include <algorithm>

namespace unravel::sim {

namespace {

// Two directions whose sine is below this are parallel: which points are nearest is then a matter of
// rounding.
constexpr double parallel_sine = 1e-7;

// The nearest point of a triangle's outline: of one without area, of the whole.
Vec3 closest_on_outline(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double ab = closest_on_segment(p, a, b), bc = closest_on_segment(p, b, c),
                 ca = closest_on_segment(p, c, a);
    const std::array<Vec3, 3> weights{Vec3(1 - ab, ab, 0), Vec3(0, 1 - bc, bc), Vec3(ca, 0, 1 - ca)};
    const auto distance = [&](const Vec3& w) { return (w[0] * a + w[1] * b + w[2] * c - p).squaredNorm(); };
    return *std::min_element(weights.begin(), weights.end(), [&](const Vec3& one, const Vec3& other) {
        return distance(one) < distance(other);
    });
}

}  // namespace

double closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double length2 = ab.squaredNorm();
    return length2 > 0 ? std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) : 0.0;
}

Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double bb = ab.squaredNorm(), cc = ac.squaredNorm(), bc = ab.dot(ac);
    const double area2 = bb * cc - bc * bc;  // (twice the area)²
    if (!(area2 > parallel_sine * parallel_sine * bb * cc)) return closest_on_outline(p, a, b, c);
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    const double beta = (cc * d1 - bc * d2) / area2, gamma = (bb * d2 - bc * d1) / area2;
    if (beta >= 0 && gamma >= 0 && beta + gamma <= 1) return {1 - beta - gamma, beta, gamma};
    return closest_on_outline(p, a, b, c);
}

std::array<double, 2> closest_on_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = d - c, r = a - c;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
    if (!(uu > 0)) return {0.0, closest_on_segment(a, c, d)};
    if (!(vv > 0)) return {closest_on_segment(c, a, b), 0.0};
    const double sine2 = uu * vv - uv * uv;
    if (!(sine2 > parallel_sine * parallel_sine * uu * vv)) {
        // The stretch of ab that cd lies beside; where there is none, the end nearest to it.
        const double from = -ur / uu, to = u.dot(d - a) / uu;
        const double low = std::max(0.0, std::min(from, to)), high = std::min(1.0, std::max(from, to));
        const double s = low <= high ? 0.5 * (low + high) : std::clamp(0.5 * (low + high), 0.0, 1.0);
        return {s, closest_on_segment(a + s * u, c, d)};
    }
    double s = std::clamp((uv * vr - ur * vv) / sine2, 0.0, 1.0);
    const double t = (uv * s + vr) / vv;
    if (t >= 0 && t <= 1) return {s, t};
    const double end = t < 0 ? 0.0 : 1.0;
    s = closest_on_segment(c + end * v, a, b);
    return {s, end};
}

Weights vertex_triangle_weights(const std::array<Vec3, 4>& x) {
    const Vec3 w = closest_on_triangle(x[0], x[1], x[2], x[3]);
    return {1.0, -w[0], -w[1], -w[2]};
}

Weights edge_edge_weights(const std::array<Vec3, 4>& x) {
    const auto [s, t] = closest_on_segments(x[0], x[1], x[2], x[3]);
    return {1 - s, s, t - 1, -t};
}

}  // namespace unravel::sim
