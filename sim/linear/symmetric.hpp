#pragma once

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// A symmetric 3 × 3 block in six numbers.
struct Symmetric3 {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// += a I + scale u uᵀ
    void add(double a, double scale, const Vec3& u) {
        xx += a + scale * u.x() * u.x();
        yy += a + scale * u.y() * u.y();
        zz += a + scale * u.z() * u.z();
        xy += scale * u.x() * u.y();
        xz += scale * u.x() * u.z();
        yz += scale * u.y() * u.z();
    }
    Vec3 operator*(const Vec3& y) const {
        return {xx * y.x() + xy * y.y() + xz * y.z(), xy * y.x() + yy * y.y() + yz * y.z(),
                xz * y.x() + yz * y.y() + zz * y.z()};
    }
    double trace() const { return xx + yy + zz; }
    Mat3 matrix() const {
        Mat3 M;
        M << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        return M;
    }
};

}  // namespace unravel::sim
