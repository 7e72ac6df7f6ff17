#include "render/renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "render/backdrop.hpp"
#include "render/bounds.hpp"
#include "render/camera.hpp"
#include "render/cloth_renderer.hpp"
#include "render/color.hpp"
#include "render/frame_block.hpp"
#include "render/framebuffer.hpp"
#include "render/ground.hpp"
#include "render/light_defines.hpp"
#include "render/outlines.hpp"
#include "render/readback.hpp"
#include "render/sampling.hpp"
#include "render/shadow.hpp"
#include "render/solid_renderer.hpp"
#include "render/wire_renderer.hpp"

namespace unravel::render {

namespace {

// Share of a component's colour that its surface has between springs far apart: enough to tell folds.
constexpr float least_sheet = 0.16f;

// Of the reach that the ground has otherwise: from a man's height over ground 100 m wide the horizon is a
// tenth of a degree too low.
constexpr float to_horizon = 60;

/// Whether shaders encode as sRGB what they write; not where alpha is kept, which is of linear light, nor
/// where a mean of light is taken.
bool encodes(const GlContext& context, const DrawScene& scene, const RenderSettings& asked) {
    return context.software() && !scene.transparent && asked.quality != Quality::final_;
}

/// Samples where none are asked: on the CPU each costs as much again as the first, and outlines are smoothed.
int samples_for(const GlContext& context, const RenderSettings& asked) {
    if (asked.quality != Quality::standard) return 1;
    return asked.samples > 0 ? asked.samples : context.software() ? 1 : 4;
}

/// Texels along a side of the key light's map.
int map_size(const GlContext& context, const RenderSettings& asked) {
    return asked.quality == Quality::draft ? 512 : context.software() ? 1024 : 2048;
}

}  // namespace

struct Renderer::Parts {
    const DrawScene* scene;
    RenderSettings settings;
    std::string renderer, light_lines;
    Framebuffer framebuffer;  ///< of the textured view
    // Wires cover pixels by as much as they should without more samples, and are blended in linear light.
    Framebuffer wire_framebuffer;
    Readback readback;
    Backdrop backdrop;
    SolidRenderer solids;
    ShadowMaps shadows;
    // The ground of final pictures, broad and of one colour, would show each of many shadows: it is lit by
    // maps of soft ones, once for each exposure.
    std::optional<ShadowMaps> soft_shadows;
    ClothRenderer cloths;
    WireRenderer wires;
    Ground ground;
    Outlines outlines;
    GlProgram depth{{"depth.vert"}, {"depth.frag"}};
    GlProgram surface{{"frame.glsl", "yield.glsl", "surface.vert"}, {"frame.glsl", "surface.frag"}};
    GlProgram sheet{{"frame.glsl", "color.glsl", "sheet.vert"}, {"sheet.frag"}};
    GLint depth_transform = depth.uniform("transform"), sheet_strength = sheet.uniform("strength");
    SolidRenderer::SurfaceUniforms surface_uniforms{surface.uniform("model"), surface.uniform("tint"),
                                                    surface.uniform("fades"), surface.uniform("fade_centre")};
    GlBuffer block_buffer;
    FrameBlock block;
    std::size_t particles = 0, edges = 0;

    Parts(const GlContext& context, const DrawScene& draw_scene, const RenderSettings& asked)
        : scene(&draw_scene),
          settings(asked),
          renderer(context.renderer()),
          light_lines(light_defines(draw_scene, asked.quality)),
          framebuffer(context, {asked.width, asked.height, samples_for(context, asked), asked.supersample,
                                asked.exposures, draw_scene.transparent, encodes(context, draw_scene, asked),
                                asked.samples == 0 && asked.quality == Quality::standard, sampled()}),
          wire_framebuffer(context,
                           {asked.width, asked.height, context.software() ? 1 : samples_for(context, asked),
                            asked.supersample, asked.exposures, draw_scene.transparent, false, false}),
          readback(asked.width, asked.height),
          backdrop(draw_scene, framebuffer.encoded()),
          solids(draw_scene, framebuffer.encoded(), light_lines),
          shadows(draw_scene, map_size(context, asked), asked.quality),
          cloths(draw_scene, {context.software(), framebuffer.encoded(), framebuffer.supersample(),
                              asked.quality, light_lines}),
          wires(draw_scene),
          ground(draw_scene,
                 {context.software() ? 512 : 1024, framebuffer.encoded(), sampled() || !backdrop.plain(),
                  asked.quality == Quality::draft, light_defines(draw_scene, Quality::standard),
                  sampled() ? "#define SAMPLED\n" : light_lines}),
          outlines(draw_scene, framebuffer.encoded()),
          block(fixed_block(draw_scene)) {
        if (sampled()) soft_shadows.emplace(draw_scene, map_size(context, asked), Quality::standard);
        allocate_buffer(GL_UNIFORM_BUFFER, block_buffer, sizeof(FrameBlock));
        edges = draw_scene.edges.size();
        for (const ClothMesh& mesh : draw_scene.cloths)
            for (const std::uint32_t p : mesh.particle) particles = std::max<std::size_t>(particles, p + 1);
    }

