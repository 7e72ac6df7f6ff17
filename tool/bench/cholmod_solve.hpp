#pragma once

/// Solves A y = b by CHOLMOD: A symmetric positive definite, its lower triangle by columns, sorted.
///   starts   (n + 1)       rows, values   (starts[n])       b, y   (n)
///   set_up   receives the seconds for ordering and factors
/// Returns 0, or another number where that failed. In a library of its own (CMakeLists.txt), which is made
/// where CHOLMOD is installed and opened by `unravel bench` alone.
extern "C" int unravel_cholmod_solve(int n, const int* starts, const int* rows, const double* values,
                                     const double* b, double* y, double* set_up);
