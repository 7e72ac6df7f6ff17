#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/draw_scene.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// What a picture is made of: one of the renderer's styles, or both views beside each other.
enum class Layout { textured, components, overlay, side_by_side };
inline constexpr Layout all_layouts[] = {Layout::textured, Layout::components, Layout::overlay,
                                         Layout::side_by_side};

/// One of the pictures that a clip has of each frame.
struct ClipView {
    Layout layout = Layout::textured;
    std::size_t camera = 0;  ///< of the scene's
    std::string name;        ///< names its files: "textured", "components_close", …
};

/// "textured", "components", "overlay", "side_by_side".
const char* layout_name(Layout layout);

/// Names a view after its layout and, but for the scene's first, its camera, less what file names had better
/// not hold. `suffix` is added as it is.
ClipView make_view(const Scene& scene, Layout layout, std::size_t camera, const std::string& suffix = "");

/// Width of its pictures, where one view is `width` wide.
int view_width(Layout layout, int width);

/// One thing to be drawn; views are made of one or two.
struct Shot {
    DrawStyle style = DrawStyle::textured;
    std::size_t camera = 0;
    bool operator==(const Shot&) const = default;
};
std::vector<Shot> shots_of(const ClipView& view);

}  // namespace unravel::tool
