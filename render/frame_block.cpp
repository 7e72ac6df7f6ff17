#include "render/frame_block.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "render/color.hpp"
#include "render/sky_light.hpp"

namespace unravel::render {

namespace {

constexpr float key_strength = 1.2f, fill_strength = 0.14f, sky_strength = 0.36f;

/// Light from all around is that of the scene's sky image, below the horizon that off the ground.
void light_by_image(const DrawScene& scene, float mean, FrameBlock& block) {
    std::optional<Vec3f> below;
    if (scene.show_ground && !scene.transparent) below = block.bounce_color.head<3>();
    const std::array<Vec3f, 9> harmonics = sky_harmonics(scene.light.sky, mean, below);
    for (std::size_t k = 0; k < harmonics.size(); ++k) block.sky_harmonics[k] << harmonics[k], 0;
    block.sky_color << light_of(harmonics, Vec3f::UnitY()), 0;
}

}  // namespace

FrameBlock fixed_block(const DrawScene& scene) {
    FrameBlock block{};
    const Vec3f key = scene.key_direction.normalized();
    // A lamp of warm white, a cooler fill from the other side, a sky tinted by the background, light off the
    // ground.
    const Lighting& light = scene.light;
    block.key_color << (key_strength * light.key_strength * light.exposure) * light.key_color, 0;
    block.fill_direction << Vec3f(-key.x(), 0.35f, -0.4f * key.z()).normalized(), 0;
    const float around = light.sky_strength * light.exposure;
    block.fill_color << (fill_strength * around) * Vec3f(0.86f, 0.93f, 1.0f), 0;
    const Vec3f background = linear(scene.background);
    const float brightest = std::max(background.maxCoeff(), 0.05f);
    const Vec3f sky = light.sky_color.value_or(0.5f * (Vec3f(0.90f, 0.95f, 1.0f) + background / brightest));
    block.sky_color << (sky_strength * around) * sky, 0;
    const Vec3f ground = scene.show_ground ? linear(scene.ground) : Vec3f(0.2f, 0.2f, 0.2f);
    // Off ground that key light and sky reach, as most of what a place sees of it is.
    block.bounce_color << ground.cwiseProduct(std::max(key.y(), 0.f) * block.key_color.head<3>() +
                                              block.sky_color.head<3>()),
        0;
    if (!light.sky.pixels.empty()) light_by_image(scene, sky_strength * around, block);
    return block;
}

}  // namespace unravel::render
