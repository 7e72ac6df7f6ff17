#include "sim/mesh/obj.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/mesh/cut_polygon.hpp"
#include "sim/scene/limits.hpp"

namespace unravel::sim {

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

// What most programs write and no polygon mesh needs is passed over without a word.
constexpr std::string_view passed_over[] = {"vn", "vp", "s", "mg", "mtllib", "usemtl"};

constexpr std::size_t most_words = 8;  // unknown ones, named in the note

constexpr bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

// A word of a file as it can be shown.
std::string shown_word(std::string_view word) {
    std::string out(word.substr(0, 40));
    for (char& c : out) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return out;
}

// Statements of the file one by one: lines, joined where one ends in a backslash, without comments.
class ObjLines {
public:
    explicit ObjLines(std::string_view text) : rest_(text) {
        if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
    }

    bool next() {
        if (rest_.empty()) return false;
        line_ = physical_line();
        first_ = number_;
        if (!line_.ends_with('\\')) return true;
        joined_.clear();
        while (line_.ends_with('\\') && !rest_.empty()) {
            joined_.append(line_.substr(0, line_.size() - 1)).push_back(' ');
            line_ = physical_line();
        }
        joined_.append(line_.substr(0, line_.find('\\')));
        line_ = joined_;
        return true;
    }

    // The next word of the statement; empty at its end.
    std::string_view word() {
        line_ = trimmed(line_);
        const std::size_t end = std::min(line_.find_first_of(" \t"), line_.size());
        const std::string_view found = line_.substr(0, end);
        line_ = line_.substr(end);
        return found;
    }
    std::string_view rest_of_line() const { return trimmed(line_); }
    int number() const { return first_; }

private:
    std::string_view physical_line() {
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        std::string_view line = rest_.substr(0, end);
        const bool both = rest_.substr(end).starts_with("\r\n");
        rest_ = rest_.substr(std::min(rest_.size(), end + (both ? 2 : 1)));
        ++number_;
        return trimmed(line.substr(0, line.find('#')));
    }

    std::string_view rest_, line_;
    std::string joined_;
    int number_ = 0, first_ = 0;
};

class ObjParser {
public:
    ObjParser(std::string_view text, MeshMessages& said) : lines_(text), said_(said) {}

    PolygonMesh parse() {
        mesh_.parts.emplace_back();
        while (!said_.full() && !stopped_ && lines_.next()) element(lines_.word());
        if (!stopped_) make_elements();
        if (!unknown_.empty())
            said_.notes.push_back(fmt::format("passed over: lines of '{}'{}", fmt::join(unknown_, "', '"),
                                              more_unknown_ ? " and others" : ""));
        note_cut_faces(cut_, said_);
        finish_numbering(mesh_);
        return std::move(mesh_);
    }

private:
    // Corners of a face, a line or points, as they are written: what they refer to may come later.
    struct Corner {
        std::uint32_t vertex, uv;
    };
    enum class Kind : std::uint8_t { face, line, points, stitch };
    struct Element {
        std::size_t first;  // of its corners
        std::uint32_t part;
        int line;
        Kind kind;
    };

    void fault(std::string what, std::string hint = {}) {
        said_.fault(lines_.number(), std::move(what), std::move(hint));
    }

    void element(std::string_view keyword) {
        if (keyword.empty()) return;
        if (keyword == "v") {
            vertex();
        } else if (keyword == "vt") {
            texture_vertex();
        } else if (keyword == "f") {
            corners(Kind::face);
        } else if (keyword == "l") {
            corners(Kind::line);
        } else if (keyword == "p") {
            corners(Kind::points);
        } else if (keyword == "g" || keyword == "o") {
            enter_part(keyword);
        } else if (keyword == "stitch") {
            stitch();
        } else if (std::find(std::begin(passed_over), std::end(passed_over), keyword) ==
                   std::end(passed_over)) {
            const std::string word = shown_word(keyword);
            if (std::find(unknown_.begin(), unknown_.end(), word) != unknown_.end()) return;
            if (unknown_.size() < most_words)
                unknown_.push_back(word);
            else
                more_unknown_ = true;
        }
    }

