#include "sim/scene_file/describe.hpp"

namespace unravel::sim {

void describe(Fields& f, Wind& wind) {
    f.place(wind.place);
    f.vector({"velocity", "m/s; zero: still air that resists"}, wind.velocity, speed_bounds);
    f.list({"keyframes", "velocity over time, instead of `velocity`"}, wind.keyframes,
           ListForm::inline_tables, in_order<WindKey>());
    f.optional_table(
        {"gust", "a smooth random factor on the wind"}, wind.gust, Gust{}, [](Fields& g, Gust& gust) {
            g.number({"strength", "standard deviation of the speed over its mean"}, gust.strength, {0, 10});
            g.number({"period", "s"}, gust.period, {1e-3, max_time, false, "s"});
            g.seed({"seed", "another seed, other gusts"}, gust.seed);
        });
    f.number({"density", "kg/m³, of the air"}, wind.density, {0, 1e4, false, "kg/m³"});
    f.number({"drag", "coefficient on the velocity along the cloth's normal"}, wind.drag, {0, 1000});
    f.number({"lift", "coefficient on the velocity along the cloth"}, wind.lift, {0, 1000});
}

void describe(Fields& f, WindKey& key) {
    f.number({"time", "s", true}, key.time, time_bounds);
    f.vector({"velocity", "m/s", true}, key.velocity, speed_bounds);
}

void describe(Fields& f, Camera::Key& key) {
    f.number({"time", "s", true}, key.time, time_bounds);
    f.vector({"position", "m", true}, key.position, position_bounds);
    f.vector({"target", "m", true}, key.target, position_bounds);
}

void describe(Fields& f, SelfCollision& self) {
    f.place(self.place);
    f.number({"thickness", "m; 0: from the particle spacing"}, self.thickness, {0, 1, false, "m"});
    f.number({"stiffness", "N/m; 0: from the material"}, self.stiffness, {0, 1e9, false, "N/m"});
    f.number({"damping", "N·s/m"}, self.damping, {0, 1e6, false, "N·s/m"});
}

void describe(Fields& f, Camera& camera) {
    f.text({"name", "for messages and file names"}, camera.name, TextKind::name);
    f.vector({"position", "m"}, camera.position, position_bounds);
    f.vector({"target", "m, the point looked at"}, camera.target, position_bounds);
    f.number({"fov", "degrees, vertical"}, camera.fov, {1, 170, false, "degrees"});
    f.number({"orbit", "degrees turned about the target over the clip"}, camera.orbit, rotation_bounds);
    f.list({"keyframes", "position and target over time, instead of `position` and `target`"},
           camera.keyframes, ListForm::inline_tables, in_order<Camera::Key>());
    f.choice({"interpolation", "between keyframes: smooth, linear, hold (cuts), or ease (from rest to rest)",
              false, !f.writing() || camera.interpolation != Interpolation::smooth},
             camera.interpolation);
}

void describe(Fields& f, Look& look) {
    f.list({"cloth", "one per cloth; the last serves the rest"}, look.cloth, ListForm::tables,
           [](Fields& g, ClothLook& cloth) { describe(g, cloth); });
    f.text({"background", "\"#rrggbb\""}, look.background, TextKind::color);
    f.text({"ground", "\"#rrggbb\""}, look.ground, TextKind::color);
    f.text({"solid", "\"#rrggbb\", of solids that have no color of their own"}, look.solid, TextKind::color);
    f.flag({"show_ground", "draw a ground"}, look.show_ground);
    f.optional_number({"ground_height", "m; default: under the lowest plane or under everything"},
                      look.ground_height, position_bounds);
    f.choice({"show", "what the colours of the component view tell"}, look.show);
    f.number({"show_max", "where the scale ends: strain (1) or velocity (m/s); 0: 0.05, 3"}, look.show_max,
             {0, 1e6});
    f.flag({"legend", "tell in the picture what its colours mean"}, look.legend);
    f.flag({"transparent", "no ground and no background: frames with an alpha channel"}, look.transparent);
    f.integer(
        {"subdivide", "times that each cell is drawn as four smooth ones; -1: as a coarse grid needs it"},
        look.subdivide, -1, 3);
    f.integer({"motion_blur", "sub-frames that a picture is the mean of; 1: none"}, look.motion_blur, 1, 64);
    f.number({"shutter", "share of the time between frames that the shutter is open"}, look.shutter,
             {0, 1, true});
}

void describe(Fields& f, ClothLook& cloth) {
    f.choice({"weave", "the pattern of the two yarns"}, cloth.weave);
    f.text({"front", "\"#rrggbb\", first yarn of the front"}, cloth.front, TextKind::color);
    f.text({"front_second", "\"#rrggbb\", second yarn of the front"}, cloth.front_second, TextKind::color);
    f.text({"back", "\"#rrggbb\""}, cloth.back, TextKind::color);
    f.number({"scale", "m, period of checks or stripes"}, cloth.scale, {1e-4, 100, false, "m"});
    f.text({"texture",
            "PNG file in the scene's folder; replaces the weave on the front, once over a grid, on a mesh as "
            "its "
            "texture coordinates say"},
           cloth.texture, TextKind::path);
}

}  // namespace unravel::sim