    void check(DrawStyle style, const DrawFrame& frame) const;
    bool sampled() const { return settings.quality == Quality::final_; }
    void update_block(DrawStyle style, const DrawFrame& frame, ShadowMaps& maps,
                      const Sample* sample = nullptr);
    void draw_textured(DrawStyle style, const DrawFrame& frame, int exposure, int exposures);
    void draw_sampled(DrawStyle style, std::span<const DrawFrame> exposures);
    void draw_maps(const DrawFrame& frame, ShadowMaps& maps);
    void light_ground(DrawStyle style, const DrawFrame& frame);
    void draw_shapes(DrawStyle style, const DrawFrame& frame);
    void draw_components(const DrawFrame& frame, int exposure, int exposures);
    float wire_gap(const DrawFrame& frame) const;
    Rgb background(DrawStyle style) const {
        return style == DrawStyle::components ? scene->components_background : scene->background;
    }
    void draw_ground(DrawStyle style, const DrawFrame& frame) const;
    Projection sampled_camera(const Projection& camera, const CameraView& view, const Sample& sample) const;
    PixelRect shapes_rect(const DrawFrame& frame) const;
    int height() const { return framebuffer.height() * framebuffer.supersample(); }
};

void Renderer::Parts::check(DrawStyle style, const DrawFrame& frame) const {
    if (frame.positions.size() < particles || frame.solid_poses.size() < scene->solids.size())
        throw std::invalid_argument("a frame lacks positions or poses that its scene needs");
    for (std::size_t s = 0; s < scene->solids.size(); ++s) {
        if (scene->solids[s].deforms &&
            (frame.solid_positions.size() <= s ||
             frame.solid_positions[s].size() != scene->solids[s].positions.size()))
            throw std::invalid_argument("a frame lacks the vertices of a mesh that deforms");
    }
    if (style != DrawStyle::textured && frame.particle_colors.size() < particles)
        throw std::invalid_argument("a frame of the component view lacks particle colours");
    if (!frame.edge_colors.empty() && frame.edge_colors.size() != edges)
        throw std::invalid_argument("a frame's edge colours are not one for each edge");
    if (!frame.edge_strength.empty() && frame.edge_strength.size() != edges)
        throw std::invalid_argument("a frame's edge strengths are not one for each edge");
}

/// Aims light, camera and ground at where the frame's shapes are now.
void Renderer::Parts::update_block(DrawStyle style, const DrawFrame& frame, ShadowMaps& maps,
                                   const Sample* sample) {
    const BoundingBox now = bounds_of(*scene, frame);
    const BoundingBox all{scene->bounds_low.cwiseMin(now.low), scene->bounds_high.cwiseMax(now.high)};
    if (sample)
        maps.aim(now.low, now.high, sample->lamp, sample->sky);
    else
        maps.aim(now.low, now.high);
    maps.describe(block);
    // Ground and planes fade away around where the clip takes place, or wherever shapes have left to.
    const Vec3f centre = 0.5f * (scene->bounds_low + scene->bounds_high);
    const float farthest = (all.high - centre).cwiseMax(centre - all.low).norm();
    const float reach = solids.set_reach(5 * farthest);
    block.ground << centre.x(), centre.z(), 0.2f * reach, 0.95f * reach;
    if (scene->horizon) block.ground.tail<2>() << 6 * reach, to_horizon * reach;
    // Cloth touches solids at its particles and cuts their corners between them: solids yield by that much.
    block.shadow.w() = std::min(0.012f, 0.5f * scene->spacing);

    const float aspect = static_cast<float>(framebuffer.width()) / static_cast<float>(framebuffer.height());
    const float farthest_ground = scene->horizon ? 1.1f * to_horizon * reach : 1.5f * reach;
    Projection camera = make_camera(frame.camera, aspect, all.low, all.high, farthest_ground);
    if (sample) camera = sampled_camera(camera, frame.camera, *sample);
    const int factor = framebuffer.supersample();
    block.view_projection = camera.projection * camera.view;
    block.eye << camera.position, 1;
    block.background << linear(background(style)), 1;
    block.viewport << static_cast<float>(framebuffer.width() * factor), static_cast<float>(height()),
        camera.pixels_per_radian * static_cast<float>(height()), std::min(0.004f, 0.3f * scene->spacing);
    update_buffer(GL_UNIFORM_BUFFER, block_buffer, std::span<const FrameBlock>(&block, 1));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, block_buffer);
}

