#include "tool/view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "render/png.hpp"
#include "sim/solids/motion.hpp"

namespace unravel {

namespace {

WeavePattern pattern_of(Weave weave) {
    switch (weave) {
        case Weave::plain:
            return WeavePattern::plain;
        case Weave::twill:
            return WeavePattern::twill;
        case Weave::checks:
            return WeavePattern::checks;
        case Weave::stripes:
            return WeavePattern::stripes;
        case Weave::solid:
            return WeavePattern::solid;
    }
    return WeavePattern::plain;
}

SolidShape shape_of(Shape shape) {
    switch (shape) {
        case Shape::plane:
            return SolidShape::plane;
        case Shape::sphere:
            return SolidShape::sphere;
        case Shape::box:
            return SolidShape::box;
        case Shape::cylinder:
            return SolidShape::cylinder;
        case Shape::capsule:
            return SolidShape::capsule;
    }
    return SolidShape::sphere;
}

// The grid as triangles. A tube's seam column is doubled, so that uv runs on to the full circumference there.
ClothMesh mesh_of(const ClothPatch& patch, const ClothAppearance& appearance) {
    ClothMesh mesh;
    mesh.appearance = appearance;
    const int columns = patch.cells_u() + 1, rows = patch.particles[1];
    const float du = static_cast<float>(patch.size[0] / std::max(patch.cells_u(), 1));
    const float dv = static_cast<float>(patch.size[1] / std::max(patch.cells_v(), 1));
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            mesh.particle.push_back(patch.at(i, j));
            mesh.uv.push_back({du * static_cast<float>(i), dv * static_cast<float>(j)});
        }
    }
    const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * columns + i); };
    for (int j = 0; j + 1 < rows; ++j) {
        for (int i = 0; i + 1 < columns; ++i) {
            const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                                d = vertex(i, j + 1);
            // u along +x, v along +z: counter-clockwise as seen from the front (+y). Diagonals alternate, so
            // that the shading has no grain.
            if ((i + j) % 2 == 0) {
                mesh.triangles.push_back({a, d, c});
                mesh.triangles.push_back({a, c, b});
            } else {
                mesh.triangles.push_back({a, d, b});
                mesh.triangles.push_back({b, d, c});
            }
        }
    }
    return mesh;
}

// A plane that faces straight up is drawn as the ground.
bool is_ground(const Solid& solid) {
    return solid.shape == Shape::plane && solid.motion.empty() &&
           (rotation_from_degrees(solid.rotation) * Vec3::UnitY()).y() > 0.9999;
}

float ground_height(const Scene& scene, const Placement& placement) {
    if (scene.look.ground_height) return static_cast<float>(*scene.look.ground_height);
    double lowest = std::numeric_limits<double>::infinity();
    for (const Solid& solid : scene.solids) {
        if (is_ground(solid)) lowest = std::min(lowest, solid.center.y());
    }
    if (std::isfinite(lowest)) return static_cast<float>(lowest);
    for (const Solid& solid : scene.solids) {
        const double reach =
            solid.shape == Shape::box ? 0.5 * solid.size.norm() : solid.radius + 0.5 * solid.height;
        if (solid.shape != Shape::plane) lowest = std::min(lowest, solid.center.y() - reach);
    }
    // A hanging cloth may swing down to its own size below its highest point.
    double highest = -std::numeric_limits<double>::infinity(), size = 0;
    for (const Vec3& x : placement.x) highest = std::max(highest, x.y());
    for (const Cloth& cloth : scene.cloths) size = std::max({size, cloth.size[0], cloth.size[1]});
    return static_cast<float>(std::min(lowest, highest - 1.1 * size) - 0.02);
}

void set_bounds(const Scene& scene, const Placement& placement, DrawScene& out) {
    Vec3f low = placement.x.front().cast<float>(), high = low;
    const auto include = [&](const Vec3f& point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    };
    for (const Vec3& x : placement.x) include(x.cast<float>());
    for (const Solid& solid : scene.solids) {
        if (solid.shape == Shape::plane) continue;
        const double reach = solid.shape == Shape::box      ? 0.5 * solid.size.norm()
                             : solid.shape == Shape::sphere ? solid.radius
                                                            : solid.radius + 0.5 * solid.height;
        const Vec3f r = Vec3f::Constant(static_cast<float>(reach)), c = solid.center.cast<float>();
        include(c - r);
        include(c + r);
    }
    // What falls or swings ends on the ground, or nearly.
    include({low.x(), out.ground_height, low.z()});
    out.bounds_low = low;
    out.bounds_high = high;
}

}  // namespace

