#include "sim/linear/methods.hpp"

#include <algorithm>
#include <iterator>

#include "sim/linear/aggregation.hpp"

namespace unravel::sim {

namespace {

template <Preconditioner kind>
void build_blocks(const System& A, const Components& components, const Constraints& constraints,
                  SolveWorkspace& ws) {
    build_preconditioner(kind, A, components, constraints, ws.blocks);
}

void apply_blocks_of(const BlockPreconditioner& P, const ComponentRows& rows) {
    rows.each([&](std::uint32_t row) { rows.ws.q[row] = P.inverse[row] * rows.ws.r[row]; });
}

void apply_constrained_blocks(const ComponentRows& rows) {
    apply_blocks_of(rows.ws.constrained_blocks, rows);
}

void apply_blocks(const ComponentRows& rows) {
    apply_blocks_of(rows.ws.blocks, rows);
}

void build_both_sweeps(const System& A, const Components& components, const Constraints& constraints,
                       SolveWorkspace& ws) {
    build_sweeps(A, components, constraints, ws.constrained_blocks, ws.sweeps);
}

void factorise_component(const ComponentRows& rows) {
    factorise(rows.A, rows.components, rows.constraints, rows.begin, rows.end, rows.ws.sweeps);
}

void apply_sweeps(const ComponentRows& rows) {
    sweep(rows.ws.sweeps, rows.begin, rows.end, rows.ws.r, rows.ws.q);
}

void build_cycles(const ComponentRows& rows) {
    rows.ws.aggregation_of[rows.component]->build(rows.A, rows.components, rows.component, rows.ws.aggregates,
                                                  rows.ws.constraint);
}

void apply_cycles(const ComponentRows& rows) {
    rows.ws.aggregation_of[rows.component]->apply(rows.ws.r, rows.ws.q);
}

// The first stands in for what is not in the list.
constexpr PreconditionerMethod methods[] = {
    {Preconditioner::constrained_block, nullptr, nullptr, apply_constrained_blocks},
    {Preconditioner::none, build_blocks<Preconditioner::none>, nullptr, apply_blocks},
    {Preconditioner::diagonal, build_blocks<Preconditioner::diagonal>, nullptr, apply_blocks},
    {Preconditioner::block, build_blocks<Preconditioner::block>, nullptr, apply_blocks},
    {Preconditioner::ssor, build_both_sweeps, nullptr, apply_sweeps},
    {Preconditioner::ic0, build_both_sweeps, factorise_component, apply_sweeps},
    {Preconditioner::aggregation, nullptr, build_cycles, apply_cycles},
};

}  // namespace

const PreconditionerMethod& method_of(Preconditioner kind) {
    const auto* const found = std::find_if(std::begin(methods), std::end(methods),
                                           [&](const PreconditionerMethod& m) { return m.kind == kind; });
    return found == std::end(methods) ? methods[0] : *found;
}

}  // namespace unravel::sim
