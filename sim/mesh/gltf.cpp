#include "sim/mesh/gltf.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "sim/mesh/gltf_parts.hpp"
#include "sim/mesh/gltf_values.hpp"
#include "sim/scene/limits.hpp"

namespace unravel::sim {

namespace {

constexpr std::size_t most_joints = 4096, most_targets = 1024;

Vec3 vec3(const std::vector<double>& values, std::size_t k) {
    return {values[3 * k], values[3 * k + 1], values[3 * k + 2]};
}

class GltfReader {
public:
    GltfReader(const tinygltf::Model& model, MeshMessages& said) : model_(model), said_(said) {}

    PolygonMesh mesh;
    Figure figure;

    void read(const std::string& animation) {
        mesh.parts.emplace_back();
        read_nodes();
        for (const std::size_t n : order_) {
            const tinygltf::Node& node = model_.nodes[n];
            if (node.mesh >= 0) read_mesh(node, number_[n]);
        }
        if (!animation.empty())
            add_gltf_animation(model_, animation, number_, figure);
        else if (!model_.animations.empty())
            said_.notes.push_back(fmt::format("the scene names no animation, so none is played; it has {}",
                                              gltf_animations(model_)));
        if (passed_over_ > 0)
            said_.notes.push_back(fmt::format("{} no triangles: passed over",
                                              counted(passed_over_, "primitive has", "primitives have")));
        figure.pose(animation.empty() ? 0 : first_key(), mesh.positions);
        for (const Vec3& x : mesh.positions) {
            if (!x.allFinite() || x.cwiseAbs().maxCoeff() > largest_coordinate)
                throw GltfError(fmt::format("a vertex stands beyond {:g} m", largest_coordinate));
        }
        finish_numbering(mesh);
    }

private:
    // The nodes of the scene, parents first. A node that is reached again would make the tree none.
    void read_nodes() {
        number_.assign(model_.nodes.size(), Figure::no_node);
        std::vector<int> roots;
        if (!model_.scenes.empty()) {
            roots = gltf_item(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes;
        } else {
            std::vector<char> is_child(model_.nodes.size(), 0);
            for (const tinygltf::Node& node : model_.nodes) {
                for (const int child : node.children) {
                    gltf_item(model_.nodes, child, "node");
                    is_child[static_cast<std::size_t>(child)] = 1;
                }
            }
            for (std::size_t n = 0; n < is_child.size(); ++n)
                if (!is_child[n]) roots.push_back(static_cast<int>(n));
        }
        std::vector<std::pair<int, std::uint32_t>> open;
        for (const int root : roots) open.emplace_back(root, Figure::no_node);
        for (std::size_t k = 0; k < open.size(); ++k) {
            const auto [index, parent] = open[k];
            const tinygltf::Node& node = gltf_item(model_.nodes, index, "node");
            const auto n = static_cast<std::size_t>(index);
            if (number_[n] != Figure::no_node) throw GltfError(fmt::format("node {} has two parents", index));
            number_[n] = static_cast<std::uint32_t>(figure.nodes.size());
            order_.push_back(n);
            figure.nodes.push_back(placed_node(node, parent));
            for (const int child : node.children) open.emplace_back(child, number_[n]);
        }
    }

    static Figure::Node placed_node(const tinygltf::Node& from, std::uint32_t parent) {
        Figure::Node node;
        node.parent = parent;
        if (from.translation.size() == 3) node.translation = Vec3(from.translation.data());
        if (from.scale.size() == 3) node.scale = Vec3(from.scale.data());
        if (from.rotation.size() == 4) {
            const Eigen::Quaterniond q(from.rotation[3], from.rotation[0], from.rotation[1],
                                       from.rotation[2]);
            if (q.norm() > 0) node.rotation = q.normalized();
        }
        if (from.matrix.size() == 16) {
            node.matrix.matrix() = Eigen::Map<const Eigen::Matrix4d>(from.matrix.data());
            node.has_matrix = true;
        }
        node.weights = from.weights;
        return node;
    }

    void read_mesh(const tinygltf::Node& node, std::uint32_t number) {
        const tinygltf::Mesh& from = gltf_item(model_.meshes, node.mesh, "mesh");
        if (figure.nodes[number].weights.empty()) figure.nodes[number].weights = from.weights;
        for (const tinygltf::Primitive& primitive : from.primitives) {
            const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
            const auto position = primitive.attributes.find("POSITION");
            if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN ||
                position == primitive.attributes.end()) {
                ++passed_over_;
                continue;
            }
            PolygonMesh::Part part;
            for (const std::string& name : {node.name, from.name})
                if (!name.empty()) part.objects.push_back(name);
            if (primitive.material >= 0 &&
                !gltf_item(model_.materials, primitive.material, "material").name.empty())
                part.groups.push_back(model_.materials[static_cast<std::size_t>(primitive.material)].name);
            if (mesh.parts.size() > max_list)
                throw GltfError(fmt::format("more than {} primitives", max_list));
            mesh.parts.push_back(std::move(part));
            read_primitive(primitive, mode, position->second, number, node.skin);
        }
    }

