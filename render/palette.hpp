#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// Colours of components, found by farthest-point search in OKLab under normal vision and full protan-,
/// deuter- and tritanopia (Machado et al. 2009), away from white, grey and the dark background: any two are
/// 0.12 apart for normal vision and protanopes, 0.15 for deuteranopes, 0.09 for tritanopes, most by lightness
/// as well as by hue.
inline constexpr std::array<Rgb, 8> component_palette{{{255, 232, 104},
                                                       {19, 107, 133},
                                                       {226, 107, 235},
                                                       {170, 194, 0},
                                                       {133, 25, 255},
                                                       {249, 175, 204},
                                                       {163, 126, 24},
                                                       {124, 73, 0}}};
inline constexpr Rgb constrained_color{255, 255, 255};  ///< no direction left to solve for
inline constexpr Rgb single_color{128, 132, 140};       ///< a component of one particle

/// What ComponentColors remembers between frames: plain data.
struct ComponentColorState {
    std::vector<std::int32_t>
        label;  ///< (particles) the component it last belonged to, under a lasting name; −1 none
    std::vector<std::int8_t> color;  ///< (particles) index into component_palette that it last wore; −1 none
    std::vector<std::int8_t> own;    ///< (particles) what it wore before its component was taken into another
    std::int32_t next_label = 0;
};

/// Gives components colours that stay as components merge, split, come and go:
/// - of the components that share particles with one of an earlier frame, the one sharing most keeps its
/// colour;
/// - one that parts from another wears what most of its particles wore before they were taken into that one;
/// - components joined by an edge get different colours, the larger one keeping its own (where a component
/// has more neighbours than there are colours, the colour touching it least is taken), and new ones are
/// lighter or darker than their neighbours where they can be;
/// - components of one particle share a calm grey, so that hundreds of them may come and go without a
/// flicker, and
///   particles remember their colour while they are alone or held;
/// - fully constrained particles are white.
/// Depends on the particles' grouping alone, not on how components are numbered. Replaying the frames from
/// the first gives the same colours again. O((n + e) log(n + e)).
class ComponentColors {
public:
    /// `component` (particles): id ≥ 0, or −1 = fully constrained. `edges`: pairs of particles. The result
    /// holds until the next call.
    const std::vector<Rgb>& assign(std::span<const std::int32_t> component,
                                   std::span<const std::array<std::uint32_t, 2>> edges);

    ComponentColorState state;

private:
    std::vector<Rgb> colors_;
};

/// Colours of a moving picture: what a particle wears changes once the new colour has held for three frames
/// in a row, so that what sticks and slips, or parts and meets, from one frame to the next does not flicker.
/// A change that stays is seen two frames late.
class SteadyColors {
public:
    /// `colors` (particles) of the next frame; the first is shown as it is. The result holds until the next
    /// call.
    const std::vector<Rgb>& follow(const std::vector<Rgb>& colors);

private:
    std::vector<Rgb> shown_, coming_;
    std::vector<std::uint8_t> held_;  // (particles) frames that the coming colour has been there
};

}  // namespace unravel::render
