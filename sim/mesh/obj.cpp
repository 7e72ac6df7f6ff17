#include "sim/mesh/obj.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/scene/limits.hpp"

namespace unravel::sim {

namespace {

// Farther than this from the origin is a slip or a wrong unit, and squares of it are still safe.
constexpr double largest_coordinate = 1e7;

constexpr bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

class ObjParser {
public:
    ObjParser(std::string_view text, std::vector<MeshFault>& faults, std::size_t most)
        : rest_(text), faults_(faults), most_(most) {}

    ObjMesh parse() {
        while (!rest_.empty() && faults_.size() < most_ && !stopped_) {
            const std::size_t end = rest_.find('\n');
            line_ = rest_.substr(0, end);
            rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
            ++number_;
            if (const std::size_t comment = line_.find('#'); comment != std::string_view::npos)
                line_ = line_.substr(0, comment);
            element(word());
        }
        for (auto& [name, vertices] : mesh_.groups) {
            std::sort(vertices.begin(), vertices.end());
            vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        }
        return std::move(mesh_);
    }

private:
    void fault(std::string what, std::string hint = {}) {
        if (faults_.size() < most_) faults_.push_back({number_, std::move(what), std::move(hint)});
    }

    // The next word of the line; empty at its end.
    std::string_view word() {
        std::size_t begin = 0;
        while (begin < line_.size() && is_blank(line_[begin])) ++begin;
        std::size_t end = begin;
        while (end < line_.size() && !is_blank(line_[end])) ++end;
        const std::string_view found = line_.substr(begin, end - begin);
        line_ = line_.substr(end);
        return found;
    }

    static std::string shown(std::string_view word) {
        std::string out(word.substr(0, 40));
        for (char& c : out) {
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
        }
        return out;
    }

    void element(std::string_view keyword) {
        if (keyword.empty()) return;
        if (keyword == "v") {
            vertex();
        } else if (keyword == "vt") {
            texture_vertex();
        } else if (keyword == "vn") {
            ++normals_;
        } else if (keyword == "f") {
            face();
        } else if (keyword == "l") {
            segments();
        } else if (keyword == "p") {
            points();
        } else if (keyword == "g" || keyword == "o") {
            enter_group(keyword);
        } else if (keyword != "s" && keyword != "mtllib" && keyword != "usemtl" && keyword != "mg" &&
                   keyword != "vp") {
            fault(fmt::format("'{}' begins no line of a polygon mesh", shown(keyword)),
                  "export it as OBJ with polygons, without curves and surfaces");
        }
    }

    bool number(double& out) {
        const std::string_view text = word();
        std::string_view digits = text;
        if (digits.starts_with('+')) digits.remove_prefix(1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
        if (error == std::errc::result_out_of_range && end == digits.data() + digits.size()) out = 0;
        if (text.empty() || end != digits.data() + digits.size() || error == std::errc::invalid_argument ||
            !std::isfinite(out) || std::abs(out) > largest_coordinate) {
            fault(
                text.empty() ? "a coordinate is missing" : fmt::format("'{}' is no coordinate", shown(text)),
                fmt::format("write numbers up to {:g}", largest_coordinate));
            return false;
        }
        return true;
    }

    bool within(std::size_t size, std::size_t limit, const char* what) {
        if (size < limit) return true;
        fault(fmt::format("more than {} {}", limit, what), "that is more than a run can hold");
        stopped_ = true;
        return false;
    }

    void vertex() {
        Vec3 x;
        if (!within(mesh_.positions.size(), max_particles, "vertices")) return;
        // A fourth number is a weight, and some programs add a colour: neither is geometry.
        if (!number(x.x()) || !number(x.y()) || !number(x.z())) x.setZero();
        mesh_.positions.push_back(x);
        mesh_.vertex_line.push_back(number_);
    }

    void texture_vertex() {
        Vec2 uv(0, 0);
        if (!within(mesh_.uvs.size(), 4 * std::size_t{max_particles}, "texture vertices")) return;
        if (!number(uv.x()) || !number(uv.y())) uv.setZero();
        mesh_.uvs.push_back(uv);
    }

    // One index of a list of `count`, from 1, or counted back from the last by a negative number.
    bool index(std::string_view text, std::size_t count, const char* what, std::uint32_t& out) {
        long long value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty() || error != std::errc() || end != text.data() + text.size() || value == 0) {
            fault(fmt::format("'{}' is no {} number", shown(text), what), "they count from 1");
            return false;
        }
        const long long at = value > 0 ? value - 1 : static_cast<long long>(count) + value;
        if (at < 0 || at >= static_cast<long long>(count)) {
            fault(fmt::format("there is no {} {}", what, value),
                  fmt::format("{} stand before this line", count));
            return false;
        }
        out = static_cast<std::uint32_t>(at);
        return true;
    }

