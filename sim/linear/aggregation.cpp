#include "sim/linear/aggregation.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace unravel::sim {

namespace {

constexpr std::int32_t free_row = -1, absent_row = -2;
// Sweeps on the last level besides the first, when no coarser one follows.
constexpr int coarsest_aggregate_sweeps = 3;
// A level of no more rows is the last.
constexpr std::uint32_t coarsest_rows = 32;

Block3 block_of(const Mat3& M) {
    const auto column = [&](int c) {
        return Float4(static_cast<float>(M(0, c)), static_cast<float>(M(1, c)), static_cast<float>(M(2, c)),
                      0.0f);
    };
    return {column(0), column(1), column(2)};
}

Mat3 matrix_of(const Block3& B) {
    Mat3 M;
    M.col(0) = B.x.head<3>().matrix().cast<double>();
    M.col(1) = B.y.head<3>().matrix().cast<double>();
    M.col(2) = B.z.head<3>().matrix().cast<double>();
    return M;
}

// Not below B nor −B, for B of any sign: diagonally dominant with either.
Block3 bound_of(const Block3& B) {
    Block3 bound;
    bound.x[0] = B.x.head<3>().abs().sum();
    bound.y[1] = B.y.head<3>().abs().sum();
    bound.z[2] = B.z.head<3>().abs().sum();
    return bound;
}

// Positive definite, by its leading minors.
bool is_definite(const Block3& B) {
    const float minor = B.x[0] * B.y[1] - B.y[0] * B.x[1];
    const float det = B.z[0] * (B.x[1] * B.y[2] - B.x[2] * B.y[1]) -
                      B.z[1] * (B.x[0] * B.y[2] - B.x[2] * B.y[0]) + B.z[2] * minor;
    return B.x[0] > 0 && minor > 0 && det > 0;
}

// E = D − θ T with the largest θ that is safe; the last always is but for rounding: T ≤ D.
Block3 pivot_of(const Block3& D, const Block3& T) {
    for (const float theta : {0.85f, 2.0f / 3, 0.5f, 1.0f / 3}) {
        Block3 bound = D;
        if (is_definite(bound.add(-3 * theta, T))) {
            Block3 E = D;
            return E.add(-theta, T);
        }
    }
    return D;
}

// (S (E) S + c (I − S))⁻¹ in the free directions.
Block3 inverse_of(const Block3& E, const Block3* filter) {
    Mat3 M = matrix_of(E);
    M = 0.5 * (M + M.transpose()).eval();
    if (!(M.trace() > 0)) return {};
    if (!filter) return block_of(M.inverse());
    const Mat3 S = matrix_of(*filter);
    const Mat3 bordered = S * M * S + M.trace() / 3.0 * (Mat3::Identity() - S);
    return block_of(S * bordered.inverse() * S);
}

// The smoother: E⁻¹ of all rows in the order of elimination. filter(i): null where row i is free.
template <typename Level, typename Filter>
void factorise(Level& level, const Filter& filter) {
    for (const std::uint32_t kind : {0u, 1u}) {
        level.pieces.each(kind, [&](std::uint32_t begin, std::uint32_t end) {
            for (std::uint32_t i = begin; i < end; ++i) {
                const auto& row = level.rows[i];
                Block3 T, D = level.D[i];
                for (std::uint32_t e = row.begin; e < row.upper; ++e)
                    T += level.coupling[e].around(level.inverse[level.column[e]]);
                for (std::uint32_t e = row.apart; e < row.end; ++e) {
                    const Block3 B = level.coupling[e].block();
                    D += level.any_sign ? bound_of(B) : B;
                }
                level.inverse[i] = inverse_of(row.begin == row.upper ? D : pivot_of(D, T), filter(i));
            }
        });
    }
}

// Pᵀ A P: rows of `coarse`, of couplings between rows that `absent` does not name.
template <typename Level, typename Absent>
void coarsen(const Level& fine, AggregationLevel<Block3>& coarse, std::uint32_t n, const Absent& absent) {
    // An aggregate has at most as many couplings as its members have, so that all can be summed at once.
    coarse.resize(n, fine.column.size());
    coarse.any_sign = fine.any_sign;
    std::uint32_t place = 0;
    for (std::uint32_t I = 0; I < n; ++I) {
        coarse.rows[I].begin = place;
        for (std::uint32_t k = fine.first_member[I]; k < fine.first_member[I + 1]; ++k)
            place += fine.rows[fine.member[k]].end - fine.rows[fine.member[k]].begin;
    }
    coarse.pieces.all([&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t I = begin; I < end; ++I) {
            RowOfBlocks row(coarse, I);
            Block3 own;
            for (std::uint32_t k = fine.first_member[I]; k < fine.first_member[I + 1]; ++k) {
                const std::uint32_t i = fine.member[k];
                if (absent(i)) continue;
                own += fine.own[i];
                for (std::uint32_t e = fine.rows[i].begin; e < fine.rows[i].end; ++e) {
                    const std::uint32_t j = fine.column[e], J = fine.parent[j];
                    if (!absent(j) && J != I) row.add(J, fine.coupling[e].block());
                }
            }
            Block3 D = own;
            for (std::uint32_t e = coarse.rows[I].begin; e < row.end(); ++e) D += coarse.coupling[e];
            row.order();
            coarse.own[I] = own;
            coarse.D[I] = D;
        }
    });
}

