// Binary glTF 2.0 (Khronos, sections 3.6 and 3.11). The first frame is the base mesh; every further frame is
// a morph target, and the animation gives it weight 1 at its time.

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "tool/export/export.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int float_type = 5126, index_type = 5125;

// A cloth's vertices as glTF has them: vertex v < particles is particle v, those that follow repeat a
// particle for each further texture coordinate that it has.
struct Vertices {
    std::vector<std::uint32_t> particle;
    std::vector<Eigen::Vector2f> uv;
    std::vector<std::uint32_t> indices;

    Vertices(const ClothSurface& surface, std::uint32_t particles) : particle(particles) {
        uv.assign(particles, Eigen::Vector2f::Zero());
        std::vector<std::uint32_t> first(particles, no_index);
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> others;
        for (std::uint32_t p = 0; p < particles; ++p) particle[p] = p;
        const auto vertex = [&](std::uint32_t p, std::uint32_t t) {
            if (t == no_index) return p;
            // glTF's v runs downwards.
            const Eigen::Vector2f at(static_cast<float>(surface.uvs[t].x()),
                                     static_cast<float>(1 - surface.uvs[t].y()));
            if (first[p] == no_index) {
                first[p] = t;
                uv[p] = at;
            }
            if (first[p] == t) return p;
            const auto [found, is_new] =
                others.try_emplace({p, t}, static_cast<std::uint32_t>(particle.size()));
            if (is_new) {
                particle.push_back(p);
                uv.push_back(at);
            }
            return found->second;
        };
        for (const ClothSurface::Face& face : surface.faces) {
            const auto at = [&](std::size_t k) { return vertex(face.vertex[k], face.uv[k]); };
            const std::uint32_t a = at(0), b = at(1), c = at(2);
            indices.insert(indices.end(), {a, b, c});
            if (face.corners == 4) indices.insert(indices.end(), {a, c, at(3)});
        }
    }
};

// Positions and normals of a cloth in a frame.
struct Posture {
    std::vector<Eigen::Vector3f> positions, normals;
};

Posture shape_of(const ClothSurface& surface, const Vertices& vertices, std::span<const Vec3> x) {
    const std::vector<Vec3> normals = surface_normals(surface, x);
    Posture out;
    for (const std::uint32_t p : vertices.particle) {
        out.positions.push_back(x[p].cast<float>());
        out.normals.push_back(normals[p].cast<float>());
    }
    return out;
}

// What a target adds to the base.
Posture difference(const Posture& base, const Posture& other) {
    Posture out = other;
    for (std::size_t v = 0; v < base.positions.size(); ++v) {
        out.positions[v] -= base.positions[v];
        out.normals[v] -= base.normals[v];
    }
    return out;
}

// The JSON part, with the byte ranges of the binary one in the order in which they will be written.
class GlbLayout {
public:
    Json json{
        {"asset", {{"version", "2.0"}, {"generator", "unravel"}, {"extras", {{"units", "metres, y up"}}}}},
        {"scene", 0},
        {"materials", Json::array({{{"doubleSided", true},
                                    {"pbrMetallicRoughness",
                                     {{"baseColorFactor", {0.55, 0.06, 0.08, 1.0}},
                                      {"metallicFactor", 0.0},
                                      {"roughnessFactor", 0.9}}}}})}};

    int accessor(std::size_t count, const char* type, std::size_t item_bytes, int component,
                 Json extra = {}) {
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes}, {"byteLength", count * item_bytes}});
        Json a{{"bufferView", views_}, {"componentType", component}, {"count", count}, {"type", type}};
        if (extra.is_object()) a.update(extra);
        json["accessors"].push_back(std::move(a));
        bytes += count * item_bytes;
        return views_++;
    }
    int vectors(const std::vector<Eigen::Vector3f>& values) {
        Eigen::Vector3f low = values.front(), high = low;
        for (const Eigen::Vector3f& v : values) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
        return accessor(values.size(), "VEC3", 12, float_type,
                        {{"min", {low.x(), low.y(), low.z()}}, {"max", {high.x(), high.y(), high.z()}}});
    }
    std::size_t bytes = 0;

private:
    int views_ = 0;
};

template <typename T>
void write(WholeFile& file, const std::vector<T>& values) {
    file.write(std::as_bytes(std::span(values)));
}

void write_word(WholeFile& file, std::size_t value) {
    write(file, std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)});
}

}  // namespace

