#include "tool/run/draft.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/mesh/placement.hpp"

namespace unravel::tool {

namespace {

// A sheet of fewer shows nothing of how it falls.
constexpr int fewest_along = 4, fewest_around = 8;

// A place on a grid of `from` particles as one on a grid of `to`.
int moved_index(int index, int from, int to) {
    return from > 1 ? static_cast<int>(std::lround(static_cast<double>(index) * (to - 1) / (from - 1))) : 0;
}

// The particle nearest to the middle of what the pin is to hold.
std::array<int, 4> nearest_to(const Cloth& cloth, const Pin& pin) {
    const Vec2 uv =
        pin.target == PinTarget::disc ? pin.disc.center : Vec2(0.5 * (pin.box.low + pin.box.high));
    const bool tube = cloth.wrap == Wrap::tube;
    const int around = cloth.particles[0];
    const int i = static_cast<int>(std::lround(uv.x() * (tube ? around : around - 1))) % around;
    const int j = static_cast<int>(std::lround(uv.y() * (cloth.particles[1] - 1)));
    return {i, i, j, j};
}

void coarsen(Cloth& cloth, double share) {
    const std::array<int, 2> before = cloth.particles;
    for (std::size_t d = 0; d < 2; ++d) {
        const bool around = d == 0 && cloth.wrap == Wrap::tube;
        const double cells = share * (around ? before[d] : before[d] - 1);
        const int wanted = static_cast<int>(std::lround(cells)) + (around ? 0 : 1);
        cloth.particles[d] = std::min(before[d], std::max(wanted, around ? fewest_around : fewest_along));
    }
    for (Pin& pin : cloth.pins) {
        if (pin.target == PinTarget::particles) {
            for (std::size_t k = 0; k < 4; ++k)
                pin.range[k] = moved_index(pin.range[k], before[k / 2], cloth.particles[k / 2]);
        } else if (pinned_particles(cloth, pin).empty()) {
            pin.range = nearest_to(cloth, pin);
            pin.target = PinTarget::particles;
        }
    }
}

}  // namespace

Scene draft_of(Scene scene, int particles) {
    double grids = 0, meshes = 0;
    for (const Cloth& cloth : scene.cloths)
        (cloth.geometry ? meshes : grids) += static_cast<double>(cloth.particles[0]) * cloth.particles[1];
    const double share = std::sqrt(std::max(particles - meshes, 1.0) / std::max(grids, 1.0));
    for (Cloth& cloth : scene.cloths) {
        if (!cloth.geometry && share < 1) coarsen(cloth, share);
    }
    const double per_frame = std::max(1.0, std::ceil(draft_steps * scene.clip.fps.time_of(1)));
    scene.solver.step = std::max(scene.solver.step, 1 / (scene.clip.fps.per_second() * per_frame));
    // As many as the coarser grid and the longer step need.
    if (scene.solver.integrator == Integrator::explicit_) scene.solver.substeps = 0;
    return scene;
}

}  // namespace unravel::tool
