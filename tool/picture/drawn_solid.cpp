#include "tool/picture/drawn_solid.hpp"

#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::tool {

namespace {

// Shadows need fewer triangles than the eye.
constexpr float detail_of_shadows = 0.4f;

Tessellation drawn_surface(ShapeSurface&& surface) {
    return {std::move(surface.positions), std::move(surface.normals), std::move(surface.indices)};
}

}  // namespace

SolidMesh drawn_solid(const Solid& solid) {
    const ShapeLaw& law = law_of(solid.shape);
    SolidMesh mesh;
    mesh.plane = solid.shape == Shape::plane;
    if (!mesh.plane) mesh.half_extents = law.half_extents(solid).cast<float>();
    if (law.surface) {
        mesh.fine = drawn_surface(law.surface(solid, 1));
        mesh.coarse = drawn_surface(law.surface(solid, detail_of_shadows));
    }
    if (solid.geometry) {
        mesh.triangles = solid.geometry->triangles;
        mesh.deforms = solid.geometry->deforms();
        for (const Vec3& x : solid.geometry->rest) mesh.positions.push_back(x.cast<float>());
    }
    return mesh;
}

}  // namespace unravel::tool
