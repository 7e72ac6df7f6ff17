// PLY, STL and glTF give the mesh that the same body gives as OBJ; a figure's animation is what glTF says.

#include <Eigen/Geometry>
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sim/mesh/gltf.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/mesh/ply.hpp"
#include "sim/mesh/read_mesh.hpp"
#include "sim/mesh/stl.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"

using namespace unravel;
using namespace unravel::sim;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

template <class T>
void put(std::string& out, T value, bool big_endian = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof value);
    if (big_endian) std::reverse(raw, raw + sizeof value);
    out.append(raw, sizeof value);
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// A box of corners (±1, 0 or 1, ±1), its faces outward.
const std::vector<Vec3> box{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1},
                            {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}};
const std::vector<std::array<int, 4>> sides{{4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2},
                                            {2, 6, 7, 3}, {3, 7, 4, 0}, {0, 1, 2, 3}};

std::string box_ply(const char* format) {
    std::string out = fmt::format(
        "ply\nformat {} 1.0\ncomment made by hand\nelement vertex 8\nproperty float x\nproperty uchar red\n"
        "property float y\nproperty float z\nproperty list uchar int odd\nelement face 6\n"
        "property uchar flags\nproperty list uchar int vertex_indices\nend_header\n",
        format);
    const bool text = std::string(format) == "ascii", big = std::string(format) == "binary_big_endian";
    const auto number = [&](auto value) {
        text ? out += fmt::format("{} ", static_cast<double>(value)) : (put(out, value, big), out);
    };
    for (const Vec3& x : box) {
        number(static_cast<float>(x.x()));
        number(std::uint8_t{200});
        number(static_cast<float>(x.y()));
        number(static_cast<float>(x.z()));
        number(std::uint8_t{2});
        number(7);
        number(9);
        if (text) out += '\n';
    }
    for (const auto& side : sides) {
        number(std::uint8_t{0});
        number(std::uint8_t{4});
        for (const int v : side) number(v);
        if (text) out += '\n';
    }
    return out;
}

std::string box_stl(bool text) {
    std::string out = text ? "solid box\n" : std::string(80, 's');
    if (!text) put(out, std::uint32_t{12});
    for (const auto& side : sides) {
        for (const auto& three : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
            if (text) out += "facet normal 0 0 0\nouter loop\n";
            if (!text) out.append(12, '\0');
            for (const int k : three) {
                const Vec3& x = box[static_cast<std::size_t>(side[static_cast<std::size_t>(k)])];
                if (text)
                    out += fmt::format("vertex {} {} {}\n", x.x(), x.y(), x.z());
                else
                    for (const double value : x) put(out, static_cast<float>(value));
            }
            out += text ? "endloop\nendfacet\n" : std::string(2, '\0');
        }
    }
    return out;
}

