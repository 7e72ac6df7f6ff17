#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// What is expected of a hard case.
enum class Must {
    survive,  ///< runs to its end within its bounds
    refuse,   ///< is never started: the scene or its step is refused with the cause named
    stop,     ///< is stopped while it runs, with the cause named
};

/// One line of scenes/hard/cases.toml: a scene, what is changed in it, and what is to happen.
struct HardCase {
    std::string name;
    std::string what;  ///< in a few words, for people
    std::filesystem::path scene;
    std::vector<std::string> set;  ///< as --set takes them
    Must must = Must::survive;
    std::string says;        ///< refuse, stop: part of the message
    double strain = 0.1;     ///< survive: bound on the largest strain of a stretch spring
    double energy = 1e-9;    ///< survive: how far energy may rise above what it was, over the energy there is
    bool swing = false;      ///< energy may swing as forward-backward Euler's does
    bool fed = false;        ///< the scene puts energy in while it runs: its rise is not judged
    double rest = 0;         ///< m/s, what the fastest particle may do at the end; 0: need not rest
    double penetration = 0;  ///< m, how deep a particle may be inside a solid (not its skin)
    double flicker = 1;      ///< share of springs that may turn between explicit and implicit in a step
    double chatter = 1;      ///< share of contacts that friction may catch or let go in a step, at the end
    double jitter = 1;       ///< share of contacts that may open or close in a step, at the end
    int frames = 0;          ///< of the shortened run in the test suite; 0: all
    bool allow_unstable = false;  ///< run it although its explicit springs are beyond their limit
};

/// All cases of a file, in its order. Throws InputError, SceneError-like text where the file is wrong.
std::vector<HardCase> read_hard_cases(const std::filesystem::path& file);

/// How a case went.
struct HardOutcome {
    enum class Kind { survived, refused, stopped } kind = Kind::survived;
    std::string says;                   ///< refused, stopped: the message
    std::vector<std::string> failures;  ///< what was promised and not kept; empty: as it must be
    std::size_t particles = 0;
    std::uint64_t steps = 0;
    double max_strain = 0;    ///< over the run
    double energy_rise = 0;   ///< greatest rise above the least energy before, over the energy there is
    std::uint64_t again = 0;  ///< steps taken more than once: solved to their end, or halved
    double flicker = 0;       ///< springs between explicit and implicit, largest share of a step
    double chatter = 0, jitter = 0;  ///< of the contacts, mean share per step over the last quarter
    double penetration = 0;          ///< m, deepest particle inside a solid
    double pin_error = 0;            ///< m, farthest pinned particle from where its motion has it
    double final_speed = 0;          ///< m/s, fastest free particle at the end
    std::uint32_t cg_most = 0;       ///< iterations of the component that took most
    std::uint64_t unconverged = 0;   ///< steps
    std::uint64_t hash = 0;          ///< of the last state
    bool same_bits = true;           ///< one thread and two threads agree after every frame
    double seconds = 0;
    std::optional<Scene> scene;  ///< as run, for its picture
    FrameRecord last;            ///< where it ended
};

/// Runs a case with one thread and with two, and judges it. `frames` > 0 ends it early; what only its end
/// tells is then not judged.
HardOutcome run_hard_case(const HardCase& hard, int frames = 0);

}  // namespace unravel::tool
