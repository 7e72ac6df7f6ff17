#include "sim/self_collision/self_collision.hpp"

#include <algorithm>
#include <cmath>

namespace unravel::sim {

namespace {

// Pairs are searched out to between so many thicknesses, so that the list lasts for a while: far where that
// finds few, near where it finds many. How far decides what a step costs, never which pairs are nearer than
// the thickness.
constexpr double least_search = 1.5, search_growth = 1.5;
// Groups of particles for the root of their number: their pairs then cost as much as the particles do.
constexpr double groups_per_root = 2;
// Pairs for each particle that are many, and few.
constexpr double many_pairs = 1, few_pairs = 0.25;

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

// A pair of particles as one number, i before j, that sorts as they do.
std::uint64_t pair_of(std::uint32_t p, std::uint32_t q) {
    return std::uint64_t{std::min(p, q)} << 32 | std::max(p, q);
}

// Pairs of p with particles of its own voxel, and of those of the 26 round it that come after it: from each
// two voxels once.
void add_pairs_of(const ClothModel& model, std::span<const Vec3> x, double radius, std::uint32_t mask,
                  std::uint32_t p, const SelfCollisionWorkspace& ws, std::vector<std::uint64_t>& pairs) {
    const auto add = [&](std::uint32_t slot, std::uint32_t after) {
        for (std::uint32_t k = ws.voxel_start[slot]; k < ws.voxel_start[slot + 1]; ++k) {
            const std::uint32_t q = ws.voxel_particles[k];
            if (q < after || q == p || (x[q] - x[p]).squaredNorm() > radius * radius) continue;
            if (!are_neighbours(model, std::min(p, q), std::max(p, q))) pairs.push_back(pair_of(p, q));
        }
    };
    const Voxel home = voxel_at(x[p], radius);
    add(ws.voxel_of[p], p);
    constexpr int after_home = 14;  // of the 27
    for (int k = after_home; k < 27; ++k)
        add(slot_of({home.x + k % 3 - 1, home.y + k / 3 % 3 - 1, home.z + k / 9 - 1}, mask), 0);
}

void search(const ClothModel& model, std::span<const Vec3> x, double radius, SelfCollisionWorkspace& ws) {
    std::uint32_t slots = 64;
    while (slots < 2 * x.size()) slots *= 2;
    const std::uint32_t mask = slots - 1;
    fill_voxels(x, radius, mask, ws);
    ws.found.resize(chunk_count(x.size()));
    parallel_chunks(x.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        ws.found[chunk].clear();
        for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p)
            add_pairs_of(model, x, radius, mask, p, ws, ws.found[chunk]);
    });
    ws.pairs.clear();
    for (const std::vector<std::uint64_t>& found : ws.found)
        ws.pairs.insert(ws.pairs.end(), found.begin(), found.end());
    // Two of the voxels may share a slot.
    std::sort(ws.pairs.begin(), ws.pairs.end());
    ws.pairs.erase(std::unique(ws.pairs.begin(), ws.pairs.end()), ws.pairs.end());
    ws.x_searched.assign(x.begin(), x.end());
}

// Sorts the particles by boxes into groups, and notes the room between them: `radius` of those that were
// looked through for pairs, the gap between others.
void make_groups(std::span<const Vec3> x, double radius, double thickness, ParticleGroups& groups) {
    const double wanted = groups_per_root * std::sqrt(static_cast<double>(x.size()));
    // As large as of a flat sheet would make so many; afterwards as the last ones were too many or too few.
    if (groups.edge == 0) {
        groups.edge = 1.5 * thickness * std::sqrt(static_cast<double>(x.size()) / wanted);
    } else if (static_cast<double>(groups.size()) > 1.5 * wanted) {
        groups.edge *= 1.25;
    } else if (static_cast<double>(groups.size()) < wanted / 1.5) {
        groups.edge /= 1.25;
    }
    groups.key.resize(x.size());
    parallel_each(x.size(), [&](std::size_t p) {
        const Voxel v = voxel_at(x[p], groups.edge);
        constexpr std::uint64_t bits = (std::uint64_t{1} << 21) - 1;
        const auto part = [&](std::int64_t c) { return static_cast<std::uint64_t>(c) & bits; };
        groups.key[p] = {part(v.x) << 42 | part(v.y) << 21 | part(v.z), static_cast<std::uint32_t>(p)};
    });
    std::sort(groups.key.begin(), groups.key.end());
    groups.start.clear();
    groups.low.clear();
    groups.high.clear();
    for (std::uint32_t k = 0; k < groups.key.size(); ++k) {
        const Vec3& at = x[groups.key[k].second];
        if (k == 0 || groups.key[k].first != groups.key[k - 1].first) {
            groups.start.push_back(k);
            groups.low.push_back(at);
            groups.high.push_back(at);
        }
        groups.low.back() = groups.low.back().cwiseMin(at);
        groups.high.back() = groups.high.back().cwiseMax(at);
    }
    groups.start.push_back(static_cast<std::uint32_t>(groups.key.size()));
    groups.room.clear();
    for (std::size_t a = 0; a < groups.size(); ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
            const Vec3 gap = (groups.low[a] - groups.high[b]).cwiseMax(groups.low[b] - groups.high[a]);
            groups.room.push_back(std::max(radius, gap.cwiseMax(0.0).norm()) - thickness);
        }
    }
}

