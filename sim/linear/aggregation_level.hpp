#pragma once

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace unravel::sim {

/// A vector of single precision in a machine vector; the fourth lane is zero where it is read as a vector.
using Float4 = Eigen::Array4f;

/// A symmetric 3 × 3 block by columns.
struct Block3 {
    Float4 x = Float4::Zero(), y = Float4::Zero(), z = Float4::Zero();
    Block3& operator+=(const Block3& o) {
        x += o.x;
        y += o.y;
        z += o.z;
        return *this;
    }
    Block3& add(float scale, const Block3& o) {
        x += scale * o.x;
        y += scale * o.y;
        z += scale * o.z;
        return *this;
    }
    Float4 times(const Float4& v) const { return x * v[0] + y * v[1] + z * v[2]; }
    float trace() const { return x[0] + y[1] + z[2]; }
    /// This block B between E: B E B.
    Block3 around(const Block3& E) const { return {times(E.times(x)), times(E.times(y)), times(E.times(z))}; }
    Block3 block() const { return *this; }
};

/// A spring's block B = a I + w wᵀ in one machine vector: w, and a in the fourth lane. times() leaves a
/// fourth lane without a meaning.
struct RankOneBlock {
    Float4 wa;
    Float4 times(const Float4& v) const { return wa * (wa * v).sum() + wa[3] * v; }
    Float4 w() const { return {wa[0], wa[1], wa[2], 0.0f}; }
    Block3 around(const Block3& E) const {
        const float a = wa[3];
        const Float4 w = this->w(), v = E.times(w);
        const float s = (w * v).sum();
        const auto column = [&](int c, const Float4& e) -> Float4 {
            return a * a * e + w * (a * v[c] + s * w[c]) + v * (a * w[c]);
        };
        return {column(0, E.x), column(1, E.y), column(2, E.z)};
    }
    Block3 block() const {
        const Float4 w = this->w();
        Block3 out{w * w[0], w * w[1], w * w[2]};
        out.x[0] += wa[3];
        out.y[1] += wa[3];
        out.z[2] += wa[3];
        return out;
    }
};

/// Rows of one level are cut into pieces; sweeps run over the even pieces, then over the odd ones, all of a
/// kind at once. So the order of elimination is: even pieces before odd ones, rows in order within a piece.
/// Couplings between two pieces of a kind stand apart from it.
struct Pieces {
    std::uint32_t rows = 0, size = 1, count = 0;
    int shift = 0;  ///< size is a power of two

    explicit Pieces(std::uint32_t n = 0) : rows(n) {
        const auto bits = [](std::uint32_t k) { return static_cast<int>(std::bit_width(k)); };
        shift = std::max(std::clamp(bits(n / 16), 9, 10), bits(n / 64));
        size = 1u << shift;
        count = (n + size - 1) >> shift;
    }
    enum Relation { lower = 0, upper = 1, apart = 2 };
    /// What `column` is to `row`: eliminated before it, after it, or neither.
    Relation relation(std::uint32_t row, std::uint32_t column) const {
        const std::uint32_t p = row >> shift, q = column >> shift;
        const bool before = p == q ? column < row : (q & 1) < (p & 1);
        const bool neither = p != q && ((p ^ q) & 1) == 0;
        return neither ? apart : before ? lower : upper;
    }
    /// f(begin, end) for all pieces of a kind (0: even, 1: odd), in parallel.
    template <typename F>
    void each(std::uint32_t kind, const F& f) const {
        const auto run = [&](std::uint32_t k) {
            const std::uint32_t begin = (2 * k + kind) * size;
            f(begin, std::min(begin + size, rows));
        };
        const std::uint32_t of_kind = (count + 1 - kind) / 2;
        if (of_kind == 1) return run(0);
        tbb::parallel_for(0u, of_kind, run);
    }
    /// f(begin, end) for all pieces, in parallel.
    template <typename F>
    void all(const F& f) const {
        const auto run = [&](std::uint32_t k) { f(k * size, std::min((k + 1) * size, rows)); };
        if (count == 1) return run(0);
        tbb::parallel_for(0u, count, run);
    }
};

/// One level's matrix, diagonal D less couplings B, and its smoother.
template <typename Coupling>
struct AggregationLevel {
    /// Couplings of a row: lower in [begin, upper), upper in [upper, apart), apart in [apart, end).
    struct Row {
        std::uint32_t begin, upper, apart, end;
    };
    Pieces pieces;
    bool any_sign = false;  ///< couplings need not be positive semidefinite
    std::vector<Row> rows;
    std::vector<std::uint32_t> column;
    std::vector<Coupling> coupling;
    std::vector<Block3> D;
    std::vector<Block3> own;      ///< what of D is no coupling: mass, and springs to what is held
    std::vector<Block3> inverse;  ///< E⁻¹, in the free directions
    std::vector<Float4> r, z, u;
    std::vector<std::uint32_t> node;    ///< (rows) which of the cloth's nodes of this level a row is
    std::vector<std::uint32_t> parent;  ///< (rows) row of the next level
    std::vector<std::uint32_t> first_member, member;  ///< (next level's rows + 1), (rows)

    std::uint32_t size() const { return pieces.rows; }
    /// Makes room for `n` rows and that many couplings; keeps its memory.
    void resize(std::uint32_t n, std::size_t couplings) {
        pieces = Pieces(n);
        rows.resize(n);
        D.resize(n);
        own.resize(n);
        inverse.resize(n);
        r.resize(n);
        z.resize(n);
        u.resize(n);
        if (column.size() < couplings) {
            column.resize(couplings);
            coupling.resize(couplings);
        }
    }
    template <typename Vector>
    Float4 sum(std::uint32_t begin, std::uint32_t end, const Vector& y) const {
        Float4 s = Float4::Zero();
        for (std::uint32_t e = begin; e < end; ++e) s += coupling[e].times(y(column[e]));
        return s;
    }
    /// r − A z of one row.
    Float4 defect(std::uint32_t i) const {
        return r[i] - D[i].times(z[i]) +
               sum(rows[i].begin, rows[i].end, [&](std::uint32_t j) { return z[j]; });
    }
    /// z = M⁻¹ r
    void relax() {
        for (const std::uint32_t kind : {0u, 1u}) {
            pieces.each(kind, [&](std::uint32_t begin, std::uint32_t end) {
                for (std::uint32_t i = begin; i < end; ++i)
                    z[i] = inverse[i].times(
                        r[i] + sum(rows[i].begin, rows[i].upper, [&](std::uint32_t j) { return z[j]; }));
            });
        }
        for (const std::uint32_t kind : {1u, 0u}) {
            pieces.each(kind, [&](std::uint32_t begin, std::uint32_t end) {
                for (std::uint32_t i = end; i-- > begin;)
                    z[i] += inverse[i].times(
                        sum(rows[i].upper, rows[i].apart, [&](std::uint32_t j) { return z[j]; }));
            });
        }
    }
    /// z += M⁻¹ (r − A z), the defect found on the way down.
    void correct() {
        for (const std::uint32_t kind : {0u, 1u}) {
            pieces.each(kind, [&](std::uint32_t begin, std::uint32_t end) {
                for (std::uint32_t i = begin; i < end; ++i) {
                    const Row& row = rows[i];
                    u[i] = inverse[i].times(
                        r[i] - D[i].times(z[i]) +
                        sum(row.begin, row.upper, [&](std::uint32_t j) { return Float4(z[j] + u[j]); }) +
                        sum(row.upper, row.end, [&](std::uint32_t j) { return z[j]; }));
                }
            });
        }
        for (const std::uint32_t kind : {1u, 0u}) {
            pieces.each(kind, [&](std::uint32_t begin, std::uint32_t end) {
                for (std::uint32_t i = end; i-- > begin;) {
                    u[i] += inverse[i].times(
                        sum(rows[i].upper, rows[i].apart, [&](std::uint32_t j) { return u[j]; }));
                    z[i] += u[i];
                }
            });
        }
    }
};

/// Couplings of one row as they are found, from its `begin` on, where there must be room: those to the same
/// column become one.
class RowOfBlocks {
public:
    RowOfBlocks(AggregationLevel<Block3>& level, std::uint32_t i)
        : level_(level), i_(i), last_(level.rows[i].begin) {}

    void add(std::uint32_t column, const Block3& B) {
        std::uint32_t at = level_.rows[i_].begin;
        while (at < last_ && level_.column[at] != column) ++at;
        if (at == last_) {
            level_.column[last_] = column;
            level_.coupling[last_++] = {};
        }
        level_.coupling[at] += B;
    }
    std::uint32_t end() const { return last_; }
    /// Brings lower ones to the front, then upper ones.
    void order() {
        auto& row = level_.rows[i_];
        row.upper = bring(row.begin, Pieces::lower);
        row.apart = bring(row.upper, Pieces::upper);
        row.end = last_;
    }

private:
    std::uint32_t bring(std::uint32_t from, Pieces::Relation relation) {
        for (std::uint32_t e = from; e < last_; ++e) {
            if (level_.pieces.relation(i_, level_.column[e]) != relation) continue;
            if (e != from) {
                std::swap(level_.column[from], level_.column[e]);
                std::swap(level_.coupling[from], level_.coupling[e]);
            }
            ++from;
        }
        return from;
    }

    AggregationLevel<Block3>& level_;
    std::uint32_t i_, last_;
};

}  // namespace unravel::sim