    bool number(std::string_view text, double& out) {
        std::string_view digits = text;
        if (digits.starts_with('+')) digits.remove_prefix(1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
        if (error == std::errc::result_out_of_range && end == digits.data() + digits.size()) out = 0;
        if (text.empty() || end != digits.data() + digits.size() || error == std::errc::invalid_argument ||
            !std::isfinite(out) || std::abs(out) > largest_coordinate) {
            fault(text.empty() ? "a coordinate is missing"
                               : fmt::format("'{}' is no coordinate", shown_word(text)),
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
        if (!number(lines_.word(), x.x()) || !number(lines_.word(), x.y()) || !number(lines_.word(), x.z()))
            x.setZero();
        mesh_.positions.push_back(x);
        mesh_.vertex_line.push_back(lines_.number());
    }

    void texture_vertex() {
        Vec2 uv(0, 0);
        if (!within(mesh_.uvs.size(), 4 * std::size_t{max_particles}, "texture vertices")) return;
        // The second number may be absent: it is 0 then.
        if (number(lines_.word(), uv.x()) && !lines_.rest_of_line().empty()) number(lines_.word(), uv.y());
        mesh_.uvs.push_back(uv);
    }

    // One index, from 1, or counted back from the last so far by a negative number.
    bool index(std::string_view text, std::size_t so_far, const char* what, std::uint32_t& out) {
        long long value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty() || error != std::errc() || end != text.data() + text.size() || value == 0) {
            fault(fmt::format("'{}' is no {} number", shown_word(text), what), "they count from 1");
            return false;
        }
        const long long at = value > 0 ? value - 1 : static_cast<long long>(so_far) + value;
        if (at < 0 || at >= static_cast<long long>(no_index)) {
            fault(fmt::format("there is no {} {}", what, value),
                  fmt::format("{} stand before this line", so_far));
            return false;
        }
        out = static_cast<std::uint32_t>(at);
        return true;
    }

    // A corner: v, v/vt, v//vn or v/vt/vn, each after the first maybe empty. Normals are not looked at.
    bool corner(std::string_view text, Corner& out) {
        out.uv = no_index;
        const std::size_t slash = text.find('/');
        if (!index(text.substr(0, slash), mesh_.positions.size(), "vertex", out.vertex)) return false;
        if (slash == std::string_view::npos) return true;
        const std::string_view after = text.substr(slash + 1), texture = after.substr(0, after.find('/'));
        return texture.empty() || index(texture, mesh_.uvs.size(), "texture vertex", out.uv);
    }

    void corners(Kind kind) {
        const std::size_t first = corners_.size();
        if (kind == Kind::face) ++faces_;
        if (!within(elements_.size(), 4 * std::size_t{max_particles}, "faces, lines and points")) return;
        for (std::string_view text = lines_.word(); !text.empty(); text = lines_.word()) {
            Corner out;
            if (!within(corners_.size(), 8 * std::size_t{max_particles}, "corners of faces")) return;
            if (!corner(text, out)) {
                corners_.resize(first);
                return;
            }
            corners_.push_back(out);
        }
        if (kind == Kind::face && corners_.size() - first > most_corners) {
            fault(fmt::format("face {} has {} corners", faces_, corners_.size() - first),
                  fmt::format("at most {} are cut: triangulate it", most_corners));
            corners_.resize(first);
            return;
        }
        elements_.push_back({first, part_, lines_.number(), kind});
    }

    void stitch() {
        std::uint32_t ends[3];
        double ratio = 0;
        for (std::uint32_t& end : ends) {
            const std::string_view text = lines_.word();
            const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), end);
            if (text.empty() || error != std::errc() || last != text.data() + text.size()) {
                fault(fmt::format("'{}' is no vertex number", shown_word(text)), "stitches count from 0");
                return;
            }
        }
        if (!number(lines_.word(), ratio)) return;
        if (!within(elements_.size(), 4 * std::size_t{max_particles}, "faces, lines and points")) return;
        elements_.push_back({corners_.size(), part_, lines_.number(), Kind::stitch});
        corners_.push_back({ends[0], no_index});
        corners_.push_back({ratio < 0.5 ? ends[1] : ends[2], no_index});
    }

