#include "sim/self_collision/self_collision.hpp"

#include <algorithm>
#include <cmath>

namespace unravel::sim {

namespace {

// Pairs are searched out to this many thicknesses, so that the list lasts until something has moved half the
// excess.
constexpr double search_share = 1.5;

struct Voxel {
    std::int64_t x, y, z;
};

Voxel voxel_at(const Vec3& x, double edge) {
    return {static_cast<std::int64_t>(std::floor(x.x() / edge)),
            static_cast<std::int64_t>(std::floor(x.y() / edge)),
            static_cast<std::int64_t>(std::floor(x.z() / edge))};
}

// Slot of a voxel in a table; voxels that share a slot cost a distance test, nothing else.
std::uint32_t slot_of(const Voxel& v, std::uint32_t mask) {
    const auto mixed = static_cast<std::uint64_t>(v.x) * 73856093u ^
                       static_cast<std::uint64_t>(v.y) * 19349663u ^
                       static_cast<std::uint64_t>(v.z) * 83492791u;
    return static_cast<std::uint32_t>(mixed ^ (mixed >> 32)) & mask;
}

// Counting sort of the particles by slot.
void fill_voxels(std::span<const Vec3> x, double edge, std::uint32_t mask, SelfCollisionWorkspace& ws) {
    ws.voxel_start.assign(mask + 2u, 0);
    ws.voxel_particles.resize(x.size());
    ws.voxel_of.resize(x.size());
    parallel_each(x.size(), [&](std::size_t p) { ws.voxel_of[p] = slot_of(voxel_at(x[p], edge), mask); });
    for (const std::uint32_t slot : ws.voxel_of) ++ws.voxel_start[slot + 1];
    for (std::uint32_t slot = 0; slot <= mask; ++slot) ws.voxel_start[slot + 1] += ws.voxel_start[slot];
    for (std::uint32_t p = 0; p < x.size(); ++p) ws.voxel_particles[ws.voxel_start[ws.voxel_of[p]]++] = p;
    for (std::uint32_t slot = mask; slot > 0; --slot) ws.voxel_start[slot] = ws.voxel_start[slot - 1];
    ws.voxel_start[0] = 0;
}

// Partners of p with a higher number, sorted.
void partners_of(const ClothModel& model, std::span<const Vec3> x, double radius, std::uint32_t mask,
                 std::uint32_t p, const SelfCollisionWorkspace& ws, std::vector<std::uint32_t>& partners) {
    partners.clear();
    const Voxel home = voxel_at(x[p], radius);
    for (std::int64_t dz = -1; dz <= 1; ++dz) {
        for (std::int64_t dy = -1; dy <= 1; ++dy) {
            for (std::int64_t dx = -1; dx <= 1; ++dx) {
                const std::uint32_t slot = slot_of({home.x + dx, home.y + dy, home.z + dz}, mask);
                for (std::uint32_t k = ws.voxel_start[slot]; k < ws.voxel_start[slot + 1]; ++k) {
                    const std::uint32_t q = ws.voxel_particles[k];
                    if (q <= p || (x[q] - x[p]).squaredNorm() > radius * radius) continue;
                    if (!are_neighbours(model, p, q)) partners.push_back(q);
                }
            }
        }
    }
    // Two of the 27 voxels may share a slot.
    std::sort(partners.begin(), partners.end());
    partners.erase(std::unique(partners.begin(), partners.end()), partners.end());
}

void search(const ClothModel& model, std::span<const Vec3> x, double radius, SelfCollisionWorkspace& ws) {
    std::uint32_t slots = 64;
    while (slots < 2 * x.size()) slots *= 2;
    const std::uint32_t mask = slots - 1;
    fill_voxels(x, radius, mask, ws);
    ws.found.resize(chunk_count(x.size()));
    parallel_chunks(x.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t>& found = ws.found[chunk];
        std::vector<std::uint32_t> partners;
        found.clear();
        for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p) {
            partners_of(model, x, radius, mask, p, ws, partners);
            for (const std::uint32_t q : partners) found.insert(found.end(), {p, q});
        }
    });
    ws.candidate_i.clear();
    ws.candidate_j.clear();
    for (const std::vector<std::uint32_t>& found : ws.found) {
        for (std::size_t k = 0; k < found.size(); k += 2) {
            ws.candidate_i.push_back(found[k]);
            ws.candidate_j.push_back(found[k + 1]);
        }
    }
    ws.x_searched.assign(x.begin(), x.end());
}