// Whether two particles that are no known pair may have come within the thickness: what groups have moved in
// common brings none together.
bool may_be_missing(std::span<const Vec3> x, std::span<const Vec3> before, ParticleGroups& groups) {
    if (before.size() != x.size()) return true;
    groups.way.assign(groups.size(), Vec3::Zero());
    groups.spread.assign(groups.size(), 0.0);
    parallel_each(groups.size(), [&](std::size_t g) {
        const auto each = [&](const auto& f) {
            for (std::uint32_t k = groups.start[g]; k < groups.start[g + 1]; ++k) {
                const std::uint32_t p = groups.key[k].second;
                f(Vec3(x[p] - before[p]));
            }
        };
        Vec3& way = groups.way[g];
        each([&](const Vec3& d) { way += d; });
        way /= groups.start[g + 1] - groups.start[g];
        double farthest = 0;
        each([&](const Vec3& d) { farthest = std::max(farthest, (d - way).squaredNorm()); });
        groups.spread[g] = std::sqrt(farthest);
    });
    const double* room = groups.room.data();
    for (std::size_t a = 0; a < groups.size(); ++a) {
        for (std::size_t b = 0; b <= a; ++b, ++room) {
            const double nearer =
                (groups.way[a] - groups.way[b]).norm() + groups.spread[a] + groups.spread[b];
            if (nearer > *room) return true;
        }
    }
    return false;
}

// Looks for pairs where those known may not be all, as far as was worth while the last time.
void keep_pairs(const ClothModel& model, std::span<const Vec3> x, SelfCollisionWorkspace& ws) {
    const double thickness = model.self_collision->thickness;
    if (!may_be_missing(x, ws.x_searched, ws.groups)) return;
    const double particles = static_cast<double>(x.size());
    if (static_cast<double>(ws.pairs.size()) > many_pairs * particles) {
        // Most are of cloth that lies flat, or will go on to lie as it lies: never so far again.
        ws.searched = ws.farthest = std::max(least_search, ws.searched / search_growth);
    } else if (static_cast<double>(ws.pairs.size()) < few_pairs * particles) {
        ws.searched = std::min(ws.farthest, ws.searched * search_growth);
    }
    search(model, x, ws.searched * thickness, ws);
    make_groups(x, ws.searched * thickness, thickness, ws.groups);
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
    keep_pairs(model, x, ws);

    ExtensionSprings& springs = ws.springs;
    springs.i.clear();
    springs.j.clear();
    ws.least_distance = settings.thickness;
    for (const std::uint64_t pair : ws.pairs) {
        const auto i = static_cast<std::uint32_t>(pair >> 32), j = static_cast<std::uint32_t>(pair);
        const double distance = (x[j] - x[i]).norm();
        ws.least_distance = std::min(ws.least_distance, distance);
        if (distance >= settings.thickness) continue;
        springs.i.push_back(i);
        springs.j.push_back(j);
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
    // Of none it is what it was of none before.
    if (springs.size() > 0 || !ws.adjacency.entries.empty() || ws.adjacency.start.size() != x.size() + 1)
        ws.adjacency = adjacency_of(x.size(), springs.i, springs.j);
}

}  // namespace unravel::sim
