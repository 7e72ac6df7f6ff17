#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/image.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// A value of a series, with the spread of its measurement where it has one. A y that is not finite stands
/// for a run that broke: it is drawn as a cross at the upper edge. On a log axis, values ≤ 0 are left out.
struct PlotPoint {
    double x = 0, y = 0;
    double low = std::numeric_limits<double>::quiet_NaN();  ///< error bar in y, from … to
    double high = std::numeric_limits<double>::quiet_NaN();
    double left = std::numeric_limits<double>::quiet_NaN();  ///< error bar in x
    double right = std::numeric_limits<double>::quiet_NaN();
    std::string note{};  ///< written beside the point
};

enum class SeriesStyle { line_and_points, line, points, bars };

struct PlotSeries {
    std::string label{};  ///< in the legend; empty: not there
    std::vector<PlotPoint> points{};
    SeriesStyle style = SeriesStyle::line_and_points;
    bool dashed = false;
    int color = -1;      ///< of the component palette; −1: the series' own number
    bool faint = false;  ///< grey and small, in place of a colour
};

struct PlotAxis {
    std::string label{};
    bool log = false;
    std::optional<double> from{}, to{};     ///< absent: what the points need
    std::vector<std::string> categories{};  ///< in place of numbers: names of x = 0, 1, 2 …
};

/// A straight line across the plot: a limit, a floor.
struct PlotGuide {
    double value = 0;
    bool horizontal = true;  ///< at y = value; otherwise at x = value
    std::string label{};
};

struct Plot {
    std::string title;
    PlotAxis x, y;
    std::vector<PlotSeries> series;
    std::vector<PlotGuide> guides;
    double bar_width = 0;  ///< of all bars at one x together, in units of x; 0: from how near they stand
    int width = 720, height = 440;
};

/// Plots side by side as one SVG document, and as a picture.
std::string plots_svg(std::span<const Plot> plots);
Image plots_image(std::span<const Plot> plots, double scale = 2);

/// The plot as an SVG document.
std::string plot_svg(const Plot& plot);

/// The same as a picture, `scale` pixels per unit of its size.
Image plot_image(const Plot& plot, double scale = 2);

}  // namespace unravel::tool