/// The camera of one of many pictures: elsewhere on its lens, and by a part of a pixel.
Projection Renderer::Parts::sampled_camera(const Projection& camera, const CameraView& view,
                                           const Sample& sample) const {
    const float focus = view.focus > 0 ? view.focus : (view.target - view.position).norm();
    const Vec2f half(0.5f * static_cast<float>(framebuffer.width()),
                     0.5f * static_cast<float>(framebuffer.height()));
    return shifted(camera, 0.5f * view.aperture * sample.lens, focus, sample.pixel.cwiseQuotient(half));
}

/// Behind the shapes that are there already. Where any reaches below the ground, it hides what lies there.
void Renderer::Parts::draw_ground(DrawStyle style, const DrawFrame& frame) const {
    if (scene->transparent) return;
    bool below = false;
    const auto look = [&](const Vec3f& p) { below = below || p.y() < scene->ground_height; };
    visit_bounds(*scene, frame, std::ref(look));
    if (!below) glDepthRange(1, 1);
    ground.draw(style, frame.camera.position);
    glDepthRange(0, 1);
}

/// Where there may be outlines.
PixelRect Renderer::Parts::shapes_rect(const DrawFrame& frame) const {
    return covered_rect(*scene, frame, block.view_projection, framebuffer.whole(), 2);
}

/// Pixels between neighbouring particles at the scene's centre.
float Renderer::Parts::wire_gap(const DrawFrame& frame) const {
    const Vec3f centre = 0.5f * (scene->bounds_low + scene->bounds_high);
    return scene->spacing * block.viewport.z() / std::max((centre - frame.camera.position).norm(), 1e-3f);
}

/// Where light and sky are hidden.
void Renderer::Parts::draw_maps(const DrawFrame& frame, ShadowMaps& maps) {
    const auto casters = [&](const Eigen::Matrix4f& transform, bool coarse) {
        depth.use();
        // Solids yield to cloth that lies on them here too, or its corners would be in their shadow.
        Eigen::Matrix4f behind = transform;
        behind(2, 3) += block.shadow.w() / maps.radius();
        solids.draw_casters(frame, depth_transform, behind, coarse);
        glUniformMatrix4fv(depth_transform, 1, GL_FALSE, transform.data());
        if (coarse)
            cloths.draw_coarse();
        else
            cloths.draw_casters();
    };
    maps.draw(std::ref(casters));  // by reference: what it holds would not fit into a std::function
}

/// Of a final picture, as a standard one's.
void Renderer::Parts::light_ground(DrawStyle style, const DrawFrame& frame) {
    if (scene->transparent || !scene->show_ground) return;
    update_block(style, frame, *soft_shadows);
    draw_maps(frame, *soft_shadows);
    ground.light(frame, *soft_shadows);
}

void Renderer::Parts::draw_shapes(DrawStyle style, const DrawFrame& frame) {
    shadows.bind();
    cloths.draw_fabric(block.viewport.z());
    solids.draw_shaded(frame);
    draw_ground(style, frame);
    solids.draw_planes(frame);
    if (style == DrawStyle::overlay) {
        wires.update(frame);
        wires.draw(height(), wire_gap(frame), framebuffer.encoded());
    }
}

void Renderer::Parts::draw_textured(DrawStyle style, const DrawFrame& frame, int exposure, int exposures) {
    cloths.update_shape(frame);
    solids.update_shapes(frame);
    draw_maps(frame, shadows);
    if (!scene->transparent) ground.light(frame, shadows);
    framebuffer.begin(scene->background);
    if (!backdrop.plain()) backdrop.draw(frame.camera, framebuffer.whole().width, framebuffer.whole().height);
    draw_shapes(style, frame);
    if (framebuffer.smooths_outlines()) {
        outlines.update(frame);
        outlines.draw(framebuffer, shapes_rect(frame));
    }
    framebuffer.finish(exposure, exposures);
}

