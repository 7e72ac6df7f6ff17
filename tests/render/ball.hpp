#pragma once

#include "tool/picture/drawn_solid.hpp"

namespace unravel::testing {

/// A sphere of this radius [m], as the renderer takes it.
inline render::SolidMesh ball(float radius, render::Rgb color = render::SolidMesh().color) {
    sim::Solid sphere;
    sphere.shape = sim::Shape::sphere;
    sphere.radius = radius;
    render::SolidMesh mesh = tool::drawn_solid(sphere);
    mesh.color = color;
    return mesh;
}

}  // namespace unravel::testing
