#include "sim/mesh/ply.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>

#include "sim/mesh/cut_polygon.hpp"
#include "sim/scene/limits.hpp"

namespace unravel::sim {

namespace {

static_assert(std::endian::native == std::endian::little, "other machines turn the other files round");

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<PlyType> type_named(std::string_view name) {
    constexpr std::string_view names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                             {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                             {"float", "float32"}, {"double", "float64"}};
    for (std::size_t k = 0; k < std::size(names); ++k) {
        if (name == names[k][0] || name == names[k][1]) return static_cast<PlyType>(k);
    }
    return {};
}

constexpr std::size_t size_of(PlyType type) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count;  // of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

// Values one after the other, text or binary.
class PlyValues {
public:
    enum class Form { text, little, big };
    PlyValues(std::span<const std::uint8_t> bytes, Form form) : bytes_(bytes), form_(form) {}

    bool next(PlyType type, double& out) { return form_ == Form::text ? word(out) : binary(type, out); }

private:
    bool word(double& out) {
        const auto blank = [](std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
        std::size_t begin = 0;
        while (begin < bytes_.size() && blank(bytes_[begin])) ++begin;
        std::size_t end = begin;
        while (end < bytes_.size() && !blank(bytes_[end])) ++end;
        const char* text = reinterpret_cast<const char*>(bytes_.data());
        if (begin < end && text[begin] == '+') ++begin;
        const auto [last, error] = std::from_chars(text + begin, text + end, out);
        if (error == std::errc::result_out_of_range && last == text + end) out = 0;
        bytes_ = bytes_.subspan(end);
        return begin < end && last == text + end && error != std::errc::invalid_argument;
    }

    bool binary(PlyType type, double& out) {
        std::uint8_t raw[8];
        const std::size_t size = size_of(type);
        if (bytes_.size() < size) return false;
        std::memcpy(raw, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
        if (form_ == Form::big) std::reverse(raw, raw + size);
        const auto as = [&](auto value) {
            std::memcpy(&value, raw, sizeof value);
            out = static_cast<double>(value);
        };
        switch (type) {
            case PlyType::int8:
                as(std::int8_t{});
                break;
            case PlyType::uint8:
                as(std::uint8_t{});
                break;
            case PlyType::int16:
                as(std::int16_t{});
                break;
            case PlyType::uint16:
                as(std::uint16_t{});
                break;
            case PlyType::int32:
                as(std::int32_t{});
                break;
            case PlyType::uint32:
                as(std::uint32_t{});
                break;
            case PlyType::float32:
                as(float{});
                break;
            case PlyType::float64:
                as(double{});
                break;
        }
        return true;
    }

    std::span<const std::uint8_t> bytes_;
    Form form_;
};

class PlyParser {
public:
    PlyParser(std::span<const std::uint8_t> bytes, MeshMessages& said) : bytes_(bytes), said_(said) {}

    PolygonMesh parse() {
        mesh_.parts.emplace_back();
        if (header()) {
            PlyValues values(bytes_, form_);
            for (const PlyElement& element : elements_) {
                if (!read(element, values)) break;
            }
        }
        note_cut_faces(cut_, said_);
        finish_numbering(mesh_);
        return std::move(mesh_);
    }

private:
    bool wrong(std::string what, std::string hint = "export it again") {
        said_.fault(0, std::move(what), std::move(hint));
        return false;
    }

    bool header_line(std::string& line) {
        const auto end = std::find(bytes_.begin(), bytes_.end(), '\n');
        if (end == bytes_.end() || end - bytes_.begin() > 4096) return false;
        line.assign(bytes_.begin(), end);
        if (line.ends_with('\r')) line.pop_back();
        bytes_ = bytes_.subspan(static_cast<std::size_t>(end - bytes_.begin()) + 1);
        return true;
    }

    bool header() {
        std::string line;
        if (!header_line(line) || line != "ply") return wrong("it is no PLY file");
        while (header_line(line)) {
            std::istringstream words(line);
            std::string keyword, first, second, third, name;
            words >> keyword;
            if (keyword == "end_header") return true;
            if (keyword == "format") {
                words >> first;
                if (first != "ascii" && first != "binary_little_endian" && first != "binary_big_endian")
                    return wrong("its header names no format that there is");
                form_ = first == "ascii"                  ? PlyValues::Form::text
                        : first == "binary_little_endian" ? PlyValues::Form::little
                                                          : PlyValues::Form::big;
            } else if (keyword == "element") {
                elements_.emplace_back();
                if (!(words >> elements_.back().name >> elements_.back().count))
                    return wrong("an element in its header has no number");
            } else if (keyword == "property" && !elements_.empty()) {
                PlyProperty property;
                words >> first;
                const bool list = first == "list";
                if (list) words >> second >> first;
                words >> property.name;
                const auto type = type_named(first), count = type_named(second);
                if (!type || (list && !count))
                    return wrong("a property in its header has no type that there is");
                property.type = *type;
                if (list) property.count = count;
                elements_.back().properties.push_back(std::move(property));
            }
        }
        return wrong("its header has no end");
    }

    bool read(const PlyElement& element, PlyValues& values) {
        const bool vertices = element.name == "vertex", faces = element.name == "face";
        const auto limit = vertices ? std::size_t{max_particles} : 2 * std::size_t{max_particles};
        if (element.count > limit && (vertices || faces))
            return wrong(fmt::format("more than {} of '{}'", limit, element.name),
                         "that is more than a run can hold");
        // An element of no properties takes no bytes, however many there are.
        if (element.properties.empty()) return true;
        for (std::size_t k = 0; k < element.count; ++k) {
            if (!read_one(element, values)) return false;
            if (vertices && !add_vertex()) return false;
            if (faces && !add_face(k)) return false;
        }
        return true;
    }

    bool read_one(const PlyElement& element, PlyValues& values) {
        x_ = {0, 0, 0};
        uv_ = {0, 0};
        has_uv_ = false;
        corners_.clear();
        for (const PlyProperty& property : element.properties) {
            double count = 1;
            if (property.count && !values.next(*property.count, count)) return ends(element);
            if (!(count >= 0 && count <= static_cast<double>(most_corners)))
                return wrong(fmt::format("a list of {} in '{}'", count, element.name),
                             fmt::format("at most {} corners are read", most_corners));
            const std::string& name = property.name;
            const bool indices = property.count && (name == "vertex_indices" || name == "vertex_index");
            for (double k = 0; k < count; ++k) {
                double value = 0;
                if (!values.next(property.type, value)) return ends(element);
                if (indices) corners_.push_back(value);
                if (!property.count) take(name, value);
            }
        }
        return true;
    }

    bool ends(const PlyElement& element) {
        return wrong(fmt::format("it ends within its elements '{}', or holds no number there", element.name));
    }

    void take(const std::string& name, double value) {
        if (name == "x") x_.x() = value;
        if (name == "y") x_.y() = value;
        if (name == "z") x_.z() = value;
        const bool u = name == "s" || name == "u" || name == "texture_u";
        if (u || name == "t" || name == "v" || name == "texture_v") {
            uv_[u ? 0 : 1] = value;
            has_uv_ = true;
        }
    }

    bool add_vertex() {
        const auto sound = [](const auto& values) {
            return values.allFinite() && values.cwiseAbs().maxCoeff() <= largest_coordinate;
        };
        if (!sound(x_) || !sound(uv_))
            return wrong(fmt::format("vertex {} is not finite or too far away", mesh_.positions.size() + 1),
                         fmt::format("coordinates go up to {:g}", largest_coordinate));
        mesh_.positions.push_back(x_);
        if (has_uv_) mesh_.uvs.push_back(uv_);
        return true;
    }

    bool add_face(std::size_t number) {
        std::vector<std::uint32_t> vertex, uv;
        const bool textured = mesh_.uvs.size() == mesh_.positions.size();
        for (const double corner : corners_) {
            if (!(corner >= 0 && corner < static_cast<double>(mesh_.positions.size())))
                return wrong(fmt::format("face {} names vertex {}, and there are {} before it (from 0)",
                                         number + 1, corner, mesh_.positions.size()));
            vertex.push_back(static_cast<std::uint32_t>(corner));
            uv.push_back(textured ? vertex.back() : no_index);
        }
        cut_ +=
            add_polygon(mesh_, std::move(vertex), std::move(uv), 0, static_cast<std::uint32_t>(number), 0);
        return true;
    }

    std::span<const std::uint8_t> bytes_;
    MeshMessages& said_;
    PolygonMesh mesh_;
    PlyValues::Form form_ = PlyValues::Form::text;
    std::vector<PlyElement> elements_;
    Vec3 x_;
    Vec2 uv_;
    bool has_uv_ = false;
    std::vector<double> corners_;
    std::size_t cut_ = 0;
};

}  // namespace

PolygonMesh parse_ply(std::span<const std::uint8_t> bytes, MeshMessages& said) {
    return PlyParser(bytes, said).parse();
}

}  // namespace unravel::sim
