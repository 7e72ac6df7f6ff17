#pragma once

#include <string>
#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// A picture that a scene's look names.
struct NamedPicture {
    std::string key;   ///< "look.cloth[0].texture"
    std::string file;  ///< relative to the scene's folder
};

/// All of them, in the order of the keys.
std::vector<NamedPicture> look_pictures(const Look& look);

}  // namespace unravel::sim
