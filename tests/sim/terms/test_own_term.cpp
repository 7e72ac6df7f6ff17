// A force that no scene knows, from this file alone: all that walks the list of forces takes it.

#include <catch2/catch.hpp>

#include "sim/run/simulate.hpp"
#include "sim/step/plan_text.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

constexpr double drag = 2.0;  // 1/s

void slow_down(const ClothModel& model, const ForcesAt& at, ForceMemory&, std::span<Vec3> force) {
    for (std::size_t p = 0; p < force.size(); ++p) force[p] -= drag * model.mass[p] * at.v[p];
}

const ForceTerm drag_term{
    .name = "uniform drag", .acts = [](const ClothModel&) { return true; }, .push = slow_down};

// The same with an energy of its own: a field that lifts each particle by half of its weight.
void lift(const ClothModel& model, const ForcesAt&, ForceMemory&, std::span<Vec3> force) {
    for (std::size_t p = 0; p < force.size(); ++p) force[p] -= 0.5 * model.mass[p] * model.gravity;
}
void measure_lift(const ClothModel& model, std::span<const Vec3> x, const ForceMemory&, MeasureWorkspace&,
                  StepReport& report) {
    for (std::size_t p = 0; p < x.size(); ++p)
        report.potential += 0.5 * model.mass[p] * model.gravity.dot(x[p]);
}
const ForceTerm lift_term{
    .name = "lift", .acts = [](const ClothModel&) { return true; }, .push = lift, .measure = measure_lift};
// What drives particles on, and its work.
void pump(const ClothModel& model, const ForcesAt& at, ForceMemory&, std::span<Vec3> force) {
    for (std::size_t p = 0; p < force.size(); ++p) force[p] += drag * model.mass[p] * at.v[p];
}
double work_of_pump(const ClothModel& model, const StepEnds& step, ForceMemory&) {
    double work = 0;
    for (std::size_t p = 0; p < step.x.size(); ++p)
        work += drag * model.mass[p] * step.v[p].dot(step.x_next[p] - step.x[p]);
    return work;
}
const ForceTerm silent_pump{
    .name = "silent pump", .acts = [](const ClothModel&) { return true; }, .push = pump};
const ForceTerm pump_term{
    .name = "pump", .acts = [](const ClothModel&) { return true; }, .push = pump, .put_in = work_of_pump};

Scene falling_grid() {
    Scene scene;
    scene.cloths.push_back(sheet(9, 1.0));
    scene.cloths.back().velocity = {0.3, 0.1, -0.2};
    scene.cameras.emplace_back();
    return scene;
}

Scene falling_mesh() {
    const MeshScene made(
        "[cloth]\nmesh = \"mesh.obj\"\nvelocity = [0.3, 0.1, -0.2]\n[cloth.material]\nstretch = 200\n",
        sheet_obj(8, true));
    return made.scene;
}

Simulation with(const ForceTerm& term, const Scene& scene, Integrator integrator) {
    Scene own = scene;
    own.solver.integrator = integrator;
    own.solver.tolerance = 1e-13;
    Simulation simulation = start_simulation(own);
    simulation.model.further_terms = {&term};
    return simulation;
}

constexpr Integrator one_step[] = {Integrator::explicit_, Integrator::implicit, Integrator::newton,
                                   Integrator::imex, Integrator::adaptive_imex};

}  // namespace

TEST_CASE("a term of one's own acts on grids, meshes and explicit steps", "[terms]") {
    const double h = 0.001;
    for (const Scene& scene : {falling_grid(), falling_mesh()}) {
        for (const Integrator integrator : one_step) {
            INFO(scheme_of(integrator).name);
            Simulation simulation = with(drag_term, scene, integrator);
            Vec3 v(0.3, 0.1, -0.2), fallen(0, 0, 0);
            const std::vector<Vec3> start = simulation.state.x;
            ForceMemory forces;
            prepare_terms(simulation.model, h, forces);
            for (int k = 0; k < 50; ++k) {
                const double before = v.squaredNorm(),
                             mass = std::accumulate(simulation.model.mass.begin(),
                                                    simulation.model.mass.end(), 0.0);
                StepReport last;
                MeasureWorkspace scratch;
                measure(simulation.model, forces, simulation.state, scratch, last);
                const StepReport report =
                    step(simulation.model, simulation.options, h, simulation.state, simulation.ws);
                // v' = v + h (g − c v): no spring is taut, so that each particle falls by itself.
                const Vec3 change = h * (simulation.model.gravity - drag * v);
                const Vec3 next = v + change;
                fallen += h * next;
                // What the drag takes, and what a step of first order loses besides.
                const double taken = mass * (drag * h * next.dot(v) + 0.5 * change.squaredNorm());
                CHECK(report.kinetic + report.potential - last.kinetic - last.potential ==
                      Approx(-taken).epsilon(1e-6));
                CHECK(report.kinetic == Approx(0.5 * mass * next.squaredNorm()).epsilon(1e-10));
                CHECK(before > 0);
                v = next;
            }
            for (std::size_t p = 0; p < start.size(); ++p) {
                CHECK((simulation.state.v[p] - v).norm() < 1e-12);
                CHECK((simulation.state.x[p] - start[p] - fallen).norm() < 1e-12);
            }
        }
    }
}

