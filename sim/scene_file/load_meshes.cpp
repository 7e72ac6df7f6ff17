// The meshes of a scene: read, mended, checked, and tied to the scene by their hash.

#include <fmt/format.h>

#include <cmath>

#include "sim/mesh/check_mesh.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/placement.hpp"
#include "sim/mesh/repair.hpp"
#include "sim/scene_file/check.hpp"
#include "sim/scene_file/mesh_files.hpp"

namespace unravel::sim {

namespace {

constexpr std::uint64_t no_bytes_yet = 14695981039346656037ull;  // what hashes start from

// Holes of up to this share of a body's surface are closed without being asked for.
constexpr double small_hole = 0.01;

// A cloth wider than the first, or narrower than the second, is more often a wrong unit than meant. [m]
constexpr double widest_cloth = 30, narrowest_cloth = 0.01;

void ask_about_size(const MeshFiles& files, const Cloth& cloth) {
    const double width = cloth.geometry->extent().maxCoeff();
    if (width >= narrowest_cloth && width <= widest_cloth) return;
    // What most files are in: centimetres, millimetres or inches of something between hanky and tent.
    double scale = cloth.mesh.scale;
    for (const double unit : {0.01, 0.001, 0.0254, 100.0, 1000.0}) {
        if (width * unit < 0.2 || width * unit > 5) continue;
        scale *= unit;
        break;
    }
    files.note(fmt::format("{}: the cloth is {:.3g} m wide: is that meant?{}", cloth.mesh.file, width,
                           scale != cloth.mesh.scale ? fmt::format(" With mesh_scale = {:g} it is {:.3g} m",
                                                                   scale, width * scale / cloth.mesh.scale)
                                                     : ""));
}

void check_group(const MeshFiles& files, const Cloth& cloth, const std::string& path,
                 const std::string& group) {
    const auto& groups = cloth.geometry->groups;
    if (groups.contains(group)) return;
    std::vector<std::string_view> names;
    for (const auto& [name, vertices] : groups) names.push_back(name);
    files.problem(path, fmt::format("the mesh has no group \"{}\"", group),
                  MeshFiles::other_names(group, std::move(names), "the mesh has no groups (g lines)"));
}

void check_groups(const MeshFiles& files, const Cloth& cloth, const std::string& path) {
    for (std::size_t k = 0; k < cloth.regions.size(); ++k) {
        if (!cloth.regions[k].group.empty())
            check_group(files, cloth, fmt::format("{}.region[{}].group", path, k), cloth.regions[k].group);
    }
    for (std::size_t k = 0; k < cloth.pins.size(); ++k) {
        const Pin& pin = cloth.pins[k];
        const std::string at = fmt::format("{}.pin[{}].", path, k);
        if (pin.target == PinTarget::group) check_group(files, cloth, at + "group", pin.group);
        if (pin.target == PinTarget::within && files.places().sound(at + "within") &&
            pinned_particles(cloth, pin).empty())
            files.problem(at + "within", "the pin catches no particle", "no vertex starts in this box");
    }
}

void load_mesh(const MeshFiles& files, Cloth& cloth, const std::string& path) {
    std::uint64_t hash = no_bytes_yet;
    const bool apart = cloth.mesh.merge == false;
    std::shared_ptr<const Figure> none;
    std::optional<PolygonMesh> mesh = files.read_mesh(
        cloth.mesh, path + ".mesh", cloth.mesh.merge.value_or(false), hash,
        [&](PolygonMesh& one, MeshMessages& said) { check_cloth_mesh(one, apart, said); }, {}, none);
    if (!mesh || !files.tie(cloth.mesh, path, hash)) return;
    cloth.geometry =
        std::make_shared<MeshCloth>(make_mesh_cloth(std::move(*mesh), cloth.mesh.scale, cloth.mesh.up));
    cloth.particles = {static_cast<int>(cloth.geometry->rest.size()), 1};
    const Vec3 extent = cloth.geometry->extent();
    cloth.size = {extent.maxCoeff(), extent.sum() - extent.maxCoeff() - extent.minCoeff()};
    ask_about_size(files, cloth);
    check_groups(files, cloth, path);
}

void load_mesh(const MeshFiles& files, Solid& solid, const std::string& path) {
    std::uint64_t hash = no_bytes_yet;
    const MeshFile& file = solid.mesh;
    const bool solid_body = file.shell == 0;
    std::shared_ptr<const Figure> figure;
    std::optional<PolygonMesh> mesh = files.read_mesh(
        file, path + ".mesh", file.merge.value_or(true), hash,
        [&](PolygonMesh& one, MeshMessages& said) {
            if (solid_body) {
                cap_holes(one, file.holes == MeshHoles::cap ? HUGE_VAL : small_hole, said);
                turn_outward(one, said);
            }
            check_solid_mesh(one, solid_body, said);
        },
        solid.frames.animation, figure);
    if (!mesh) return;
    MeshSolid body;
    if (!solid.frames.files.empty()) {
        files.read_samples(solid.frames.files, path + ".mesh_frames", mesh->file_vertices, body, hash);
        if (!body.deforms()) return;
    }
    if (!files.tie(solid.mesh, path, hash)) return;
    finish_solid(body, std::move(*mesh), file, solid.frames, std::move(figure));
    solid.geometry = std::make_shared<MeshSolid>(std::move(body));
}

}  // namespace

void load_meshes(Scene& scene, const Places& places, std::vector<SceneProblem>& problems) {
    const MeshFiles files(scene, places, problems);
    const auto load = [&](auto& things, const char* kind) {
        for (std::size_t i = 0; i < things.size(); ++i) {
            const std::string path = fmt::format("{}[{}]", kind, i);
            if (!things[i].mesh.file.empty() && places.sound(path + ".mesh"))
                load_mesh(files, things[i], path);
        }
    };
    load(scene.cloths, "cloth");
    load(scene.solids, "solid");
}

}  // namespace unravel::sim
