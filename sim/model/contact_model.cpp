#include "sim/model/contact_model.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/polygon_mesh.hpp"
#include "sim/solids/shape.hpp"
#include "sim/surface/closest.hpp"
#include "sim/surface/feature_pairs.hpp"

namespace unravel::sim {

namespace {

constexpr double bulk_density = 100;  // kg/m³
constexpr double thinnest = 5e-4, thickest = 5e-3;
// Layers that start nearer than this are taken to be this far apart: contact of no thickness could not act.
constexpr double least_at_start = 1e-4;
// Particles that are nearer than this many thicknesses along the cloth never touch: the tightest fold, a half
// circle, has 1.6 between its sides, and more along the threads of a grid.
constexpr double near_thicknesses = 2.5;

Surface make_surface(const ClothModel& model) {
    SurfaceBuilder builder;
    for (const ClothPatch& patch : model.cloths) {
        if (patch.grid()) {
            builder.add_grid(patch.first, patch.particles[0], patch.particles[1], patch.tube);
            continue;
        }
        builder.add_mesh(patch.first, patch.count());
        for (const PolygonMesh::Face& face : patch.mesh->faces) {
            std::array<std::uint32_t, 4> corners{};
            for (std::size_t k = 0; k < face.corners; ++k) corners[k] = patch.first + face.vertex[k];
            builder.add_face(std::span(corners).first(face.corners));
        }
    }
    for (std::size_t s = 0; s < model.stitches.size(); ++s)
        builder.sew(model.stitches.i[s], model.stitches.j[s]);
    return builder.build();
}

// Lengths along the cloth: of edges flat and at rest, of stitches none.
struct Ways {
    std::vector<std::vector<std::pair<std::uint32_t, double>>> from;  // (particles)

    Ways(const ClothModel& model, const Surface& surface) : from(model.size()) {
        const auto add = [&](std::uint32_t a, std::uint32_t b, double length) {
            from[a].emplace_back(b, length);
            from[b].emplace_back(a, length);
        };
        for (const auto& [a, b] : surface.edges) add(a, b, flat_length(model, surface.cloth[a], a, b));
        for (std::size_t s = 0; s < model.stitches.size(); ++s)
            add(model.stitches.i[s], model.stitches.j[s], 0);
    }

    static double flat_length(const ClothModel& model, std::uint32_t cloth, std::uint32_t a,
                              std::uint32_t b) {
        const ClothPatch& patch = model.cloths[cloth];
        if (!patch.grid())
            return (patch.mesh->rest[b - patch.first] - patch.mesh->rest[a - patch.first]).norm();
        const auto nu = static_cast<std::uint32_t>(patch.particles[0]);
        const std::uint32_t i = a - patch.first, j = b - patch.first;
        const auto apart = [](std::uint32_t p, std::uint32_t q) { return p < q ? q - p : p - q; };
        std::uint32_t du = apart(i % nu, j % nu);
        if (patch.tube) du = std::min(du, nu - du);
        return std::hypot(du * patch.size[0] / std::max(patch.cells_u(), 1),
                          apart(i / nu, j / nu) * patch.size[1] / std::max(patch.cells_v(), 1));
    }

