// Cameras, light, and how things look.
#include "sim/scene_file/describe.hpp"

namespace unravel::sim {

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
    f.text({"follow", "name of a solid or cloth that position and target go along with"}, camera.follow,
           TextKind::name);
    f.flag(
        {"fit",
         "stand, without being turned, where what is known beforehand and its shadow fill the picture; not "
         "with `follow`"},
        camera.fit);
    f.number({"aperture", "m, across the lens; 0: all is sharp; drawn with --quality final"}, camera.aperture,
             {0, 10, false, "m"});
    f.optional_number({"focus", "m, distance of what is sharp; default: the target's"}, camera.focus,
                      {0, max_length, true, "m"});
}

void describe(Fields& f, Camera::Key& key) {
    f.number({"time", "s", true}, key.time, time_bounds);
    f.vector({"position", "m", true}, key.position, position_bounds);
    f.vector({"target", "m", true}, key.target, position_bounds);
}

void describe(Fields& f, Look& look) {
    f.list({"cloth", "one per cloth; the last serves the rest"}, look.cloth, ListForm::tables,
           [](Fields& g, ClothLook& cloth) { describe(g, cloth); });
    f.list({"body", "one per solid; the last serves the rest"}, look.body, ListForm::tables,
           [](Fields& g, BodyLook& body) { describe(g, body); });
    f.table({"sun", "the lamp that casts shadows with edges"}, [&](Fields& g) { describe(g, look.sun); });
    f.table({"sky", "light from all around"}, [&](Fields& g) { describe(g, look.sky); });
    f.number({"exposure", "stops: each doubles all light"}, look.exposure, {-20, 20, false, "stops"});
    f.text({"background", "\"#rrggbb\""}, look.background, TextKind::color);
    f.text({"background_top", "\"#rrggbb\", of a gradient from `background` at the picture's bottom"},
           look.background_top, TextKind::color);
    f.text({"background_image", "PNG file in the scene's folder; fills the picture, cut where it is wider"},
           look.background_image, TextKind::path);
    f.text({"ground", "\"#rrggbb\""}, look.ground, TextKind::color);
    f.text({"ground_texture", "PNG file in the scene's folder, repeated; replaces the ground's colour"},
           look.ground_texture, TextKind::path);
    f.number({"ground_scale", "m of the ground that its texture spans"}, look.ground_scale,
             {1e-3, 1000, false, "m"});
    f.flag({"horizon", "the ground goes on to the horizon, not only to a little beyond the scene"},
           look.horizon);
    f.text({"solid", "\"#rrggbb\", of solids that have no color of their own"}, look.solid, TextKind::color);
    f.flag({"show_ground", "draw a ground"}, look.show_ground);
    f.optional_number({"ground_height", "m; default: under the lowest plane or under everything"},
                      look.ground_height, position_bounds);
    f.choice({"show", "what the colours of the component view tell"}, look.show);
    f.number({"show_max",
              "where the scale ends: strain (1) or velocity (m/s); 0: by `render` where the clip's 99th "
              "percentile is, by `run`, which does not know the clip yet, 0.05 or 3"},
             look.show_max, {0, 1e6});
    f.choice({"theme", "the component view on a screen's dark ground, or as a figure on a white page"},
             look.theme);
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
            "its texture coordinates say"},
           cloth.texture, TextKind::path);
}

void describe(Fields& f, BodyLook& body) {
    f.choice({"finish", "how the surface takes the light"}, body.finish);
    f.text({"texture",
            "PNG file in the scene's folder, repeated, laid on from three sides; replaces the colour"},
           body.texture, TextKind::path);
    f.number({"scale", "m of the surface that the texture spans"}, body.scale, {1e-3, 1000, false, "m"});
}

void describe(Fields& f, Sun& sun) {
    f.vector({"direction", "towards it, of any length"}, sun.direction, {-1e6, 1e6});
    f.text({"color", "\"#rrggbb\"; default: a warm white"}, sun.color, TextKind::color);
    f.number({"strength", "of the usual; 0: no sun"}, sun.strength, {0, 100});
    f.optional_number({"softness", "degrees that it is across; default: 5.7"}, sun.softness,
                      {0, 60, false, "degrees"});
}

void describe(Fields& f, Sky& sky) {
    f.text({"color", "\"#rrggbb\"; default: a cool white with a share of the background"}, sky.color,
           TextKind::color);
    f.number({"strength", "of the usual; 0: no light but the sun's"}, sky.strength, {0, 100});
    f.text({"image",
            "PNG file in the scene's folder, twice as wide as high: all directions, the top row straight up, "
            "its middle towards -z; its colours light the scene"},
           sky.image, TextKind::path);
    f.flag({"show", "the image is the background, too"}, sky.show);
}

}  // namespace unravel::sim
