#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "base/whole_file.hpp"

namespace unravel::tool {

/// The binary part of a GLB file as it is laid out: what stands before the morph targets, room for them, and
/// what stands after them. The targets are written by someone who has them, frame by frame.
class GlbBinary {
public:
    using Json = nlohmann::ordered_json;
    static constexpr int float_type = 5126, index_type = 5125;

    Json views = Json::array(), accessors = Json::array();

    /// Accessors of values that are kept here, of a mesh or of an animation. Each returns its number.
    int vertices(std::span<const Eigen::Vector3f> values);  ///< with their bounds
    int pairs(std::span<const Eigen::Vector2f> values);
    int indices(const std::vector<std::uint32_t>& values);
    int scalars(const std::vector<float>& values, bool bounds = false);
    int places(std::span<const Eigen::Vector3f> values);
    int quaternions(const std::vector<Eigen::Vector4f>& values);
    /// A view of a whole file, for pictures. Returns its number.
    int file(std::span<const std::uint8_t> bytes);

    /// Room for vectors that are written later, all such one after the other: before any value that comes
    /// after them. Their bounds are told now.
    int later(std::span<const Eigen::Vector3f> values);

    std::size_t bytes() const { return before_.size() + later_ + after_.size(); }
    const std::vector<std::uint8_t>& before() const { return before_; }
    const std::vector<std::uint8_t>& after() const { return after_; }

private:
    // What a view is for, by the numbers of the format.
    enum Use { animation = 0, attributes = 34962, triangles = 34963 };
    int put(std::span<const std::byte> values, std::size_t count, const char* type, int component, Use use,
            Json more = {});
    int accessor(std::size_t count, const char* type, int component, std::size_t bytes, Use use, Json more);
    void view(std::size_t bytes, Use use);

    std::vector<std::uint8_t> before_, after_;
    std::size_t later_ = 0;
};

/// The file: its header, the document and the binary part, of which `write_later` writes the targets (false:
/// stopped, and there is no file). Throws OutputError, also where it would be larger than the format allows.
bool write_glb(const std::filesystem::path& target, nlohmann::ordered_json document, const GlbBinary& binary,
               const std::function<bool(WholeFile&)>& write_later);

}  // namespace unravel::tool