    void read_primitive(const tinygltf::Primitive& primitive, int mode, int position, std::uint32_t node,
                        int skin) {
        const std::size_t count = gltf_count(model_, position);
        if (mesh.positions.size() + count > std::size_t{max_particles})
            throw GltfError(fmt::format("more than {} vertices", max_particles));
        const std::vector<double> x = gltf_numbers(model_, position, 3, count);
        Figure::Piece piece;
        piece.node = node;
        piece.first = static_cast<std::uint32_t>(figure.positions.size());
        std::vector<std::vector<double>> targets;
        if (primitive.targets.size() > most_targets)
            throw GltfError(fmt::format("more than {} morph targets", most_targets));
        if (count * primitive.targets.size() * sizeof(Eigen::Vector3f) > max_sample_bytes)
            throw GltfError("its morph targets are more than a run can hold");
        for (const auto& target : primitive.targets) {
            const auto moved = target.find("POSITION");
            targets.push_back(moved == target.end() ? std::vector<double>(3 * count, 0.0)
                                                    : attribute(moved->second, 3, count));
        }
        std::vector<double> joints, weights;
        std::size_t influences = 0;
        if (skin >= 0) {
            piece.skin = read_skin(skin);
            for (int set = 0; set < 4; ++set) {
                const auto joint = primitive.attributes.find(fmt::format("JOINTS_{}", set));
                const auto weight = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
                if (joint == primitive.attributes.end() || weight == primitive.attributes.end()) break;
                append(joints, attribute(joint->second, 4, count));
                append(weights, attribute(weight->second, 4, count));
                influences += 4;
            }
            if (influences == 0) throw GltfError("a mesh has a skin, and no joints and weights");
        }
        const std::vector<std::uint32_t> same =
            number_alike(count, {&x, &joints, &weights}, targets, influences);
        // What each vertex of the file became, and the vertices that stay.
        std::vector<std::uint32_t> vertex(count), kept;
        for (std::uint32_t v = 0; v < count; ++v) {
            if (same[v] == v) {
                vertex[v] = piece.first + static_cast<std::uint32_t>(kept.size());
                kept.push_back(v);
            } else {
                vertex[v] = vertex[same[v]];
            }
        }
        piece.count = static_cast<std::uint32_t>(kept.size());
        for (const std::uint32_t v : kept) figure.positions.push_back(vec3(x, v));
        for (const std::vector<double>& target : targets) {
            piece.targets.emplace_back();
            for (const std::uint32_t v : kept) piece.targets.back().push_back(vec3(target, v).cast<float>());
        }
        if (piece.skin != Figure::no_node) take_influences(piece, kept, joints, weights, count, influences);
        const bool turned = piece.skin == Figure::no_node && mirrors(node);
        mesh.positions.resize(figure.positions.size());
        add_faces(primitive, mode, count, vertex, turned);
        figure.pieces.push_back(std::move(piece));
    }

    std::vector<double> attribute(int accessor, std::size_t width, std::size_t count) const {
        if (gltf_count(model_, accessor) != count)
            throw GltfError(
                fmt::format("accessor {} has not as many elements as its primitive has vertices", accessor));
        return gltf_numbers(model_, accessor, width, count);
    }

