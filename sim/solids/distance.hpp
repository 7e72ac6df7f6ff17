#pragma once

#include <cmath>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// v / |v| without under- or overflow, `instead` where v is zero.
template <class Vector>
Vector direction(const Vector& v, const Vector& instead) {
    const double largest = v.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return instead;
    const Vector scaled = v / largest;
    return scaled / scaled.norm();
}

/// Signed distance to a box of the given dimension with half edges `half`; the gradient has unit length
/// everywhere.
template <class Vector>
double box_distance(const Vector& half, const Vector& p, Vector& gradient) {
    const Vector beyond = p.cwiseAbs() - half;
    const auto sign = [&](int axis) { return p[axis] < 0 ? -1.0 : 1.0; };
    gradient.setZero();
    int nearest = 0;
    const double largest = beyond.maxCoeff(&nearest);
    if (largest <= 0) {
        gradient[nearest] = sign(nearest);
        return largest;
    }
    Vector outside = beyond.cwiseMax(0.0);
    gradient = direction<Vector>(outside, Vector::Zero());
    for (int axis = 0; axis < gradient.size(); ++axis) gradient[axis] *= sign(axis);
    return outside.stableNorm();
}

}  // namespace unravel::sim
