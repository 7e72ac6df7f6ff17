#include "sim/kernels/stencil_kernels.hpp"

namespace unravel::sim {

namespace plain {
extern const SweepKernels sweep_kernels;
extern const LineKernels line_kernels;
extern const TransferKernels transfer_kernels;
extern const CoarsenKernels coarsen_kernels;
extern const BendKernels bend_kernels;
}  // namespace plain

namespace avx2 {
extern const SweepKernels sweep_kernels;
extern const LineKernels line_kernels;
extern const TransferKernels transfer_kernels;
extern const CoarsenKernels coarsen_kernels;
extern const BendKernels bend_kernels;
}  // namespace avx2

const StencilKernels& plain_stencil_kernels() {
    static constexpr StencilKernels kernels{"x86-64",
                                            plain::sweep_kernels,
                                            plain::line_kernels,
                                            plain::transfer_kernels,
                                            plain::coarsen_kernels,
                                            plain::bend_kernels};
    return kernels;
}

const StencilKernels& stencil_kernels() {
    static constexpr StencilKernels wide{"avx2",
                                         avx2::sweep_kernels,
                                         avx2::line_kernels,
                                         avx2::transfer_kernels,
                                         avx2::coarsen_kernels,
                                         avx2::bend_kernels};
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    return has_avx2 ? wide : plain_stencil_kernels();
}

}  // namespace unravel::sim
