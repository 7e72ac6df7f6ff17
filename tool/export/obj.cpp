#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

#include "base/whole_file.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "tool/export/export.hpp"

namespace unravel::tool {

namespace {

constexpr std::string_view heading = "# unravel: metres, right-handed, y up\n";

}  // namespace

std::span<const Vec3> positions_of(const ClothPatch& patch, const FrameRecord& record) {
    return std::span(record.state.x).subspan(patch.first, patch.count());
}

std::vector<Vec3> surface_normals(const ClothSurface& surface, std::span<const Vec3> x) {
    std::vector<Vec3> normals(x.size(), Vec3::Zero());
    for (const ClothSurface::Face& face : surface.faces) {
        const auto& [a, b, c, d] = face.vertex;
        const Vec3 n =
            face.corners == 4 ? (x[c] - x[a]).cross(x[d] - x[b]) : (x[b] - x[a]).cross(x[c] - x[a]);
        for (std::size_t k = 0; k < face.corners; ++k) normals[face.vertex[k]] += n;
    }
    for (Vec3& n : normals) n = n.norm() > 0 ? Vec3(n.normalized()) : Vec3::UnitY();
    return normals;
}

std::string file_name(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.';
        out += plain ? c : '_';
    }
    return out.starts_with('.') ? "_" + out : out;
}

std::vector<std::string> file_names(const ExportSource& source) {
    std::vector<std::string> names;
    const auto add = [&](const std::string& wanted) {
        const std::string plain = file_name(wanted);
        std::string name = plain;
        for (int k = 2; std::find(names.begin(), names.end(), name) != names.end(); ++k)
            name = fmt::format("{}_{}", plain, k);
        names.push_back(name);
    };
    for (const ClothPatch& patch : source.model.cloths) add(patch.name);
    for (const ExportSolid& solid : source.solids) add(solid.name);
    return names;
}

std::string obj_text(const std::string& name, const ExportSolid& solid, std::span<const Vec3> x,
                     std::size_t vertices) {
    fmt::memory_buffer out;
    const auto to = std::back_inserter(out);
    fmt::format_to(to, "o {}\n", name);
    for (const Vec3& p : x) fmt::format_to(to, "v {} {} {}\n", p.x(), p.y(), p.z());
    for (const auto& [a, b, c] : solid.triangles)
        fmt::format_to(to, "f {} {} {}\n", vertices + a + 1, vertices + b + 1, vertices + c + 1);
    return fmt::to_string(out);
}

std::string obj_text(const std::string& name, const ClothPatch& patch, const ClothSurface& surface,
                     std::span<const Vec3> x, std::size_t vertices, std::size_t uvs) {
    fmt::memory_buffer out;
    const auto to = std::back_inserter(out);
    fmt::format_to(to, "o {}\n", name);
    // fmt's {} is the shortest text that reads back to the same double.
    for (const Vec3& p : x) fmt::format_to(to, "v {} {} {}\n", p.x(), p.y(), p.z());
    for (const Vec2& uv : surface.uvs) fmt::format_to(to, "vt {} {}\n", uv.x(), uv.y());
    for (const Vec3& n : surface_normals(surface, x))
        fmt::format_to(to, "vn {:.6f} {:.6f} {:.6f}\n", n.x(), n.y(), n.z());
    for (const ClothSurface::Face& face : surface.faces) {
        fmt::format_to(to, "f");
        for (std::size_t k = 0; k < face.corners; ++k) {
            const std::size_t v = vertices + face.vertex[k] + 1;
            if (face.uv[k] == no_index)
                fmt::format_to(to, " {}//{}", v, v);
            else
                fmt::format_to(to, " {}/{}/{}", v, uvs + face.uv[k] + 1, v);
        }
        fmt::format_to(to, "\n");
    }
    if (!patch.grid()) {
        for (const auto& [a, b] : patch.mesh->seams)
            fmt::format_to(to, "l {} {}\n", vertices + a + 1, vertices + b + 1);
    }
    return fmt::to_string(out);
}

Written export_obj(const ExportSource& source, const std::filesystem::path& folder) {
    Written written;
    const std::vector<std::string> names = file_names(source);
    for (int frame = source.first; frame <= source.last; ++frame) {
        const FrameRecord record = source.read(frame);
        WholeFile file(folder / fmt::format("frame_{:04}.obj", frame));
        file.write(heading);
        std::size_t uvs = 0;
        for (std::size_t c = 0; c < source.surfaces.size(); ++c) {
            const ClothPatch& patch = source.model.cloths[c];
            file.write(
                obj_text(names[c], patch, source.surfaces[c], positions_of(patch, record), patch.first, uvs));
            uvs += source.surfaces[c].uvs.size();
        }
        std::size_t vertices = source.model.size();
        for (std::size_t k = 0; k < source.solids.size(); ++k) {
            const std::vector<Vec3> x = solid_positions(source.solids[k], record.state.t);
            file.write(obj_text(names[source.surfaces.size() + k], source.solids[k], x, vertices));
            vertices += x.size();
        }
        file.commit();
        written.push_back(file.target());
        if (!source.done(frame)) break;
    }
    return written;
}

}  // namespace unravel::tool
