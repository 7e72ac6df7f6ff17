#include <algorithm>

#include "sim/mesh/gltf_parts.hpp"

namespace unravel::sim {

namespace {

constexpr std::size_t most_keys = 1'000'000;

std::size_t targets_of(const Figure& figure, std::uint32_t node) {
    for (const Figure::Piece& piece : figure.pieces)
        if (piece.node == node) return piece.targets.size();
    return 0;
}

void read_channel(const tinygltf::Model& model, const tinygltf::AnimationChannel& from,
                  const tinygltf::AnimationSampler& sampler, std::uint32_t node, Figure& figure) {
    Figure::Channel channel;
    channel.node = node;
    std::size_t element = 3;
    if (from.target_path == "translation") {
        channel.path = Figure::Path::translation;
    } else if (from.target_path == "scale") {
        channel.path = Figure::Path::scale;
    } else if (from.target_path == "rotation") {
        channel.path = Figure::Path::rotation;
        channel.width = element = 4;
    } else if (from.target_path == "weights") {
        channel.path = Figure::Path::weights;
        channel.width = targets_of(figure, node);
        element = 1;
        if (channel.width == 0) return;
    } else {
        return;
    }
    channel.interpolation = sampler.interpolation == "STEP"          ? Figure::Interpolation::step
                            : sampler.interpolation == "CUBICSPLINE" ? Figure::Interpolation::cubic
                                                                     : Figure::Interpolation::linear;
    channel.times = gltf_numbers(model, sampler.input, 1, most_keys);
    channel.values = gltf_numbers(model, sampler.output, element, most_keys * 16);
    const std::size_t each = channel.width * (channel.interpolation == Figure::Interpolation::cubic ? 3 : 1);
    if (channel.times.empty() || channel.values.size() != channel.times.size() * each)
        throw GltfError("a channel of its animation has not a value for each key");
    for (std::size_t k = 1; k < channel.times.size(); ++k) {
        if (!(channel.times[k] > channel.times[k - 1]))
            throw GltfError("the keys of a channel of its animation do not follow one another");
    }
    figure.channels.push_back(std::move(channel));
}

}  // namespace

std::string gltf_animations(const tinygltf::Model& model) {
    std::string out;
    for (std::size_t k = 0; k < std::min<std::size_t>(model.animations.size(), 12); ++k)
        out += fmt::format("{}\"{}\"", k > 0 ? ", " : "", model.animations[k].name.substr(0, 60));
    return out;
}

void add_gltf_animation(const tinygltf::Model& model, const std::string& name,
                        const std::vector<std::uint32_t>& number, Figure& figure) {
    const auto found = std::find_if(model.animations.begin(), model.animations.end(),
                                    [&](const tinygltf::Animation& one) { return one.name == name; });
    if (found == model.animations.end())
        throw GltfError(model.animations.empty() ? "it has no animations"
                                                 : fmt::format("it has no animation \"{}\", but {}", name,
                                                               gltf_animations(model)));
    for (const tinygltf::AnimationChannel& channel : found->channels) {
        if (channel.target_node < 0) continue;  // of an extension
        gltf_item(model.nodes, channel.target_node, "node");
        const std::uint32_t node = number[static_cast<std::size_t>(channel.target_node)];
        if (node == Figure::no_node || figure.nodes[node].has_matrix) continue;
        read_channel(model, channel, gltf_item(found->samplers, channel.sampler, "sampler"), node, figure);
    }
    if (figure.channels.empty()) throw GltfError(fmt::format("its animation \"{}\" moves nothing", name));
}

}  // namespace unravel::sim
