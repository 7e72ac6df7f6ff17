// Where cloth, pins and solids are at the start.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "sim/mesh/placement.hpp"
#include "sim/scene_file/check.hpp"
#include "sim/solids/sdf.hpp"

namespace unravel::sim {

namespace {

struct Held {
    int i = 0, j = 0;
    double depth = 0;  ///< m inside the surface
};

/// The first particle found deeper in the solid than its offset. The distance changes by no more than one
/// moves, so a block of the grid whose middle is farther out than the block and its jitter reach has none;
/// other blocks are cut in four. That makes a cloth of millions as cheap as its border with the solid.
class HeldSearch {
public:
    HeldSearch(const Cloth& cloth, const Solid& solid)
        : cloth_(cloth), solid_(solid), places_(cloth), to_solid_(start_pose(solid).inverse()) {}

    std::optional<Held> find() const {
        return cloth_.geometry ? find_vertex() : find(0, cloth_.particles[0], 0, cloth_.particles[1]);
    }

private:
    std::optional<Held> find_vertex() const {
        for (int v = 0; v < cloth_.particles[0]; ++v) {
            const double distance = signed_distance(solid_, to_solid_ * places_.started(v, 0));
            if (distance < -solid_.offset) return Held{v, 0, -distance};
        }
        return {};
    }

    std::optional<Held> find(int i0, int i1, int j0, int j1) const {
        const int i = (i0 + i1) / 2, j = (j0 + j1) / 2;
        const double distance = signed_distance(solid_, to_solid_ * places_.started(i, j));
        if (distance < -solid_.offset) return Held{i, j, -distance};
        // On a tube or a start shape the way through the air is shorter than along the cloth: the bound holds
        // there too.
        const double reach_u = spacing(0) * std::max(i - i0, i1 - 1 - i);
        const double reach_v = spacing(1) * std::max(j - j0, j1 - 1 - j);
        const bool single = i1 - i0 == 1 && j1 - j0 == 1;
        const double reach = std::hypot(reach_u, reach_v) + 2 * places_.most_displaced();
        if (single || distance + solid_.offset > reach * (1 + 1e-9)) return {};
        for (const auto& [a0, a1] : {std::array{i0, i}, std::array{i, i1}}) {
            for (const auto& [b0, b1] : {std::array{j0, j}, std::array{j, j1}}) {
                if (a0 == a1 || b0 == b1) continue;
                if (const std::optional<Held> held = find(a0, a1, b0, b1)) return held;
            }
        }
        return {};
    }

    double spacing(std::size_t axis) const {
        const int cells =
            axis == 0 && cloth_.wrap == Wrap::tube ? cloth_.particles[0] : cloth_.particles[axis] - 1;
        return cloth_.size[axis] * cloth_.placed_scale[axis] / std::max(cells, 1);
    }

