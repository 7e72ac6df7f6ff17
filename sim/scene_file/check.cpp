#include "sim/scene_file/check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sim/scene/limits.hpp"
#include "sim/scene_file/look_pictures.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

/// `kind` is the key of the list, "cloth" or "solid".
template <class T>
void check_names(const Checking& check, const std::vector<T>& things, std::string_view kind) {
    for (std::size_t i = 0; i < things.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (things[i].name.empty() || things[i].name != things[j].name) continue;
            check.report(fmt::format("{}[{}].name", kind, i),
                         fmt::format("a second {} named \"{}\"", kind, things[i].name),
                         "give each its own name");
            break;
        }
    }
}

/// The frame is the whole number of steps nearest to what the scene says.
void check_step(const Checking& check) {
    const Scene& scene = check.scene;
    const double steps = 1 / (scene.clip.fps.per_second() * scene.solver.step);
    const double whole = std::max(1.0, std::round(steps));
    if (std::abs(steps - whole) > step_slack * whole) {
        check.report("solver.step",
                     fmt::format("the step of {} s does not divide a frame of {} s", scene.solver.step,
                                 step_text(scene.clip.fps, 1)),
                     fmt::format("the nearest that does is \"{}\"",
                                 step_text(scene.clip.fps, static_cast<long long>(whole))));
    } else if (const double frames = scene.clip.frames() + scene.clip.settle * scene.clip.fps.per_second();
               steps * frames > max_steps) {
        check.report("solver.step", fmt::format("{:.3g} steps in {:.0f} frames", steps * frames, frames),
                     fmt::format("at most {:.0e} are run", max_steps));
    }
    if (scene.solver.adaptive && check.places.sound("solver.adaptive") &&
        scene.solver.adaptive->smallest > scene.solver.step)
        check.report("solver.adaptive.smallest",
                     fmt::format("the smallest step, {} s, is above the step of {} s",
                                 scene.solver.adaptive->smallest, scene.solver.step),
                     "the step is the largest that is taken");
}

}  // namespace

void check_clip(const Checking& check) {
    const Clip& clip = check.scene.clip;
    if (!check.places.sound("clip.duration") || !check.places.sound("clip.fps")) return;
    const double frames = clip.duration * clip.fps.per_second();
    if (frames < 0.5) {
        check.report("clip.duration", fmt::format("a clip of {} s is shorter than a frame", clip.duration),
                     fmt::format("at {} frames per second it takes {:.4g} s or more", rate_text(clip.fps),
                                 clip.fps.time_of(1)));
        return;
    }
    if (frames > max_frames) {
        check.report("clip.duration", fmt::format("a clip of {:.0f} frames", frames),
                     fmt::format("at most {} are made", max_frames));
        return;
    }
    if (check.places.has("solver.step") && check.places.sound("solver.step")) check_step(check);
}

void check_cloths(const Checking& check) {
    const std::vector<Cloth>& cloths = check.scene.cloths;
    check_names(check, cloths, "cloth");
    double total = 0;
    for (std::size_t i = 0; i < cloths.size(); ++i) {
        const std::string path = fmt::format("cloth[{}]", i);
        if (check.places.sound(path + ".particles")) {
            const double before = total;
            total += static_cast<double>(cloths[i].particles[0]) * cloths[i].particles[1];
            if (before <= max_particles && total > max_particles)
                check.report(path + ".particles", fmt::format("{:.0f} particles in all", total),
                             fmt::format("at most {} fit", max_particles));
        }
        for (std::size_t k = 0; k < cloths[i].regions.size(); ++k) {
            const std::string region = fmt::format("{}.region[{}]", path, k);
            const UvBox& box = cloths[i].regions[k].box;
            if (check.places.sound(region + ".box") && (box.low.array() >= box.high.array()).any())
                check.report(region + ".box", "an empty region",
                             "write [u0, v0, u1, v1] with u0 < u1 and v0 < v1");
        }
    }
}

void check_solids(const Checking& check) {
    const std::vector<Solid>& solids = check.scene.solids;
    check_names(check, solids, "solid");
    for (std::size_t i = 0; i < solids.size(); ++i) {
        const Solid& solid = solids[i];
        const std::string path = fmt::format("solid[{}]", i);
        if (check.places.sound(path + ".friction") && solid.friction.kinetic > solid.friction.static_)
            check.report(path + ".friction",
                         fmt::format("kinetic friction {} above static friction {}", solid.friction.kinetic,
                                     solid.friction.static_),
                         "what slides is never held harder than what rests");
        if (!check.places.sound(path) || solid.round == 0) continue;
        const double thinnest = 2 * law_of(solid.shape).half_extents(solid).minCoeff();
        if (solid.round > thinnest / 2)
            check.report(path + ".round", fmt::format("edges rounded by {} m", solid.round),
                         fmt::format("at most half of its thinnest, {} m", thinnest / 2));
    }
}

