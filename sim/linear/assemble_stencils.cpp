#include "sim/linear/assemble_stencils.hpp"

#include <algorithm>
#include <utility>

namespace unravel::sim {

namespace {

// f(entry, particle) for each wanted particle that has a part in an implicit stencil, in order. Of an empty
// `wanted` (particles) all are.
template <typename F>
void each_part(std::span<const Stencils> lists, std::span<const std::uint8_t> wanted, const F& f) {
    for (std::uint32_t list = 0; list < lists.size(); ++list) {
        for (std::uint32_t s = 0; s < lists[list].list.size(); ++s) {
            if (!lists[list].is_implicit(s)) continue;
            const Stencil& stencil = lists[list].list[s];
            for (std::uint32_t slot = 0; slot < stencil.count; ++slot) {
                const std::uint32_t p = stencil.p[slot];
                if (stencil.w[slot] != 0 && (wanted.empty() || wanted[p] != 0))
                    f(StencilIndex::Entry{list, s, slot}, p);
            }
        }
    }
}

void index_stencils(std::span<const Stencils> lists, std::size_t particles, StencilIndex& out) {
    out.start.assign(particles + 1, 0);
    each_part(lists, out.wanted, [&](const StencilIndex::Entry&, std::uint32_t p) { ++out.start[p]; });
    std::uint32_t place = 0;
    for (std::uint32_t& start : out.start) place += std::exchange(start, place);
    out.entries.resize(place);
    each_part(lists, out.wanted, [&](const StencilIndex::Entry& entry, std::uint32_t p) {
        out.entries[out.start[p]++] = entry;
    });
    // Dealing moved every start to the next one's.
    for (std::size_t p = particles; p > 0; --p) out.start[p] = out.start[p - 1];
    out.start[0] = 0;
}

// h² K + h D = a I + scale u uᵀ
struct StencilBlock {
    double a, scale;
    StencilBlock(const Stencil& s, double h)
        : a(h * (h * s.across + s.damping_across)), scale(h * (h * s.along + s.damping_along) - a) {}
};

}  // namespace

void assemble_stencils(std::span<const Stencils> lists, const Load& load, const Components& components,
                       const Constraints& constraints, double h, System& out) {
    out.blocks.clear();
    out.block_start.clear();
    if (lists.empty()) return;
    const std::size_t n = load.mass.size();
    const auto made = [&](std::size_t row, std::uint32_t p) {
        return solved_in(out, components, row) || constraints.find(p);
    };
    std::vector<std::uint8_t>& wanted = out.stencils_of.wanted;
    wanted.resize(out.elsewhere.empty() ? 0 : n);
    parallel_each(wanted.size(), [&](std::size_t row) {
        const std::uint32_t p = components.order[row];
        wanted[p] = made(row, p);
    });
    index_stencils(lists, n, out.stencils_of);
    const StencilIndex& index = out.stencils_of;
    if (index.entries.empty()) return;

    const std::uint32_t solved = components.start.back();
    const auto of = [&](std::uint32_t p) {
        return std::span(index.entries).subspan(index.start[p], index.start[p + 1] - index.start[p]);
    };
    const auto moved_to_b = [&](std::uint32_t row, std::uint32_t other) {
        return row < solved && out.row_of[other] >= solved;
    };
    // f(slot) for each other particle of an entry's stencil
    const auto each_other = [](const Stencil& stencil, std::uint32_t slot, const auto& f) {
        for (std::uint32_t other = 0; other < stencil.count; ++other) {
            if (other != slot && stencil.w[other] != 0) f(other);
        }
    };

    // The blocks of a row, each of its columns once and in order.
    constexpr std::uint32_t most_others = 3;
    std::vector<std::uint32_t>& columns = out.stencils_of.columns;
    columns.resize(most_others * index.entries.size());
    out.block_start.assign(n + 1, 0);
    parallel_each(n, [&](std::size_t r) {
        const auto row = static_cast<std::uint32_t>(r);
        const std::uint32_t p = components.order[row];
        if (!made(row, p)) return;
        std::uint32_t *const first = columns.data() + most_others * index.start[p], *last = first;
        for (const StencilIndex::Entry& entry : of(p)) {
            const Stencil& stencil = lists[entry.list].list[entry.stencil];
            each_other(stencil, entry.slot, [&](std::uint32_t other) {
                if (!moved_to_b(row, stencil.p[other])) *last++ = out.row_of[stencil.p[other]];
            });
        }
        std::sort(first, last);
        out.block_start[row + 1] = static_cast<std::uint32_t>(std::unique(first, last) - first);
    });
    for (std::size_t row = 0; row < n; ++row) out.block_start[row + 1] += out.block_start[row];
    out.blocks.resize(out.block_start[n]);

    parallel_each(n, [&](std::size_t r) {
        const auto row = static_cast<std::uint32_t>(r);
        const std::uint32_t p = components.order[row];
        if (of(p).empty() || !made(row, p)) return;
        System::Block* const first = out.blocks.data() + out.block_start[row];
        const std::uint32_t count = out.block_start[row + 1] - out.block_start[row];
        for (std::uint32_t k = 0; k < count; ++k) first[k] = {columns[most_others * index.start[p] + k], {}};
        Symmetric3 diagonal;
        Vec3 b = out.b[row];
        for (const auto& [list, number, slot] : of(p)) {
            const Stencil& s = lists[list].list[number];
            const std::span<const Vec3> drift = lists[list].drift.empty() ? load.drift : lists[list].drift;
            const StencilBlock B(s, h);
            const double w = s.w[slot];
            diagonal.add(w * w * B.a, w * w * B.scale, s.u);
            Vec3 g = Vec3::Zero();
            for (std::uint32_t k = 0; k < s.count; ++k) g += s.w[k] * drift[s.p[k]];
            b -= h * w * (s.across * g + (s.along - s.across) * s.u.dot(g) * s.u);
            each_other(s, slot, [&](std::uint32_t other) {
                const std::uint32_t q = s.p[other];
                const double ww = w * s.w[other];
                if (moved_to_b(row, q)) {
                    const Vec3& z = constraints.find(q)->z;
                    b -= ww * (B.a * z + B.scale * s.u.dot(z) * s.u);
                } else {
                    const auto at = std::lower_bound(first, first + count, out.row_of[q],
                                                     [](const System::Block& block, std::uint32_t column) {
                                                         return block.column < column;
                                                     });
                    at->K.add(ww * B.a, ww * B.scale, s.u);
                }
            });
        }
        out.diagonal[row] += diagonal.matrix();
        out.b[row] = b;
    });
}

}  // namespace unravel::sim
