#include "sim/linear/solve.hpp"

#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/linear/aggregation.hpp"
#include "sim/linear/conjugate_gradients.hpp"
#include "sim/linear/methods.hpp"

namespace unravel::sim {

namespace {

// Iterations after which the constrained block gives way to cycles that nobody expected to pay.
constexpr std::uint32_t most_iterations = 150;
constexpr std::uint32_t ever = std::numeric_limits<std::uint32_t>::max();

// Without the cycles by aggregation, which are for large components.
const PreconditionerMethod& method_on_rows(Preconditioner kind) {
    return method_of(kind == Preconditioner::aggregation ? Preconditioner::constrained_block : kind);
}

ComponentSolve solve_single(const ComponentRows& rows) {
    const std::uint32_t row = rows.begin;
    // x holds (I − S) z already, S y has no say.
    rows.ws.x[row] +=
        rows.ws.constrained_blocks.inverse[row] * (rows.A.b[row] - rows.A.diagonal[row] * rows.ws.x[row]);
    return {1, 1, 0.0, true, SolvedBy::block, SolveReason::one_row};
}

// Here the √κ of expected_iterations() is the mean over rows of a row's: its mean coupling over what of its
// diagonal is none. Rows beside held ones, of which that is no mass, hardly count.
bool pays_cycles(const ComponentRows& rows) {
    const System& A = rows.A;
    const double reach = rows.sum([&](std::uint32_t row) {
        double coupled = 0, trace = 0;
        for (std::uint32_t e = A.start[row]; e < A.start[row + 1]; ++e) {
            const double ww = A.entries[e].w.squaredNorm();
            coupled += A.entries[e].a + ww;
            trace += 3 * A.entries[e].a + ww;
        }
        const std::span<const System::Block> blocks = A.blocks_of(row);
        for (const System::Block& block : blocks) {
            coupled += std::abs(block.K.trace());
            trace -= block.K.trace();
        }
        const double own = (A.diagonal[row].trace() - trace) / 3;
        const std::size_t count = A.start[row + 1] - A.start[row] + blocks.size();
        return count > 0 && own > 0 ? std::sqrt(coupled / (static_cast<double>(count) * own)) : 0.0;
    }) / rows.count();
    return expected_iterations(reach, rows.count()) > iterations_worth_cycles;
}

// CG's problem on the rows of a component; its z and q are one vector, one after the other. The residual is
// measured with constrained blocks, which as preconditioner are applied while that is done.
class RowProblem {
public:
    explicit RowProblem(const ComponentRows& rows) : rows_(rows), P_(rows.ws.constrained_blocks.inverse) {}

    // Goes on with another preconditioner, which is built.
    void take(const PreconditionerMethod& method) {
        method_ = &method;
        measures_ = method.kind == Preconditioner::constrained_block;
        if (measures_) method.apply(rows_);
        if (measures_) rho_ = product();
    }
    // ‖Sb‖² and ‖r‖², r = S (b − A x)
    double right_side() const {
        // The constraint force that A x − b holds outside the free directions is no residual. P would take it
        // away, but to rounding only, and what is left outgrows a residual that has become small: so it never
        // gets in. Nor is it a right-hand side, where what is left may be below zero.
        return norm([&](std::uint32_t row) { return rows_.filtered(row, rows_.A.b[row]); });
    }
    double first_residual() {
        rows_.each([&](std::uint32_t row) {
            r_[row] = rows_.filtered(row, rows_.A.b[row] - row_times(rows_.A, row, x_));
        });
        return norm([&](std::uint32_t row) { return r_[row]; });
    }

