#include <fmt/core.h>

#include <cmath>
#include <string>

#include "sim/scene/limits.hpp"
#include "sim/scene_file/describe.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

constexpr Bounds length_bounds{1e-4, 1000, false, "m"};
constexpr Bounds friction_bounds{0, 100};

void describe(Fields& f, Friction& friction) {
    f.number({"static", "coefficient while held", true}, friction.static_, friction_bounds);
    f.number({"kinetic", "coefficient while sliding; default: 0.8 of static"}, friction.kinetic,
             friction_bounds);
}

// "of spheres, boxes": the shapes that have this size.
std::string of_shapes(bool ShapeSizes::*size, std::string_view what) {
    std::string text(what);
    const char* before = " of ";
    for (std::size_t s = 0; s < std::size(all_shapes); ++s) {
        if (!(all_shapes[s]->sizes.*size)) continue;
        text += before;
        text += shape_words[s];
        before = ", ";
    }
    return text;
}

}  // namespace

void describe_friction(Fields& f, const Key& key, Friction& friction) {
    const bool plain = f.number_or_table(key, friction.static_, friction_bounds, [&](Fields& g) {
        describe(g, friction);
        if (g.reading() && !g.says("kinetic")) friction.kinetic = 0.8 * friction.static_;
    });
    if (plain) friction.kinetic = 0.8 * friction.static_;
}

void describe(Fields& f, Fall& fall) {
    f.number({"time", "s, when it is let go; not before its motion has ended"}, fall.time, time_bounds);
    f.vector({"velocity", "m/s at that time"}, fall.velocity, speed_bounds);
    f.optional_number({"floor", "m, height at which its lowest point is stopped; default: nowhere"},
                      fall.floor, position_bounds);
    f.number({"bounce", "share of its speed that each bounce leaves"}, fall.bounce, {0, 0.99});
    f.number({"give", "m by which the floor yields in the first bounce, and in others as they are softer"},
             fall.give, {0, 10, false, "m"});
}

void describe(Fields& f, Repeat& repeat) {
    const bool read = !f.writing();
    f.integer({"count", "so many of them in a row", false, read}, repeat.count, 1,
              static_cast<int>(max_list));
    f.vector({"spacing", "m, from each to the next", false, read}, repeat.spacing, position_bounds);
    f.choice({"mirror", "another beyond the plane x = 0, y = 0 or z = 0, with all that it has", false, read},
             repeat.mirror);
    if (f.reading() && repeat.count > 1 && repeat.spacing.isZero(0))
        f.problem("count", fmt::format("{} of them in one place", repeat.count), "say spacing, too");
}

void describe(Fields& f, MeshFrames& frames, bool applies) {
    f.text({"mesh_frames", "how the mesh deforms: a PC2 file, or OBJ files numbered where the name has '#'",
            false, applies},
           frames.files, TextKind::path);
    f.text({"animation", "how the mesh deforms: an animation of its glTF file, by its name", false, applies},
           frames.animation, TextKind::name);
    if (f.says("mesh_frames") && f.says("animation"))
        f.problem("animation", "a mesh that deforms in two ways", "say mesh_frames or animation");
    const auto some = [&](bool said, bool there) {
        return applies && (f.reading() ? said : !f.writing() || there);
    };
    const bool samples = some(f.says("mesh_frames"), !frames.files.empty());
    const bool moves = some(f.says("mesh_frames") || f.says("animation"), frames.deforms());
    f.number({"mesh_fps", "samples per second", false, samples}, frames.fps, {1e-3, 1e5});
    f.number({"mesh_start", "s, when the first sample, or the animation's beginning, is due", false, moves},
             frames.start, {-3600, 3600, false, "s"});
    f.flag({"mesh_loop", "begin again at the end", false, moves && (!f.writing() || frames.loop)},
           frames.loop);
}

void describe(Fields& f, Solid& solid) {
    f.place(solid.place);
    f.text({"name", "for messages and reports"}, solid.name, TextKind::name);
    f.choice({"shape", "unrotated, a plane faces up, a cylinder or capsule stands", true}, solid.shape);
    const Shape shape = solid.shape;
    const bool mesh = shape == Shape::mesh;
    describe(f, solid.mesh,
             {"mesh", "OBJ, PLY, STL or glTF file in the scene's folder: a closed body", false,
              mesh || (!f.reading() && !f.writing())},
             true);
    if (f.reading() && mesh && !f.says("mesh"))
        f.problem("shape", "a mesh without a file", "write mesh = \"body.obj\"");
    describe(f, solid.frames, mesh || (!f.reading() && !f.writing()));
    const ShapeSizes has = law_of(shape).sizes;
    static const std::string radius = of_shapes(&ShapeSizes::radius, "m,"),
                             height = of_shapes(&ShapeSizes::height, "m,") +
                                      "; a capsule's is between the centres of its caps",
                             size = of_shapes(&ShapeSizes::size, "m, edge lengths"),
                             round = of_shapes(&ShapeSizes::round, "m, radius of the rounded edges");
    f.number({"radius", radius, false, has.radius}, solid.radius, length_bounds);
    f.number({"height", height, false, has.height}, solid.height, length_bounds);
    f.vector({"size", size, false, has.size}, solid.size, length_bounds);
    f.number({"round", round, false, has.round}, solid.round, {0, 1000, false, "m"});
    f.vector({"center", "m"}, solid.center, position_bounds);
    f.vector({"rotation", "degrees about x, then y, then z"}, solid.rotation, rotation_bounds);
    describe_path(f, {"motion", "keyframes: displacement from where it stands, and rotation about the pivot"},
                  solid.motion);
    if (f.reading()) solid.pivot = solid.center;
    f.vector({"pivot", "m, in the world at the start; default: the center"}, solid.pivot, position_bounds);
    f.optional_table({"fall", "it falls from where it stands, and bounces", false,
                      !f.reading() || mesh || std::isfinite(law_of(shape).reach(solid))},
                     solid.fall, Fall{}, [](Fields& g, Fall& fall) { describe(g, fall); });
    f.text({"parent", "name of the solid that it rides on; default: the world"}, solid.parent,
           TextKind::name);
    describe(f, solid.repeat);
    if (f.says("mirror") && solid.repeat.mirror != Mirror::none &&
        (mesh || !std::isfinite(law_of(shape).reach(solid))))
        f.problem("mirror", fmt::format("a {} has no mirror image here", word_of(shape)),
                  "place the other one by itself");
    describe_friction(
        f, {"friction", "a number, or {static, kinetic}; a number mu stands for static mu, kinetic 0.8 mu"},
        solid.friction);
    f.number({"offset", "m, distance at which cloth is held off the surface"}, solid.offset,
             {0, 1, false, "m"});
    f.choice(
        {"contact",
         "what of the cloth it holds off: particles alone, or edges and faces too, which \"auto\" says where "
         "cloth would sag into it between particles; not of meshes",
         false, !mesh || (!f.reading() && !f.writing())},
        solid.contact);
    f.text({"color", "\"#rrggbb\"; default: the look's"}, solid.color, TextKind::color);
}

}  // namespace unravel::sim
