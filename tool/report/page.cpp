#include "tool/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/terms/effects.hpp"
#include "tool/base/progress.hpp"
#include "tool/report/html.hpp"
#include "tool/report/page_files.hpp"
#include "tool/report/series.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;

std::string hex(Rgb c) {
    return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b);
}

// Three digits are what a residual means.
double rounded(double value) {
    return std::stod(fmt::format("{:.3g}", value));
}

Json frame_json(const PageFrame& frame, const std::vector<ComponentRow>& rows) {
    Json json;
    json["number"] = frame.number;
    json["time"] = frame.time;
    if (frame.last_step > 0) json["steps"] = {frame.first_step, frame.last_step};
    json["components"] = Json::array();
    for (const ComponentRow& row : rows) {
        json["components"].push_back({row.id, hex(row.color), row.particles, row.boundary, row.springs,
                                      row.solve.iterations, row.solve.rvm, rounded(row.solve.residual),
                                      row.solve.by, row.solve.because});
    }
    if (frame.rest.count > 0) {
        json["rest"] = {{"count", frame.rest.count},
                        {"particles", frame.rest.particles},
                        {"springs", frame.rest.springs},
                        {"iterations", frame.rest.iterations},
                        {"rvm", frame.rest.rvm}};
    }
    return json;
}

// Which pictures go into the page. Too many of them: none where the folder has them as files, else of every
// k-th frame.
std::vector<int> inlined(const Previews& previews, const std::string& view, bool on_disk) {
    if (!previews.within_budget() && on_disk) return {};
    const std::size_t every = previews.bytes() / picture_budget + 1;
    const std::vector<int> all = previews.frames(view);
    std::vector<int> some;
    for (std::size_t k = 0; k < all.size(); k += every) some.push_back(all[k]);
    return some;
}

std::vector<int> pictures_on_disk(const RunFolder& folder, const std::string& view,
                                  const std::vector<PageFrame>& frames) {
    std::vector<int> numbers;
    for (const PageFrame& frame : frames) {
        if (std::filesystem::exists(folder.picture(view, frame.number))) numbers.push_back(frame.number);
    }
    return numbers;
}

// JSON within a <script> must not hold its end.
std::string script_safe(const Json& json) {
    std::string text = json.dump();
    for (std::size_t at = 0; (at = text.find("</", at)) != text.npos; at += 3) text.insert(at + 1, "\\");
    for (std::size_t at = 0; (at = text.find("<!--", at)) != text.npos; at += 9)
        text.replace(at, 1, "\\u003c");
    return text;
}

}  // namespace

PageFacts page_facts(const Json& run) {
    PageFacts facts;
    facts.status = run.value("status", "unknown");
    const auto say = [&](const char* name, std::string text) {
        if (!text.empty()) facts.made.emplace_back(name, std::move(text));
    };
    say("version", "Unravel " + run.value("version", ""));
    say("host", run.value("host", ""));
    if (run.contains("threads")) say("threads", std::to_string(run["threads"].get<int>()));
    if (run.contains("renderer")) {
        say("renderer", run["renderer"].value("name", ""));
        say("why this one", run["renderer"].value("why", ""));
    }
    if (run.contains("encoder")) {
        for (const Json& line : run["encoder"]) say("encoder", line.get<std::string>());
    }
    if (run.contains("wall_seconds")) say("time in all", duration_text(run["wall_seconds"].get<double>()));
    // As plan_json() has them (sim/step/plan_text.hpp).
    if (run.contains("plan")) {
        const Json& plan = run["plan"];
        const auto word = [](const Json& of, const char* key) { return of.value(key, std::string()); };
        say("integrator", word(plan, "integrator") + ": " + word(plan, "integrator_because"));
        say("steps", word(plan, "steps") + ": " + word(plan, "steps_because"));
        for (const Json& cloth : plan.value("cloths", Json::array())) {
            say(("cloth " + word(cloth, "name")).c_str(),
                fmt::format("forces by the {} path: {}; solver: {}", word(cloth, "path"),
                            word(cloth, "because"), word(cloth, "solver")));
        }
    }
    return facts;
}

