#include "tool/picture/view.hpp"

#include <algorithm>
#include <cmath>

#include "render/png.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/scene_file/look_pictures.hpp"
#include "sim/solids/motion.hpp"
#include "sim/solids/shape.hpp"
#include "tool/picture/camera_path.hpp"
#include "tool/picture/display_mesh.hpp"
#include "tool/picture/drawn_solid.hpp"
#include "tool/picture/staging.hpp"
#include "tool/picture/subdivision.hpp"
#include "tool/picture/wire_colors.hpp"

namespace unravel::tool {

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

// A plane that faces straight up is drawn as the ground.
bool is_ground(const Solid& solid) {
    return solid.shape == Shape::plane && !solid.moves() &&
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
        const double reach = law_of(solid.shape).reach(solid);
        if (solid.shape != Shape::plane) lowest = std::min(lowest, solid.center.y() - reach);
    }
    // A hanging cloth may swing down to its own size below its highest point.
    double highest = -std::numeric_limits<double>::infinity(), size = 0;
    for (const Vec3& x : placement.x) highest = std::max(highest, x.y());
    for (const Cloth& cloth : scene.cloths) size = std::max({size, cloth.size[0], cloth.size[1]});
    return static_cast<float>(std::min(lowest, highest - 1.1 * size) - 0.02);
}

// Where everything starts, where solids move to, and where pins take their cloths.
void set_bounds(const Scene& scene, const ClothModel& model, const Placement& placement, DrawScene& out) {
    Vec3f low = placement.x.front().cast<float>(), high = low;
    const auto include = [&](const Vec3f& point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    };
    for (const Vec3& x : placement.x) include(x.cast<float>());
    const auto along = [&](bool moves, auto&& visit) {
        visit(0.0);
        if (!moves) return;
        for (int frame = 1; frame < scene.clip.frames(); ++frame) visit(frame_time(scene, frame));
    };
    for (const Solid& solid : scene.solids) {
        if (solid.shape == Shape::plane) continue;
        const Vec3f r = Vec3f::Constant(static_cast<float>(law_of(solid.shape).reach(solid)));
        along(solid.moves(), [&](double t) {
            const Vec3f c = solid_pose(solid, t).translation().cast<float>();
            include(c - r);
            include(c + r);
        });
    }
    for (std::size_t c = 0; c < model.cloths.size(); ++c) {
        const auto first = placement.x.begin() + static_cast<std::ptrdiff_t>(model.cloths[c].first);
        Vec3f from = first->cast<float>(), to = from;
        std::for_each_n(first, model.cloths[c].count(), [&](const Vec3& x) {
            from = from.cwiseMin(x.cast<float>());
            to = to.cwiseMax(x.cast<float>());
        });
        for (const Pin& pin : scene.cloths[c].pins)
            along(!pin.motion.empty() || (pin.carried.by && pin.carried.by->moves()), [&](double t) {
                const Vec3f moved = sample_motion(pin.motion, t).displacement.cast<float>();
                const Eigen::Isometry3f carried = carried_pose(pin.carried, t).cast<float>();
                include(carried * (from + moved));
                include(carried * (to + moved));
            });
    }
    // What falls or swings ends on the ground, or nearly.
    include({low.x(), out.ground_height, low.z()});
    out.bounds_low = low;
    out.bounds_high = high;
}

// Median rest length of the stretch springs.
float spacing_of(const ClothModel& model) {
    std::vector<double> rest(model.springs.stretch_count);
    for (std::size_t s = 0; s < rest.size(); ++s) rest[s] = model.springs.rest[s];
    if (rest.empty()) return DrawScene{}.spacing;
    const auto middle = rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2);
    std::nth_element(rest.begin(), middle, rest.end());
    return static_cast<float>(*middle);
}

}  // namespace

void check_textures(const Scene& scene, const std::filesystem::path& textures) {
    for (const NamedPicture& picture : look_pictures(scene.look)) read_png(textures / picture.file);
    DrawScene stage;
    set_stage(scene.look, textures, stage);
}

DrawScene make_draw_scene(const Scene& scene, const ClothModel& model, const Placement& placement,
                          const std::filesystem::path& textures) {
    DrawScene out;
    std::size_t first = model.size();
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
        const ClothPatch& patch = model.cloths[c];
        const int level = display_level(scene.look, patch);
        ClothMesh& mesh =
            out.cloths.emplace_back(patch.grid() ? grid_mesh(patch, level, first) : face_mesh(patch));
        mesh.appearance = appearance;
        if (level > 0) first += FineGrid(patch, level).size();
        if (!appearance.texture.empty() && !textures.empty())
            mesh.texture = read_png(textures / appearance.texture);
    }
    out.edges = drawn_edges(model, scene.look.show);
    out.transparent = scene.look.transparent;
    out.spacing = spacing_of(model);
    for (const Solid& solid : scene.solids) {
        if (is_ground(solid)) continue;
        SolidMesh& mesh = out.solids.emplace_back(drawn_solid(solid));
        mesh.color = parse_color(solid.color.empty() ? scene.look.solid : solid.color);
        set_surface(scene.look, static_cast<std::size_t>(&solid - scene.solids.data()), textures, mesh);
    }
    set_stage(scene.look, textures, out);
    out.ground_height = ground_height(scene, placement);
    set_bounds(scene, model, placement, out);
    return out;
}

