// What is mended in a mesh, each with a note, and what polygons are cut into.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>
#include <set>

#include "sim/mesh/cut_polygon.hpp"
#include "sim/mesh/half_edges.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/mesh/repair.hpp"
#include "source_dir.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"

using namespace unravel;
using namespace unravel::sim;
using Catch::Contains;

namespace {

std::string mesh_file(const char* name) {
    return read_whole_text(std::string(UNRAVEL_SOURCE_DIR "/tests/meshes/") + name, 1 << 20);
}

// Twice the area of a piece as seen from z, positive where it turns left.
double twice_area(const std::vector<Vec3>& x, const Piece& piece) {
    double area = 0;
    const std::size_t count = piece[3] == no_index ? 3 : 4;
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 &a = x[piece[k]], &b = x[piece[(k + 1) % count]];
        area += a.x() * b.y() - a.y() * b.x();
    }
    return area;
}

double twice_area(const std::vector<Vec3>& x) {
    double area = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const Vec3 &a = x[k], &b = x[(k + 1) % x.size()];
        area += a.x() * b.y() - a.y() * b.x();
    }
    return area;
}

}  // namespace

TEST_CASE("a polygon's pieces fill it, and none is turned over", "[mesh]") {
    std::vector<std::vector<Vec3>> polygons;
    for (const std::size_t n : {3u, 4u, 5u, 6u, 12u, 200u}) {  // regular, and stars
        for (const double inner : {1.0, 0.5, 0.1}) {
            std::vector<Vec3> polygon;
            for (std::size_t k = 0; k < n; ++k) {
                const double angle = 2 * std::numbers::pi * double(k) / double(n), r = k % 2 ? inner : 1.0;
                polygon.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
            }
            polygons.push_back(std::move(polygon));
        }
    }
    // A comb, whose teeth hide one another, and a frame: a hole reached over a bridge that is run along
    // twice.
    std::vector<Vec3> comb{{0, 0, 0}, {9, 0, 0}};
    for (int k = 0; k < 9; ++k) {
        comb.emplace_back(9 - k, 3, 0);
        comb.emplace_back(8.5 - k, 1, 0);
    }
    polygons.push_back(comb);
    polygons.push_back({{0, 0, 0},
                        {4, 0, 0},
                        {4, 4, 0},
                        {0, 4, 0},
                        {0, 0, 0},
                        {1, 1, 0},
                        {1, 3, 0},
                        {3, 3, 0},
                        {3, 1, 0},
                        {1, 1, 0}});
    for (const std::vector<Vec3>& polygon : polygons) {
        CAPTURE(polygon.size());
        const std::vector<Piece> pieces = cut_polygon(polygon);
        double sum = 0;
        std::size_t triangles = 0;
        for (const Piece& piece : pieces) {
            CHECK(twice_area(polygon, piece) > 0);
            sum += twice_area(polygon, piece);
            triangles += piece[3] == no_index ? 1 : 2;
        }
        CHECK(triangles == polygon.size() - 2);
        CHECK(sum == Approx(twice_area(polygon)).epsilon(1e-12));
    }
    // A rectangle with corners along its sides is the quads that it was made of.
    const std::vector<Piece> quads =
        cut_polygon(std::vector<Vec3>{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {1, 0, 1}, {1, 0, 0}});
    REQUIRE(quads.size() == 2);
    CHECK((quads[0][3] != no_index && quads[1][3] != no_index));
}

TEST_CASE("a polygon that crosses itself is cut all the same", "[mesh]") {
    const std::vector<Piece> pieces =
        cut_polygon(std::vector<Vec3>{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}, {-1, 1, 0}});
    std::size_t triangles = 0;
    for (const Piece& piece : pieces) triangles += piece[3] == no_index ? 1 : 2;
    CHECK(triangles == 3);
    CHECK(cut_polygon(std::vector<Vec3>(7, Vec3(1, 1, 1))).size() == 5);
}

