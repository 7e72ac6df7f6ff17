#include "sim/mesh/repair.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "sim/mesh/half_edges.hpp"

namespace unravel::sim {

namespace {

using Face = PolygonMesh::Face;

// Of all sides of faces, but for those that have no length to speak of.
double shortest_side(const PolygonMesh& mesh) {
    double longest = 0, shortest = std::numeric_limits<double>::infinity();
    const auto each_side = [&](const auto& visit) {
        for (const Face& face : mesh.faces) {
            for (std::size_t k = 0; k < face.corners; ++k)
                visit((mesh.positions[face.vertex[k]] - mesh.positions[face.vertex[(k + 1) % face.corners]])
                          .norm());
        }
    };
    each_side([&](double length) { longest = std::max(longest, length); });
    each_side([&](double length) {
        if (length > 1e-6 * longest) shortest = std::min(shortest, length);
    });
    return shortest;
}

void keep_faces(PolygonMesh& mesh, const std::vector<char>& kept) {
    std::size_t to = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (!kept[f]) continue;
        mesh.faces[to] = mesh.faces[f];
        mesh.face_part[to] = mesh.face_part[f];
        mesh.file_face[to] = mesh.file_face[f];
        if (!mesh.face_line.empty()) mesh.face_line[to] = mesh.face_line[f];
        ++to;
    }
    mesh.faces.resize(to);
    mesh.face_part.resize(to);
    mesh.file_face.resize(to);
    if (!mesh.face_line.empty()) mesh.face_line.resize(to);
}

// Vertices give way to those that stand for them, by number (themselves: they stay; no_index: they go, with
// the seams that end there). Those that stay keep their order.
void keep_vertices(PolygonMesh& mesh, const std::vector<std::uint32_t>& stands) {
    std::vector<std::uint32_t> number(stands.size(), no_index);
    std::uint32_t to = 0;
    for (std::uint32_t v = 0; v < stands.size(); ++v) {
        if (stands[v] != v) continue;
        mesh.positions[to] = mesh.positions[v];
        mesh.file_vertex[to] = mesh.file_vertex[v];
        if (!mesh.vertex_line.empty()) mesh.vertex_line[to] = mesh.vertex_line[v];
        number[v] = to++;
    }
    mesh.positions.resize(to);
    mesh.file_vertex.resize(to);
    if (!mesh.vertex_line.empty()) mesh.vertex_line.resize(to);
    for (std::uint32_t v = 0; v < stands.size(); ++v) {
        if (stands[v] != no_index) number[v] = number[stands[v]];
    }
    for (Face& face : mesh.faces) {
        for (std::size_t k = 0; k < face.corners; ++k) face.vertex[k] = number[face.vertex[k]];
    }
    for (auto& line : mesh.lines) line = {number[line[0]], number[line[1]]};
    std::erase_if(mesh.lines, [](const auto& line) {
        return line[0] == no_index || line[1] == no_index || line[0] == line[1];
    });
    for (auto& [name, vertices] : mesh.groups) {
        for (std::uint32_t& v : vertices) v = number[v];
        std::erase(vertices, no_index);
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    }
}

// Vertices without a face go. Returns how many.
std::size_t drop_unused(PolygonMesh& mesh) {
    std::vector<std::uint32_t> stands(mesh.positions.size(), no_index);
    for (const Face& face : mesh.faces) {
        for (std::size_t k = 0; k < face.corners; ++k) stands[face.vertex[k]] = face.vertex[k];
    }
    const auto dropped = static_cast<std::size_t>(std::count(stands.begin(), stands.end(), no_index));
    if (dropped > 0) keep_vertices(mesh, stands);
    return dropped;
}

bool names_twice(const Face& face) {
    for (std::size_t a = 0; a < face.corners; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            if (face.vertex[a] == face.vertex[b]) return true;
        }
    }
    return false;
}

}  // namespace

double face_area(const std::vector<Vec3>& positions, const Face& face) {
    const Vec3 &a = positions[face.vertex[0]], &b = positions[face.vertex[1]], &c = positions[face.vertex[2]];
    if (face.corners == 3) return 0.5 * (b - a).cross(c - a).norm();
    return 0.5 * (c - a).cross(positions[face.vertex[3]] - b).norm();
}

