// What is exported is what the cache holds: bit for bit where the format has doubles, rounded once where it
// has floats.

#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "sim/mesh/check_mesh.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/obj.hpp"
#include "sim/mesh/pc2.hpp"
#include "sim/run/simulate.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"
#include "tool/export/export.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

constexpr std::size_t largest = 1 << 26;

// A few frames of a tube and a sheet, which is a mesh.
struct Run {
    testing::MeshScene made{
        "[clip]\nfps = 20\nduration = 0.2\n[[cloth]]\nname = \"sleeve\"\nparticles = [7, 5]\nwrap = "
        "\"tube\"\n"
        "[[cloth]]\nname = \"a sheet\"\nmesh = \"mesh.obj\"\ncenter = [0.1, 0.7, 1.3]\nrotation = [10, 20, "
        "30]\n",
        testing::sheet_obj(5, true)};
    Simulation simulation = start_simulation(made.scene);
    std::vector<FrameRecord> records;
    TemporaryFolder folder;
    int reads = 0;

    Run() {
        records.push_back(present_record(simulation));
        for (int frame = 1; frame < 5; ++frame) records.push_back(next_record(simulation));
    }
    ExportSource source() {
        ExportSource out{simulation.model, {}, 1, 3, 20, {}, {}};
        for (const ClothPatch& patch : simulation.model.cloths) out.surfaces.push_back(surface_of(patch));
        out.read = [this](int frame) {
            ++reads;
            return records[static_cast<std::size_t>(frame)];
        };
        out.done = [](int) { return true; };
        return out;
    }
    const Vec3& at(int frame, std::size_t p) const {
        return records[static_cast<std::size_t>(frame)].state.x[p];
    }
};

template <typename T>
T take(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    T value;
    REQUIRE(at + sizeof(T) <= bytes.size());
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

std::uint32_t big_endian(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    const auto word = take<std::array<std::uint8_t, 4>>(bytes, at);
    return std::uint32_t{word[0]} << 24 | std::uint32_t{word[1]} << 16 | std::uint32_t{word[2]} << 8 |
           word[3];
}

}  // namespace

TEST_CASE("an exported OBJ reads back to the same doubles, faces and texture coordinates", "[export]") {
    Run run;
    const Written written = export_obj(run.source(), run.folder.path());
    REQUIRE(written.size() == 3);
    CHECK(written[0].filename() == "frame_0001.obj");
    for (int frame = 1; frame <= 3; ++frame) {
        MeshMessages said;
        const PolygonMesh mesh =
            parse_obj(read_whole_text(written[static_cast<std::size_t>(frame - 1)], largest), said);
        REQUIRE(said.faults.empty());
        REQUIRE(mesh.positions.size() == run.simulation.model.size());
        for (std::size_t p = 0; p < mesh.positions.size(); ++p)
            REQUIRE(mesh.positions[p] == run.at(frame, p));
        REQUIRE(mesh.faces.size() == 7 * 4 + 2 * 25);
        CHECK(mesh.groups.contains("sleeve"));
        CHECK(mesh.groups.contains("a_sheet"));
        // The mesh's own faces come out as they went in.
        const auto& own = run.made.scene.cloths[1].geometry->faces;
        for (std::size_t f = 0; f < own.size(); ++f) {
            const PolygonMesh::Face& face = mesh.faces[28 + f];
            REQUIRE(face.corners == own[f].corners);
            for (std::size_t k = 0; k < face.corners; ++k) {
                REQUIRE(face.vertex[k] == own[f].vertex[k] + 35);
                REQUIRE(mesh.uvs[face.uv[k]] == run.made.scene.cloths[1].geometry->uvs[own[f].uv[k]]);
            }
        }
    }
}

