#include "tool/study/verify/verify_cases.hpp"

#include <array>

namespace unravel::tool {

namespace {

constexpr std::array cases{
    VerifyCase{"cantilever", "B θ'' = −ρ g (L − s) cos θ, θ(0) = 0, θ'(L) = 0",
               "heavy elastica (Bickley 1934, as Peirce's cantilever test has it)",
               "droop over length of a strip of 0.1 m", "", "the discrete clamp lies within a cell",
               verify_cantilever},
    VerifyCase{"tube", "E = ½ B κ² per area", "plate bent to a cylinder",
               "energy of a flat cloth rolled up along u or v", "µJ", "", verify_tube},
    VerifyCase{"moduli", "energy per area ½ C ε², ½ G γ²",
               "plane elasticity; what the keys mean is in docs/scenes.md",
               "moduli of a sheet that is stretched or sheared evenly by 0.001", "N/m",
               "triangles know no shear modulus of their own", verify_moduli},
    VerifyCase{"strip", "ΔL = ρ g L²/(2 (stretch − 2 shear (b/a)²))", "uniaxial tension, free to narrow",
               "elongation of a hanging strip of 1 m", "mm", "its width is held where it is pinned",
               verify_strip},
    VerifyCase{"catenary", "L = 2 c sinh(d/2c), sag = c (cosh(d/2c) − 1)", "inextensible chain",
               "sag of 1 m of tape between points 0.8 m apart", "mm", "", verify_catenary},
    VerifyCase{"wave", "c = √(T/ρ')", "taut string", "speed of a wave across a stretched tape", "m/s", "",
               verify_wave},
    VerifyCase{"free fall", "½ g t²", "Galilei", "fall in 0.5 s", "m", "a step's error is h/t", verify_fall},
    VerifyCase{"momentum", "m v is kept", "Newton", "speed of a stretched sheet that flies for 0.5 s", "m/s",
               "", verify_momentum},
    VerifyCase{"terminal speed", "v = √(2 ρ g/(ρ_air c_d))", "drag of a plate across the stream",
               "speed of a sheet that sinks flat", "m/s", "", verify_terminal},
    VerifyCase{"slack sheet", "explicit steps of 1/12800 s", "a reference by another method",
               "fall of the centre of a silk sheet pinned by one corner, at 0.1 and 0.5 s", "mm",
               "no formula: chaotic, 5%", verify_slack},
    VerifyCase{"spin", "ω e^(−ω² h t)", "backward Euler applied to a rotation",
               "angular momentum of a spinning sheet after 1 s over that at the start", "",
               "what implicit steps lose is theirs, not the cloth's", verify_spin},
    VerifyCase{"sliding block", "v²/(2 μ g)", "Coulomb", "way on which a sliding sheet comes to rest", "m",
               "", verify_block},
    VerifyCase{"incline", "g (sin θ − μ cos θ), or rest", "Coulomb",
               "way in 0.5 s on a slope of 0.95 and of 1.5 times the angle of friction", "m", "",
               verify_incline},
    VerifyCase{"capstan", "T₁/T₂ ≤ e^(μ π)", "Euler, Eytelwein",
               "whether a loaded tape over a cylinder slips (1) within a second or not (0)", "", "",
               verify_capstan},
    VerifyCase{"critical κ", "κ ≤ 1 of a chain, ≤ ½ with shear", "paper, Sec. 3.5",
               "largest κ at which explicit steps don't grow", "",
               "finite grids bear a little more than the bound", verify_kappa},
};

}  // namespace

std::span<const VerifyCase> verify_cases() {
    return cases;
}

}  // namespace unravel::tool