    static void append(std::vector<double>& all, const std::vector<double>& more) {
        all.insert(all.end(), more.begin(), more.end());
    }

    // The first vertex that is where each is, and moves as it does.
    static std::vector<std::uint32_t> number_alike(std::size_t count,
                                                   const std::array<const std::vector<double>*, 3>& parts,
                                                   const std::vector<std::vector<double>>& targets,
                                                   std::size_t influences) {
        const auto compare_run = [](const std::vector<double>& values, std::size_t width, std::size_t a,
                                    std::size_t b) {
            for (std::size_t c = 0; c < width; ++c) {
                const double p = values[a * width + c], q = values[b * width + c];
                if (p != q) return p < q ? -1 : 1;
            }
            return 0;
        };
        const auto compare = [&](std::uint32_t a, std::uint32_t b) {
            if (const int order = compare_run(*parts[0], 3, a, b)) return order;
            for (std::size_t set = 0; set < influences / 4; ++set) {
                for (const std::size_t which : {1, 2}) {
                    if (const int order = compare_run(*parts[which], 4, set * count + a, set * count + b))
                        return order;
                }
            }
            for (const std::vector<double>& target : targets) {
                if (const int order = compare_run(target, 3, a, b)) return order;
            }
            return 0;
        };
        std::vector<std::uint32_t> order(count), first(count);
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return compare(a, b) < 0; });
        for (std::size_t k = 0; k < count; ++k)
            first[order[k]] = k > 0 && compare(order[k - 1], order[k]) == 0 ? first[order[k - 1]] : order[k];
        return first;
    }

    void take_influences(Figure::Piece& piece, const std::vector<std::uint32_t>& kept,
                         const std::vector<double>& joints, const std::vector<double>& weights,
                         std::size_t count, std::size_t influences) const {
        const std::size_t there = figure.skins[piece.skin].joints.size();
        for (const std::uint32_t v : kept) {
            piece.first_influence.push_back(static_cast<std::uint32_t>(piece.influences.size()));
            double sum = 0;
            for (std::size_t i = 0; i < influences; ++i) {
                const std::size_t k = (i / 4 * count + v) * 4 + i % 4;
                if (!(weights[k] > 0)) continue;
                if (!(joints[k] >= 0 && joints[k] < static_cast<double>(there)))
                    throw GltfError(fmt::format("a vertex hangs on joint {} of {}", joints[k], there));
                piece.influences.push_back({static_cast<std::uint32_t>(joints[k]), weights[k]});
                sum += weights[k];
            }
            if (!(sum > 0)) throw GltfError("a vertex of a skin hangs on no joint");
            for (std::size_t i = piece.first_influence.back(); i < piece.influences.size(); ++i)
                piece.influences[i].weight /= sum;
        }
        piece.first_influence.push_back(static_cast<std::uint32_t>(piece.influences.size()));
    }

    std::uint32_t read_skin(int index) {
        if (const auto known = skins_.find(index); known != skins_.end()) return known->second;
        const tinygltf::Skin& from = gltf_item(model_.skins, index, "skin");
        Figure::Skin skin;
        if (from.joints.empty() || from.joints.size() > most_joints)
            throw GltfError(fmt::format("a skin of {} joints", from.joints.size()));
        for (const int joint : from.joints) {
            gltf_item(model_.nodes, joint, "node");
            const std::uint32_t node = number_[static_cast<std::size_t>(joint)];
            if (node == Figure::no_node)
                throw GltfError(fmt::format("joint {} is no node of the scene", joint));
            skin.joints.push_back(node);
        }
        skin.inverse_bind.assign(skin.joints.size(), Eigen::Affine3d::Identity());
        if (from.inverseBindMatrices >= 0) {
            const std::vector<double> values = attribute(from.inverseBindMatrices, 16, skin.joints.size());
            for (std::size_t j = 0; j < skin.joints.size(); ++j)
                skin.inverse_bind[j].matrix() = Eigen::Map<const Eigen::Matrix4d>(values.data() + 16 * j);
        }
        skins_[index] = static_cast<std::uint32_t>(figure.skins.size());
        figure.skins.push_back(std::move(skin));
        return skins_[index];
    }

