#pragma once

#include <string_view>

namespace unravel::render {

/// Text of the file shaders/<name>, embedded at build time; empty if there is none of that name.
std::string_view shader_source(std::string_view name);

}  // namespace unravel::render
