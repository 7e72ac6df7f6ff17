#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/draw_scene.hpp"
#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// Colours that stand for one thing each, apart for the colour-blind (Okabe & Ito 2008).
inline constexpr Rgb implicit_color{230, 159, 0}, explicit_color{86, 180, 233}, inactive_color{104, 108, 118};
inline constexpr Rgb free_color{86, 180, 233}, partly_color{230, 159, 0};

/// Colour at t in [0, 1] of a scale that grows lighter all the way (after viridis, less its darkest part).
Rgb scale_color(double t);

/// Where the scale of a scene's look ends: strain (1) or velocity [m/s].
double scale_end(const Look& look);

/// Finds where a scale has to end for a clip: above 99 of a hundred of its values, of all springs that are
/// taut, or of all particles, in every frame.
class ScaleFinder {
public:
    void add(Show show, const ClothModel& model, const ClothState& state);
    /// 1, 2 or 5 times a power of ten; 0: nothing was seen that has a value.
    double end() const;

private:
    static constexpr int decades = 12, steps = 100;  // from 1e-9 on, each decade in equal ratios
    std::array<std::uint64_t, decades * steps> count_{};
};

/// Springs drawn in the component view, as particle pairs: stretch, and where the splitting is shown shear
/// too. They are the model's first so many springs.
std::size_t drawn_springs(const ClothModel& model, Show show);

/// Colours and strengths of particles and wires. `components` (particles): their colours by component.
///   components  by component; explicit and slack springs faint
///   splitting   springs by treatment
///   strain      springs by (l − L)/L, slack ones faint; particles by the mean of their springs
///   velocity    particles by speed
///   contact     particles by free directions: three, one or two, none (white)
void color_wires(const Look& look, const ClothModel& model, const FrameRecord& record,
                 const std::vector<Rgb>& components, DrawFrame& out);

}  // namespace unravel::tool