// The same box as glTF writes it, a vertex for each corner of a face, hung on two joints, of which the second
// turns about z and rises; and a morph target that lifts its top.
std::string figure_glb(const std::string& interpolation, const Json& more = {}) {
    std::string binary;
    Json views = Json::array(), accessors = Json::array();
    const auto add = [&](const std::string& bytes, int type, const char* kind, std::size_t count) {
        views.push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
        binary += bytes + std::string((4 - bytes.size() % 4) % 4, '\0');
        accessors.push_back(
            {{"bufferView", views.size() - 1}, {"componentType", type}, {"count", count}, {"type", kind}});
        return accessors.size() - 1;
    };
    std::string positions, joints, weights, indices, lift, uv;
    std::uint16_t corner = 0;
    for (const auto& side : sides) {
        for (const int v : side) {
            const Vec3& x = box[static_cast<std::size_t>(v)];
            for (const double value : x) put(positions, static_cast<float>(value));
            for (const int joint : {0, 1, 0, 0}) put(joints, static_cast<std::uint8_t>(joint));
            const std::uint8_t upper = x.y() > 0.5 ? 255 : 0;
            for (const int weight : {255 - upper, int{upper}, 0, 0})
                put(weights, static_cast<std::uint8_t>(weight));
            for (const double value : {0.0, x.y() > 0.5 ? 0.5 : 0.0, 0.0})
                put(lift, static_cast<float>(value));
            put(uv, static_cast<float>(corner % 4 / 2));
            put(uv, 0.25f);
            ++corner;
        }
        for (const int k : {4, 3, 2, 4, 2, 1}) put(indices, static_cast<std::uint16_t>(corner - k));
    }
    Json attributes{{"POSITION", add(positions, 5126, "VEC3", 24)},
                    {"JOINTS_0", add(joints, 5121, "VEC4", 24)}};
    attributes["WEIGHTS_0"] = add(weights, 5121, "VEC4", 24);
    accessors.back()["normalized"] = true;
    attributes["TEXCOORD_0"] = add(uv, 5126, "VEC2", 24);
    std::string times, turns, places, shares, binds;
    for (const float t : {0.5f, 1.5f}) put(times, t);
    const auto values = [&](std::string& out, std::initializer_list<std::vector<float>> keys) {
        for (const std::vector<float>& key : keys) {
            const std::vector<float> zero(key.size(), 0.0f);
            const bool cubic = interpolation == "CUBICSPLINE";
            for (const auto& part : cubic ? std::vector<std::vector<float>>{zero, key, zero}
                                          : std::vector<std::vector<float>>{key})
                for (const float value : part) put(out, value);
        }
    };
    const float half = std::sqrt(0.5f);  // of a right angle
    values(turns, {{0, 0, 0, 1}, {0, 0, half, half}});
    values(places, {{0, 0.5, 0}, {0, 2.5, 0}});
    values(shares, {{0}, {1}});
    for (int k = 0; k < 2; ++k) {
        for (const float value :
             {1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, -0.5f * float(k), 0.f, 1.f})
            put(binds, value);
    }
    const std::size_t keys = interpolation == "CUBICSPLINE" ? 6 : 2;
    const auto index = add(indices, 5123, "SCALAR", 36), time = add(times, 5126, "SCALAR", 2);
    const auto turn = add(turns, 5126, "VEC4", keys), place = add(places, 5126, "VEC3", keys);
    const auto share = add(shares, 5126, "SCALAR", keys), bind = add(binds, 5126, "MAT4", 2);
    const auto target = add(lift, 5126, "VEC3", 24);
    Json document{
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", Json::array({{{"nodes", {0, 2}}}})},
        {"nodes", Json::array({{{"children", {1}}},
                               {{"translation", {0, 0.5, 0}}},
                               {{"mesh", 0}, {"skin", 0}, {"name", "figure"}}})},
        {"skins", Json::array({{{"joints", {0, 1}}, {"inverseBindMatrices", bind}}})},
        {"meshes", Json::array({{{"primitives",
                                  Json::array({{{"attributes", attributes},
                                                {"indices", index},
                                                {"targets", Json::array({{{"POSITION", target}}})}}})}}})},
        {"accessors", accessors},
        {"bufferViews", views},
        {"buffers", Json::array({{{"byteLength", binary.size()}}})}};
    Json channels = Json::array(), samplers = Json::array();
    for (const auto& [output, path, node] :
         {std::tuple{turn, "rotation", 1}, std::tuple{place, "translation", 1},
          std::tuple{share, "weights", 2}}) {
        channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
        samplers.push_back({{"input", time}, {"output", output}, {"interpolation", interpolation}});
    }
    document["animations"] =
        Json::array({{{"name", "rise"}, {"channels", channels}, {"samplers", samplers}}});
    if (more.is_object()) document.merge_patch(more);
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    put(out, std::uint32_t{2});
    put(out, static_cast<std::uint32_t>(28 + text.size() + binary.size()));
    put(out, static_cast<std::uint32_t>(text.size()));
    put(out, std::uint32_t{0x4E4F534A});
    out += text;
    put(out, static_cast<std::uint32_t>(binary.size()));
    put(out, std::uint32_t{0x004E4942});
    return out + binary;
}

PolygonMesh parse_glb(const std::string& glb, const std::string& animation,
                      std::shared_ptr<const Figure>& figure) {
    MeshMessages said;
    PolygonMesh mesh = parse_gltf(bytes_of(glb), animation, said, figure);
    for (const MeshFault& fault : said.faults) FAIL(fault.what);
    return mesh;
}

}  // namespace

