#include "sim/terms/effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

// "[[cloth.pin]] (line 8), (line 14)": each table once, though a pin may stand for several corners.
template <typename List>
void add_places(const List& list, std::string& text) {
    for (const auto& item : list) {
        const std::string place = place_text(item.place);
        if (text.find(place) == text.npos) text += (text.ends_with(')') ? "," : "") + place;
    }
}

}  // namespace

std::string place_text(const SourcePlace& place) {
    if (place.option > 0) return fmt::format(" (--set #{})", place.option);
    if (place.file > 0) return fmt::format(" (line {} of included file {})", place.line, place.file);
    return place.line > 0 ? fmt::format(" (line {})", place.line) : std::string();
}

std::vector<Effect> list_effects(const Scene& scene) {
    std::vector<Effect> effects;
    for (const ForceTerm* const term : scene_terms) {
        if (term->effects) term->effects(scene, effects);
    }
    const auto add = [&](const char* name, bool on, const std::string& why, const char* why_not) {
        effects.push_back({name, on, on ? why : why_not});
    };
    bool pins = false, regions = false;
    std::string pin_places = "[[cloth.pin]]", region_places = "[[cloth.region]]";
    for (const Cloth& cloth : scene.cloths) {
        pins = pins || !cloth.pins.empty();
        regions = regions || !cloth.regions.empty();
        add_places(cloth.pins, pin_places);
        add_places(cloth.regions, region_places);
    }
    std::vector<Solid> rough;
    std::ranges::copy_if(scene.solids, std::back_inserter(rough),
                         [](const Solid& solid) { return solid.friction.static_ > 0; });
    add("regions", regions, region_places, "no [[cloth.region]]");
    add("pins", pins, pin_places, "no [[cloth.pin]]");
    add("solids", !scene.solids.empty(), "[[solid]]: " + names_of(scene.solids), "no [[solid]]");
    add("friction", !rough.empty(), "friction of " + names_of(rough), "no solid has friction");
    add("adaptive_step", scene.solver.adaptive.has_value(),
        "[solver.adaptive]" +
            place_text(scene.solver.adaptive ? scene.solver.adaptive->place : SourcePlace{}),
        "no [solver.adaptive]");
    return effects;
}

}  // namespace unravel::sim
