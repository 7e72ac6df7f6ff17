// The distance to a mesh against bodies whose distance is known, and cloth on meshes that stand, move and
// deform.

#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "base/whole_file.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/mesh/pc2.hpp"
#include "sim/run/simulate.hpp"
#include "sim/solids/sdf.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

std::string box_obj(double half) {
    std::string out;
    for (int k = 0; k < 8; ++k)
        out += fmt::format("v {} {} {}\n", k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half);
    return out + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

Scene on_body(const TemporaryFolder& folder, const std::string& obj, const std::string& extra) {
    write_whole_file(folder.path() / "body.obj", std::string_view(obj));
    return parse_scene(
        "[cloth]\nparticles = [17, 17]\nsize = [0.5, 0.5]\ncenter = [0, 0.23, 0]\n[clip]\nfps = 20\n"
        "[[solid]]\nshape = \"mesh\"\nmesh = \"body.obj\"\n" +
            extra,
        "scene.toml", folder.path());
}

}  // namespace

TEST_CASE("the distance to a box of triangles is the box's", "[mesh][solid]") {
    const TemporaryFolder folder;
    const Scene scene = on_body(folder, box_obj(0.2), "");
    const Solid& mesh = scene.solids[0];
    Solid box;
    box.shape = Shape::box;
    box.size = {0.4, 0.4, 0.4};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
    for (int k = 0; k < 20'000; ++k) {
        Vec3 p(anywhere(random), anywhere(random), anywhere(random));
        if (k % 3 == 0) p *= 0.39;                   // inside
        if (k % 7 == 0) p.x() = p.y();               // nearest to an edge
        if (k % 11 == 0) p = Vec3::Constant(p.x());  // to a corner
        if (k % 5 == 0) p.y() = 0.2;                 // in the plane of a face
        Vec3 a, b;
        const double here = signed_distance(mesh, p, &a), there = signed_distance(box, p, &b);
        REQUIRE(here == Approx(there).margin(1e-12));
        REQUIRE(a.norm() == Approx(1));
        // On the way to the surface the distance is the way.
        if (std::abs(here) > 1e-6) REQUIRE(std::abs(signed_distance(mesh, p - here * a)) < 1e-9);
    }
}

TEST_CASE("cloth lies on a mesh, also on one that moves or deforms, and never in it", "[mesh][solid]") {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> cache = pc2_header({8, 0, 1, 11});
    // The box's top rises by a tenth of a metre within the half second that the samples cover.
    for (int sample = 0; sample < 11; ++sample) {
        for (int k = 0; k < 8; ++k) {
            const float rise = k & 2 ? 0.01f * static_cast<float>(sample) : 0.0f;
            for (const float value :
                 {k & 1 ? 0.2f : -0.2f, (k & 2 ? 0.2f : -0.2f) + rise, k & 4 ? 0.2f : -0.2f}) {
                std::uint8_t bytes[4];
                std::memcpy(bytes, &value, 4);
                cache.insert(cache.end(), bytes, bytes + 4);
            }
        }
    }
    write_whole_file(folder.path() / "body.pc2", cache);
    const std::vector<std::pair<std::string, double>> bodies{
        {"", 0.204},
        {"motion = [{time = 0}, {time = 0.5, position = [0, 0.1, 0]}]\n", 0.304},
        {"mesh_frames = \"body.pc2\"\nmesh_fps = 20\n", 0.304}};
    for (const auto& [extra, height] : bodies) {
        INFO(extra);
        Simulation simulation = start_simulation(on_body(folder, box_obj(0.2), extra));
        for (int frame = 0; frame < 16; ++frame) next_record(simulation);
        const Vec3 middle = simulation.state.x[17 * 8 + 8];
        CHECK(middle.y() == Approx(height).margin(0.002));
        std::vector<Vec3> body;
        const Solid& solid = simulation.model.solids[0];
        solid.geometry->positions_at(simulation.state.t, body);
        MeshTree tree = solid.geometry->tree;
        tree.refit(body);
        const Pose pose = solid_pose(solid, simulation.state.t);
        for (const Vec3& x : simulation.state.x)
            REQUIRE(tree.nearest(pose.inverse() * x, 1.0).distance > -1e-6);
    }
}

TEST_CASE("samples that do not fit their mesh are refused", "[mesh][solid]") {
    std::vector<std::vector<Vec3>> out;
    Pc2Header header;
    std::vector<std::uint8_t> bytes = pc2_header({8, 0, 1, 2});
    CHECK(read_pc2(bytes, 8, 1000, header, out) == "it ends before its 2 samples do");
    bytes.resize(bytes.size() + 2 * 8 * 12);
    CHECK(read_pc2(bytes, 8, 1000, header, out).empty());
    CHECK(out.size() == 2);
    CHECK(read_pc2(bytes, 9, 1000, header, out) == "it has 8 points, the mesh 9 vertices");
    CHECK(read_pc2(bytes, 8, 100, header, out) == "2 samples of 8 points are more than a run can hold");
    bytes[0] = 'X';
    CHECK(read_pc2(bytes, 8, 1000, header, out) == "it is no PC2 file");
}