TEST_CASE("PLY and STL of every kind are the box that they were made from", "[mesh]") {
    for (const std::string& file :
         {box_ply("ascii"), box_ply("binary_little_endian"), box_ply("binary_big_endian")}) {
        MeshMessages said;
        const PolygonMesh mesh = parse_ply(bytes_of(file), said);
        REQUIRE(said.faults.empty());
        CHECK(mesh.positions == box);
        REQUIRE(mesh.faces.size() == 6);
        for (std::size_t f = 0; f < 6; ++f) {
            for (std::size_t k = 0; k < 4; ++k)
                CHECK(mesh.faces[f].vertex[k] == static_cast<std::uint32_t>(sides[f][k]));
        }
    }
    for (const std::string& file : {box_stl(true), box_stl(false)}) {
        MeshMessages said;
        const PolygonMesh mesh = parse_stl(bytes_of(file), said);
        REQUIRE(said.faults.empty());
        CHECK(mesh.positions.size() == 8);
        REQUIRE(mesh.faces.size() == 12);
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(mesh.positions[mesh.faces[3].vertex[c]] ==
                  box[static_cast<std::size_t>(sides[1][std::array{0u, 2u, 3u}[c]])]);
    }
}

TEST_CASE("a file cut short or of another format is a fault, not a mesh", "[mesh]") {
    std::shared_ptr<const Figure> figure;
    const std::pair<const char*, std::string> files[] = {{"a.ply", box_ply("binary_little_endian")},
                                                         {"a.ply", box_ply("ascii")},
                                                         {"a.stl", box_stl(false)},
                                                         {"a.glb", figure_glb("LINEAR")}};
    for (const auto& [name, whole] : files) {
        for (std::size_t size = 0; size + 1 < whole.size(); size += 1 + size / 16) {
            INFO(name << " " << size);
            MeshMessages said;
            parse_mesh(name, bytes_of(whole.substr(0, size)), said, {}, figure);
            CHECK(!said.faults.empty());
        }
    }
    MeshMessages said;
    parse_mesh("a.fbx", {}, said, {}, figure);
    REQUIRE(said.faults.size() == 1);
    CHECK(said.faults[0].what == "no mesh is read from '.fbx' files");
}

TEST_CASE("glTF's vertices that differ in texture coordinates only are one", "[mesh]") {
    std::shared_ptr<const Figure> figure;
    const PolygonMesh mesh = parse_glb(figure_glb("LINEAR"), "", figure);
    CHECK(!figure);
    REQUIRE(mesh.positions.size() == 8);
    CHECK(mesh.faces.size() == 12);
    CHECK(mesh.uvs.size() == 24);
    CHECK(mesh.uvs[0].y() == 0.75);  // its v runs downwards
    CHECK(mesh.groups.at("figure").size() == 8);
    for (const Vec3& x : mesh.positions) CHECK(std::abs(x.x()) == 1);
}

TEST_CASE("an animation is sampled as glTF says, bent by joints and lifted by its target", "[mesh]") {
    struct Expected {
        const char* interpolation;
        double half;  // of the way, at the middle between the keys, and after a quarter
        double quarter;
    };
    for (const auto& [interpolation, half, quarter] :
         {Expected{"STEP", 0, 0}, Expected{"LINEAR", 0.5, 0.25}, Expected{"CUBICSPLINE", 0.5, 0.15625}}) {
        INFO(interpolation);
        std::shared_ptr<const Figure> figure;
        const PolygonMesh mesh = parse_glb(figure_glb(interpolation), "rise", figure);
        REQUIRE(figure);
        std::vector<Vec3> now;
        for (const auto& [t, share] : {std::pair{0.0, 0.0}, std::pair{0.5, 0.0}, std::pair{0.75, quarter},
                                       std::pair{1.0, half}, std::pair{1.5, 1.0}, std::pair{9.0, 1.0}}) {
            CAPTURE(t);
            figure->pose(t, now);
            REQUIRE(now.size() == mesh.positions.size());
            // Of quaternions a Hermite spline between the identity and a right angle, made unit; else even.
            double angle = share * std::acos(0.0);
            if (std::string(interpolation) == "CUBICSPLINE")
                angle = 2 * std::atan2(share * std::sqrt(0.5), 1 - share + share * std::sqrt(0.5));
            const Vec3 joint(0, 0.5 + 2 * share, 0);
            for (std::size_t v = 0; v < now.size(); ++v) {
                // At the first key it stands as it is; only its top moves.
                const Vec3& at = mesh.positions[v];
                if (at.y() < 0.5) {
                    CHECK((now[v] - at).norm() < 1e-6);
                    continue;
                }
                const Vec3 lifted = at + Vec3(0, 0.5 * share, 0);
                const Vec3 moved =
                    joint + Eigen::AngleAxisd(angle, Vec3::UnitZ()) * (lifted - Vec3(0, 0.5, 0));
                CHECK((now[v] - moved).norm() < 1e-6);
            }
        }
    }
}

