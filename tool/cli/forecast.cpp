#include "tool/cli/forecast.hpp"

#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <fstream>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace unravel::tool {

namespace {

// Particles of the piece that is tried, of the coarse cloth, and seconds of one core for each.
constexpr double tried_particles = 20'000, coarse_particles = 1'600;
constexpr double trial_seconds = 0.7;

// Both views of 1280 × 720 with PNG and video, on a 2.4 GHz server core: per pixel, and per particle for its
// two triangles in picture and shadow (scenes/drape_sphere.toml at 51² and 401²).
constexpr double pixel_seconds = 0.11 / (1280.0 * 720.0), drawn_particle_seconds = 1.4e-6;
// Memory of the program itself, of the renderer, of a pixel (targets, pictures under way, encoders) and of a
// particle on its way to a picture: five frames' records and vertices.
constexpr double own_bytes = 50e6, renderer_bytes = 80e6, pixel_bytes = 165;
// And of one in a frame that is being written.
constexpr double recorded_bytes = 250;
constexpr double drawn_grid_bytes = 2050, drawn_mesh_bytes = 2900;

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double resident_bytes() {
    double pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double particles_of(const Scene& scene) {
    double n = 0;
    for (const Cloth& cloth : scene.cloths)
        if (!cloth.geometry) n += static_cast<double>(cloth.particles[0]) * cloth.particles[1];
    return n;
}

// The same cloths with `share` of their cells: of the same size (a piece), or larger (all of the cloth).
// Meshes stay what they are.
Scene with_share(Scene scene, double share, bool piece) {
    for (Cloth& cloth : scene.cloths) {
        if (cloth.geometry) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            const int before = cloth.particles[k];
            cloth.particles[k] = std::clamp(static_cast<int>(std::lround(before * std::sqrt(share))),
                                            std::min(before, 4), before);
            if (piece && before > 1) cloth.size[k] *= (cloth.particles[k] - 1.0) / (before - 1.0);
        }
        // They name particles that there may be no more.
        std::erase_if(cloth.pins, [](const Pin& pin) { return pin.target == PinTarget::particles; });
    }
    return scene;
}

// Asks for a stop after a while: a single step may take hours.
class Patience {
public:
    explicit Patience(double seconds)
        : thread_([this, seconds](const std::stop_token& over) {
              std::unique_lock lock(mutex_);
              wake_.wait_for(lock, over, std::chrono::duration<double>(seconds), [] { return false; });
              ended_ = 1;
          }) {}
    StopFlag flag() const { return &ended_; }

private:
    std::atomic<int> ended_{0};
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread thread_;  // last: it uses the others
};

// Seconds that each of the first steps takes, until they have taken a while. The last may not have come to
// its end.
std::vector<double> try_steps(Simulation& simulation, long most, bool& longer) {
    std::vector<double> seconds;
    const Patience patience(10 * trial_seconds);
    simulation.options.solve.stop = patience.flag();
    const double begin = cpu_seconds();
    double before = begin;
    try {
        while (static_cast<long>(seconds.size()) < most && before - begin < trial_seconds) {
            next_step(simulation);
            const double now = cpu_seconds();
            seconds.push_back(now - before);
            before = now;
        }
    } catch (const SimulationError&) {
        // What can be said of a run that ends here is what it takes until then.
    } catch (const Stopped&) {
        longer = seconds.empty();
        if (longer) seconds.push_back(cpu_seconds() - before);
    }
    return seconds;
}

double sum(const std::vector<double>& values, std::size_t count) {
    double total = 0;
    for (std::size_t k = 0; k < count; ++k) total += values[k];
    return total;
}

}  // namespace

Forecast forecast(const Scene& scene, const Simulation& simulation) {
    Forecast out;
    out.steps = static_cast<long>(simulation.settling) +
                static_cast<long>(simulation.steps_per_frame) * (scene.clip.frames() - 1);
    const double grid = particles_of(scene), n = static_cast<double>(simulation.model.size());
    const double share = std::min(1.0, tried_particles / std::max(grid, 1.0));
    const double before = resident_bytes();
    std::vector<double> first, through;
    double scale = 1, held = 0;
    // One thread: what is told is the work, and waiting is none.
    tbb::task_arena arena(1);
    arena.execute([&] {
        {
            Simulation tried = start_simulation(share < 1 ? with_share(scene, share, true) : scene);
            scale = n / std::max(1.0, static_cast<double>(tried.model.size()));
            first = try_steps(tried, out.steps, out.longer);
            held = resident_bytes() - before;
        }
        if (static_cast<long>(first.size()) < out.steps && grid > coarse_particles) {
            Simulation coarse = start_simulation(with_share(scene, coarse_particles / grid, false));
            bool any = false;
            through = try_steps(coarse, out.steps, any);
        }
    });
    const std::size_t tried = first.size();
    double later = tried > 0 ? static_cast<double>(out.steps) / static_cast<double>(tried) : 0;
    if (through.size() > tried && tried > 0) {
        const double all = sum(through, through.size()) / static_cast<double>(through.size());
        const double start = sum(through, tried) / static_cast<double>(tried);
        later *= all / start;
    }
    out.seconds = scale * sum(first, tried) * later;
    const double pixels = static_cast<double>(scene.clip.size[0]) * scene.clip.size[1];
    out.picture_seconds = scene.clip.frames() * (pixels * pixel_seconds + n * drawn_particle_seconds);
    out.bytes = own_bytes + n * recorded_bytes + scale * std::max(held, 0.0);
    out.bytes_with_pictures = out.bytes + renderer_bytes + pixels * pixel_bytes;
    for (const ClothPatch& cloth : simulation.model.cloths)
        out.bytes_with_pictures += cloth.count() * (cloth.grid() ? drawn_grid_bytes : drawn_mesh_bytes);
    return out;
}

}  // namespace unravel::tool