// Which rows of the next level there are, in the order of their first members, and whose members are whose.
template <typename Level>
void gather(const std::vector<std::uint32_t>& parent_of_node, std::size_t nodes,
            std::vector<std::uint32_t>& found, Level& level, std::vector<std::uint32_t>& next) {
    found.assign(nodes, Aggregates::none);
    next.clear();
    level.parent.resize(level.node.size());
    for (std::size_t i = 0; i < level.node.size(); ++i) {
        const std::uint32_t node = parent_of_node[level.node[i]];
        if (found[node] == Aggregates::none) {
            found[node] = static_cast<std::uint32_t>(next.size());
            next.push_back(node);
        }
        level.parent[i] = found[node];
    }
    level.first_member.assign(next.size() + 2, 0);
    for (const std::uint32_t I : level.parent) ++level.first_member[I + 2];
    for (std::size_t I = 0; I < next.size(); ++I) level.first_member[I + 2] += level.first_member[I + 1];
    level.member.resize(level.parent.size());
    for (std::uint32_t i = 0; i < level.parent.size(); ++i)
        level.member[level.first_member[level.parent[i] + 1]++] = i;
    level.first_member.pop_back();
}

}  // namespace

Float4 Aggregation::filtered(std::uint32_t i, const Float4& y) const {
    const std::int32_t f = filter_[i];
    if (f == free_row) return y;
    return f == absent_row ? Float4::Zero().eval() : filters_[static_cast<std::size_t>(f)].times(y);
}

template <typename Finest>
void Aggregation::place(const System& A, const Components& components, std::size_t c,
                        const Aggregates& aggregates, Finest& finest) {
    begin_ = components.start[c];
    const std::uint32_t n = components.size(c);
    const auto first = components.order.begin() + begin_;
    const bool same = particles_.size() == n && std::equal(particles_.begin(), particles_.end(), first);
    if (same && finest.node.size() == n) return;
    particles_.assign(first, first + n);
    row_.clear();
    at_.resize(n);
    springs_.node.clear();
    general_.node.clear();
    for (std::uint32_t k = 0; k < aggregates.order.size(); ++k) {
        const std::uint32_t p = aggregates.order[k];
        if (components.label[p] != static_cast<std::int32_t>(c)) continue;
        const std::uint32_t row = A.row_of[p] - begin_;
        at_[row] = static_cast<std::uint32_t>(row_.size());
        row_.push_back(row);
        finest.node.push_back(k);
    }
    depth_ = 0;
    std::size_t rows = n;
    for (std::size_t level = 0; level < aggregates.parent.size() && rows > coarsest_rows; ++level) {
        if (coarse_.size() == depth_) coarse_.emplace_back();
        const std::vector<std::uint32_t>& parent = aggregates.parent[level];
        const std::size_t nodes = level + 1 < aggregates.parent.size()
                                      ? aggregates.parent[level + 1].size()
                                      : *std::max_element(parent.begin(), parent.end()) + 1;
        std::vector<std::uint32_t>& next = coarse_[depth_].node;
        if (level == 0) {
            gather(parent, nodes, found_, finest, next);
        } else {
            gather(parent, nodes, found_, coarse_[depth_ - 1], next);
        }
        rows = next.size();
        ++depth_;
    }
}

