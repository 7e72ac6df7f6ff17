#include "sim/model/effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/mesh/mesh_cloth.hpp"

namespace unravel::sim {

namespace {

std::string at(const SourcePlace& place) {
    if (place.option > 0) return fmt::format(" (--set #{})", place.option);
    return place.line > 0 ? fmt::format(" (line {})", place.line) : std::string();
}

// "[[cloth.pin]] (line 8), (line 14)": each table once, though a pin may stand for several corners.
template <typename List>
void add_places(const List& list, std::string& text) {
    for (const auto& item : list) {
        const std::string place = at(item.place);
        if (text.find(place) == text.npos) text += (text.ends_with(')') ? "," : "") + place;
    }
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
    bool stretch = false, shear = false, bend = false, pins = false, regions = false;
    std::string pin_places = "[[cloth.pin]]", region_places = "[[cloth.region]]";
    std::size_t seams = 0;
    for (const Cloth& cloth : scene.cloths) {
        if (cloth.geometry) {
            const auto quads = [](const MeshCloth::Cell& cell) { return cell.corners == 4; };
            stretch = true;
            shear = shear || (cloth.material.shear > 0 &&
                              std::any_of(cloth.geometry->cells.begin(), cloth.geometry->cells.end(), quads));
            bend = bend || cloth.material.bend > 0;
            seams += cloth.geometry->seams.size();
            pins = pins || !cloth.pins.empty();
            regions = regions || !cloth.regions.empty();
            add_places(cloth.pins, pin_places);
            add_places(cloth.regions, region_places);
            continue;
        }
        const bool grid = cloth.particles[0] > 1 && cloth.particles[1] > 1;
        stretch = stretch || cloth.particles[0] * cloth.particles[1] > 1;
        double most_shear = cloth.material.shear, most_bend = cloth.material.bend;
        for (const Region& region : cloth.regions) {
            if (!region.material) continue;
            most_shear = std::max(most_shear, region.material->shear);
            most_bend = std::max(most_bend, region.material->bend);
        }
        shear = shear || (grid && most_shear > 0);
        bend = bend || (most_bend > 0 && (cloth.particles[0] > 2 || cloth.particles[1] > 2));
        pins = pins || !cloth.pins.empty();
        regions = regions || !cloth.regions.empty();
        add_places(cloth.pins, pin_places);
        add_places(cloth.regions, region_places);
    }
    std::vector<Solid> rough;
    for (const Solid& solid : scene.solids) {
        if (solid.friction.static_ > 0) rough.push_back(solid);
    }
    add("stretch", stretch, "cloth: " + names(scene.cloths), "every cloth is a single particle");
    add("shear", shear, "a cloth has shear stiffness", "no cloth has shear stiffness");
    add("bend", bend, "a cloth has bending stiffness", "no cloth has bending stiffness");
    add("regions", regions, region_places, "no [[cloth.region]]");
    add("seams", seams > 0, fmt::format("a mesh has {} stitches (l lines)", seams),
        "no mesh has seams (l lines)");
    add("gravity", !scene.gravity.isZero(), fmt::format("{} m/s²", scene.gravity.norm()),
        "gravity = [0, 0, 0]");
    add("pins", pins, pin_places, "no [[cloth.pin]]");
    add("solids", !scene.solids.empty(), "[[solid]]: " + names(scene.solids), "no [[solid]]");
    add("friction", !rough.empty(), "friction of " + names(rough), "no solid has friction");
    add("wind", scene.wind.has_value(), "[wind]" + at(scene.wind ? scene.wind->place : SourcePlace{}),
        "no [wind]");
    add("self_collision", scene.self_collision.has_value(),
        "[self_collision]" + at(scene.self_collision ? scene.self_collision->place : SourcePlace{}),
        "no [self_collision]");
    add("adaptive_step", scene.solver.adaptive.has_value(),
        "[solver.adaptive]" + at(scene.solver.adaptive ? scene.solver.adaptive->place : SourcePlace{}),
        "no [solver.adaptive]");
    return effects;
}

}  // namespace unravel::sim
