#include "sim/model/mesh_springs.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "sim/model/mesh_bends.hpp"
#include "sim/model/mesh_curvature.hpp"
#include "sim/model/moduli.hpp"

namespace unravel::sim {

namespace {

using Cell = MeshCloth::Cell;

std::size_t corner_of(const Cell& cell, std::uint32_t vertex) {
    return static_cast<std::size_t>(std::find(cell.vertex.begin(), cell.vertex.end(), vertex) -
                                    cell.vertex.begin());
}

// Share of u in the direction of an edge, cos² of its angle in the texture; a half where there is none.
double share_of_u(const MeshCloth& mesh, const Cell& cell, const MeshCloth::Edge& edge) {
    const std::uint32_t a = cell.uv[corner_of(cell, edge.a)], b = cell.uv[corner_of(cell, edge.b)];
    if (a == no_index || b == no_index) return 0.5;
    const Vec2 d = mesh.uvs[b] - mesh.uvs[a];
    const double square = d.squaredNorm();
    return square > 0 ? d.x() * d.x() / square : 0.5;
}

// k/E of an edge as one of its cells has it.
double edge_shape(const MeshCloth& mesh, const Cell& cell, const MeshCloth::Edge& edge) {
    const double length = mesh.length(edge), area = mesh.area(cell);
    if (cell.corners == 3) return area / (length * length);
    const std::size_t a = corner_of(cell, edge.a), b = corner_of(cell, edge.b);
    // The two corners that are neither.
    const std::uint32_t c = cell.vertex[(a + 2) % 4], d = cell.vertex[(b + 2) % 4];
    const double opposite = (mesh.rest[d] - mesh.rest[c]).norm();
    return area / ((length + opposite) * length);
}

// Mean length of an edge and the one opposite over what a square of the cell's area has: √(a/b) of a
// rectangle, and its fourth power.
double quad_square(const MeshCloth& mesh, const Cell& cell, std::size_t corner) {
    const auto at = [&](std::size_t k) { return mesh.rest[cell.vertex[(corner + k) % 4]]; };
    const double mean = 0.5 * ((at(1) - at(0)).norm() + (at(2) - at(3)).norm()), area = mesh.area(cell);
    return mean * mean * mean * mean / (area * area);
}

// The modulus in the direction of the edge that begins at a corner of a quad.
double stretch_along(const MeshCloth& mesh, const Cell& cell, std::size_t corner, const Material& m) {
    const std::uint32_t a = cell.vertex[corner], b = cell.vertex[(corner + 1) % 4];
    const double u = share_of_u(mesh, cell, {std::min(a, b), std::max(a, b), {}});
    return u * m.stretch[0] + (1 - u) * m.stretch[1];
}

// The share of the shear modulus that a quad's diagonals have: as its more demanding edges leave it.
double quad_share(const MeshCloth& mesh, const Cell& cell, const Material& material) {
    double share = 1;
    for (const std::size_t corner : {0u, 1u}) {
        Material along = material;
        along.stretch = {stretch_along(mesh, cell, corner, material),
                         stretch_along(mesh, cell, corner + 1, material)};
        share = std::min(share, diagonals_share(along, quad_square(mesh, cell, corner)));
    }
    return share;
}

// What of an edge's k/E a triangle has of E A/L²: isotropic cloth of Young's modulus E is stiffer by 9/8
// where it is held in its width.
constexpr double held_triangle = 8.0 / 9.0;

}  // namespace

bool in_group(const MeshCloth& mesh, const std::string& group, std::uint32_t vertex) {
    const auto found = mesh.groups.find(group);
    return found != mesh.groups.end() &&
           std::binary_search(found->second.begin(), found->second.end(), vertex);
}

MeshMaterials::MeshMaterials(const Cloth& cloth) : cloth_(cloth) {
    for (const Region& region : cloth.regions) {
        std::vector<char>& inside = inside_.emplace_back(cloth.geometry->rest.size(), 0);
        if (const auto found = cloth.geometry->groups.find(region.group);
            found != cloth.geometry->groups.end()) {
            for (const std::uint32_t v : found->second) inside[v] = 1;
        }
    }
}

const Material& MeshMaterials::at(std::span<const std::uint32_t> vertices) const {
    const Material* found = &cloth_.material;
    for (std::size_t r = 0; r < inside_.size(); ++r) {
        if (cloth_.regions[r].material && all_inside(r, vertices)) found = &*cloth_.regions[r].material;
    }
    return *found;
}

double MeshMaterials::density(std::uint32_t vertex) const {
    double found = cloth_.density;
    for (std::size_t r = 0; r < inside_.size(); ++r) {
        if (cloth_.regions[r].density && inside_[r][vertex]) found = *cloth_.regions[r].density;
    }
    return found;
}

bool MeshMaterials::all_inside(std::size_t region, std::span<const std::uint32_t> vertices) const {
    return std::all_of(vertices.begin(), vertices.end(),
                       [&](std::uint32_t v) { return inside_[region][v] != 0; });
}

void add_mesh_stretch(const Cloth& cloth, std::uint32_t first, ExtensionSprings& springs) {
    const MeshCloth& mesh = *cloth.geometry;
    const MeshMaterials materials(cloth);
    for (const MeshCloth::Edge& edge : mesh.edges) {
        const std::array ends{edge.a, edge.b};
        const Material& m = materials.at(ends);
        double stiffness = 0, damping = 0;
        for (const std::uint32_t c : edge.cell) {
            if (c == no_index) continue;
            const Cell& cell = mesh.cells[c];
            const bool triangle = cell.corners == 3;
            const double u = share_of_u(mesh, cell, edge);
            const double shape = (triangle ? held_triangle : 1.0) * edge_shape(mesh, cell, edge);
            const double of_stretch = shape * (u * m.stretch[0] + (1 - u) * m.stretch[1]);
            const double of_damping = shape * (u * m.stretch_damping[0] + (1 - u) * m.stretch_damping[1]);
            // What a quad's diagonals resist already is not its edges' to resist.
            const Material& inside = triangle ? m : materials.at(cell.vertex);
            const double of_diagonals =
                triangle ? 0 : 0.5 * quad_share(mesh, cell, inside) / edge_shape(mesh, cell, edge);
            stiffness += std::max(of_stretch - of_diagonals * inside.shear, threads_share * of_stretch);
            damping += std::max(of_damping - of_diagonals * inside.shear_damping, 0.0);
        }
        springs.add(first + edge.a, first + edge.b, mesh.length(edge), stiffness, damping);
    }
}

void note_mesh_shear(const Cloth& cloth, std::vector<std::string>& notes) {
    const MeshCloth& mesh = *cloth.geometry;
    const MeshMaterials materials(cloth);
    double least = 1;
    for (const Cell& cell : mesh.cells) {
        if (cell.corners == 4) least = std::min(least, quad_share(mesh, cell, materials.at(cell.vertex)));
    }
    if (least < 1) notes.push_back(weak_shear_note(cloth, least, "the mesh"));
}

void add_mesh_shear(const Cloth& cloth, std::uint32_t first, ExtensionSprings& springs) {
    const MeshCloth& mesh = *cloth.geometry;
    const MeshMaterials materials(cloth);
    for (const Cell& cell : mesh.cells) {
        if (cell.corners != 4) continue;
        const Material& m = materials.at(cell.vertex);
        for (const std::size_t k : {0u, 1u}) {
            const std::uint32_t a = cell.vertex[k], b = cell.vertex[k + 2];
            const double rest = (mesh.rest[b] - mesh.rest[a]).norm();
            const double shape = quad_share(mesh, cell, m) * rest * rest / mesh.area(cell);
            springs.add(first + a, first + b, rest, m.shear * shape, m.shear_damping * shape);
        }
    }
}

void add_mesh_curvature(const Cloth& cloth, std::uint32_t first, CurvatureStencils& stencils) {
    const MeshMaterials materials(cloth);
    for (MeshCurvature& s : curvature_of(*cloth.geometry)) {
        const std::span vertices(s.vertex.data(), s.count);
        const double stiffness = materials.at(vertices).bend * s.stiffness;
        if (stiffness <= 0) continue;
        for (std::uint32_t& vertex : vertices) vertex += first;
        stencils.add(vertices, std::span(s.weight.data(), s.count), stiffness);
    }
}

void add_mesh_arcs(const Cloth& cloth, std::uint32_t first, BendSprings& bends) {
    const MeshCloth& mesh = *cloth.geometry;
    const MeshMaterials materials(cloth);
    for (const MeshCloth::Edge& edge : mesh.edges) {
        const Material& m = materials.at(std::array{edge.a, edge.b});
        const double length = mesh.length(edge);
        double width = 0;
        for (const std::uint32_t c : edge.cell)
            if (c != no_index) width += edge_shape(mesh, mesh.cells[c], edge) * length;
        if (m.bend * width > 0)
            bends.add(first + edge.a, first + edge.b, length, m.bend * width, m.buckling_strain);
    }
}

std::vector<double> mesh_masses(const Cloth& cloth) {
    const MeshMaterials materials(cloth);
    std::vector<double> mass = vertex_areas(*cloth.geometry);
    for (std::uint32_t v = 0; v < mass.size(); ++v) mass[v] *= materials.density(v);
    return mass;
}

void add_mesh_air(const MeshCloth& mesh, std::uint32_t first, AirCells& air) {
    for (const MeshCloth::Cell& cell : mesh.cells) {
        const auto at = [&](std::size_t k) { return first + cell.vertex[k]; };
        air.corners.push_back({at(0), at(1), at(2), at(cell.corners == 4 ? 3 : 2)});
    }
}

}  // namespace unravel::sim