Written export_glb(const ExportSource& source, const std::filesystem::path& folder, const std::string& name) {
    const std::size_t cloths = source.surfaces.size(), frames = static_cast<std::size_t>(source.frames());
    std::vector<Vertices> vertices;
    std::vector<Posture> bases;
    const FrameRecord first = source.read(source.first);
    GlbLayout layout;
    Json& json = layout.json;
    json["scenes"] = Json::array({{{"nodes", Json::array()}}});
    for (std::size_t c = 0; c < cloths; ++c) {
        const ClothPatch& patch = source.model.cloths[c];
        vertices.emplace_back(source.surfaces[c], patch.count());
        bases.push_back(shape_of(source.surfaces[c], vertices[c], positions_of(patch, first)));
        if (vertices[c].indices.empty()) continue;  // a thread has no faces
        Json primitive{{"attributes",
                        {{"POSITION", layout.vectors(bases[c].positions)},
                         {"NORMAL", layout.vectors(bases[c].normals)}}},
                       {"material", 0}};
        if (!source.surfaces[c].uvs.empty())
            primitive["attributes"]["TEXCOORD_0"] =
                layout.accessor(vertices[c].uv.size(), "VEC2", 8, float_type);
        primitive["indices"] = layout.accessor(vertices[c].indices.size(), "SCALAR", 4, index_type);
        const auto index = static_cast<int>(json.value("nodes", Json::array()).size());
        json["nodes"].push_back({{"mesh", index}, {"name", patch.name}});
        json["meshes"].push_back({{"name", patch.name}, {"primitives", Json::array({primitive})}});
        json["scenes"][0]["nodes"].push_back(index);
    }
    // First pass: the format wants the bounds of every target before the targets.
    for (int frame = source.first + 1; frame <= source.last; ++frame) {
        const FrameRecord record = source.read(frame);
        for (std::size_t c = 0, m = 0; c < cloths; ++c) {
            if (vertices[c].indices.empty()) continue;
            const Posture moved = difference(
                bases[c],
                shape_of(source.surfaces[c], vertices[c], positions_of(source.model.cloths[c], record)));
            json["meshes"][m++]["primitives"][0]["targets"].push_back(
                {{"POSITION", layout.vectors(moved.positions)}, {"NORMAL", layout.vectors(moved.normals)}});
        }
    }
    const std::size_t targets = frames - 1;
    if (targets > 0 && json.contains("meshes")) {
        const int times = layout.accessor(
            frames, "SCALAR", 4, float_type,
            {{"min", {0.0}}, {"max", {static_cast<float>(source.fps.time_of(static_cast<int>(targets)))}}});
        const int weights = layout.accessor(frames * targets, "SCALAR", 4, float_type);
        Json animation{{"name", name}, {"samplers", Json::array({{{"input", times}, {"output", weights}}})}};
        for (std::size_t m = 0; m < json["meshes"].size(); ++m) {
            json["meshes"][m]["weights"] = std::vector<int>(targets, 0);
            animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", m}, {"path", "weights"}}}});
        }
        json["animations"] = Json::array({animation});
    }
    json["buffers"] = Json::array({{{"byteLength", layout.bytes}}});
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t whole = 12 + 8 + text.size() + 8 + layout.bytes;
    WholeFile file(folder / (file_name(name) + ".glb"));
    if (whole > std::numeric_limits<std::uint32_t>::max())
        throw OutputError(file.target(),
                          "a glTF file holds no more than 4 GiB: export fewer frames (--frames A-B), "
                          "or as pc2");
    for (const std::size_t word :
         {std::size_t{0x46546C67}, std::size_t{2}, whole, text.size(), std::size_t{0x4E4F534A}})
        write_word(file, word);
    file.write(std::string_view(text));
    write_word(file, layout.bytes);
    write_word(file, 0x004E4942);
    for (std::size_t c = 0; c < cloths; ++c) {
        if (vertices[c].indices.empty()) continue;
        write(file, bases[c].positions);
        write(file, bases[c].normals);
        if (!source.surfaces[c].uvs.empty()) write(file, vertices[c].uv);
        write(file, vertices[c].indices);
    }
    // Second pass: the targets themselves.
    for (int frame = source.first; frame <= source.last; ++frame) {
        if (frame > source.first) {
            const FrameRecord record = source.read(frame);
            for (std::size_t c = 0; c < cloths; ++c) {
                if (vertices[c].indices.empty()) continue;
                const Posture moved = difference(
                    bases[c],
                    shape_of(source.surfaces[c], vertices[c], positions_of(source.model.cloths[c], record)));
                write(file, moved.positions);
                write(file, moved.normals);
            }
        }
        if (!source.done(frame)) return {};
    }
    if (json.contains("animations")) {
        std::vector<float> times(frames), weights(targets);
        for (std::size_t k = 0; k < frames; ++k)
            times[k] = static_cast<float>(source.fps.time_of(static_cast<int>(k)));
        write(file, times);
        for (std::size_t k = 0; k < frames; ++k) {
            std::fill(weights.begin(), weights.end(), 0.0f);
            if (k > 0) weights[k - 1] = 1.0f;
            write(file, weights);
        }
    }
    file.commit();
    return {file.target()};
}

}  // namespace unravel::tool