Rgb parse_color(const std::string& text) {
    const auto digits = text.find_first_not_of("0123456789abcdefABCDEF", 1);
    if (text.size() != 7 || text[0] != '#' || digits != std::string::npos) {
        throw std::invalid_argument("'" + text + "' is no colour: write it as #rrggbb");
    }
    const auto byte = [&](std::size_t at) {
        return static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16));
    };
    return {byte(1), byte(3), byte(5)};
}

DrawScene make_draw_scene(const Scene& scene, const ClothModel& model, const Placement& placement,
                          const std::filesystem::path& textures) {
    DrawScene out;
    for (std::size_t c = 0; c < model.cloths.size(); ++c) {
        ClothAppearance appearance;
        if (!scene.look.cloth.empty()) {
            const ClothLook& look = scene.look.cloth[std::min(c, scene.look.cloth.size() - 1)];
            appearance.weave = pattern_of(look.weave);
            appearance.front = parse_color(look.front);
            appearance.front_second = parse_color(look.front_second);
            appearance.back = parse_color(look.back);
            appearance.period = static_cast<float>(look.scale);
            appearance.texture = look.texture;
        }
        out.cloths.push_back(mesh_of(model.cloths[c], appearance));
        if (!appearance.texture.empty() && !textures.empty())
            out.cloths.back().texture = read_png(textures / appearance.texture);
    }
    // Stretch springs are stored cloth by cloth, so each cloth's edges are a run of them.
    const auto edges = drawn_edges(model);
    for (const auto& edge : edges) {
        std::size_t c = 0;
        while (edge[0] >= model.cloths[c].first + model.cloths[c].count()) ++c;
        out.cloths[c].edges.push_back(edge);
    }
    for (const Solid& solid : scene.solids) {
        if (is_ground(solid)) continue;
        SolidMesh mesh;
        mesh.shape = shape_of(solid.shape);
        mesh.radius = static_cast<float>(solid.radius);
        mesh.height = static_cast<float>(solid.height);
        mesh.round = static_cast<float>(solid.round);
        mesh.size = solid.size.cast<float>();
        mesh.color = parse_color(solid.color.empty() ? scene.look.solid : solid.color);
        out.solids.push_back(mesh);
    }
    out.background = parse_color(scene.look.background);
    out.ground = parse_color(scene.look.ground);
    out.show_ground = scene.look.show_ground;
    out.ground_height = ground_height(scene, placement);
    set_bounds(scene, placement, out);
    return out;
}

std::vector<std::array<std::uint32_t, 2>> drawn_edges(const ClothModel& model) {
    std::vector<std::array<std::uint32_t, 2>> edges(model.springs.stretch_count);
    for (std::size_t s = 0; s < edges.size(); ++s) edges[s] = {model.springs.i[s], model.springs.j[s]};
    return edges;
}

void make_draw_frame(const Scene& scene, const ClothModel& model, const FrameRecord& record,
                     const std::vector<Rgb>& particle_colors, DrawFrame& out, std::size_t camera) {
    constexpr std::uint8_t faint = 110;
    out.positions.resize(model.size());
    for (std::size_t p = 0; p < model.size(); ++p) out.positions[p] = record.state.x[p].cast<float>();
    out.particle_colors = particle_colors;
    out.edge_strength.resize(model.springs.stretch_count);
    for (std::size_t s = 0; s < out.edge_strength.size(); ++s) {
        out.edge_strength[s] = record.springs[s] == SpringState::implicit ? 255 : faint;
    }
    out.solid_poses.clear();
    for (const Solid& solid : scene.solids) {
        if (!is_ground(solid)) out.solid_poses.push_back(solid_pose(solid, record.state.t).cast<float>());
    }
    out.camera = camera_at(scene, scene.cameras[camera], record.state.t);
}

CameraView camera_at(const Scene& scene, const Camera& camera, double t) {
    Vec3 position = camera.position, target = camera.target;
    const auto& keys = camera.keyframes;
    if (!keys.empty()) {
        const auto next = std::upper_bound(keys.begin(), keys.end(), t,
                                           [](double time, const auto& key) { return time < key.time; });
        const auto& b = next == keys.end() ? keys.back() : *next;
        const auto& a = next == keys.begin() ? keys.front() : *std::prev(next);
        const double s = b.time > a.time ? std::clamp((t - a.time) / (b.time - a.time), 0.0, 1.0) : 0.0;
        const double ease = s * s * (3 - 2 * s);
        position = a.position + ease * (b.position - a.position);
        target = a.target + ease * (b.target - a.target);
    }
    if (camera.orbit != 0) {
        const double angle = camera.orbit * std::numbers::pi / 180.0 * t / scene.clip.duration;
        position = target + Eigen::AngleAxisd(angle, Vec3::UnitY()) * (position - target);
    }
    CameraView view;
    view.position = position.cast<float>();
    view.target = target.cast<float>();
    view.fov = static_cast<float>(camera.fov);
    return view;
}

}  // namespace unravel
