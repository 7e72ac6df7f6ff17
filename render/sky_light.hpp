#pragma once

#include <array>
#include <optional>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// A picture of all directions, twice as wide as high: its top row straight up, its middle towards −z, its
/// right towards +x.
///
/// Light that a matt white surface scatters under it, over its normal (x, y, z): the first nine spherical
/// harmonics with the constants worked in, so that the light is
///   c0 + c1 y + c2 z + c3 x + c4 xy + c5 yz + c6 (3z² − 1) + c7 xz + c8 (x² − y²).
/// [Ramamoorthi & Hanrahan 2001, An Efficient Representation for Irradiance Environment Maps, Eq. 10]
/// Scaled so that the mean of the image's upper half has the brightness `mean`. `below`: what the lower half
/// is instead, after that; absent: the image.
std::array<Vec3f, 9> sky_harmonics(const Image& image, float mean, const std::optional<Vec3f>& below);

/// The light of such harmonics at a unit normal.
Vec3f light_of(const std::array<Vec3f, 9>& harmonics, const Vec3f& n);

}  // namespace unravel::render
