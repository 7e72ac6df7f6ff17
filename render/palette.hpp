#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// Colours of components. The first seven are Okabe & Ito's (2008, Color Universal Design); the others were
/// found by farthest-point search in OKLab under normal vision and full protan-, deuter- and tritanopia
/// (Machado et al. 2009), away from white, grey and the dark background.
inline constexpr std::array<Rgb, 10> component_palette{{{230, 159, 0},
                                                        {86, 180, 233},
                                                        {0, 158, 115},
                                                        {240, 228, 66},
                                                        {0, 114, 178},
                                                        {213, 94, 0},
                                                        {204, 121, 167},
                                                        {170, 43, 0},
                                                        {170, 213, 170},
                                                        {140, 60, 255}}};
inline constexpr Rgb constrained_color{255, 255, 255};  ///< no direction left to solve for
inline constexpr Rgb single_color{94, 98, 106};         ///< a component of one particle

/// What ComponentColors remembers between frames: plain data.
struct ComponentColorState {
    std::vector<std::int32_t>
        label;  ///< (particles) the component it last belonged to, under a lasting name; −1 none
    std::vector<std::uint8_t> color;  ///< (particles) index into component_palette that it last wore
    std::int32_t next_label = 0;
};

/// Gives components colours that stay as components merge, split, come and go:
/// - of the components that share particles with one of an earlier frame, the one sharing most keeps its
/// colour;
/// - components joined by an edge get different colours, the larger one keeping its own (where a component
/// has more
///   neighbours than there are colours, the colour touching it least is taken);
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

}  // namespace unravel::render
