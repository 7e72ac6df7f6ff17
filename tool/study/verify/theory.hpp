#pragma once

#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// A strip clamped level at one end that bends under its own weight: the heavy elastica,
///   θ'' = −(w/B) (L − s) cos θ,  θ(0) = 0,  θ'(L) = 0,
/// θ the angle below the level at arc length s, w = ρ g the weight per area and B the bending stiffness per
/// width. Its place at even arc lengths, across and down [m].
struct ElasticaPoint {
    double across, down;
};
std::vector<ElasticaPoint> heavy_elastica(double length, double weight, double bend, int points);

/// Sag of an inextensible chain of a length between two points at one height, `span` apart [m].
double catenary_sag(double length, double span);

}  // namespace unravel::tool
