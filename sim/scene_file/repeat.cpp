// What a scene says to repeat: rows and mirror images of cloths and solids.

#include <fmt/core.h>

#include <algorithm>

#include "sim/scene_file/check.hpp"

namespace unravel::sim {

namespace {

// Which coordinate a mirror turns round.
int axis_of(Mirror mirror) {
    return static_cast<int>(mirror) - static_cast<int>(Mirror::x);
}

Vec3 mirrored(Vec3 place, Mirror mirror) {
    place[axis_of(mirror)] *= -1;
    return place;
}

// Turned about the mirror's own axis it is the same, about others the other way round.
Vec3 mirrored_rotation(Vec3 degrees, Mirror mirror) {
    for (int c = 0; c < 3; ++c)
        if (c != axis_of(mirror)) degrees[c] *= -1;
    return degrees;
}

void mirror_motion(Motion& motion, Mirror mirror) {
    for (Keyframe& key : motion) {
        key.position = mirrored(key.position, mirror);
        key.rotation = mirrored_rotation(key.rotation, mirror);
    }
}

std::string mirror_name(const std::string& name) {
    return name.empty() ? name : name + " mirrored";
}

// The mirror image of what rides on a solid rides on that solid's mirror image, where it has one.
std::string mirrored_carrier(const std::string& name, const std::vector<Solid>& solids, Mirror mirror) {
    const bool has_image = std::ranges::any_of(
        solids, [&](const Solid& solid) { return solid.name == name && solid.repeat.mirror == mirror; });
    return has_image ? mirror_name(name) : name;
}

void mirror_one(Solid& solid, const std::vector<Solid>& solids, Mirror mirror) {
    solid.center = mirrored(solid.center, mirror);
    solid.pivot = mirrored(solid.pivot, mirror);
    // Every shape that may be mirrored is its own mirror image across each of its axes.
    solid.rotation = mirrored_rotation(solid.rotation, mirror);
    mirror_motion(solid.motion, mirror);
    if (solid.fall) solid.fall->velocity = mirrored(solid.fall->velocity, mirror);
    solid.parent = mirrored_carrier(solid.parent, solids, mirror);
}

// "u0v1" → "u1v1" where u runs the other way.
void turn_round(std::string& edge_or_corner, char direction) {
    const std::size_t at = edge_or_corner.find(direction);
    if (at == edge_or_corner.npos) return;
    char& end = edge_or_corner[at + 1];
    end = end == '0' ? '1' : '0';
}

// The mirror image of a sheet with its front and back where the image has them: one of its directions runs
// the other way, the one that crosses the mirror, or u where its front does.
void mirror_one(Cloth& cloth, const std::vector<Solid>& solids, Mirror mirror) {
    constexpr Facing opposite[] = {Facing::down,  Facing::up,    Facing::back,
                                   Facing::front, Facing::right, Facing::left};
    // Where u, the front and v of each facing look: x 0, y 1, z 2.
    constexpr int axes[][3] = {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}, {0, 2, 1}, {2, 0, 1}, {2, 0, 1}};
    const int* const looks = axes[static_cast<int>(cloth.facing)];
    const int across = axis_of(mirror);
    const char direction = looks[2] == across ? 'v' : 'u';
    const int d = direction == 'u' ? 0 : 1;
    cloth.center = mirrored(cloth.center, mirror);
    cloth.velocity = mirrored(cloth.velocity, mirror);
    cloth.rotation = mirrored_rotation(cloth.rotation, mirror);
    if (looks[1] == across) cloth.facing = opposite[static_cast<int>(cloth.facing)];
    if (cloth.start) turn_round(cloth.start->from, direction);
    const auto turn_box = [&](UvBox& box) {
        std::swap(box.low[d], box.high[d]);
        box.low[d] = 1 - box.low[d];
        box.high[d] = 1 - box.high[d];
    };
    for (Region& region : cloth.regions) turn_box(region.box);
    for (Pin& pin : cloth.pins) {
        turn_round(pin.name, direction);
        turn_box(pin.box);
        pin.disc.center[d] = 1 - pin.disc.center[d];
        const auto first = static_cast<std::size_t>(2 * d), axis = static_cast<std::size_t>(d);
        std::swap(pin.range[first], pin.range[first + 1]);
        pin.range[first] = cloth.particles[axis] - 1 - pin.range[first];
        pin.range[first + 1] = cloth.particles[axis] - 1 - pin.range[first + 1];
        pin.slide = mirrored(pin.slide, mirror);
        mirror_motion(pin.motion, mirror);
        pin.to = mirrored_carrier(pin.to, solids, mirror);
        pin.rod = mirrored_carrier(pin.rod, solids, mirror);
    }
}

void displace(Solid& solid, const Vec3& by) {
    solid.center += by;
    solid.pivot += by;
}

void displace(Cloth& cloth, const Vec3& by) {
    cloth.center += by;
}

// Calls added(i) for each thing that the i-th brought about. A row is mirrored as a whole.
template <class T, class Added>
void repeat_all(std::vector<T>& things, const std::vector<Solid>& solids, Added&& added) {
    const std::size_t written = things.size();
    for (std::size_t i = 0; i < written; ++i) {
        const Repeat repeat = things[i].repeat;
        const auto mirror_of = [&](T thing) {
            mirror_one(thing, solids, repeat.mirror);
            thing.name = mirror_name(thing.name);
            things.push_back(std::move(thing));
            added(i);
        };
        for (int k = 1; k < repeat.count; ++k) {
            T copy = things[i];
            displace(copy, k * repeat.spacing);
            if (!copy.name.empty()) copy.name = fmt::format("{} {}", copy.name, k + 1);
            things.push_back(copy);
            added(i);
            if (repeat.mirror != Mirror::none) mirror_of(std::move(copy));
        }
        if (repeat.mirror != Mirror::none) mirror_of(things[i]);
    }
}

}  // namespace

void repeat_things(Scene& scene, Places& places) {
    const std::vector<Solid> solids = scene.solids;
    const std::size_t cloths = scene.cloths.size(), looks = scene.look.cloth.size();
    repeat_all(scene.cloths, solids, [&](std::size_t i) {
        places.repeat(fmt::format("cloth[{}]", i), fmt::format("cloth[{}]", scene.cloths.size() - 1));
        // It looks like the one that it repeats.
        if (looks < 2) return;
        while (scene.look.cloth.size() < cloths) scene.look.cloth.push_back(scene.look.cloth.back());
        scene.look.cloth.push_back(scene.look.cloth[i]);
    });
    repeat_all(scene.solids, solids, [&](std::size_t i) {
        places.repeat(fmt::format("solid[{}]", i), fmt::format("solid[{}]", scene.solids.size() - 1));
    });
    for (Cloth& cloth : scene.cloths) cloth.repeat = {};
    for (Solid& solid : scene.solids) solid.repeat = {};
}

}  // namespace unravel::sim
