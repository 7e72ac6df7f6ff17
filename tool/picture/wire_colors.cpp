#include "tool/picture/wire_colors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/palette.hpp"

namespace unravel::tool {

namespace {

constexpr std::uint8_t faint = 110, solid = 255;

Rgb mix(Rgb a, Rgb b, double t) {
    const auto channel = [t](std::uint8_t x, std::uint8_t y) {
        return static_cast<std::uint8_t>(std::lround(x + t * (y - x)));
    };
    return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

Rgb treatment_color(SpringState state) {
    switch (state) {
        case SpringState::implicit:
            return implicit_color;
        case SpringState::explicit_:
            return explicit_color;
        case SpringState::inactive:
            return inactive_color;
    }
    return inactive_color;
}

double strain_of(const ClothModel& model, const ClothState& state, std::size_t s) {
    const ExtensionSprings& springs = model.springs;
    return (state.x[springs.j[s]] - state.x[springs.i[s]]).norm() / springs.rest[s] - 1;
}

// Wires by value of their own; particles, and the surface with them, by the mean of their wires.
void color_strain(const Look& look, const ClothModel& model, const ClothState& state, DrawFrame& out) {
    const std::size_t count = out.edge_strength.size();
    const double end = scale_end(look);
    std::vector<double> sum(model.size(), 0);
    std::vector<int> springs(model.size(), 0);
    out.edge_colors.resize(count);
    for (std::size_t s = 0; s < count; ++s) {
        const double share = strain_of(model, state, s) / end;
        out.edge_colors[s] = share < 0 ? inactive_color : scale_color(share);
        out.edge_strength[s] = share < 0 ? faint : solid;
        for (const std::uint32_t p : {model.springs.i[s], model.springs.j[s]}) {
            sum[p] += std::clamp(share, 0.0, 1.0);
            ++springs[p];
        }
    }
    for (std::size_t p = 0; p < sum.size(); ++p)
        out.particle_colors[p] = scale_color(sum[p] / std::max(springs[p], 1));
}

}  // namespace

Rgb scale_color(double t) {
    static constexpr std::array<Rgb, 8> stops{{{71, 62, 133},
                                               {54, 92, 141},
                                               {39, 127, 142},
                                               {31, 161, 135},
                                               {74, 193, 109},
                                               {122, 209, 81},
                                               {188, 222, 44},
                                               {253, 231, 37}}};
    const double at = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    return mix(stops[k], stops[k + 1], at - static_cast<double>(k));
}

double scale_end(const Look& look) {
    if (look.show_max > 0) return look.show_max;
    return look.show == Show::velocity ? 3 : 0.05;
}

void ScaleFinder::add(Show show, const ClothModel& model, const ClothState& state) {
    const auto note = [&](double value) {
        if (!(value > 1e-9)) return;
        const int at = static_cast<int>(steps * (std::log10(value) + 9));
        ++count_[static_cast<std::size_t>(std::clamp(at, 0, decades * steps - 1))];
    };
    if (show == Show::strain)
        for (std::size_t s = 0; s < model.springs.stretch_count; ++s) note(strain_of(model, state, s));
    else
        for (const Vec3& v : state.v) note(v.norm());
}

double ScaleFinder::end() const {
    const std::uint64_t all = std::accumulate(count_.begin(), count_.end(), std::uint64_t{0});
    if (all == 0) return 0;
    std::uint64_t below = 0;
    std::size_t at = 0;
    while (100 * (below += count_[at]) < 99 * all) ++at;
    const double value = std::pow(10.0, static_cast<double>(at + 1) / steps - 9);
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    // What falls on a round number by rounding is that number.
    for (const double times : {1.0, 2.0, 5.0})
        if (value <= 1.03 * times * power) return times * power;
    return 10 * power;
}

std::size_t drawn_springs(const ClothModel& model, Show show) {
    return show == Show::splitting ? model.springs.size() : model.springs.stretch_count;
}

void color_wires(const Look& look, const ClothModel& model, const FrameRecord& record,
                 const std::vector<Rgb>& components, DrawFrame& out) {
    out.edge_strength.assign(drawn_springs(model, look.show), solid);
    out.edge_colors.clear();
    out.particle_colors = components;
    switch (look.show) {
        case Show::components:
            for (std::size_t s = 0; s < out.edge_strength.size(); ++s)
                if (record.springs[s] != SpringState::implicit) out.edge_strength[s] = faint;
            break;
        case Show::splitting:
            for (std::size_t p = 0; p < model.size(); ++p)
                out.particle_colors[p] = record.free[p] == 0 ? constrained_color : single_color;
            for (std::size_t s = 0; s < out.edge_strength.size(); ++s) {
                out.edge_colors.push_back(treatment_color(record.springs[s]));
                if (record.springs[s] == SpringState::inactive) out.edge_strength[s] = faint;
            }
            break;
        case Show::strain:
            color_strain(look, model, record.state, out);
            break;
        case Show::velocity:
            for (std::size_t p = 0; p < model.size(); ++p)
                out.particle_colors[p] = scale_color(record.state.v[p].norm() / scale_end(look));
            break;
        case Show::contact:
            for (std::size_t p = 0; p < model.size(); ++p)
                out.particle_colors[p] = record.free[p] == 0   ? constrained_color
                                         : record.free[p] == 3 ? free_color
                                                               : partly_color;
            break;
    }
}

}  // namespace unravel::tool
