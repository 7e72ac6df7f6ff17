#include "sim/scene/presets.hpp"

#include <algorithm>
#include <array>

namespace unravel {

namespace {

// Kawabata's system (KES-F; S. Kawabata, The Standardization and Analysis of Hand Evaluation, 1980) gives
//   bending rigidity B  [gf·cm²/cm]   1 unit = 9.81e-5 N·m
//   shear rigidity G    [gf/(cm·deg)] 1 unit = 56.2 N/m per radian
//   extension EMT [%] at 490 N/m with linearity LT: the curve starts flatter than its secant, and what a
//   hanging or draped cloth sees is its start; stretch here is about LT/4 of the secant 490 N/m / EMT.
// The denim is the mean of the samples of "Regenerated Cellulose-Based Denim Fabric for Tropical Regions",
// Journal of Textiles 2016 (B 0.17, G 2.0, EMT 5.2, LT 0.70). Cotton, silk and wool are round values within
// the usual ranges of shirting, habutai and suiting in such tables (B 0.05, 0.02, 0.1; G 1.0, 0.3, 0.6); the
// curves of Wang, O'Brien & Ramamoorthi (Data-Driven Elastic Models for Cloth, 2011) lie in the same range.
// KES has no rate of damping: stretch and shear get a relaxation time (damping over stiffness) of 20 µs,
// small enough to leave the swing of a cloth alone.
constexpr double relaxation = 2e-5;  // s

Material woven(std::string_view name, double weft, double warp, double shear, double bend) {
    Material material;
    material.preset = name;
    material.stretch = {weft, warp};
    material.stretch_damping = {relaxation * weft, relaxation * warp};
    material.shear = shear;
    material.shear_damping = relaxation * shear;
    material.bend = bend;
    return material;
}

const std::array<MaterialPreset, 5> presets{{
    {"cotton", 0.15, woven("cotton", 1200, 1600, 55, 5e-6)},
    {"silk", 0.08, woven("silk", 1000, 1400, 17, 2e-6)},
    {"denim", 0.4, woven("denim", 1600, 2400, 110, 1.7e-5)},
    {"wool", 0.25, woven("wool", 900, 1200, 34, 1e-5)},
    // A latex sheet of 0.5 mm: E = 1 MPa, Poisson's ratio 1/2, 920 kg/m³; stretch E t, shear E t / 3,
    // bend E t³ / (12 (1 − 1/4)).
    {"rubber", 0.46, woven("rubber", 500, 500, 167, 1.4e-5)},
}};

constexpr std::string_view names[] = {"cotton", "silk", "denim", "wool", "rubber"};

}  // namespace

std::span<const MaterialPreset> material_presets() {
    return presets;
}

std::span<const std::string_view> preset_names() {
    return names;
}

const MaterialPreset* find_preset(std::string_view name) {
    const auto found = std::find_if(presets.begin(), presets.end(),
                                    [&](const MaterialPreset& preset) { return preset.name == name; });
    return found == presets.end() ? nullptr : &*found;
}

}  // namespace unravel
