#pragma once

#include <string>
#include <vector>

#include "tool/base/names.hpp"
#include "tool/inspect/inspected.hpp"
#include "tool/inspect/pattern.hpp"
#include "tool/plot/plot.hpp"

namespace unravel::tool {

/// How many components, and how many particles in them, for each range of sizes.
Plot size_histogram(const InspectedStep& step);

/// How many springs for each range of κ, by how they were handled, with the threshold.
Plot kappa_histogram(const InspectedStep& step);

/// A of the implicit scheme, of this step, and of this step reordered (paper Figs 3–5).
std::vector<Pattern> step_patterns(const InspectedStep& step);

/// A picture of the page: its name in file names, and both its formats.
struct Figure {
    std::string name, caption, svg;
    Image image{};
    bool dots_only = false;  ///< the SVG is no larger than the picture, and sharper
};

/// All of them drawn.
std::vector<Figure> step_figures(const InspectedStep& step);

}  // namespace unravel::tool