/// The mean of many pictures of the frame, spread over its exposures.
void Renderer::Parts::draw_sampled(DrawStyle style, std::span<const DrawFrame> exposures) {
    const int n = static_cast<int>(exposures.size()), passes = std::max(settings.passes, n);
    const DrawFrame* shown = nullptr;
    for (int k = 0; k < passes; ++k) {
        const DrawFrame& frame = exposures[static_cast<std::size_t>(k * n / passes)];
        if (shown != &frame) {
            cloths.update_shape(frame);
            solids.update_shapes(frame);
            light_ground(style, frame);
        }
        shown = &frame;
        const Sample sample = sample_at(k);
        update_block(style, frame, shadows, &sample);
        draw_maps(frame, shadows);
        framebuffer.begin(scene->background);
        draw_shapes(style, frame);
        framebuffer.expose(k, passes);
    }
    framebuffer.begin_finished(scene->background);
    if (!backdrop.plain()) backdrop.draw(exposures.back().camera, framebuffer.width(), framebuffer.height());
    framebuffer.develop();
}

void Renderer::Parts::draw_components(const DrawFrame& frame, int exposure, int exposures) {
    cloths.update_shape(frame);
    solids.update_shapes(frame);
    cloths.update_colors(frame);
    wires.update(frame);
    const float gap = wire_gap(frame);
    wire_framebuffer.begin(scene->components_background);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
    sheet.use();
    // The denser the springs, the more of a component's colour its surface carries.
    glUniform1f(sheet_strength, std::clamp(1.3f - 0.3f * gap, least_sheet, 1.0f));
    cloths.draw_shapes();
    surface.use();
    solids.draw_quiet(frame, surface_uniforms);
    glDisable(GL_POLYGON_OFFSET_FILL);
    draw_ground(DrawStyle::components, frame);
    surface.use();
    solids.draw_quiet_planes(frame, surface_uniforms);
    wires.draw(height(), gap, false);
    wire_framebuffer.finish(exposure, exposures);
}

Renderer::Renderer(const GlContext& context, const DrawScene& scene, RenderSettings settings)
    : parts_(std::make_unique<Parts>(context, scene, settings)) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::submit(DrawStyle style, std::span<const DrawFrame> exposures) {
    const bool sampled = parts_->sampled() && style != DrawStyle::components;
    const bool several = parts_->settings.exposures || sampled;
    if (exposures.empty() || (exposures.size() > 1 && !several))
        throw std::invalid_argument("a picture has one frame, or several where the settings say so");
    for (const DrawFrame& frame : exposures) parts_->check(style, frame);
    if (pending() == Readback::depth)
        throw std::invalid_argument("collect a frame before submitting another");
    const int n = static_cast<int>(exposures.size());
    if (sampled) {
        parts_->draw_sampled(style, exposures);
        parts_->readback.start();
        return;
    }
    for (int k = 0; k < n; ++k) {
        const DrawFrame& frame = exposures[static_cast<std::size_t>(k)];
        parts_->update_block(style, frame, parts_->shadows);
        if (style == DrawStyle::components)
            parts_->draw_components(frame, k, n);
        else
            parts_->draw_textured(style, frame, k, n);
    }
    parts_->readback.start();
}

void Renderer::collect(Image& out) {
    if (pending() == 0) throw std::invalid_argument("there is no frame under way");
    parts_->readback.finish(out);
}

int Renderer::pending() const {
    return parts_->readback.pending();
}

void Renderer::draw(DrawStyle style, const DrawFrame& frame, Image& out) {
    if (pending() > 0) throw std::invalid_argument("draw() while frames of submit() are under way");
    submit(style, frame);
    collect(out);
}

std::string Renderer::description() const {
    const Framebuffer& framebuffer = parts_->framebuffer;
    const int asked = parts_->settings.samples;
    std::string text =
        fmt::format("{}, {}×{}, ", parts_->renderer, framebuffer.width(), framebuffer.height());
    text +=
        framebuffer.smooths_outlines() ? "smooth outlines" : fmt::format("{} samples", framebuffer.samples());
    if (parts_->settings.quality == Quality::draft) text = fmt::format("{}, draft", text);
    if (parts_->sampled()) text = fmt::format("{}, mean of {} pictures", text, parts_->settings.passes);
    if (asked > framebuffer.samples() && parts_->settings.quality == Quality::standard)
        text += fmt::format(" ({} asked; this renderer has no more)", asked);
    if (framebuffer.supersample() > 1)
        text += fmt::format(", supersampled {0}×{0}", framebuffer.supersample());
    return text;
}

}  // namespace unravel::render
