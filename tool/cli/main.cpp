// Arguments → options → command.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>

#include "tool/base/options.hpp"
#include "tool/base/version.hpp"
#include "tool/bench/command_speed.hpp"
#include "tool/bench/frames.hpp"
#include "tool/cli/guarded.hpp"
#include "tool/cluster/cluster.hpp"

namespace {

using namespace unravel::tool;

void add_run_options(CLI::App& command, Options& o) {
    command.add_option(
        "-o", o.output,
        "folder of the run (default: output/<scene name>); of several scenes, the folder around theirs");
    command.add_option("--set", o.overrides, "key=value: another value for a key of the scene; repeatable")
        ->allow_extra_args(false);
    command.add_option("--threads", o.threads, "threads of the simulation (default: one per processor)")
        ->check(CLI::Range(1, 1024));
    command.add_flag("--resume", o.resume, "go on from the last frame in the folder");
    command.add_flag("--force", o.force, "start anew in a folder that holds a run");
    command.add_flag("--allow-unstable", o.allow_unstable,
                     "simulate although the step is beyond the limit of the springs handled explicitly");
    command.add_flag("--compare-whole", o.compare_whole,
                     "solve each system undecomposed too, and count rvm_whole");
}

void add_picture_options(CLI::App& command, Options& o) {
    command.add_option("--frames", o.frames, "A-B: only these frames");
    command
        .add_option("--style", o.style,
                    "textured, components, both, overlay or side-by-side; several with commas between")
        ->capture_default_str();
    command.add_option("--show", o.show, "what the colours of the component view tell (default: components)")
        ->check(CLI::IsMember({"components", "splitting", "strain", "velocity", "contact"}));
    command.add_flag("--legend", o.legend, "tell in the component view what its colours mean");
    command.add_flag("--transparent", o.transparent,
                     "no ground, no background: frames with an alpha channel");
    command.add_option("--motion-blur", o.motion_blur, "sub-frames that each picture is the mean of")
        ->check(CLI::Range(1, 64));
    command
        .add_option("--subdivide", o.subdivide, "draw each cell as 4 to the power of this many smooth ones")
        ->check(CLI::Range(0, 3));
    command.add_option("--size", o.size, "WxH, both even (default: the scene's)");
    command.add_option("--camera", o.camera,
                       "the scene's cameras by name, with commas between, or all (default: the first)");
    command.add_option("--device", o.device, "auto, gpu, software or the number of an EGL device")
        ->capture_default_str();
    command
        .add_option("--samples", o.samples,
                    "per pixel, clamped to what the renderer offers (default: 4; on the CPU outlines are "
                    "smoothed instead)")
        ->check(CLI::Range(1, 64));
    command.add_option("--supersample", o.supersample, "draw this many times larger and average")
        ->check(CLI::Range(1, 4));
    command
        .add_option("--video", o.video,
                    "mp4, webm, mkv (lossless), gif or none (default: mp4; mkv where --transparent)")
        ->check(CLI::IsMember({"mp4", "webm", "mkv", "gif", "none"}));
    command.add_option("--codec", o.codec, "this encoder and no other");
    command.add_option("--crf", o.crf, "quality of the video, smaller is better")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--preset", o.preset, "the encoder's effort");
    command.add_flag("--pictures,!--no-pictures", o.pictures, "write PNG frames (default: yes)");
}

void add_output_options(CLI::App& command, Options& o) {
    command.add_flag("--quiet", o.quiet, "print errors only");
    command.add_flag("--json", o.json, "print the result as JSON");
}

CLI::Option* add_submission_options(CLI::App& command, Options& o) {
    ClusterOptions& c = o.cluster;
    const auto add = [&](CLI::Option* option) { return option->group("On a cluster"); };
    CLI::Option* slurm = add(
        command.add_flag("--slurm", c.submit,
                         "send what is missing to Slurm as an array job, and a job after it that concludes"));
    const auto with = [&](CLI::Option* option) { add(option)->needs(slurm); };
    with(command.add_flag("--wait", c.wait, "show progress until all is done"));
    with(command.add_flag("--dry-run", c.dry_run, "print the job scripts, change nothing"));
    with(command.add_option("--partition", c.partition, "of the cluster"));
    with(command.add_option("--time", c.time, "limit for each task, as sbatch takes it"));
    with(command.add_option("--cpus", c.cpus, "processors for each task")->check(CLI::Range(1, 1024)));
    with(command.add_option("--array-limit", c.array_limit, "tasks at the same time")
             ->check(CLI::Range(1, 1000000)));
    with(
        command.add_option("--sbatch", c.sbatch, "any other option of sbatch: --sbatch=--mem=8G; repeatable")
            ->allow_extra_args(false));
    return slurm;
}

// Commands whose work falls into pieces.
void add_cluster_options(CLI::App& command, Options& o) {
    CLI::Option* slurm = add_submission_options(command, o);
    CLI::Option* point =
        command.add_option("--point", o.point, "what a task does: this piece only, from 0 on")
            ->check(CLI::Range(0, 1000000))
            ->group("On a cluster");
    CLI::Option* collect =
        command
            .add_flag("--collect", o.collect,
                      "conclude from the pieces that lie there, name those that are missing")
            ->group("On a cluster");
    slurm->excludes(point)->excludes(collect);
    point->excludes(collect);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    options.words.assign(argv + std::min(argc, 1), argv + argc);
    CLI::App app("Unravel: cloth simulated with a decomposing solver, rendered off-screen.", "unravel");
    app.set_version_flag("--version", version());
    app.require_subcommand(1);

    std::function<int()> chosen;
    const auto command = [&](const char* name, const char* what, int (*run)(const Options&)) {
        CLI::App* sub = app.add_subcommand(name, what);
        add_output_options(*sub, options);
        sub->callback([&, run] { chosen = [&, run] { return run(options); }; });
        return sub;
    };
    const auto takes = [&](CLI::App* sub, const char* what, const char* meaning) {
        sub->add_option(what, options.scene, meaning)->required();
        return sub;
    };

    const auto takes_scenes = [&](CLI::App* sub) {
        sub->add_option("SCENE", options.scenes, "scene files, each made into a clip of its own")->required();
        add_run_options(*sub, options);
        add_cluster_options(*sub, options);
        return sub;
    };
    add_picture_options(*takes_scenes(command("run", "simulate, render both views, encode", command_run)),
                        options);
    takes_scenes(command("simulate", "simulate only, into a cache", command_simulate));
    CLI::App* render = takes(command("render", "pictures and videos from a cached run", command_render),
                             "RUN_DIR", "folder of the run");
    render->add_option("-o", options.output, "folder for the pictures (default: the run's own)");
    render->add_option("--set", options.overrides, "key=value of [camera], [look] or clip.size")
        ->allow_extra_args(false);
    add_picture_options(*render, options);
    add_cluster_options(*render, options);
    render
        ->add_option("--parts", options.parts, "ranges that a cluster draws the frames in (default: chosen)")
        ->check(CLI::Range(1, 1000));
    render->add_option("--still", options.still, "this frame alone, without a video")
        ->check(CLI::NonNegativeNumber);
    render
        ->add_option("--turntable", options.turntable,
                     "seconds of one turn about a frame that stands still: --still, or the last")
        ->check(CLI::Range(0.1, 600.0));
    CLI::App* sheet = command("sheet", "both views of a frame of each run in one picture", command_sheet);
    sheet->add_option("runs", options.runs, "RUN_DIR or RUN_DIR:FRAME (default: its last frame)")->required();
    sheet->add_option("-o", options.output, "PNG file (default: sheet.png)");
    sheet->add_option("--size", options.size, "WxH of each picture, both even (default: the scene's)");
    sheet->add_option("--camera", options.camera, "one of the scene's cameras (default: the first)");
    sheet->add_option("--show", options.show, "what the colours of the component view tell")
        ->check(CLI::IsMember({"components", "splitting", "strain", "velocity", "contact"}));
    sheet->add_option("--samples", options.samples, "per pixel")->check(CLI::Range(1, 64));
    sheet->add_option("--supersample", options.supersample, "draw this many times larger and average")
        ->check(CLI::Range(1, 4));
    sheet->add_option("--device", options.device, "auto, gpu, software or the number of an EGL device")
        ->capture_default_str();
    CLI::App* exported =
        takes(command("export", "a cached run's geometry for other programs, frame by frame", command_export),
              "RUN_DIR", "folder of the run");
    exported->add_option("--format", options.format, "obj, ply, pc2, mdd or glb (docs/geometry.md)")
        ->check(CLI::IsMember({"obj", "ply", "pc2", "mdd", "glb"}))
        ->required();
    exported->add_option("-o", options.output, "folder for the files (default: RUN_DIR/export/FORMAT)");
    exported->add_option("--frames", options.frames, "A-B: only these frames");
    CLI::App* accuracy = takes(
        command("accuracy", "what accuracy costs in time: integrators, steps, thresholds and tolerances",
                command_accuracy),
        "SCENE", "scene file");
    accuracy->add_option("-o", options.output, "folder of the study (default: output/<scene name>_accuracy)");
    accuracy->add_option("--set", options.overrides, "key=value: another value for a key of the scene")
        ->allow_extra_args(false);
    accuracy->add_option("--budget", options.budget, "minutes that the study may take")
        ->check(CLI::Range(0.1, 1e5))
        ->capture_default_str();
    accuracy->add_option("--error", options.error, "to be borne, as a share of the cloth's diagonal")
        ->check(CLI::Range(1e-9, 1.0))
        ->capture_default_str();
    accuracy
        ->add_option("--stiffer", options.stiffer,
                     "the same study of a cloth so many times stiffer, and both side by side")
        ->check(CLI::Range(1.0, 1e6));
    accuracy->add_option("--video", options.video, "mp4 of a cheap run beside an accurate one, or none")
        ->check(CLI::IsMember({"mp4", "none"}))
        ->capture_default_str();
    accuracy->add_option("--device", options.device, "auto, gpu, software or the number of an EGL device")
        ->capture_default_str();
    accuracy
        ->add_option("--threads", options.threads, "threads of the simulation (default: one per processor)")
        ->check(CLI::Range(1, 1024));
    accuracy->add_flag("--force", options.force, "forget the points of an earlier study in the folder");
    add_cluster_options(*accuracy, options);
    accuracy->add_flag("--reference", options.reference, "compute the reference, no point")
        ->group("On a cluster");
    CLI::App* inspect =
        takes(command("inspect", "one frame in depth: components, splitting, the matrix", command_inspect),
              "RUN_DIR", "folder of the run");
    inspect->add_option("--frame", options.frame, "number of the frame, 1 or more")->required();
    inspect
        ->add_option("--step", options.step, "step on the way to that frame, 1 or more (default: the last)")
        ->check(CLI::Range(1, 1000000));
    inspect->add_option("--particle", options.particle, "tell all about this particle")
        ->check(CLI::NonNegativeNumber);
    inspect->add_option("--spring", options.spring, "tell all about this stretch or shear spring")
        ->check(CLI::NonNegativeNumber);
    inspect->add_option("--device", options.device, "auto, gpu, software or the number of an EGL device")
        ->capture_default_str();
    CLI::App* reproduce =
        command("reproduce", "every figure and claim of the paper again, beside ours", command_reproduce);
    reproduce->add_flag("--quick", options.quick,
                        "small and short: shows that it works, not what it reaches");
    reproduce->add_option("-o", options.output, "folder of the report (default: output/reproduce)");
    reproduce->add_option("--device", options.device, "auto, gpu, software or the number of an EGL device")
        ->capture_default_str();
    bool frames_bench = false;
    CLI::App* bench = command("bench", "how fast it is by size, beside other solvers; or what pictures cost",
                              command_bench_speed);
    bench->add_option("scene", options.scene,
                      "scene file whose cloth is refined (default: hang; with --frames drape_sphere)");
    bench->add_option("-o", options.output, "folder for tables, plots and records (default: output/bench)");
    bench->add_option("--sizes", options.sizes,
                      "numbers of particles with commas between (default: 2500,10000,40000)");
    bench
        ->add_option("--budget", options.budget,
                     "minutes that it may take: repeats are cut, then slow rivals")
        ->check(CLI::Range(0.01, 10000.0))
        ->capture_default_str();
    CLI::Option* frames = bench->add_flag(
        "--frames", frames_bench,
        "what pictures cost instead: simulation, drawing, PNG and mp4 of both views, each alone "
        "and all together");
    bench->get_option("--sizes")->excludes(frames);
    bench
        ->add_option("--set", options.overrides,
                     "key=value: another value for a key of the scene; repeatable")
        ->allow_extra_args(false);
    bench->add_option("--threads", options.threads, "threads of the simulation (default: one per processor)")
        ->check(CLI::Range(1, 1024));
    bench->add_option("--device", options.device, "auto, gpu, software or the number of an EGL device")
        ->needs(frames)
        ->capture_default_str();
    bench->callback([&] {
        chosen = [&] {
            if (options.cluster.submit) return send_bench(options);
            return frames_bench ? command_bench_frames(options) : command_bench_speed(options);
        };
    });
    add_submission_options(*bench, options);
    CLI::App* schema = command("schema", "what files hold, for editors and programs", command_schema);
    schema
        ->add_option("what", options.what,
                     "scene, run or bench (JSON schemas), keys (the scene's, as Markdown), stats (columns of "
                     "stats.csv)")
        ->check(CLI::IsMember({"scene", "keys", "run", "bench", "stats"}))
        ->required();
    CLI::App* check = takes(command("check", "what is wrong with a scene, or what would run", command_check),
                            "SCENE", "scene file");
    check
        ->add_option("--set", options.overrides,
                     "key=value: another value for a key of the scene; repeatable")
        ->allow_extra_args(false);
    CLI::App* stability =
        command("stability", "the hard cases, each with verdict, numbers and picture", command_stability);
    stability->add_option("cases", options.cases, "names of cases, or parts of them (default: all)");
    stability->add_flag("--map", options.map, "also the (stiffness, step) map of each integrator");
    stability->add_option("--scenes", options.scene, "folder of the cases (default: scenes/hard)");
    stability->add_option("-o", options.output, "folder for the results (default: output/stability)");
    stability->add_option("--device", options.device, "auto, gpu, software or the number of an EGL device")
        ->capture_default_str();
    stability->add_flag("--pictures,!--no-pictures", options.pictures, "draw each case (default: yes)");
    add_cluster_options(*stability, options);
    command("doctor", "which renderers and encoders this machine has, and how to get what is missing",
            command_doctor);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        if (code != 0) return exit_usage;
        std::cout.flush();  // help goes there
        return guarded([] { return exit_done; });
    }
    return guarded(chosen);
}
