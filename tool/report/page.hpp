#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/palette.hpp"
#include "sim/frame_record.hpp"
#include "sim/model.hpp"
#include "sim/scene/scene.hpp"
#include "tool/clip.hpp"
#include "tool/report/component_table.hpp"
#include "tool/report/preview.hpp"
#include "tool/run_folder.hpp"

namespace unravel {

/// What the page shows of a frame beside its statistics.
struct PageFrame {
    int number = 0;
    double time = 0;                              ///< s
    std::uint64_t first_step = 0, last_step = 0;  ///< 0: frame 0, before any step
    std::vector<ComponentRow> components;         ///< the largest, as component_table() sorts them
    struct {
        std::uint32_t count = 0, particles = 0, springs = 0;
        std::uint64_t iterations = 0, rvm = 0;
    } rest;  ///< all others together
};

/// Looks at the frames of a run as they pass by and keeps what its page needs of them. Must see every frame
/// from the first, in order: colours are stable in time.
class PageRecorder {
public:
    explicit PageRecorder(const ClothModel& model);
    void see(const FrameRecord& record);
    const std::vector<PageFrame>& frames() const { return frames_; }

private:
    const ClothModel& model_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
    ComponentColors colors_;
    std::vector<PageFrame> frames_;
};

/// What the page tells besides frames.
struct PageFacts {
    std::string status;                                     ///< "complete", "interrupted", "failed"
    std::vector<std::pair<std::string, std::string>> made;  ///< how: renderer, encoder, threads, …
};

/// The same for a run, from its run.json.
PageFacts page_facts(const nlohmann::ordered_json& run_json);

/// Bytes that the pictures within a page may take.
inline constexpr std::size_t picture_budget = std::size_t{24} << 20;

/// Views that the page shows, both by the scene's first camera.
inline constexpr Layout page_layouts[] = {Layout::textured, Layout::components};

/// Previews for the pictures that a page of these options will show.
Previews previews_of(const Scene& scene, const ClipOptions& options);
/// Takes the pictures of a clip that are the page's views.
std::function<void(const ClipView&, int, const Image&)> take_previews(Previews& previews);

/// The whole of report.html: one file that needs no other and no network. Pictures that do not fit the budget
/// are linked where the folder has them. `reports` are all steps of the run, with their times.
std::string report_page(const Scene& scene, const ClothModel& model, const RunFolder& folder,
                        const std::vector<PageFrame>& frames, std::span<const StepReport> reports,
                        const Previews& previews, const PageFacts& facts);

}  // namespace unravel
