#include "sim/integrators/scheme.hpp"

namespace unravel::sim {

namespace {

// The two-step formula is zero-stable while steps grow by less than 1 + √2; beyond, the scheme starts anew.
constexpr double largest_growth = 2.4;

// A one-step start of second order: the trapezoidal rule. Its half f(x, v) of the old force and its half of
// the new one, linearised at (x, v), make h_f = h.
void begin_trapezoidal(const ClothState& state, double h, Stage& stage) {
    stage.h = 0.5 * h;
    stage.h_force = h;
    stage.x_at = state.x;
    stage.x_linear.clear();
    stage.v = stage.v_at = state.v;
    stage.own.x.resize(state.x.size());
    parallel_each(state.x.size(), [&](std::size_t p) { stage.own.x[p] = state.x[p] + 0.5 * h * state.v[p]; });
    stage.x = stage.own.x;
}

}  // namespace

// Second-order backward differentiation (Choi & Ko 2002), linearised once per step.
const Scheme bdf2{.name = "bdf2",
                  .order = 2,
                  .splitting =
                      [](double threshold) {
                          return Splitting{always_implicit, always_implicit, 0.6 * threshold};
                      },
                  .begin = begin_bdf2,
                  .multistep = true,
                  .explicit_bound = 3.2};

/// With ω = h/h_previous,
///   x̃ = ((1 + ω)² x − ω² x_previous)/(1 + 2ω),  ṽ alike,  h̃ = h (1 + ω)/(1 + 2ω).
/// Implicit springs are linearised at x (Choi & Ko 2002), which leaves an error of second order in the step.
/// At an extrapolated state it has that order too, but stiff springs that are slack and taut by turns
/// overshoot there: a hanging cloth of 5,000 N/m is a third of its size off at any step above 1/400 s. A
/// spring slack at x and taut at x* has its Jacobian; damping acts along the line at x*. Explicit forces
/// (bend, air, and in the IMEX pair the soft springs) are taken at a state extrapolated to the end of the
/// step, so that they are of second order from one evaluation. Of the extrapolations with that order,
///   x* = x + ω/3 (x − x_previous) + 2h/3 v,
///   v* = v + ω/2 (v − v_previous) + ω (v − (x − x_previous)/h_previous)
/// are taken for what they do to an explicit spring: its frequency is right to fourth order, its swing loses
/// a third of what backward differentiation takes from an implicit one, and it is stable for 8κ ≤ 3.2
/// whatever share of κ (7) is damping and however stiff the implicit springs beside it are: κ ≤ 0.4 on a grid
/// whose springs share one κ. SBDF2's own 2x − x_previous feeds an undamped explicit spring at every step
/// size.
void begin_bdf2(const ClothState& state, double h, Stage& stage) {
    const double w = state.h_previous > 0 ? h / state.h_previous : 0.0;
    if (w == 0 || w > largest_growth || state.x_previous.size() != state.x.size()) {
        return begin_trapezoidal(state, h, stage);
    }
    const std::size_t n = state.x.size();
    stage.x_linear = state.x;
    const double now = (1 + w) * (1 + w) / (1 + 2 * w), before = w * w / (1 + 2 * w);
    stage.h = stage.h_force = h * (1 + w) / (1 + 2 * w);
    Stage::Own& own = stage.own;
    for (std::vector<Vec3>* y : {&own.x, &own.v, &own.x_at, &own.v_at}) y->resize(n);
    parallel_each(n, [&](std::size_t p) {
        own.x[p] = now * state.x[p] - before * state.x_previous[p];
        own.v[p] = now * state.v[p] - before * state.v_previous[p];
        const Vec3 moved = state.x[p] - state.x_previous[p];
        own.x_at[p] = state.x[p] + w / 3 * moved + 2.0 / 3 * h * state.v[p];
        own.v_at[p] = state.v[p] + 0.5 * w * (state.v[p] - state.v_previous[p]) +
                      w * (state.v[p] - moved / state.h_previous);
    });
    stage.x = own.x;
    stage.v = own.v;
    stage.x_at = own.x_at;
    stage.v_at = own.v_at;
}

}  // namespace unravel::sim
