#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/scene_file/document.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/scene_file/schema.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

const std::filesystem::path complete = UNRAVEL_SOURCE_DIR "/tests/scenes/complete.toml";

std::vector<std::filesystem::path> scenes() {
    std::vector<std::filesystem::path> out{complete};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(UNRAVEL_SOURCE_DIR "/scenes")) {
        // The table of hard cases names scenes, it is none; one of them is there to be refused. The meshes of
        // garments are made when they are needed.
        if (entry.path().parent_path().filename() == "garments") continue;
        const std::string name = entry.path().filename();
        if (entry.path().extension() == ".toml" && name != "cases.toml" && name != "inside.toml") {
            out.push_back(entry.path());
        }
    }
    return out;
}

/// Every key under a node as a path without numbers: "cloth.pin.release".
void keys_of(const Node& node, const std::string& path, std::set<std::string>& out) {
    for (const Node& item : node.items) keys_of(item, path, out);
    for (const Entry& entry : node.entries) {
        const std::string key = path.empty() ? entry.key : path + "." + entry.key;
        out.insert(key);
        keys_of(entry.value, key, out);
    }
}

/// The same of a schema.
void keys_of(const nlohmann::json& schema, const std::string& path, std::set<std::string>& out) {
    if (schema.contains("anyOf"))
        for (const auto& form : schema["anyOf"]) keys_of(form, path, out);
    if (schema.contains("items")) keys_of(schema["items"], path, out);
    if (!schema.contains("properties")) return;
    for (const auto& [name, property] : schema["properties"].items()) {
        const std::string key = path.empty() ? name : path + "." + name;
        out.insert(key);
        keys_of(property, key, out);
    }
}

std::set<std::string> keys_of(const std::string& toml) {
    Node root;
    std::vector<SceneProblem> problems;
    REQUIRE(parse_document(toml, root, problems));
    std::set<std::string> out;
    keys_of(root, "", out);
    return out;
}

}  // namespace

TEST_CASE("a written scene loads back to the same values", "[scene]") {
    for (const auto& file : scenes()) {
        INFO(file.filename());
        const std::string written = scene_to_toml(load_scene(file));
        const Scene again = parse_scene(written, file.filename(), file.parent_path());
        CHECK(scene_to_toml(again) == written);
    }
}

TEST_CASE("the complete scene has every key there is, and every key is written", "[scene]") {
    std::set<std::string> known;
    keys_of(scene_schema(), "", known);
    const Scene scene = load_scene(complete);
    CHECK(keys_of(scene.text) == known);
    // A run's folder holds copies of the files, and its scene names them from there.
    // What is taken over from others, what is repeated, and a path's interpolation stand where they act.
    for (const char* key :
         {"root", "include", "cloth.count", "cloth.spacing", "cloth.mirror", "solid.count", "solid.spacing",
          "solid.mirror", "solid.interpolation", "cloth.pin.interpolation"})
        known.erase(key);
    CHECK(keys_of(scene_to_toml(scene)) == known);
}

