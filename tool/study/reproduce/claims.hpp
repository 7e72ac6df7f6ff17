#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/gl_context.hpp"
#include "tool/base/names.hpp"
#include "tool/inspect/figures.hpp"
#include "tool/study/reproduce/runs.hpp"

namespace unravel::tool {

/// One figure or claim of the paper, and what came out here. Every number in `ours`, `why` and `numbers` is
/// measured while the report is made.
struct Claim {
    std::string heading;
    std::string paper;  ///< what the paper shows or says
    std::string ours;
    std::string why;                    ///< where ours differs; empty: it does not
    std::vector<std::string> commands;  ///< that make it again
    std::vector<std::pair<std::string, Image>> views;
    std::vector<Figure> figures;
    nlohmann::ordered_json numbers = nlohmann::ordered_json::object();
};

/// The scenes of Figs 1, 7 and 8 simulated once, decomposed and whole: their snapshots, the RVMs saved and
/// the overhead of the graph search.
std::vector<Claim> snapshot_claims(const ReproduceScale& scale, const DeviceChoice& device);

/// Figs 3–5: the matrix of a cloth of 300 particles.
Claim sparsity_claim(const ReproduceScale& scale);

/// Sec. 6.1: time of adaptive IMEX against the semi-implicit scheme.
Claim imex_claim(const ReproduceScale& scale);

/// Fig. 9 and Sec. 6.2: CG iterations with three preconditioners against the number of particles.
Claim preconditioner_claim(const ReproduceScale& scale);

/// Sec. 7: time of the decomposing solver against the whole one, on one thread and on two.
Claim thread_claim(const ReproduceScale& scale);

}  // namespace unravel::tool
