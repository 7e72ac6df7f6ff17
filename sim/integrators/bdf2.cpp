#include "sim/integrators/scheme.hpp"

namespace unravel {

namespace {

// The two-step formula is zero-stable while steps grow by less than 1 + √2; beyond, the scheme starts anew.
constexpr double largest_growth = 2.4;

// A one-step start of second order: the trapezoidal rule. Its half f(x, v) of the old force and its half of
// the new one, linearised at (x, v), make h_f = h.
void begin_trapezoidal(const ClothState& state, double h, Stage& stage) {
    stage.h = 0.5 * h;
    stage.h_force = h;
    stage.x_at = state.x;
    stage.v = stage.v_at = state.v;
    stage.x.resize(state.x.size());
    parallel_each(state.x.size(), [&](std::size_t p) { stage.x[p] = state.x[p] + 0.5 * h * state.v[p]; });
}

}  // namespace

// Second-order backward differentiation (Choi & Ko 2002), linearised once per step.
const Scheme bdf2{"bdf2",     2,     [](double) { return Splitting{always_implicit, always_implicit}; },
                  begin_bdf2, false, true};

/// With ω = h/h_previous,
///   x̃ = ((1 + ω)² x − ω² x_previous)/(1 + 2ω),  ṽ alike,  h̃ = h (1 + ω)/(1 + 2ω).
/// Forces are linearised at the extrapolated state
///   x* = x + h ((1 + ω/2) v − ω/2 v_previous),  v* = (1 + ω) v − ω v_previous:
/// what is explicit (bend, and in the IMEX pair the soft springs) is then of second order from one evaluation
/// of the forces, and a spring that will be taut at the end of the step is seen to be so. The positions go by
/// the velocities because (1 + ω) x − ω x_previous feeds an explicit undamped spring by h⁴ω₀⁴/4 a step,
/// however small h is; this way it is damped for all h²ω₀² ≤ 1.6, which is κ ≤ 0.2 on a grid whose springs
/// share one κ.
void begin_bdf2(const ClothState& state, double h, Stage& stage) {
    const double w = state.h_previous > 0 ? h / state.h_previous : 0.0;
    if (w == 0 || w > largest_growth || state.x_previous.size() != state.x.size()) {
        return begin_trapezoidal(state, h, stage);
    }
    const std::size_t n = state.x.size();
    const double now = (1 + w) * (1 + w) / (1 + 2 * w), before = w * w / (1 + 2 * w);
    stage.h = stage.h_force = h * (1 + w) / (1 + 2 * w);
    for (std::vector<Vec3>* y : {&stage.x, &stage.v, &stage.x_at, &stage.v_at}) y->resize(n);
    parallel_each(n, [&](std::size_t p) {
        stage.x[p] = now * state.x[p] - before * state.x_previous[p];
        stage.v[p] = now * state.v[p] - before * state.v_previous[p];
        stage.x_at[p] = state.x[p] + h * ((1 + 0.5 * w) * state.v[p] - 0.5 * w * state.v_previous[p]);
        stage.v_at[p] = (1 + w) * state.v[p] - w * state.v_previous[p];
    });
}

}  // namespace unravel
