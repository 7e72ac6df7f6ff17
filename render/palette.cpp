#include "render/palette.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "render/color.hpp"

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
    int color = none;  ///< the label's, or what most particles of a group without one wore on their own
};

/// Of each group the number that most of its particles carry, of those that `counts`; none where there is
/// none.
template <class Numbers, class Counts>
std::vector<int> majority(const Groups& groups, const Numbers& numbers, Counts&& counts) {
    std::vector<std::array<std::int32_t, 2>> carried;
    for (std::size_t i = 0; i < groups.of.size(); ++i)
        if (groups.of[i] != none && numbers[i] != none && counts(i))
            carried.push_back({groups.of[i], numbers[i]});
    std::vector<int> result(groups.count, none);
    std::vector<std::int32_t> most(groups.count, 0);
    for (const Tally& tallied : tally(std::move(carried)))
        if (tallied.count > most[tallied.first]) {
            most[tallied.first] = tallied.count;
            result[tallied.first] = tallied.second;
        }
    return result;
}

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
    const std::vector<int> worn = majority(
        groups, state.color, [&](std::size_t i) { return state.label[i] == heritage[groups.of[i]].label; });
    const std::vector<int> own = majority(groups, state.own, [](std::size_t) { return true; });
    // What parts is not to look like what it parts from, though that be far away.
    const std::vector<int> last = majority(groups, state.color, [](std::size_t) { return true; });
    for (int g = 0; g < groups.count; ++g)
        heritage[g].color = heritage[g].label != none ? worn[g] : own[g] != last[g] ? own[g] : none;
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

/// OKLab's lightness of each colour. [Ottosson 2020]
std::array<float, component_palette.size()> lightness() {
    std::array<float, component_palette.size()> result{};
    for (std::size_t c = 0; c < result.size(); ++c) {
        const Vec3f light = linear(component_palette[c]);
        result[c] = 0.2105f * std::cbrt(light.dot(Vec3f(0.4122f, 0.5363f, 0.0514f))) +
                    0.7936f * std::cbrt(light.dot(Vec3f(0.2119f, 0.6807f, 0.1074f))) -
                    0.0041f * std::cbrt(light.dot(Vec3f(0.0883f, 0.2817f, 0.6300f)));
    }
    return result;
}

constexpr float like_lightness = 0.1f;  // nearer than that two colours are much alike in a grey copy

}  // namespace

const std::vector<Rgb>& ComponentColors::assign(std::span<const std::int32_t> component,
                                                std::span<const std::array<std::uint32_t, 2>> edges) {
    constexpr int palette = static_cast<int>(component_palette.size());
    static const std::array<float, palette> light = lightness();
    state.label.resize(component.size(), none);
    state.color.resize(component.size(), none);
    state.own.resize(component.size(), none);
    const Groups groups = group(component);
    std::vector<Heritage> heritage = inherit(groups, state);
    const std::vector<Tally> neighbours = borders(groups, edges);

    std::vector<int> color(groups.count, none);
    std::array<int, palette> used{};  // by how many groups so far
    const auto choose = [&](int g) {
        std::array<int, palette> touching{},
            alike{};  // edges to neighbours that wear the colour, or one as light
        const auto [begin, end] = std::ranges::equal_range(neighbours, g, {}, &Tally::first);
        for (auto it = begin; it != end; ++it) {
            const int other = color[it->second];
            if (other == none) continue;
            touching[other] += it->count;
            for (int c = 0; c < palette; ++c)
                if (std::abs(light[c] - light[other]) < like_lightness) alike[c] += it->count;
        }
        int best = 0;
        for (int c = 1; c < palette; ++c)
            if (std::tuple(touching[c], alike[c], used[c]) <
                std::tuple(touching[best], alike[best], used[best]))
                best = c;
        const int own = heritage[g].color;
        color[g] = own != none && touching[own] <= touching[best] ? own : best;
        ++used[color[g]];
    };
    // Who goes on keeps its colour before those choose that part, and newcomers after them; among each,
    // larger ones first.
    const auto rank = [&](int g) {
        return heritage[g].label != none ? 0 : heritage[g].color != none ? 1 : 2;
    };
    for (const int turn : {0, 1, 2})
        for (int g = 0; g < groups.count; ++g)
            if (rank(g) == turn) choose(g);
    std::vector<char> fresh(groups.count, 0);  // under a new name
    for (int g = 0; g < groups.count; ++g)
        if (heritage[g].label == none) {
            heritage[g].label = state.next_label++;
            fresh[g] = 1;
        }

    colors_.resize(component.size());
    for (std::size_t i = 0; i < component.size(); ++i) {
        const std::int32_t g = groups.of[i];
        if (g == none) {
            colors_[i] = component[i] < 0 ? constrained_color : single_color;
            continue;
        }
        state.label[i] = heritage[g].label;
        state.color[i] = static_cast<std::int8_t>(color[g]);
        // Those that have been taken in remember what they wore.
        if (fresh[g] || state.own[i] == none || state.own[i] == heritage[g].color)
            state.own[i] = state.color[i];
        colors_[i] = component_palette[color[g]];
    }
    return colors_;
}

const std::vector<Rgb>& SteadyColors::follow(const std::vector<Rgb>& colors) {
    constexpr int frames = 3;
    if (shown_.size() != colors.size()) {
        shown_ = coming_ = colors;
        held_.assign(colors.size(), 0);
    }
    for (std::size_t i = 0; i < colors.size(); ++i) {
        held_[i] = colors[i] == shown_[i] ? 0 : colors[i] == coming_[i] ? held_[i] + 1 : 1;
        coming_[i] = colors[i];
        if (held_[i] < frames) continue;
        shown_[i] = colors[i];
        held_[i] = 0;
    }
    return shown_;
}

}  // namespace unravel::render
