#include "sim/forces/air.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr double unbounded = std::numeric_limits<double>::infinity();
// Share of the air's own speed to which a step may bring a cell by a force that it takes for constant.
constexpr double most_of_air_speed = 0.5;

// Where a cell is to the air.
struct CellInWind {
    double area = 0;   // m²; 0: no other member is set
    Vec3 n, relative;  // unit normal; r = w − v of its middle [m/s]
    double along = 0;  // r·n

    CellInWind(const std::array<std::uint32_t, 4>& corners, const Vec3& w, std::span<const Vec3> x,
               std::span<const Vec3> v) {
        const auto [p, q, r, s] = corners;
        const Vec3 area_vector = 0.5 * (x[r] - x[p]).cross(x[s] - x[q]);
        area = area_vector.norm();
        if (area == 0) return;
        n = area_vector / area;
        relative = w - (r == s ? Vec3((v[p] + v[q] + v[r]) / 3) : Vec3(0.25 * (v[p] + v[q] + v[r] + v[s])));
        along = n.dot(relative);
    }
    // The lightest corner decides how much a cell bears: it takes a quarter of it from each of up to four
    // cells; of triangles a third from each of up to six.
    static double lightest(const std::array<std::uint32_t, 4>& corners, std::span<const double> mass) {
        const auto [p, q, r, s] = corners;
        return (r == s ? 0.5 : 1.0) * std::min({mass[p], mass[q], mass[r], mass[s]});
    }
};

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
        force[c].setZero();
        const CellInWind cell(air.corners[c], w, x, v);
        if (cell.area == 0) return;
        const AirPush push = air_push(wind, cell.area, cell.along, cell.relative.norm(),
                                      cell.lightest(air.corners[c], mass) / h);
        force[c] = push.drag * cell.along * cell.n + push.lift * (cell.relative - cell.along * cell.n);
    });
}

bool acts(const Wind& wind) {
    return wind.density > 0 && (wind.drag > 0 || wind.lift > 0);
}

std::uint32_t held_back(const AirCells& air, const Wind& wind, double t, double h,
                        std::span<const double> mass, std::span<const Vec3> x, std::span<const Vec3> v) {
    const Vec3 w = wind_velocity(wind, t);
    std::uint32_t count = 0;
    for (const std::array<std::uint32_t, 4>& corners : air.corners) {
        const CellInWind cell(corners, w, x, v);
        if (cell.area == 0) continue;
        const AirPush whole = air_push(wind, cell.area, cell.along, cell.relative.norm(), unbounded);
        count += std::max(whole.drag, whole.lift) > cell.lightest(corners, mass) / h;
    }
    return count;
}

void find_stiff_air(const AirCells& air, const Wind& wind, double t, double h, std::span<const double> mass,
                    std::span<const Vec3> x, std::span<const Vec3> v, StiffAir& out) {
    out.cells.clear();
    out.start.clear();
    const Vec3 w = wind_velocity(wind, t);
    const auto find = [&](std::size_t first, std::size_t last, StiffAir& found) {
        for (std::size_t c = first; c < last; ++c) {
            const std::array<std::uint32_t, 4>& corners = air.corners[c];
            const CellInWind cell(corners, w, x, v);
            if (cell.area == 0) continue;
            const AirPush push = air_push(wind, cell.area, cell.along, cell.relative.norm(), unbounded);
            const double bears = most_of_air_speed * cell.lightest(corners, mass) / h;
            if (std::max(push.drag, push.lift) <= bears) continue;
            Stencil stencil;
            stencil.count = static_cast<std::uint32_t>(corner_count(corners));
            stencil.p = corners;
            stencil.w.fill(1.0 / stencil.count);
            stencil.u = cell.n;
            stencil.damping_along = push.drag;
            stencil.damping_across = push.lift;
            found.cells.push_back(stencil);
            found.start.push_back(w - cell.relative);
        }
    };
    std::vector<StiffAir> found(chunk_count(air.corners.size()));
    parallel_chunks(air.corners.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
        find(first, last, found[chunk]);
    });
    for (const StiffAir& part : found) {
        out.cells.insert(out.cells.end(), part.cells.begin(), part.cells.end());
        out.start.insert(out.start.end(), part.start.begin(), part.start.end());
    }
}

void answer_stiff_air(std::span<const Vec3> v, StiffAir& stiff) {
    stiff.answer.resize(stiff.cells.size());
    for (std::size_t s = 0; s < stiff.cells.size(); ++s) {
        const Stencil& cell = stiff.cells[s];
        Vec3 change = -stiff.start[s];
        for (std::uint32_t k = 0; k < cell.count; ++k) change += cell.w[k] * v[cell.p[k]];
        const Vec3 along = cell.u.dot(change) * cell.u;
        stiff.answer[s] = -(cell.damping_along * along + cell.damping_across * (change - along));
    }
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
