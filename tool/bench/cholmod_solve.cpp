#include "tool/bench/cholmod_solve.hpp"

#include <cholmod.h>

#include <algorithm>
#include <chrono>

extern "C" int unravel_cholmod_solve(int n, const int* starts, const int* rows, const double* values,
                                     const double* b, double* y, double* set_up) {
    const auto start = std::chrono::steady_clock::now();
    cholmod_common common;
    cholmod_start(&common);
    common.print = 0;
    cholmod_sparse A{};
    const auto size = static_cast<std::size_t>(n);
    A.nrow = A.ncol = size;
    A.nzmax = static_cast<std::size_t>(starts[n]);
    // CHOLMOD reads them only.
    A.p = const_cast<int*>(starts);
    A.i = const_cast<int*>(rows);
    A.x = const_cast<double*>(values);
    A.stype = -1;
    A.itype = CHOLMOD_INT;
    A.xtype = CHOLMOD_REAL;
    A.dtype = CHOLMOD_DOUBLE;
    A.sorted = A.packed = 1;
    cholmod_factor* factor = cholmod_analyze(&A, &common);
    bool solved = factor && cholmod_factorize(&A, factor, &common) && common.status == CHOLMOD_OK;
    *set_up = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (solved) {
        cholmod_dense right{};
        right.nrow = right.nzmax = right.d = size;
        right.ncol = 1;
        right.x = const_cast<double*>(b);
        right.xtype = CHOLMOD_REAL;
        right.dtype = CHOLMOD_DOUBLE;
        cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor, &right, &common);
        solved = solution != nullptr;
        if (solved) std::copy_n(static_cast<const double*>(solution->x), n, y);
        cholmod_free_dense(&solution, &common);
    }
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
    return solved ? 0 : 1;
}