    // What follows belongs to these names. An object's holds until the next object, a group's until the next
    // group.
    void enter_part(std::string_view keyword) {
        PolygonMesh::Part part = mesh_.parts[part_];
        std::vector<std::string>& names = keyword == "o" ? part.objects : part.groups;
        names.clear();
        const std::string_view whole = lines_.rest_of_line();
        for (std::string_view name = lines_.word(); !name.empty(); name = lines_.word()) {
            if (!within(names.size(), max_list, "names of a group")) return;
            names.emplace_back(name);
        }
        if (names.size() > 1) names.emplace_back(whole);
        for (const std::string& name : names) {
            if (!mesh_.groups.contains(name) && !within(mesh_.groups.size(), max_list, "groups")) return;
            mesh_.groups[name];
        }
        if (!within(mesh_.parts.size(), 16 * max_list, "changes of group")) return;
        part_ = static_cast<std::uint32_t>(mesh_.parts.size());
        mesh_.parts.push_back(std::move(part));
    }

    // Once all vertices are known: the elements, in their order.
    void make_elements() {
        std::uint32_t part = no_index, face = 0;
        std::vector<std::vector<std::uint32_t>*> members;  // of the part's groups
        for (std::size_t e = 0; e < elements_.size() && !said_.full(); ++e) {
            const Element& element = elements_[e];
            const std::size_t last = e + 1 < elements_.size() ? elements_[e + 1].first : corners_.size();
            const std::span<const Corner> corners(corners_.data() + element.first, last - element.first);
            if (element.part != part) members = members_of(part = element.part);
            if (element.kind == Kind::face) ++face;
            if (!in_range(element, corners)) continue;
            for (const Corner& corner : corners) {
                for (std::vector<std::uint32_t>* group : members) {
                    if (group->empty() || group->back() != corner.vertex) group->push_back(corner.vertex);
                }
            }
            if (element.kind == Kind::face) {
                make_face(element, corners, face - 1);
            } else if (element.kind != Kind::points) {
                for (std::size_t k = 1; k < corners.size(); ++k)
                    mesh_.lines.push_back({corners[k - 1].vertex, corners[k].vertex});
            }
        }
        elements_ = {};
        corners_ = {};
    }

    std::vector<std::vector<std::uint32_t>*> members_of(std::uint32_t part) {
        std::vector<std::vector<std::uint32_t>*> members;
        for (const auto* names : {&mesh_.parts[part].objects, &mesh_.parts[part].groups})
            for (const std::string& name : *names) members.push_back(&mesh_.groups[name]);
        std::sort(members.begin(), members.end());
        members.erase(std::unique(members.begin(), members.end()), members.end());
        return members;
    }

    bool in_range(const Element& element, std::span<const Corner> corners) {
        const int base = element.kind == Kind::stitch ? 0 : 1;
        for (const Corner& corner : corners) {
            if (corner.vertex >= mesh_.positions.size()) {
                said_.fault(element.line,
                            fmt::format("there is no vertex {}", std::size_t{corner.vertex} + base),
                            fmt::format("the file has {}", mesh_.positions.size()));
                return false;
            }
            if (corner.uv != no_index && corner.uv >= mesh_.uvs.size()) {
                said_.fault(element.line,
                            fmt::format("there is no texture vertex {}", std::size_t{corner.uv} + 1),
                            fmt::format("the file has {}", mesh_.uvs.size()));
                return false;
            }
        }
        return true;
    }

    void make_face(const Element& element, std::span<const Corner> corners, std::uint32_t number) {
        std::vector<std::uint32_t> vertex, uv;
        for (const Corner& corner : corners) {
            vertex.push_back(corner.vertex);
            uv.push_back(corner.uv);
        }
        cut_ += add_polygon(mesh_, std::move(vertex), std::move(uv), element.part, number, element.line);
    }

    ObjLines lines_;
    MeshMessages& said_;
    PolygonMesh mesh_;
    std::vector<Corner> corners_;
    std::vector<Element> elements_;
    std::uint32_t part_ = 0;
    std::size_t faces_ = 0, cut_ = 0;
    bool stopped_ = false, more_unknown_ = false;
    std::vector<std::string> unknown_;
};

}  // namespace

PolygonMesh parse_obj(std::string_view text, MeshMessages& said) {
    return ObjParser(text, said).parse();
}

}  // namespace unravel::sim
