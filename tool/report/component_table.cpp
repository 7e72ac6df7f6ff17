#include "tool/report/component_table.hpp"

#include <algorithm>
#include <utility>

namespace unravel::tool {

std::vector<ComponentRow> component_table(const ClothModel& model, std::span<const std::int32_t> component,
                                          std::span<const SpringState> springs,
                                          std::span<const ComponentSolve> solves,
                                          std::span<const Rgb> colors) {
    std::vector<ComponentRow> rows;
    for (std::size_t p = 0; p < component.size(); ++p) {
        if (component[p] < 0) continue;
        const auto c = static_cast<std::size_t>(component[p]);
        // Ids follow the smallest particle, so the first particle of a component meets them in order.
        if (c >= rows.size()) {
            rows.resize(c + 1);
            rows[c].id = component[p];
            rows[c].color = colors[p];
            if (c < solves.size()) rows[c].solve = solves[c];
        }
        ++rows[c].particles;
    }
    // Pairs of a component and a held particle beside it, each to be counted once.
    std::vector<std::pair<std::int32_t, std::uint32_t>> touching;
    for (std::size_t s = 0; s < springs.size(); ++s) {
        if (springs[s] != SpringState::implicit) continue;
        const std::uint32_t i = model.springs.i[s], j = model.springs.j[s];
        const std::int32_t a = component[i], b = component[j];
        if (a < 0 && b < 0) continue;
        ++rows[static_cast<std::size_t>(std::max(a, b))].springs;
        if (a < 0) touching.emplace_back(b, i);
        if (b < 0) touching.emplace_back(a, j);
    }
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
    for (const auto& [c, particle] : touching) ++rows[static_cast<std::size_t>(c)].boundary;
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.particles > b.particles; });
    return rows;
}

}  // namespace unravel::tool
