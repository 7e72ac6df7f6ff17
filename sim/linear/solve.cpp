#include "sim/linear/solve.hpp"

#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/linear/aggregation.hpp"

namespace unravel::sim {

namespace {

bool is_swept(Preconditioner kind) {
    return kind == Preconditioner::ssor || kind == Preconditioner::ic0;
}

// What stands in for preconditioners that need a grid, or many rows.
Preconditioner on_rows(Preconditioner kind) {
    const bool more = kind == Preconditioner::automatic || kind == Preconditioner::stencil_block ||
                      kind == Preconditioner::multigrid || kind == Preconditioner::aggregation;
    return more ? Preconditioner::constrained_block : kind;
}

// What solving a component by aggregation costs, set-up included, in iterations with the constrained block:
// from here on `automatic` begins with cycles.
constexpr std::uint32_t iterations_worth_cycles = 60;
// Iterations after which the constrained block gives way to cycles that nobody expected to pay, and cycles
// after which they give way.
constexpr std::uint32_t most_iterations = 150, most_aggregation_cycles = 60;
constexpr std::uint32_t ever = std::numeric_limits<std::uint32_t>::max();

// The rows of one component and the vectors over them.
struct Rows {
    const System& A;
    const Components& components;
    SolveWorkspace& ws;
    std::size_t component;
    std::uint32_t begin, end;
    double* partials;        // one per chunk of these rows, nobody else's
    bool chooses;            // cycles where they pay, rather than always
    bool separate_stopping;  // the preconditioner is not the one that the stopping rule measures with

    std::uint32_t count() const { return end - begin; }

    // Sum over rows of f(row), in chunk order.
    template <typename F>
    double sum(const F& f) const {
        const auto over = [&](std::uint32_t first, std::uint32_t last) {
            double partial = 0;
            for (std::uint32_t row = first; row < last; ++row) partial += f(row);
            return partial;
        };
        if (count() <= chunk_size) return over(begin, end);
        parallel_chunks(count(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
            partials[chunk] =
                over(begin + static_cast<std::uint32_t>(first), begin + static_cast<std::uint32_t>(last));
        });
        double total = 0;
        for (std::size_t chunk = 0; chunk < chunk_count(count()); ++chunk) total += partials[chunk];
        return total;
    }

    template <typename F>
    void each(const F& f) const {
        parallel_each(count(), [&](std::size_t k) { f(begin + static_cast<std::uint32_t>(k)); });
    }

