#include "render/palette.hpp"

#include <algorithm>
#include <numeric>

namespace unravel::render {

namespace {

constexpr int none = -1;

/// Components of two particles or more, numbered by size, largest first; equals by their smallest particle.
struct Groups {
    std::vector<std::int32_t> of;  ///< (particles) group; none where constrained or alone
    int count = 0;
};

Groups group(std::span<const std::int32_t> component) {
    struct Component {
        std::int32_t size = 0, smallest = 0;
    };
    const std::int32_t ids = component.empty() ? 0 : 1 + std::max(none, *std::ranges::max_element(component));
    std::vector<Component> all(ids);
    for (std::size_t i = component.size(); i-- > 0;)
        if (component[i] >= 0) {
            ++all[component[i]].size;
            all[component[i]].smallest = static_cast<std::int32_t>(i);
        }
    std::vector<std::int32_t> order;
    for (std::int32_t id = 0; id < ids; ++id)
        if (all[id].size > 1) order.push_back(id);
    std::ranges::sort(order, [&](std::int32_t a, std::int32_t b) {
        return all[a].size != all[b].size ? all[a].size > all[b].size : all[a].smallest < all[b].smallest;
    });
    std::vector<std::int32_t> rank(ids, none);
    for (std::size_t r = 0; r < order.size(); ++r) rank[order[r]] = static_cast<std::int32_t>(r);

    Groups groups{.of = std::vector<std::int32_t>(component.size(), none),
                  .count = static_cast<int>(order.size())};
    for (std::size_t i = 0; i < component.size(); ++i)
        if (component[i] >= 0) groups.of[i] = rank[component[i]];
    return groups;
}

/// A pair of numbers and how often it occurs.
struct Tally {
    std::int32_t first, second, count;
};

/// Counts equal pairs; sorted by pair.
std::vector<Tally> tally(std::vector<std::array<std::int32_t, 2>> pairs) {
    std::ranges::sort(pairs);
    std::vector<Tally> result;
    for (const auto& [first, second] : pairs)
        if (!result.empty() && result.back().first == first && result.back().second == second)
            ++result.back().count;
        else
            result.push_back({first, second, 1});
    return result;
}

/// What a group inherits from earlier frames.
struct Heritage {
    std::int32_t label = none;
    int color = none;
};

/// Largest overlaps first, each label goes to one group and each group takes one label.
std::vector<Heritage> inherit(const Groups& groups, const ComponentColorState& state) {
    std::vector<std::array<std::int32_t, 2>> pairs;
    for (std::size_t i = 0; i < groups.of.size(); ++i)
        if (groups.of[i] != none && state.label[i] != none) pairs.push_back({groups.of[i], state.label[i]});
    std::vector<Tally> overlaps = tally(std::move(pairs));
    std::ranges::stable_sort(overlaps, [](const Tally& a, const Tally& b) { return a.count > b.count; });

    std::vector<Heritage> heritage(groups.count);
    std::vector<char> given(state.next_label, 0);
    for (const Tally& overlap : overlaps)
        if (heritage[overlap.first].label == none && !given[overlap.second]) {
            heritage[overlap.first].label = overlap.second;
            given[overlap.second] = 1;
        }
    // A label's particles agree on its colour unless some were away when it changed: most of the group's
    // decide.
    std::vector<std::array<std::int32_t, 2>> worn;
    for (std::size_t i = 0; i < groups.of.size(); ++i) {
        const std::int32_t g = groups.of[i];
        if (g != none && heritage[g].label != none && state.label[i] == heritage[g].label)
            worn.push_back({g, state.color[i]});
    }
    std::vector<std::int32_t> most(groups.count, 0);
    for (const Tally& color : tally(std::move(worn)))
        if (color.count > most[color.first]) {
            most[color.first] = color.count;
            heritage[color.first].color = color.second;
        }
    return heritage;
}

/// Number of edges between each pair of groups, both ways round, sorted by the first.
std::vector<Tally> borders(const Groups& groups, std::span<const std::array<std::uint32_t, 2>> edges) {
    std::vector<std::array<std::int32_t, 2>> pairs;
    for (const auto& [a, b] : edges) {
        const std::int32_t g = groups.of[a], h = groups.of[b];
        if (g == none || h == none || g == h) continue;
        pairs.push_back({g, h});
        pairs.push_back({h, g});
    }
    return tally(std::move(pairs));
}

}  // namespace

const std::vector<Rgb>& ComponentColors::assign(std::span<const std::int32_t> component,
                                                std::span<const std::array<std::uint32_t, 2>> edges) {
    constexpr int palette = static_cast<int>(component_palette.size());
    state.label.resize(component.size(), none);
    state.color.resize(component.size(), 0);
    const Groups groups = group(component);
    std::vector<Heritage> heritage = inherit(groups, state);
    const std::vector<Tally> neighbours = borders(groups, edges);

    std::vector<int> color(groups.count, none);
    std::array<int, palette> used{};  // by how many groups so far
    const auto choose = [&](int g) {
        std::array<int, palette> touching{};  // edges to neighbours that wear the colour
        const auto [begin, end] = std::ranges::equal_range(neighbours, g, {}, &Tally::first);
        for (auto it = begin; it != end; ++it)
            if (color[it->second] != none) touching[color[it->second]] += it->count;
        int best = 0;
        for (int c = 1; c < palette; ++c)
            if (touching[c] != touching[best] ? touching[c] < touching[best] : used[c] < used[best]) best = c;
        const int own = heritage[g].color;
        color[g] = own != none && touching[own] <= touching[best] ? own : best;
        ++used[color[g]];
    };
    // Who has a colour keeps it before newcomers choose; among each, larger ones first.
    for (int g = 0; g < groups.count; ++g)
        if (heritage[g].color != none) choose(g);
    for (int g = 0; g < groups.count; ++g)
        if (heritage[g].color == none) choose(g);
    for (Heritage& h : heritage)
        if (h.label == none) h.label = state.next_label++;

    colors_.resize(component.size());
    for (std::size_t i = 0; i < component.size(); ++i) {
        const std::int32_t g = groups.of[i];
        if (g == none) {
            colors_[i] = component[i] < 0 ? constrained_color : single_color;
            continue;
        }
        state.label[i] = heritage[g].label;
        state.color[i] = static_cast<std::uint8_t>(color[g]);
        colors_[i] = component_palette[color[g]];
    }
    return colors_;
}

}  // namespace unravel::render
