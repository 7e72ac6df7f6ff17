#pragma once

// Small scenes that several tests share.

#include "sim/run/simulate.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::testing {

using namespace sim;

inline Cloth sheet(int n, double height) {
    Cloth cloth;
    cloth.name = "sheet";
    cloth.particles = {n, n};
    cloth.center = {0, height, 0};
    cloth.material.stretch = {200, 200};
    cloth.material.shear = 0.5;
    return cloth;
}

/// A sheet falling onto a sphere: contact, friction, components, everything that the main job needs.
inline Scene drape(int n = 21) {
    Scene scene;
    scene.name = "drape";
    scene.cloths.push_back(sheet(n, 0.95));
    Solid sphere;
    sphere.name = "sphere";
    sphere.center = {0, 0.6, 0};
    sphere.pivot = sphere.center;
    sphere.friction = {0.4, 0.3};
    scene.solids.push_back(sphere);
    scene.solver.activation_band = 0.02;
    scene.clip.fps = 25;
    scene.cameras.emplace_back();
    return scene;
}

/// Steps a simulation and returns the reports.
inline std::vector<StepReport> run_steps(Simulation& simulation, int frames) {
    std::vector<StepReport> reports;
    for (int k = 0; k < frames; ++k) {
        const FrameRecord record = next_record(simulation);
        reports.insert(reports.end(), record.reports.begin(), record.reports.end());
    }
    return reports;
}

}  // namespace unravel::testing
