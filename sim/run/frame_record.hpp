#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "sim/forces/extension.hpp"
#include "sim/linear/solve.hpp"
#include "sim/model/report.hpp"
#include "sim/model/state.hpp"

namespace unravel::sim {

/// What the simulation leaves of a frame: the state from which it goes on, and what the last step before it
/// was, for those who draw or inspect it.
struct FrameRecord {
    int frame = 0;  ///< due at exactly frame/fps
    ClothState state;
    std::vector<std::int32_t> component;  ///< (particles) of the last step; −1: fully constrained
    std::vector<std::uint8_t> free;       ///< (particles) free directions, 0–3
    std::vector<SpringState> springs;     ///< (stretch and shear springs) of the last step
    std::vector<ComponentSolve> solves;   ///< (components) of the last step; empty for frame 0
    std::vector<StepReport> reports;      ///< one per step since the frame before; empty for frame 0
};

/// What every record begins with; the last byte is the format's version.
inline constexpr std::string_view record_magic = "UNRAVEL\x07";

/// Hash of positions and velocities, by which runs are compared bit for bit (64-bit FNV-1a over their bytes).
std::uint64_t state_hash(const ClothState& state);

/// Writes a record, whole or not at all. Stage times are left out: the same run leaves the same bytes. The
/// scene's hash ties the file to its run. Throws OutputError.
void write_record(const std::filesystem::path& file, std::uint64_t scene_hash, const FrameRecord& record);

/// Reads a record of `particles` particles and `springs` springs written for the same scene. Throws
/// InputError if it is damaged, of another scene, or does not fit.
FrameRecord read_record(const std::filesystem::path& file, std::uint64_t scene_hash, std::size_t particles,
                        std::size_t springs);

/// The same from a record's bytes; `file` stands for them in messages.
FrameRecord parse_record(std::span<const std::uint8_t> bytes, const std::filesystem::path& file,
                         std::uint64_t scene_hash, std::size_t particles, std::size_t springs);

}  // namespace unravel::sim
