// OBJ files as they are: exact numbers, topology kept, groups, and a message for everything that is wrong.

#include <catch2/catch.hpp>

#include "sim/mesh/check_mesh.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

std::vector<MeshFault> faults_of(const std::string& text, bool solid = false) {
    std::vector<MeshFault> faults;
    const ObjMesh mesh = parse_obj(text, faults);
    if (faults.empty()) solid ? check_solid_mesh(mesh, faults) : check_cloth_mesh(mesh, faults);
    return faults;
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("an OBJ is read as it is written", "[mesh]") {
    std::vector<MeshFault> faults;
    const ObjMesh mesh = parse_obj(
        "# comment\nmtllib a.mtl\no shirt\nv 0.1 -2e-3 +3 1.0\r\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 0.25 1\nvn 0 0 1\ng collar left\nf 1/1/1 2/2/1 3//1 4\ns off\ng\nf -4 -3 -2\n"
        "l 1 2 4\ng hem\np 3 2 3\n",
        faults);
    REQUIRE(faults.empty());
    REQUIRE(mesh.positions.size() == 4);
    CHECK(mesh.positions[0] == Vec3(0.1, -2e-3, 3));
    REQUIRE(mesh.faces.size() == 2);
    CHECK(mesh.faces[0].corners == 4);
    CHECK(mesh.faces[0].vertex == std::array<std::uint32_t, 4>{0, 1, 2, 3});
    CHECK(mesh.faces[0].uv == std::array<std::uint32_t, 4>{0, 1, no_index, no_index});
    CHECK(mesh.faces[1].corners == 3);
    CHECK(mesh.faces[1].vertex[2] == 2);
    CHECK(mesh.face_line == std::vector<int>{12, 15});
    CHECK(mesh.lines == std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {1, 3}});
    CHECK(mesh.groups.at("collar") == std::vector<std::uint32_t>{0, 1, 2, 3});
    CHECK(mesh.groups.at("left").size() == 4);
    CHECK(mesh.groups.at("hem") == std::vector<std::uint32_t>{1, 2});
    CHECK(mesh.groups.at("shirt").size() == 4);
}

TEST_CASE("a broken mesh of each kind gets its message", "[mesh]") {
    struct Broken {
        std::string text;
        int line;
        std::string what;
        bool solid = false;
    };
    const std::vector<Broken> all{
        {"", 0, "the mesh has no faces"},
        {"v 0 0 0\nv 1 0\n", 2, "a coordinate is missing"},
        {"v 0 0 nan\n", 1, "'nan' is no coordinate"},
        {"v 0 0 1x\n", 1, "'1x' is no coordinate"},
        {"v 0 0 1e300\n", 1, "'1e300' is no coordinate"},
        {square + "f 1 2 5\n", 5, "there is no vertex 5"},
        {square + "f 1 2 -5\n", 5, "there is no vertex -5"},
        {square + "f 1 2 0\n", 5, "'0' is no vertex number"},
        {square + "f 1/1 2/1 3/1\n", 5, "there is no texture vertex 1"},
        {square + "f 1//2 2 3\n", 5, "there is no normal 2"},
        {square + "f 1 2\n", 5, "face 1 has 2 corners"},
        {square + "v 0 2 0\nf 1 2 3 4 5\n", 6, "face 1 has 5 corners"},
        {square + "cstype bezier\n", 5, "'cstype' begins no line of a polygon mesh"},
        {square + "v 3 0 0\nf 1 2 3 4\n", 5, "vertex 5 belongs to no face"},
        {square + "v 1 1 0\nf 1 2 4\nf 2 3 4\nf 5 4 2\n", 5, "vertex 5 lies on vertex 3 (line 3)"},
        {square + "v 1.000001 1 0\nf 1 2 4\nf 2 3 4\nf 5 4 2\n", 5, "vertex 5 lies on vertex 3 (line 3)"},
        {square + "f 1 2 2\n", 5, "face 1 names a vertex twice (1, 2, 2)"},
        {square + "v 2 0 0\nf 1 2 3 4\nf 1 2 5\n", 7, "face 2 has no area (vertices 1, 2, 5)"},
        {square + "f 1 2 3\nf 1 3 4\nf 4 1 3\n", 7,
         "the edge from vertex 1 to 3 belongs to 3 faces (1, 2, 3)"},
        {square + "f 1 2 3\nf 1 4 3\n", 6,
         "faces 1 (line 5) and 2 face opposite ways across the edge from vertex 1 to 3"},
        {square + "f 1 2 3\n", 4, "vertex 4 belongs to no face"},
        {square + "f 1 2 3 4\n", 5, "the edge from vertex 1 to 2 is open: only face 1 is there", true},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n", 5,
         "the faces look inward", true},
    };
    for (const Broken& broken : all) {
        INFO(broken.text);
        const std::vector<MeshFault> faults = faults_of(broken.text, broken.solid);
        REQUIRE(!faults.empty());
        CHECK(faults[0].line == broken.line);
        CHECK(faults[0].what == broken.what);
    }
    CHECK(faults_of(square + "f 1 2 3 4\n").empty());
}