std::vector<std::array<std::uint32_t, 2>> drawn_edges(const ClothModel& model, Show show) {
    std::vector<std::array<std::uint32_t, 2>> edges(drawn_springs(model, show));
    for (std::size_t s = 0; s < edges.size(); ++s) edges[s] = {model.springs.i[s], model.springs.j[s]};
    return edges;
}

namespace {

// Display vertices between particles follow the particles.
void add_fine_grids(const Scene& scene, const ClothModel& model, DrawFrame& out) {
    std::size_t first = model.size();
    for (const ClothPatch& patch : model.cloths) {
        const int level = display_level(scene.look, patch);
        if (level == 0) continue;
        FineGrid grid(patch, level);
        out.positions.resize(first + grid.size());
        out.particle_colors.resize(first + grid.size());
        grid.points(std::span(out.positions).first(model.size()), std::span(out.positions).subspan(first));
        grid.colors(std::span(out.particle_colors).first(model.size()),
                    std::span(out.particle_colors).subspan(first));
        first += grid.size();
    }
}

void pose_solids(const Scene& scene, double t, DrawFrame& out) {
    out.solid_poses.clear();
    out.solid_positions.clear();
    for (const Solid& solid : scene.solids) {
        if (is_ground(solid)) continue;
        out.solid_poses.push_back(solid_pose(solid, t).cast<float>());
        std::vector<Vec3f>& positions = out.solid_positions.emplace_back();
        if (!solid.geometry || !solid.geometry->deforms()) continue;
        std::vector<Vec3> now;
        solid.geometry->positions_at(t, now);
        for (const Vec3& x : now) positions.push_back(x.cast<float>());
    }
}

// Where a particle was at share s of the way from one frame to the next: Hermite's cubic through both places
// with both velocities, h apart.
Vec3 on_the_way(const ClothState& a, const ClothState& b, std::size_t p, double s, double h) {
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * a.x[p] + (s3 - 2 * s2 + s) * h * a.v[p] + (3 * s2 - 2 * s3) * b.x[p] +
           (s3 - s2) * h * b.v[p];
}

}  // namespace

double frame_time(const Scene& scene, int frame) {
    return scene.clip.fps.time_of(frame);
}

namespace {

void fill_frame(const Scene& scene, const ClothModel& model, const FrameRecord& record,
                const std::vector<Rgb>& components, DrawFrame& out) {
    out.positions.resize(model.size());
    for (std::size_t p = 0; p < model.size(); ++p) out.positions[p] = record.state.x[p].cast<float>();
    color_wires(scene.look, model, record, components, out);
    add_fine_grids(scene, model, out);
    pose_solids(scene, record.state.t, out);
}

}  // namespace

void make_draw_frame(const Scene& scene, const ClothModel& model, const DrawScene& drawn,
                     const FrameRecord& record, const std::vector<Rgb>& components, DrawFrame& out,
                     std::size_t camera) {
    fill_frame(scene, model, record, components, out);
    out.camera = camera_of_frame(scene, scene.cameras[camera], frame_time(scene, record.frame), model,
                                 out.positions, drawn);
}

std::vector<double> exposure_times(const Scene& scene, int frame, int count) {
    if (frame == 0 || count == 1) return {frame_time(scene, frame)};
    std::vector<double> times;
    for (int k = 0; k < count; ++k)
        times.push_back(frame_time(scene, frame) -
                        scene.look.shutter * scene.clip.fps.time_of(1) * (1 - (k + 0.5) / count));
    return times;
}

void make_exposures(const Scene& scene, const ClothModel& model, const FrameRecord& record,
                    const ClothState* previous, const std::vector<Rgb>& components, int count,
                    std::vector<DrawFrame>& out) {
    const std::vector<double> times = exposure_times(scene, previous ? record.frame : 0, count);
    out.resize(times.size());
    if (times.size() == 1) return fill_frame(scene, model, record, components, out[0]);
    // A frame that stands still, as on a turntable, was nowhere else.
    const double h = record.state.t - previous->t, pace = h > 0 ? 1 : 0;
    for (std::size_t e = 0; e < times.size(); ++e) {
        DrawFrame& frame = out[e];
        const double before = pace * (frame_time(scene, record.frame) - times[e]);
        const double s = h > 0 ? 1 - before / h : 1;
        frame.positions.resize(model.size());
        for (std::size_t p = 0; p < model.size(); ++p)
            frame.positions[p] = on_the_way(*previous, record.state, p, s, h).cast<float>();
        color_wires(scene.look, model, record, components, frame);
        add_fine_grids(scene, model, frame);
        pose_solids(scene, record.state.t - before, frame);
    }
}

}  // namespace unravel::tool
