#include "tool/picture/clip_renderer.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "render/video_length.hpp"
#include "tool/picture/picture_stamp.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

// Times at which the shutter is open that a final picture is spread over.
constexpr int final_exposures = 16;

RenderSettings render_settings(const Scene& scene, const ClipOptions& options) {
    return {scene.clip.size[0],  scene.clip.size[1],         options.samples,
            options.supersample, scene.look.motion_blur > 1, options.quality};
}

}  // namespace

VideoSettings video_settings(const Scene& scene, const ClipOptions& options, Layout layout) {
    VideoSettings settings;
    settings.width = view_width(layout, scene.clip.size[0]);
    settings.height = scene.clip.size[1];
    settings.fps_num = scene.clip.fps.num;
    settings.fps_den = scene.clip.fps.den;
    settings.codec = options.codec;
    settings.preset = options.preset;
    settings.crf = options.crf;
    settings.full_chroma = options.full_chroma;
    settings.thin_lines = layout != Layout::textured;
    settings.alpha = scene.look.transparent;
    return settings;
}

RendererOnThread::RendererOnThread(const DrawScene& scene, const DeviceChoice& device,
                                   const RenderSettings& settings) {
    thread_.run([&] {
        auto context = std::make_unique<GlContext>(device);
        renderer_ = std::make_unique<Renderer>(*context, scene, settings);
        context_ = std::move(context);
    });
}

RendererOnThread::~RendererOnThread() {
    thread_.run([&] {
        renderer_.reset();
        context_.reset();
    });
}

ClipRenderer::ClipRenderer(const Scene& scene, const ClothModel& model, const Placement& placement,
                           const RunFolder& folder, const ClipOptions& options)
    : scene_(scene),
      model_(model),
      target_(folder),
      folder_(folder),
      options_(options),
      edges_(drawn_edges(model)),
      drawn_(make_draw_scene(scene, model, placement, options.textures)),
      drawing_(drawn_, options.device, render_settings(scene, options)) {
    plan_shots();
    report_.renderer = drawing_.renderer().description();
    report_.renderer_summary = drawing_.context().summary();
    report_.software = drawing_.context().software();
    if (scene.look.theme == Theme::paper) figure_ = std::make_unique<PaperFigure>(scene, model, drawn_);
    if (scene.look.legend) legend_ = std::make_unique<Legend>(scene, scene.clip.size[1]);
    for (FrameInFlight& slot : in_flight_) {
        slot.pictures.resize(options.views.size());
        slot.parts.resize(shots_.size());
        free_.push(&slot);
    }
    choose_folder();
    prepare_folders();
    if (options.video_ending.empty()) return;
    for (const ClipView& view : options.views) {
        const std::filesystem::path file = folder_.video(view.name, options.video_ending);
        videos_.push_back(std::make_unique<VideoWriter>(file, video_settings(scene, options, view.layout)));
        report_.encoders.push_back(videos_.back()->description());
        report_.videos.push_back(file.filename().string());
    }
}

void ClipRenderer::plan_shots() {
    for (std::size_t v = 0; v < options_.views.size(); ++v) {
        std::vector<std::size_t>& of_view = view_shots_.emplace_back();
        const std::vector<Shot> shots = tool::shots_of(options_.views[v]);
        for (const Shot& shot : shots) {
            const auto found = std::ranges::find(shots_, shot);
            of_view.push_back(static_cast<std::size_t>(found - shots_.begin()));
            if (found != shots_.end()) continue;
            shots_.push_back(shot);
            shot_view_.push_back(-1);
        }
        if (shots.size() == 1) shot_view_[of_view[0]] = static_cast<int>(v);
    }
}

bool ClipRenderer::draws_whole_clip() const {
    return options_.first == 0 && options_.last == scene_.clip.frames() - 1;
}

// Beside what is there, where that is a clip drawn otherwise.
void ClipRenderer::choose_folder() {
    if (!options_.keep_pictures || options_.vouched || options_.shares_folder || !draws_whole_clip()) return;
    const std::string stamp = picture_stamp(scene_, options_, report_.renderer);
    const RunFolder next{target_.next()};
    if (std::ranges::none_of(options_.views, [&](const ClipView& view) {
            return holds_other_pictures(target_, view.name, stamp);
        })) {
        std::filesystem::remove_all(next.root);
        return;
    }
    if (!options_.reuse_pictures) std::filesystem::remove_all(next.root);
    std::filesystem::create_directories(next.frames());
    remove_partial_files(next.root);
    remove_partial_files(next.frames());
    folder_ = next;
}

void ClipRenderer::prepare_folders() {
    reusable_.assign(options_.views.size(), options_.vouched);
    if (options_.vouched) return;
    if (!options_.keep_pictures && !options_.reuse_pictures) return;
    const std::string stamp = picture_stamp(scene_, options_, report_.renderer);
    const bool whole = draws_whole_clip();
    for (std::size_t v = 0; v < options_.views.size(); ++v) {
        const std::string& name = options_.views[v].name;
        // Where none are written, what lies there is what it was.
        const bool same = !options_.keep_pictures ? !holds_other_pictures(folder_, name, stamp)
                          : options_.shares_folder
                              ? keep_or_clear_range(folder_, name, stamp, {options_.first, options_.last})
                              : stamp_pictures(folder_, name, stamp, whole);
        reusable_[v] = options_.reuse_pictures && same;
    }
}