    // Particles within `reach` of one, sorted; `way` is scratch, infinite all over.
    void around(std::uint32_t p, double reach, std::vector<double>& way,
                std::vector<std::uint32_t>& out) const {
        using Place = std::pair<double, std::uint32_t>;
        std::priority_queue<Place, std::vector<Place>, std::greater<>> next;
        out.assign(1, p);
        way[p] = 0;
        next.emplace(0.0, p);
        while (!next.empty()) {
            const auto [length, q] = next.top();
            next.pop();
            if (length > way[q]) continue;
            for (const auto& [to, edge] : from[q]) {
                const double there = length + edge;
                if (there > reach || there >= way[to]) continue;
                if (std::isinf(way[to])) out.push_back(to);
                way[to] = there;
                next.emplace(there, to);
            }
        }
        for (const std::uint32_t q : out) way[q] = std::numeric_limits<double>::infinity();
        std::sort(out.begin(), out.end());
    }
};

Lists near_particles(const ClothModel& model, const ContactModel& contact) {
    const Ways ways(model, contact.surface);
    Lists out;
    out.start.assign(1, 0);
    std::vector<double> way(model.size(), std::numeric_limits<double>::infinity());
    std::vector<std::uint32_t> found;
    for (std::uint32_t p = 0; p < model.size(); ++p) {
        ways.around(p, near_thicknesses * contact.wanted[contact.surface.cloth[p]], way, found);
        out.list.insert(out.list.end(), found.begin(), found.end());
        out.start.push_back(static_cast<std::uint32_t>(out.list.size()));
    }
    return out;
}

// Takes each cloth's thickness down to what its layers have between them at the start.
void fit_to_start(std::span<const Vec3> x, ContactModel& contact) {
    const Surface& surface = contact.surface;
    std::vector<Box> boxes(x.size());
    for (std::size_t p = 0; p < x.size(); ++p) {
        const Vec3 reach = Vec3::Constant(0.5 * contact.wanted[surface.cloth[p]]);
        boxes[p] = {x[p] - reach, x[p] + reach};
    }
    SurfaceTree tree = contact.tree;
    tree.refit(surface, boxes);
    FeaturePairs pairs;
    find_pairs(surface, tree, pairs);
    const auto fit = [&](FeaturePair kind, const std::array<std::uint32_t, 2>& pair) {
        const std::array<std::uint32_t, 4> p = corners_of(surface, kind, pair);
        if (contact.are_near(kind, p)) return;
        const std::array<Vec3, 4> at{x[p[0]], x[p[1]], x[p[2]], x[p[3]]};
        const double distance = std::max(combined(weights_of(kind, at), at).norm(), least_at_start);
        for (const std::uint32_t q : {p[0], p[3]}) {
            double& thickness = contact.thickness[surface.cloth[q]];
            thickness = std::min(thickness, distance);
        }
    };
    for (const auto& pair : pairs.vertex_triangle) fit(FeaturePair::vertex_triangle, pair);
    for (const auto& pair : pairs.edge_edge) fit(FeaturePair::edge_edge, pair);
}

double stiffest_thread(const ClothModel& model) {
    double most = 0;
    for (std::size_t s = 0; s < model.springs.stretch_count; ++s)
        most = std::max(most, model.springs.stiffness[s]);
    // Of cloth without springs, a single particle or none: anything that holds its weight.
    return most > 0 ? most : 1e3;
}

}  // namespace

bool ContactModel::are_near(FeaturePair kind, const std::array<std::uint32_t, 4>& p) const {
    const auto is_near = [&](std::uint32_t a, std::uint32_t b) {
        const std::span<const std::uint32_t> list = near.of(a);
        return std::binary_search(list.begin(), list.end(), b);
    };
    if (kind == FeaturePair::vertex_triangle)
        return is_near(p[0], p[1]) || is_near(p[0], p[2]) || is_near(p[0], p[3]);
    return is_near(p[0], p[2]) || is_near(p[0], p[3]) || is_near(p[1], p[2]) || is_near(p[1], p[3]);
}

double ContactModel::pair_thickness(std::uint32_t p, std::uint32_t q) const {
    return 0.5 * (thickness[surface.cloth[p]] + thickness[surface.cloth[q]]);
}

double widest_spacing(const ClothModel& model) {
    double widest = 0;
    for (std::uint32_t s = 0; s < model.springs.stretch_count; ++s)
        widest = std::max(widest, model.springs.rest[s]);
    return widest;
}

bool needs_surfaces(const Solid& solid, double spacing) {
    if (solid.shape == Shape::plane || solid.shape == Shape::mesh) return false;
    const double radius = law_of(solid.shape).rounding(solid);
    return spacing > 2 * std::sqrt(solid.offset * (2 * radius + solid.offset));
}

void choose_solid_contacts(const Reach& reach, ClothModel& model) {
    const double spacing = widest_spacing(model);
    for (Solid& solid : model.solids) {
        if (solid.contact != SolidContact::automatic) continue;
        const bool needs = reach.meets(solid) && needs_surfaces(solid, spacing);
        solid.contact = needs ? SolidContact::surface : SolidContact::particles;
    }
}

std::shared_ptr<const ContactModel> make_contact_model(const Scene& scene, const ClothModel& model,
                                                       const Placement& placement) {
    const auto edges_can_cut = [](const Solid& solid) {
        return solid.shape != Shape::plane && solid.shape != Shape::mesh;
    };
    if (!scene.self_collision && scene.cloths.size() < 2 && std::ranges::none_of(scene.solids, edges_can_cut))
        return nullptr;
    auto out = std::make_shared<ContactModel>();
    out->surface = make_surface(model);
    out->tree = SurfaceTree(out->surface, placement.x);
    out->stiffness = stiffest_thread(model);
    if (!model.cloth_by_surfaces()) return out;
    const SelfCollision& settings = *scene.self_collision;
    for (const Cloth& cloth : scene.cloths) {
        out->wanted.push_back(settings.thickness > 0
                                  ? settings.thickness
                                  : std::clamp(cloth.density / bulk_density, thinnest, thickest));
    }
    out->thickness = out->wanted;
    if (settings.stiffness > 0) out->stiffness = settings.stiffness;
    out->damping = settings.damping;
    out->friction = settings.friction;
    out->near = near_particles(model, *out);
    fit_to_start(placement.x, *out);
    return out;
}

}  // namespace unravel::sim
