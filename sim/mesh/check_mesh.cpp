#include "sim/mesh/check_mesh.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace unravel::sim {

namespace {

// An edge of a face, named by its smaller and larger vertex, so that sorting brings neighbours together.
struct HalfEdge {
    std::uint32_t low, high, face;
    bool forward;  ///< runs from low to high
    bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> half_edges(const ObjMesh& mesh) {
    std::vector<HalfEdge> out;
    out.reserve(4 * mesh.faces.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const ObjMesh::Face& face = mesh.faces[f];
        for (std::size_t k = 0; k < face.corners; ++k) {
            const std::uint32_t a = face.vertex[k], b = face.vertex[(k + 1) % face.corners];
            out.push_back({std::min(a, b), std::max(a, b), f, a < b});
        }
    }
    std::sort(out.begin(), out.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return out;
}

class MeshCheck {
public:
    MeshCheck(const ObjMesh& mesh, std::vector<MeshFault>& faults, std::size_t most)
        : mesh_(mesh), faults_(faults), most_(most) {}

    void faces() {
        if (mesh_.faces.empty()) {
            add(0, "the mesh has no faces", "write triangles or quads (f lines)");
            return;
        }
        double largest = 0;
        for (const ObjMesh::Face& face : mesh_.faces)
            largest = std::max(largest, face_area(mesh_.positions, face));
        for (std::size_t f = 0; f < mesh_.faces.size() && !full(); ++f) {
            const ObjMesh::Face& face = mesh_.faces[f];
            bool twice = false;
            for (std::size_t a = 0; a < face.corners; ++a) {
                for (std::size_t b = 0; b < a; ++b) twice = twice || face.vertex[a] == face.vertex[b];
            }
            if (twice) {
                add(mesh_.face_line[f], fmt::format("face {} names a vertex twice ({})", f + 1, corners(f)),
                    "remove the face, or name another vertex");
            } else if (!(face_area(mesh_.positions, face) > 1e-12 * largest)) {
                add(mesh_.face_line[f], fmt::format("face {} has no area (vertices {})", f + 1, corners(f)),
                    "remove it, or merge its vertices");
            }
        }
    }

    void vertices() {
        std::vector<char> used(mesh_.positions.size(), 0);
        for (const ObjMesh::Face& face : mesh_.faces) {
            for (std::size_t k = 0; k < face.corners; ++k) used[face.vertex[k]] = 1;
        }
        for (std::size_t v = 0; v < used.size() && !full(); ++v) {
            if (!used[v])
                add(mesh_.vertex_line[v], fmt::format("vertex {} belongs to no face", v + 1), "remove it");
        }
    }

    // Vertices at one and the same place, or nearer than numbers of six digits tell, look sewn and are not.
    // Seams (l lines) may join such. Sorted along a direction that no mesh has, those that are near stand
    // near.
    void duplicates() {
        const Vec3 along(0.5377, 0.3519, 0.7663);
        const double near = 1e-5 * shortest_side();
        std::vector<std::uint32_t> order(mesh_.positions.size());
        std::iota(order.begin(), order.end(), 0u);
        std::vector<double> place;
        place.reserve(order.size());
        for (const Vec3& x : mesh_.positions) place.push_back(along.dot(x));
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::tie(place[a], a) < std::tie(place[b], b);
        });
        std::vector<std::pair<std::uint32_t, std::uint32_t>> sewn;
        for (const auto& [a, b] : mesh_.lines) sewn.emplace_back(std::min(a, b), std::max(a, b));
        std::sort(sewn.begin(), sewn.end());
        for (std::size_t k = 1; k < order.size() && !full(); ++k) {
            for (std::size_t l = k; l-- > 0 && place[order[k]] - place[order[l]] <= near && !full();) {
                const auto [a, b] = std::minmax(order[l], order[k]);
                if ((mesh_.positions[a] - mesh_.positions[b]).norm() > near ||
                    std::binary_search(sewn.begin(), sewn.end(), std::pair(a, b)))
                    continue;
                add(mesh_.vertex_line[b],
                    fmt::format("vertex {} lies on vertex {} (line {})", b + 1, a + 1, mesh_.vertex_line[a]),
                    "merge them, or join them by a seam (l line)");
            }
        }
    }

