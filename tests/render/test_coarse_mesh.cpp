#include "render/coarse_mesh.hpp"

#include <catch2/catch.hpp>

#include "tests/render/sheet.hpp"

using namespace unravel;
using namespace unravel::render;

namespace {

/// Area of a mesh's triangles seen along y.
float area_from_above(const ClothMesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                      const std::vector<Vec3f>& x) {
    float area = 0;
    for (const auto& [a, b, c] : triangles) {
        const Vec3f p = x[mesh.particle[b]] - x[mesh.particle[a]],
                    q = x[mesh.particle[c]] - x[mesh.particle[a]];
        area += 0.5f * std::abs(p.cross(q).y());
    }
    return area;
}

/// A flat square of n × n particles with a metre's sides.
std::pair<ClothMesh, std::vector<Vec3f>> flat_square(int n) {
    testing::Sheet sheet(n);
    std::vector<Vec3f> x;
    for (const Vec2f& uv : sheet.scene.cloths[0].uv) x.emplace_back(uv.x(), 0, uv.y());
    return {sheet.scene.cloths[0], x};
}

/// The same triangles, each with three vertices of its own that lie anywhere on the flat cloth.
ClothMesh islands_of(const ClothMesh& mesh) {
    ClothMesh islands;
    for (const auto& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(islands.particle.size());
        for (std::uint32_t k = 0; k < 3; ++k) {
            islands.particle.push_back(mesh.particle[triangle[k]]);
            islands.uv.push_back({float(first), k == 1 ? 0.f : 1.f});
        }
        islands.triangles.push_back({first, first + 1, first + 2});
    }
    return islands;
}

}  // namespace

TEST_CASE("a_coarse_mesh_covers_what_the_fine_one_does") {
    const auto [mesh, x] = flat_square(101);
    for (const std::size_t count : {400, 1600, 5000}) {
        const auto coarse = coarse_triangles(mesh, count);
        INFO(count << " particles asked: " << coarse.size() << " triangles");
        // Two triangles a particle on the whole; seeds stand up to twice as dense where discs pack well.
        CHECK(coarse.size() <= 4 * count);
        CHECK(coarse.size() > count / 2);
        // Border first: the outline keeps its corners, and is cut by at most half a step where it has some.
        CHECK(area_from_above(mesh, coarse, x) == Approx(1).epsilon(0.03));
    }
    CHECK(coarse_triangles(mesh, 101 * 101) == mesh.triangles);
}

TEST_CASE("a_coarse_mesh_does_not_know_the_flat_cloth") {
    const auto [mesh, x] = flat_square(61);
    const ClothMesh islands = islands_of(mesh);
    ClothMesh heap = mesh;
    for (Vec2f& uv : heap.uv) uv = Vec2f(-0.5f, 3);
    const auto places = [&, &x = x](const ClothMesh& of) {
        std::vector<std::array<std::uint32_t, 3>> particles;
        for (const auto& [a, b, c] : coarse_triangles(of, 400))
            particles.push_back({of.particle[a], of.particle[b], of.particle[c]});
        std::ranges::sort(particles);
        return particles;
    };
    CHECK(places(heap) == places(mesh));
    // Particles are met in another order: other triangles, of the same cloth.
    const auto coarse = coarse_triangles(islands, 400);
    CHECK(area_from_above(islands, coarse, x) == Approx(1).epsilon(0.03));
}
