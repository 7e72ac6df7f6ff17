#pragma once

#include <string>

#include "render/renderer.hpp"

namespace unravel::render {

/// Preprocessor lines for every program that light.glsl or written.glsl is part of.
///   SHARP      a lamp is a point: shadows have hard edges
///   SAMPLED    (without SHARP: of what has maps of its own) the picture is one of many, with one direction
///   of the sky; what is written is light SKY_IMAGE  light from all around is that of the scene's sky image
inline std::string light_defines(const DrawScene& scene, Quality quality) {
    std::string defines;
    if (quality != Quality::standard) defines += "#define SHARP\n";
    if (quality == Quality::final_) defines += "#define SAMPLED\n";
    if (!scene.light.sky.pixels.empty()) defines += "#define SKY_IMAGE\n";
    return defines;
}

}  // namespace unravel::render
