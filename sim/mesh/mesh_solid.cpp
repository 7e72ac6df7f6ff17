#include "sim/mesh/mesh_solid.hpp"

#include <algorithm>
#include <cmath>

namespace unravel::sim {

void MeshSolid::positions_at(double t, std::vector<Vec3>& out) const {
    if (!deforms()) {
        out = rest;
        return;
    }
    const double last = static_cast<double>(samples.size() - 1);
    const double at = std::clamp((t - start) * fps, 0.0, last);
    const auto before = static_cast<std::size_t>(std::min(std::floor(at), std::max(last - 1, 0.0)));
    const std::vector<Vec3>&a = samples[before], &b = samples[std::min(before + 1, samples.size() - 1)];
    const double share = at - static_cast<double>(before);
    out.resize(a.size());
    for (std::size_t v = 0; v < a.size(); ++v) out[v] = a[v] + share * (b[v] - a[v]);
}

}  // namespace unravel::sim
