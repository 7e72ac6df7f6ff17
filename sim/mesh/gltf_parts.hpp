#pragma once

// Parts of the reading of glTF files that stand by themselves. All throw GltfError.

#include <fmt/core.h>
#include <tiny_gltf.h>

#include <span>
#include <vector>

#include "sim/mesh/figure.hpp"
#include "sim/mesh/gltf_values.hpp"

namespace unravel::sim {

/// The document of a glTF file that holds its own data, binary or text, that needs no extension which changes
/// what its meshes are.
tinygltf::Model parse_gltf_document(std::span<const std::uint8_t> bytes);

/// Adds the channels of the animation of that name to a figure whose nodes and pieces are there. `number`: of
/// the document's nodes, in the figure's.
void add_gltf_animation(const tinygltf::Model& model, const std::string& name,
                        const std::vector<std::uint32_t>& number, Figure& figure);

/// The names of its animations, in quotes; of many only the first.
std::string gltf_animations(const tinygltf::Model& model);

template <class T>
const T& gltf_item(const std::vector<T>& all, int k, const char* what) {
    if (k < 0 || static_cast<std::size_t>(k) >= all.size())
        throw GltfError(fmt::format("there is no {} {}", what, k));
    return all[static_cast<std::size_t>(k)];
}

}  // namespace unravel::sim