void Aggregation::load_row(const System& A, std::uint32_t r, std::uint32_t i, Fine& level) const {
    auto& row = level.rows[i];
    std::array<std::uint32_t, 3> place_of{};  // by relation: how many, then where the next one goes
    const auto each = [&](const auto& f) {
        for (std::uint32_t e = A.start[r]; e < A.start[r + 1]; ++e)
            f(A.entries[e], at_[A.entries[e].column - begin_]);
    };
    each([&](const System::Entry&, std::uint32_t j) { ++place_of[level.pieces.relation(i, j)]; });
    row.upper = row.begin + place_of[Pieces::lower];
    row.apart = row.upper + place_of[Pieces::upper];
    row.end = row.apart + place_of[Pieces::apart];
    place_of = {row.begin, row.upper, row.apart};
    each([&](const System::Entry& entry, std::uint32_t j) {
        const std::uint32_t place = place_of[level.pieces.relation(i, j)]++;
        level.column[place] = j;
        level.coupling[place] = {{static_cast<float>(entry.w.x()), static_cast<float>(entry.w.y()),
                                  static_cast<float>(entry.w.z()), static_cast<float>(entry.a)}};
    });
}

void Aggregation::load_row(const System& A, std::uint32_t r, std::uint32_t i, Coarse& level) const {
    RowOfBlocks row(level, i);
    for (std::uint32_t e = A.start[r]; e < A.start[r + 1]; ++e) {
        const System::Entry& entry = A.entries[e];
        row.add(at_[entry.column - begin_],
                block_of(entry.a * Mat3::Identity() + entry.w * entry.w.transpose()));
    }
    for (const System::Block& block : A.blocks_of(r))
        row.add(at_[block.column - begin_], block_of(-block.K.matrix()));
    row.order();
}

template <typename Level>
void Aggregation::load(const System& A, std::span<const Constraint* const> constraint, Level& level) {
    const auto n = static_cast<std::uint32_t>(row_.size());
    const auto couplings = [&](std::uint32_t row) {
        return A.start[row + 1] - A.start[row] + static_cast<std::uint32_t>(A.blocks_of(row).size());
    };
    std::uint32_t place = 0;
    for (std::uint32_t row = begin_; row < begin_ + n; ++row) place += couplings(row);
    level.resize(n, place);
    level.any_sign = of_stencils_;
    filter_.resize(n);
    filters_.clear();
    place = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t row = begin_ + row_[i];
        level.rows[i].begin = place;
        place += couplings(row);
        const Constraint* const held = constraint[row];
        filter_[i] = !held             ? free_row
                     : held->free == 0 ? absent_row
                                       : static_cast<std::int32_t>(filters_.size());
        if (held && held->free > 0) filters_.push_back(block_of(held->S));
    }
    const auto is_absent = [&](std::uint32_t column) { return filter_[at_[column - begin_]] == absent_row; };
    level.pieces.all([&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t r = begin_ + row_[i];
            Mat3 own = A.diagonal[r];
            for (std::uint32_t e = A.start[r]; e < A.start[r + 1]; ++e) {
                const System::Entry& entry = A.entries[e];
                if (is_absent(entry.column)) continue;
                own.noalias() -= entry.w * entry.w.transpose();
                own.diagonal().array() -= entry.a;
            }
            for (const System::Block& block : A.blocks_of(r)) {
                if (!is_absent(block.column)) own += block.K.matrix();
            }
            load_row(A, r, i, level);
            if (filter_[i] >= 0) own += 2 * A.diagonal[r].trace() * (Mat3::Identity() - constraint[r]->S);
            level.own[i] = block_of(own);
            level.D[i] = block_of(A.diagonal[r]);
        }
    });
}

