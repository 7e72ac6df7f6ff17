#include "tool/clip.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>

#include <array>
#include <exception>
#include <memory>
#include <mutex>

#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/renderer.hpp"
#include "tool/picture_stamp.hpp"
#include "tool/render_thread.hpp"
#include "tool/view.hpp"

namespace unravel {

namespace {

// Frames between source and end of the pipeline at any time: one per stage and one to take up unevenness.
constexpr std::size_t frames_under_way = 5;

// A frame on its way. Reused, so that a long clip allocates no more than a short one.
struct Passage {
    FrameRecord record;
    DrawFrame drawing;
    std::vector<Image> pictures;  // one per style
};

VideoSettings video_settings(const Scene& scene, const ClipOptions& options) {
    VideoSettings settings;
    settings.width = scene.clip.size[0];
    settings.height = scene.clip.size[1];
    settings.fps_num = scene.clip.fps;
    settings.codec = options.codec;
    settings.preset = options.preset;
    settings.crf = options.crf;
    return settings;
}

RenderSettings render_settings(const Scene& scene, const ClipOptions& options) {
    return {scene.clip.size[0], scene.clip.size[1], options.samples, options.supersample};
}

// Everything between a frame record and its files.
class Studio {
public:
    Studio(const Scene& scene, const ClothModel& model, const Placement& placement, const RunFolder& folder,
           const ClipOptions& options)
        : scene_(scene),
          model_(model),
          folder_(folder),
          options_(options),
          edges_(drawn_edges(model)),
          drawn_(make_draw_scene(scene, model, placement, options.textures)) {
        thread_.run([&] {
            context_ = std::make_unique<GlContext>(options.device);
            renderer_ = std::make_unique<Renderer>(*context_, drawn_, render_settings(scene, options));
        });
        report_.renderer = renderer_->description();
        report_.renderer_summary = context_->summary();
        report_.software = context_->software();
        for (Passage& passage : passages_) free_.push(&passage);
        claim();
        if (options.video_ending.empty()) return;
        for (const DrawStyle style : options.styles) {
            const std::filesystem::path file = folder.video(style, options.video_ending);
            videos_.push_back(std::make_unique<VideoWriter>(file, video_settings(scene, options)));
            report_.encoders.push_back(videos_.back()->description());
            report_.videos.push_back(file.filename().string());
        }
    }
    ~Studio() {
        thread_.run([&] {
            renderer_.reset();
            context_.reset();
        });
    }
    Studio(const Studio&) = delete;
    Studio& operator=(const Studio&) = delete;

    // Null: the clip is over.
    Passage* take(const FrameSource& source) {
        for (;;) {
            std::optional<FrameRecord> record = source();
            if (!record) return nullptr;
            const int frame = record->frame;
            // Colours follow components through time, so frames that are not drawn are looked at too.
            const std::vector<Rgb>& colors = colors_.assign(record->component, edges_);
            if (frame < options_.first) continue;
            if (frame > options_.last) return nullptr;
            Passage* passage = nullptr;
            free_.pop(passage);
            passage->record = std::move(*record);
            make_draw_frame(scene_, model_, passage->record, colors, passage->drawing, options_.camera);
            passage->pictures.resize(options_.styles.size());
            return passage;
        }
    }

    void draw(Passage& passage) {
        thread_.run([&] {
            StageTimer timer;
            for (std::size_t s = 0; s < options_.styles.size(); ++s) {
                if (!lies_there(passage, s)) draw(passage, s);
            }
            timer.lap(report_.draw);
        });
    }

    void write(Passage& passage) {
        StageTimer timer;
        tbb::parallel_for(std::size_t{0}, options_.styles.size(), [&](std::size_t s) {
            const auto file = folder_.picture(options_.styles[s], passage.record.frame);
            const bool taken_over = lies_there(passage, s) && take_over(file, passage.pictures[s]);
            if (lies_there(passage, s) && !taken_over) thread_.run([&] { draw(passage, s); });
            if (options_.keep_pictures && !taken_over) write_png(file, passage.pictures[s]);
            if (options_.picture) {
                options_.picture(options_.styles[s], passage.record.frame, passage.pictures[s]);
            }
        });
        double spent = 0;
        timer.lap(spent);
        const std::lock_guard lock(mutex_);
        report_.write += spent;
    }