TEST_CASE("the complete scene's values arrive where they belong", "[scene]") {
    // Loaded from what was written, so that neither half can drop or swap a value.
    const Scene scene =
        parse_scene(scene_to_toml(load_scene(complete)), "complete.toml", complete.parent_path());
    CHECK(scene.gravity == Vec3(0.5, -8.5, 0.25));
    CHECK(scene.clip.size == std::array{640, 360});
    REQUIRE(scene.cloths.size() == 10);
    const Cloth& cloth = scene.cloths[0];
    CHECK(cloth.name == "sheet");
    CHECK(cloth.density == 0.31);
    CHECK(cloth.rotation == Vec3(10, 20, 30));
    CHECK(cloth.velocity == Vec3(0.1, -0.2, 0.3));
    CHECK(cloth.placed_scale == std::array{1.02, 0.97});
    CHECK(cloth.seed == 4294967295u);
    CHECK(cloth.material.preset == "denim");
    CHECK(cloth.material.stretch == std::array{1700.0, 2300.0});
    CHECK(cloth.material.shear_damping == 0.0031);
    CHECK(cloth.material.buckling_strain == 0.03);
    REQUIRE(cloth.regions.size() == 2);
    CHECK(cloth.regions[0].density == 0.8);
    CHECK(cloth.regions[0].material->shear == 99.5);
    CHECK(cloth.regions[0].material->bend == 1e-3);
    CHECK(cloth.regions[1].material->preset == "silk");
    CHECK(cloth.regions[1].density == 0.082);
    REQUIRE(cloth.pins.size() == 6);
    CHECK(cloth.pins[1].name == "u1v0");
    CHECK(cloth.pins[1].release == 0.75);
    REQUIRE(cloth.pins[2].motion.size() == 2);
    CHECK(cloth.pins[2].motion[1].time == 0.6);
    CHECK(cloth.pins[2].motion[1].position == Vec3(0.1, 0.2, 0.3));
    CHECK(cloth.pins[2].motion[1].rotation == Vec3(0, 45, 0));
    CHECK(cloth.pins[5].disc.radius == 0.06);
    CHECK(scene.cloths[1].wrap == Wrap::tube);
    REQUIRE(scene.solids.size() == 10);
    CHECK(scene.solids[3].frames.files == "tetra_##.obj");
    CHECK(scene.solids[3].frames.start == -0.5);
    CHECK(scene.solids[3].frames.loop);
    CHECK(scene.solids[3].mesh.merge == false);
    CHECK(scene.solids[3].mesh.holes == MeshHoles::cap);
    CHECK(scene.cloths[2].mesh.merge == true);
    CHECK(scene.cloths[2].mesh.group == "both halves");
    CHECK(scene.solids[4].mesh.shell == 0.02);
    CHECK(scene.solids[4].geometry->triangles.size() == 24);
    CHECK(scene.solids[3].geometry->samples.size() == 2);
    CHECK(scene.cloths[2].geometry->groups.at("left").size() == 2);
    CHECK(scene.cloths[2].sewing.stiffness == 120);
    CHECK(scene.cloths[2].pins[1].within.low == Vec3(-4, 1, -1));
    CHECK(scene.solids[0].size == Vec3(0.6, 0.05, 0.7));
    CHECK(scene.solids[0].round == 0.01);
    CHECK(scene.solids[0].offset == 0.006);
    CHECK(scene.solids[0].contact == SolidContact::surface);
    CHECK(scene.solids[0].color == "#123abc");
    CHECK(scene.solids[0].pivot == Vec3(0, 0.5, 0));
    CHECK(scene.solids[1].pivot == Vec3(3, 0.625, 0));
    CHECK(scene.solids[1].friction.kinetic == 0.8 * 0.6);
    CHECK(scene.solids[2].name == "capsule2");
    CHECK(scene.solver.step == 1.0 / 240);
    CHECK(scene.solver.max_iterations == 321);
    CHECK(!scene.solver.decompose);
    CHECK(scene.solver.bend == BendTreatment::explicit_);
    CHECK(scene.solver.adaptive->max_strain == 0.07);
    CHECK(scene.wind->keyframes[1].velocity == Vec3(3, 0, 0));
    CHECK(scene.wind->gust->seed == 9);
    CHECK(scene.self_collision->stiffness == 70);
    CHECK(scene.self_collision->method == ContactMethod::surface);
    CHECK(scene.self_collision->friction.kinetic == 0.25);
    REQUIRE(scene.cameras.size() == 2);
    CHECK(scene.cameras[0].orbit == 30);
    CHECK(scene.cameras[1].keyframes[1].position == Vec3(2, 2, 3));
    CHECK(scene.look.cloth[0].weave == Weave::twill);
    CHECK(scene.look.cloth[0].texture == "weave.png");
    CHECK(!scene.look.show_ground);
    CHECK(scene.look.ground_height == -0.25);
    CHECK(scene.clip.settle == 0.5);
    const Cloth& curtain = scene.cloths[3];
    CHECK(curtain.facing == Facing::front);
    CHECK(curtain.start->shape == StartShape::pleated);
    CHECK(curtain.start->from == "u1");
    CHECK(curtain.start->pleats == 3);
    CHECK(curtain.start->width == 0.6);
    CHECK(curtain.wrinkles->size == 0.3);
    CHECK(curtain.wrinkles->seed == 3);
    CHECK(curtain.pins[0].count == 4);
    CHECK(curtain.pins[0].gather == 0.5);
    CHECK(curtain.pins[0].gather_time == 0.4);
    CHECK(curtain.pins[0].to == "table");
    CHECK(curtain.pins[0].carried.by);
    CHECK(curtain.pins[0].slide == Vec3(1, 0, 0));
    CHECK(curtain.pins[0].motion[0].interpolation == Interpolation::ease);
    CHECK(curtain.pins[0].motion[1].interpolation == Interpolation::linear);
    CHECK(curtain.pins[1].rod == "rod");
    CHECK(scene.cloths[7].center == Vec3(-8, 3, 0));
    CHECK(scene.cloths[4].start->gap == 0.02);
    CHECK(scene.cloths[5].start->flat == 0.2);
    CHECK(scene.cloths[6].start->share == 0.4);
    CHECK(scene.solids[5].parent == "table");
    CHECK(scene.solids[5].motion[0].interpolation == Interpolation::linear);
    CHECK(scene.solids[5].motion[1].interpolation == Interpolation::hold);
    CHECK(scene.solids[6].fall->floor == 0.5);
    CHECK(scene.solids[6].fall->give == 0.1);
    CHECK(scene.solids[9].name == "rod mirrored");
    CHECK(scene.cameras[1].interpolation == Interpolation::hold);
}

TEST_CASE("names with quotes, backslashes and accents survive writing", "[scene]") {
    Scene scene = parse_scene("[cloth]\n", "a.toml");
    scene.cloths[0].name = "l'été \\ \"x\" # [y]";
    CHECK(parse_scene(scene_to_toml(scene), "a.toml").cloths[0].name == scene.cloths[0].name);
}
