#pragma once

#include <Eigen/Core>

#include "render/draw_scene.hpp"

namespace unravel::render {

/// The uniform block "Frame" of shaders/frame.glsl, std140: what every shader of one frame shares. Colours
/// are linear.
struct FrameBlock {
    static constexpr int sky_directions = 8;

    Eigen::Matrix4f view_projection;
    Eigen::Matrix4f shadow_matrix;                  ///< world to [0, 1]³ of the key light's map
    Eigen::Matrix4f sky_matrix[sky_directions];     ///< world to its tile of the sky maps
    Eigen::Vector4f sky_direction[sky_directions];  ///< xyz: unit, towards the sky
    Eigen::Vector4f eye;                            ///< xyz [m]
    Eigen::Vector4f key_direction;  ///< xyz: unit, towards the light; w: tangent of its radius
    Eigen::Vector4f key_color, fill_direction, fill_color, sky_color, bounce_color;
    Eigen::Vector4f background;
    Eigen::Vector4f ground;  ///< x, z of its middle [m]; distances where its fade begins and ends [m]
    Eigen::Vector4f shadow;  ///< texel of the key map [m]; extent of the map [m]; texel of a sky map [m]; by
                             ///< how much solids yield to cloth [m]
    Eigen::Vector4f
        viewport;  ///< width, height [px]; pixels per metre at a depth of 1 m; wire bias towards the eye [m]
    Eigen::Vector4f sky_harmonics[9];  ///< light from all around, where the sky is an image (sky_light.hpp)
};
static_assert(sizeof(FrameBlock) ==
              (2 + FrameBlock::sky_directions) * 64 + (FrameBlock::sky_directions + 20) * 16);

/// The part of it that is the same for every frame and style.
FrameBlock fixed_block(const DrawScene& scene);

}  // namespace unravel::render
