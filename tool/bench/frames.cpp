#include "tool/bench/frames.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/renderer.hpp"
#include "sim/run/simulate.hpp"
#include "tool/picture/clip.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

// Processor time that the whole machine has spent so far [ms]; 0 where the system does not tell.
double machine_busy() {
    std::ifstream file("/proc/stat");
    std::string name;
    double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0;
    if (!(file >> name >> user >> nice >> system >> idle >> wait >> irq >> soft)) return 0;
    return 1e3 * (user + nice + system + irq + soft) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// Wall and processor time from its making on [ms].
class Stopwatch {
public:
    FrameStage read(std::string name, int frames) const {
        const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start_;
        return {std::move(name), wall.count() / frames, (cpu_now() - cpu_) / frames};
    }

private:
    static double cpu_now() {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        const auto ms = [](const timeval& t) {
            return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
        };
        return ms(usage.ru_utime) + ms(usage.ru_stime);
    }
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double cpu_ = cpu_now();
};

// What every stage of the measurement works on.
struct Work {
    const Scene& scene;
    int frames;
    int threads;
    std::vector<FrameRecord> records;
    std::vector<DrawFrame> drawings;
    std::array<std::vector<Image>, 2> pictures;  // by style
};

FrameStage measure_simulation(Work& work) {
    tbb::task_arena arena(work.threads);
    Simulation simulation = start_simulation(work.scene);
    const Stopwatch watch;
    work.records.push_back(present_record(simulation));
    while (static_cast<int>(work.records.size()) < work.frames)
        arena.execute([&] { work.records.push_back(next_record(simulation)); });
    return watch.read("simulate", work.frames);
}

FrameStage measure_drawings(Work& work, const ClothModel& model, const DrawScene& drawn) {
    const auto edges = drawn_edges(model);
    ComponentColors colors;
    work.drawings.resize(work.records.size());
    const Stopwatch watch;
    for (std::size_t k = 0; k < work.records.size(); ++k)
        make_draw_frame(work.scene, model, drawn, work.records[k],
                        colors.assign(work.records[k].component, edges), work.drawings[k]);
    return watch.read("colours and shapes", work.frames);
}

FrameStage measure_drawing(Work& work, Renderer& renderer, DrawStyle style, const char* name) {
    std::vector<Image>& pictures = work.pictures[style == DrawStyle::textured ? 0 : 1];
    pictures.resize(work.drawings.size());
    renderer.draw(style, work.drawings[0], pictures[0]);  // shaders are compiled at their first use
    const Stopwatch watch;
    for (std::size_t k = 0; k < work.drawings.size(); ++k)
        renderer.draw(style, work.drawings[k], pictures[k]);
    return watch.read(name, work.frames);
}

FrameStage measure_png(const Work& work, const RunFolder& folder) {
    const Stopwatch watch;
    tbb::parallel_for(0, work.frames, [&](int k) {
        for (std::size_t s = 0; s < 2; ++s)
            write_png(folder.picture(s == 0 ? "textured" : "components", k),
                      work.pictures[s][static_cast<std::size_t>(k)]);
    });
    return watch.read("PNG, both views", work.frames);
}

FrameStage measure_video(const Work& work, const RunFolder& folder, std::string& encoder) {
    VideoSettings settings;
    settings.width = work.scene.clip.size[0];
    settings.height = work.scene.clip.size[1];
    settings.fps_num = work.scene.clip.fps.num;
    settings.fps_den = work.scene.clip.fps.den;
    const Stopwatch watch;
    tbb::parallel_for(std::size_t{0}, std::size_t{2}, [&](std::size_t s) {
        VideoWriter video(folder.video(s == 0 ? "textured" : "components", ".mp4"), settings);
        for (const Image& picture : work.pictures[s]) video.add(picture);
        video.finish();
        if (s == 0) encoder = video.description();
    });
    return watch.read("mp4, both views", work.frames);
}

FrameStage measure_together(const Work& work, const RunFolder& folder, const DeviceChoice& device,
                            double& others) {
    Simulation simulation = start_simulation(work.scene);
    Placement placement;
    build_model(work.scene, placement);
    ClipOptions options;
    options.device = device;
    options.last = work.frames - 1;
    tbb::task_arena arena(work.threads);
    int next = 0;
    const FrameSource source = [&]() -> std::optional<FrameRecord> {
        if (next == work.frames) return std::nullopt;
        FrameRecord record;
        arena.execute([&] { record = next == 0 ? present_record(simulation) : next_record(simulation); });
        ++next;
        return record;
    };
    const Stopwatch watch;
    const double busy = machine_busy();
    make_clip(work.scene, simulation.model, placement, folder, options, source, [](int) {});
    const FrameStage stage = watch.read("together", work.frames);
    others = std::max(0.0, ((machine_busy() - busy) / work.frames - stage.cpu) / stage.wall);
    return stage;
}

}  // namespace