/// Sub-frames of textured pictures. A final one is the mean of many pictures anyhow.
int ClipRenderer::exposures() const {
    return options_.quality == Quality::final_ ? std::max(final_exposures, scene_.look.motion_blur)
                                               : scene_.look.motion_blur;
}

/// Whether a style is drawn of the frame itself: figures, and component views where the scene asks for no
/// blur.
bool ClipRenderer::of_still(DrawStyle style) const {
    return style == DrawStyle::components && (figure_ || exposures() > scene_.look.motion_blur);
}

/// What the frames after this one have to know of it.
void ClipRenderer::remember(const FrameRecord& record) {
    if (exposures() == 1) return;
    previous_.t = record.state.t;
    previous_.x = record.state.x;
    previous_.v = record.state.v;
    has_previous_ = true;
}

FrameInFlight* ClipRenderer::take(const FrameSource& source) {
    for (;;) {
        std::optional<FrameRecord> record = source();
        if (!record) return nullptr;
        const int frame = record->frame;
        if (frame > options_.last) return nullptr;
        // Colours follow components through time, so frames that are not drawn are looked at too.
        const std::vector<Rgb>& colors = steady_.follow(colors_.assign(record->component, edges_));
        if (frame < options_.first) {
            remember(*record);
            continue;
        }
        FrameInFlight* slot = nullptr;
        free_.pop(slot);
        slot->record = std::move(*record);
        make_exposures(scene_, model_, slot->record, has_previous_ ? &previous_ : nullptr, colors,
                       exposures(), slot->exposures);
        slot->colors = colors;
        if (std::ranges::any_of(shots_, [&](const Shot& shot) { return of_still(shot.style); }))
            make_draw_frame(scene_, model_, drawn_, slot->record, colors, slot->still);
        remember(slot->record);
        return slot;
    }
}

Image& ClipRenderer::image_of(FrameInFlight& slot, std::size_t shot) const {
    return shot_view_[shot] >= 0 ? slot.pictures[static_cast<std::size_t>(shot_view_[shot])]
                                 : slot.parts[shot];
}

// On the renderer's thread.
void ClipRenderer::draw_shot(FrameInFlight& slot, std::size_t shot) {
    const Camera& camera = scene_.cameras[shots_[shot].camera];
    if (of_still(shots_[shot].style)) {
        slot.still.camera = camera_of_frame(scene_, camera, frame_time(scene_, slot.record.frame), model_,
                                            slot.still.positions, drawn_);
        return draw_still(slot, shot);
    }
    const std::vector<double> times = exposure_times(
        scene_, slot.exposures.size() > 1 ? slot.record.frame : 0, static_cast<int>(slot.exposures.size()));
    for (std::size_t e = 0; e < slot.exposures.size(); ++e) {
        const double t = slot.exposures.size() > 1 ? times[e] : frame_time(scene_, slot.record.frame);
        slot.exposures[e].camera =
            camera_of_frame(scene_, camera, t, model_, slot.exposures[e].positions, drawn_);
    }
    Image& image = image_of(slot, shot);
    drawing_.renderer().submit(shots_[shot].style, slot.exposures);
    drawing_.renderer().collect(image);
    if (legend_ && shots_[shot].style != DrawStyle::textured) legend_->add(slot.record, slot.colors, image);
}

/// A component view of the frame itself.
void ClipRenderer::draw_still(FrameInFlight& slot, std::size_t shot) {
    Image& image = image_of(slot, shot);
    const auto [width, height] = scene_.clip.size;
    if (!figure_) {
        drawing_.renderer().draw(DrawStyle::components, slot.still, image);
        if (legend_) legend_->add(slot.record, slot.colors, image);
        return;
    }
    image = canvas_image(width, height, 1, [&](Canvas& canvas) {
        figure_->draw(canvas, slot.record, slot.still, scene_.clip.size[0], scene_.clip.size[1]);
        if (legend_) Legend::draw(scene_, slot.record, slot.colors, scene_.clip.size[1], canvas);
    });
}

void ClipRenderer::draw(FrameInFlight& slot) {
    drawing_.run([&] {
        StageTimer timer;
        std::vector<char> wanted(shots_.size(), 0);
        for (std::size_t v = 0; v < options_.views.size(); ++v) {
            if (lies_there(slot, v)) continue;
            for (const std::size_t shot : view_shots_[v]) wanted[shot] = 1;
        }
        for (std::size_t shot = 0; shot < shots_.size(); ++shot)
            if (wanted[shot]) draw_shot(slot, shot);
        timer.lap(report_.draw);
    });
}

