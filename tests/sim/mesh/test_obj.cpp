// OBJ files as they are: exact numbers, topology kept, groups, and a message for everything that is wrong.

#include <algorithm>
#include <catch2/catch.hpp>

#include "sim/mesh/check_mesh.hpp"
#include "sim/mesh/obj.hpp"
#include "sim/mesh/repair.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// As the loader takes a mesh: mended, but for what only a scene asks for.
MeshMessages said_of(const std::string& text, bool solid = false) {
    MeshMessages said;
    PolygonMesh mesh = parse_obj(text, said);
    if (!said.faults.empty()) return said;
    drop_flat_faces(mesh, said);
    drop_unused_vertices(mesh, said);
    turn_alike(mesh, said);
    solid ? check_solid_mesh(mesh, true, said) : check_cloth_mesh(mesh, false, said);
    return said;
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("an OBJ is read as it is written", "[mesh]") {
    MeshMessages said;
    const PolygonMesh mesh = parse_obj(
        "# comment\nmtllib a.mtl\no shirt\nv 0.1 -2e-3 +3 1.0\r\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 0.25 1\nvn 0 0 1\ng collar left\nf 1/1/1 2/2/1 3//1 4\ns off\ng\nf -4 -3 -2\n"
        "l 1 2 4\ng hem\np 3 2 3\n",
        said);
    REQUIRE(said.faults.empty());
    REQUIRE(said.notes.empty());
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
        {square + "v 1 1 0\nf 1 2 4\nf 2 3 4\nf 5 4 2\n", 5, "vertex 5 lies on vertex 3 (line 3)"},
        {square + "v 1.000001 1 0\nf 1 2 4\nf 2 3 4\nf 5 4 2\n", 5, "vertex 5 lies on vertex 3 (line 3)"},
        {square + "v 0 0 1\nf 1 2 3\nf 1 3 4\nf 5 1 3\n", 8,
         "the edge from vertex 1 to 3 belongs to 3 faces (1, 2, 3)"},
        {square + "f 1 2 3 4\n", 0, "the body is open: 1 hole of 4 edges", true},
        // A Möbius strip of five triangles.
        {square + "v 2 2 1\nf 1 2 3\nf 2 3 4\nf 3 4 5\nf 4 5 1\nf 5 1 2\n", 10,
         "faces 1 (line 6) and 5 face opposite ways across the edge from vertex 1 to 2"},
        {square + "f 1 2 3 4\nstitch 0 1 9 0.7\n", 6, "there is no vertex 9"},
    };
    for (const Broken& broken : all) {
        INFO(broken.text);
        const std::vector<MeshFault> faults = said_of(broken.text, broken.solid).faults;
        REQUIRE(!faults.empty());
        CHECK(faults[0].line == broken.line);
        CHECK(faults[0].what == broken.what);
    }
    CHECK(said_of(square + "f 1 2 3 4\n").faults.empty());
}

TEST_CASE("an OBJ is read however its lines are written", "[mesh]") {
    MeshMessages said;
    const auto faces = [&](const std::string& text) {
        said = {};
        const PolygonMesh mesh = parse_obj(text, said);
        INFO(text);
        CHECK(said.faults.empty());
        return mesh.faces.size();
    };
    CHECK(faces("\xEF\xBB\xBF" + square + "f 1 2 3 4\n") == 1);
    CHECK(faces("f 1 2 3 4\n" + square) == 1);
    CHECK(faces(square + "f 1 2 \\\n  3 \\\r\n4\nf 1 2 3") == 2);
    std::string old_line_ends = square + "f 1 2 3 4\n";
    std::replace(old_line_ends.begin(), old_line_ends.end(), '\n', '\r');
    CHECK(faces(old_line_ends) == 1);
    CHECK(faces(square + "f 1// 2// 3// 4//\nf 1//7 2//8 3//9\nf 1/ 2/ 3/\n") == 3);
    CHECK(said.notes.empty());
    CHECK(faces(square + "usemap x\nlod 1\nusemap y\ncstype bezier\nf 1 2 3 4\n") == 1);
    CHECK(said.notes == std::vector<std::string>{"passed over: lines of 'usemap', 'lod', 'cstype'"});

    // Lines are counted as in the file.
    said = {};
    parse_obj(square + "f 1 \\\n2 3\nf 1 2 99\n", said);
    REQUIRE(said.faults.size() == 1);
    CHECK(said.faults[0].line == 7);

    said = {};
    const PolygonMesh named = parse_obj(square + "g left sleeve\nf 1 2 3\no cape\nf 1 3 4\n", said);
    CHECK(named.groups.at("left sleeve") == std::vector<std::uint32_t>{0, 1, 2, 3});
    CHECK(named.groups.at("cape") == std::vector<std::uint32_t>{0, 2, 3});
    CHECK(named.parts[named.face_part[0]].objects.empty());
    CHECK(named.parts[named.face_part[1]].objects == std::vector<std::string>{"cape"});

    // Codim-IPC's stitches: a vertex to a point between two others, counted from 0.
    said = {};
    const PolygonMesh sewn = parse_obj(square + "f 1 2 3\nstitch 3 0 1 0.2\nstitch 3 0 1 0.8\n", said);
    CHECK(sewn.lines == std::vector<std::array<std::uint32_t, 2>>{{3, 0}, {3, 1}});
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
    CHECK_THAT(problems("[cloth]\nmesh = \"mesh.obj\"\n", sheet + "f 1 2 99\n"),
               Contains("scene.toml:2:8: error: mesh.obj:42: there is no vertex 99; the file has 16"));
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
