// Every scene that ships gives the same bits whatever the number of threads. Shipped sizes, because a smaller
// cloth is one piece of work; few steps, because the whole clips are long.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <catch2/catch.hpp>

#include "sim/run/frame_record.hpp"
#include "sim/run/simulate.hpp"
#include "sim/scene_file/load.hpp"
#include "source_dir.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

constexpr int steps = 24;

std::vector<std::uint64_t> hashes(const Scene& scene, int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute([&] {
        Simulation simulation = start_simulation(scene);
        std::vector<std::uint64_t> out;
        for (int k = 0; k < steps; ++k) {
            next_step(simulation);
            out.push_back(state_hash(simulation.state));
        }
        return out;
    });
}

}  // namespace

TEST_CASE("one, two and three threads give the same bits on every scene that ships", "[threads]") {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(UNRAVEL_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        ++scenes;
        const Scene scene = load_scene(entry.path());
        const std::vector<std::uint64_t> one = hashes(scene, 1);
        INFO(entry.path().filename());
        CHECK(hashes(scene, 2) == one);
        CHECK(hashes(scene, 3) == one);
        CHECK(one.front() != one.back());
    }
    CHECK(scenes >= 10);
}

TEST_CASE("explicit sweeps and the choice between integrators give the same bits for any threads",
          "[threads]") {
    // Soft enough that explicit substeps are what auto takes, and so stiff that it takes none.
    for (const char* stretch : {"50", "5e4"}) {
        for (const char* name : {"hang", "drape_sphere"}) {
            INFO(name << ", stretch " << stretch);
            const Scene scene =
                load_scene(std::string(UNRAVEL_SOURCE_DIR "/scenes/") + name + ".toml",
                           {"solver.integrator=\"auto\"", std::string("cloth.material.stretch=") + stretch});
            const std::vector<std::uint64_t> one = hashes(scene, 1);
            CHECK(hashes(scene, 2) == one);
            CHECK(hashes(scene, 3) == one);
        }
    }
}
