#pragma once

// What concerns several values at once. A check whose values had a problem of their own is left out, so that
// one slip gives one message.

#include <filesystem>
#include <string>
#include <vector>

#include "sim/scene_file/diagnostics.hpp"
#include "sim/scene_file/fields.hpp"

namespace unravel::sim {

/// What the checks of a whole scene look at and add to.
struct Checking {
    const Scene& scene;
    const Places& places;
    std::vector<SceneProblem>& problems;

    void report(const std::string& path, std::string what, std::string hint) const {
        problems.push_back({places.at(path), std::move(what), std::move(hint)});
    }
};

void check_clip(const Checking&);    ///< size, frames, steps in a frame
void check_cloths(const Checking&);  ///< names, number of particles
void check_solids(const Checking&);  ///< names, shapes, friction
void check_pins(const Checking&);    ///< who takes over from whom
void check_start(const Checking&);   ///< no solid holds a cloth
void check_looks(const Checking&);   ///< cameras, textures

/// A file that a scene names: it has to lie in the scene's root, also once links are resolved.
struct ContainedFile {
    std::filesystem::path file;  ///< where it is; empty with a problem
    std::string what, hint;      ///< the problem
};
ContainedFile contained_file(const std::filesystem::path& folder, const std::string& name,
                             std::string_view kind);

/// Replaces what the scene says to repeat by cloths and solids of their own, behind those that are written.
void repeat_things(Scene&, Places&);

/// Finds the bodies that pins and solids ride on by their names, and what falls from where. After the meshes.
void attach_things(Scene&, const Places&, std::vector<SceneProblem>&);

/// Reads the meshes that the scene names into its cloths and solids, and reports what is wrong with them and
/// with what refers to them (pins, regions). Before the checks above.
void load_meshes(Scene&, const Places&, std::vector<SceneProblem>&);

/// A pin just read, `names` being all its corners or edges: it has to catch a particle.
void check_pin(const Fields& cloth_fields, Fields& pin_fields, const Cloth& cloth, const Pin& pin,
               const std::vector<std::string>& names);

}  // namespace unravel::sim