/// Puts a view of several shots together, beside each other.
void ClipRenderer::compose(FrameInFlight& slot, std::size_t view) const {
    const std::vector<std::size_t>& shots = view_shots_[view];
    if (shots.size() == 1) return;
    Image& out = slot.pictures[view];
    const std::size_t count = shots.size();
    const auto row_bytes = std::size_t{4} * static_cast<std::size_t>(scene_.clip.size[0]);
    out.width = static_cast<int>(count) * scene_.clip.size[0];
    out.height = scene_.clip.size[1];
    out.pixels.resize(row_bytes * count * static_cast<std::size_t>(out.height));
    for (std::size_t s = 0; s < count; ++s) {
        const Image& part = image_of(slot, shots[s]);
        for (int y = 0; y < out.height; ++y)
            std::memcpy(out.at(static_cast<int>(s) * scene_.clip.size[0], y), part.at(0, y), row_bytes);
    }
}

void ClipRenderer::write(FrameInFlight& slot) {
    StageTimer timer;
    const std::size_t count = options_.views.size();
    std::vector<char> taken_over(count, 0);
    for (std::size_t v = 0; v < count; ++v) {
        if (!lies_there(slot, v)) continue;
        Image there;
        if (take_over(slot, v, there)) {
            taken_over[v] = 1;
            slot.pictures[v] = std::move(there);
        } else {
            drawing_.run([&] {
                for (const std::size_t shot : view_shots_[v]) draw_shot(slot, shot);
            });
        }
    }
    for (std::size_t v = 0; v < count; ++v)
        if (!taken_over[v]) compose(slot, v);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
        const ClipView& view = options_.views[v];
        if (options_.keep_pictures && !taken_over[v])
            write_png(folder_.picture(view.name, slot.record.frame), slot.pictures[v],
                      {.alpha = scene_.look.transparent});
        if (options_.picture) options_.picture(view, slot.record.frame, slot.pictures[v]);
    });
    double spent = 0;
    timer.lap(spent);
    const std::lock_guard lock(mutex_);
    report_.write += spent;
}

void ClipRenderer::encode(FrameInFlight& slot) {
    StageTimer timer;
    tbb::parallel_for(std::size_t{0}, videos_.size(),
                      [&](std::size_t v) { videos_[v]->add(slot.pictures[v]); });
    timer.lap(report_.encode);
}

void ClipRenderer::release(FrameInFlight* slot) {
    ++report_.frames;
    free_.push(slot);
}

// What plays longer stays, unless this is all that was asked for.
void ClipRenderer::finish_video(std::size_t view, bool all) {
    const std::filesystem::path file = folder_.video(options_.views[view].name, options_.video_ending);
    const bool replaces = all && (draws_whole_clip() || !options_.keep_longer);
    const int before = replaces || !std::filesystem::exists(file) ? 0 : count_video_frames(file);
    if (before <= videos_[view]->frames()) return videos_[view]->finish();
    report_.kept = fmt::format("{} of {} frames stays as it was", file.filename().string(), before);
}

ClipReport ClipRenderer::finish(bool ended) {
    const bool all = report_.frames == options_.last - options_.first + 1;
    if (report_.frames == 0) report_.videos.clear();
    for (std::size_t v = 0; v < videos_.size(); ++v) {
        if (report_.frames > 0) finish_video(v, all);
    }
    if (folder_.root != target_.root) {
        // A run that has fewer frames than its scene says may have had them all in the old look too.
        const bool as_many = std::ranges::all_of(options_.views, [&](const ClipView& view) {
            return report_.frames >= count_pictures(target_, view.name);
        });
        if (all || (ended && as_many)) {
            adopt();
        } else {
            report_.kept =
                fmt::format("the clip that was there stays as it was; what is drawn so far is in {}",
                            folder_.root.string());
        }
    } else if (all && draws_whole_clip() && options_.keep_pictures) {
        for (const ClipView& view : options_.views) remove_pictures_beyond(target_, view.name, options_.last);
    }
    return report_;
}

// What was drawn beside the old clip takes its place.
void ClipRenderer::adopt() {
    for (const ClipView& view : options_.views) {
        adopt_pictures(folder_, target_, view.name);
        if (!videos_.empty())
            std::filesystem::rename(folder_.video(view.name, options_.video_ending),
                                    target_.video(view.name, options_.video_ending));
    }
    std::filesystem::remove_all(folder_.root);
}

bool ClipRenderer::lies_there(const FrameInFlight& slot, std::size_t view) const {
    return reusable_[view] != 0 &&
           std::filesystem::exists(folder_.picture(options_.views[view].name, slot.record.frame));
}

// False: the picture is damaged, or not of this clip's size.
bool ClipRenderer::take_over(const FrameInFlight& slot, std::size_t view, Image& picture) const {
    try {
        picture = read_png(folder_.picture(options_.views[view].name, slot.record.frame));
    } catch (const InputError&) {
        return false;
    }
    return picture.width == view_width(options_.views[view].layout, scene_.clip.size[0]) &&
           picture.height == scene_.clip.size[1];
}

}  // namespace unravel::tool
