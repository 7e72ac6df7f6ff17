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
    const std::vector<std::string> names = file_names(source);
    const std::size_t cloths = source.surfaces.size();
    std::vector<std::unique_ptr<WholeFile>> meshes, caches;
    for (std::size_t k = 0; k < names.size(); ++k) {
        const auto points = static_cast<std::uint32_t>(
            k < cloths ? source.model.cloths[k].count() : source.solids[k - cloths].positions.size());
        meshes.push_back(std::make_unique<WholeFile>(folder / (names[k] + ".obj")));
        caches.push_back(std::make_unique<WholeFile>(folder / (names[k] + (mdd ? ".mdd" : ".pc2"))));
        const Pc2Header header{static_cast<std::int32_t>(points), static_cast<float>(source.first), 1.0f,
                               source.frames()};
        caches.back()->write(mdd ? mdd_header(source, points) : pc2_header(header));
    }
    std::vector<std::uint8_t> bytes;
    for (int frame = source.first; frame <= source.last; ++frame) {
        const FrameRecord record = source.read(frame);
        for (std::size_t k = 0; k < caches.size(); ++k) {
            std::vector<Vec3> of_solid;
            if (k >= cloths) of_solid = solid_positions(source.solids[k - cloths], record.state.t);
            const std::span<const Vec3> x =
                k < cloths ? positions_of(source.model.cloths[k], record) : std::span<const Vec3>(of_solid);
            if (frame == source.first) {
                meshes[k]->write(std::string_view("# unravel: metres, right-handed, y up\n"));
                meshes[k]->write(k < cloths
                                     ? obj_text(names[k], source.model.cloths[k], source.surfaces[k], x, 0, 0)
                                     : obj_text(names[k], source.solids[k - cloths], x, 0));
            }
            bytes.clear();
            for (const Vec3& p : x) {
                for (const double value : {p.x(), p.y(), p.z()})
                    append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), mdd);
            }
            caches[k]->write(bytes);
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
