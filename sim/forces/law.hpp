#pragma once

// A force's scalar law is written once, free of branches, and inlined into all that evaluates it: lists of
// springs or cells (sim/forces), rows of grids (sim/rows), the linear system and the measures. Loops over
// rows must stay vectorised: a named truth value for each part of a condition keeps them so.
#define UNRAVEL_LAW inline __attribute__((always_inline))
