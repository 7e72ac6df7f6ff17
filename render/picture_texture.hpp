#pragma once

#include <epoxy/gl.h>

#include "render/image.hpp"

namespace unravel::render {

/// Fills a texture with a picture that is seen at any size. `repeats`: beyond [0, 1]² it goes on; else its
/// rim does not take in the opposite one.
void upload_picture(GLuint texture, const Image& image, bool repeats);

}  // namespace unravel::render