Previews previews_of(const Scene& scene, const ClipOptions& options, const std::filesystem::path& folder) {
    const int frames = std::max(0, options.last - options.first + 1);
    return Previews(scene.clip.size[0], scene.clip.size[1],
                    frames * static_cast<int>(std::ssize(page_layouts)), picture_budget, folder);
}

std::function<void(const ClipView&, int, const Image&)> take_previews(Previews& previews) {
    return [&previews](const ClipView& view, int frame, const Image& picture) {
        for (const Layout layout : page_layouts)
            if (view.name == layout_name(layout)) previews.add(view.name, frame, picture);
    };
}

void write_report_page(const Scene& scene, const ClothModel& model, const RunFolder& folder,
                       const PageRecorder& recorder, std::span<const StepReport> reports,
                       const Previews& previews, const PageFacts& facts) {
    const std::vector<PageFrame>& frames = recorder.frames();
    Json data;
    std::vector<std::pair<std::string, std::vector<int>>> pictures;  // views and the frames within the page
    data["views"] = Json::array();
    for (std::uint8_t k = 0; k < solver_count; ++k) data["solvers"].push_back(words(SolvedBy{k}));
    for (std::uint8_t k = 0; k < solve_reason_count; ++k) data["reasons"].push_back(words(SolveReason{k}));
    for (const Layout layout : page_layouts) {
        const std::string name = layout_name(layout);
        const std::vector<int> files = pictures_on_disk(folder, name, frames);
        std::vector<int> inside = inlined(previews, name, !files.empty());
        if (files.empty() && inside.empty()) continue;
        Json view{{"name", name}};
        if (!files.empty()) {
            view["files"] = fmt::format("frames/{}_", name);
            view["numbers"] = files;
        }
        data["views"].push_back(view);
        pictures.emplace_back(name, std::move(inside));
    }
    data["size"] = scene.clip.size;
    data["fps"] = scene.clip.fps.per_second();
    data["series"] = page_series(frames, reports, model);
    data["summary"] = page_summary(scene, model, frames, reports, facts.status);
    data["warnings"] = page_warnings(scene, model, frames, reports, facts.status);
    data["effects"] = Json::array();
    for (const Effect& effect : list_effects(scene)) {
        data["effects"].push_back({{"name", effect.name}, {"on", effect.on}, {"because", effect.because}});
    }
    data["scene"] = scene_to_toml(scene);
    data["made"] = facts.made;

    // The page is written as it is made: with all its pictures it may be larger than the run that made it.
    const LongText all_frames = [&](const TextSink& out) {
        for (std::size_t k = 0; k < frames.size(); ++k) {
            out(k == 0 ? "[" : ",\n");
            out(script_safe(frame_json(frames[k], recorder.rows(frames[k]))));
        }
        out(frames.empty() ? "[]" : "]");
    };
    const LongText all_pictures = [&](const TextSink& out) {
        out("{");
        for (std::size_t v = 0; v < pictures.size(); ++v) {
            const auto& [name, numbers] = pictures[v];
            out(fmt::format("{}\"{}\":{{", v == 0 ? "" : ",\n", name));
            for (std::size_t k = 0; k < numbers.size(); ++k)
                out(fmt::format("{}\"{}\":\"{}\"", k == 0 ? "" : ",\n", numbers[k],
                                previews.text(name, numbers[k])));
            out("}");
        }
        out("}");
    };
    const auto text = [](std::string value) -> LongText {
        return [value = std::move(value)](const TextSink& out) { out(value); };
    };
    const auto embedded = [](const char* name) -> LongText {
        return [name](const TextSink& out) { out(page_file(name)); };
    };
    WholeFile file(folder.report());
    fill_page(page_file("report.html"),
              {{"title", text(html_text(scene.name))},
               {"library_style", embedded("dygraph.min.css")},
               {"style", embedded("report.css")},
               {"data", text(script_safe(data))},
               {"frames", all_frames},
               {"pictures", all_pictures},
               {"library", embedded("dygraph.min.js")},
               {"plots", embedded("report_plots.js")},
               {"script", embedded("report.js")}},
              [&](std::string_view part) { file.write(part); });
    file.commit();
}

}  // namespace unravel::tool
