// PC2 and MDD: what Blender, Houdini and Maya read as a cache of moving points.

#include <fmt/format.h>

#include <bit>
#include <memory>

#include "base/whole_file.hpp"
#include "sim/mesh/pc2.hpp"
#include "tool/export/export.hpp"

namespace unravel::tool {

namespace {

void append(std::vector<std::uint8_t>& out, std::uint32_t word, bool big_endian) {
    for (int k = 0; k < 4; ++k)
        out.push_back(static_cast<std::uint8_t>(word >> (big_endian ? 24 - 8 * k : 8 * k)));
}

// MDD is big-endian: frames, points, and the time of every frame [s].
std::vector<std::uint8_t> mdd_header(const ExportSource& source, std::uint32_t points) {
    std::vector<std::uint8_t> out;
    append(out, static_cast<std::uint32_t>(source.frames()), true);
    append(out, points, true);
    for (int k = 0; k < source.frames(); ++k) {
        const auto t = static_cast<float>(source.fps.time_of(k));
        append(out, std::bit_cast<std::uint32_t>(t), true);
    }
    return out;
}

}  // namespace

Written export_point_cache(const ExportSource& source, const std::filesystem::path& folder, bool mdd) {
    const std::vector<std::string> names = file_names(source.model);
    std::vector<std::unique_ptr<WholeFile>> meshes, caches;
    for (std::size_t c = 0; c < source.surfaces.size(); ++c) {
        const ClothPatch& patch = source.model.cloths[c];
        const std::string& name = names[c];
        meshes.push_back(std::make_unique<WholeFile>(folder / (name + ".obj")));
        caches.push_back(std::make_unique<WholeFile>(folder / (name + (mdd ? ".mdd" : ".pc2"))));
        const Pc2Header header{static_cast<std::int32_t>(patch.count()), static_cast<float>(source.first),
                               1.0f, source.frames()};
        caches.back()->write(mdd ? mdd_header(source, patch.count()) : pc2_header(header));
    }
    std::vector<std::uint8_t> bytes;
    for (int frame = source.first; frame <= source.last; ++frame) {
        const FrameRecord record = source.read(frame);
        for (std::size_t c = 0; c < caches.size(); ++c) {
            const ClothPatch& patch = source.model.cloths[c];
            const std::span<const Vec3> x = positions_of(patch, record);
            if (frame == source.first) {
                meshes[c]->write(std::string_view("# unravel: metres, right-handed, y up\n"));
                meshes[c]->write(obj_text(names[c], patch, source.surfaces[c], x, 0, 0));
            }
            bytes.clear();
            for (const Vec3& p : x) {
                for (const double value : {p.x(), p.y(), p.z()})
                    append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), mdd);
            }
            caches[c]->write(bytes);
        }
        if (!source.done(frame)) return {};
    }
    Written written;
    for (std::size_t c = 0; c < caches.size(); ++c) {
        for (WholeFile* file : {meshes[c].get(), caches[c].get()}) {
            file->commit();
            written.push_back(file->target());
        }
    }
    return written;
}

}  // namespace unravel::tool
