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
    double sum = bytes(solves.plan.elsewhere, solves.beyond);
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
    add("curvature stencils", static_cast<double>(m.curvature.bytes()));
    const ForceMemory& f = w.forces.memory;
    const LinearStage& l = w.linear;
    add("whose springs: adjacency",
        static_cast<double>(m.spring_adjacency.bytes() + f.bending.adjacency.bytes() +
                            f.bending.parts.bytes()));
    add("air's cells", bytes(f.air.cells.corners, f.air.cells.start, f.air.cells.cells));
    add("mass", bytes(m.mass));
    add("state, and the one before", bytes(simulation.state) + bytes(w.before));
    add("stage: x~, v~, x*, v*",
        bytes(w.stage.own.x, w.stage.own.v, w.stage.own.x_at, w.stage.own.v_at, w.stage.x_linear));
    add("forces along rows", static_cast<double>(w.forces.rows.bytes()));
    add("forces of stretch and shear", bytes(f.springs));
    add("forces of bending and its limit",
        bytes(f.bending.force) + bytes(f.bending.limit.slope, f.bending.limit.crossing) +
            bytes(f.bending.implicit.springs) + bytes(f.bending.implicit.forces) +
            bytes(f.bending.split.is_implicit, f.bending.split.implicit, f.bending.pull) +
            bytes(f.bending.unlimited.slope, f.bending.unlimited.crossing));
    add("forces of air", bytes(f.air.force));
    add("forces, drift, impulse and other vectors",
        bytes(w.forces.pushes, w.forces.sum, w.forces.taut, w.forces.ahead, w.contact.corrected,
              w.contact.inertia, w.contact.reactions.impulse, w.contact.reactions.velocity,
              w.contact.reactions.block, l.impulse, l.drift, l.drift_from_start, l.predicted, l.guess, l.dv));
    add("stitches", bytes(f.stitches.springs) + bytes(f.stitches.forces) +
                        static_cast<double>(f.stitches.adjacency.bytes()));
    const SelfCollisionWorkspace& c = f.self_collision;
    add("self-collision", bytes(c.springs) + bytes(c.forces) + static_cast<double>(c.adjacency.bytes()) +
                              bytes(c.pairs, c.x_searched, c.voxel_start, c.voxel_particles, c.voxel_of,
                                    c.groups.key, c.groups.room));
    add("components", bytes(l.parent, l.components.label, l.components.order, l.components.start));
    const double by_rows = row_share(l.system, l.components);
    const System& A = l.system;
    add("system by rows: A, b", bytes(A.row_of, A.start, A.entries, A.block_start, A.blocks, A.elsewhere) +
                                    bytes(A.stencils_of.start, A.stencils_of.entries, A.stencils_of.columns) +
                                    by_rows * bytes(A.diagonal, A.b));
    add("solver by rows", bytes(l.solve.x, l.solve.constraint) +
                              by_rows * (bytes(l.solve.constrained_blocks.inverse, l.solve.blocks.inverse) +
                                         bytes(l.solve.r, l.solve.p, l.solve.q)));
    add("systems on the grid", bytes(l.grids));
    add("their CG vectors", bytes_of_cg(l.grids));
    add("measuring", bytes(w.measure.strain, w.measure.partials));
    if (n < least_particles) return record;
    record.peak = peak / n;
    record.arrays.emplace_back("rest", (peak - named) / n);
    return record;
}

}  // namespace unravel::tool