    // ‖y‖² of y(row) in the stopping rule's norm.
    template <typename F>
    double measure(const F& y) const {
        const UntouchedVector<Mat3>& P = separate_stopping ? ws.stopping.inverse : ws.preconditioner.inverse;
        return sum([&](std::uint32_t row) {
            const Vec3 at = y(row);
            return at.dot(P[row] * at);
        });
    }
};

ComponentSolve solve_single(const Rows& rows, const Mat3& inverse) {
    const std::uint32_t row = rows.begin;
    // x holds (I − S) z already, S y has no say.
    rows.ws.x[row] += inverse * (rows.A.b[row] - rows.A.diagonal[row] * rows.ws.x[row]);
    return {1, 1, 0.0, true};
}

// Iterations with the constrained block grow with the distance that a spring's pull travels within a step, √κ
// springs, as long as the component is larger than that (fitted on grids: sim/step/solve_components.cpp).
// Here √κ is the mean over rows of a row's: its mean coupling over what of its diagonal is none. Rows beside
// held ones, of which that is no mass, hardly count.
bool pays_cycles(const Rows& rows) {
    const System& A = rows.A;
    const double reach = rows.sum([&](std::uint32_t row) {
        double coupled = 0, trace = 0;
        for (std::uint32_t e = A.start[row]; e < A.start[row + 1]; ++e) {
            const double ww = A.entries[e].w.squaredNorm();
            coupled += A.entries[e].a + ww;
            trace += 3 * A.entries[e].a + ww;
        }
        const double own = (A.diagonal[row].trace() - trace) / 3;
        const std::uint32_t count = A.start[row + 1] - A.start[row];
        return count > 0 && own > 0 ? std::sqrt(coupled / (count * own)) : 0.0;
    }) / rows.count();
    const double most = std::sqrt(static_cast<double>(rows.count()));
    return 6.0 * std::pow(std::min(reach, most), 0.75) > iterations_worth_cycles;
}

ComponentSolve solve_component(const Rows& rows, const SolveOptions& options) {
    const System& A = rows.A;
    std::vector<Vec3>& x = rows.ws.x;
    UntouchedVector<Vec3>&r = rows.ws.r, &p = rows.ws.p, &q = rows.ws.q;
    const UntouchedVector<Mat3>& P = rows.ws.preconditioner.inverse;
    const bool swept = is_swept(options.preconditioner);
    ComponentSolve result;

    // The constraint force that A x − b holds outside the free directions is no residual. P would take it
    // away, but to rounding only, and what is left outgrows a residual that has become small: so it never
    // gets in.
    const std::vector<const Constraint*>& constraint = rows.ws.constraint;
    const auto filtered = [&](std::uint32_t row, const Vec3& y) {
        return constraint[row] ? Vec3(constraint[row]->S * y) : y;
    };
    // Nor is it a right-hand side: P would take it away from b to rounding only, which may be below zero.
    const double target = options.tolerance * options.tolerance *
                          rows.measure([&](std::uint32_t row) { return filtered(row, A.b[row]); });
    rows.each([&](std::uint32_t row) { r[row] = filtered(row, A.b[row] - row_times(A, row, x)); });
    result.rvm = rows.count();
    const auto residual_at = [&](std::uint32_t row) { return r[row]; };

    Aggregation* const aggregation = rows.ws.aggregation_of[rows.component];
    const bool chooses = rows.chooses;
    bool cycles = aggregation && (!chooses || pays_cycles(rows));
    std::uint32_t until = !aggregation ? ever : cycles ? most_aggregation_cycles : most_iterations;
    bool built = false;
    // q = P⁻¹ r; returns r·q
    const auto precondition = [&] {
        if (cycles) {
            if (!built)
                aggregation->build(A, rows.components, rows.component, rows.ws.aggregates, constraint);
            built = true;
            aggregation->apply(r, q);
        } else if (swept) {
            sweep(rows.ws.sweeps, rows.begin, rows.end, r, q);
        } else {
            rows.each([&](std::uint32_t row) { q[row] = P[row] * r[row]; });
        }
        return rows.sum([&](std::uint32_t row) { return r[row].dot(q[row]); });
    };
    // ‖r‖² in the stopping rule's norm; rho where that is r·q
    const auto measured = [&](double rho) {
        return rows.separate_stopping || cycles ? rows.measure(residual_at) : rho;
    };
    // The first direction: from the start, or when another preconditioner takes over.
    const auto begin = [&] {
        const double rho = precondition();
        rows.each([&](std::uint32_t row) { p[row] = q[row]; });
        return rho;
    };
    double residual = rows.measure(residual_at), rho = residual > target ? begin() : 0.0;

    while (residual > target && result.iterations < static_cast<std::uint32_t>(options.max_iterations)) {
        heed(options.stop);
        // Rounding may leave single precision without a direction to go.
        if (result.iterations >= until || (cycles && !(rho > 0))) {
            until = ever;
            cycles = !cycles;
            rho = begin();
        }
        const double curvature = rows.sum([&](std::uint32_t row) {
            q[row] = row_times(A, row, p);
            return p[row].dot(q[row]);
        });
        ++result.iterations;
        result.rvm += rows.count();
        // Zero curvature: p is zero to rounding, nothing further can be gained.
        if (!(curvature > 0)) break;
        const double alpha = rho / curvature;
        const auto advance = [&](std::uint32_t row) {
            x[row] += alpha * p[row];
            r[row] = filtered(row, r[row] - alpha * q[row]);
        };
        const bool apart = swept || cycles;
        if (apart) rows.each(advance);
        if (cycles) {
            residual = measured(rho);
            if (!(residual > target)) break;
        }
        const double rho_next = apart ? precondition() : rows.sum([&](std::uint32_t row) {
            advance(row);
            q[row] = P[row] * r[row];
            return r[row].dot(q[row]);
        });
        const double beta = rho_next / rho;
        rho = rho_next;
        rows.each([&](std::uint32_t row) { p[row] = q[row] + beta * p[row]; });
        if (!cycles) residual = measured(rho);
    }
    result.converged = residual <= target;
    result.residual = target > 0 ? options.tolerance * std::sqrt(std::max(residual, 0.0) / target) : 0.0;
    return result;
}

// Which components may get cycles, and the memory for them.
void assign_aggregations(const System& A, const Components& components, Preconditioner kind,
                         SolveWorkspace& ws) {
    ws.aggregation_of.assign(components.count(), nullptr);
    if (ws.aggregates.particles() == 0) return;
    const std::uint32_t least = least_rows_of_aggregation(kind);
    std::size_t ordinal = 0;
    for (std::size_t c = 0; c < components.count(); ++c) {
        if (components.size(c) < least || (!A.elsewhere.empty() && A.elsewhere[c] != 0)) continue;
        if (ws.aggregations.size() == ordinal) ws.aggregations.push_back(std::make_shared<Aggregation>());
        ws.aggregation_of[c] = ws.aggregations[ordinal++].get();
    }
}

}  // namespace

void solve(const System& A, const Components& components, const Constraints& constraints,
           std::span<const Vec3> guess, const SolveOptions& asked, SolveWorkspace& ws,
           std::vector<ComponentSolve>& out) {
    SolveOptions options = asked;
    options.preconditioner = on_rows(asked.preconditioner);
    const std::size_t n = A.rows();
    ws.x.resize(n);
    ws.r.resize(n);
    ws.p.resize(n);
    ws.q.resize(n);
    ws.constraint.resize(n);
    const bool separate = options.preconditioner != Preconditioner::constrained_block;
    build_preconditioner(options.preconditioner, A, components, constraints, ws.preconditioner);
    if (separate)
        build_preconditioner(Preconditioner::constrained_block, A, components, constraints, ws.stopping);
    if (is_swept(options.preconditioner)) build_sweeps(A, components, constraints, ws.stopping, ws.sweeps);

    out.assign(components.count(), {});
    const auto component_size_one = [&](std::uint32_t row) {
        const std::int32_t c = components.label[components.order[row]];
        return c >= 0 && components.size(static_cast<std::size_t>(c)) == 1;
    };
    parallel_each(n, [&](std::size_t r) {
        const std::uint32_t particle = components.order[r];
        const Constraint* c = constraints.find(particle);
        const Vec3 y =
            component_size_one(static_cast<std::uint32_t>(r)) ? Vec3::Zero().eval() : guess[particle];
        ws.constraint[r] = c;
        ws.x[r] = c ? Vec3(c->S * y + (c->z - c->S * c->z)) : y;
    });

    assign_aggregations(A, components, asked.preconditioner, ws);
    // A component of k chunks may straddle one more; numbering the large ones keeps their partials apart.
    std::size_t large_count = 0;
    for (std::size_t c = 0; c < components.count(); ++c) large_count += components.size(c) > chunk_size;
    ws.partials.resize(chunk_count(n) + large_count);
    const auto run = [&](std::size_t c, double* partials) {
        const Rows rows{A,
                        components,
                        ws,
                        c,
                        components.start[c],
                        components.start[c + 1],
                        partials,
                        asked.preconditioner == Preconditioner::automatic,
                        separate};
        if (options.preconditioner == Preconditioner::ic0 && rows.count() > 1)
            factorise(A, components, constraints, rows.begin, rows.end, ws.sweeps);
        out[c] = rows.count() == 1
                     ? solve_single(rows, (separate ? ws.stopping : ws.preconditioner).inverse[rows.begin])
                     : solve_component(rows, options);
    };
    // Components of many chunks go first, so that the small ones fill the gaps that they leave.
    tbb::task_group large;
    const auto ours = [&](std::size_t c) { return A.elsewhere.empty() || A.elsewhere[c] == 0; };
    for (std::size_t c = 0, ordinal = 0; c < components.count(); ++c) {
        if (components.size(c) <= chunk_size) continue;
        if (!ours(c)) {
            ++ordinal;
            continue;
        }
        double* const partials = ws.partials.data() + components.start[c] / chunk_size + ordinal++;
        large.run([&run, c, partials] { run(c, partials); });
    }
    tbb::parallel_for(std::size_t{0}, components.count(), [&](std::size_t c) {
        if (components.size(c) <= chunk_size && ours(c)) run(c, nullptr);
    });
    large.wait();
}

}  // namespace unravel::sim