bool moved_too_far(std::span<const Vec3> x, std::span<const Vec3> before, double bound) {
    if (before.size() != x.size()) return true;
    for (std::size_t p = 0; p < x.size(); ++p) {
        if ((x[p] - before[p]).squaredNorm() > bound * bound) return true;
    }
    return false;
}

}  // namespace

bool are_neighbours(const ClothModel& model, std::uint32_t p, std::uint32_t q) {
    for (const ClothPatch& patch : model.cloths) {
        if (p >= patch.first + patch.count()) continue;
        if (!patch.grid()) {
            const auto begin = model.neighbours.list.begin();
            return std::binary_search(begin + model.neighbours.start[p],
                                      begin + model.neighbours.start[p + 1], q);
        }
        if (p < patch.first || q < patch.first || q >= patch.first + patch.count()) return false;
        const int nu = patch.particles[0], a = static_cast<int>(p - patch.first),
                  b = static_cast<int>(q - patch.first);
        int du = std::abs(a % nu - b % nu);
        if (patch.tube) du = std::min(du, nu - du);
        const int dv = std::abs(a / nu - b / nu);
        if (du <= 2 && dv <= 2) return true;
        const double flat = std::hypot(du * patch.size[0] / std::max(patch.cells_u(), 1),
                                       dv * patch.size[1] / std::max(patch.cells_v(), 1));
        return flat <= model.self_collision->thickness;
    }
    return false;
}

void self_collide(const ClothModel& model, std::span<const Vec3> x, std::span<const Vec3> v, double h,
                  double threshold, SelfCollisionWorkspace& ws) {
    const SelfCollision& settings = *model.self_collision;
    const double radius = search_share * settings.thickness;
    if (moved_too_far(x, ws.x_searched, 0.5 * (radius - settings.thickness))) search(model, x, radius, ws);

    ExtensionSprings& springs = ws.springs;
    springs.i.clear();
    springs.j.clear();
    ws.least_distance = settings.thickness;
    for (std::size_t k = 0; k < ws.candidate_i.size(); ++k) {
        const double distance = (x[ws.candidate_j[k]] - x[ws.candidate_i[k]]).norm();
        ws.least_distance = std::min(ws.least_distance, distance);
        if (distance >= settings.thickness) continue;
        springs.i.push_back(ws.candidate_i[k]);
        springs.j.push_back(ws.candidate_j[k]);
    }
    const auto fill = [&](Coefficients& values, double value) { values.own().assign(springs.size(), value); };
    fill(springs.rest, settings.thickness);
    fill(springs.stiffness, settings.stiffness);
    fill(springs.damping, settings.damping);
    ws.forces.resize(springs.size());
    parallel_each(springs.size(), [&](std::size_t s) {
        const std::uint32_t i = springs.i[s], j = springs.j[s];
        const Vec3 d = x[j] - x[i];
        const double length = d.norm();
        // Coincident particles part along a fixed axis rather than not at all.
        const Vec3 u = length > 0 ? Vec3(d / length) : Vec3::UnitY();
        // Damping may add to the push and take from it, but contact never pulls.
        const double push =
            spring_pull(settings.stiffness, length - settings.thickness, settings.damping, u.dot(v[j] - v[i]))
                .sum();
        const bool bears = is_explicit(
            kappa_between(h, model.mass[i], model.mass[j], settings.stiffness, settings.damping), threshold);
        ws.forces.force[s] = std::min(push, 0.0) * u;
        ws.forces.direction[s] = u;
        ws.forces.transverse[s] = 0;
        ws.forces.state[s] = bears ? SpringState::explicit_ : SpringState::implicit;
    });
    ws.adjacency = adjacency_of(x.size(), springs.i, springs.j);
}

}  // namespace unravel::sim