// Sorted along a direction that no mesh has, those that are near stand near.
std::vector<std::array<std::uint32_t, 2>> coincident_vertices(const PolygonMesh& mesh) {
    const Vec3 along(0.5377, 0.3519, 0.7663);
    const double near = 1e-5 * shortest_side(mesh);
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<double> place;
    place.reserve(order.size());
    for (const Vec3& x : mesh.positions) place.push_back(along.dot(x));
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(place[a], a) < std::tie(place[b], b);
    });
    std::vector<std::array<std::uint32_t, 2>> sewn, out;
    for (const auto& [a, b] : mesh.lines) sewn.push_back({std::max(a, b), std::min(a, b)});
    std::sort(sewn.begin(), sewn.end());
    // One of each heap gathers what is near it, so that a heap of n takes n steps.
    std::vector<char> taken(order.size(), 0);
    std::vector<std::uint32_t> heap;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (taken[order[k]]) continue;
        heap.assign(1, order[k]);
        for (std::size_t l = k + 1; l < order.size() && place[order[l]] - place[order[k]] <= near; ++l) {
            const auto [first, later] = std::minmax(order[k], order[l]);
            const std::array<std::uint32_t, 2> pair{later, first};
            if (taken[order[l]] || (mesh.positions[first] - mesh.positions[later]).norm() > near ||
                std::binary_search(sewn.begin(), sewn.end(), pair))
                continue;
            taken[order[l]] = 1;
            heap.push_back(order[l]);
        }
        std::sort(heap.begin(), heap.end());
        for (std::size_t l = 1; l < heap.size(); ++l) out.push_back({heap[l], heap[0]});
    }
    std::sort(out.begin(), out.end());
    return out;
}

void merge_coincident(PolygonMesh& mesh, MeshMessages& said) {
    const auto pairs = coincident_vertices(mesh);
    if (pairs.empty()) return;
    std::vector<std::uint32_t> stands(mesh.positions.size());
    std::iota(stands.begin(), stands.end(), 0u);
    // The first of a pair is the smaller: what it stands for is final when the later one is reached.
    for (const auto& [later, first] : pairs) stands[later] = stands[first];
    keep_vertices(mesh, stands);
    said.notes.push_back(
        fmt::format("{} on another: merged", counted(pairs.size(), "vertex lies", "vertices lie")));
}

void drop_flat_faces(PolygonMesh& mesh, MeshMessages& said) {
    double largest = 0;
    for (const Face& face : mesh.faces) largest = std::max(largest, face_area(mesh.positions, face));
    std::vector<char> kept(mesh.faces.size(), 1);
    std::size_t flat = mesh.flat_faces, again = 0;
    std::vector<std::pair<std::array<std::uint32_t, 4>, std::uint32_t>> sorted;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const Face& face = mesh.faces[f];
        if (names_twice(face) || !(face_area(mesh.positions, face) > 1e-12 * largest)) {
            kept[f] = 0;
            ++flat;
            continue;
        }
        std::array<std::uint32_t, 4> vertices = face.vertex;
        if (face.corners == 3) vertices[3] = no_index;
        std::sort(vertices.begin(), vertices.end());
        sorted.emplace_back(vertices, f);
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 1; k < sorted.size(); ++k) {
        if (sorted[k].first != sorted[k - 1].first) continue;
        kept[sorted[k].second] = 0;
        ++again;
    }
    mesh.flat_faces = 0;
    if (flat > 0)
        said.notes.push_back(fmt::format("{} no area: dropped", counted(flat, "face has", "faces have")));
    if (again > 0)
        said.notes.push_back(
            fmt::format("{} the vertices of another: dropped", counted(again, "face has", "faces have")));
    if (flat + again > 0) keep_faces(mesh, kept);
}

void drop_unused_vertices(PolygonMesh& mesh, MeshMessages& said) {
    if (mesh.faces.empty()) return;
    const std::size_t dropped = drop_unused(mesh);
    if (dropped > 0)
        said.notes.push_back(
            fmt::format("{} to no face: dropped", counted(dropped, "vertex belongs", "vertices belong")));
}

bool keep_part(PolygonMesh& mesh, const std::string& object, const std::string& group) {
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
        return name.empty() || std::find(names.begin(), names.end(), name) != names.end();
    };
    std::vector<char> part_kept, kept;
    for (const PolygonMesh::Part& part : mesh.parts)
        part_kept.push_back(has(part.objects, object) && has(part.groups, group));
    for (const std::uint32_t part : mesh.face_part) kept.push_back(part_kept[part]);
    keep_faces(mesh, kept);
    if (mesh.faces.empty()) return false;
    drop_unused(mesh);
    return true;
}

}  // namespace unravel::sim
