#include "tool/picture/still.hpp"

#include "render/renderer.hpp"

namespace unravel::tool {

std::vector<Image> draw_still(const Scene& scene, const ClothModel& model, const FrameRecord& record,
                              const std::vector<Rgb>& colors, const DeviceChoice& device) {
    Placement placement;
    build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, model, placement);
    const GlContext context(device);
    Renderer renderer(context, drawn, {scene.clip.size[0], scene.clip.size[1], 4, 1});
    DrawFrame frame;
    make_draw_frame(scene, model, drawn, record, colors, frame);
    std::vector<Image> pictures(2);
    renderer.draw(DrawStyle::textured, frame, pictures[0]);
    renderer.draw(DrawStyle::components, frame, pictures[1]);
    return pictures;
}

}  // namespace unravel::tool
