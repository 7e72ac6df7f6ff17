// unravel preview SCENE: a coarse and quick look at a scene, once or on every save.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "render/renderer.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/picture/view.hpp"
#include "tool/plot/canvas.hpp"
#include "tool/run/draft.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

using PreviewClock = std::chrono::steady_clock;

struct PreviewOptions {
    fs::path scene, file;  // empty: output/<scene name>_preview.png
    std::vector<std::string> overrides;
    int still = -1;    // this frame alone; -1: a sheet
    int pictures = 6;  // of the sheet
    int particles = draft_particles;
    int width = 480;     // px of each picture
    double seconds = 5;  // of simulation, after which the sheet ends
    bool watch = false;
    std::string device = "auto";
    int threads = 0;
    OutputOptions output;
};

// How often files are looked at.
constexpr std::chrono::milliseconds watch_period{100};
constexpr int sheet_gap = 4;  // px between pictures

// Frames to be drawn, as far as the simulation came.
std::vector<int> wanted_frames(const PreviewOptions& options, const Scene& scene) {
    const int last = scene.clip.frames() - 1;
    if (options.still > last)
        throw UsageError(fmt::format("--still {}: the frames are 0-{}", options.still, last));
    if (options.still >= 0) return {options.still};
    const int count = std::min(options.pictures, last + 1);
    std::vector<int> frames;
    for (int k = 0; k < count; ++k)
        frames.push_back(
            count > 1 ? static_cast<int>(std::lround(static_cast<double>(last) * k / (count - 1))) : 0);
    return frames;
}

// What a preview shows: frames, and how far it came where it had to stop.
struct Seen {
    std::vector<FrameRecord> records;
    std::string stopped;  // why it ended early; empty: it did not
};

Seen simulate_frames(Simulation& simulation, const std::vector<int>& frames, double seconds) {
    const auto begin = PreviewClock::now();
    const auto in_time = [&] {
        return std::chrono::duration<double>(PreviewClock::now() - begin).count() < seconds &&
               !InterruptWatch::requested();
    };
    Seen seen;
    try {
        bool on = settle(simulation, in_time);
        FrameRecord record = present_record(simulation);
        for (std::size_t k = 0; k < frames.size(); ++k) {
            while (on && record.frame < frames[k] && (on = in_time())) record = next_record(simulation);
            if (on || k == 0) seen.records.push_back(record);
            if (!on) {
                seen.stopped =
                    fmt::format("{:g} s of simulation ended at frame {} (--seconds)", seconds, record.frame);
                if (seen.records.back().frame < record.frame) seen.records.push_back(record);
                break;
            }
        }
    } catch (const SimulationError& error) {
        seen.stopped = error.what();
        seen.records.push_back(present_record(simulation));
    }
    return seen;
}

Image draw_sheet(const Scene& scene, const ClothModel& model, const Seen& seen, const GlContext& context) {
    Placement placement;
    build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, model, placement, scene.home);
    const auto [width, height] = scene.clip.size;
    Renderer renderer(context, drawn, {width, height, 0, 1});
    const std::vector<Rgb> colors(model.size());
    std::vector<Image> pictures(seen.records.size());
    DrawFrame frame;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        make_draw_frame(scene, model, drawn, seen.records[k], colors, frame);
        renderer.draw(DrawStyle::textured, frame, pictures[k]);
    }
    if (pictures.size() == 1) return std::move(pictures.front());
    const int columns = pictures.size() <= 4 ? 2 : 3;
    const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
    return canvas_image(columns * (width + sheet_gap) - sheet_gap, rows * (height + sheet_gap) - sheet_gap, 1,
                        [&](Canvas& canvas) {
                            canvas.font(0.045 * height);
                            for (std::size_t k = 0; k < pictures.size(); ++k) {
                                const int column = static_cast<int>(k) % columns,
                                          row = static_cast<int>(k) / columns;
                                const double x = column * (width + sheet_gap), y = row * (height + sheet_gap);
                                canvas.picture(pictures[k], x, y, width, height);
                                canvas.color({40, 40, 46});
                                canvas.text(x + 0.03 * height, y + 0.07 * height,
                                            fmt::format("frame {}, {:.2f} s", seen.records[k].frame,
                                                        frame_time(scene, seen.records[k].frame)));
                            }
                        });
}

// Pictures `width` wide, in the clip's own proportion.
std::array<int, 2> picture_size(const Clip& clip, int width) {
    const int height =
        static_cast<int>(std::lround(static_cast<double>(width) * clip.size[1] / clip.size[0]));
    return {width, std::max(16, height)};
}

// Files whose change makes another picture.
std::vector<fs::path> files_of(const Scene& scene, const fs::path& file) {
    std::vector<fs::path> files{file};
    const auto add = [&](const std::string& name) {
        if (!name.empty()) files.push_back(scene.home / name);
    };
    for (const std::string& name : scene.include) add(name);
    for (const Cloth& cloth : scene.cloths) add(cloth.mesh.file);
    for (const Solid& solid : scene.solids) add(solid.mesh.file);
    for (const ClothLook& look : scene.look.cloth) add(look.texture);
    return files;
}

