#include "tool/cli/scene_list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/whole_file.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/cli/guarded.hpp"
#include "tool/cluster/cluster.hpp"
#include "tool/folder/folder_lock.hpp"
#include "tool/folder/run_folder.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_json = std::size_t{64} << 20;

struct ListedScene {
    fs::path file;
    Scene scene;  // with what the command line changes of its look and size
    RunFolder folder;
    int last;  // frame that is asked for
};

RunOptions options_for(const RunOptions& options, const ListedScene& listed) {
    RunOptions one = options;
    one.folder = listed.folder.root;
    return one;
}

std::vector<ListedScene> list_scenes(const RunOptions& options) {
    std::vector<ListedScene> list;
    std::vector<SceneProblem> problems;
    std::string said;
    std::set<fs::path> folders;
    for (const fs::path& file : options.scenes) {
        try {
            Scene scene = load_scene(file, options.overrides);
            const int last = clip_options_of(options.pictures, scene).last;
            const fs::path around = options.folder.empty() ? fs::path("output") : options.folder;
            RunFolder folder{options.scenes.size() == 1 && !options.folder.empty() ? around
                                                                                   : around / scene.name};
            if (!folders.insert(folder.root.lexically_normal()).second) {
                throw UsageError(fmt::format("two of the scenes are called {}, and would share '{}'",
                                             scene.name, folder.root.string()));
            }
            list.push_back({file, std::move(scene), std::move(folder), last});
        } catch (const SceneError& error) {
            said += (said.empty() ? "" : "\n") + std::string(error.what());
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    }
    if (!said.empty()) throw SceneError(said, std::move(problems));
    return list;
}

bool is_complete(const ListedScene& listed, const std::vector<std::string>& command) {
    const RunFolder& folder = listed.folder;
    if (!fs::exists(folder.scene()) || !fs::exists(folder.report())) return false;
    const nlohmann::ordered_json run = read_run_json(folder);
    if (!run.is_object() || run.value("status", "") != "complete" ||
        run.value("command", std::vector<std::string>()) != command ||
        read_whole_text(folder.scene(), largest_json) != scene_to_toml(listed.scene))
        return false;
    for (const std::string& video : run.value("videos", std::vector<std::string>())) {
        if (!fs::exists(folder.root / video)) return false;
    }
    for (int frame = 0; frame <= listed.last; ++frame) {
        if (!fs::exists(folder.record(frame))) return false;
    }
    return true;
}

int frames_there(const std::vector<ListedScene>& list) {
    int frames = 0;
    for (const ListedScene& listed : list) {
        for (int k = 0; k <= listed.last && fs::exists(listed.folder.record(k)); ++k) ++frames;
    }
    return frames;
}

// The folder that all the clips are in; a single clip is its own.
fs::path results_of(const RunOptions& options, const std::vector<ListedScene>& list) {
    if (list.size() == 1) return list.front().folder.root;
    return options.folder.empty() ? fs::path("output") : options.folder;
}

int send(const RunOptions& options, const std::vector<ListedScene>& list) {
    const std::vector<std::string> command = command_of_run(options);
    ClusterWork work;
    work.name = options.words.front();
    work.words = options.words;
    work.threads = options.threads == 0;
    work.what = list.size() == 1 ? "the scene" : fmt::format("scene K of {}, counted from 0", list.size());
    work.results = results_of(options, list);
    for (std::size_t k = 0; k < list.size(); ++k) {
        if (options.force || !is_complete(list[k], command)) work.missing.push_back(static_cast<int>(k));
        work.total += list[k].last + 1;
    }
    // What a folder holds is judged here, once: a task that is done again goes on from what it has left
    // itself.
    work.prepare = [&] {
        for (const int k : work.missing) {
            const ListedScene& listed = list[static_cast<std::size_t>(k)];
            const FolderLock lock(listed.folder.root);
            open_run(listed.folder, listed.scene, options.force ? Existing::replace : Existing::resume);
        }
    };
    work.done = [&] { return frames_there(list); };
    return do_on_cluster(options.pieces.cluster, options.output, work);
}

int conclude(const RunOptions& options, const std::vector<ListedScene>& list) {
    const std::vector<std::string> command = command_of_run(options);
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    std::vector<std::string> lines;
    std::size_t missing = 0;
    for (std::size_t k = 0; k < list.size(); ++k) {
        const ListedScene& listed = list[k];
        std::string why;
        if (!is_complete(listed, command)) {
            ++missing;
            why = why_missing(results_of(options, list), command.front(), static_cast<int>(k));
        }
        json.push_back({{"scene", listed.scene.name},
                        {"folder", listed.folder.root.string()},
                        {"status", why.empty() ? "complete" : "missing"},
                        {"why", why}});
        lines.push_back(fmt::format("{:<24} {}", listed.scene.name,
                                    why.empty() ? listed.folder.root.string() : "MISSING: " + why));
    }
    if (options.output.json) {
        fmt::print("{}\n", json.dump(2));
    } else if (!options.output.quiet) {
        fmt::print("{}\n{} of {} clips are complete\n", fmt::join(lines, "\n"), list.size() - missing,
                   list.size());
        if (missing > 0) fmt::print("the same command sends those that are missing again\n");
    }
    return missing == 0 ? exit_done : exit_simulation;
}

int do_here(const RunOptions& options, const std::vector<ListedScene>& list, RunOne one) {
    int code = exit_done;
    std::vector<std::string> failed;
    for (const ListedScene& listed : list) {
        const int ended = guarded([&] { return one(listed.file, options_for(options, listed)); });
        if (ended > exit_signal) return ended;
        if (ended != exit_done) failed.push_back(listed.scene.name);
        if (code == exit_done) code = ended;
    }
    if (!failed.empty())
        fmt::print(stderr, "unravel: {} of {} scenes failed: {}\n", failed.size(), list.size(),
                   fmt::join(failed, ", "));
    return code;
}

}  // namespace

std::vector<std::string> command_of_run(const RunOptions& options) {
    std::vector<std::string> words = words_without(
        options.words,
        {"--slurm", "--wait", "--dry-run", "--force", "--resume", "--collect", "--quiet", "--json",
         "--allow-unstable"},
        {"--partition", "--time", "--cpus", "--array-limit", "--sbatch", "--point", "--threads", "-o"});
    std::erase_if(words, [&](const std::string& word) {
        return std::find(options.scenes.begin(), options.scenes.end(), word) != options.scenes.end();
    });
    return words;
}

int for_each_scene(const RunOptions& options, RunOne one) {
    const PieceOptions& pieces = options.pieces;
    if (options.scenes.size() == 1 && pieces.whole()) return one(options.scenes.front(), options);
    if (!pieces.whole() && std::ranges::find(options.scenes, fs::path("-")) != options.scenes.end())
        throw UsageError("a cluster's tasks read no standard input: write the scene to a file");
    const std::vector<ListedScene> list = list_scenes(options);
    if (pieces.cluster.submit) return send(options, list);
    if (pieces.collect) return conclude(options, list);
    if (pieces.point < 0) return do_here(options, list, one);
    if (static_cast<std::size_t>(pieces.point) >= list.size())
        throw UsageError(fmt::format("--point {}: the scenes end at {}", pieces.point, list.size() - 1));
    const ListedScene& listed = list[static_cast<std::size_t>(pieces.point)];
    RunOptions single = options_for(options, listed);
    single.resume = true;
    single.force = false;
    return one(listed.file, single);
}

}  // namespace unravel::tool
