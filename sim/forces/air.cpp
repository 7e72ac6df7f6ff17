#include "sim/forces/air.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/forces/air_law.hpp"
#include "sim/scene/random.hpp"

namespace unravel::sim {

namespace {

// Smooth noise of unit variance: random values at whole periods, cubic in between.
double gust_noise(const Gust& gust, double t) {
    const double position = t / gust.period, cell = std::floor(position), s = position - cell;
    // A uniform value in [−1, 1) has variance 1/3; interpolation between two of them halves it on average.
    const double scale = std::sqrt(3.0) * std::sqrt(35.0 / 26.0);
    const auto value = [&](double k) { return seeded_uniform(gust.seed, static_cast<std::uint64_t>(k)); };
    const double ease = s * s * (3 - 2 * s);
    return scale * ((1 - ease) * value(cell) + ease * value(cell + 1));
}

}  // namespace

void connect_cells(std::size_t particles, AirCells& air) {
    air.start.assign(particles + 1, 0);
    for (const auto& corners : air.corners) {
        for (std::size_t k = 0; k < corner_count(corners); ++k) ++air.start[corners[k] + 1];
    }
    for (std::size_t p = 0; p < particles; ++p) air.start[p + 1] += air.start[p];
    air.cells.resize(4 * air.corners.size());
    std::vector<std::uint32_t> next(air.start.begin(), air.start.end() - 1);
    for (std::uint32_t c = 0; c < air.corners.size(); ++c) {
        const auto& corners = air.corners[c];
        for (std::size_t k = 0; k < corner_count(corners); ++k) air.cells[next[corners[k]]++] = c;
    }
}

Vec3 wind_velocity(const Wind& wind, double t) {
    Vec3 velocity = wind.velocity;
    const std::vector<WindKey>& keys = wind.keyframes;
    if (!keys.empty()) {
        const auto next = std::upper_bound(keys.begin(), keys.end(), t,
                                           [](double time, const WindKey& key) { return time < key.time; });
        if (next == keys.begin()) {
            velocity = keys.front().velocity;
        } else if (next == keys.end()) {
            velocity = keys.back().velocity;
        } else {
            const WindKey &a = *std::prev(next), &b = *next;
            velocity = a.velocity + (t - a.time) / (b.time - a.time) * (b.velocity - a.velocity);
        }
    }
    if (wind.gust) velocity *= 1.0 + wind.gust->strength * gust_noise(*wind.gust, t);
    return velocity;
}

void air_forces(const AirCells& air, const Wind& wind, double t, double h, std::span<const double> mass,
                std::span<const Vec3> x, std::span<const Vec3> v, std::span<Vec3> force) {
    const Vec3 w = wind_velocity(wind, t);
    parallel_each(air.corners.size(), [&](std::size_t c) {
        const auto [p, q, r, s] = air.corners[c];
        const Vec3 area_vector = 0.5 * (x[r] - x[p]).cross(x[s] - x[q]);
        const double area = area_vector.norm();
        force[c].setZero();
        if (area == 0) return;
        const Vec3 n = area_vector / area;
        const bool triangle = r == s;
        const Vec3 relative =
            w - (triangle ? Vec3((v[p] + v[q] + v[r]) / 3) : Vec3(0.25 * (v[p] + v[q] + v[r] + v[s])));
        const double along = n.dot(relative);
        // The lightest corner decides how much a cell bears: it takes a quarter of it from each of up to four
        // cells; of triangles a third from each of up to six.
        const double bound = (triangle ? 0.5 : 1.0) * std::min({mass[p], mass[q], mass[r], mass[s]}) / h;
        const AirPush push = air_push(wind, area, along, relative.norm(), bound);
        force[c] = push.drag * along * n + push.lift * (relative - along * n);
    });
}

void add_air(const AirCells& air, std::span<const Vec3> of_cell, std::span<Vec3> force) {
    parallel_each(force.size(), [&](std::size_t p) {
        for (std::uint32_t k = air.start[p]; k < air.start[p + 1]; ++k) {
            const std::uint32_t c = air.cells[k];
            force[p] += (corner_count(air.corners[c]) == 3 ? 1.0 / 3 : 0.25) * of_cell[c];
        }
    });
}

}  // namespace unravel::sim
