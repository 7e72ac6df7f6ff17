#include "sim/scene_file/presets.hpp"

#include <algorithm>
#include <array>

namespace unravel::sim {

namespace {

// Measured fabrics, and how they come to this model's numbers.
//
// Wang, O'Brien & Ramamoorthi, "Data-Driven Elastic Models for Cloth: Modeling and Measurement" (2011),
// publish c11, c12, c22, c33 [N/m] and hinge stiffnesses k [N·m] of ten fabrics. Their energy per area is, as
// their simulator ARCSim applies it, c11 G_u² + c22 G_v² + c33 G_uv² of the Green strain G:
//   stretch = 2 c11, 2 c22 (of the unstrained cloth);  shear = c33 / 2, because γ = 2 G_uv;
// a hinge has the energy k l²/(|N1| + |N2|) θ²/4 (Bridson et al. 2003), which on a right-angled grid is
// that of a plate of
//   bend = k / 4 (mean of both thread directions at the smallest curvature).
// The denim's 2.0e-5 N·m agrees with denims on Kawabata's tester (B 0.17 gf·cm²/cm, "Regenerated
// Cellulose-Based Denim Fabric for Tropical Regions", Journal of Textiles 2016).
//
// Kawabata's tester (KES-F; S. Kawabata, The Standardization and Analysis of Hand Evaluation, 1980):
//   bending rigidity B [gf·cm²/cm]: 1 is 9.81e-5 N·m;  shear rigidity G [gf/(cm·deg)]: 1 is 56.2 N/m;
//   extension EMT at 490 N/m with linearity LT: a curve a ε + b ε³ of that linearity starts with the share
//   2 LT − 1 of its secant, and the start is what a hanging cloth feels: stretch = (2 LT − 1) 490 N/m / EMT.
//
// Neither has a rate of damping: stretch and shear get a relaxation time (damping over stiffness) of 20 µs,
// small enough to leave the swing of a cloth alone.
constexpr double relaxation = 2e-5;  // s

Material fabric(std::string_view name, double weft, double warp, double shear, double bend) {
    Material material;
    material.preset = name;
    material.stretch = {weft, warp};
    material.stretch_damping = {relaxation * weft, relaxation * warp};
    material.shear = shear;
    material.shear_damping = relaxation * shear;
    material.bend = bend;
    return material;
}

const std::array<MaterialPreset, 6> presets{{
    // Wang et al., "royal target": trousers, 65% cotton, 35% polyester.
    // c11 2016.6, c22 2035.0, c33 104.8, k 125.4e-6
    {"cotton", 0.22, fabric("cotton", 4033, 4070, 52.4, 3.1e-5)},
    // Crêpe de Chine of 19 momme (4.34 g/m² each): the one preset that is an estimate throughout, of round
    // values for thin dress silks on Kawabata's tester (B 0.02, G 0.3, EMT 5%, LT 0.6). Silk is exceptionally
    // low in shear (M. Matsudaira, Mechanical Properties and Handles of Silk Filament Weaves, Kanazawa
    // University).
    {"silk", 0.082, fabric("silk", 1960, 1960, 17, 2e-6)},
    // Wang et al., "11oz black denim": 99% cotton, 1% spandex.
    // c11 205.4, c22 1013.9, c33 53.4, k 64.2e-6 and 97.0e-6
    {"denim", 0.324, fabric("denim", 411, 2028, 26.7, 2.0e-5)},
    // A tropical, 100% wool, plain weave: W 16.29 mg/cm² and B 0.067 gf·cm²/cm on Kawabata's tester
    // (Matsudaira, Masuda, Wada & Yokura, "Shape Factor of Flared Skirts Compared with That of Circular
    // Fabrics", Journal of Textile Engineering 61(6), 2015, Table 1, fabric B). Stretch and shear are
    // estimates, of round values for suitings (EMT 6%, LT 0.608; G 0.96).
    {"wool", 0.163, fabric("wool", 1760, 1760, 54, 6.6e-6)},
    // Wang et al., "gray interlock": a T-shirt's knit, 60% cotton, 40% polyester.
    // c11 16.6, c22 34.5, c33 36.9, k 23.2e-6 and 14.3e-6
    {"jersey", 0.187, fabric("jersey", 33.2, 69.0, 18.4, 4.7e-6)},
    // A latex sheet of 0.5 mm: E = 1 MPa, Poisson's ratio 1/2, 920 kg/m³; stretch, held in its width,
    // E t / (1 − 1/4), shear E t / 3, bend E t³ / (12 (1 − 1/4)).
    {"rubber", 0.46, fabric("rubber", 667, 667, 166.7, 1.4e-5)},
}};

constexpr std::string_view names[] = {"cotton", "silk", "denim", "wool", "jersey", "rubber"};

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

}  // namespace unravel::sim
