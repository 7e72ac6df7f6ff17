// The scenes that ship: at more than one resolution, and what they are there to show.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/solids/sdf.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

const std::filesystem::path scenes = UNRAVEL_SOURCE_DIR "/scenes";

double deepest(const ClothModel& model, const ClothState& state) {
    double least = 1;
    for (const Solid& solid : model.solids) {
        const Pose pose = solid_pose(solid, state.t);
        for (const Vec3& x : state.x)
            least = std::min(least, signed_distance(solid, pose.inverse(Eigen::Isometry) * x, nullptr));
    }
    return least;
}

}  // namespace

TEST_CASE("every scene that ships also runs on a grid of half the particles along each side") {
    for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
        if (entry.path().extension() != ".toml") continue;
        INFO(entry.path().filename());
        const Scene full = load_scene(entry.path(), {});
        REQUIRE(full.cloths.size() == 1);
        const auto [nu, nv] = full.cloths[0].particles;
        const Scene half =
            load_scene(entry.path(), {fmt::format("cloth.particles=[{}, {}]", (nu + 1) / 2, (nv + 1) / 2)});
        Simulation simulation = start_simulation(half);
        double strain = 0;
        for (int frame = 0; frame < 15; ++frame) {
            for (const StepReport& report : next_record(simulation).reports) {
                CHECK(report.converged);
                strain = std::max(strain, report.max_strain);
            }
        }
        CHECK(strain < 0.5);
        CHECK(deepest(simulation.model, simulation.state) > -1e-9);
    }
}

TEST_CASE("patchwork: the splitting is local in space, and with the adaptive step in time") {
    Simulation simulation = start_simulation(load_scene(scenes / "patchwork.toml", {}));
    const ClothModel& model = simulation.model;
    const ClothPatch& patch = model.cloths.at(0);
    const auto u_of = [&](std::uint32_t p) { return static_cast<double>(p % 61) / 60; };
    REQUIRE(patch.particles == std::array{61, 61});
    // Explicit and implicit shear springs, by place.
    struct Count {
        int explicit_ = 0, implicit = 0;
    } interfacing, soft, rest;
    std::vector<bool> was_explicit(model.springs.size()), was_implicit(model.springs.size());
    int rejected = 0;
    for (int frame = 0; frame < 20; ++frame) {
        const FrameRecord record = next_record(simulation);
        for (const StepReport& report : record.reports) rejected += static_cast<int>(report.rejected);
        for (std::size_t s = model.springs.stretch_count; s < model.springs.size(); ++s) {
            const SpringState state = record.springs[s];
            if (state == SpringState::inactive) continue;
            const double u = 0.5 * (u_of(model.springs.i[s]) + u_of(model.springs.j[s]));
            Count& count = u > 0.4 && u < 0.6 ? interfacing : u < 0.25 ? soft : rest;
            (state == SpringState::explicit_ ? count.explicit_ : count.implicit) += 1;
            (state == SpringState::explicit_ ? was_explicit : was_implicit)[s] = true;
        }
    }
    CHECK(rejected > 0);
    CHECK(interfacing.explicit_ == 0);
    CHECK(interfacing.implicit > 0);
    CHECK(soft.implicit == 0);
    CHECK(soft.explicit_ > 0);
    CHECK(rest.explicit_ > 0);
    CHECK(rest.implicit > 0);
    // The same spring now so, now so: the step has changed under it.
    int both = 0;
    for (std::size_t s = 0; s < model.springs.size(); ++s) both += was_explicit[s] && was_implicit[s];
    CHECK(both > 100);
}
