#include "render/normals.hpp"

#include <catch2/catch.hpp>

#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;

TEST_CASE("normals_of_a_sphere_point_outwards") {
    // The sheet's cap lies on a sphere around (0, 0.42, 0), its front outside.
    const testing::Sheet sheet(61);
    const ClothMesh& mesh = sheet.scene.cloths[0];
    std::vector<Vec3f> normals(sheet.frame.positions.size());
    smooth_normals(mesh, sheet.frame.positions, normals);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if ((mesh.uv[i] - Vec2f(0.5f, 0.5f)).norm() > 0.3f) continue;
        const Vec3f out = (sheet.frame.positions[i] - Vec3f(0, 0.42f, 0)).normalized();
        REQUIRE(normals[i].dot(out) > 0.998f);  // within 3.6 degrees: the triangles are inscribed
        REQUIRE(normals[i].norm() == Approx(1));
    }
}

TEST_CASE("normals_of_no_area_are_defined") {
    ClothMesh mesh;
    mesh.particle = {0, 1, 2};
    mesh.triangles = {{0, 1, 2}};
    const std::vector<Vec3f> positions(3, Vec3f(1, 2, 3));
    std::vector<Vec3f> normals(3);
    smooth_normals(mesh, positions, normals);
    for (const Vec3f& normal : normals) CHECK(normal == Vec3f(0, 1, 0));
}

TEST_CASE("normals_agree_across_a_seam") {
    // A tube of four columns around y, with its seam column doubled: the particle at the seam has one normal,
    // its own.
    ClothMesh mesh;
    const int columns = 4;
    std::vector<Vec3f> positions;
    for (int row = 0; row < 2; ++row)
        for (int c = 0; c < columns; ++c)
            positions.push_back({c == 0   ? 1.f
                                 : c == 2 ? -1.f
                                          : 0.f,
                                 static_cast<float>(row),
                                 c == 1   ? -1.f
                                 : c == 3 ? 1.f
                                          : 0.f});
    for (int row = 0; row < 2; ++row)
        for (int c = 0; c <= columns; ++c) mesh.particle.push_back(row * columns + c % columns);
    for (std::uint32_t c = 0; c < columns; ++c) {
        mesh.triangles.push_back({c, c + 1, c + columns + 1});
        mesh.triangles.push_back({c + 1, c + columns + 2, c + columns + 1});
    }
    std::vector<Vec3f> normals(positions.size());
    smooth_normals(mesh, positions, normals);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3f out(positions[i].x(), 0, positions[i].z());
        CHECK(normals[i].dot(out) > 0.94f);
    }
}
