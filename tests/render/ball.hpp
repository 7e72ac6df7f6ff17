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

/// A box with these edges [m].
inline render::SolidMesh box(const sim::Vec3& size, render::Rgb color) {
    sim::Solid solid;
    solid.shape = sim::Shape::box;
    solid.size = size;
    render::SolidMesh mesh = tool::drawn_solid(solid);
    mesh.color = color;
    return mesh;
}

}  // namespace unravel::testing