TEST_CASE("an animated figure is a body of the scene, turned and scaled as its file is", "[mesh][scene]") {
    const TemporaryFolder folder;
    write_whole_file(folder.path() / "figure.glb", std::string_view(figure_glb("LINEAR")));
    const std::string solid =
        "[cloth]\ncenter = [9, 9, 9]\n[[solid]]\nshape = \"mesh\"\nmesh = \"figure.glb\"\n";
    const Scene scene = parse_scene(solid + "animation = \"rise\"\nmesh_scale = 2\nmesh_start = 1\n",
                                    "scene.toml", folder.path());
    const MeshSolid& body = *scene.solids[0].geometry;
    CHECK(body.deforms());
    CHECK(body.triangles.size() == 12);
    CHECK(body.tree.nearest({0, 1, 0}, 9).distance == Approx(-1));
    std::vector<Vec3> now;
    body.positions_at(2.5, now);  // the last key, a second late
    double highest = 0;
    for (const Vec3& x : now) {
        highest = std::max(highest, x.y());
        CHECK(x.norm() <= body.reach);
    }
    // The top's corner at x = 1, turned up by the right angle: joint 2.5 and 1 above it, twice.
    CHECK(highest == Approx(2 * 3.5));
    const std::string text = scene_to_toml(scene);
    CHECK_THAT(text, Contains("animation = \"rise\""));
    CHECK(scene_to_toml(parse_scene(text, "scene.toml", folder.path())) == text);

    const Scene still = parse_scene(solid, "scene.toml", folder.path());
    CHECK(!still.solids[0].geometry->deforms());
    REQUIRE(still.notes.size() == 1);
    CHECK(still.notes[0] == "figure.glb: the scene names no animation, so none is played; it has \"rise\"");
    CHECK_THROWS_WITH(parse_scene(solid + "animation = \"fall\"\n", "scene.toml", folder.path()),
                      Contains("it has no animation \"fall\", but \"rise\""));
    CHECK_THROWS_WITH(
        parse_scene(solid + "animation = \"rise\"\nmesh_frames = \"a.pc2\"\n", "scene.toml", folder.path()),
        Contains("a mesh that deforms in two ways"));
}

TEST_CASE("a glTF file that is not as the format says is refused with what is wrong", "[mesh]") {
    const std::pair<Json, const char*> broken[] = {
        {{{"extensionsRequired", {"KHR_draco_mesh_compression"}}},
         "it needs the extension KHR_draco_mesh_compression"},
        {{{"scenes", Json::array({{{"nodes", {0, 1, 2}}}})}}, "node 1 has two parents"},
        {{{"scenes", Json::array({{{"nodes", {0, 7}}}})}}, "there is no node 7"},
        {{{"skins", Json::array({{{"joints", {0}}}})}}, "a vertex hangs on joint 1 of 1"},
        {{{"skins", Json::array({{{"joints", {0, 9}}}})}}, "there is no node 9"}};
    for (const auto& [change, what] : broken) {
        MeshMessages said;
        std::shared_ptr<const Figure> figure;
        const PolygonMesh mesh = parse_gltf(bytes_of(figure_glb("LINEAR", change)), "rise", said, figure);
        CHECK(mesh.faces.empty());
        REQUIRE(said.faults.size() == 1);
        CHECK_THAT(said.faults[0].what, Contains(what));
    }
}