    // Whether a node's place turns the mesh inside out.
    bool mirrors(std::uint32_t node) const {
        bool turned = false;
        for (; node != Figure::no_node; node = figure.nodes[node].parent) {
            const Figure::Node& at = figure.nodes[node];
            turned ^= (at.has_matrix ? at.matrix.linear().determinant() : at.scale.prod()) < 0;
        }
        return turned;
    }

    void add_faces(const tinygltf::Primitive& primitive, int mode, std::size_t count,
                   const std::vector<std::uint32_t>& vertex, bool turned) {
        std::vector<std::uint32_t> index(count);
        std::iota(index.begin(), index.end(), 0u);
        if (primitive.indices >= 0) {
            index.clear();
            for (const double value :
                 gltf_numbers(model_, primitive.indices, 1, 6 * std::size_t{max_particles})) {
                if (!(value >= 0 && value < static_cast<double>(count)))
                    throw GltfError(fmt::format("a triangle names vertex {} of {}", value, count));
                index.push_back(static_cast<std::uint32_t>(value));
            }
        }
        const auto first_uv = static_cast<std::uint32_t>(mesh.uvs.size());
        const auto texture = primitive.attributes.find("TEXCOORD_0");
        const bool textured = texture != primitive.attributes.end();
        if (textured) {
            const std::vector<double> uv = attribute(texture->second, 2, count);
            // A picture's first row is where v = 0 there, and where v = 1 here.
            for (std::size_t v = 0; v < count; ++v) mesh.uvs.emplace_back(uv[2 * v], 1 - uv[2 * v + 1]);
        }
        const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
        const auto part = static_cast<std::uint32_t>(mesh.parts.size() - 1);
        for (std::size_t k = 0; k + 2 < index.size(); k += step) {
            std::array<std::uint32_t, 3> corner{index[k], index[k + 1], index[k + 2]};
            if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && k % 2 == 1) std::swap(corner[1], corner[2]);
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN) corner[0] = index[0];
            if (turned) std::swap(corner[1], corner[2]);
            PolygonMesh::Face face{3, {}, {}};
            face.vertex.fill(no_index);
            face.uv.fill(no_index);
            for (std::size_t c = 0; c < 3; ++c) {
                face.vertex[c] = vertex[corner[c]];
                if (textured) face.uv[c] = first_uv + corner[c];
            }
            if (mesh.faces.size() >= 2 * std::size_t{max_particles})
                throw GltfError("it has more triangles than a run can hold");
            mesh.add_face(face, part, static_cast<std::uint32_t>(mesh.faces.size()), 0);
            for (const std::string& name : mesh.parts.back().objects) remember(name, face);
            for (const std::string& name : mesh.parts.back().groups) remember(name, face);
        }
    }

    void remember(const std::string& name, const PolygonMesh::Face& face) {
        std::vector<std::uint32_t>& group = mesh.groups[name];
        group.insert(group.end(), face.vertex.begin(), face.vertex.begin() + 3);
    }

    double first_key() const {
        double first = figure.duration();
        for (const Figure::Channel& channel : figure.channels) first = std::min(first, channel.times.front());
        return first;
    }

    const tinygltf::Model& model_;
    MeshMessages& said_;
    std::vector<std::uint32_t> number_;  // (nodes of the file) in the figure
    std::vector<std::size_t> order_;     // (nodes of the figure) in the file
    std::map<int, std::uint32_t> skins_;
    std::size_t passed_over_ = 0;
};

}  // namespace

PolygonMesh parse_gltf(std::span<const std::uint8_t> bytes, const std::string& animation, MeshMessages& said,
                       std::shared_ptr<const Figure>& figure) {
    try {
        const tinygltf::Model model = parse_gltf_document(bytes);
        GltfReader reader(model, said);
        reader.read(animation);
        if (!animation.empty()) figure = std::make_shared<const Figure>(std::move(reader.figure));
        return std::move(reader.mesh);
    } catch (const GltfError& error) {
        said.fault(0, error.what());
    } catch (const std::exception& error) {
        said.fault(0, fmt::format("it can't be read: {}", std::string(error.what()).substr(0, 200)),
                   "export it again as GLB");
    }
    return {};
}

}  // namespace unravel::sim