    const Cloth& cloth_;
    const Solid& solid_;
    StartPlaces places_;
    Eigen::Isometry3d to_solid_;
};

// False: its mesh has faults of its own.
bool loaded(const Cloth& cloth) {
    return cloth.mesh.file.empty() || cloth.geometry;
}
bool loaded(const Solid& solid) {
    return solid.shape != Shape::mesh || solid.geometry;
}

std::string quoted_name(const std::string& kind, const std::string& name) {
    return name.empty() ? "the " + kind : fmt::format("the {} \"{}\"", kind, name);
}

/// The particle nearest to (u, v). The distance along the cloth is a sum of one part in u and one in v, so it
/// is found along each by itself.
std::array<int, 2> nearest_particle(const Cloth& cloth, const Vec2& uv) {
    const auto [nu, nv] = cloth.particles;
    const int j = static_cast<int>(std::lround(uv.y() * (nv - 1)));
    if (cloth.wrap == Wrap::tube) return {static_cast<int>(std::lround(uv.x() * nu)) % nu, j};
    return {static_cast<int>(std::lround(uv.x() * (nu - 1))), j};
}

// Whether two pins have any particle at the same place all the time.
bool moves_alike(const Pin& a, const Pin& b) {
    if (a.to != b.to || a.rod != b.rod || a.gather != b.gather || a.slide != b.slide) return false;
    const auto still = [](const Pin& pin) {
        return std::all_of(pin.motion.begin(), pin.motion.end(), [](const Keyframe& key) {
            return key.position.isZero(0) && key.rotation.isZero(0);
        });
    };
    if (still(a) && still(b)) return true;
    return std::equal(a.motion.begin(), a.motion.end(), b.motion.begin(), b.motion.end(),
                      [](const Keyframe& one, const Keyframe& other) {
                          return one.time == other.time && one.position == other.position &&
                                 one.interpolation == other.interpolation && one.rotation.isZero(0) &&
                                 other.rotation.isZero(0);
                      });
}

bool outlasts(const Pin& pin, double time) {
    return !pin.release || *pin.release > time;
}

// The first of the pins that hold a particle moves it; what it lets go of must not jump to where a later one
// would have it.
void check_handovers(const Checking& check, const Cloth& cloth) {
    const std::vector<Pin>& pins = cloth.pins;
    std::vector<std::vector<std::size_t>> held(pins.size());
    const auto particles_of = [&](std::size_t k) -> const std::vector<std::size_t>& {
        if (held[k].empty()) held[k] = pinned_particles(cloth, pins[k]);
        return held[k];
    };
    for (std::size_t b = 1; b < pins.size(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            if (!pins[a].release || !outlasts(pins[b], *pins[a].release) || moves_alike(pins[a], pins[b]))
                continue;
            std::vector<std::size_t> both;
            std::ranges::set_intersection(particles_of(a), particles_of(b), std::back_inserter(both));
            if (both.empty()) continue;
            const auto nu = static_cast<std::size_t>(cloth.particles[0]);
            const std::string particle =
                cloth.geometry ? fmt::format("vertex {}", both.front() + 1)
                               : fmt::format("particle ({}, {})", both.front() % nu, both.front() / nu);
            check.problems.push_back(
                {pins[b].place,
                 fmt::format("{} would jump here at {} s, when the pin at line {} lets go of it", particle,
                             *pins[a].release, pins[a].place.line),
                 "let one pin hold it, or give both the same motion"});
            break;
        }
    }
}

}  // namespace

void check_pins(const Checking& check) {
    for (std::size_t c = 0; c < check.scene.cloths.size(); ++c) {
        const Cloth& cloth = check.scene.cloths[c];
        const std::string path = fmt::format("cloth[{}]", c);
        if (!check.places.sound(path) || !loaded(cloth)) continue;
        check_handovers(check, cloth);
    }
}

void check_start(const Checking& check) {
    const Scene& scene = check.scene;
    for (std::size_t k = 0; k < scene.solids.size(); ++k) {
        if (!check.places.sound(fmt::format("solid[{}]", k))) continue;
        for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
            const std::string path = fmt::format("cloth[{}]", c);
            if (!check.places.sound(path + ".particles") || !check.places.sound_itself(path)) continue;
            if (!loaded(scene.cloths[c]) || !loaded(scene.solids[k])) continue;
            const std::optional<Held> held = HeldSearch(scene.cloths[c], scene.solids[k]).find();
            if (!held) continue;
            const std::string particle = scene.cloths[c].geometry
                                             ? fmt::format("vertex {}", held->i + 1)
                                             : fmt::format("particle ({}, {})", held->i, held->j);
            check.report(fmt::format("solid[{}]", k),
                         fmt::format("{} holds {} at the start: {} is {:.3g} m inside",
                                     quoted_name("solid", scene.solids[k].name),
                                     quoted_name("cloth", scene.cloths[c].name), particle, held->depth),
                         "move one of them");
        }
    }
}

namespace {

void check_count(Fields& fields, const Cloth& cloth, const Pin& pin, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const int there = name.starts_with("u") ? cloth.particles[1] : cloth.particles[0];
        if (name.empty() || pin.count <= there) continue;
        fields.problem("count", fmt::format("{} of the {} particles along {}", pin.count, there, name),
                       "make it less, or the grid finer");
        return;
    }
}

}  // namespace

void check_pin(const Fields& cloth_fields, Fields& pin_fields, const Cloth& cloth, const Pin& pin,
               const std::vector<std::string>& names) {
    if (!cloth_fields.sound("particles") || !cloth_fields.sound("size") || !cloth_fields.sound("wrap"))
        return;
    const auto [nu, nv] = cloth.particles;
    if (pin.count > 0 && pin_fields.sound("count")) check_count(pin_fields, cloth, pin, names);
    const auto nothing = [&](std::string_view key, std::string hint) {
        if (pin_fields.says(key) && pin_fields.sound(key))
            pin_fields.problem(key, "the pin catches no particle", std::move(hint));
    };
    const auto test_nearest = [&](std::string_view key, const Vec2& uv) {
        const auto [i, j] = nearest_particle(cloth, uv);
        const Vec2 there = particle_uv(cloth, i, j);
        if (!pin_catches(cloth, pin, i, j))
            nothing(key, fmt::format("the nearest is at u = {:.4g}, v = {:.4g}", there.x(), there.y()));
    };
    switch (pin.target) {
        case PinTarget::corner:
            if (cloth.wrap == Wrap::tube)
                nothing("corner", "a tube has no corners; say edge, particles, box or disc");
            break;
        case PinTarget::edge:
            if (cloth.wrap == Wrap::tube && std::any_of(names.begin(), names.end(), [](const auto& name) {
                    return name.starts_with("u");
                }))
                nothing("edge", "a tube has the edges v0 and v1 only");
            break;
        case PinTarget::particles:
            if (pin.range[0] > pin.range[1] || pin.range[2] > pin.range[3])
                nothing("particles", "write first and last along u, then first and last along v");
            else if (pin.range[1] >= nu || pin.range[3] >= nv)
                nothing("particles",
                        fmt::format("indices run from 0 to {} along u and to {} along v", nu - 1, nv - 1));
            break;
        case PinTarget::box:
            test_nearest("box", (pin.box.low + pin.box.high) / 2);
            break;
        case PinTarget::disc:
            test_nearest("disc", pin.disc.center);
            break;
        case PinTarget::group:
        case PinTarget::within:
            break;  // of meshes, which are read later
    }
}

}  // namespace unravel::sim
