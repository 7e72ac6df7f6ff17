// What of a scene refers to its other parts: pins and solids that ride on solids, and bodies that fall.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sim/mesh/mesh_solid.hpp"
#include "sim/mesh/placement.hpp"
#include "sim/scene_file/check.hpp"
#include "sim/scene_file/similar.hpp"
#include "sim/solids/motion.hpp"
#include "sim/solids/sdf.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

class Attaching {
public:
    Attaching(Scene& scene, const Places& places, std::vector<SceneProblem>& problems)
        : scene_(scene), places_(places), problems_(problems), state_(scene.solids.size(), State::open) {}

    void attach_all() {
        for (std::size_t s = 0; s < scene_.solids.size(); ++s) attach_solid(s);
        for (std::size_t c = 0; c < scene_.cloths.size(); ++c) {
            for (Pin& pin : scene_.cloths[c].pins) attach_pin(pin);
        }
    }

private:
    enum class State { open, under_way, done };

    // The solid's number, or −1 with a problem added.
    int find(const std::string& name, const SourcePlace& place) {
        for (std::size_t s = 0; s < scene_.solids.size(); ++s)
            if (scene_.solids[s].name == name) return static_cast<int>(s);
        std::vector<std::string_view> names;
        for (const Solid& solid : scene_.solids)
            if (!solid.name.empty()) names.push_back(solid.name);
        const std::string_view meant = most_similar(name, names);
        report(place, fmt::format("there is no solid \"{}\"", printable(name)),
               !meant.empty() ? fmt::format("did you mean \"{}\"?", meant)
                              : "give the solid that is meant this name");
        return -1;
    }

    void report(const SourcePlace& place, std::string what, std::string hint) {
        problems_.push_back({place, std::move(what), std::move(hint)});
    }

    bool loaded(const Solid& solid) const { return solid.shape != Shape::mesh || solid.geometry; }

    // What rides on another follows it only once that is attached itself.
    void attach_solid(std::size_t s) {
        Solid& solid = scene_.solids[s];
        if (state_[s] != State::open) return;
        state_[s] = State::under_way;
        const SourcePlace place = places_.at(fmt::format("solid[{}].parent", s));
        if (const int parent = solid.parent.empty() ? -1 : find(solid.parent, place); parent >= 0) {
            const auto p = static_cast<std::size_t>(parent);
            attach_solid(p);
            if (state_[p] == State::under_way)
                report(place, fmt::format("\"{}\" would ride on itself", solid.parent),
                       "let one of them ride on none");
            else if (loaded(scene_.solids[p]))
                carry(solid.carried, p, start_pose(solid).translation());
        }
        state_[s] = State::done;
        if (solid.fall) drop(solid, fmt::format("solid[{}].fall", s));
    }

    void carry(Carried& carried, std::size_t by, const Vec3& from) const {
        carried.by = std::make_shared<Solid>(scene_.solids[by]);
        carried.triangle = carrying_triangle(*carried.by, from);
    }

    void attach_pin(Pin& pin) {
        const bool slides = !pin.rod.empty();
        const std::string& name = slides ? pin.rod : pin.to;
        if (name.empty()) return;
        const int found = find(name, pin.place);
        if (found < 0) return;
        const Solid& body = scene_.solids[static_cast<std::size_t>(found)];
        if (slides && !law_of(body.shape).sizes.height)
            return report(pin.place, fmt::format("the rod \"{}\" is a {}", name, word_of(body.shape)),
                          "a rod is a cylinder or a capsule");
        // Which triangles its particles ride on is found with them.
        if (loaded(body)) pin.carried.by = std::make_shared<Solid>(body);
    }

    // How far the solid reaches below its centre, along the unit vector `up`: from so far below that its
    // surface looks flat, what is missing to the distance of the centre.
    static double below(const Solid& solid, const Eigen::Matrix3d& rotation, const Vec3& up) {
        constexpr double far_below = 1e4;  // times its reach: wrong by 1/20000 of that at most
        const double from = far_below * law_of(solid.shape).reach(solid);
        return from - signed_distance(solid, rotation.transpose() * Vec3(-from * up));
    }

    void drop(Solid& solid, const std::string& path) {
        Fall& fall = *solid.fall;
        fall.gravity = scene_.gravity;
        const SourcePlace place = places_.at(path);
        if (fall.gravity.isZero(0)) return report(place, "nothing falls without gravity", "give it a motion");
        if (!solid.motion.empty() && solid.motion.back().time > fall.time)
            return report(places_.at(path + ".time"), "it falls before its motion has ended",
                          fmt::format("the last keyframe is at {:g} s", solid.motion.back().time));
        if (!fall.floor || !loaded(solid)) return;
        Solid before = solid;
        before.fall.reset();
        const Pose pose = solid_pose(before, fall.time);
        const Vec3 up = -fall.gravity.normalized();
        fall.drop = up.dot(pose.translation()) - below(solid, pose.linear(), up) - *fall.floor;
        if (fall.drop < -1e-9)
            report(places_.at(path + ".floor"),
                   fmt::format("its lowest point begins {:.4g} m below the floor", -fall.drop),
                   fmt::format("it is at a height of {:.4g} m", fall.drop + *fall.floor));
        fall.drop = std::max(fall.drop, 0.0);
    }

    Scene& scene_;
    const Places& places_;
    std::vector<SceneProblem>& problems_;
    std::vector<State> state_;
};

}  // namespace

void attach_things(Scene& scene, const Places& places, std::vector<SceneProblem>& problems) {
    Attaching(scene, places, problems).attach_all();
}

}  // namespace unravel::sim
