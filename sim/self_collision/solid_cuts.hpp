#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/model/contact_model.hpp"
#include "sim/solids/motion.hpp"

namespace unravel::sim {

/// What is less deep in a solid touches it [m].
inline constexpr double touching_depth = 1e-6;

/// The cloth in the frame of one solid of a closed form. All of those are convex: a distance to one is
/// nowhere less than the tangent planes at particles say, so that nearly all edges and faces are passed over
/// at once.
class CutView {
public:
    /// longest   of all edges at x [m]
    CutView(const Solid& solid, const Pose& to_local, std::span<const Vec3> x, double longest);

    /// Whether an edge passes through: it enters and leaves where the surface looks another way, or goes
    /// deeper than the solid's skin.
    bool cuts(const std::array<std::uint32_t, 2>& edge) const;
    /// How deep a face goes into the solid [m]; 0: it does not.
    double depth(const std::array<std::uint32_t, 3>& face) const;

private:
    template <std::size_t N>
    double bound(const std::array<std::uint32_t, N>& corners) const;

    const Solid& solid_;
    std::vector<Vec3> local_, slope_;  // (particles) where it is; the distance's gradient there, where known
    std::vector<double> distance_;     // (particles) m; unless known, a lower bound
    std::vector<std::uint8_t> known_;
};

double longest_edge(const Surface& surface, std::span<const Vec3> x);

/// Edges of the cloth that pass through solids that hold off surfaces (Solid::contact), at time t.
std::uint64_t count_cuts(const ClothModel& model, double t, std::span<const Vec3> x);

/// Of particles that moved straight from x at time t to `next` at t_next, how many such solids have
struct Ways {
    std::uint64_t through = 0;  ///< gone through, from one side to another
    std::uint64_t turned = 0;   ///< turned under: they went round an edge
};
Ways judge_ways(const ClothModel& model, double t, std::span<const Vec3> x, double t_next,
                std::span<const Vec3> next);

}  // namespace unravel::sim
