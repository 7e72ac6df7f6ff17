#include "sim/solve.hpp"

#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>

namespace unravel {

namespace {

bool is_swept(Preconditioner kind) {
    return kind == Preconditioner::ssor || kind == Preconditioner::ic0;
}

// What stands in for preconditioners that need a grid.
Preconditioner on_rows(Preconditioner kind) {
    const bool needs_grid = kind == Preconditioner::automatic || kind == Preconditioner::stencil_block ||
                            kind == Preconditioner::multigrid;
    return needs_grid ? Preconditioner::constrained_block : kind;
}

// The rows of one component and the vectors over them.
struct Rows {
    const System& A;
    SolveWorkspace& ws;
    std::uint32_t begin, end;
    double* partials;        // one per chunk of these rows, nobody else's
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
    // q = P⁻¹ r; returns r·q
    const auto precondition = [&] {
        if (swept) {
            sweep(rows.ws.sweeps, rows.begin, rows.end, r, q);
        } else {
            rows.each([&](std::uint32_t row) { q[row] = P[row] * r[row]; });
        }
        return rows.sum([&](std::uint32_t row) { return r[row].dot(q[row]); });
    };
    const auto residual_at = [&](std::uint32_t row) { return r[row]; };
    double rho = precondition();
    rows.each([&](std::uint32_t row) { p[row] = q[row]; });
    double residual = rows.separate_stopping ? rows.measure(residual_at) : rho;

    while (residual > target && result.iterations < static_cast<std::uint32_t>(options.max_iterations)) {
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
        if (swept) rows.each(advance);
        const double rho_next = swept ? precondition() : rows.sum([&](std::uint32_t row) {
            advance(row);
            q[row] = P[row] * r[row];
            return r[row].dot(q[row]);
        });
        const double beta = rho_next / rho;
        rho = rho_next;
        rows.each([&](std::uint32_t row) { p[row] = q[row] + beta * p[row]; });
        residual = rows.separate_stopping ? rows.measure(residual_at) : rho;
    }
    result.converged = residual <= target;
    result.residual = target > 0 ? options.tolerance * std::sqrt(std::max(residual, 0.0) / target) : 0.0;
    return result;
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

    // A component of k chunks may straddle one more; numbering the large ones keeps their partials apart.
    std::size_t large_count = 0;
    for (std::size_t c = 0; c < components.count(); ++c) large_count += components.size(c) > chunk_size;
    ws.partials.resize(chunk_count(n) + large_count);
    const auto run = [&](std::size_t c, double* partials) {
        const Rows rows{A, ws, components.start[c], components.start[c + 1], partials, separate};
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

}  // namespace unravel
