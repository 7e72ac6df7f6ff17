// Compiled once for each instruction set (UNRAVEL_ISA names it): include nothing here whose functions could
// be shared with code that must run anywhere.

#include "sim/kernels/stencil_rows.hpp"

namespace unravel::sim::UNRAVEL_ISA {

namespace {

// What is read beyond an end of the grid, so that restriction is the transpose of prolongation in every case.
// An even column 2I lends ¼ to I − 1, an odd one 2I + 1 to I + 1; what has nowhere to go stays in its own
// aggregate, or goes round a tube.
UNRAVEL_INLINE void fill_ends(float* v, const StencilGrid& g) {
    const bool even = g.nu % 2 == 0;
    const int n = g.nu;
    const float first = v[0], last = v[n - 1];
    v[-1] = g.tube ? (even ? last : 0) : first;
    v[n] = even ? (g.tube ? first : last) : 0;
    v[n + 1] = even ? 0 : (g.tube ? first : 0);
}

UNRAVEL_INLINE f8 evens(const float* v) {
    return __builtin_shufflevector(Lanes<f8>::load(v), Lanes<f8>::load(v + 8), 0, 2, 4, 6, 8, 10, 12, 14);
}

constexpr f8 quarter = {0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f};
constexpr f8 three_quarters = {0.75f, 0.75f, 0.75f, 0.75f, 0.75f, 0.75f, 0.75f, 0.75f};

// Bilinear between aggregates of 2 × 2: weights ¾ and ¼ each way.
void restrict_to(const StencilGrid& fine, const StencilGrid& coarse, int begin, int end, const float* t,
                 float* r, float* scratch) {
    float* const v = scratch + margin;
    const int length = margin + 2 * coarse.columns() + 16;
    for (int J = begin; J < end; ++J) {
        const int j = 2 * J;
        const bool odd_row = j + 1 < fine.nv;
        for (int c = 0; c < 3; ++c) {
            const auto row = [&](int k) { return row_of(t, fine, k, 3) + c * fine.pitch; };
            const float *const r0 = row(j), *const before = row(j > 0 ? j - 1 : 0);
            const float* const r1 = odd_row ? row(j + 1) : nullptr;
            const float* const after = odd_row ? row(j + 2 < fine.nv ? j + 2 : j + 1) : nullptr;
            clear(scratch, length);
            for (int i = 0; i < fine.nu; i += 8) {
                f8 sum = three_quarters * Lanes<f8>::load(r0 + i) + quarter * Lanes<f8>::load(before + i);
                if (odd_row)
                    sum = sum +
                          (three_quarters * Lanes<f8>::load(r1 + i) + quarter * Lanes<f8>::load(after + i));
                Lanes<f8>::store(v + i, sum);
            }
            for (int i = fine.nu; i < fine.columns(); ++i) v[i] = 0;
            fill_ends(v, fine);
            float* const out = row_of(r, coarse, J, 3) + c * coarse.pitch;
            for (int I = 0; I < coarse.nu; I += 8) {
                const float* const at = v + 2 * I;
                Lanes<f8>::store(out + I, three_quarters * (evens(at) + evens(at + 1)) +
                                              quarter * (evens(at - 1) + evens(at + 2)));
            }
            for (int I = coarse.nu; I < coarse.columns(); ++I) out[I] = 0;
        }
    }
}

void prolong_add(const StencilGrid& fine, const StencilGrid& coarse, int begin, int end, const float* e,
                 float* z, float* scratch) {
    float* const v = scratch + margin;
    for (int j = begin; j < end; ++j) {
        const int J = j / 2;
        const int other = j % 2 == 0 ? (J > 0 ? J - 1 : 0) : (J + 1 < coarse.nv ? J + 1 : J);
        float* const zj = row_of(z, fine, j, 3);
        for (int c = 0; c < 3; ++c) {
            const float* const near = row_of(e, coarse, J, 3) + c * coarse.pitch;
            const float* const far = row_of(e, coarse, other, 3) + c * coarse.pitch;
            for (int I = 0; I < coarse.nu; I += 8)
                Lanes<f8>::store(
                    v + I, three_quarters * Lanes<f8>::load(near + I) + quarter * Lanes<f8>::load(far + I));
            const float first = v[0], last = v[coarse.nu - 1];
            v[-1] = fine.tube ? last : first;
            v[coarse.nu] = fine.tube ? first : last;
            float* const out = zj + c * fine.pitch;
            for (int I = 0; 2 * I < fine.nu; I += 8) {
                const f8 here = three_quarters * Lanes<f8>::load(v + I);
                const f8 even = here + quarter * Lanes<f8>::load(v + I - 1);
                const f8 odd = here + quarter * Lanes<f8>::load(v + I + 1);
                float* const at = out + 2 * I;
                Lanes<f8>::store(
                    at, Lanes<f8>::load(at) + __builtin_shufflevector(even, odd, 0, 8, 1, 9, 2, 10, 3, 11));
                if (2 * I + 8 < fine.columns())
                    Lanes<f8>::store(at + 8,
                                     Lanes<f8>::load(at + 8) +
                                         __builtin_shufflevector(even, odd, 4, 12, 5, 13, 6, 14, 7, 15));
            }
            for (int i = fine.nu; i < fine.columns(); ++i) out[i] = 0;
        }
        filter_row(fine, j, zj);
    }
}

void close_rings(const StencilGrid& g, int begin, int end, float* z) {
    for (int j = begin; j < end; ++j) close_ring(row_of(z, g, j, 3), g, 3);
}

}  // namespace

extern const TransferKernels transfer_kernels;
const TransferKernels transfer_kernels = {restrict_to, prolong_add, close_rings};

}  // namespace unravel::sim::UNRAVEL_ISA
