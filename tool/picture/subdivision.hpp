#pragma once

#include <span>
#include <vector>

#include "render/draw_scene.hpp"
#include "sim/model/model.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// Times that each cell of a cloth is drawn as four: what the look says, or enough for smooth outlines and
/// light.
int display_level(const Look& look, const ClothPatch& patch);

/// A cloth's grid drawn finer than it is simulated: each cell as 2^level × 2^level, by bicubic Catmull–Rom
/// interpolation, which passes through the particles and has one tangent plane everywhere.
struct FineGrid {
    explicit FineGrid(const ClothPatch& patch, int level);

    int columns() const { return columns_; }  ///< of points; a tube's seam once
    int rows() const { return rows_; }
    std::size_t size() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }

    /// Points of the fine grid, i + j·columns(). `particles` (all) [m]; `out` (size()).
    void points(std::span<const Vec3f> particles, std::span<Vec3f> out);
    /// Colours of the nearest particle.
    void colors(std::span<const Rgb> particles, std::span<Rgb> out) const;

private:
    const ClothPatch* patch_;
    int factor_, columns_, rows_;
    std::vector<Vec3f> rows_refined_;  // (particles[1] × columns_): fine along u, coarse along v
};

}  // namespace unravel::tool
