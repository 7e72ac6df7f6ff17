// unravel stability: every hard case, with what must happen, what happened, numbers and a picture.

#include <fmt/format.h>

#include <algorithm>

#include "base/whole_file.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/program.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/cluster/cluster.hpp"
#include "tool/study/stability/hard_case.hpp"
#include "tool/study/stability/stability_map.hpp"
#include "tool/study/stability/stability_picture.hpp"
#include "tool/study/stability/stability_points.hpp"
#include "tool/study/stability/stability_report.hpp"

namespace unravel::tool {

namespace {

struct StabilityOptions {
    std::vector<std::string> cases;  // names, or parts of them; empty: all
    bool map = false;                // also the (stiffness, step) map
    std::filesystem::path scenes = shipped_scenes() / "hard", folder = "output/stability";
    std::string device = "auto";
    bool pictures = true;
    PieceOptions pieces;
    std::vector<std::string> words;  // the command line as it was written
    OutputOptions output;
};

bool is_asked_for(const HardCase& hard, const std::vector<std::string>& names) {
    return names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
               return hard.name.find(name) != std::string::npos;
           });
}

void tell(const StabilityMap& map) {
    const auto& cells = map.cells;
    // The paper's claim: nothing blows up below kappa = 1/2.
    const auto below = std::count_if(cells.begin(), cells.end(),
                                     [](const MapCell& cell) { return cell.kappa <= 0.5 && !cell.stable; });
    const auto broken =
        std::count_if(cells.begin(), cells.end(), [](const MapCell& cell) { return !cell.stable; });
    fmt::print("map of {:<15} {} of {} runs blow up, {} of them at kappa <= 1/2\n", map.integrator, broken,
               cells.size(), below);
    std::fflush(stdout);
}

// What is asked for, in pieces that don't depend on each other: the cases, then the maps.
struct Study {
    std::filesystem::path scenes, output;
    std::vector<HardCase> cases;
    std::vector<std::string> maps;  // integrators

    std::filesystem::path map_scene() const { return scenes / "map.toml"; }
    std::size_t size() const { return cases.size() + maps.size(); }
    std::string name(std::size_t k) const {
        return k < cases.size() ? cases[k].name : "map of " + maps[k - cases.size()];
    }
};

Study study_of(const StabilityOptions& options) {
    Study study;
    study.scenes = options.scenes;
    study.output = options.folder;
    study.cases = read_hard_cases(study.scenes / "cases.toml");
    std::erase_if(study.cases, [&](const HardCase& hard) { return !is_asked_for(hard, options.cases); });
    if (study.cases.empty())
        throw UsageError(fmt::format("no hard case has such a name; {} lists them",
                                     (study.scenes / "cases.toml").string()));
    if (options.map) study.maps.assign(std::begin(mapped_integrators), std::end(mapped_integrators));
    return study;
}

void create_output(const Study& study) {
    std::error_code error;
    std::filesystem::create_directories(study.output, error);
    if (error) throw OutputError(study.output, error.value());
}

HardLine do_case(const HardCase& hard, const Study& study, const std::optional<GlContext>& context) {
    HardLine line{hard, run_hard_case(hard), ""};
    if (context && draw_hard_case(*context, line.outcome, study.output / (hard.name + ".png")))
        line.picture = hard.name + ".png";
    line.outcome.last = {};
    return line;
}

int conclude(const StabilityOptions& options, const Study& study, const std::vector<HardLine>& lines,
             const std::vector<StabilityMap>& maps) {
    std::vector<std::string> pictures;
    if (!maps.empty()) pictures = write_stability_maps(study.output, maps);
    const nlohmann::ordered_json json = stability_json(lines);
    write_whole_file(study.output / "stability.json", json.dump(2) + "\n");
    write_whole_file(study.output / "table.md", stability_markdown(lines));
    write_whole_file(study.output / "index.html", stability_html(lines, pictures));
    const auto wrong = std::count_if(lines.begin(), lines.end(),
                                     [](const HardLine& line) { return !line.outcome.failures.empty(); });
    if (options.output.json) {
        fmt::print("{}\n", json.dump(2));
    } else if (!options.output.quiet) {
        fmt::print("{} of {} cases as they must be\n  {}\n", lines.size() - static_cast<std::size_t>(wrong),
                   lines.size(), (study.output / "index.html").string());
    }
    return wrong == 0 ? exit_done : exit_simulation;
}

