// Binary glTF 2.0 (Khronos, sections 3.6 to 3.11). The first frame is the base mesh; every further frame is
// a morph target, and the animation gives it weight 1 at its time. What only moves as a whole is a node that
// does.

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "sim/mesh/mesh_cloth.hpp"
#include "tool/export/export.hpp"
#include "tool/export/glb_binary.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;

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
Posture difference(const Posture& base, Posture other) {
    for (std::size_t v = 0; v < base.positions.size(); ++v) {
        other.positions[v] -= base.positions[v];
        other.normals[v] -= base.normals[v];
    }
    return other;
}

// A cloth, or a solid that deforms.
struct GlbShape {
    ClothSurface surface;
    Vertices vertices;
    std::function<std::vector<Vec3>(const FrameRecord&)> positions;
    std::size_t mesh = 0;  // its number in the document
    Posture base;

    Posture at(const FrameRecord& record) const { return shape_of(surface, vertices, positions(record)); }
};

ClothSurface surface_of_solid(const ExportSolid& solid) {
    ClothSurface out;
    for (const auto& [a, b, c] : solid.triangles)
        out.faces.push_back({3, {a, b, c, no_index}, {no_index, no_index, no_index, no_index}});
    return out;
}

// Colours of the format are linear.
Json linear(const Rgb& color) {
    const auto one = [](std::uint8_t byte) {
        const double c = byte / 255.0;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    return {one(color.r), one(color.g), one(color.b), 1.0};
}

// Where a camera is: it looks along its own −z.
Eigen::Isometry3d placed(const CameraView& view) {
    const Vec3 position = view.position.cast<double>(), target = view.target.cast<double>();
    const Vec3 back = (position - target).normalized();
    Vec3 up = view.up.cast<double>();
    if (back.cross(up).norm() < 1e-6) up = Vec3::UnitZ();
    const Vec3 right = up.cross(back).normalized();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << right, back.cross(right), back;
    pose.translation() = position;
    return pose;
}

class GlbExport {
public:
    GlbExport(const ExportSource& source, const std::string& name) : source_(source) {
        document_["asset"] = {
            {"version", "2.0"}, {"generator", "unravel"}, {"extras", {{"units", "metres, y up"}}}};
        document_["scene"] = 0;
        document_["scenes"] = Json::array({{{"nodes", Json::array()}}});
        animation_ = {{"name", name}, {"samplers", Json::array()}, {"channels", Json::array()}};
    }

    Written write(const std::filesystem::path& target) {
        const FrameRecord first = source_.read(source_.first);
        for (std::size_t c = 0; c < source_.surfaces.size(); ++c) add_cloth(c, first);
        for (const ExportSolid& solid : source_.solids) add_solid(solid, first);
        for (const ExportCamera& camera : source_.cameras) add_camera(camera);
        add_targets();
        animate_targets();
        animate_nodes();
        if (!animation_["channels"].empty()) document_["animations"] = Json::array({animation_});
        const bool whole =
            write_glb(target, document_, binary_, [&](WholeFile& file) { return write_targets(file); });
        return whole ? Written{target} : Written{};
    }

private:
    std::size_t frames() const { return static_cast<std::size_t>(source_.frames()); }
    double time_of(std::size_t k) const { return source_.fps.time_of(source_.first + static_cast<int>(k)); }

    std::size_t add_node(Json node) {
        document_["nodes"].push_back(std::move(node));
        const std::size_t number = document_["nodes"].size() - 1;
        document_["scenes"][0]["nodes"].push_back(number);
        return number;
    }

    // Two-sided, for cloth has two; a picture in the file's own bytes.
    std::size_t add_material(const std::string& name, const Rgb& color,
                             const std::vector<std::uint8_t>& texture, double roughness) {
        Json surface{{"baseColorFactor", texture.empty() ? linear(color) : Json{1.0, 1.0, 1.0, 1.0}},
                     {"metallicFactor", 0.0},
                     {"roughnessFactor", roughness}};
        if (!texture.empty()) {
            document_["images"].push_back({{"bufferView", binary_.file(texture)}, {"mimeType", "image/png"}});
            if (!document_.contains("samplers"))
                document_["samplers"] = Json::array({{{"wrapS", 10497}, {"wrapT", 10497}}});
            document_["textures"].push_back({{"sampler", 0}, {"source", document_["images"].size() - 1}});
            surface["baseColorTexture"] = {{"index", document_["textures"].size() - 1}};
        }
        document_["materials"].push_back(
            {{"name", name}, {"doubleSided", true}, {"pbrMetallicRoughness", surface}});
        return document_["materials"].size() - 1;
    }

    std::size_t add_mesh(const std::string& name, const Posture& base, const Vertices& vertices,
                         bool textured, std::size_t material) {
        Json primitive{
            {"attributes",
             {{"POSITION", binary_.vertices(base.positions)}, {"NORMAL", binary_.vertices(base.normals)}}},
            {"material", material}};
        if (textured) primitive["attributes"]["TEXCOORD_0"] = binary_.pairs(vertices.uv);
        primitive["indices"] = binary_.indices(vertices.indices);
        document_["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
        return document_["meshes"].size() - 1;
    }

    void add_shape(const std::string& name, GlbShape shape, const FrameRecord& first, std::size_t material) {
        shape.base = shape.at(first);
        shape.mesh = add_mesh(name, shape.base, shape.vertices, !shape.surface.uvs.empty(), material);
        node_of_shape_.push_back(add_node({{"mesh", shape.mesh}, {"name", name}}));
        shapes_.push_back(std::move(shape));
    }

    void add_cloth(std::size_t c, const FrameRecord& first) {
        const ClothPatch& patch = source_.model.cloths[c];
        const ClothSurface& surface = source_.surfaces[c];
        if (surface.faces.empty()) return;  // a thread
        const ExportLook look = c < source_.looks.size() ? source_.looks[c] : ExportLook{};
        const auto positions = [&patch](const FrameRecord& record) {
            const std::span<const Vec3> x = positions_of(patch, record);
            return std::vector<Vec3>(x.begin(), x.end());
        };
        add_shape(patch.name, {surface, Vertices(surface, patch.count()), positions, 0, {}}, first,
                  add_material(patch.name, look.front,
                               surface.uvs.empty() ? std::vector<std::uint8_t>{} : look.texture, 0.9));
    }

    void add_solid(const ExportSolid& solid, const FrameRecord& first) {
        const ClothSurface surface = surface_of_solid(solid);
        const Vertices vertices(surface, static_cast<std::uint32_t>(solid.positions.size()));
        const std::size_t material = add_material(solid.name, solid.color, {}, 0.6);
        if (solid.shape) {
            const auto positions = [&solid](const FrameRecord& record) {
                return solid_positions(solid, record.state.t);
            };
            add_shape(solid.name, {surface, vertices, positions, 0, {}}, first, material);
            return;
        }
        std::vector<Vec3> x;
        for (const Vec3f& at : solid.positions) x.push_back(at.cast<double>());
        const std::size_t mesh =
            add_mesh(solid.name, shape_of(surface, vertices, x), vertices, false, material);
        add_placed({{"mesh", mesh}, {"name", solid.name}}, solid.pose, solid.moves);
    }

    void add_camera(const ExportCamera& camera) {
        const double fov = camera.view(time_of(0)).fov * std::numbers::pi / 180.0;
        document_["cameras"].push_back(
            {{"type", "perspective"},
             {"name", camera.name},
             {"perspective", {{"yfov", fov}, {"aspectRatio", camera.aspect}, {"znear", 0.01}}}});
        add_placed(
            {{"camera", document_["cameras"].size() - 1}, {"name", camera.name}},
            [&camera](double t) { return placed(camera.view(t)); }, true);
    }

    // A node that is where `pose` says at the first frame, and moves with it.
    void add_placed(Json node, const std::function<Eigen::Isometry3d(double)>& pose, bool moves) {
        const Eigen::Isometry3d at = pose(time_of(0));
        const Eigen::Quaterniond q(at.linear());
        node["translation"] = {at.translation().x(), at.translation().y(), at.translation().z()};
        node["rotation"] = {q.x(), q.y(), q.z(), q.w()};
        const std::size_t number = add_node(std::move(node));
        if (moves) moving_.push_back({number, pose});
    }

    // First pass: the format wants the bounds of every target before the targets.
    void add_targets() {
        for (int frame = source_.first + 1; frame <= source_.last; ++frame) {
            const FrameRecord record = source_.read(frame);
            for (const GlbShape& shape : shapes_) {
                const Posture moved = difference(shape.base, shape.at(record));
                document_["meshes"][shape.mesh]["primitives"][0]["targets"].push_back(
                    {{"POSITION", binary_.later(moved.positions)}, {"NORMAL", binary_.later(moved.normals)}});
            }
        }
    }

    // Second pass: the targets themselves.
    bool write_targets(WholeFile& file) const {
        for (int frame = source_.first; frame <= source_.last; ++frame) {
            if (frame > source_.first) {
                const FrameRecord record = source_.read(frame);
                for (const GlbShape& shape : shapes_) {
                    const Posture moved = difference(shape.base, shape.at(record));
                    file.write(std::as_bytes(std::span(moved.positions)));
                    file.write(std::as_bytes(std::span(moved.normals)));
                }
            }
            if (!source_.done(frame)) return false;
        }
        return true;
    }

    int times() {
        if (times_ < 0) {
            std::vector<float> at(frames());
            for (std::size_t k = 0; k < at.size(); ++k)
                at[k] = static_cast<float>(source_.fps.time_of(static_cast<int>(k)));
            times_ = binary_.scalars(at, true);
        }
        return times_;
    }

    void animate(std::size_t node, const char* path, int output) {
        animation_["samplers"].push_back({{"input", times()}, {"output", output}});
        animation_["channels"].push_back(
            {{"sampler", animation_["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }

    void animate_targets() {
        const std::size_t targets = frames() - 1;
        if (targets == 0 || shapes_.empty()) return;
        std::vector<float> weights(frames() * targets, 0.0f);
        for (std::size_t k = 1; k < frames(); ++k) weights[k * targets + k - 1] = 1.0f;
        const int input = times(), output = binary_.scalars(weights);
        animation_["samplers"].push_back({{"input", input}, {"output", output}});
        for (std::size_t s = 0; s < shapes_.size(); ++s) {
            document_["meshes"][shapes_[s].mesh]["weights"] = std::vector<int>(targets, 0);
            animation_["channels"].push_back(
                {{"sampler", 0}, {"target", {{"node", node_of_shape_[s]}, {"path", "weights"}}}});
        }
    }

    void animate_nodes() {
        if (frames() < 2) return;
        for (const Moving& one : moving_) {
            std::vector<Eigen::Vector3f> places;
            std::vector<Eigen::Vector4f> turns;
            for (std::size_t k = 0; k < frames(); ++k) {
                const Eigen::Isometry3d at = one.pose(time_of(k));
                Eigen::Vector4f q = Eigen::Quaterniond(at.linear()).coeffs().cast<float>();
                if (!turns.empty() && q.dot(turns.back()) < 0) q = -q;  // the shorter way
                places.push_back(at.translation().cast<float>());
                turns.push_back(q);
            }
            animate(one.node, "translation", binary_.places(places));
            animate(one.node, "rotation", binary_.quaternions(turns));
        }
    }

    struct Moving {
        std::size_t node;
        std::function<Eigen::Isometry3d(double)> pose;
    };

    const ExportSource& source_;
    Json document_, animation_;
    GlbBinary binary_;
    std::vector<GlbShape> shapes_;
    std::vector<std::size_t> node_of_shape_;
    std::vector<Moving> moving_;
    int times_ = -1;
};

}  // namespace

Written export_glb(const ExportSource& source, const std::filesystem::path& folder, const std::string& name) {
    return GlbExport(source, name).write(folder / (file_name(name) + ".glb"));
}

}  // namespace unravel::tool