    double precondition() {
        if (measures_) return rho_;
        method_->apply(rows_);
        return product();
    }
    double multiply(double beta) {
        rows_.each([&](std::uint32_t row) {
            if (beta == 0) {
                p_[row] = q_[row];
            } else {
                p_[row] = q_[row] + beta * p_[row];
            }
        });
        return rows_.sum([&](std::uint32_t row) {
            q_[row] = row_times(rows_.A, row, p_);
            return p_[row].dot(q_[row]);
        });
    }
    double measure(double alpha) {
        const auto advance = [&](std::uint32_t row) {
            x_[row] += alpha * p_[row];
            r_[row] = rows_.filtered(row, r_[row] - alpha * q_[row]);
        };
        if (!measures_) {
            return norm([&](std::uint32_t row) {
                advance(row);
                return r_[row];
            });
        }
        rho_ = rows_.sum([&](std::uint32_t row) {
            advance(row);
            q_[row] = P_[row] * r_[row];
            return r_[row].dot(q_[row]);
        });
        return rho_;
    }

private:
    double product() const {
        return rows_.sum([&](std::uint32_t row) { return r_[row].dot(q_[row]); });
    }
    // ‖y‖² of y(row) in the stopping rule's norm.
    template <typename F>
    double norm(const F& y) const {
        return rows_.sum([&](std::uint32_t row) {
            const Vec3 at = y(row);
            return at.dot(P_[row] * at);
        });
    }

    const ComponentRows& rows_;
    const UntouchedVector<Mat3>& P_;
    std::vector<Vec3>& x_ = rows_.ws.x;
    UntouchedVector<Vec3>&r_ = rows_.ws.r, &p_ = rows_.ws.p, &q_ = rows_.ws.q;
    const PreconditionerMethod* method_ = nullptr;
    bool measures_ = false;
    double rho_ = 0;  // r·z, where it was measured
};

ComponentSolve solve_component(const ComponentRows& rows, const SolveOptions& options) {
    RowProblem problem(rows);
    ComponentSolve result;
    const double target = options.tolerance * options.tolerance * problem.right_side();
    double residual = problem.first_residual();

    // The method, and the one that may take over from it, once.
    const PreconditionerMethod* method = &method_on_rows(options.preconditioner);
    const PreconditionerMethod* other = nullptr;
    std::uint32_t until = ever;
    const bool asked = options.preconditioner != Preconditioner::automatic;
    result.because = asked ? SolveReason::asked : SolveReason::few_rows;
    if (rows.ws.aggregation_of[rows.component]) {
        other = &method_of(Preconditioner::aggregation);
        until = most_iterations;
        if (options.preconditioner == Preconditioner::aggregation || pays_cycles(rows)) {
            std::swap(method, other);
            until = most_cycles_of_multigrid;
            if (!asked) result.because = SolveReason::many_expected;
        }
    }
    const auto limit = static_cast<std::uint32_t>(options.max_iterations);
    while (residual > target && result.iterations < limit) {
        if (method->build) method->build(rows);
        problem.take(*method);
        residual = conjugate_gradients(problem, residual, target, std::min(until, limit), result.iterations,
                                       options.stop);
        // Rounding may leave cycles, in single precision, without a direction to go.
        const bool gives_way = result.iterations >= until || method->kind == Preconditioner::aggregation;
        if (!other || !gives_way) break;
        std::swap(method, other);
        until = ever;
        result.because = SolveReason::took_over;
    }
    result.by = method->kind == Preconditioner::aggregation ? SolvedBy::aggregation : SolvedBy::rows;
    result.rvm = rows.count() * (1 + static_cast<std::uint64_t>(result.iterations));
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
           std::span<const Vec3> guess, const SolveOptions& options, SolveWorkspace& ws,
           std::vector<ComponentSolve>& out) {
    const std::size_t n = A.rows();
    ws.x.resize(n);
    ws.r.resize(n);
    ws.p.resize(n);
    ws.q.resize(n);
    ws.constraint.resize(n);
    build_preconditioner(Preconditioner::constrained_block, A, components, constraints,
                         ws.constrained_blocks);
    if (const auto build_all = method_on_rows(options.preconditioner).build_all)
        build_all(A, components, constraints, ws);

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

    assign_aggregations(A, components, options.preconditioner, ws);
    // A component of k chunks may straddle one more; numbering the large ones keeps their partials apart.
    std::size_t large_count = 0;
    for (std::size_t c = 0; c < components.count(); ++c) large_count += components.size(c) > chunk_size;
    ws.partials.resize(chunk_count(n) + large_count);
    const auto run = [&](std::size_t c, double* partials) {
        const ComponentRows rows{
            A, components, constraints, ws, c, components.start[c], components.start[c + 1], partials};
        out[c] = rows.count() == 1 ? solve_single(rows) : solve_component(rows, options);
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