TEST_CASE("a grid that is exported and taken up as a mesh starts from the same bits", "[export][mesh]") {
    const Scene grid = parse_scene(
        "[cloth]\nparticles = [6, 9]\nsize = [0.7, 1.1]\nrotation = [12, 34, 56]\n"
        "center = [0.3, 0.2, 0.1]\n",
        "grid.toml");
    Simulation simulation = start_simulation(grid);
    const ClothPatch& patch = simulation.model.cloths[0];
    const testing::MeshScene made("[cloth]\nmesh = \"mesh.obj\"\n",
                                  obj_text("sheet", patch, surface_of(patch), simulation.state.x, 0, 0));
    Placement placement;
    const ClothModel model = build_model(made.scene, placement);
    REQUIRE(placement.x == simulation.state.x);
    CHECK(model.springs.size() == simulation.model.springs.size());
    CHECK(model.bends.size() == simulation.model.bends.size());
}

TEST_CASE("PC2 and MDD hold every frame, rounded to floats once", "[export]") {
    Run run;
    for (const bool mdd : {false, true}) {
        const Written written = export_point_cache(run.source(), run.folder.path(), mdd);
        REQUIRE(written.size() == 4);
        CHECK(written[2].filename() == "a_sheet.obj");
        const std::vector<std::uint8_t> bytes = read_whole_file(written[3], largest);
        std::vector<std::vector<Vec3>> samples;
        if (!mdd) {
            Pc2Header header;
            REQUIRE(read_pc2(bytes, 36, largest, header, samples).empty());
            CHECK(header.start == 1);
        } else {
            REQUIRE(bytes.size() == 8 + 3 * 4 + 3 * 36 * 12);
            CHECK(big_endian(bytes, 0) == 3);
            CHECK(big_endian(bytes, 4) == 36);
            CHECK(std::bit_cast<float>(big_endian(bytes, 12)) == 0.05f);
            for (std::size_t k = 0; k < 3; ++k) {
                samples.emplace_back();
                for (std::size_t p = 0; p < 36; ++p) {
                    const std::size_t at = 20 + (k * 36 + p) * 12;
                    samples.back().emplace_back(std::bit_cast<float>(big_endian(bytes, at)),
                                                std::bit_cast<float>(big_endian(bytes, at + 4)),
                                                std::bit_cast<float>(big_endian(bytes, at + 8)));
                }
            }
        }
        REQUIRE(samples.size() == 3);
        for (int k = 0; k < 3; ++k) {
            for (std::size_t p = 0; p < 36; ++p)
                REQUIRE(Eigen::Vector3f(samples[static_cast<std::size_t>(k)][p].cast<float>()) ==
                        Eigen::Vector3f(run.at(k + 1, 35 + p).cast<float>()));
        }
    }
}

TEST_CASE("PLY has the doubles and the components' colours, from the first frame on", "[export]") {
    Run run;
    int seen = 0;
    const Written written = export_ply(run.source(), run.folder.path(), [&](const FrameRecord& record) {
        CHECK(record.frame == seen++);
        return std::vector<Rgb>(record.component.size(), Rgb{1, 2, static_cast<std::uint8_t>(record.frame)});
    });
    REQUIRE(written.size() == 3);
    const std::vector<std::uint8_t> bytes = read_whole_file(written[2], largest);
    const std::string text(bytes.begin(), bytes.end());
    const std::size_t body = text.find("end_header\n") + 11, stride = 3 * 8 + 3 * 4 + 3;
    for (std::size_t p = 0; p < run.simulation.model.size(); ++p) {
        for (int k = 0; k < 3; ++k)
            REQUIRE(take<double>(bytes, body + p * stride + 8 * static_cast<std::size_t>(k)) ==
                    run.at(3, p)[k]);
        REQUIRE(bytes[body + p * stride + 38] == 3);
    }
    CHECK(bytes.size() == body + 71 * stride + 28 * 17 + 50 * 13);
}