TEST_CASE("a scene names its mesh's faults, and what refers to what is not there", "[mesh][scene]") {
    const auto problems = [](const std::string& toml, const std::string& obj) {
        try {
            testing::MeshScene made(toml, obj);
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    using Catch::Contains;
    const std::string sheet = testing::sheet_obj(3);
    CHECK(problems("[cloth]\nmesh = \"mesh.obj\"\n", sheet).empty());
    CHECK_THAT(problems("[cloth]\nmesh = \"mesh.obj\"\n", sheet + "v 9 9 9\n"),
               Contains("scene.toml:2:8: error: mesh.obj:42: vertex 17 belongs to no face; remove it"));
    CHECK_THAT(problems("[cloth]\nmesh = \"none.obj\"\n", sheet), Contains("no file \"none.obj\""));
    CHECK_THAT(problems("[cloth]\nmesh = \"../mesh.obj\"\n", sheet), Contains("outside the scene's folder"));
    CHECK_THAT(problems("[cloth]\nmesh = \"mesh.obj\"\nparticles = [3, 3]\n", sheet),
               Contains("'particles' does not belong here"));
    CHECK_THAT(problems("[cloth]\nmesh = \"mesh.obj\"\n[[cloth.pin]]\ngroup = \"wast\"\n",
                        sheet + "g waist\np 1 2\n"),
               Contains("the mesh has no group \"wast\"; did you mean \"waist\"?"));
    CHECK_THAT(problems("[cloth]\nmesh = \"mesh.obj\"\n[[cloth.pin]]\ncorner = \"u0v0\"\n", sheet),
               Contains("a pin by 'corner' of a mesh; say group or within"));
    CHECK_THAT(problems("[cloth]\n[[cloth.pin]]\ngroup = \"waist\"\n", sheet),
               Contains("a pin by 'group' of a grid"));
    CHECK_THAT(problems("[cloth]\nmesh = \"mesh.obj\"\n[[cloth.pin]]\nwithin = [5, 5, 5, 6, 6, 6]\n", sheet),
               Contains("the pin catches no particle"));
    CHECK_THAT(problems("[cloth]\nmesh = \"mesh.obj\"\nmesh_hash = \"0123456789abcdef\"\n", sheet),
               Contains("the mesh \"mesh.obj\" has changed"));
    CHECK_THAT(problems("[cloth]\n[[solid]]\nshape = \"mesh\"\n", sheet), Contains("a mesh without a file"));
}

TEST_CASE("a scene with meshes is written and read back the same, tied to their content", "[mesh][scene]") {
    const testing::MeshScene made(
        "[cloth]\nmesh = \"mesh.obj\"\nmesh_scale = 0.5\nmesh_up = \"z\"\ncenter = [0, 1, 0]\n"
        "sewing = {time = 0.25}\n[[cloth.pin]]\nwithin = [-9, -9, -9, 9, 9, 9]\n",
        testing::sheet_obj(3));
    const std::string text = scene_to_toml(made.scene);
    CHECK_THAT(text, Catch::Contains("mesh_hash = \""));
    const Scene again = parse_scene(text, "scene.toml", made.folder.path());
    CHECK(scene_to_toml(again) == text);
    CHECK(again.cloths[0].sewing.time == 0.25);
    // z up: the file's y axis points away from the viewer.
    CHECK(made.scene.cloths[0].size[0] == Approx(0.5));
}
