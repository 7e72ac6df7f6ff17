// unravel sheet RUN_DIR[:FRAME] ...: both views of a frame of each run, side by side in one picture.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "render/png.hpp"
#include "render/renderer.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/options.hpp"
#include "tool/cli/render_options.hpp"
#include "tool/folder/run_folder.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

constexpr int gap = 4;  // px between pictures

// Where a run is, and which of its frames is meant; −1: the last.
struct Entry {
    RunFolder folder;
    int frame = -1;
};

Entry parse_entry(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    const bool numbered = colon != text.npos && colon + 1 < text.size() && colon + 7 > text.size() &&
                          text.find_first_not_of("0123456789", colon + 1) == text.npos;
    if (!numbered) return {{text}, -1};
    return {{text.substr(0, colon)}, std::stoi(text.substr(colon + 1))};
}

// Both views of one frame. Components get the colours that they have in the run's video.
std::array<Image, 2> draw_entry(const Entry& entry, const Options& options, std::array<int, 2>& size) {
    if (!std::filesystem::exists(entry.folder.scene()))
        throw FolderError(fmt::format("'{}' holds no run", entry.folder.root.string()));
    Scene scene = load_scene(entry.folder.scene(), options.overrides);
    const std::uint64_t hash = scene_hash(scene);
    const ClipOptions clip = clip_options_of(options, scene);
    size = scene.clip.size;
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const int frames = cached_frames(entry.folder, scene, hash, model.size(), model.springs.size());
    const int frame = entry.frame < 0 ? frames - 1 : entry.frame;
    if (frame < 0 || frame >= frames)
        throw FolderError(fmt::format("'{}' holds {} usable frames, and frame {} is asked for: {}",
                                      entry.folder.root.string(), frames, std::max(frame, 0),
                                      why_unusable(entry.folder, frames, hash)));
    const auto edges = drawn_edges(model);
    ComponentColors colors;
    DrawFrame drawing;
    for (int k = 0; k <= frame; ++k) {
        const FrameRecord record = read_frame(entry.folder, k, hash, model.size(), model.springs.size());
        const std::vector<Rgb>& components = colors.assign(record.component, edges);
        if (k == frame) make_draw_frame(scene, model, record, components, drawing, clip.views.front().camera);
    }
    const DrawScene drawn = make_draw_scene(scene, model, placement, entry.folder.root);
    const GlContext context(clip.device);
    Renderer renderer(context, drawn,
                      {scene.clip.size[0], scene.clip.size[1], options.samples, options.supersample});
    std::array<Image, 2> pictures;
    renderer.draw(DrawStyle::textured, drawing, pictures[0]);
    renderer.draw(DrawStyle::components, drawing, pictures[1]);
    return pictures;
}

void paste(const Image& picture, int left, int top, Image& sheet) {
    for (int y = 0; y < picture.height; ++y)
        std::memcpy(sheet.at(left, top + y), picture.at(0, y), std::size_t{4} * picture.width);
}

}  // namespace

int command_sheet(const Options& options) {
    Image sheet;
    int column = 0;
    for (const std::string& run : options.runs) {
        std::array<int, 2> size{};
        const std::array<Image, 2> pictures = draw_entry(parse_entry(run), options, size);
        if (column == 0) {
            sheet.width = static_cast<int>(options.runs.size()) * (size[0] + gap) - gap;
            sheet.height = 2 * size[1] + gap;
            sheet.pixels.assign(std::size_t{4} * sheet.width * sheet.height, 255);
        }
        if (pictures[0].width + column > sheet.width || 2 * pictures[0].height + gap != sheet.height)
            throw UsageError("the runs' pictures are not of one size: choose one with --size");
        paste(pictures[0], column, 0, sheet);
        paste(pictures[1], column, size[1] + gap, sheet);
        column += size[0] + gap;
    }
    const std::filesystem::path file = options.output.empty() ? "sheet.png" : options.output;
    write_png(file, sheet, {.level = 9});
    if (!options.quiet) fmt::print("  {}\n", file.string());
    return exit_done;
}

}  // namespace unravel::tool
