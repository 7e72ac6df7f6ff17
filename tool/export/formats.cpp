#include "tool/export/formats.hpp"

#include "render/palette.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

using Path = std::filesystem::path;

constexpr ExportFormat formats[] = {
    {"obj", [](const ExportSource& source, const Path& folder,
               const std::string& /*name*/) { return export_obj(source, folder); }},
    {"ply",
     [](const ExportSource& source, const Path& folder, const std::string& /*name*/) {
         ComponentColors colors;
         const auto edges = drawn_edges(source.model);
         return export_ply(source, folder,
                           [&](const FrameRecord& record) { return colors.assign(record.component, edges); });
     }},
    {"pc2", [](const ExportSource& source, const Path& folder,
               const std::string& /*name*/) { return export_point_cache(source, folder, false); }},
    {"mdd", [](const ExportSource& source, const Path& folder,
               const std::string& /*name*/) { return export_point_cache(source, folder, true); }},
    {"glb", [](const ExportSource& source, const Path& folder,
               const std::string& name) { return export_glb(source, folder, name); }},
};

}  // namespace

std::span<const ExportFormat> export_formats() {
    return formats;
}

}  // namespace unravel::tool
