#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/draw_scene.hpp"
#include "sim/run/simulate.hpp"
#include "tool/base/names.hpp"
#include "tool/base/spread.hpp"

namespace unravel::tool {

/// How much work the reproduction does. Quick shows that it works; its numbers say little.
struct ReproduceScale {
    bool quick = false;
    int repetitions() const { return quick ? 1 : 5; }
    /// Sides of the square grids of Fig. 9.
    std::vector<int> sides() const {
        return quick ? std::vector<int>{11, 16, 23} : std::vector<int>{16, 23, 32, 45, 64, 100, 141, 200};
    }
};

/// A scene that ships, found in ./scenes or where the tool was built from; nothing if it is not there. Quick
/// makes it coarse and short.
std::optional<Scene> paper_scene(const std::string& name, const ReproduceScale& scale,
                                 std::vector<std::string> overrides = {});

/// A simulated scene with all that its frames left.
struct SceneRun {
    Scene scene;
    ClothModel model;
    std::vector<FrameRecord> records;
    std::vector<StepReport> reports;
    double step_seconds() const;
    double graph_share() const;        ///< of the steps' time
    double rvm_saved() const;          ///< 1 − decomposed/whole; needs compare
    double constrained_share() const;  ///< of rows, over all steps
};
SceneRun run_scene(const Scene& scene, int threads, bool compare_whole);

/// The frame in which the cloth is most evenly decomposed: greatest 1/Σ(share of free particles)², which
/// hundreds of single particles hardly change. Where constraints hold a twentieth of the cloth in some frame,
/// only such frames count: before it meets anything a cloth falls apart in free flight, which no figure
/// shows.
int most_decomposed_frame(const SceneRun& run);

/// The frame whose second largest component is the largest: two large blocks.
int two_blocks_frame(const SceneRun& run);

/// Frame records up to `frame` give the colours of its components.
std::vector<Rgb> colors_at(const SceneRun& run, int frame);

/// The components that a record's particles name.
Components components_of(const FrameRecord& record);

}  // namespace unravel::tool
