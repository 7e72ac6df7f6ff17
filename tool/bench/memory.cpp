#include "tool/bench/memory.hpp"

#include <malloc.h>
#include <unistd.h>

#include <concepts>
#include <fstream>
#include <string>

namespace unravel::tool {

namespace {

// What smaller problems take is lost among what the program keeps from earlier ones.
constexpr double least_particles = 5000;

double resident() {
    std::ifstream file("/proc/self/statm");
    double size = 0, pages = 0;
    file >> size >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double highest() {
    std::ifstream file("/proc/self/status");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
    }
    return 0;
}

// What is used of them: what is set aside besides is never touched, so that it takes no memory.
template <typename... T, typename... A>
double bytes(const std::vector<T, A>&... arrays) {
    return (0.0 + ... + static_cast<double>(arrays.size() * sizeof(T)));
}
// Share of the rows that are solved as such: only those are ever written in arrays over rows.
double row_share(const System& system, const Components& components) {
    if (system.elsewhere.empty() || system.rows() == 0) return 1;
    double away = 0;
    for (std::size_t c = 0; c < components.count(); ++c) away += system.elsewhere[c] ? components.size(c) : 0;
    return 1 - away / static_cast<double>(system.rows());
}
template <typename... T>
requires(std::same_as<T, Coefficients>&&...) double bytes(const T&... of) {
    return (0.0 + ... + static_cast<double>(of.bytes()));
}
double bytes(const ExtensionSprings& s) {
    return bytes(s.i, s.j) + bytes(s.rest, s.stiffness, s.damping);
}
double bytes(const ExtensionForces& f) {
    return bytes(f.force, f.direction, f.transverse, f.state);
}
double bytes(const ClothState& s) {
    return bytes(s.x, s.v, s.dv, s.contacts, s.x_previous, s.v_previous);
}
double bytes(const GridSolves& solves) {
    double sum = bytes(solves.plan.elsewhere, solves.touched);
    for (const auto& grid : solves.grids) {
        const GridSystem& s = grid->system;
        sum += bytes(s.couplings, s.mass, s.D, s.P, s.active, s.slot, s.directions, s.b, s.x);
    }
    return sum;
}
double bytes_of_cg(const GridSolves& solves) {
    double sum = 0;
    for (const auto& grid : solves.grids) {
        const GridCgWorkspace& cg = grid->cg;
        sum += bytes(cg.r, cg.z, cg.q, cg.d, cg.p[0], cg.p[1], cg.dots);
    }
    return sum;
}

}  // namespace

MemoryWatch::MemoryWatch() {
    malloc_trim(0);
    std::ofstream file("/proc/self/clear_refs");
    file << "5" << std::flush;
    forgot_ = static_cast<bool>(file);
    before_ = resident();
}

double MemoryWatch::peak() const {
    return (forgot_ ? highest() : resident()) - before_;
}

MemoryRecord account_memory(const Simulation& simulation, double peak) {
    const ClothModel& m = simulation.model;
    const StepWorkspace& w = simulation.ws;
    const double n = static_cast<double>(m.size());
    MemoryRecord record;
    double named = 0;
    const auto add = [&](const char* name, double size) {
        if (size == 0) return;
        named += size;
        record.arrays.emplace_back(name, size / n);
    };
    add("stretch and shear springs", bytes(m.springs));
    add("bend springs", bytes(m.bends.i, m.bends.j) + bytes(m.bends.rest, m.bends.stiffness, m.bends.slope));
    add("whose springs: adjacency",
        static_cast<double>(m.spring_adjacency.bytes() + w.bend_adjacency.bytes()));
    add("air's cells", bytes(w.air_cells.corners, w.air_cells.start, w.air_cells.cells));
    add("mass", bytes(m.mass));
    add("state, and the one before", bytes(simulation.state) + bytes(w.before));
    add("stage: x~, v~, x*, v*",
        bytes(w.stage.own.x, w.stage.own.v, w.stage.own.x_at, w.stage.own.v_at, w.stage.x_linear));
    add("forces along rows", static_cast<double>(w.rows.bytes()));
    add("forces of stretch and shear", bytes(w.extension));
    add("forces of bending and its limit", bytes(w.bend) + bytes(w.bend_limit.slope, w.bend_limit.crossing) +
                                               bytes(w.implicit_bend.springs) +
                                               bytes(w.implicit_bend.forces));
    add("forces of air", bytes(w.air));
    add("base, drift, impulse and other vectors",
        bytes(w.ahead, w.drift_from_start, w.corrected, w.inertia, w.v_constrained, w.impulse, w.drift, w.guess, w.dv,
              w.reaction, w.taut));
    add("self-collision", bytes(w.self.springs) + bytes(w.self.forces) +
                              static_cast<double>(w.self.adjacency.bytes()) +
                              bytes(w.self.candidate_i, w.self.candidate_j, w.self.x_searched,
                                    w.self.voxel_start, w.self.voxel_particles, w.self.voxel_of));
    add("components", bytes(w.parent, w.components.label, w.components.order, w.components.start));
    const double by_rows = row_share(w.system, w.components);
    add("system by rows: A, b", bytes(w.system.row_of, w.system.start, w.system.entries, w.system.elsewhere) +
                                    by_rows * bytes(w.system.diagonal, w.system.b));
    add("solver by rows", bytes(w.solve.x, w.solve.constraint) +
                              by_rows * (bytes(w.solve.preconditioner.inverse, w.solve.stopping.inverse) +
                                         bytes(w.solve.r, w.solve.p, w.solve.q)));
    add("systems on the grid", bytes(w.grid_solves));
    add("their CG vectors", bytes_of_cg(w.grid_solves));
    add("measuring", bytes(w.measure.strain, w.measure.partials));
    if (n < least_particles) return record;
    record.peak = peak / n;
    record.arrays.emplace_back("rest", (peak - named) / n);
    return record;
}

}  // namespace unravel::tool
