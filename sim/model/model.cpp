#include "sim/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/placement.hpp"
#include "sim/model/mesh_links.hpp"
#include "sim/model/mesh_springs.hpp"

namespace unravel::sim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// One cloth's grid with its metrics; a and b are the edge lengths of a cell. A mesh is a row of particles
// here, and its springs come from sim/mesh.
struct Grid {
    const Cloth& cloth;
    ClothPatch patch;
    double a, b;

    Grid(const Cloth& c, std::uint32_t first) : cloth(c) {
        patch = {c.name, first, c.particles, c.size, c.wrap == Wrap::tube, c.geometry};
        a = patch.cells_u() > 0 ? c.size[0] / patch.cells_u() : c.size[0];
        b = patch.cells_v() > 0 ? c.size[1] / patch.cells_v() : c.size[1];
    }
    int nu() const { return patch.particles[0]; }
    int nv() const { return patch.particles[1]; }
    // Width of the strip that column i (row j) stands for: half a cell at an open end.
    double width_u(int i) const {
        return nu() == 1 ? a : patch.tube || (i > 0 && i + 1 < nu()) ? a : 0.5 * a;
    }
    double width_v(int j) const { return nv() == 1 ? b : j > 0 && j + 1 < nv() ? b : 0.5 * b; }
    // Place on the cloth's own square; halves stand for the middles of springs.
    Vec2 uv(double i, double j) const {
        return {patch.cells_u() > 0 ? i / patch.cells_u() : 0.5,
                patch.cells_v() > 0 ? j / patch.cells_v() : 0.5};
    }
};

bool inside(const UvBox& box, const Vec2& uv) {
    return uv.x() >= box.low.x() && uv.x() <= box.high.x() && uv.y() >= box.low.y() && uv.y() <= box.high.y();
}

// The last region that holds a place decides.
const Material& material_at(const Cloth& cloth, const Vec2& uv) {
    const Material* found = &cloth.material;
    for (const Region& region : cloth.regions) {
        if (region.material && inside(region.box, uv)) found = &*region.material;
    }
    return *found;
}

double density_at(const Cloth& cloth, const Vec2& uv) {
    double found = cloth.density;
    for (const Region& region : cloth.regions) {
        if (region.density && inside(region.box, uv)) found = *region.density;
    }
    return found;
}

// Adds a direction's springs, row by row: add(i, j, p, q) for each, p and q its ends as the grid has them.
template <typename F>
SpringRows add_rows(const Grid& g, std::size_t first, std::array<int, 2> count, std::array<int, 2> from,
                    std::array<int, 2> to, const F& add) {
    SpringRows rows;
    rows.first = static_cast<std::uint32_t>(first);
    if (count[0] <= 0 || count[1] <= 0) return rows;
    for (int j = 0; j < count[1]; ++j) {
        for (int i = 0; i < count[0]; ++i)
            add(i, j, g.patch.at(i + from[0], j + from[1]), g.patch.at(i + to[0], j + to[1]));
    }
    rows.per_row = static_cast<std::uint32_t>(count[0]);
    rows.rows = static_cast<std::uint32_t>(count[1]);
    for (const std::size_t axis : {0u, 1u}) {
        rows.from[axis] = static_cast<std::uint32_t>(from[axis]);
        rows.to[axis] = static_cast<std::uint32_t>(to[axis]);
    }
    return rows;
}

void add_stretch(const Grid& g, ExtensionSprings& springs, GridSprings& grid) {
    const auto along = [&](int axis) {
        return [&, axis](int i, int j, std::uint32_t p, std::uint32_t q) {
            const Material& m = material_at(g.cloth, axis == 0 ? g.uv(i + 0.5, j) : g.uv(i, j + 0.5));
            const double rest = axis == 0 ? g.a : g.b;
            const double shape = (axis == 0 ? g.width_v(j) : g.width_u(i)) / rest;
            const auto k = static_cast<std::size_t>(axis);
            springs.add(p, q, rest, m.stretch[k] * shape, m.stretch_damping[k] * shape);
        };
    };
    grid.u = add_rows(g, springs.size(), {g.patch.cells_u(), g.nv()}, {0, 0}, {1, 0}, along(0));
    grid.v = add_rows(g, springs.size(), {g.nu(), g.patch.cells_v()}, {0, 0}, {0, 1}, along(1));
}