namespace {

// The script that makes a folder's files, make_*.py, as it can be called from here; empty: there is none.
std::string script_beside(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    std::string found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename();
        if (!name.starts_with("make_") || !name.ends_with(".py")) continue;
        const std::string path = entry.path().lexically_proximate(fs::current_path(error));
        if (found.empty() || path < found) found = path;
    }
    return found;
}

}  // namespace

ContainedFile contained_file(const std::filesystem::path& folder, const std::string& name,
                             std::string_view kind) {
    namespace fs = std::filesystem;
    const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder);
    // Links are resolved first: what counts is where the file really is.
    std::error_code error;
    fs::path file = fs::weakly_canonical(home / name, error);
    const bool inside =
        !error && std::mismatch(home.begin(), home.end(), file.begin(), file.end()).first == home.end();
    if (fs::path(name).is_absolute() || !inside)
        return {{},
                fmt::format("the {} \"{}\" is outside the scene's folder", kind, name),
                "put it beside the scene, or name the folder around it by root = \"...\" and it relative to "
                "that"};
    if (!fs::is_regular_file(file, error)) {
        const std::string maker = script_beside(home);
        return {{},
                fmt::format("no file \"{}\"", name),
                maker.empty() ? "it is looked for in the scene's folder"
                              : fmt::format("make it first: python3 {}", maker)};
    }
    return {std::move(file), {}, {}};
}

namespace {

void check_follow(const Checking& check, std::size_t camera) {
    const Scene& scene = check.scene;
    const std::string& followed = scene.cameras[camera].follow;
    if (followed.empty()) return;
    if (scene.cameras[camera].fit)
        check.report(fmt::format("camera[{}].fit", camera),
                     "a camera that is fitted to the scene follows nothing", "leave out fit or follow");
    std::string there;
    const auto add = [&](const auto& things) {
        for (const auto& thing : things)
            if (!thing.name.empty()) there += fmt::format("{}\"{}\"", there.empty() ? "" : ", ", thing.name);
    };
    add(scene.solids);
    add(scene.cloths);
    const auto names = [&](const auto& thing) { return thing.name == followed; };
    if (std::ranges::any_of(scene.solids, names) || std::ranges::any_of(scene.cloths, names)) return;
    check.report(fmt::format("camera[{}].follow", camera),
                 fmt::format("there is no solid or cloth named \"{}\"", followed),
                 there.empty() ? "give one of them a name" : "there is " + there);
}

void check_light(const Checking& check) {
    const Look& look = check.scene.look;
    if (check.places.sound("look.sun.direction") && look.sun.direction.norm() < 1e-9)
        check.report("look.sun.direction", "a sun that stands nowhere",
                     "write the direction towards it, such as [-0.35, 0.8, 0.5]");
    if (look.sky.show && look.sky.image.empty())
        check.report("look.sky.show", "a sky without an image is not to be shown",
                     "name one by image = \"sky.png\"");
}

// Every picture that the scene names is to lie in its folder.
void check_pictures(const Checking& check) {
    for (const auto& [key, file] : look_pictures(check.scene.look)) {
        const ContainedFile found = contained_file(check.scene.home, file, "texture");
        if (!found.what.empty()) check.report(key, found.what, found.hint);
    }
}

}  // namespace

void check_looks(const Checking& check) {
    for (std::size_t i = 0; i < check.scene.cameras.size(); ++i) {
        const Camera& camera = check.scene.cameras[i];
        const std::string path = fmt::format("camera[{}]", i);
        const auto check_aim = [&](const std::string& where, const Vec3& position, const Vec3& target) {
            if (check.places.sound(path) && (position - target).norm() < 1e-6)
                check.report(where, "the camera stands in its target", "move one of them");
        };
        if (camera.keyframes.empty()) check_aim(path + ".position", camera.position, camera.target);
        for (std::size_t k = 0; k < camera.keyframes.size(); ++k)
            check_aim(fmt::format("{}.keyframes[{}]", path, k), camera.keyframes[k].position,
                      camera.keyframes[k].target);
    }
    check_names(check, check.scene.cameras, "camera");
    for (std::size_t i = 0; i < check.scene.cameras.size(); ++i) check_follow(check, i);
    check_light(check);
    check_pictures(check);
}

}  // namespace unravel::sim
