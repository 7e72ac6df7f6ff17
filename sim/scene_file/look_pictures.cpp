#include "sim/scene_file/look_pictures.hpp"

#include <fmt/core.h>

namespace unravel::sim {

std::vector<NamedPicture> look_pictures(const Look& look) {
    std::vector<NamedPicture> pictures;
    const auto add = [&](std::string key, const std::string& file) {
        if (!file.empty()) pictures.push_back({std::move(key), file});
    };
    for (std::size_t i = 0; i < look.cloth.size(); ++i)
        add(fmt::format("look.cloth[{}].texture", i), look.cloth[i].texture);
    for (std::size_t i = 0; i < look.body.size(); ++i)
        add(fmt::format("look.body[{}].texture", i), look.body[i].texture);
    add("look.sky.image", look.sky.image);
    add("look.background_image", look.background_image);
    add("look.ground_texture", look.ground_texture);
    return pictures;
}

}  // namespace unravel::sim
