#include <algorithm>

#include "base/whole_file.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/motion.hpp"
#include "sim/solids/shape.hpp"
#include "tool/export/export.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

constexpr std::size_t largest_picture = std::size_t{1} << 30;
constexpr float plane_side = 10;  // m, of which a plane shows

void give_shape(const Solid& solid, ExportSolid& out) {
    if (solid.shape == Shape::plane) {
        const float r = 0.5f * plane_side;
        out.positions = {{-r, 0, -r}, {-r, 0, r}, {r, 0, r}, {r, 0, -r}};
        out.triangles = {{0, 1, 2}, {0, 2, 3}};
        return;
    }
    if (solid.geometry) {
        out.triangles = solid.geometry->triangles;
        for (const Vec3& x : solid.geometry->rest) out.positions.push_back(x.cast<float>());
        if (solid.geometry->deforms())
            out.shape = [geometry = solid.geometry](double t, std::vector<Vec3>& x) {
                geometry->positions_at(t, x);
            };
        return;
    }
    const ShapeSurface shape = law_of(solid.shape).surface(solid, 1);
    out.positions = shape.positions;
    for (std::size_t k = 0; k + 2 < shape.indices.size(); k += 3)
        out.triangles.push_back({shape.indices[k], shape.indices[k + 1], shape.indices[k + 2]});
}

}  // namespace

std::vector<Vec3> solid_positions(const ExportSolid& solid, double t) {
    std::vector<Vec3> x;
    if (solid.shape)
        solid.shape(t, x);
    else
        for (const Vec3f& at : solid.positions) x.push_back(at.cast<double>());
    const Eigen::Isometry3d pose = solid.pose(t);
    for (Vec3& at : x) at = pose * at;
    return x;
}

void add_surroundings(ExportSource& source, const Scene& scene, bool cameras) {
    for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
        ExportLook out;
        if (!scene.look.cloth.empty()) {
            const ClothLook& look = scene.look.cloth[std::min(c, scene.look.cloth.size() - 1)];
            out.front = parse_color(look.front);
            if (!look.texture.empty())
                out.texture = read_whole_file(scene.home / look.texture, largest_picture);
        }
        source.looks.push_back(std::move(out));
    }
    for (const Solid& solid : scene.solids) {
        ExportSolid out;
        out.name = solid.name;
        out.color = parse_color(solid.color.empty() ? scene.look.solid : solid.color);
        out.moves = solid.moves();
        out.pose = [solid](double t) { return solid_pose(solid, t); };
        give_shape(solid, out);
        source.solids.push_back(std::move(out));
    }
    if (!cameras) return;
    const double aspect = static_cast<double>(scene.clip.size[0]) / scene.clip.size[1];
    for (const Camera& camera : scene.cameras)
        source.cameras.push_back(
            {camera.name, aspect, [scene, camera](double t) { return camera_at(scene, camera, t); }});
}

}  // namespace unravel::tool
