// Figs 1, 7 and 8, and what Sec. 6.3 says of row–vector multiplies and overhead.

#include <fmt/format.h>

#include <algorithm>

#include "tool/picture/still.hpp"
#include "tool/study/reproduce/claims.hpp"

namespace unravel::tool {

namespace {

struct Snapshot {
    const char *scene, *heading, *paper;
    double saved_low, saved_high;  ///< what the paper reports of RVMs saved; negative: nothing
    bool explicit_shear = false;   ///< as the figure's caption says
};

// Soft enough in shear that κ (7) stays below the threshold at 51 × 51 particles and h = 1/200 s.
// As in the paper, a slack spring has no Jacobian, however near to its length it is.
const std::vector<std::string> explicit_shear{"cloth.material.shear=0.25", "cloth.material.shear_damping=0",
                                              "solver.activation_band=0"};

constexpr Snapshot snapshots[] = {
    {"drape_sphere", "Fig. 1, left: cloth draping over a sphere",
     "Textured and decomposed-wireframe snapshots; each colour a component, white fully constrained. 20% "
     "fewer RVMs.",
     0.20, 0.20},
    {"arm_bend", "Fig. 1, right: arm bend", "The same of a sleeve on a bending arm. 35–50% fewer RVMs.", 0.35,
     0.50},
    {"tablecloth", "Fig. 7: cloth draping over a square table",
     "Decomposed snapshot, implicit stretch and explicit shear. No number for this scene.", -1, -1, true},
    {"pinned_centre", "Fig. 8: cloth pinned at its centre",
     "Pinned at its centre point, has just begun falling; implicit stretch and explicit shear. No number for "
     "this "
     "scene.",
     -1, -1, true}};

Claim missing(const Snapshot& snapshot) {
    Claim claim;
    claim.heading = snapshot.heading;
    claim.paper = snapshot.paper;
    claim.ours = fmt::format("MISSING: there is no scenes/{}.toml beside the tool.", snapshot.scene);
    claim.numbers["missing"] = true;
    return claim;
}

void draw_views(Claim& claim, const SceneRun& run, int frame, const DeviceChoice& device) {
    try {
        std::vector<Image> views =
            draw_still(run.scene, run.model, run.records[static_cast<std::size_t>(frame)],
                       colors_at(run, frame), device);
        claim.views.emplace_back(fmt::format("textured view, frame {}", frame), std::move(views[0]));
        claim.views.emplace_back(fmt::format("components view, frame {}", frame), std::move(views[1]));
    } catch (const RendererError& error) {
        claim.ours += fmt::format(" MISSING: its pictures, because {}", error.what());
    }
}

Claim snapshot_claim(const Snapshot& snapshot, const SceneRun& run, const DeviceChoice& device) {
    Claim claim;
    claim.heading = snapshot.heading;
    claim.paper = snapshot.paper;
    const int frame = most_decomposed_frame(run);
    const StepReport& last = run.records[static_cast<std::size_t>(frame)].reports.back();
    const double saved = run.rvm_saved();
    std::uint32_t most = 0;
    for (const StepReport& r : run.reports) most = std::max(most, r.components);
    claim.ours = fmt::format(
        "{} particles. Frame {} ({:.2f} s) is the most evenly decomposed: {} components, the largest of {} "
        "particles, {} fully constrained; springs: {} implicit, {} explicit, {} slack. Over the clip at most "
        "{} components; {:.1f}% fewer RVMs than the whole-system "
        "solver "
        "needs for the very same systems.",
        run.model.size(), frame, last.t, last.components, last.largest, last.constrained, last.implicit,
        last.explicit_, last.inactive, most, 100 * saved);
    if (snapshot.saved_low >= 0 &&
        (saved < snapshot.saved_low - 0.02 || saved > snapshot.saved_high + 0.02)) {
        claim.why = fmt::format(
            "The paper does not give its scene in full, and the saving follows the share of fully "
            "constrained rows, "
            "which friction, shape and time make: here {:.1f}% of all rows over the clip.",
            100 * run.constrained_share());
    }
    std::string set;
    if (snapshot.explicit_shear) {
        for (const std::string& key : explicit_shear) set += " --set " + key;
    }
    claim.commands = {fmt::format("./run scenes/{}.toml --compare-whole{}", snapshot.scene, set),
                      fmt::format("./run inspect output/{} --frame {}", snapshot.scene, frame)};
    claim.numbers = {{"scene", snapshot.scene},
                     {"particles", run.model.size()},
                     {"frame", frame},
                     {"components", last.components},
                     {"most_components", most},
                     {"rvm_saved", saved},
                     {"graph_share", run.graph_share()},
                     {"constrained_share", run.constrained_share()}};
    draw_views(claim, run, frame, device);
    return claim;
}

// RVMs saved, step by step and in all, beside the paper's ranges.
Claim rvm_claim(const std::vector<std::pair<const Snapshot*, SceneRun>>& runs) {
    Claim claim;
    claim.heading = "Sec. 6.3: row–vector multiplies saved";
    claim.paper = "0–80% fewer RVMs; 35–50% in arm bend, 20% in draping over a sphere.";
    Plot plot;
    plot.title = "RVMs saved by decomposing";
    plot.y.label = "fewer RVMs than whole [%]";
    plot.series = {{"paper", {}, SeriesStyle::bars}, {"ours", {}, SeriesStyle::bars}};
    double low = 1, high = 0;
    for (const auto& [snapshot, run] : runs) {
        const double x = static_cast<double>(plot.x.categories.size());
        plot.x.categories.push_back(snapshot->scene);
        if (snapshot->saved_low >= 0) {
            PlotPoint paper{x, 50 * (snapshot->saved_low + snapshot->saved_high)};
            if (snapshot->saved_high > snapshot->saved_low)
                paper.low = 100 * snapshot->saved_low, paper.high = 100 * snapshot->saved_high;
            plot.series[0].points.push_back(paper);
        }
        // The spread within a clip: its frames, each over its own steps.
        PlotPoint ours{x, 100 * run.rvm_saved()};
        ours.low = 100, ours.high = 0;
        for (const FrameRecord& record : run.records) {
            double rvm = 0, whole = 0;
            for (const StepReport& r : record.reports) {
                rvm += static_cast<double>(r.rvm);
                whole += static_cast<double>(r.rvm_whole.value_or(0));
            }
            if (whole <= 0) continue;
            ours.low = std::min(ours.low, 100 * (1 - rvm / whole));
            ours.high = std::max(ours.high, 100 * (1 - rvm / whole));
        }
        ours.note = fmt::format("{:.0f}%", ours.y);
        low = std::min(low, ours.low / 100);
        high = std::max(high, ours.high / 100);
        plot.series[1].points.push_back(ours);
    }
    claim.ours = fmt::format(
        "From {:.0f}% to {:.0f}% in single frames; bars are whole clips, strokes the range over "
        "their frames.",
        100 * low, 100 * high);
    claim.commands = {"./run scenes/drape_sphere.toml --compare-whole   # stats.csv: rvm, rvm_whole"};
    claim.figures.push_back(
        {"rvm_saved", "Row–vector multiplies saved, whole clips.", plot_svg(plot), plot_image(plot), true});
    claim.numbers = {{"frame_lowest", low}, {"frame_highest", high}};
    return claim;
}

Claim overhead_claim(const std::vector<std::pair<const Snapshot*, SceneRun>>& runs) {
    Claim claim;
    claim.heading = "Sec. 5.3: overhead of decomposing";
    claim.paper = "Graph search and sorting add approximately 2% to the step.";
    Plot plot;
    plot.title = "Share of the graph search in the step";
    plot.y.label = "[%]";
    plot.guides.push_back({2, true, "paper: about 2%"});
    plot.series = {{"ours", {}, SeriesStyle::bars}};
    for (const auto& [snapshot, run] : runs) {
        PlotPoint point{static_cast<double>(plot.x.categories.size()), 100 * run.graph_share()};
        point.note = fmt::format("{:.1f}%", point.y);
        plot.x.categories.push_back(snapshot->scene);
        plot.series[0].points.push_back(point);
        claim.ours += fmt::format("{}{} {:.2f}%", claim.ours.empty() ? "" : ", ", snapshot->scene, point.y);
        claim.numbers[snapshot->scene] = run.graph_share();
    }
    claim.commands = {
        "./run simulate scenes/drape_sphere.toml   # stats.csv: ms_graph beside the other stages"};
    claim.figures.push_back({"overhead", "Time of the graph search over the time of the step.",
                             plot_svg(plot), plot_image(plot), true});
    return claim;
}

}  // namespace

std::vector<Claim> snapshot_claims(const ReproduceScale& scale, const DeviceChoice& device) {
    std::vector<Claim> claims;
    std::vector<std::pair<const Snapshot*, SceneRun>> runs;
    for (const Snapshot& snapshot : snapshots) {
        const std::optional<Scene> scene = paper_scene(
            snapshot.scene, scale, snapshot.explicit_shear ? explicit_shear : std::vector<std::string>{});
        if (!scene) {
            claims.push_back(missing(snapshot));
            continue;
        }
        runs.emplace_back(&snapshot, run_scene(*scene, 1, true));
        claims.push_back(snapshot_claim(snapshot, runs.back().second, device));
    }
    if (runs.empty()) return claims;
    claims.push_back(rvm_claim(runs));
    claims.push_back(overhead_claim(runs));
    return claims;
}

}  // namespace unravel::tool
