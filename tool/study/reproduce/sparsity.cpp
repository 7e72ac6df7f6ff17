// Figs 3–5: what the matrix looks like, and how reordering it shows its parts.

#include <fmt/format.h>

#include "tool/study/reproduce/claims.hpp"

namespace unravel::tool {

Claim sparsity_claim(const ReproduceScale&) {  // 300 particles are quick enough
    Claim claim;
    claim.heading = "Figs 3, 4, 5: sparsity of A, 300 × 300 blocks";
    claim.paper =
        "The implicit scheme couples every spring (Fig. 3); adaptive IMEX leaves fewer blocks (Fig. 4); "
        "reordered, the matrix falls into two large blocks and small ones (Fig. 5).";
    const std::string grid = "cloth.particles=[15,20]";
    const std::optional<Scene> scene =
        paper_scene("drape_sphere", {.quick = false}, {grid, "clip.duration=1.5"});
    if (!scene) {
        claim.ours = "MISSING: there is no scenes/drape_sphere.toml beside the tool.";
        claim.numbers["missing"] = true;
        return claim;
    }
    const SceneRun run = run_scene(*scene, 1, false);
    const int frame = two_blocks_frame(run);
    const FrameRecord& record = run.records[static_cast<std::size_t>(frame)];
    const Pattern implicit = implicit_pattern(run.model);
    const Pattern assembled = step_pattern(run.model, record.springs, {});
    const Pattern reordered = reordered_pattern(assembled, components_of(record));
    const StepReport& last = record.reports.back();
    claim.ours = fmt::format(
        "nz = {} blocks for the implicit scheme, {} in this step (frame {} of drape_sphere on a "
        "15 × 20 grid), {} after the couplings to the {} fully constrained particles have gone "
        "to the right-hand side: {} components, the largest of {} rows.",
        implicit.entries.size(), assembled.entries.size(), frame, reordered.entries.size(), last.constrained,
        last.components, last.largest);
    claim.commands = {fmt::format("./run scenes/drape_sphere.toml --set '{}' -o output/fig3", grid),
                      fmt::format("./run inspect output/fig3 --frame {}", frame)};
    const char* const names[] = {"fig3", "fig4", "fig5"};
    const Pattern* const patterns[] = {&implicit, &assembled, &reordered};
    for (int k = 0; k < 3; ++k) {
        claim.figures.push_back({names[k], fmt::format("As the paper's Fig. {}.", k + 3),
                                 pattern_svg(*patterns[k]), pattern_image(*patterns[k]), true});
    }
    claim.numbers = {{"nz_implicit", implicit.entries.size()},
                     {"nz_step", assembled.entries.size()},
                     {"nz_reordered", reordered.entries.size()},
                     {"components", last.components},
                     {"frame", frame}};
    return claim;
}

}  // namespace unravel::tool
