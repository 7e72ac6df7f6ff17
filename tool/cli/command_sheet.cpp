// unravel sheet RUN_DIR[:FRAME] ...: both views of a frame of each run, side by side in one picture.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "render/png.hpp"
#include "render/renderer.hpp"
#include "sim/run/simulate.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cli/picture_options.hpp"
#include "tool/folder/cached_run.hpp"
#include "tool/picture/figure.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

struct SheetOptions {
    std::vector<std::string> runs;  // RUN_DIR[:FRAME]
    std::filesystem::path file = "sheet.png";
    PictureOptions pictures;
    OutputOptions output;
};

constexpr int gap = 4;  // px between pictures

// Where a run is, and which of its frames is meant; −1: the last.
struct Entry {
    std::string folder;
    int frame = -1;
};

Entry parse_entry(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    const bool numbered = colon != text.npos && colon + 1 < text.size() && colon + 7 > text.size() &&
                          text.find_first_not_of("0123456789", colon + 1) == text.npos;
    if (!numbered) return {text, -1};
    return {text.substr(0, colon), std::stoi(text.substr(colon + 1))};
}

// Both views of one frame. Components get the colours that they have in the run's video.
std::array<Image, 2> draw_entry(const Entry& entry, const PictureOptions& options, std::array<int, 2>& size) {
    CachedRun run = open_cached_run(entry.folder);
    const ClipOptions clip = clip_options_of(options, run.scene);
    size = run.scene.clip.size;
    const int frames = run.usable_frames();
    const int frame = entry.frame < 0 ? frames - 1 : entry.frame;
    run.require(std::max(frame, 0), frames);
    const auto edges = drawn_edges(run.model);
    const DrawScene drawn = make_draw_scene(run.scene, run.model, run.placement, run.folder.root);
    ComponentColors colors;
    SteadyColors steady;
    DrawFrame drawing;
    FrameRecord record;
    for (int k = 0; k <= frame; ++k) {
        record = run.read(k);
        const std::vector<Rgb>& components = steady.follow(colors.assign(record.component, edges));
        if (k == frame)
            make_draw_frame(run.scene, run.model, drawn, record, components, drawing,
                            clip.views.front().camera);
    }
    const GlContext context(clip.device);
    Renderer renderer(context, drawn,
                      {size[0], size[1], options.samples, options.supersample, false, clip.quality});
    std::array<Image, 2> pictures;
    renderer.draw(DrawStyle::textured, drawing, pictures[0]);
    if (run.scene.look.theme == Theme::paper)
        pictures[1] =
            figure_picture(PaperFigure(run.scene, run.model, drawn), record, drawing, size[0], size[1]);
    else
        renderer.draw(DrawStyle::components, drawing, pictures[1]);
    return pictures;
}

void paste(const Image& picture, int left, int top, Image& sheet) {
    for (int y = 0; y < picture.height; ++y)
        std::memcpy(sheet.at(left, top + y), picture.at(0, y), std::size_t{4} * picture.width);
}

int sheet(const SheetOptions& options) {
    Image picture_of_all;
    int column = 0;
    for (const std::string& run : options.runs) {
        std::array<int, 2> size{};
        const std::array<Image, 2> pictures = draw_entry(parse_entry(run), options.pictures, size);
        if (column == 0) {
            picture_of_all.width = static_cast<int>(options.runs.size()) * (size[0] + gap) - gap;
            picture_of_all.height = 2 * size[1] + gap;
            picture_of_all.pixels.assign(std::size_t{4} * picture_of_all.width * picture_of_all.height, 255);
        }
        if (pictures[0].width + column > picture_of_all.width ||
            2 * pictures[0].height + gap != picture_of_all.height)
            throw UsageError("the runs' pictures are not of one size: choose one with --size");
        paste(pictures[0], column, 0, picture_of_all);
        paste(pictures[1], column, size[1] + gap, picture_of_all);
        column += size[0] + gap;
    }
    write_png(options.file, picture_of_all, {.level = 9});
    if (!options.output.quiet) fmt::print("  {}\n", options.file.string());
    return exit_done;
}

}  // namespace

void add_sheet(CommandLine& line) {
    const auto [command, o] = line.add("sheet", "both views of a frame of each run in one picture", sheet);
    command.add_option("runs", o.runs, "RUN_DIR or RUN_DIR:FRAME (default: its last frame)")->required();
    command.add_option("-o", o.file, "PNG file")->capture_default_str();
    add_view_options(command, o.pictures);
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
