#include "tool/study/accuracy/accuracy_video.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/renderer.hpp"
#include "render/video.hpp"
#include "tool/picture/view.hpp"
#include "tool/plot/canvas.hpp"

namespace unravel::tool {

namespace {

constexpr int side_width = 640, side_height = 640, caption_height = 44, scale_height = 36;
constexpr double decades = 3;
constexpr Rgb video_ink{235, 237, 240}, page{27, 30, 36}, exact_color{150, 158, 170};

// m, the largest distance of any particle at any frame.
double worst_distance(const Trajectory& a, const Trajectory& b) {
    double worst = 0;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
        for (std::size_t p = 0; p < a[k].size(); ++p)
            worst = std::max(worst, (a[k][p] - b[k][p]).squaredNorm());
    }
    return std::sqrt(worst);
}

std::string millimetres(double metres) {
    return fmt::format("{:.2g} mm", 1e3 * metres);
}

// The strip under the pictures: what the colours mean.
void draw_scale(Canvas& canvas, double worst, double top, double width) {
    const double bar = 360, left = 0.5 * (width - bar), y = top + 12;
    constexpr int cells = 120;
    for (int k = 0; k < cells; ++k) {
        canvas.color(heat_color(worst * std::pow(10.0, decades * ((k + 0.5) / cells - 1)), worst));
        canvas.rectangle(left + bar * k / cells, y, bar / cells + 0.5, 12);
    }
    canvas.color(video_ink);
    canvas.font(14);
    canvas.text(left - 8, y + 11, millimetres(worst * std::pow(10.0, -decades)) + " off", Align::end);
    canvas.text(left + bar + 8, y + 11, millimetres(worst));
}

}  // namespace

Rgb heat_color(double distance, double worst) {
    constexpr std::array<Rgb, 4> stops{{{70, 80, 110}, {86, 180, 233}, {240, 228, 66}, {213, 94, 0}}};
    const double share =
        distance > 0 && worst > 0 ? std::clamp(1 + std::log10(distance / worst) / decades, 0.0, 1.0) : 0.0;
    const double place = share * (stops.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double mix = place - static_cast<double>(low);
    const auto between = [&](std::uint8_t a, std::uint8_t b) {
        return static_cast<std::uint8_t>(std::lround(a + mix * (b - a)));
    };
    const Rgb &a = stops[low], &b = stops[low + 1];
    return {between(a.r, b.r), between(a.g, b.g), between(a.b, b.b)};
}

void write_accuracy_video(const Scene& studied, const AccuracySide& cheap, const AccuracySide& accurate,
                          const DeviceChoice& device, const std::filesystem::path& file,
                          const std::function<bool()>& keep_on) {
    Scene scene = studied;
    scene.look.show = Show::components;  // whose colours are those that are given
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, model, placement);
    const GlContext context(device);
    Renderer renderer(context, drawn, {side_width, side_height, 4, 1});
    VideoSettings settings;
    settings.width = 2 * side_width;
    settings.height = caption_height + side_height + scale_height;
    settings.fps_num = scene.clip.fps.num;
    settings.fps_den = scene.clip.fps.den;
    VideoWriter video(file, settings);

    const double worst = worst_distance(cheap.trajectory, accurate.trajectory);
    FrameRecord record;
    record.springs.assign(model.springs.size(), SpringState::implicit);  // no wire is faint
    DrawFrame frame;
    std::vector<Rgb> colors(model.size(), exact_color);
    std::array<Image, 2> pictures;
    const auto frames = std::min(cheap.trajectory.size(), accurate.trajectory.size());
    for (std::size_t k = 0; k <= frames && keep_on(); ++k) {
        const double t = scene.clip.fps.time_of(static_cast<int>(k));
        const std::vector<Vec3>& exact = k == 0 ? placement.x : accurate.trajectory[k - 1];
        const std::vector<Vec3>& near = k == 0 ? placement.x : cheap.trajectory[k - 1];
        record.frame = static_cast<int>(k);
        record.state.t = t;
        for (int side = 0; side < 2; ++side) {
            record.state.x = side == 0 ? near : exact;
            for (std::size_t p = 0; p < model.size(); ++p)
                colors[p] = side == 0 ? heat_color((near[p] - exact[p]).norm(), worst) : exact_color;
            make_draw_frame(scene, model, drawn, record, colors, frame);
            renderer.draw(DrawStyle::components, frame, pictures[static_cast<std::size_t>(side)]);
        }
        const Image picture = canvas_image(settings.width, settings.height, 1, [&](Canvas& canvas) {
            canvas.color(page);
            canvas.rectangle(0, 0, settings.width, settings.height);
            canvas.picture(pictures[0], 0, caption_height, side_width, side_height);
            canvas.picture(pictures[1], side_width, caption_height, side_width, side_height);
            canvas.color(video_ink);
            canvas.font(17);
            canvas.text(0.5 * side_width, 28, cheap.caption, Align::middle);
            canvas.text(1.5 * side_width, 28, accurate.caption, Align::middle);
            canvas.font(14);
            canvas.text(12, caption_height + side_height + 23, fmt::format("{:.2f} s", t));
            draw_scale(canvas, worst, caption_height + side_height, settings.width);
        });
        video.add(picture);
        for (int still = 0; k == frames && 2 * still < scene.clip.fps.per_second(); ++still)
            video.add(picture);
    }
    if (video.frames() > 0) video.finish();
}

}  // namespace unravel::tool