TEST_CASE("glTF's targets put the vertices where the frames have them", "[export]") {
    Run run;
    const Written written = export_glb(run.source(), run.folder.path(), "a run");
    REQUIRE(written.size() == 1);
    const std::vector<std::uint8_t> bytes = read_whole_file(written[0], largest);
    CHECK(take<std::uint32_t>(bytes, 8) == bytes.size());
    const std::size_t json_size = take<std::uint32_t>(bytes, 12), binary = 20 + json_size + 8;
    const auto json =
        nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + std::ptrdiff_t(json_size));
    CHECK(take<std::uint32_t>(bytes, binary - 8) == bytes.size() - binary);
    CHECK(json["buffers"][0]["byteLength"] == bytes.size() - binary);
    const auto value = [&](const nlohmann::json& accessor, std::size_t item, std::size_t k) {
        const auto& view =
            json["bufferViews"][json["accessors"][accessor.get<int>()]["bufferView"].get<int>()];
        return take<float>(bytes, binary + view["byteOffset"].get<std::size_t>() + 4 * (3 * item + k));
    };
    REQUIRE(json["meshes"].size() == 2);
    std::size_t first = 0;
    for (std::size_t m = 0; m < 2; ++m) {
        const auto& primitive = json["meshes"][m]["primitives"][0];
        REQUIRE(primitive["targets"].size() == 2);
        const std::size_t count = run.simulation.model.cloths[m].count();
        for (std::size_t p = 0; p < count; ++p) {
            for (std::size_t k = 0; k < 3; ++k) {
                const float base = value(primitive["attributes"]["POSITION"], p, k);
                REQUIRE(base == static_cast<float>(run.at(1, first + p)[Eigen::Index(k)]));
                for (int frame = 2; frame <= 3; ++frame) {
                    const float moved =
                        base + value(primitive["targets"][std::size_t(frame - 2)]["POSITION"], p, k);
                    REQUIRE(moved == Approx(run.at(frame, first + p)[Eigen::Index(k)]).margin(1e-6));
                }
            }
        }
        first += count;
    }
    // At every frame's time its own target has all the weight.
    const auto& sampler = json["animations"][0]["samplers"][0];
    const auto& input = json["accessors"][sampler["input"].get<int>()];
    CHECK(input["max"][0].get<float>() == 0.1f);
    CHECK(json["accessors"][sampler["output"].get<int>()]["count"] == 6);
}

