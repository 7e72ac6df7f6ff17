#pragma once

#include "sim/scene/scene.hpp"

namespace unravel {

/// Signed distance [m] from a point to a solid's surface, negative inside, and its gradient (the outward unit
/// normal of the nearest surface point). `local` is in the solid's own frame: centre at the origin,
/// unrotated.
///
/// The distance is exact for every shape, so it is 1-Lipschitz. Where the nearest surface point is not unique
/// the gradient does not exist; then one of the nearest points' normals is given, always the same and always
/// of unit length:
///   sphere's centre                       +y
///   cylinder's and capsule's axis         +x  (nearest to the side), ±y (nearest to an end)
///   inside a box, between several faces   the first of x, y, z that is nearest; on a middle plane its + side
/// On the edge of a sharp box or cylinder it is the normal of one of the faces that meet there.
double signed_distance(const Solid& solid, const Vec3& local, Vec3* gradient = nullptr);

}  // namespace unravel
