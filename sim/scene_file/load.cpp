#include "sim/scene_file/load.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iostream>
#include <set>
#include <system_error>

#include "sim/scene/enums.hpp"
#include "sim/scene/limits.hpp"
#include "sim/scene_file/check.hpp"
#include "sim/scene_file/describe.hpp"
#include "sim/scene_file/include.hpp"
#include "sim/scene_file/override.hpp"
#include "sim/scene_file/reader.hpp"

namespace unravel::sim {

namespace {

/// The file's text, or one byte more than a scene may have.
std::string read_file(const std::filesystem::path& file) {
    const auto fail = [&]() -> std::string {
        throw std::system_error(errno ? errno : EIO, std::generic_category(),
                                fmt::format("the scene {} can't be read", file.string()));
    };
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return fail();
    std::string text(max_scene_bytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad() || (stream.fail() && !stream.eof())) return fail();
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

/// What is written to the program, read once: a scene from there may be asked for again.
const std::string& standard_input() {
    static const std::string text = [] {
        std::string read(max_scene_bytes + 1, '\0');
        std::cin.read(read.data(), static_cast<std::streamsize>(read.size()));
        read.resize(static_cast<std::size_t>(std::cin.gcount()));
        return read;
    }();
    return text;
}

/// Names for what has none: its kind, with a number from the second on.
template <class T, class Kind>
void complete_names(std::vector<T>& things, Kind&& kind) {
    std::set<std::string> taken;
    for (const T& thing : things) taken.insert(thing.name);
    for (T& thing : things) {
        if (!thing.name.empty()) continue;
        std::string name(kind(thing));
        for (int number = 2; taken.contains(name); ++number) name = fmt::format("{}{}", kind(thing), number);
        taken.insert(name);
        thing.name = std::move(name);
    }
}

/// What only a scene without problems gets: names, a camera, a step that divides the frame exactly.
void complete(Scene& scene, bool says_step) {
    if (scene.cameras.empty()) scene.cameras.emplace_back();
    complete_names(scene.cloths, [](const Cloth&) { return std::string_view("cloth"); });
    complete_names(scene.solids, [](const Solid& solid) { return word_of(solid.shape); });
    complete_names(scene.cameras, [](const Camera&) { return std::string_view("camera"); });
    const double steps = 1 / (scene.clip.fps.per_second() * scene.solver.step);
    const double per_frame = says_step ? std::round(steps) : std::ceil(steps * (1 - step_slack));
    scene.solver.step = 1 / (scene.clip.fps.per_second() * per_frame);
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                  const std::vector<std::string>& overrides) {
    Sources sources{name, text, overrides, {}};
    std::vector<SceneProblem> problems;
    const auto stop_on_problems = [&] {
        if (!problems.empty()) throw SceneError(format_problems(problems, sources), problems);
    };
    if (text.size() > max_scene_bytes)
        problems.push_back({{1, 1, 0},
                            "the file is too large for a scene",
                            fmt::format("at most {} MiB are read", max_scene_bytes >> 20)});
    stop_on_problems();

    Node root;
    if (!parse_document(text, root, problems)) stop_on_problems();
    take_over_included(root, name, folder, sources.included, problems);
    stop_on_problems();
    for (std::size_t i = 0; i < overrides.size(); ++i)
        apply_override(root, overrides[i], static_cast<int>(i) + 1, problems);

    Scene scene;
    Places places;
    Reading reading{problems, places};
    Reader reader(root, "", reading);
    describe(reader, scene);
    reader.finish();

    scene.home = (folder.empty() ? std::filesystem::path(".") : folder) / scene.root;
    if (!scene.root.empty() && !std::filesystem::is_directory(scene.home))
        problems.push_back({places.at("root"), fmt::format("no folder \"{}\"", scene.root),
                            "it is looked for from the scene's own folder"});
    repeat_things(scene, places);
    load_meshes(scene, places, problems);
    attach_things(scene, places, problems);
    const Checking checking{scene, places, problems};
    check_clip(checking);
    check_cloths(checking);
    check_solids(checking);
    check_pins(checking);
    check_start(checking);
    check_looks(checking);
    stop_on_problems();

    complete(scene, places.has("solver.step"));
    scene.name = std::filesystem::path(name).stem().string();
    scene.text = text;
    return scene;
}

Scene load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    if (file == "-") return parse_scene(standard_input(), "stdin", ".", overrides);
    return parse_scene(read_file(file), file.string(), file.has_parent_path() ? file.parent_path() : ".",
                       overrides);
}

}  // namespace unravel::sim
