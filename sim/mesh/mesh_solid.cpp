#include "sim/mesh/mesh_solid.hpp"

#include <algorithm>
#include <cmath>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/shell.hpp"

namespace unravel::sim {

namespace {

// Quads are cut along the shorter diagonal.
std::vector<Triangle> triangles_of(const std::vector<Vec3>& x, const std::vector<PolygonMesh::Face>& faces) {
    std::vector<Triangle> out;
    for (const PolygonMesh::Face& face : faces) {
        const auto& [a, b, c, d] = face.vertex;
        if (face.corners == 3) {
            out.push_back({a, b, c});
        } else if ((x[a] - x[c]).squaredNorm() <= (x[b] - x[d]).squaredNorm()) {
            out.push_back({a, b, c});
            out.push_back({a, c, d});
        } else {
            out.push_back({a, b, d});
            out.push_back({b, c, d});
        }
    }
    return out;
}

// Places that are looked at to find how far an animated figure reaches, and what is added for those between.
constexpr int reach_samples = 64;
constexpr double reach_margin = 1.05;

}  // namespace

void MeshSolid::positions_at(double t, std::vector<Vec3>& out) const {
    if (!deforms()) {
        out = rest;
        return;
    }
    // Before frame 0, while a scene settles, nothing moves.
    double since = std::max(t, 0.0) - start;
    if (period > 0 && since > 0) since = std::fmod(since, period);
    if (pose) {
        pose(since, out);
        return;
    }
    const double last = static_cast<double>(samples.size() - 1);
    const double at = std::clamp(since * fps, 0.0, last);
    const auto before = static_cast<std::size_t>(std::min(std::floor(at), std::max(last - 1, 0.0)));
    const std::vector<Vec3>&a = samples[before], &b = samples[std::min(before + 1, samples.size() - 1)];
    const double share = at - static_cast<double>(before);
    out.resize(a.size());
    for (std::size_t v = 0; v < a.size(); ++v) out[v] = a[v] + share * (b[v] - a[v]);
}

void finish_solid(MeshSolid& body, PolygonMesh mesh, const MeshFile& file, const MeshFrames& frames,
                  std::shared_ptr<const Figure> figure) {
    body.fps = frames.fps;
    body.start = frames.start;
    body.rest = std::move(mesh.positions);
    body.triangles = triangles_of(body.rest, mesh.faces);
    const std::vector<Triangle> surface = body.triangles;
    if (file.shell > 0) body.triangles = shell_triangles(surface, body.rest.size());
    const auto place = [surface, scale = file.scale, up = file.up,
                        shell = file.shell](std::vector<Vec3>& shape) {
        for (Vec3& x : shape) x = from_file(x, scale, up);
        if (shell > 0) thicken(surface, shell, shape);
    };
    // Vertices that were dropped or merged are not among the mesh's any more.
    const auto take = [from = std::move(mesh.file_vertex), place](const std::vector<Vec3>& all,
                                                                  std::vector<Vec3>& out) {
        out.clear();
        out.reserve(2 * from.size());
        for (const std::uint32_t v : from) out.push_back(all[v]);
        place(out);
    };
    const auto reach_for = [&](const std::vector<Vec3>& shape, double margin) {
        for (const Vec3& x : shape) body.reach = std::max(body.reach, margin * x.norm());
    };
    place(body.rest);
    reach_for(body.rest, 1);
    std::vector<Vec3> shape;
    for (std::vector<Vec3>& sample : body.samples) {
        take(sample, shape);
        sample = shape;
        reach_for(sample, 1);
    }
    if (frames.loop && !body.samples.empty())
        body.period = static_cast<double>(body.samples.size() - 1) / body.fps;
    if (figure) {
        if (frames.loop) body.period = figure->duration();
        body.pose = [figure, take](double t, std::vector<Vec3>& out) {
            std::vector<Vec3> all;
            figure->pose(t, all);
            take(all, out);
        };
        for (int k = 0; k <= reach_samples; ++k) {
            body.pose(figure->duration() * k / reach_samples, shape);
            reach_for(shape, reach_margin);
        }
    }
    if (body.deforms()) {
        body.positions_at(0, shape);
        body.rest = std::move(shape);
    }
    body.tree = MeshTree(body.rest, body.triangles);
}

}  // namespace unravel::sim