template <typename Finest>
void Aggregation::build_on(Finest& finest, const System& A, const Components& components, std::size_t c,
                           const Aggregates& aggregates, std::span<const Constraint* const> constraint) {
    place(A, components, c, aggregates, finest);
    load(A, constraint, finest);
    static const Block3 nothing;
    factorise(finest, [&](std::uint32_t i) -> const Block3* {
        const std::int32_t f = filter_[i];
        if (f == free_row) return nullptr;
        return f == absent_row ? &nothing : &filters_[static_cast<std::size_t>(f)];
    });
    const auto no_filter = [](std::uint32_t) -> const Block3* { return nullptr; };
    for (std::size_t k = 0; k < depth_; ++k) {
        Coarse& coarse = coarse_[k];
        const auto rows = static_cast<std::uint32_t>(coarse.node.size());
        if (k == 0) {
            coarsen(finest, coarse, rows, [&](std::uint32_t i) { return filter_[i] == absent_row; });
        } else {
            coarsen(coarse_[k - 1], coarse, rows, [](std::uint32_t) { return false; });
        }
        factorise(coarse, no_filter);
    }
}

void Aggregation::build(const System& A, const Components& components, std::size_t c,
                        const Aggregates& aggregates, std::span<const Constraint* const> constraint) {
    of_stencils_ = A.has_blocks(components.start[c], components.start[c + 1]);
    if (of_stencils_) {
        build_on(general_, A, components, c, aggregates, constraint);
    } else {
        build_on(springs_, A, components, c, aggregates, constraint);
    }
}

template <typename Level>
void Aggregation::cycle(Level& level, std::size_t depth) {
    level.relax();
    if (depth == depth_) {
        for (int k = 0; k < coarsest_aggregate_sweeps; ++k) level.correct();
        return;
    }
    const auto filter = [&](std::uint32_t i, const Float4& y) { return depth == 0 ? filtered(i, y) : y; };
    Coarse& coarse = coarse_[depth];
    coarse.pieces.all([&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t I = begin; I < end; ++I) {
            Float4 sum = Float4::Zero();
            for (std::uint32_t k = level.first_member[I]; k < level.first_member[I + 1]; ++k)
                sum += filter(level.member[k], level.defect(level.member[k]));
            sum[3] = 0;
            coarse.r[I] = sum;
        }
    });
    cycle(coarse, depth + 1);
    level.pieces.all([&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) level.z[i] += filter(i, coarse.z[level.parent[i]]);
    });
    level.correct();
}

template <typename Finest>
void Aggregation::apply_on(Finest& finest, std::span<const Vec3> r, std::span<Vec3> z) {
    finest.pieces.all([&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Vec3& y = r[begin_ + row_[i]];
            finest.r[i] = {static_cast<float>(y.x()), static_cast<float>(y.y()), static_cast<float>(y.z()),
                           0.0f};
        }
    });
    cycle(finest, 0);
    finest.pieces.all([&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i)
            z[begin_ + row_[i]] = finest.z[i].template head<3>().matrix().template cast<double>();
    });
}

void Aggregation::apply(std::span<const Vec3> r, std::span<Vec3> z) {
    if (of_stencils_) {
        apply_on(general_, r, z);
    } else {
        apply_on(springs_, r, z);
    }
}

}  // namespace unravel::sim
