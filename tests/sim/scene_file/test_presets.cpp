#include "sim/scene_file/presets.hpp"

#include <catch2/catch.hpp>

using namespace unravel;
using namespace unravel::sim;

TEST_CASE("presets are found by the names that the loader offers", "[scene]") {
    REQUIRE(preset_names().size() == material_presets().size());
    for (const std::string_view name : preset_names()) {
        REQUIRE(find_preset(name));
        CHECK(find_preset(name)->material.preset == name);
    }
    CHECK(!find_preset("lead"));
}

TEST_CASE("woven presets have the proportions of woven cloth", "[scene]") {
    for (const std::string_view name : {"cotton", "silk", "denim", "wool"}) {
        const MaterialPreset& preset = *find_preset(name);
        INFO(name);
        for (const double stretch : preset.material.stretch) {
            CHECK(stretch >= 400);
            CHECK(stretch <= 5000);
            CHECK(preset.material.shear < stretch / 10);
        }
        CHECK(preset.material.bend >= 1e-6);
        CHECK(preset.material.bend <= 1e-4);
    }
    CHECK(find_preset("silk")->material.bend < find_preset("cotton")->material.bend);
    CHECK(find_preset("silk")->material.bend < find_preset("denim")->material.bend);
    CHECK(find_preset("jersey")->material.stretch[0] < find_preset("denim")->material.stretch[0]);
    CHECK(find_preset("silk")->density < find_preset("denim")->density);
}