    void encode(Passage& passage) {
        StageTimer timer;
        tbb::parallel_for(std::size_t{0}, videos_.size(),
                          [&](std::size_t s) { videos_[s]->add(passage.pictures[s]); });
        timer.lap(report_.encode);
    }

    void release(Passage* passage) {
        ++report_.frames;
        free_.push(passage);
    }

    ClipReport finish() {
        if (report_.frames == 0) report_.videos.clear();
        for (const auto& video : videos_) {
            if (report_.frames > 0) video->finish();
        }
        return report_;
    }

private:
    void claim() {
        reusable_.assign(options_.styles.size(), 0);
        if (!options_.keep_pictures && !options_.reuse_pictures) return;
        const std::string stamp = picture_stamp(scene_, options_, report_.renderer);
        const bool whole = options_.first == 0 && options_.last == scene_.clip.frames() - 1;
        for (std::size_t s = 0; s < options_.styles.size(); ++s) {
            const bool same = claim_pictures(folder_, options_.styles[s], stamp, whole);
            reusable_[s] = options_.reuse_pictures && same;
        }
    }

    bool lies_there(const Passage& passage, std::size_t style) const {
        return reusable_[style] != 0 &&
               std::filesystem::exists(folder_.picture(options_.styles[style], passage.record.frame));
    }

    // False: the picture is damaged, or not of this clip's size.
    bool take_over(const std::filesystem::path& file, Image& picture) const {
        try {
            picture = read_png(file);
        } catch (const InputError&) {
            return false;
        }
        return picture.width == scene_.clip.size[0] && picture.height == scene_.clip.size[1];
    }

    // On the renderer's thread.
    void draw(Passage& passage, std::size_t style) {
        renderer_->draw(options_.styles[style], passage.drawing, passage.pictures[style]);
    }

    const Scene& scene_;
    const ClothModel& model_;
    const RunFolder& folder_;
    const ClipOptions& options_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<char> reusable_;  // (styles) pictures that lie there may be taken over
    ComponentColors colors_;
    DrawScene drawn_;
    RenderThread thread_;
    std::unique_ptr<GlContext> context_;  // made and destroyed on thread_
    std::unique_ptr<Renderer> renderer_;  // likewise
    std::vector<std::unique_ptr<VideoWriter>> videos_;
    std::array<Passage, frames_under_way> passages_;
    tbb::concurrent_bounded_queue<Passage*> free_;
    std::mutex mutex_;  // of report_.write: pictures are written by several tasks at once
    ClipReport report_;
};

}  // namespace

ClipReport make_clip(const Scene& scene, const ClothModel& model, const Placement& placement,
                     const RunFolder& folder, const ClipOptions& options, const FrameSource& source,
                     const std::function<void(int frame)>& done) {
    Studio studio(scene, model, placement, folder, options);
    std::exception_ptr stopped;  // by the source: what it has given is finished first

    const auto take = [&](tbb::flow_control& flow) -> Passage* {
        Passage* passage = nullptr;
        try {
            passage = studio.take(source);
        } catch (...) {
            stopped = std::current_exception();
        }
        if (!passage) flow.stop();
        return passage;
    };
    const auto draw = [&](Passage* passage) {
        studio.draw(*passage);
        return passage;
    };
    const auto write = [&](Passage* passage) {
        studio.write(*passage);
        return passage;
    };
    const auto encode = [&](Passage* passage) {
        studio.encode(*passage);
        const int frame = passage->record.frame;
        studio.release(passage);
        done(frame);
    };
    using tbb::filter_mode;
    tbb::parallel_pipeline(frames_under_way,
                           tbb::make_filter<void, Passage*>(filter_mode::serial_in_order, take) &
                               tbb::make_filter<Passage*, Passage*>(filter_mode::serial_in_order, draw) &
                               tbb::make_filter<Passage*, Passage*>(filter_mode::parallel, write) &
                               tbb::make_filter<Passage*, void>(filter_mode::serial_in_order, encode));
    ClipReport report = studio.finish();
    if (stopped) std::rethrow_exception(stopped);
    return report;
}

void check_clip(const Scene& scene, const RunFolder& folder, const ClipOptions& options) {
    if (!options.video_ending.empty()) {
        check_video_settings(folder.video(DrawStyle::textured, options.video_ending),
                             video_settings(scene, options));
    }
    const GlContext context(options.device);
}

}  // namespace unravel
