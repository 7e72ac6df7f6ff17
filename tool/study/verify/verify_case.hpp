#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/plot/plot.hpp"

namespace unravel::tool {

/// What theory says of one run, and what the run says.
struct VerifyLine {
    std::string of;        ///< what the case is set to: "B = 0.001 N·m"; may be empty
    std::string grid;      ///< "21 x 41", "triangles"
    double step = 0;       ///< s; 0: no step is taken, the model itself is asked
    double expected = 0;   ///< in the case's unit
    double measured = 0;   ///< likewise; not a number where the run failed
    std::string failure;   ///< why it failed; empty: it did not
    double tolerance = 0;  ///< most that measured may be off, in the case's unit
    bool holds() const;
};

/// An analytic case: the same cloth on several grids and with several steps, against a formula.
struct VerifyCase {
    const char* name;
    const char* formula;   ///< as text
    const char* source;    ///< who says so
    const char* quantity;  ///< what is measured
    const char* unit;      ///< "" where it has none
    const char* why;       ///< where its tolerance comes from, or what the table should not hide
    struct Result {
        std::vector<VerifyLine> lines;
        std::optional<Plot> plot;  ///< beside the theory's curve
    };
    /// `fast`: only the coarsest grid and the default step.
    Result (*run)(bool fast);
};

std::span<const VerifyCase> verify_cases();

/// A case with what became of it.
struct VerifyOutcome {
    const VerifyCase* of;
    VerifyCase::Result result;
    double seconds = 0;  ///< that it took
    int wrong() const;   ///< lines that do not hold
};

VerifyOutcome run_verify_case(const VerifyCase& of, bool fast);

}  // namespace unravel::tool
