#include "sim/mesh/gltf_values.hpp"

#include <fmt/core.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace unravel::sim {

namespace {

template <class T>
double as_number(const unsigned char* from, bool normalised) {
    T value;
    std::memcpy(&value, from, sizeof value);
    if constexpr (!std::is_floating_point_v<T>) {
        if (normalised)
            return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()),
                            -1.0);
    }
    return static_cast<double>(value);
}

double number_at(const unsigned char* from, int type, bool normalised) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return as_number<std::int8_t>(from, normalised);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return as_number<std::uint8_t>(from, normalised);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return as_number<std::int16_t>(from, normalised);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return as_number<std::uint16_t>(from, normalised);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return as_number<std::uint32_t>(from, normalised);
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return as_number<float>(from, false);
        default:
            throw GltfError(fmt::format("numbers of the unknown type {}", type));
    }
}

// `count` elements of `width` numbers in a buffer view.
void read_view(const tinygltf::Model& model, int view, std::size_t offset, std::size_t stride, int type,
               bool normalised, std::size_t width, std::size_t count, std::vector<double>& out) {
    if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
        throw GltfError(fmt::format("there is no buffer view {}", view));
    const tinygltf::BufferView& from = model.bufferViews[static_cast<std::size_t>(view)];
    if (from.buffer < 0 || static_cast<std::size_t>(from.buffer) >= model.buffers.size())
        throw GltfError(fmt::format("there is no buffer {}", from.buffer));
    const std::span<const unsigned char> data(model.buffers[static_cast<std::size_t>(from.buffer)].data);
    const std::int32_t bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
    if (bytes <= 0) throw GltfError(fmt::format("numbers of the unknown type {}", type));
    const std::size_t size = static_cast<std::size_t>(bytes), element = size * width;
    if (stride == 0) stride = from.byteStride == 0 ? element : from.byteStride;
    if (from.byteOffset > data.size() || from.byteLength > data.size() - from.byteOffset ||
        stride > from.byteLength || offset > from.byteLength ||
        (count > 0 &&
         (element > from.byteLength - offset ||
          (count - 1) > (from.byteLength - offset - element) / std::max<std::size_t>(stride, 1))))
        throw GltfError("an accessor reaches beyond its data");
    out.reserve(count * width);
    for (std::size_t k = 0; k < count; ++k) {
        const unsigned char* at = data.data() + from.byteOffset + offset + k * stride;
        for (std::size_t c = 0; c < width; ++c) out.push_back(number_at(at + c * size, type, normalised));
    }
}

}  // namespace

std::size_t gltf_count(const tinygltf::Model& model, int accessor) {
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size())
        throw GltfError(fmt::format("there is no accessor {}", accessor));
    return model.accessors[static_cast<std::size_t>(accessor)].count;
}

std::vector<double> gltf_numbers(const tinygltf::Model& model, int accessor, std::size_t width,
                                 std::size_t most) {
    if (gltf_count(model, accessor) > most)
        throw GltfError(fmt::format("accessor {} has more than {} elements", accessor, most));
    const tinygltf::Accessor& from = model.accessors[static_cast<std::size_t>(accessor)];
    const std::int32_t components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type));
    if (components <= 0 || (width != 0 && static_cast<std::size_t>(components) != width))
        throw GltfError(
            fmt::format("accessor {} has {} numbers per element, not {}", accessor, components, width));
    width = static_cast<std::size_t>(components);
    std::vector<double> out;
    // Without a view it is zeros, which a sparse one then fills.
    if (from.bufferView < 0)
        out.assign(from.count * width, 0.0);
    else
        read_view(model, from.bufferView, from.byteOffset, 0, from.componentType, from.normalized, width,
                  from.count, out);
    if (from.sparse.isSparse) {
        if (from.sparse.count < 0 || static_cast<std::size_t>(from.sparse.count) > from.count)
            throw GltfError(fmt::format("accessor {} replaces more elements than it has", accessor));
        const auto count = static_cast<std::size_t>(from.sparse.count);
        std::vector<double> index, value;
        read_view(model, from.sparse.indices.bufferView,
                  static_cast<std::size_t>(from.sparse.indices.byteOffset), 0,
                  from.sparse.indices.componentType, false, 1, count, index);
        read_view(model, from.sparse.values.bufferView,
                  static_cast<std::size_t>(from.sparse.values.byteOffset), 0, from.componentType,
                  from.normalized, width, count, value);
        for (std::size_t k = 0; k < count; ++k) {
            if (!(index[k] >= 0 && index[k] < static_cast<double>(from.count)))
                throw GltfError(fmt::format("accessor {} replaces element {}", accessor, index[k]));
            std::copy_n(
                value.begin() + static_cast<std::ptrdiff_t>(k * width), width,
                out.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(index[k]) * width));
        }
    }
    for (const double value : out) {
        if (!std::isfinite(value))
            throw GltfError(fmt::format("a number of accessor {} is not finite", accessor));
    }
    return out;
}

}  // namespace unravel::sim
