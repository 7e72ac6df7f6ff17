#pragma once

#include <cmath>
#include <numbers>

#include "render/draw_scene.hpp"
#include "tests/render/ball.hpp"

namespace unravel::testing {

using namespace render;

/// A wavy sheet of n × n particles that hangs over a sphere on the ground: a drape without a simulation.
struct Sheet {
    DrawScene scene;
    DrawFrame frame;

    /// `phase` [rad] turns the folds, for frames that differ.
    explicit Sheet(int n, float phase = 0) {
        const float radius = 0.3f, height = 0.42f, cover = radius + 0.004f;
        ClothMesh mesh;
        scene.spacing = 1.f / static_cast<float>(n - 1);
        for (int v = 0; v < n; ++v)
            for (int u = 0; u < n; ++u) {
                mesh.particle.push_back(v * n + u);
                mesh.uv.push_back({float(u) / float(n - 1), float(v) / float(n - 1)});
            }
        const auto at = [n](int u, int v) { return static_cast<std::uint32_t>(v * n + u); };
        for (int v = 0; v < n; ++v)
            for (int u = 0; u < n; ++u) {
                if (u + 1 < n) scene.edges.push_back({at(u, v), at(u + 1, v)});
                if (v + 1 < n) scene.edges.push_back({at(u, v), at(u, v + 1)});
                if (u + 1 < n && v + 1 < n) {
                    mesh.triangles.push_back({at(u, v), at(u, v + 1), at(u + 1, v)});
                    mesh.triangles.push_back({at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)});
                }
            }
        // Down the sphere to its side, then straight, with folds that grow.
        const float bend = 1.25f, leave = cover * bend;
        for (const Vec2f& uv : mesh.uv) {
            const float x = uv.x() - 0.5f, z = uv.y() - 0.5f, rho = std::hypot(x, z),
                        angle = std::atan2(z, x);
            const float along = std::min(rho, leave), below = std::max(rho - leave, 0.f);
            float r = cover * std::sin(along / cover) + 0.3f * below;
            const float y = height + cover * std::cos(along / cover) - 0.93f * below;
            r += below * 0.36f * std::cos(8 * angle + phase) * std::min(1.f, below / 0.1f);
            // Folds lie against the sphere, not in it.
            const float drop = std::min(std::abs(y - height), cover);
            r = std::max(r, std::sqrt(cover * cover - drop * drop));
            frame.positions.push_back({r * std::cos(angle), std::max(y, 0.005f), r * std::sin(angle)});
        }
        scene.cloths.push_back(std::move(mesh));
        scene.solids.push_back(ball(radius));
        scene.bounds_low = {-0.6f, 0, -0.6f};
        scene.bounds_high = {0.6f, 0.75f, 0.6f};
        Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
        pose.translation() = Vec3f(0, height, 0);
        frame.solid_poses.push_back(pose);
        frame.camera = {.position = {1.3f, 1.05f, 1.5f}, .target = {0, 0.33f, 0}, .fov = 32};

        // The cap is held; the rest falls into sectors.
        const Rgb colors[] = {{230, 159, 0}, {86, 180, 233}, {0, 158, 115},  {240, 228, 66},
                              {0, 114, 178}, {213, 94, 0},   {204, 121, 167}};
        for (const Vec2f& uv : scene.cloths[0].uv) {
            const float x = uv.x() - 0.5f, z = uv.y() - 0.5f,
                        angle = std::atan2(z, x) + std::numbers::pi_v<float>;
            const int sector = std::min(6, static_cast<int>(7 * angle / (2 * std::numbers::pi_v<float>)));
            frame.particle_colors.push_back(std::hypot(x, z) < 0.2f ? Rgb{255, 255, 255} : colors[sector]);
        }
    }
};

}  // namespace unravel::testing