int do_piece(const StabilityOptions& options, const Study& study) {
    const auto k = static_cast<std::size_t>(options.pieces.point);
    if (k >= study.size())
        throw UsageError(fmt::format("--point {}: the pieces end at {}", k, study.size() - 1));
    create_output(study);
    if (k >= study.cases.size()) {
        const StabilityMap map = make_stability_map(study.map_scene(), study.maps[k - study.cases.size()]);
        write_map_piece(study.output, study.map_scene(), map);
        return exit_done;
    }
    std::optional<GlContext> context;
    if (options.pictures) context.emplace(parse_device_choice(options.device));
    const HardLine line = do_case(study.cases[k], study, context);
    fmt::print("{}\n", terminal_line(line));
    write_hard_line(study.output, line, options.pictures);
    return exit_done;  // a case that is not as it must be is a result too
}

int collect(const StabilityOptions& options, const Study& study) {
    const bool silent = !options.output.talks();
    std::vector<HardLine> lines;
    std::vector<StabilityMap> maps;
    std::string missing;
    for (std::size_t k = 0; k < study.size(); ++k) {
        std::optional<HardLine> line;
        std::optional<StabilityMap> map;
        if (k < study.cases.size()) {
            line = read_hard_line(study.output, study.cases[k], options.pictures);
        } else {
            map = read_map_piece(study.output, study.map_scene(), study.maps[k - study.cases.size()]);
        }
        if (!line && !map) {
            missing += fmt::format("\n  {}: {}", study.name(k),
                                   why_missing(study.output, "stability", static_cast<int>(k)));
        }
        if (line && !silent) fmt::print("{}\n", terminal_line(*line));
        if (map && !silent) tell(*map);
        if (line) lines.push_back(std::move(*line));
        if (map) maps.push_back(std::move(*map));
    }
    const int code = conclude(options, study, lines, maps);
    if (!missing.empty()) {
        throw MissingPieces("cases are missing:" + missing +
                            "\nthe same command sends them again and keeps the rest");
    }
    return code;
}

int send(const StabilityOptions& options, const Study& study) {
    const auto is_there = [&](std::size_t k) {
        if (k < study.cases.size())
            return read_hard_line(study.output, study.cases[k], options.pictures).has_value();
        const std::string& integrator = study.maps[k - study.cases.size()];
        return read_map_piece(study.output, study.map_scene(), integrator).has_value();
    };
    ClusterWork work;
    work.name = "stability";
    work.what = fmt::format("hard case K of {}, counted from 0{}", study.cases.size(),
                            study.maps.empty() ? "" : ", or map of an integrator behind them");
    work.results = study.output;
    work.words = options.words;
    work.unit = "case";
    work.total = static_cast<int>(study.size());
    for (std::size_t k = 0; k < study.size(); ++k) {
        if (!is_there(k)) work.missing.push_back(static_cast<int>(k));
    }
    work.done = [&] {
        return work.total -
               static_cast<int>(std::count_if(work.missing.begin(), work.missing.end(),
                                              [&](int k) { return !is_there(static_cast<std::size_t>(k)); }));
    };
    return do_on_cluster(options.pieces.cluster, options.output, work);
}

int do_all(const StabilityOptions& options, const Study& study) {
    const bool silent = !options.output.talks();
    create_output(study);
    std::optional<GlContext> context;
    if (options.pictures) context.emplace(parse_device_choice(options.device));
    std::vector<HardLine> lines;
    for (const HardCase& hard : study.cases) {
        lines.push_back(do_case(hard, study, context));
        if (silent) continue;
        fmt::print("{}\n", terminal_line(lines.back()));
        std::fflush(stdout);
    }
    std::vector<StabilityMap> maps;
    for (const std::string& integrator : study.maps) {
        maps.push_back(make_stability_map(study.map_scene(), integrator));
        if (!silent) tell(maps.back());
    }
    return conclude(options, study, lines, maps);
}

int stability(const StabilityOptions& options) {
    const Study study = study_of(options);
    const PieceOptions& pieces = options.pieces;
    if (pieces.cluster.submit) return send(options, study);
    if (pieces.collect) return collect(options, study);
    return pieces.point >= 0 ? do_piece(options, study) : do_all(options, study);
}

}  // namespace

void add_stability(CommandLine& line) {
    const auto [command, o] =
        line.add("stability", "the hard cases, each with verdict, numbers and picture", stability);
    o.words = line.words();
    command.add_option("cases", o.cases, "names of cases, or parts of them (default: all)");
    command.add_flag("--map", o.map, "also the (stiffness, step) map of each integrator");
    command.add_option("--scenes", o.scenes, "folder of the cases (default: those that ship)");
    command.add_option("-o", o.folder, "folder for the results")->capture_default_str();
    add_device(command, o.device);
    command.add_flag("--pictures,!--no-pictures", o.pictures, "draw each case (default: yes)");
    add_piece_options(command, o.pieces);
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
