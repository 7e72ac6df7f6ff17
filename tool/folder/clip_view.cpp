#include "tool/folder/clip_view.hpp"

#include <cctype>

namespace unravel::tool {

const char* layout_name(Layout layout) {
    switch (layout) {
        case Layout::textured:
            return "textured";
        case Layout::components:
            return "components";
        case Layout::overlay:
            return "overlay";
        case Layout::side_by_side:
            return "side_by_side";
    }
    return "";
}

ClipView make_view(const Scene& scene, Layout layout, std::size_t camera, const std::string& suffix) {
    ClipView view{layout, camera, layout_name(layout)};
    if (camera > 0) {
        view.name += "_";
        for (const char c : scene.cameras[camera].name) {
            const auto byte = static_cast<unsigned char>(c);
            view.name += std::isalnum(byte) || byte >= 128 || c == '-' ? c : '_';
        }
    }
    view.name += suffix;
    return view;
}

int view_width(Layout layout, int width) {
    return layout == Layout::side_by_side ? 2 * width : width;
}

std::vector<Shot> shots_of(const ClipView& view) {
    switch (view.layout) {
        case Layout::textured:
            return {{DrawStyle::textured, view.camera}};
        case Layout::components:
            return {{DrawStyle::components, view.camera}};
        case Layout::overlay:
            return {{DrawStyle::overlay, view.camera}};
        case Layout::side_by_side:
            return {{DrawStyle::textured, view.camera}, {DrawStyle::components, view.camera}};
    }
    return {};
}

}  // namespace unravel::tool