bool resists_shear(const Material& m) {
    return m.shear > 0 || m.shear_damping > 0;
}

void add_shear(const Grid& g, ExtensionSprings& springs, GridSprings& grid) {
    if (!resists_shear(g.cloth.material) &&
        std::none_of(g.cloth.regions.begin(), g.cloth.regions.end(),
                     [](const Region& region) { return region.material && resists_shear(*region.material); }))
        return;
    const double diagonal = std::hypot(g.a, g.b), shape = diagonal * diagonal / (g.a * g.b);
    const std::array<int, 2> cells{g.patch.cells_u(), g.patch.cells_v()};
    const auto across = [&](int i, int j, std::uint32_t p, std::uint32_t q) {
        const Material& m = material_at(g.cloth, g.uv(i + 0.5, j + 0.5));
        springs.add(p, q, diagonal, m.shear * shape, m.shear_damping * shape);
    };
    grid.diagonal = add_rows(g, springs.size(), cells, {0, 0}, {1, 1}, across);
    grid.anti = add_rows(g, springs.size(), cells, {1, 0}, {0, 1}, across);
}

void add_bends(const Grid& g, BendSprings& bends, GridSprings& grid) {
    const auto bends_at_all = [](const Region& region) {
        return region.material && region.material->bend > 0;
    };
    if (g.cloth.material.bend <= 0 &&
        std::none_of(g.cloth.regions.begin(), g.cloth.regions.end(), bends_at_all))
        return;
    const double diagonal = std::hypot(g.a, g.b), across = g.a * g.b / diagonal;
    // A tube of three or four columns has its next-nearest neighbours already among its nearest.
    const int last_u = g.patch.tube ? (g.nu() > 4 ? g.nu() : 0) : g.nu() - 2, last_v = g.nv() - 2;
    const auto of = [&](double rest, const auto& width) {
        return [&, rest, width](int i, int j, std::uint32_t p, std::uint32_t q) {
            const Material& m = material_at(g.cloth, g.uv(i, j));
            bends.add(p, q, rest, m.bend * width(i, j) / 3.0, m.buckling_strain);
        };
    };
    const auto wide = [&](int, int) { return across; };
    grid.bend_u = add_rows(g, bends.size(), {last_u, g.nv()}, {0, 0}, {2, 0},
                           of(2 * g.a, [&](int, int j) { return g.width_v(j); }));
    grid.bend_v = add_rows(g, bends.size(), {g.nu(), last_v}, {0, 0}, {0, 2},
                           of(2 * g.b, [&](int i, int) { return g.width_u(i); }));
    grid.bend_diagonal = add_rows(g, bends.size(), {last_u, last_v}, {0, 0}, {2, 2}, of(2 * diagonal, wide));
    grid.bend_anti = add_rows(g, bends.size(), {last_u, last_v}, {2, 0}, {0, 2}, of(2 * diagonal, wide));
}

void place(const Grid& g, Placement& placement) {
    const Cloth& cloth = g.cloth;
    for (int j = 0; j < g.nv(); ++j) {
        for (int i = 0; i < g.nu(); ++i) {
            placement.x.push_back(started_particle(cloth, i, j));
            placement.v.push_back(cloth.velocity);
        }
    }
}

void add_pins(const Grid& g, const Placement& placement, std::vector<PinnedGroup>& groups) {
    for (const Pin& pin : g.cloth.pins) {
        PinnedGroup group;
        for (const std::size_t index : pinned_particles(g.cloth, pin)) {
            group.particles.push_back(g.patch.first + static_cast<std::uint32_t>(index));
            group.start.push_back(placement.x[group.particles.back()]);
            group.centre += group.start.back();
        }
        if (group.particles.empty()) continue;
        group.centre /= static_cast<double>(group.particles.size());
        group.motion = pin.motion;
        group.release = pin.release.value_or(infinity);
        groups.push_back(std::move(group));
    }
}