TEST_CASE("glTF has the solids where the scene has them, textures as they are, and cameras if asked for",
          "[export]") {
    const TemporaryFolder folder;
    const std::string tetra = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    write_whole_file(folder.path() / "t_0.obj", std::string_view(tetra));
    std::string moved = tetra;
    moved.replace(moved.find("v 0 0 1"), 7, "v 0 0 3");
    write_whole_file(folder.path() / "t_1.obj", std::string_view(moved));
    const render::Image image{2, 2, std::vector<std::uint8_t>(16, 200)};
    const std::vector<std::uint8_t> png = render::encode_png(image);
    write_whole_file(folder.path() / "a.png", std::span(png));
    const Scene scene = parse_scene(
        "[clip]\nfps = 10\nduration = 0.2\nsize = [320, 160]\n[cloth]\nparticles = [3, 3]\ncenter = [0, 9, "
        "0]\n"
        "[[solid]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.5\ncenter = [1, 2, 3]\n"
        "motion = [{time = 0}, {time = 0.2, position = [0, 1, 0], rotation = [0, 90, 0]}]\n"
        "[[solid]]\nname = \"soft\"\nshape = \"mesh\"\nmesh = \"t_0.obj\"\nmesh_frames = "
        "\"t_#.obj\"\nmesh_fps = 5\n"
        "[[camera]]\nname = \"main\"\nposition = [0, 1, 5]\ntarget = [0, 1, 0]\nfov = 45\n"
        "[[look.cloth]]\ntexture = \"a.png\"\n",
        "beside.toml", folder.path());
    Simulation simulation = start_simulation(scene);
    std::vector<FrameRecord> records{present_record(simulation)};
    for (int k = 1; k < 3; ++k) records.push_back(next_record(simulation));
    ExportSource source{simulation.model, {surface_of(simulation.model.cloths[0])}, 0, 2, 10, {}, {}};
    source.read = [&](int frame) { return records[static_cast<std::size_t>(frame)]; };
    source.done = [](int) { return true; };
    add_surroundings(source, scene, true);
    const Written written = export_glb(source, folder.path(), "beside");
    const std::vector<std::uint8_t> bytes = read_whole_file(written.at(0), largest);
    const std::size_t json_size = take<std::uint32_t>(bytes, 12), binary = 20 + json_size + 8;
    const auto json =
        nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + std::ptrdiff_t(json_size));
    const auto offset = [&](const nlohmann::json& view) {
        return binary + json["bufferViews"][view.get<std::size_t>()]["byteOffset"].get<std::size_t>();
    };
    const auto value = [&](const nlohmann::json& accessor, std::size_t k) {
        return take<float>(bytes,
                           offset(json["accessors"][accessor.get<std::size_t>()]["bufferView"]) + 4 * k);
    };
    CHECK(std::equal(png.begin(), png.end(),
                     bytes.begin() + std::ptrdiff_t(offset(json["images"][0]["bufferView"]))));
    CHECK(json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] == 0);

    std::map<std::string, std::size_t> node;
    for (std::size_t n = 0; n < json["nodes"].size(); ++n) node[json["nodes"][n]["name"]] = n;
    const auto output = [&](const std::string& name, const char* path) {
        for (const auto& channel : json["animations"][0]["channels"]) {
            if (channel["target"]["node"] == node.at(name) && channel["target"]["path"] == path)
                return json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()]["output"];
        }
        return nlohmann::json();
    };
    // The ball rises by a metre and turns by a right angle; what deforms is bent by its targets instead.
    CHECK(value(output("ball", "translation"), 1) == 2.0f);
    CHECK(value(output("ball", "translation"), 7) == 3.0f);
    CHECK(value(output("ball", "rotation"), 4 * 2 + 1) == Approx(std::sqrt(0.5)));
    CHECK(output("soft", "translation").is_null());
    const auto& primitive =
        json["meshes"][json["nodes"][node.at("soft")]["mesh"].get<std::size_t>()]["primitives"][0];
    CHECK(value(primitive["attributes"]["POSITION"], 3 * 3 + 2) == 1.0f);
    CHECK(value(primitive["targets"][1]["POSITION"], 3 * 3 + 2) == 2.0f);
    // The camera stands before the scene and looks at it: unturned.
    const auto& camera = json["nodes"][node.at("main")];
    CHECK(camera["rotation"][3].get<double>() == Approx(1));
    CHECK(json["cameras"][0]["perspective"]["aspectRatio"] == 2);
    CHECK(json["cameras"][0]["perspective"]["yfov"].get<double>() == Approx(std::acos(-1.0) / 4));
}

TEST_CASE("cloths whose names are alike get files of their own", "[export]") {
    const Scene scene = parse_scene(
        "[[cloth]]\nname = \"a b\"\nparticles = [3, 3]\n[[cloth]]\nname = \"a_b\"\nparticles = [4, 3]\n"
        "center = [0, 1, 0]\n",
        "alike.toml");
    Simulation simulation = start_simulation(scene);
    const FrameRecord record = present_record(simulation);
    ExportSource source{simulation.model, {}, 0, 0, 25, {}, {}};
    for (const ClothPatch& patch : simulation.model.cloths) source.surfaces.push_back(surface_of(patch));
    source.read = [&](int) { return record; };
    source.done = [](int) { return true; };
    const TemporaryFolder folder;
    const Written written = export_point_cache(source, folder.path(), false);
    REQUIRE(written.size() == 4);
    CHECK(written[1].filename() == "a_b.pc2");
    CHECK(written[3].filename() == "a_b_2.pc2");
    CHECK(folder.entries() == 4);
    CHECK(read_whole_file(written[3], largest).size() == 32 + 12 * 12);
}

TEST_CASE("an export that is stopped leaves no half of a file", "[export]") {
    Run run;
    ExportSource source = run.source();
    source.done = [](int frame) { return frame < 2; };
    CHECK(export_point_cache(source, run.folder.path(), false).empty());
    CHECK(export_glb(source, run.folder.path(), "x").empty());
    CHECK(run.folder.entries() == 0);
    CHECK(export_obj(source, run.folder.path()).size() == 2);
}
