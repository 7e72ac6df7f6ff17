// unravel gallery SCENE ...: scenes that were run on one page, each with its clip, its numbers and its text.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/base/exit.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/folder/run_folder.hpp"
#include "tool/report/html.hpp"
#include "tool/report/page_files.hpp"
#include "tool/report/preview.hpp"

namespace unravel::tool {

namespace {

struct GalleryOptions {
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path runs = "output", file = "gallery.html";
    OutputOptions output;
};

// A clip that is longer is left where it is.
constexpr std::size_t largest_video = std::size_t{64} << 20;

// The comment that a scene begins with: what it shows.
std::string opening_words(std::string_view text) {
    std::string words;
    while (text.starts_with('#')) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::size_t first = std::min(text.find_first_not_of("# "), end);
        words += (words.empty() ? "" : " ") + std::string(text.substr(first, end - first));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return words;
}

std::string numbers_of(const nlohmann::ordered_json& run) {
    const auto& totals = run["totals"];
    std::string html;
    const auto fact = [&](const char* name, const std::string& value) {
        html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
    };
    fact("particles", fmt::format("{}", run["particles"].get<int>()));
    fact("steps", fmt::format("{}", run["steps"].get<int>()));
    fact("components at most", fmt::format("{}", totals["most_components"].get<int>()));
    fact("rows held fully", fmt::format("{:.1f}%", 100 * totals["constrained_share"].get<double>()));
    if (totals.contains("rvm_saved"))
        fact("fewer RVMs than whole", fmt::format("{:.1f}%", 100 * totals["rvm_saved"].get<double>()));
    fact("greatest strain", fmt::format("{:.3g}%", 100 * totals["max_strain"].get<double>()));
    if (run.contains("seconds"))
        fact("simulated in", fmt::format("{:.1f} s", run["seconds"]["simulate"].get<double>()));
    return html;
}

std::string videos_of(const RunFolder& folder, const nlohmann::ordered_json& run) {
    std::string html;
    if (!run.contains("videos")) return html;
    for (const auto& name : run["videos"]) {
        const std::filesystem::path file = folder.root / name.get<std::string>();
        const std::string ending = file.extension().string();
        if (!std::filesystem::exists(file) || (ending != ".mp4" && ending != ".webm")) continue;
        html += fmt::format(
            R"(<figure><video controls loop muted preload="metadata" src="data:video/{};base64,{}"></video><figcaption>{}</figcaption></figure>)",
            ending.substr(1), base64(read_whole_file(file, largest_video)), html_text(file.stem().string()));
    }
    return html;
}

// One scene's part of the page. Throws FolderError where its run is not there.
std::string section_of(const std::filesystem::path& file, const std::filesystem::path& runs) {
    const Scene scene = load_scene(file);
    const RunFolder folder{runs / scene.name};
    const nlohmann::ordered_json run = read_run_json(folder);
    if (!run.contains("status") || run["status"] != "complete")
        throw FolderError(fmt::format("'{}' holds no complete run of {}: `unravel run {} -o {}` makes it",
                                      folder.root.string(), scene.name, file.string(), folder.root.string()));
    return fmt::format(
        "<section><h2>{}</h2><p>{}</p><div class=\"figures\">{}</div><dl id=\"facts\">{}</dl>"
        "<details><summary>The scene</summary><pre tabindex=\"0\">{}</pre></details></section>\n",
        html_text(scene.name), html_text(opening_words(scene.text)), videos_of(folder, run), numbers_of(run),
        html_text(scene.text));
}

int gallery(const GalleryOptions& options) {
    std::string sections;
    for (const std::filesystem::path& scene : options.scenes) sections += section_of(scene, options.runs);
    const std::string summary =
        fmt::format("{} scenes, each with its clip, what taking it apart was worth, and its text.",
                    options.scenes.size());
    write_whole_file(options.file, fill_page(page_file("gallery.html"), {{"style", page_file("report.css")},
                                                                         {"summary", summary},
                                                                         {"scenes", sections}}));
    if (options.output.json)
        fmt::print(
            "{}\n",
            nlohmann::json{{"file", options.file.string()}, {"scenes", options.scenes.size()}}.dump(2));
    else if (!options.output.quiet)
        fmt::print("  {}\n", options.file.string());
    return exit_done;
}

}  // namespace

void add_gallery(CommandLine& line) {
    const auto [command, o] = line.add("gallery", "scenes that were run, on one page", gallery);
    command.add_option("SCENE", o.scenes, "scene files that were run")->required();
    command.add_option("--runs", o.runs, "folder that their runs' folders are in")->capture_default_str();
    command.add_option("-o", o.file, "the page, self-contained")->capture_default_str();
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