    void edges(bool closed) {
        const std::vector<HalfEdge> all = half_edges(mesh_);
        for (std::size_t first = 0; first < all.size() && !full();) {
            std::size_t last = first + 1;
            while (last < all.size() && all[last].same_edge(all[first])) ++last;
            judge_edge(all, first, last, closed);
            first = last;
        }
    }

    // Six times the volume; faces that look outward make it positive.
    void outward() {
        double volume = 0;
        for (const ObjMesh::Face& face : mesh_.faces) {
            const auto x = [&](std::size_t k) {
                return Vec3(mesh_.positions[face.vertex[k]] - mesh_.positions.front());
            };
            for (std::size_t k = 2; k < face.corners; ++k) volume += x(0).dot(x(k - 1).cross(x(k)));
        }
        if (volume < 0) add(mesh_.face_line.front(), "the faces look inward", "flip all of them");
    }

    bool full() const { return faults_.size() >= most_; }

private:
    // Of all sides of faces, but for those that have no length to speak of.
    double shortest_side() const {
        double longest = 0, shortest = std::numeric_limits<double>::infinity();
        const auto each_side = [&](const auto& visit) {
            for (const ObjMesh::Face& face : mesh_.faces) {
                for (std::size_t k = 0; k < face.corners; ++k)
                    visit((mesh_.positions[face.vertex[k]] -
                           mesh_.positions[face.vertex[(k + 1) % face.corners]])
                              .norm());
            }
        };
        each_side([&](double length) { longest = std::max(longest, length); });
        each_side([&](double length) {
            if (length > 1e-6 * longest) shortest = std::min(shortest, length);
        });
        return shortest;
    }

    void add(int line, std::string what, std::string hint) {
        if (!full()) faults_.push_back({line, std::move(what), std::move(hint)});
    }

    std::string corners(std::size_t f) const {
        std::string out;
        for (std::size_t k = 0; k < mesh_.faces[f].corners; ++k)
            out += fmt::format("{}{}", k ? ", " : "", mesh_.faces[f].vertex[k] + 1);
        return out;
    }

    void judge_edge(const std::vector<HalfEdge>& all, std::size_t first, std::size_t last, bool closed) {
        const HalfEdge& a = all[first];
        const std::string edge = fmt::format("the edge from vertex {} to {}", a.low + 1, a.high + 1);
        if (last - first > 2) {
            std::string faces;
            for (std::size_t k = first; k < last; ++k)
                faces += fmt::format("{}{}", k > first ? ", " : "", all[k].face + 1);
            add(mesh_.face_line[all[last - 1].face],
                fmt::format("{} belongs to {} faces ({})", edge, last - first, faces),
                "a sheet has at most two at an edge: remove or separate the others");
        } else if (last - first == 2 && a.forward == all[first + 1].forward) {
            const std::uint32_t f = a.face, g = all[first + 1].face;
            add(mesh_.face_line[g],
                fmt::format("faces {} (line {}) and {} face opposite ways across {}", f + 1,
                            mesh_.face_line[f], g + 1, edge),
                "flip one of them, so that both turn the same way");
        } else if (closed && last - first == 1) {
            add(mesh_.face_line[a.face], fmt::format("{} is open: only face {} is there", edge, a.face + 1),
                "a solid has an inside: close the hole");
        }
    }

    const ObjMesh& mesh_;
    std::vector<MeshFault>& faults_;
    std::size_t most_;
};

}  // namespace

double face_area(const std::vector<Vec3>& positions, const ObjMesh::Face& face) {
    const Vec3 &a = positions[face.vertex[0]], &b = positions[face.vertex[1]], &c = positions[face.vertex[2]];
    if (face.corners == 3) return 0.5 * (b - a).cross(c - a).norm();
    return 0.5 * (c - a).cross(positions[face.vertex[3]] - b).norm();
}

void check_cloth_mesh(const ObjMesh& mesh, std::vector<MeshFault>& faults, std::size_t most) {
    MeshCheck check(mesh, faults, most);
    check.faces();
    // What follows from faces that are no faces is no news.
    if (!faults.empty()) return;
    check.vertices();
    check.duplicates();
    check.edges(false);
}

void check_solid_mesh(const ObjMesh& mesh, std::vector<MeshFault>& faults, std::size_t most) {
    MeshCheck check(mesh, faults, most);
    check.faces();
    if (!faults.empty()) return;
    check.vertices();
    check.duplicates();
    check.edges(true);
    if (faults.empty()) check.outward();
}

}  // namespace unravel::sim
