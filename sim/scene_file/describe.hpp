#pragma once

// The keys of each table of the scene file: names, bounds, units, meaning (see fields.hpp).

#include "sim/scene_file/fields.hpp"

namespace unravel::sim {

void describe(Fields&, Scene&);
void describe(Fields&, Clip&);
void describe(Fields&, Solver&);
void describe(Fields&, AdaptiveStep&);
void describe(Fields&, Cloth&);
void describe(Fields&, Material&);
void describe(Fields&, Region&, const Cloth&);
/// `names`: where a pin names several corners or edges, all of them; it is read as one pin for each.
void describe(Fields&, Pin&, std::vector<std::string>& names);
void describe(Fields&, Keyframe&);
/// Keyframes under the key `motion`, and how they are interpolated where they don't say it themselves.
void describe_path(Fields&, const Key& motion, Motion&);
void describe(Fields&, Start&);
void describe(Fields&, Wrinkles&);
void describe(Fields&, Fall&);
/// Of cloths and solids. The loader replaces them by things of their own, so that it is never written.
void describe(Fields&, Repeat&);
/// A mesh's file under the key `file`, and what else is said of it; of a `body` or of cloth.
void describe(Fields&, MeshFile&, const Key& file, bool body);
void describe(Fields&, MeshFrames&, bool applies);
void describe(Fields&, Solid&);
/// A key that is a number, or a table of static and kinetic.
void describe_friction(Fields&, const Key&, Friction&);
void describe(Fields&, Wind&);
void describe(Fields&, WindKey&);
void describe(Fields&, SelfCollision&);
void describe(Fields&, Camera&);
void describe(Fields&, Camera::Key&);
void describe(Fields&, Look&);
void describe(Fields&, ClothLook&);
void describe(Fields&, BodyLook&);
void describe(Fields&, Sun&);
void describe(Fields&, Sky&);

/// Describes keyframes one after the other and reports one that is not later than the one before.
template <class Key>
auto in_order() {
    return [last = -1.0](Fields& f, Key& key) mutable {
        describe(f, key);
        if (f.says("time") && f.sound("time")) {
            if (key.time <= last)
                f.problem("time", "keyframes out of order", "each must be later than the one before");
            last = key.time;
        }
    };
}

// Bounds that several tables share. They are wide: what is outside is a slip or a wrong unit.
inline constexpr double max_length = 1e4;   // m
inline constexpr double max_time = 3600;    // s
inline constexpr double max_angle = 36000;  // degrees
inline constexpr Bounds position_bounds{-max_length, max_length, false, "m"};
inline constexpr Bounds rotation_bounds{-max_angle, max_angle, false, "degrees"};
inline constexpr Bounds time_bounds{0, max_time, false, "s"};
inline constexpr Bounds speed_bounds{-1000, 1000, false, "m/s"};

}  // namespace unravel::sim
