#include <algorithm>
#include <cstring>

#include "sim/mesh/gltf_parts.hpp"

namespace unravel::sim {

namespace {

constexpr std::size_t glb_head = 12, glb_chunk_head = 8;

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

// Lengths as the format wants them: the library looks no further than the file's own word for it.
void require_frame(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < glb_head + glb_chunk_head || word_at(bytes, 8) > bytes.size())
        throw GltfError("it ends before the length that it gives for itself");
    std::uint64_t at = glb_head;
    while (at + glb_chunk_head <= word_at(bytes, 8)) at += glb_chunk_head + word_at(bytes, at);
    if (at > word_at(bytes, 8)) throw GltfError("a part of it reaches beyond its end");
}

void require_extensions(const tinygltf::Model& model) {
    for (const std::string& name : model.extensionsRequired) {
        if (name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
            name.starts_with("EXT_texture_") || name == "KHR_mesh_quantization" ||
            name == "KHR_lights_punctual")
            continue;
        throw GltfError(fmt::format("it needs the extension {}, which is not read", name.substr(0, 60)));
    }
}

}  // namespace

tinygltf::Model parse_gltf_document(std::span<const std::uint8_t> bytes) {
    tinygltf::TinyGLTF loader;
    // Pictures are not looked at, and other files are not read.
    loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    loader.SetFsCallbacks(
        {[](const std::string&, void*) { return false; }, [](const std::string& path, void*) { return path; },
         [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; },
         [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; },
         nullptr});
    tinygltf::Model model;
    std::string error, warning;
    bool read = false;
    const auto size = static_cast<unsigned int>(bytes.size());
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
        require_frame(bytes);
        read = loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size);
    } else {
        read = loader.LoadASCIIFromString(&model, &error, &warning,
                                          reinterpret_cast<const char*>(bytes.data()), size, "");
    }
    std::replace(error.begin(), error.end(), '\n', ' ');
    if (error.find("File not found") != std::string::npos)
        throw GltfError("its data lies in another file: export it as GLB, which holds its own");
    if (!read) throw GltfError(error.empty() ? "it is no glTF file" : error.substr(0, 200));
    require_extensions(model);
    return model;
}

}  // namespace unravel::sim