TEST_CASE("each file that can be read is, with a word for what was done", "[mesh][scene]") {
    struct Mended {
        const char* file;
        std::string keys;
        std::size_t vertices, faces;
        std::vector<std::string> notes;
    };
    const std::vector<Mended> all{
        {"contin.obj", "", 9, 4, {}},
        {"bom.obj", "", 9, 4, {}},
        {"attrs.obj",
         "",
         9,
         4,
         {"mesh.obj: passed over: lines of 'usemap', 'c_interp', 'lod', 'bevel', 'd_interp', 'maplib'"}},
        {"slash2.obj", "", 9, 4, {}},
        {"novn.obj", "", 9, 4, {}},
        {"fwd.obj", "", 9, 4, {}},
        {"ngon.obj",
         "",
         9,
         4,
         {"mesh.obj: 1 face of more than four corners or not convex: cut into triangles and quads"}},
        {"unref.obj", "", 9, 4, {"mesh.obj: 1 vertex belongs to no face: dropped"}},
        {"dup.obj", "mesh_merge = true\n", 9, 4, {"mesh.obj: 1 vertex lies on another: merged"}},
        {"dup.obj", "mesh_merge = false\n", 10, 4, {}},
        {"degen.obj", "", 9, 4, {"mesh.obj: 1 face has no area: dropped"}},
    };
    for (const Mended& mended : all) {
        INFO(mended.file);
        const testing::MeshScene made("[cloth]\nmesh = \"mesh.obj\"\n" + mended.keys, mesh_file(mended.file));
        CHECK(made.scene.cloths[0].geometry->rest.size() == mended.vertices);
        CHECK(made.scene.cloths[0].geometry->faces.size() == mended.faces);
        CHECK(made.scene.notes == mended.notes);
        CHECK(scene_to_toml(parse_scene(scene_to_toml(made.scene), "scene.toml", made.folder.path())) ==
              scene_to_toml(made.scene));
    }
    CHECK_THROWS_WITH(testing::MeshScene("[cloth]\nmesh = \"mesh.obj\"\n", mesh_file("dup.obj")),
                      Contains("vertex 10 lies on vertex 5 (line 5); mesh_merge = true makes them one"));
}

TEST_CASE("bodies are turned outward and their holes closed", "[mesh][scene]") {
    const std::string far = "[cloth]\ncenter = [9, 9, 9]\n[[solid]]\nshape = \"mesh\"\nmesh = \"mesh.obj\"\n";
    const auto body = [&](const char* file, const std::string& keys = "") {
        return testing::MeshScene(far + keys, mesh_file(file));
    };
    const testing::MeshScene cube = body("cube.obj"), inward = body("cube_in.obj"),
                             capped = body("cube_open.obj", "mesh_holes = \"cap\"\n");
    CHECK(cube.scene.notes.empty());
    CHECK(inward.scene.notes == std::vector<std::string>{"mesh.obj: the faces look inward: all turned"});
    CHECK(capped.scene.notes == std::vector<std::string>{"mesh.obj: 1 hole of 4 edges: closed"});
    for (const testing::MeshScene* made : {&cube, &inward, &capped}) {
        const MeshSolid& solid = *made->scene.solids[0].geometry;
        CHECK(solid.triangles.size() == 12);
        CHECK(solid.tree.nearest({0, 0.5, 0}, 9).distance == Approx(-0.5));
        CHECK(solid.tree.nearest({0, -0.25, 0}, 9).distance == Approx(0.25));
    }
    CHECK_THROWS_WITH(body("cube_open.obj"), Contains("mesh.obj: the body is open: 1 hole of 4 edges; "
                                                      "mesh_holes = \"cap\" closes them"));
    // A shell has an inside of its own, and none where the box is.
    const testing::MeshScene shell = body("cube_open.obj", "mesh_shell = 0.1\n");
    const MeshSolid& solid = *shell.scene.solids[0].geometry;
    CHECK(solid.triangles.size() == 2 * 10 + 2 * 4);
    const double inside = solid.tree.nearest({0, 1, 0}, 9).distance;  // corners go out along slanted normals
    CHECK((inside < -0.03 && inside > -0.05));
    CHECK(solid.tree.nearest({0, 0.5, 0}, 9).distance > 0.3);
}

