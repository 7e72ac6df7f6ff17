#include "sim/model/particle_name.hpp"

#include <fmt/format.h>

namespace unravel::sim {

std::string particle_name(const ClothModel& model, std::uint32_t p) {
    std::size_t c = 0;
    while (p >= model.cloths[c].first + model.cloths[c].count()) ++c;
    const ClothPatch& patch = model.cloths[c];
    if (!patch.grid())
        return fmt::format("particle {} (vertex {}{})", p, p - patch.first + 1,
                           model.cloths.size() > 1 ? " of cloth " + std::to_string(c) : std::string());
    const auto nu = static_cast<std::uint32_t>(patch.particles[0]);
    const std::string where =
        fmt::format("particle {} (u {}, v {}", p, (p - patch.first) % nu, (p - patch.first) / nu);
    return where + (model.cloths.size() > 1 ? fmt::format(" of cloth {})", c) : std::string(")"));
}

}  // namespace unravel::sim