// When each was last written; of one that is not there (an editor is replacing it) never.
std::vector<fs::file_time_type> times_of(const std::vector<fs::path>& files) {
    std::vector<fs::file_time_type> times;
    for (const fs::path& file : files) {
        std::error_code error;
        const fs::file_time_type time = fs::last_write_time(file, error);
        times.push_back(error ? fs::file_time_type::min() : time);
    }
    return times;
}

class Previewer {
public:
    explicit Previewer(const PreviewOptions& options)
        : options_(options), context_(parse_device_choice(options.device)), files_{options.scene} {}

    // One picture. Throws what loading, simulating and drawing throw.
    void make() {
        const auto begin = PreviewClock::now();
        const Scene scene = load_scene(options_.scene, options_.overrides);
        files_ = files_of(scene, options_.scene);
        Scene draft = draft_of(scene, options_.particles);
        draft.clip.size = picture_size(scene.clip, options_.width);
        const std::vector<int> frames = wanted_frames(options_, scene);
        Simulation simulation = start_simulation(draft);
        const Seen seen = simulate_frames(simulation, frames, options_.seconds);
        const Image picture = draw_sheet(draft, simulation.model, seen, context_);
        const fs::path file =
            options_.file.empty() ? fs::path("output") / (scene.name + "_preview.png") : options_.file;
        if (file.has_parent_path()) fs::create_directories(file.parent_path());
        write_png(file, picture, {.level = 1});
        tell(scene, simulation, seen, file,
             std::chrono::duration<double>(PreviewClock::now() - begin).count());
    }

    // Makes a picture now and whenever one of its files is saved, until a stop is asked for.
    int watch() {
        std::vector<fs::file_time_type> times;
        while (!InterruptWatch::requested()) {
            times = times_of(files_);
            try {
                make();
            } catch (const SceneError& error) {
                fmt::print(stderr, "{}\n", error.what());
            } catch (const std::system_error& error) {
                fmt::print(stderr, "{}\n", error.what());
            }
            const std::vector<fs::path> watched = files_;
            if (times.size() != watched.size()) times = times_of(watched);
            while (!InterruptWatch::requested() && times_of(watched) == times)
                std::this_thread::sleep_for(watch_period);
        }
        return InterruptWatch::exit_code();
    }

private:
    void tell(const Scene& scene, const Simulation& simulation, const Seen& seen, const fs::path& file,
              double seconds) const {
        std::vector<int> frames;
        for (const FrameRecord& record : seen.records) frames.push_back(record.frame);
        std::size_t whole = 0;
        for (const Cloth& cloth : scene.cloths)
            whole +=
                static_cast<std::size_t>(cloth.particles[0]) * static_cast<std::size_t>(cloth.particles[1]);
        if (options_.output.json) {
            const nlohmann::ordered_json json{{"file", file.string()},
                                              {"frames", frames},
                                              {"particles", simulation.model.size()},
                                              {"particles_of_scene", whole},
                                              {"stopped", seen.stopped},
                                              {"seconds", seconds}};
            fmt::print("{}\n", json.dump(options_.watch ? -1 : 2));
        } else if (!options_.output.quiet) {
            fmt::print("{}: frames {}, {} of {} particles, {:.2f} s\n", file.string(),
                       fmt::join(frames, ", "), simulation.model.size(), whole, seconds);
            if (!seen.stopped.empty()) fmt::print("  {}\n", seen.stopped);
            for (const std::string& note : scene.notes) fmt::print("  note: {}\n", note);
        }
        std::fflush(stdout);
    }

    const PreviewOptions& options_;
    GlContext context_;
    std::vector<fs::path> files_;
};

int preview(const PreviewOptions& options) {
    if (options.watch && options.scene == "-")
        throw UsageError("--watch: what comes from standard input is never saved again");
    const InterruptWatch interrupts;
    const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(thread_count(options.threads)));
    Previewer previewer(options);
    if (options.watch) return previewer.watch();
    previewer.make();
    return InterruptWatch::requested() ? InterruptWatch::exit_code() : exit_done;
}

}  // namespace

void add_preview(CommandLine& line) {
    const auto [command, o] = line.add("preview", "a coarse and quick look at a scene", preview);
    command.add_option("SCENE", o.scene, "scene file, or - for standard input")->required();
    command.add_option("-o", o.file, "PNG file (default: output/<scene name>_preview.png)");
    add_overrides(command, o.overrides);
    command.add_option("--still", o.still, "this frame alone, instead of a sheet")
        ->check(CLI::Range(0, 100000));
    command.add_option("--pictures", o.pictures, "of the sheet")
        ->check(CLI::Range(1, 60))
        ->capture_default_str();
    command.add_option("--particles", o.particles, "about so many of all cloths together")
        ->check(CLI::Range(16, 4000000))
        ->capture_default_str();
    command.add_option("--width", o.width, "pixels, of each picture")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    command.add_option("--seconds", o.seconds, "of simulation, after which it shows how far it came")
        ->check(CLI::Range(0.05, 1e5))
        ->capture_default_str();
    command.add_flag("--watch", o.watch, "again on every save of the scene or of a file that it names");
    add_device(command, o.device);
    add_threads(command, o.threads);
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
