#include "tool/export/glb_binary.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace unravel::tool {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

nlohmann::ordered_json bounds_of(std::span<const Eigen::Vector3f> values) {
    Eigen::Vector3f low = values.front(), high = low;
    for (const Eigen::Vector3f& v : values) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    return {{"min", {low.x(), low.y(), low.z()}}, {"max", {high.x(), high.y(), high.z()}}};
}

void write_words(WholeFile& file, std::initializer_list<std::size_t> values) {
    for (const std::size_t value : values) {
        const auto word = static_cast<std::uint32_t>(value);
        file.write(std::as_bytes(std::span(&word, 1)));
    }
}

}  // namespace

void GlbBinary::view(std::size_t size, Use use) {
    views.push_back({{"buffer", 0}, {"byteOffset", bytes()}, {"byteLength", size}});
    if (use != animation) views.back()["target"] = static_cast<int>(use);
}

int GlbBinary::accessor(std::size_t count, const char* type, int component, std::size_t size, Use use,
                        Json more) {
    view(size, use);
    Json made{
        {"bufferView", views.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}};
    if (more.is_object()) made.update(more);
    accessors.push_back(std::move(made));
    return static_cast<int>(accessors.size()) - 1;
}

int GlbBinary::put(std::span<const std::byte> values, std::size_t count, const char* type, int component,
                   Use use, Json more) {
    const int number = accessor(count, type, component, values.size(), use, std::move(more));
    std::vector<std::uint8_t>& to = later_ == 0 ? before_ : after_;
    const auto* from = reinterpret_cast<const std::uint8_t*>(values.data());
    to.insert(to.end(), from, from + values.size());
    return number;
}

int GlbBinary::vertices(std::span<const Eigen::Vector3f> values) {
    return put(std::as_bytes(values), values.size(), "VEC3", float_type, attributes, bounds_of(values));
}

int GlbBinary::pairs(std::span<const Eigen::Vector2f> values) {
    return put(std::as_bytes(values), values.size(), "VEC2", float_type, attributes);
}

int GlbBinary::indices(const std::vector<std::uint32_t>& values) {
    return put(std::as_bytes(std::span(values)), values.size(), "SCALAR", index_type, triangles);
}

int GlbBinary::scalars(const std::vector<float>& values, bool bounds) {
    Json more;
    if (bounds) {
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        more = {{"min", Json::array({*low})}, {"max", Json::array({*high})}};
    }
    return put(std::as_bytes(std::span(values)), values.size(), "SCALAR", float_type, animation,
               std::move(more));
}

int GlbBinary::places(std::span<const Eigen::Vector3f> values) {
    return put(std::as_bytes(values), values.size(), "VEC3", float_type, animation);
}

int GlbBinary::quaternions(const std::vector<Eigen::Vector4f>& values) {
    return put(std::as_bytes(std::span(values)), values.size(), "VEC4", float_type, animation);
}

int GlbBinary::file(std::span<const std::uint8_t> content) {
    view(content.size(), animation);
    std::vector<std::uint8_t>& to = later_ == 0 ? before_ : after_;
    to.insert(to.end(), content.begin(), content.end());
    to.resize((to.size() + 3) / 4 * 4, 0);  // numbers begin at whole words
    return static_cast<int>(views.size()) - 1;
}

int GlbBinary::later(std::span<const Eigen::Vector3f> values) {
    const int number =
        accessor(values.size(), "VEC3", float_type, values.size_bytes(), attributes, bounds_of(values));
    later_ += values.size_bytes();
    return number;
}

bool write_glb(const std::filesystem::path& target, nlohmann::ordered_json document, const GlbBinary& binary,
               const std::function<bool(WholeFile&)>& write_later) {
    document["accessors"] = binary.accessors;
    document["bufferViews"] = binary.views;
    document["buffers"] = nlohmann::ordered_json::array({{{"byteLength", binary.bytes()}}});
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t whole = 12 + 8 + text.size() + 8 + binary.bytes();
    WholeFile file(target);
    if (whole > std::numeric_limits<std::uint32_t>::max())
        throw OutputError(file.target(),
                          "a glTF file holds no more than 4 GiB: export fewer frames (--frames A-B), "
                          "or as pc2");
    write_words(file, {0x46546C67, 2, whole, text.size(), 0x4E4F534A});
    file.write(std::string_view(text));
    write_words(file, {binary.bytes(), 0x004E4942});
    file.write(binary.before());
    if (!write_later(file)) return false;
    file.write(binary.after());
    file.commit();
    return true;
}

}  // namespace unravel::tool