// What the scene leaves open: near enough that no particle slips between two others, as stiff as the stiffest
// cloth, and damped to a fifth of critical.
SelfCollision fitting(SelfCollision settings, std::span<const Grid> grids, const ClothModel& model) {
    double spacing = infinity;
    for (const Grid& g : grids)
        spacing = g.patch.grid() ? std::min({spacing, g.a, g.b})
                                 : std::min(spacing, typical_spacing(*g.patch.mesh));
    if (settings.thickness == 0) settings.thickness = 0.75 * spacing;
    const ExtensionSprings& springs = model.springs;
    if (settings.stiffness == 0 && springs.stretch_count > 0) {
        settings.stiffness =
            std::ranges::max(springs.stiffness.values() | std::views::take(springs.stretch_count));
    }
    if (settings.damping == 0) {
        const double lightest = *std::min_element(model.mass.begin(), model.mass.end());
        settings.damping = 0.2 * 2.0 * std::sqrt(settings.stiffness * lightest);
    }
    return settings;
}

}  // namespace

AirCells air_cells(const ClothModel& model) {
    AirCells air;
    for (const ClothPatch& patch : model.cloths) {
        if (!patch.grid()) add_mesh_air(*patch.mesh, patch.first, air);
        for (int j = 0; patch.grid() && j < patch.cells_v(); ++j) {
            for (int i = 0; i < patch.cells_u(); ++i)
                air.corners.push_back(
                    {patch.at(i, j), patch.at(i, j + 1), patch.at(i + 1, j + 1), patch.at(i + 1, j)});
        }
    }
    connect_cells(model.size(), air);
    return air;
}

ClothModel build_model(const Scene& scene, Placement& placement) {
    ClothModel model;
    model.gravity = scene.gravity;
    model.solids = scene.solids;
    placement = {};
    std::vector<Grid> grids;
    std::uint32_t first = 0;
    for (const Cloth& cloth : scene.cloths) {
        grids.emplace_back(cloth, first);
        first += grids.back().patch.count();
    }
    for (const Grid& g : grids) {
        model.cloths.push_back(g.patch);
        if (!g.patch.grid()) {
            const std::vector<double> mass = mesh_masses(g.cloth);
            model.mass.insert(model.mass.end(), mass.begin(), mass.end());
            add_mesh_stretch(g.cloth, g.patch.first, model.springs);
            continue;
        }
        for (int j = 0; j < g.nv(); ++j) {
            for (int i = 0; i < g.nu(); ++i) {
                model.mass.push_back(density_at(g.cloth, g.uv(i, j)) * g.width_u(i) * g.width_v(j));
            }
        }
        GridSprings& springs = model.grids.emplace_back();
        springs.particle = g.patch.first;
        springs.nu = static_cast<std::uint32_t>(g.nu());
        springs.nv = static_cast<std::uint32_t>(g.nv());
        springs.tube = g.patch.tube;
        add_stretch(g, model.springs, springs);
    }
    model.springs.stretch_count = model.springs.size();
    // A cloth that is a grid also keeps its springs by direction; `model.grids` has one entry for each of
    // those.
    for (std::size_t c = 0, grid = 0; c < grids.size(); ++c) {
        const Grid& g = grids[c];
        g.patch.grid() ? add_shear(g, model.springs, model.grids[grid++])
                       : add_mesh_shear(g.cloth, g.patch.first, model.springs);
    }
    for (std::size_t c = 0, grid = 0; c < grids.size(); ++c) {
        const Grid& g = grids[c];
        g.patch.grid() ? add_bends(g, model.bends, model.grids[grid++])
                       : add_mesh_bends(g.cloth, g.patch.first, model.bends);
    }
    for (const Grid& g : grids) place(g, placement);
    for (const Grid& g : grids) add_pins(g, placement, model.pins);
    for (const Grid& g : grids) {
        if (!g.patch.grid()) add_stitches(g.cloth, g.patch, placement, model);
    }
    model.wind = scene.wind;
    if (scene.self_collision) {
        model.self_collision = fitting(*scene.self_collision, grids, model);
        find_mesh_neighbours(model);
    }
    model.spring_adjacency = !model.grids.empty() && model.grids.size() == model.cloths.size()
                                 ? adjacency_of(model.grids)
                                 : adjacency_of(model.size(), model.springs.i, model.springs.j);
    return model;
}

}  // namespace unravel::sim
