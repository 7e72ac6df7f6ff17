#pragma once

#include <string>
#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// An effect that a scene may call for, and why it is or is not simulated.
struct Effect {
    std::string name;  ///< as in run.json: "gravity", "solids", "wind", …
    bool on = false;
    std::string because;  ///< "[[solid]] at line 21: sphere, ground"
};

/// " (line 8)", or which --set named it; nothing where that is unknown.
std::string place_text(const SourcePlace& place);

/// "sphere (line 8), ground (line 14)"
template <typename List>
std::string names_of(const List& list) {
    std::string text;
    for (const auto& item : list) text += (text.empty() ? "" : ", ") + item.name + place_text(item.place);
    return text;
}

/// Every effect the simulator knows, on or off, in a fixed order.
std::vector<Effect> list_effects(const Scene& scene);

}  // namespace unravel::sim
