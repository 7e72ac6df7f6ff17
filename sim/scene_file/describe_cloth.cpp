#include <fmt/core.h>

#include "sim/mesh/start_line.hpp"
#include "sim/scene/limits.hpp"
#include "sim/scene_file/check.hpp"
#include "sim/scene_file/describe.hpp"
#include "sim/scene_file/presets.hpp"

namespace unravel::sim {

namespace {

constexpr std::string_view corners[] = {"u0v0", "u1v0", "u0v1", "u1v1"};
constexpr std::string_view edges[] = {"u0", "u1", "v0", "v1"};
constexpr Bounds density_bounds{1e-4, 1000, false, "kg/m²"};

void describe_box(Fields& f, const Key& key, UvBox& box) {
    std::array<double, 4> values{box.low.x(), box.low.y(), box.high.x(), box.high.y()};
    f.numbers(key, values, {0, 1});
    box.low = {values[0], values[1]};
    box.high = {values[2], values[3]};
    if (f.reading() && (values[0] > values[2] || values[1] > values[3]))
        f.problem(key.name, "'box' runs backwards", "write the lower corner first: [u0, v0, u1, v1]");
}

// What only the whole cloth shows to be wrong with its start shape.
void check_start_shape(Fields& f, const Cloth& cloth) {
    if (!f.reading() || !cloth.start || !f.sound("start") || !f.sound("size") || !f.sound("placed_scale"))
        return;
    if (cloth.wrap == Wrap::tube) {
        f.problem("start", "a tube has a start shape of its own", "say start of a sheet only");
        return;
    }
    const std::size_t axis = cloth.start->from.starts_with('u') ? 0 : 1;
    const UnfitStart unfit = unfit_start(*cloth.start, cloth.size[axis] * cloth.placed_scale[axis]);
    if (!unfit.what.empty()) f.problem("start", unfit.what, unfit.hint);
}

}  // namespace

void describe(Fields& f, MeshFile& mesh, const Key& file, bool body) {
    f.text(file, mesh.file, TextKind::path);
    const bool has = f.reading() ? f.says(file.name) : !file.applies || !mesh.file.empty();
    const bool applies = file.applies && has;
    f.text({"mesh_object", "only this object of the file (an o line, a node of glTF)", false, applies},
           mesh.object, TextKind::name);
    f.text({"mesh_group", "only this group of the file (a g line, a material of glTF)", false, applies},
           mesh.group, TextKind::name);
    f.number({"mesh_scale", "metres per unit of the mesh's file", false, applies}, mesh.scale,
             {1e-6, 1e6, false, "m"});
    f.choice({"mesh_up", "which axis of the mesh's file points up", false, applies}, mesh.up);
    // What is mended differs from the rest in that it is written only where it was said.
    bool merge = mesh.merge.value_or(body);
    f.flag({"mesh_merge", "vertices in one place become one; default: of bodies, and asked about of cloth",
            false, applies && (!f.writing() || mesh.merge)},
           merge);
    if (f.reading() && f.says("mesh_merge")) mesh.merge = merge;
    if (body) {
        f.choice({"mesh_holes", "which holes are closed: those of up to 1% of the surface, or all", false,
                  applies && (!f.writing() || mesh.holes != MeshHoles::small)},
                 mesh.holes);
        f.number({"mesh_shell", "m, thickness of a surface with two sides; 0: a solid body", false,
                  applies && (!f.writing() || mesh.shell > 0)},
                 mesh.shell, {0, 100, false, "m"});
    }
    f.text({"mesh_hash", "written by the tool: the file must have this content", false, applies}, mesh.hash,
           TextKind::name);
}

void describe(Fields& f, Cloth& cloth) {
    f.place(cloth.place);
    f.text({"name", "for messages and reports"}, cloth.name, TextKind::name);
    describe(f, cloth.mesh,
             {"mesh", "OBJ, PLY, STL or glTF file in the scene's folder; replaces particles and size"},
             false);
    // A mesh brings its own particles and size; the schema shows the keys of both.
    const bool mesh = f.reading() ? f.says("mesh") : !cloth.mesh.file.empty();
    const bool grid = !mesh;
    if (mesh || !f.writing())
        f.table({"sewing", "how the seams of a mesh (its l lines) close", false, mesh || !f.reading()},
                [&](Fields& g) {
                    g.number({"time", "s until they are closed"}, cloth.sewing.time, {0, 3600, false, "s"});
                    g.number({"stiffness", "N/m of a stitch; 0: ten times the cloth's stiffest edge"},
                             cloth.sewing.stiffness, {0, 1e9, false, "N/m"});
                });
    f.integers({"particles", "along u and along v; a mesh brings its own", false, grid}, cloth.particles, 1,
               max_particles);
    f.numbers({"size", "m, flat and at rest, along u and along v; a mesh brings its own", false, grid},
              cloth.size, {1e-4, 1000, false, "m"});
    // The material comes first: a preset brings a density, which the cloth's own replaces.
    f.table({"material", "a preset, numbers, or a preset and the numbers that differ"},
            [&](Fields& g) { describe(g, cloth.material); });
    if (const MaterialPreset* preset = f.reading() ? find_preset(cloth.material.preset) : nullptr)
        cloth.density = preset->density;
    f.choice(
        {"bend_model",
         "\"curvature\": linear in it, and arcs where cloth buckles between particles; \"buckling\": the "
         "arcs of Choi & Ko 2002 alone, as in the paper"},
        cloth.bend_model);
    f.number({"density", "kg/m²; default: the material preset's, else 0.2"}, cloth.density, density_bounds);
    f.choice({"wrap", "\"tube\": closed along u, for sleeves; of grids only", false, grid}, cloth.wrap);
    if (f.sound("particles") && f.sound("wrap") && cloth.wrap == Wrap::tube && cloth.particles[0] < 3)
        f.problem("particles", "a tube of fewer than 3 particles around", "make the first number 3 or more");
    f.vector({"center", "m"}, cloth.center, position_bounds);
    f.vector({"rotation", "degrees about x, then y, then z; unrotated it lies flat"}, cloth.rotation,
             rotation_bounds);
    f.choice({"facing", "where its front looks before it is rotated; upright, v = 0 is above", false,
              !f.writing() || cloth.facing != Facing::up},
             cloth.facing);
    f.vector({"velocity", "m/s at the start"}, cloth.velocity, speed_bounds);
    f.numbers({"placed_scale", "size as placed over size at rest, along u and along v; 1.08: pre-stretched",
               false, grid},
              cloth.placed_scale, {0, 10});
    f.optional_table({"start", "how it lies at the start; absent: flat. Of sheets only", false, grid},
                     cloth.start, Start{}, [](Fields& g, Start& start) { describe(g, start); });
    check_start_shape(f, cloth);
    f.optional_table({"wrinkles", "smooth random displacement along the normal at the start"}, cloth.wrinkles,
                     Wrinkles{}, [](Fields& g, Wrinkles& wrinkles) { describe(g, wrinkles); });
    f.number({"jitter", "m, random displacement along the normal at the start"}, cloth.jitter,
             {0, 1, false, "m"});
    f.seed({"seed", "of the jitter"}, cloth.seed);
    describe(f, cloth.repeat);
    if (f.says("mirror") && cloth.repeat.mirror != Mirror::none && mesh)
        f.problem("mirror", "a mesh has no mirror image here", "mirror its file");
    const bool mirrored_tube = cloth.repeat.mirror != Mirror::none && cloth.wrap == Wrap::tube;
    f.list({"region", "parts made of something else; a later one covers an earlier one"}, cloth.regions,
           ListForm::tables, [&](Fields& g, Region& region) { describe(g, region, cloth); });

    std::vector<Pin> pins;
    f.list(
        {"pin", "particles that are held or moved"}, cloth.pins, ListForm::tables, [&](Fields& g, Pin& pin) {
            std::vector<std::string> names{pin.name};
            describe(g, pin, names);
            if (g.reading() && grid) check_pin(f, g, cloth, pin, names);
            if (g.says(word_of(pin.target)) && mesh != (pin.target >= PinTarget::group))
                g.problem(word_of(pin.target),
                          fmt::format("a pin by '{}' of a {}", word_of(pin.target), mesh ? "mesh" : "grid"),
                          mesh ? "say group or within" : "say corner, edge, particles, box or disc");
            if (g.reading() && mirrored_tube && pin.target == PinTarget::particles)
                g.problem("particles", "indices around a tube that has a mirror image", "say box or disc");
            for (const std::string& name : names) {
                pins.push_back(pin);
                pins.back().name = name;
            }
        });
    if (f.reading()) cloth.pins = std::move(pins);
}

void describe(Fields& f, Material& material) {
    f.word({"preset",
            "a measured fabric; gives every number of the material that is not said, and the "
            "cloth's density"},
           material.preset, preset_names());
    if (f.reading() && f.says("preset")) {
        if (const MaterialPreset* preset = find_preset(material.preset)) material = preset->material;
    }
    f.number_or_pair(
        {"stretch", "N/m, force per width and strain, held in its width; a number, or [along u, along v]"},
        material.stretch, {0, 1e9, false, "N/m"});
    f.number_or_pair({"stretch_damping", "N·s/m; a number, or [along u, along v]"}, material.stretch_damping,
                     {0, 1e6, false, "N·s/m"});
    f.number({"shear", "N/m, shear modulus times thickness; 0: no shear springs at all"}, material.shear,
             {0, 1e9, false, "N/m"});
    // What has no stiffness is not damped by default either.
    if (f.reading() && f.says("shear") && material.shear == 0) material.shear_damping = 0;
    f.number({"shear_damping", "N·s/m"}, material.shear_damping, {0, 1e6, false, "N·s/m"});
    f.number({"bend", "N·m, bending stiffness per width"}, material.bend, {0, 100, false, "N·m"});
    f.number({"buckling_strain", "compression from which a strip pushes as a buckled arc"},
             material.buckling_strain, {0, 0.5, true});
}

void describe(Fields& f, Region& region, const Cloth& cloth) {
    f.place(region.place);
    f.exactly_one({"box", "group"});
    const bool grouped = f.writing() && !region.group.empty();
    describe_box(f, {"box", "[u0, v0, u1, v1], each from 0 to 1", false, !grouped}, region.box);
    f.text({"group", "of a mesh: springs with both ends in it"}, region.group, TextKind::name);
    if (f.reading() && f.says("group") && cloth.mesh.file.empty())
        f.problem("group", "a grid has no groups", "say box");
    if (f.reading() && f.says("box") && !cloth.mesh.file.empty())
        f.problem("box", "a mesh has no place for a box", "say group");
    // The numbers are inherited, the preset's name is not: it stands for a density, too.
    Material own = cloth.material;
    own.preset.clear();
    f.optional_table({"material", "numbers that are not said are the cloth's own"}, region.material, own,
                     [&](Fields& g, Material& material) {
                         describe(g, material);
                         const MaterialPreset* preset =
                             g.says("preset") ? find_preset(material.preset) : nullptr;
                         if (preset) region.density = preset->density;
                     });
    f.optional_number({"density", "kg/m²; default: the region's preset's, else the cloth's"}, region.density,
                      density_bounds);
}

void describe(Fields& f, Pin& pin, std::vector<std::string>& names) {
    f.exactly_one({"corner", "edge", "particles", "box", "disc", "group", "within"});
    const auto is = [&](PinTarget target) { return f.reading() || pin.target == target; };
    // `names` holds the pin's own name when written; read, it starts anew with what the file says.
    if (f.reading()) names.assign(1, "");
    f.words({"corner", "a corner or several", false, is(PinTarget::corner)}, names, corners);
    f.words({"edge", "a whole edge or several", false, is(PinTarget::edge)}, names, edges);
    f.integers({"particles", "first and last grid index along u, then along v, from 0", false,
                is(PinTarget::particles)},
               pin.range, 0, max_particles - 1);
    describe_box(f, {"box", "[u0, v0, u1, v1], each from 0 to 1", false, is(PinTarget::box)}, pin.box);
    f.table({"disc", "particles within a radius along the flat cloth", false, is(PinTarget::disc)},
            [&](Fields& g) {
                g.numbers({"center", "[u, v], each from 0 to 1"}, {pin.disc.center.data(), 2}, {0, 1});
                g.number({"radius", "m", true}, pin.disc.radius, {0, 1000, true, "m"});
            });
    f.text({"group", "vertices of a group of the mesh", false, is(PinTarget::group)}, pin.group,
           TextKind::name);
    std::array<double, 6> within{pin.within.low.x(),  pin.within.low.y(),  pin.within.low.z(),
                                 pin.within.high.x(), pin.within.high.y(), pin.within.high.z()};
    f.numbers({"within", "[x0, y0, z0, x1, y1, z1], m: vertices of the mesh that start in this box", false,
               is(PinTarget::within)},
              within, position_bounds);
    pin.within = {{within[0], within[1], within[2]}, {within[3], within[4], within[5]}};
    if (f.reading()) {
        if (f.says("group")) pin.target = PinTarget::group;
        if (f.says("within")) pin.target = PinTarget::within;
        if (f.says("corner")) pin.target = PinTarget::corner;
        if (f.says("edge")) pin.target = PinTarget::edge;
        if (f.says("particles")) pin.target = PinTarget::particles;
        if (f.says("box")) pin.target = PinTarget::box;
        if (f.says("disc")) pin.target = PinTarget::disc;
    }
    f.place(pin.place, word_of(pin.target));
    const bool edge = !f.reading() || pin.target == PinTarget::edge;
    f.integer({"count", "of the particles along an edge so many, evenly spaced, such as hooks; 0: all", false,
               edge && (!f.writing() || pin.count > 0)},
              pin.count, 0, max_particles);
    f.optional_number(
        {"gather", "m, to which the row of its particles is drawn together; of an edge", false, edge},
        pin.gather, {1e-3, 1000, false, "m"});
    f.number({"gather_time", "s that this takes, from the start: of the settling where the clip has one",
              false, f.reading() ? f.says("gather") : !f.writing() || pin.gather},
             pin.gather_time, {1e-3, max_time, false, "s"});
    f.text({"to", "name of the solid that it rides on, also of one that deforms; default: the world"}, pin.to,
           TextKind::name);
    f.vector({"slide", "direction in which its particles are free to move; default: they are held", false,
              !f.writing() || !pin.slide.isZero(0)},
             pin.slide, {-1000, 1000});
    f.text({"rod", "name of a cylinder or capsule along which its particles slide, as far as its ends"},
           pin.rod, TextKind::name);
    describe_path(
        f, {"motion", "keyframes: displacement from, and rotation about the centre of, the pinned particles"},
        pin.motion);
    for (const char* other : {"to", "slide"}) {
        if (f.says("rod") && f.says(other))
            f.problem(other, fmt::format("'{}' beside 'rod'", other),
                      "what slides on a rod rides on it, too");
    }
    if (f.says("rod") && f.says("motion"))
        f.problem("motion", "'motion' beside 'rod'", "what slides on a rod goes where the rod goes");
    const auto displaced = [](const Keyframe& key) {
        return !key.position.isZero(0) || !key.rotation.isZero(0);
    };
    if (f.reading() && !pin.motion.empty() && f.sound("motion") && displaced(pin.motion.front()))
        f.problem("motion", "the motion begins away from where the pin stands: the cloth would be torn there",
                  fmt::format("begin with {{ time = {} }}; positions and rotations count from the start",
                              pin.motion.front().time > 0 ? 0 : pin.motion.front().time));
    f.optional_number({"release", "s, when it lets go; absent: never"}, pin.release, time_bounds);
}

void describe(Fields& f, Keyframe& key) {
    f.number({"time", "s", true}, key.time, time_bounds);
    f.vector({"position", "m"}, key.position, position_bounds);
    f.vector({"rotation", "degrees about x, then y, then z"}, key.rotation, rotation_bounds);
    f.choice({"interpolation", "on the way to the next keyframe; default: the path's", false,
              !f.writing() || key.interpolation != Interpolation::smooth},
             key.interpolation);
}

void describe_path(Fields& f, const Key& motion, Motion& keys) {
    Interpolation all = Interpolation::smooth;
    f.choice(
        {"interpolation",
         "between keyframes: smooth (speed is continuous, at rest in the first and the last), linear, hold "
         "(jumps), or ease (from rest to rest)",
         false, !f.writing()},
        all);
    f.list(motion, keys, ListForm::inline_tables,
           [all, next = in_order<Keyframe>()](Fields& g, Keyframe& key) mutable {
               if (g.reading()) key.interpolation = all;
               next(g, key);
           });
}

}  // namespace unravel::sim