double FrameBench::bound() const {
    double slowest = 0, cpu = 0;
    for (const FrameStage& stage : stages) {
        slowest = std::max(slowest, stage.wall);
        cpu += stage.cpu;
    }
    return std::max(slowest, cpu / std::max(processors - others, 0.1));
}

FrameBench bench_frames(const Scene& scene, int frames, int threads, const DeviceChoice& device,
                        const std::filesystem::path& folder) {
    FrameBench bench;
    bench.frames = std::min(frames, scene.clip.frames());
    bench.processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const RunFolder files{folder};
    std::filesystem::create_directories(files.frames());
    Work work{scene, bench.frames, threads > 0 ? threads : bench.processors, {}, {}, {}};
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    bench.stages.push_back(measure_simulation(work));
    const DrawScene drawn = make_draw_scene(scene, model, placement);
    bench.stages.push_back(measure_drawings(work, model, drawn));
    {
        const GlContext context(device);
        Renderer renderer(context, drawn, {scene.clip.size[0], scene.clip.size[1], ClipOptions{}.samples, 1});
        bench.renderer = renderer.description();
        bench.stages.push_back(measure_drawing(work, renderer, DrawStyle::textured, "draw textured"));
        bench.stages.push_back(measure_drawing(work, renderer, DrawStyle::components, "draw components"));
    }
    bench.stages.push_back(measure_png(work, files));
    bench.stages.push_back(measure_video(work, files, bench.encoder));
    bench.together = measure_together(work, files, device, bench.others);
    std::error_code error;
    std::filesystem::remove_all(folder, error);
    return bench;
}

std::string frame_bench_text(const FrameBench& bench) {
    std::string text =
        fmt::format("{}; {}; {} frames, {} processors\n{:<22}{:>10}{:>10}  ms per frame\n", bench.renderer,
                    bench.encoder, bench.frames, bench.processors, "stage", "wall", "cpu");
    FrameStage sum{"all in turn", 0, 0};
    for (const FrameStage& stage : bench.stages) {
        text += fmt::format("{:<22}{:>10.1f}{:>10.1f}\n", stage.name, stage.wall, stage.cpu);
        sum.wall += stage.wall;
        sum.cpu += stage.cpu;
    }
    for (const FrameStage& stage : {sum, bench.together})
        text += fmt::format("{:<22}{:>10.1f}{:>10.1f}\n", stage.name, stage.wall, stage.cpu);
    text += fmt::format(
        "bound {:.1f} (slowest stage, or all processors busy; others kept {:.2f} of them); together is "
        "{:.0f}% above it\n",
        bench.bound(), bench.others, 100 * (bench.together.wall / bench.bound() - 1));
    return text;
}

namespace {

nlohmann::ordered_json stage_json(const FrameStage& stage) {
    return {{"name", stage.name}, {"wall_ms", stage.wall}, {"cpu_ms", stage.cpu}};
}

}  // namespace

nlohmann::ordered_json frame_bench_json(const FrameBench& bench) {
    nlohmann::ordered_json json{{"renderer", bench.renderer},
                                {"encoder", bench.encoder},
                                {"frames", bench.frames},
                                {"processors", bench.processors},
                                {"others", bench.others},
                                {"bound_ms", bench.bound()},
                                {"together", stage_json(bench.together)}};
    for (const FrameStage& stage : bench.stages) json["stages"].push_back(stage_json(stage));
    return json;
}

}  // namespace unravel::tool