TEST_CASE("neighbours that face opposite ways are turned alike, the fewest of them", "[mesh]") {
    MeshMessages said;
    PolygonMesh mesh;
    for (int k = 0; k <= 6; ++k) {
        mesh.positions.emplace_back(k, 0, 0);
        mesh.positions.emplace_back(k, 1, 0);
    }
    for (std::uint32_t k = 0; k < 6; ++k) {
        PolygonMesh::Face face{4, {2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1}, {k, k, k, k}};
        if (k == 2 || k == 5) std::reverse(face.vertex.begin(), face.vertex.end());
        mesh.add_face(face, 0, k, 0);
    }
    finish_numbering(mesh);
    turn_alike(mesh, said);
    REQUIRE(said.notes.size() == 1);
    CHECK_THAT(said.notes[0], Contains("2 faces look the other way than the neighbours: turned"));
    for (const PolygonMesh::Face& face : mesh.faces) {
        const Vec3 a = mesh.positions[face.vertex[1]] - mesh.positions[face.vertex[0]],
                   b = mesh.positions[face.vertex[2]] - mesh.positions[face.vertex[0]];
        CHECK(a.cross(b).z() > 0);
    }
}

TEST_CASE("a part of a file is its faces and their vertices, in the file's order", "[mesh][scene]") {
    const std::string two =
        "o shirt\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 4 3 2\n"
        "o skirt\ng left side\nv 3 0 0\nv 4 0 0\nv 4 0 1\nv 3 0 1\nf 5 8 7 6\n";
    const testing::MeshScene skirt("[cloth]\nmesh = \"mesh.obj\"\nmesh_object = \"skirt\"\n", two);
    const MeshCloth& mesh = *skirt.scene.cloths[0].geometry;
    REQUIRE(mesh.rest.size() == 4);
    CHECK(mesh.rest[0].x() == 3);
    CHECK(mesh.groups.at("left side").size() == 4);
    CHECK(skirt.scene.notes.empty());
    CHECK_NOTHROW(testing::MeshScene("[cloth]\nmesh = \"mesh.obj\"\nmesh_group = \"left side\"\n", two));
    CHECK_THROWS_WITH(testing::MeshScene("[cloth]\nmesh = \"mesh.obj\"\nmesh_object = \"shrit\"\n", two),
                      Contains("mesh.obj has no object \"shrit\"; did you mean \"shirt\"?"));
}

TEST_CASE("a scene's files may lie in a root that it names", "[mesh][scene]") {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "scenes");
    std::filesystem::create_directories(folder.path() / "assets/cloth");
    write_whole_file(folder.path() / "assets/cloth/sheet.obj", std::string_view(testing::sheet_obj(2)));
    const std::string cloth = "[cloth]\nmesh = \"cloth/sheet.obj\"\n";
    const Scene scene = parse_scene("root = \"../assets\"\n" + cloth, "scene.toml", folder.path() / "scenes");
    CHECK(scene.cloths[0].geometry->rest.size() == 9);
    CHECK_THROWS_WITH(parse_scene("root = \"../asets\"\n" + cloth, "scene.toml", folder.path() / "scenes"),
                      Contains("no folder \"../asets\""));
}

TEST_CASE("a cloth of a wrong unit is asked about", "[mesh][scene]") {
    const testing::MeshScene huge("[cloth]\nmesh = \"mesh.obj\"\nmesh_scale = 1000\n", testing::sheet_obj(2));
    REQUIRE(huge.scene.notes.size() == 1);
    CHECK(huge.scene.notes[0] ==
          "mesh.obj: the cloth is 1e+03 m wide: is that meant? With mesh_scale = 1 it is 1 m");
}

TEST_CASE("borders are loops, the longest first", "[mesh]") {
    // A band of 12 by 1 quads round a tube, with one quad missing from a second row.
    std::vector<PolygonMesh::Face> faces;
    const auto at = [](std::uint32_t i, std::uint32_t j) { return j * 12 + i % 12; };
    for (std::uint32_t j = 0; j < 3; ++j) {
        for (std::uint32_t i = 0; i < 12; ++i) {
            if (j == 1 && i == 4) continue;
            faces.push_back({4, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, {}});
        }
    }
    CHECK(holes_text(border_loops(faces)) == "3 holes of 12, 12, 4 edges");
}
