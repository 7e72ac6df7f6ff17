#include <fmt/format.h>

#include <cstring>

#include "base/whole_file.hpp"
#include "tool/export/export.hpp"

namespace unravel::tool {

namespace {

template <typename T>
void append(std::vector<std::uint8_t>& out, const T& value) {
    const std::size_t at = out.size();
    out.resize(at + sizeof(T));
    std::memcpy(out.data() + at, &value, sizeof(T));
}

}  // namespace

Written export_ply(const ExportSource& source, const std::filesystem::path& folder,
                   const std::function<std::vector<Rgb>(const FrameRecord&)>& colors) {
    Written written;
    std::size_t faces = 0;
    for (const ClothSurface& surface : source.surfaces) faces += surface.faces.size();
    const std::string header = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment unravel: metres, right-handed, y up\n"
        "comment colours are the solver's components; white is fully constrained\n"
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "property float nx\nproperty float ny\nproperty float nz\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        source.model.size(), faces);
    // Colours follow components from frame to frame, so every earlier frame has to be seen.
    for (int frame = 0; frame <= source.last; ++frame) {
        const FrameRecord record = source.read(frame);
        const std::vector<Rgb> rgb = colors(record);
        if (frame < source.first) continue;
        std::vector<std::uint8_t> vertices, polygons;
        for (std::size_t c = 0; c < source.surfaces.size(); ++c) {
            const ClothPatch& patch = source.model.cloths[c];
            const std::span<const Vec3> x = positions_of(patch, record);
            const std::vector<Vec3> normals = surface_normals(source.surfaces[c], x);
            for (std::size_t v = 0; v < x.size(); ++v) {
                for (int k = 0; k < 3; ++k) append(vertices, x[v][k]);
                for (int k = 0; k < 3; ++k) append(vertices, static_cast<float>(normals[v][k]));
                const Rgb color = rgb[patch.first + v];
                vertices.insert(vertices.end(), {color.r, color.g, color.b});
            }
            for (const ClothSurface::Face& face : source.surfaces[c].faces) {
                polygons.push_back(face.corners);
                for (std::size_t k = 0; k < face.corners; ++k)
                    append(polygons, static_cast<std::int32_t>(patch.first + face.vertex[k]));
            }
        }
        WholeFile file(folder / fmt::format("frame_{:04}.ply", frame));
        file.write(header);
        file.write(vertices);
        file.write(polygons);
        file.commit();
        written.push_back(file.target());
        if (!source.done(frame)) break;
    }
    return written;
}

}  // namespace unravel::tool
