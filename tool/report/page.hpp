#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/palette.hpp"
#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/folder/run_folder.hpp"
#include "tool/picture/clip.hpp"
#include "tool/report/component_table.hpp"
#include "tool/report/preview.hpp"

namespace unravel::tool {

/// What the page shows of a frame beside its statistics.
struct PageFrame {
    int number = 0;
    double time = 0;                              ///< s
    std::uint64_t first_step = 0, last_step = 0;  ///< 0: frame 0, before any step
    std::size_t first_row = 0, rows = 0;          ///< the largest components; PageRecorder::rows()
    struct {
        std::uint32_t count = 0, particles = 0, springs = 0;
        std::uint64_t iterations = 0, rvm = 0;
    } rest;  ///< all others together
};

/// Looks at the frames of a run as they pass by and keeps what its page needs of them. Must see every frame
/// from the first, in order: colours are stable in time. Tables wait in the file system of `folder`.
class PageRecorder {
public:
    PageRecorder(const ClothModel& model, const std::filesystem::path& folder);
    void add(const FrameRecord& record);
    const std::vector<PageFrame>& frames() const { return frames_; }
    /// A frame's largest components, as component_table() sorts them.
    std::vector<ComponentRow> rows(const PageFrame& frame) const {
        return rows_.read(frame.first_row, frame.rows);
    }

private:
    const ClothModel& model_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
    ComponentColors colors_;
    std::vector<PageFrame> frames_;
    DiskList<ComponentRow> rows_;
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

/// Previews for the pictures that a page of these options will show, put aside near `folder`.
Previews previews_of(const Scene& scene, const ClipOptions& options, const std::filesystem::path& folder);
/// Takes the pictures of a clip that are the page's views.
std::function<void(const ClipView&, int, const Image&)> take_previews(Previews& previews);

/// Writes the folder's report.html: one file that needs no other and no network. Pictures that do not fit the
/// budget are linked where the folder has them. `reports` are all steps of the run, with their times.
void write_report_page(const Scene& scene, const ClothModel& model, const RunFolder& folder,
                       const PageRecorder& recorder, std::span<const StepReport> reports,
                       const Previews& previews, const PageFacts& facts);

}  // namespace unravel::tool
