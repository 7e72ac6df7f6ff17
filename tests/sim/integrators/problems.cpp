#include "tests/sim/integrators/problems.hpp"

#include <cmath>
#include <limits>

namespace unravel::sim {

namespace {

void add_spring(Problem& p, std::uint32_t i, std::uint32_t j, double rest, double stiffness, double damping) {
    p.model.springs.i.push_back(i);
    p.model.springs.j.push_back(j);
    p.model.springs.rest.push_back(rest);
    p.model.springs.stiffness.push_back(stiffness);
    p.model.springs.damping.push_back(damping);
}

void pin(Problem& p, std::uint32_t particle) {
    PinnedGroup group;
    group.particles = {particle};
    group.start = {p.start.x[particle]};
    group.centre = group.start[0];
    group.release = std::numeric_limits<double>::infinity();
    p.model.pins.push_back(group);
}

void finish(Problem& p) {
    p.model.springs.stretch_count = p.model.springs.size();
    p.model.spring_adjacency = adjacency_of(p.start.x.size(), p.model.springs.i, p.model.springs.j);
}

double chain_mode(int k) {
    return std::sin(M_PI * k / (chain_masses + 1));
}

}  // namespace

Problem chain() {
    Problem p;
    p.duration = 1.0;
    for (int k = 0; k <= chain_masses + 1; ++k) {
        p.model.mass.push_back(chain_mass);
        p.start.x.emplace_back(chain_gap * k + chain_swing * chain_mode(k), 0, 0);
        p.start.v.emplace_back(0, 0, 0);
        if (k > 0)
            add_spring(p, static_cast<std::uint32_t>(k - 1), static_cast<std::uint32_t>(k), chain_rest,
                       chain_stiffness, 0);
    }
    pin(p, 0);
    pin(p, chain_masses + 1);
    finish(p);
    return p;
}

std::vector<Vec3> chain_at(double t) {
    const double omega =
        2 * std::sqrt(chain_stiffness / chain_mass) * std::sin(M_PI / (2 * (chain_masses + 1)));
    std::vector<Vec3> x;
    for (int k = 0; k <= chain_masses + 1; ++k)
        x.emplace_back(chain_gap * k + chain_swing * chain_mode(k) * std::cos(omega * t), 0, 0);
    return x;
}

Problem pendulum() {
    Problem p;
    p.duration = 0.5;
    p.model.gravity = {0, -9.81, 0};
    p.model.mass = {0.1, 0.1, 0.07};
    p.start.x = {{0, 0, 0}, {0.18, -0.39, 0}, {0.28, -0.79, 0.05}};
    p.start.v = {{0, 0, 0}, {0.1, 0.05, 0.3}, {0.1, 0, 0.4}};
    add_spring(p, 0, 1, 0.4, 60, 0.02);
    add_spring(p, 1, 2, 0.4, 40, 0.02);
    pin(p, 0);
    finish(p);
    return p;
}

Problem trampoline() {
    Scene scene;
    Cloth cloth;
    cloth.particles = {7, 7};
    cloth.placed_scale = {1.08, 1.08};
    cloth.material.stretch = {50, 50};
    cloth.material.shear = 5;
    cloth.bend_model = BendModel::buckling;  // which no threshold makes implicit
    for (const char* edge : {"u0", "u1", "v0", "v1"}) {
        Pin frame;
        frame.target = PinTarget::edge;
        frame.name = edge;
        cloth.pins.push_back(frame);
    }
    scene.cloths.push_back(cloth);
    Problem p;
    p.model = build_model(scene, p.start);
    p.duration = 0.25;
    return p;
}

Problem zigzag() {
    Problem p;
    p.duration = 0.2;
    constexpr int count = 7;
    for (int k = 0; k < count; ++k) {
        p.model.mass.push_back(0.1);
        p.start.x.emplace_back(0.1 * k, k % 2 ? 0.04 : 0.0, 0.002 * k * k);
        p.start.v.emplace_back(0, 0, 0);
        if (k > 0)
            add_spring(p, static_cast<std::uint32_t>(k - 1), static_cast<std::uint32_t>(k), 0.085, 60, 0.02);
    }
    pin(p, 0);
    pin(p, count - 1);
    finish(p);
    BendSprings& bends = p.model.bends;
    for (std::uint32_t k = 0; k + 2 < count; ++k) {
        bends.i.push_back(k);
        bends.j.push_back(k + 2);
        bends.rest.push_back(0.24);
        bends.stiffness.push_back(4e-3);
        bends.slope.push_back(5);
    }
    return p;
}

std::vector<Vec3> accelerations(const Problem& p, const std::vector<Vec3>& x, const std::vector<Vec3>& v) {
    std::vector<Vec3> a(x.size(), p.model.gravity);
    const auto push = [&](std::uint32_t i, std::uint32_t j, const Vec3& f) {
        a[i] += f / p.model.mass[i];
        a[j] -= f / p.model.mass[j];
    };
    const ExtensionSprings& s = p.model.springs;
    for (std::size_t k = 0; k < s.size(); ++k) {
        const Vec3 d = x[s.j[k]] - x[s.i[k]];
        const double l = d.norm();
        if (l <= s.rest[k]) continue;
        push(s.i[k], s.j[k],
             (s.stiffness[k] * (l - s.rest[k]) + s.damping[k] * (v[s.j[k]] - v[s.i[k]]).dot(d) / l) * d / l);
    }
    const BendSprings& b = p.model.bends;
    for (std::size_t k = 0; k < b.size(); ++k) {
        const Vec3 d = x[b.j[k]] - x[b.i[k]];
        push(b.i[k], b.j[k], bend_force(d.norm(), b.rest[k], b.stiffness[k], b.slope[k]) * d / d.norm());
    }
    const CurvatureStencils& c = p.model.curvature;
    for (std::size_t k = 0; k < c.size(); ++k) {
        const Vec3 pull = c.stiffness[k] * bend_of(c, k, x);
        for (std::uint32_t end = 0; end < c.count(k); ++end)
            a[c.p[k][end]] -= c.w[end][k] / p.model.mass[c.p[k][end]] * pull;
    }
    for (const PinnedGroup& group : p.model.pins) {
        for (const std::uint32_t q : group.particles) a[q].setZero();
    }
    return a;
}

StepOptions options_of(Integrator integrator) {
    StepOptions options;
    options.integrator = integrator;
    options.threshold = 0.05;
    options.solve.tolerance = 1e-11;
    return options;
}

std::vector<Vec3> integrate(const Problem& p, const StepOptions& options, int steps,
                            const std::vector<double>& pattern) {
    ClothState state = initial_state(p.start);
    StepWorkspace ws;
    double whole = 0;
    for (int n = 0; n < steps; ++n) whole += pattern[static_cast<std::size_t>(n) % pattern.size()];
    for (int n = 0; n < steps; ++n) {
        step(p.model, options, p.duration * pattern[static_cast<std::size_t>(n) % pattern.size()] / whole,
             state, ws);
    }
    return state.x;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace unravel::sim
