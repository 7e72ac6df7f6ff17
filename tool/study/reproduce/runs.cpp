#include "tool/study/reproduce/runs.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "render/palette.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/program.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

std::optional<Scene> paper_scene(const std::string& name, const ReproduceScale& scale,
                                 std::vector<std::string> overrides) {
    std::filesystem::path file = std::filesystem::path("scenes") / (name + ".toml");
    if (!std::filesystem::exists(file)) file = shipped_scenes() / (name + ".toml");
    if (!std::filesystem::exists(file)) return std::nullopt;
    // The paper's own, so that iterations and multiplies compare.
    overrides.insert(overrides.begin(), "solver.preconditioner=constrained-block");
    if (scale.quick) {
        const Scene whole = load_scene(file);
        const auto& n = whole.cloths.front().particles;
        if (n[0] * n[1] > 600)
            overrides.insert(overrides.begin(), whole.cloths.front().wrap == Wrap::tube
                                                    ? "cloth.particles=[20,27]"
                                                    : "cloth.particles=[21,21]");
        if (whole.clip.duration > 0.6) overrides.insert(overrides.begin(), "clip.duration=0.6");
    }
    return load_scene(file, overrides);
}

double SceneRun::step_seconds() const {
    double sum = 0;
    for (const StepReport& r : reports) sum += r.times.step();
    return sum;
}

double SceneRun::graph_share() const {
    double graph = 0;
    for (const StepReport& r : reports) graph += r.times.graph;
    return graph / step_seconds();
}

double SceneRun::rvm_saved() const {
    double rvm = 0, whole = 0;
    for (const StepReport& r : reports) {
        rvm += static_cast<double>(r.rvm);
        whole += static_cast<double>(r.rvm_whole.value_or(0));
    }
    return whole > 0 ? 1 - rvm / whole : 0;
}

double SceneRun::constrained_share() const {
    double held = 0;
    for (const StepReport& r : reports) held += r.constrained;
    return held / (static_cast<double>(reports.size()) * static_cast<double>(model.size()));
}

SceneRun run_scene(const Scene& scene, int threads, bool compare_whole) {
    SceneRun run;
    run.scene = scene;
    tbb::task_arena arena(threads);
    Simulation simulation = start_simulation(scene);
    simulation.options.compare_whole = compare_whole;
    run.records.push_back(present_record(simulation));
    for (int k = 1; k < scene.clip.frames(); ++k) {
        arena.execute([&] { run.records.push_back(next_record(simulation)); });
        const auto& reports = run.records.back().reports;
        run.reports.insert(run.reports.end(), reports.begin(), reports.end());
    }
    run.model = std::move(simulation.model);
    return run;
}

int most_decomposed_frame(const SceneRun& run) {
    const auto touches = [&](const FrameRecord& record) {
        const auto held = std::count(record.component.begin(), record.component.end(), -1);
        return 20 * static_cast<std::size_t>(held) >= record.component.size();
    };
    const bool any = std::any_of(run.records.begin() + 1, run.records.end(), touches);
    int best = 1;
    double most = 0;
    for (std::size_t k = 1; k < run.records.size(); ++k) {
        if (any && !touches(run.records[k])) continue;
        const Components components = components_of(run.records[k]);
        double squares = 0;
        const double free = components.start.empty() ? 0 : components.start.back();
        for (std::size_t c = 0; c < components.count(); ++c)
            squares += std::pow(components.size(c) / free, 2);
        if (squares > 0 && 1 / squares > most) {
            most = 1 / squares;
            best = static_cast<int>(k);
        }
    }
    return best;
}

int two_blocks_frame(const SceneRun& run) {
    int best = 1;
    std::uint32_t most = 0;
    for (std::size_t k = 1; k < run.records.size(); ++k) {
        const Components components = components_of(run.records[k]);
        std::uint32_t first = 0, second = 0;
        for (std::size_t c = 0; c < components.count(); ++c) {
            const std::uint32_t size = components.size(c);
            second = std::max(second, std::min(first, size));
            first = std::max(first, size);
        }
        if (second > most) {
            most = second;
            best = static_cast<int>(k);
        }
    }
    return best;
}

std::vector<Rgb> colors_at(const SceneRun& run, int frame) {
    ComponentColors colors;
    const auto edges = drawn_edges(run.model);
    std::vector<Rgb> result;
    for (int k = 0; k <= frame; ++k)
        result = colors.assign(run.records[static_cast<std::size_t>(k)].component, edges);
    return result;
}

Components components_of(const FrameRecord& record) {
    Components out;
    out.label = record.component;
    std::int32_t count = 0;
    for (const std::int32_t c : record.component) count = std::max(count, c + 1);
    out.start.assign(static_cast<std::size_t>(count) + 1, 0);
    for (std::int32_t c = 0; c <= count; ++c) {
        out.start[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(out.order.size());
        // The fully constrained follow the last component.
        for (std::uint32_t p = 0; p < record.component.size(); ++p) {
            if (record.component[p] == (c == count ? -1 : c)) out.order.push_back(p);
        }
    }
    return out;
}

}  // namespace unravel::tool
