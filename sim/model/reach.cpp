#include "sim/model/reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/motion.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
// Times its own size that a cloth may be stretched to before a run stops (sim/run/guard.hpp).
constexpr double most_stretched = 11;
// Gusts are noise of unit variance that stays within this many of its deviations.
constexpr double strongest_gust = 3;

struct Ball {
    Vec3 centre{0, 0, 0};
    double radius = 0;  // m
};

// Not the smallest.
Ball ball_around(std::span<const Vec3> points) {
    Ball ball;
    if (points.empty()) return ball;
    Vec3 low = points.front(), high = low;
    for (const Vec3& x : points) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    return {0.5 * (low + high), 0.5 * (high - low).norm()};
}

// How far keyframes take what is at most `arm` from what they turn about: none is overshot. [m]
double travel_of(const Motion& motion, double arm) {
    double most = 0;
    bool turns = false;
    for (const Keyframe& key : motion) {
        most = std::max(most, key.position.norm());
        turns = turns || !key.rotation.isZero(0);
    }
    return most + (turns ? 2 * arm : 0.0);
}

double travel_of(const PinnedGroup& pin) {
    if (pin.carried.by || !pin.triangles.empty()) return unbounded;
    return travel_of(pin.motion, 2 * ball_around(pin.start).radius);
}

// Of any point within its own ball; a fall and a ride are somebody else's reckoning.
double travel_of(const Solid& solid) {
    if (solid.fall || solid.carried.by || (solid.geometry && solid.geometry->deforms())) return unbounded;
    if (solid.motion.empty()) return 0;
    return travel_of(solid.motion, law_of(solid.shape).reach(solid) + (solid.center - solid.pivot).norm());
}

double fastest_wind(const Wind& wind) {
    double most = wind.keyframes.empty() ? wind.velocity.norm() : 0.0;
    for (const WindKey& key : wind.keyframes) most = std::max(most, key.velocity.norm());
    return wind.gust ? (1 + strongest_gust * wind.gust->strength) * most : most;
}

}  // namespace

bool Reach::meets(const Solid& solid) const {
    const Vec3 to_cloth = centre - solid.center;
    const Pose start = solid_pose(solid, 0);
    const double distance = solid.shape == Shape::plane ? start.linear().col(1).dot(to_cloth)
                                                        : to_cloth.norm() - law_of(solid.shape).reach(solid);
    return !(distance > way + solid.offset);
}

Reach reach_of(const Scene& scene, const ClothModel& model, const Placement& placement) {
    const Ball cloth = ball_around(placement.x);
    const double seconds = scene.clip.duration + scene.clip.settle;
    double speed = model.wind ? fastest_wind(*model.wind) : 0.0, size = 2 * cloth.radius, carried = 0;
    double thrown = 0;
    for (const Vec3& v : placement.v) thrown = std::max(thrown, v.norm());
    for (const ClothPatch& patch : model.cloths) size = std::max({size, patch.size[0], patch.size[1]});
    for (const PinnedGroup& pin : model.pins) carried += travel_of(pin);
    for (const Solid& solid : model.solids) carried += travel_of(solid);
    speed += thrown + model.gravity.norm() * seconds;
    return {cloth.centre, cloth.radius + most_stretched * size + speed * seconds + carried};
}

}  // namespace unravel::sim
