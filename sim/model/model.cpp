#include "sim/model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/placement.hpp"
#include "sim/model/contact_model.hpp"
#include "sim/model/mesh_links.hpp"
#include "sim/model/mesh_springs.hpp"
#include "sim/model/moduli.hpp"
#include "sim/model/pins.hpp"
#include "sim/model/reach.hpp"

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

// The share of a cell's shear modulus that its diagonals have.
double shear_share(const Grid& g, int i, int j) {
    const double along = g.a / g.b;
    return diagonals_share(material_at(g.cloth, g.uv(i + 0.5, j + 0.5)), along * along);
}

void add_stretch(const Grid& g, ExtensionSprings& springs, GridSprings& grid) {
    const auto along = [&](int axis) {
        return [&, axis](int i, int j, std::uint32_t p, std::uint32_t q) {
            const Material& m = material_at(g.cloth, axis == 0 ? g.uv(i + 0.5, j) : g.uv(i, j + 0.5));
            const double rest = axis == 0 ? g.a : g.b;
            const double shape = (axis == 0 ? g.width_v(j) : g.width_u(i)) / rest;
            const auto k = static_cast<std::size_t>(axis);
            // What the diagonals of the cells on both sides resist already is not the threads' to resist.
            double stiffness = m.stretch[k] * shape, damping = m.stretch_damping[k] * shape;
            const double least = threads_share * stiffness;
            for (const int side : {-1, 0}) {
                const int u = axis == 0 ? i : i + side, v = axis == 0 ? j + side : j;
                if ((u < 0 && !g.patch.tube) || v < 0 || u >= g.patch.cells_u() || v >= g.patch.cells_v())
                    continue;
                const int cell = u < 0 ? g.patch.cells_u() - 1 : u;
                const Material& beside = material_at(g.cloth, g.uv(cell + 0.5, v + 0.5));
                const double share = shear_share(g, cell, v) * (axis == 0 ? g.a / g.b : g.b / g.a);
                stiffness -= share * beside.shear;
                damping -= share * beside.shear_damping;
            }
            springs.add(p, q, rest, std::max(stiffness, least), std::max(damping, 0.0));
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
        const double share = shear_share(g, i, j) * shape;
        springs.add(p, q, diagonal, m.shear * share, m.shear_damping * share);
    };
    grid.diagonal = add_rows(g, springs.size(), cells, {0, 0}, {1, 1}, across);
    grid.anti = add_rows(g, springs.size(), cells, {1, 0}, {0, 1}, across);
}

// Tells of a cloth whose diagonals have less than its shear modulus.
void note_shear(const Grid& g, std::vector<std::string>& notes) {
    double least = 1;
    for (int j = 0; j < g.patch.cells_v(); ++j) {
        for (int i = 0; i < g.patch.cells_u(); ++i) least = std::min(least, shear_share(g, i, j));
    }
    if (least < 1)
        notes.push_back(weak_shear_note(g.cloth, least, fmt::format("{:.3g} x {:.3g} m", g.a, g.b)));
}

// Curvature along both directions of threads and the twist of cells, and arcs between neighbours.
void add_curvature(const Grid& g, CurvatureStencils& stencils, BendSprings& bends, GridSprings& grid) {
    const auto bend_at = [&](double i, double j) { return material_at(g.cloth, g.uv(i, j)).bend; };
    const int last_u = g.patch.tube ? (g.nu() > 2 ? g.nu() : 0) : g.nu() - 2, last_v = g.nv() - 2;
    const std::array<int, 2> cells{g.patch.cells_u(), g.patch.cells_v()};
    const auto cube = [](double y) { return y * y * y; };
    const auto along = [&](int axis) {
        return [&, axis](int i, int j, std::uint32_t p, std::uint32_t q) {
            const int u = axis == 0 ? i + 1 : i, v = axis == 0 ? j : j + 1;
            const double c = axis == 0 ? g.width_v(v) / cube(g.a) : g.width_u(u) / cube(g.b);
            stencils.add(std::array{p, g.patch.at(u, v), q}, line_weights, bend_at(u, v) * c);
        };
    };
    const auto twist = [&](int i, int j, std::uint32_t p, std::uint32_t q) {
        stencils.add(std::array{p, g.patch.at(i + 1, j), q, g.patch.at(i, j + 1)}, twist_weights,
                     2.0 * bend_at(i + 0.5, j + 0.5) / (g.a * g.b));
    };
    const auto arc = [&](int axis) {
        return [&, axis](int i, int j, std::uint32_t p, std::uint32_t q) {
            const Vec2 middle = axis == 0 ? g.uv(i + 0.5, j) : g.uv(i, j + 0.5);
            const Material& m = material_at(g.cloth, middle);
            bends.add(p, q, axis == 0 ? g.a : g.b, m.bend * (axis == 0 ? g.width_v(j) : g.width_u(i)),
                      m.buckling_strain);
        };
    };
    grid.curve_u = add_rows(g, stencils.size(), {last_u, g.nv()}, {0, 0}, {2, 0}, along(0));
    grid.curve_v = add_rows(g, stencils.size(), {g.nu(), last_v}, {0, 0}, {0, 2}, along(1));
    grid.twist = add_rows(g, stencils.size(), cells, {0, 0}, {1, 1}, twist);
    grid.bend_u = add_rows(g, bends.size(), {cells[0], g.nv()}, {0, 0}, {1, 0}, arc(0));
    grid.bend_v = add_rows(g, bends.size(), {g.nu(), cells[1]}, {0, 0}, {0, 1}, arc(1));
}

void add_bends(const Grid& g, ClothModel& model, GridSprings& grid) {
    BendSprings& bends = model.bends;
    const auto bends_at_all = [](const Region& region) {
        return region.material && region.material->bend > 0;
    };
    if (g.cloth.material.bend <= 0 &&
        std::none_of(g.cloth.regions.begin(), g.cloth.regions.end(), bends_at_all))
        return;
    if (g.cloth.bend_model == BendModel::curvature) return add_curvature(g, model.curvature, bends, grid);
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

// A cell that a pin holds at both ends for good is rigid: of the cloth that a line of three stands for, half
// a cell on either side of its middle, only the other half bends.
void stiffen_clamped(ClothModel& model) {
    std::vector<std::uint32_t> holder(model.size(), 0);  // 1 + the pin's number, 0: free
    for (std::uint32_t g = 0; g < model.pins.size(); ++g) {
        if (std::isfinite(model.pins[g].release)) continue;
        for (const std::uint32_t p : model.pins[g].particles) holder[p] = g + 1;
    }
    CurvatureStencils& stencils = model.curvature;
    std::vector<double> stiffness(stencils.size());
    for (std::size_t s = 0; s < stencils.size(); ++s) {
        const auto& p = stencils.p[s];
        const std::uint32_t by = holder[p[1]];
        const bool line = stencils.w[1][s] == line_weights[1], before = holder[p[0]] == by;
        const bool behind = holder[p[2]] == by && (stencils.count(s) == 3 || holder[p[3]] == by);
        stiffness[s] = (line && by > 0 && before != behind ? 2.0 : 1.0) * stencils.stiffness[s];
    }
    stencils.stiffness.own() = std::move(stiffness);
    stencils.stiffness.code();
}

void place(const Grid& g, Placement& placement) {
    const Cloth& cloth = g.cloth;
    const StartPlaces places(cloth);
    for (int j = 0; j < g.nv(); ++j) {
        for (int i = 0; i < g.nu(); ++i) {
            placement.x.push_back(places.started(i, j));
            placement.v.push_back(cloth.velocity);
        }
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

bool ClothModel::solids_by_surfaces() const {
    return std::ranges::any_of(solids, &Solid::by_surfaces);
}

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
    model.begin = -scene.clip.settle;
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
    for (const Grid& g : grids) {
        if (g.patch.grid()) {
            note_shear(g, model.notes);
        } else {
            note_mesh_shear(g.cloth, model.notes);
        }
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
        if (g.patch.grid()) {
            add_bends(g, model, model.grids[grid++]);
        } else if (g.cloth.bend_model == BendModel::curvature) {
            add_mesh_curvature(g.cloth, g.patch.first, model.curvature);
            add_mesh_arcs(g.cloth, g.patch.first, model.bends);
        } else {
            add_mesh_bends(g.cloth, g.patch.first, model.bends);
        }
    }
    for (const Grid& g : grids) place(g, placement);
    for (const Grid& g : grids) add_pins(g.cloth, g.patch, model.begin, placement, model.pins);
    if (!model.pins.empty() && model.curvature.size() > 0) stiffen_clamped(model);
    for (const Grid& g : grids) {
        if (!g.patch.grid()) add_stitches(g.cloth, g.patch, placement, model);
    }
    if (scene.wind && acts(*scene.wind)) model.wind = scene.wind;
    const Reach reach = reach_of(scene, model, placement);
    model.may_touch = std::ranges::any_of(model.solids, [&](const Solid& s) { return reach.meets(s); });
    if (scene.self_collision) {
        model.self_collision = fitting(*scene.self_collision, grids, model);
        find_mesh_neighbours(model);
    }
    choose_solid_contacts(reach, model);
    model.contact = make_contact_model(scene, model, placement);
    model.spring_adjacency = !model.grids.empty() && model.grids.size() == model.cloths.size()
                                 ? adjacency_of(model.grids)
                                 : adjacency_of(model.size(), model.springs.i, model.springs.j);
    return model;
}

}  // namespace unravel::sim
