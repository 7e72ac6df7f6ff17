#include "sim/sweep/explicit_sweep.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "sim/sweep/group_sweep.hpp"
#include "sim/sweep/row_forces.hpp"

namespace unravel::sim {

namespace {

// What the substeps of a group, following each other, keep in a core's caches, and how many they are at most.
constexpr std::size_t cache_bytes = 1024 * 1024;
constexpr std::size_t most_levels = 8;
// A cloth that fits into a core's second cache as a whole needs no such care.
constexpr std::size_t small_bytes = 256 * 1024;
// A smaller cloth is one thread's work: among others, and by itself. Threads that share a cloth wait for each
// other row by row, which on a busy machine takes as long as the system lets another program run.
constexpr std::size_t shared_size = 2048, shared_size_alone = 512;

}  // namespace

struct SweepMemory {
    const double* model = nullptr;  // the masses that the tables were made of
    std::size_t particles = 0;
    double h = 0;
    std::vector<SweptCloth> cloths;
    std::vector<SweepSubstep> substeps;
    tbb::enumerable_thread_specific<SweepWorker> workers;
    std::unique_ptr<std::atomic<std::size_t>[]>
        passed;              // (groups of substeps) rows that their last has moved
    std::size_t groups = 0;  // that `passed` has room for
};

namespace {

// Substeps that follow each other in one thread's caches.
std::size_t levels_of(const SweptCloth& cloth, std::size_t substeps, std::size_t threads) {
    if (cloth.state.size() * sizeof(double) <= small_bytes) return 1;
    const std::size_t row_bytes = cloth.stride * sizeof(double);
    const std::size_t fit = cache_bytes / ((6 * (sweep_lag + 1) + 9) * row_bytes);
    const std::size_t share = (substeps + threads - 1) / threads,
                      room = cloth.rows() / (4 * sweep_lag * threads);
    return std::clamp<std::size_t>(std::min({fit, share, room}), 1, most_levels);
}

void sweep_alone(const ClothModel& model, SweepMemory& memory, SweptCloth& cloth, StopFlag stop) {
    GroupSweep sweep(model, cloth, memory.substeps, memory.h, levels_of(cloth, memory.substeps.size(), 1));
    for (std::size_t group = 0; group < sweep.groups(); ++group) {
        heed(stop);
        sweep.run(group, nullptr, memory.workers.local());
    }
}

// Groups are taken in order, so that whoever waits for one waits for a thread that is at it: one that was
// taken is swept to its end.
void sweep_together(const ClothModel& model, SweepMemory& memory, SweptCloth& cloth, std::size_t threads,
                    StopFlag stop) {
    GroupSweep sweep(model, cloth, memory.substeps, memory.h,
                     levels_of(cloth, memory.substeps.size(), threads));
    for (std::size_t group = 0; group < sweep.groups(); ++group) memory.passed[group] = 0;
    std::atomic<std::size_t> next{0};
    tbb::parallel_for(std::size_t{0}, std::min(threads, sweep.groups()), [&](std::size_t) {
        while (!is_asked_to_stop(stop)) {
            const std::size_t group = next++;
            if (group >= sweep.groups()) break;
            sweep.run(group, memory.passed.get(), memory.workers.local());
        }
    });
    heed(stop);
}

}  // namespace

ExplicitSweep::ExplicitSweep() : memory_(std::make_unique<SweepMemory>()) {}
ExplicitSweep::~ExplicitSweep() = default;
ExplicitSweep::ExplicitSweep(ExplicitSweep&&) noexcept = default;
ExplicitSweep& ExplicitSweep::operator=(ExplicitSweep&&) noexcept = default;

std::string why_not_swept(const ClothModel& model) {
    std::string why = why_not_by_rows(model);
    each_term(model, [&](const ForceTerm& term) {
        if (why.empty() && !term.rows && !term.part_of_rows)
            why = fmt::format("{} has no version along rows", term.name);
    });
    if (why.empty() && model.by_surfaces()) why = "surfaces meet, not particles alone";
    if (why.empty() && std::ranges::any_of(model.pins, &PinnedGroup::slides))
        why = "a pin slides along a line";
    for (const Solid& solid : model.solids) {
        if (why.empty() && solid.shape == Shape::mesh)
            why = fmt::format("the solid {} is a mesh", solid.name);
    }
    return why;
}

void ExplicitSweep::prepare(const ClothModel& model, const ForceMemory& forces, double h) {
    SweepMemory& memory = *memory_;
    if (memory.model == model.mass.data() && memory.particles == model.size() && memory.h == h) return;
    memory.model = model.mass.data();
    memory.particles = model.size();
    memory.h = h;
    memory.cloths.clear();
    for (std::size_t k = 0; k < model.cloths.size(); ++k) {
        SweptCloth& cloth = memory.cloths.emplace_back(model.cloths[k]);
        build_tables(model, model.grids[k], forces.bending.limit, cloth.tables);
        each_term(model, [&](const ForceTerm& term) {
            if (term.rows && !(term.rows->present && !term.rows->present(cloth.tables)))
                cloth.terms.push_back(term.rows);
        });
        if (!model.solids.empty())
            cloth.stretches = (cloth.columns() + contact_columns - 1) / contact_columns;
        place_pins(model, cloth);
    }
}

void ExplicitSweep::run(const ClothModel& model, const ClothState& state, int substeps, StopFlag stop,
                        ClothState& next, Constraints& constraints, std::uint32_t& touches) {
    SweepMemory& memory = *memory_;
    plan_substeps(model, state.t, memory.h, substeps, memory.substeps);
    if (memory.groups < memory.substeps.size()) {
        memory.groups = memory.substeps.size();
        memory.passed = std::make_unique<std::atomic<std::size_t>[]>(memory.groups);
    }
    for (SweptCloth& cloth : memory.cloths) {
        cloth.contacts.resize(cloth.rows() * cloth.stretches);
        take_state(state, cloth);
    }
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    const auto is_shared = [&](const SweptCloth& cloth) {
        const std::size_t least = memory.cloths.size() == 1 ? shared_size_alone : shared_size;
        return threads > 1 && cloth.patch.count() >= least;
    };
    for (SweptCloth& cloth : memory.cloths) {
        if (is_shared(cloth)) sweep_together(model, memory, cloth, threads, stop);
    }
    tbb::parallel_for(std::size_t{0}, memory.cloths.size(), [&](std::size_t k) {
        if (!is_shared(memory.cloths[k])) sweep_alone(model, memory, memory.cloths[k], stop);
    });
    next.x.resize(model.size());
    next.v.resize(model.size());
    next.contacts.clear();
    constraints.reset(model.size());
    touches = 0;
    for (SweptCloth& cloth : memory.cloths) give_state(cloth, next, constraints, touches);
    for (std::size_t g = 0; g < model.pins.size(); ++g) {
        if (memory.substeps.back().holds[g] == 0) continue;
        for (const std::uint32_t p : model.pins[g].particles) {
            if (!constraints.find(p)) constraints.add({p, 0, Mat3::Zero(), next.v[p] - state.v[p]});
        }
    }
}

}  // namespace unravel::sim