    // A corner: v, v/vt, v//vn or v/vt/vn.
    bool corner(std::string_view text, std::uint32_t& vertex, std::uint32_t& uv) {
        uv = no_index;
        const std::size_t slash = text.find('/');
        if (!index(text.substr(0, slash), mesh_.positions.size(), "vertex", vertex)) return false;
        if (slash == std::string_view::npos) return true;
        const std::string_view after = text.substr(slash + 1);
        const std::size_t second = after.find('/');
        const std::string_view texture = after.substr(0, second);
        if (!texture.empty() && !index(texture, mesh_.uvs.size(), "texture vertex", uv)) return false;
        std::uint32_t normal = 0;
        return second == std::string_view::npos ||
               index(after.substr(second + 1), normals_, "normal", normal);
    }

    void remember(std::uint32_t vertex) {
        for (std::vector<std::uint32_t>* group : current_) {
            if (group->empty() || group->back() != vertex) group->push_back(vertex);
        }
    }

    void face() {
        const std::size_t n = mesh_.faces.size() + 1;
        if (!within(mesh_.faces.size(), 2 * std::size_t{max_particles}, "faces")) return;
        ObjMesh::Face face;
        face.vertex.fill(no_index);
        face.uv.fill(no_index);
        std::size_t corners = 0;
        for (std::string_view text = word(); !text.empty(); text = word(), ++corners) {
            std::uint32_t vertex = 0, uv = 0;
            if (!corner(text, vertex, uv)) return;
            if (corners < 4) {
                face.vertex[corners] = vertex;
                face.uv[corners] = uv;
            }
        }
        if (corners < 3 || corners > 4) {
            fault(fmt::format("face {} has {} corners", n, corners),
                  corners > 4 ? "only triangles and quads are cloth: triangulate it"
                              : "a face has three or four");
            return;
        }
        face.corners = static_cast<std::uint8_t>(corners);
        for (std::size_t k = 0; k < corners; ++k) remember(face.vertex[k]);
        mesh_.faces.push_back(face);
        mesh_.face_line.push_back(number_);
    }

    void segments() {
        std::uint32_t before = no_index;
        for (std::string_view text = word(); !text.empty(); text = word()) {
            std::uint32_t vertex = 0, uv = 0;
            if (!corner(text, vertex, uv)) return;
            if (!within(mesh_.lines.size(), 2 * std::size_t{max_particles}, "line segments")) return;
            if (before != no_index) {
                mesh_.lines.push_back({before, vertex});
                mesh_.line_line.push_back(number_);
            }
            remember(vertex);
            before = vertex;
        }
    }

    void points() {
        for (std::string_view text = word(); !text.empty(); text = word()) {
            std::uint32_t vertex = 0;
            if (!index(text, mesh_.positions.size(), "vertex", vertex)) return;
            remember(vertex);
        }
    }

    // What follows belongs to these groups. An object's name holds until the next object, a group's until
    // the next group.
    void enter_group(std::string_view keyword) {
        std::vector<std::string>& names = keyword == "o" ? objects_ : groups_;
        names.clear();
        for (std::string_view name = word(); !name.empty(); name = word()) names.emplace_back(name);
        current_.clear();
        for (const auto* list : {&objects_, &groups_}) {
            for (const std::string& name : *list) {
                if (!mesh_.groups.contains(name) && !within(mesh_.groups.size(), max_list, "groups")) return;
                current_.push_back(&mesh_.groups[name]);
            }
        }
        std::sort(current_.begin(), current_.end());
        current_.erase(std::unique(current_.begin(), current_.end()), current_.end());
    }

    std::string_view rest_, line_;
    std::vector<MeshFault>& faults_;
    std::size_t most_;
    ObjMesh mesh_;
    int number_ = 0;
    std::size_t normals_ = 0;
    bool stopped_ = false;
    std::vector<std::string> objects_, groups_;
    std::vector<std::vector<std::uint32_t>*> current_;  // into mesh_.groups, whose nodes stay where they are
};

}  // namespace

ObjMesh parse_obj(std::string_view text, std::vector<MeshFault>& faults, std::size_t most) {
    return ObjParser(text, faults, most).parse();
}

}  // namespace unravel::sim