TEST_CASE("a term without a version along rows takes the general path, and the plan says so", "[terms]") {
    Scene scene = falling_grid();
    scene.solver.integrator = Integrator::explicit_;
    scene.solver.substeps = 0;
    Simulation plain = start_simulation(scene);
    CHECK(plan_step(plain.model, plain.options, 0.005, plain.ws).way == StepPlan::Way::swept);
    Simulation own = with(drag_term, scene, Integrator::explicit_);
    const StepPlan& plan = plan_step(own.model, own.options, 0.005, own.ws);
    CHECK(plan.way == StepPlan::Way::in_turn);
    CHECK(plan.way_because == "uniform drag has no version along rows");

    Simulation coupled = with(drag_term, scene, Integrator::adaptive_imex);
    step(coupled.model, coupled.options, 0.005, coupled.state, coupled.ws);
    bool named = false;
    for (const ForcePlan::Term& planned : coupled.ws.plan.step.forces.terms) {
        const bool drags = planned.term == &drag_term;
        CHECK(planned.by_rows == !drags);
        named = named || drags;
    }
    CHECK(named);
    CHECK(!coupled.ws.plan.step.cloths[0].by_rows);
    CHECK(coupled.ws.plan.step.cloths[0].forces_because == "uniform drag has no version along rows");
}

TEST_CASE("the guard counts a term's energy, and lets it feed where it says so", "[terms]") {
    // Half of the weight is lifted: what falls gains half of what the height gives up, and the rest is the
    // lift's.
    Simulation lifted = with(lift_term, falling_grid(), Integrator::adaptive_imex);
    lifted.guard = make_guard(lifted.model, lifted.state, 0.005);
    const double start = lifted.guard.total;
    for (int k = 0; k < 40; ++k) {
        const StepReport report =
            guarded_step(lifted.model, lifted.options, 0.005, lifted.state, lifted.ws, lifted.guard);
        CHECK(report.rejected == 0);
        CHECK(report.kinetic + report.potential <= start);
        CHECK(report.kinetic + report.potential == Approx(start).epsilon(0.05));
    }
    // Three seconds of falling, driven on, end at some 1,000 m/s: more than the fall has to spend, and less
    // than what is put in.
    for (const ForceTerm* const term : {&pump_term, &silent_pump}) {
        Simulation fed = with(*term, falling_grid(), Integrator::adaptive_imex);
        fed.guard = make_guard(fed.model, fed.state, 0.005);
        const auto run = [&] {
            for (int k = 0; k < 600; ++k)
                guarded_step(fed.model, fed.options, 0.005, fed.state, fed.ws, fed.guard);
        };
        if (term->put_in) {
            CHECK_NOTHROW(run());
        } else {
            CHECK_THROWS_AS(run(), SimulationError);
        }
    }
}

TEST_CASE("every force of a scene that has an energy is its slope", "[terms]") {
    Scene scene = falling_grid();
    scene.cloths.back().material.bend = 1e-5;
    scene.cloths.back().placed_scale = {1.1, 0.8};
    scene.cloths.back().jitter = 0.01;
    Simulation simulation = start_simulation(scene);
    const ClothModel& model = simulation.model;
    ForceMemory forces;
    prepare_terms(model, 0.005, forces);
    std::vector<Vec3> x = simulation.state.x, force(model.size());
    conservative_forces(model, x, forces, force);
    const auto energy = [&] {
        StepReport report;
        MeasureWorkspace scratch;
        measure(model, forces, x, simulation.state.v, scratch, report);
        return report.potential;
    };
    // Central differences of an energy of about 1 J: rounding over the distance, and its square times what is
    // cubic.
    const double d = 1e-6;
    for (const std::size_t p : {std::size_t{0}, std::size_t{12}, std::size_t{40}, std::size_t{80}}) {
        for (Eigen::Index c = 0; c < 3; ++c) {
            const double at = x[p][c];
            x[p][c] = at + d;
            const double above = energy();
            x[p][c] = at - d;
            const double below = energy();
            x[p][c] = at;
            CHECK(force[p][c] == Approx((below - above) / (2 * d)).epsilon(1e-4).margin(1e-6));
        }
    }
}
