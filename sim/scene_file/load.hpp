#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// One thing wrong with a scene: where, what, and what would be right.
struct SceneProblem {
    SourcePlace place;
    std::string what;  ///< "unknown key 'radus'"
    std::string hint;  ///< "did you mean 'radius'?"; may be empty
};

/// All problems of a scene at once; what() is the text for the user: per problem `file:line:column: error:
/// what; hint`, the offending line and a caret under the place.
class SceneError : public std::runtime_error {
public:
    SceneError(std::string formatted, std::vector<SceneProblem> problems)
        : std::runtime_error(std::move(formatted)), problems_(std::move(problems)) {}
    const std::vector<SceneProblem>& problems() const { return problems_; }

private:
    std::vector<SceneProblem> problems_;
};

/// Reads and checks a scene file, or with "-" standard input, of which the files are in the working folder.
/// Each override is "key=value" with the key a dotted path ("solver.step", "cloth.particles",
/// "solid[1].radius") and the value TOML; it is checked like the file. Throws SceneError with every problem
/// found, std::system_error if the file can't be read.
Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same for a text that need not be a file; `name` stands for it in messages.
Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder = {},
                  const std::vector<std::string>& overrides = {});

/// The scene as run, with overrides applied: TOML that load_scene() reads back to the same values.
std::string scene_to_toml(const Scene& scene);

}  // namespace unravel::sim
