#include "sim/effects.hpp"

#include <fmt/format.h>

namespace unravel {

namespace {

std::string at(const SourcePlace& place) {
    if (place.option > 0) return fmt::format(" (--set #{})", place.option);
    return place.line > 0 ? fmt::format(" (line {})", place.line) : std::string();
}

template <typename List>
std::string names(const List& list) {
    std::string text;
    for (const auto& item : list)
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", item.name, at(item.place));
    return text;
}

}  // namespace

std::vector<Effect> list_effects(const Scene& scene) {
    std::vector<Effect> effects;
    const auto add = [&](const char* name, bool on, const std::string& why, const char* why_not) {
        effects.push_back({name, on, on ? why : why_not});
    };
    bool stretch = false, shear = false, bend = false, pins = false, regions = false, friction = false;
    for (const Cloth& cloth : scene.cloths) {
        const bool grid = cloth.particles[0] > 1 && cloth.particles[1] > 1;
        stretch = stretch || cloth.particles[0] * cloth.particles[1] > 1;
        shear = shear || (grid && cloth.material.shear > 0);
        bend = bend || (cloth.material.bend > 0 && (cloth.particles[0] > 2 || cloth.particles[1] > 2));
        pins = pins || !cloth.pins.empty();
        regions = regions || !cloth.regions.empty();
    }
    for (const Solid& solid : scene.solids) friction = friction || solid.friction.static_ > 0;
    add("stretch", stretch, "cloth: " + names(scene.cloths), "every cloth is a single particle");
    add("shear", shear, "a cloth has shear stiffness", "no cloth has shear stiffness");
    add("bend", bend, "a cloth has bending stiffness", "no cloth has bending stiffness");
    add("regions", regions, "a cloth has [[cloth.region]]", "no [[cloth.region]]");
    add("gravity", !scene.gravity.isZero(), fmt::format("{} m/s²", scene.gravity.norm()),
        "gravity = [0, 0, 0]");
    add("pins", pins, "a cloth has [[cloth.pin]]", "no [[cloth.pin]]");
    add("solids", !scene.solids.empty(), "[[solid]]: " + names(scene.solids), "no [[solid]]");
    add("friction", friction, "a solid has friction", "no solid has friction");
    add("wind", scene.wind.has_value(), "[wind]" + at(scene.wind ? scene.wind->place : SourcePlace{}),
        "no [wind]");
    add("self_collision", scene.self_collision.has_value(),
        "[self_collision]" + at(scene.self_collision ? scene.self_collision->place : SourcePlace{}),
        "no [self_collision]");
    add("adaptive_step", scene.solver.adaptive.has_value(), "[solver.adaptive]", "no [solver.adaptive]");
    return effects;
}

}  // namespace unravel
