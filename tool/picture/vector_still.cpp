#include "tool/picture/vector_still.hpp"

#include "base/whole_file.hpp"
#include "render/palette.hpp"
#include "tool/picture/figure.hpp"
#include "tool/picture/legend.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

std::filesystem::path write_vector_still(const Scene& scene, const ClothModel& model,
                                         const Placement& placement, const RunFolder& folder,
                                         const ClipOptions& options,
                                         const std::function<FrameRecord(int frame)>& read) {
    const DrawScene drawn = make_draw_scene(scene, model, placement);
    const auto edges = drawn_edges(model);
    ComponentColors colors;
    FrameRecord record;
    std::vector<Rgb> components;
    for (int k = 0; k <= options.first; ++k) {
        record = read(k);
        components = colors.assign(record.component, edges);
    }
    const ClipView& view = options.views.front();
    DrawFrame frame;
    make_draw_frame(scene, model, drawn, record, components, frame, view.camera);
    const PaperFigure figure(scene, model, drawn);
    const auto [width, height] = scene.clip.size;
    const auto draw = [&](Canvas& canvas) {
        figure.draw(canvas, record, frame, width, height);
        if (scene.look.legend) Legend::draw(scene, record, components, height, canvas);
    };
    std::filesystem::path file = folder.picture(view.name, record.frame);
    file.replace_extension(options.format);
    write_whole_file(
        file, options.format == "pdf" ? canvas_pdf(width, height, draw) : canvas_svg(width, height, draw));
    return file;
}

}  // namespace unravel::tool
