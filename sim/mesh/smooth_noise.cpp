#include "sim/mesh/smooth_noise.hpp"

#include <cmath>

#include "sim/scene/random.hpp"

namespace unravel::sim {

namespace {

// A random unit vector for each corner of the lattice.
Vec3 lattice_gradient(std::uint64_t seed, const Eigen::Vector3i& corner) {
    std::uint64_t index = 0;
    for (const int c : corner) index = index * 0x9e3779b97f4a7c15ull + static_cast<std::uint32_t>(c);
    const Vec3 random(seeded_uniform(seed, 3 * index), seeded_uniform(seed, 3 * index + 1),
                      seeded_uniform(seed, 3 * index + 2));
    const double length = random.norm();
    return length > 1e-9 ? Vec3(random / length) : Vec3(Vec3::UnitX());
}

}  // namespace

double smooth_noise(std::uint64_t seed, const Vec3& at) {
    const Vec3 cell = at.array().floor(), within = at - cell;
    const Vec3 fade = within.array().cube() *
                      (within.array() * (6.0 * within.array() - 15.0) + 10.0);  // the quintic of 2002
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
        const Eigen::Vector3i step(k & 1, (k >> 1) & 1, k >> 2);
        double weight = 1;
        for (int c = 0; c < 3; ++c) weight *= step[c] == 1 ? fade[c] : 1 - fade[c];
        const Eigen::Vector3i corner = cell.cast<int>() + step;
        sum += weight * lattice_gradient(seed, corner).dot(within - step.cast<double>());
    }
    // In the middle of a cell every corner is √3/2 away: no sum is greater.
    return sum / (0.5 * std::sqrt(3.0));
}

}  // namespace unravel::sim
