#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace unravel::sim {

/// Something in a glTF file that is not as the format says; what() tells what.
struct GltfError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The numbers of an accessor, one after the other: whole numbers as they are or, where it says so,
/// normalised; sparse ones filled in. `width`: numbers of an element (0: whatever it has). No more than
/// `most` elements. Throws GltfError.
std::vector<double> gltf_numbers(const tinygltf::Model& model, int accessor, std::size_t width,
                                 std::size_t most);

/// Elements of an accessor. Throws GltfError where there is no such.
std::size_t gltf_count(const tinygltf::Model& model, int accessor);

}  // namespace unravel::sim
