#include "tool/picture/staging.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "render/color.hpp"
#include "render/png.hpp"

namespace unravel::tool {

namespace {

Image picture_of(const std::string& file, const std::filesystem::path& textures) {
    return file.empty() || textures.empty() ? Image{} : read_png(textures / file);
}

// Throws InputError where it can't be one of all directions.
Image sky_of(const std::string& file, const std::filesystem::path& textures) {
    Image image = picture_of(file, textures);
    if (image.width != 2 * image.height)
        throw InputError(textures / file, fmt::format("a sky's image is twice as wide as high; this one has "
                                                      "{} × {} pixels",
                                                      image.width, image.height));
    return image;
}

SurfaceFinish finish_of(Finish finish) {
    switch (finish) {
        case Finish::satin:
            return SurfaceFinish::satin;
        case Finish::matt:
            return SurfaceFinish::matt;
        case Finish::gloss:
            return SurfaceFinish::gloss;
        case Finish::metal:
            return SurfaceFinish::metal;
    }
    return SurfaceFinish::satin;
}

Lighting lighting_of(const Look& look, const std::filesystem::path& textures) {
    Lighting light;
    if (!look.sun.color.empty()) light.key_color = linear(parse_color(look.sun.color));
    light.key_strength = static_cast<float>(look.sun.strength);
    if (look.sun.softness)
        light.key_radius = static_cast<float>(std::tan(*look.sun.softness * std::numbers::pi / 360));
    if (!look.sky.color.empty()) light.sky_color = linear(parse_color(look.sky.color));
    light.sky_strength = static_cast<float>(look.sky.strength);
    light.sky = sky_of(look.sky.image, textures);
    light.show_sky = look.sky.show;
    light.exposure = static_cast<float>(std::exp2(look.exposure));
    return light;
}

}  // namespace

Rgb parse_color(const std::string& text) {
    const auto digits = text.find_first_not_of("0123456789abcdefABCDEF", 1);
    if (text.size() != 7 || text[0] != '#' || digits != std::string::npos) {
        throw std::invalid_argument("'" + text + "' is no colour: write it as #rrggbb");
    }
    const auto byte = [&](std::size_t at) {
        return static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16));
    };
    return {byte(1), byte(3), byte(5)};
}

void set_stage(const Look& look, const std::filesystem::path& textures, DrawScene& out) {
    out.key_direction = look.sun.direction.cast<float>();
    out.light = lighting_of(look, textures);
    out.background = parse_color(look.background);
    if (!look.background_top.empty()) out.background_top = parse_color(look.background_top);
    out.background_image = picture_of(look.background_image, textures);
    out.ground = parse_color(look.ground);
    out.ground_texture = picture_of(look.ground_texture, textures);
    out.ground_size = static_cast<float>(look.ground_scale);
    out.horizon = look.horizon;
    out.show_ground = look.show_ground;
}

void set_surface(const Look& look, std::size_t solid, const std::filesystem::path& textures, SolidMesh& out) {
    if (look.body.empty()) return;
    const BodyLook& body = look.body[std::min(solid, look.body.size() - 1)];
    out.finish = finish_of(body.finish);
    out.texture = picture_of(body.texture, textures);
    out.texture_size = static_cast<float>(body.scale);
}

}  // namespace unravel::tool
