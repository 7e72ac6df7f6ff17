#include "render/backdrop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/camera.hpp"
#include "render/picture_texture.hpp"

namespace unravel::render {

Backdrop::Kind Backdrop::kind_of(const DrawScene& scene) {
    if (scene.transparent) return Kind::plain;
    if (scene.light.show_sky && !scene.light.sky.pixels.empty()) return Kind::sky;
    if (!scene.background_image.pixels.empty()) return Kind::picture;
    return scene.background_top ? Kind::gradient : Kind::plain;
}

Backdrop::Backdrop(const DrawScene& scene, bool encoded)
    : scene_(&scene),
      kind_(kind_of(scene)),
      program_({"screen.vert"}, {"color.glsl", "written.glsl", "backdrop.frag"},
               fmt::format("#define KIND {}\n#define ENCODED {}\n", std::max(1, static_cast<int>(kind_)),
                           encoded ? 1 : 0)) {
    program_.sampler("picture", 0);
    const auto color = [&](const char* name, Rgb c) {
        glUniform3f(program_.uniform(name), c.r / 255.f, c.g / 255.f, c.b / 255.f);
    };
    color("bottom", scene.background);
    color("top", scene.background_top.value_or(scene.background));
    if (kind_ == Kind::picture) upload_picture(picture_, scene.background_image, false);
    if (kind_ == Kind::sky) {
        upload_picture(picture_, scene.light.sky, true);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
}

void Backdrop::draw(const CameraView& camera, int width, int height) const {
    program_.use();
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    glUniform2f(program_.uniform("size"), w, h);
    if (kind_ == Kind::picture) {
        // All of the target is filled; what is too wide or too high is cut on both sides.
        const Image& image = scene_->background_image;
        const float aspect = w / h * static_cast<float>(image.height) / static_cast<float>(image.width);
        glUniform2f(program_.uniform("window"), std::min(aspect, 1.f), std::min(1 / aspect, 1.f));
    }
    const Eigen::Matrix3f turn =
        look_at(camera.position, camera.target, camera.up).topLeftCorner<3, 3>().transpose();
    const float reach = std::tan(0.5f * camera.fov * std::numbers::pi_v<float> / 180);
    const Eigen::Matrix3f rays = turn * Vec3f(reach * w / h, reach, -1).asDiagonal();
    glUniformMatrix3fv(program_.uniform("rays"), 1, GL_FALSE, rays.data());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, picture_);
    glBindVertexArray(no_vertices_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
}

}  // namespace unravel::render
