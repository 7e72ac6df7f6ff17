#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tool/base/exit.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

/// --slurm and what goes with it: work sent to a cluster instead of done here.
struct ClusterOptions {
    bool submit = false;   ///< --slurm
    bool wait = false;     ///< --wait: show progress until all is done
    bool dry_run = false;  ///< --dry-run: print the job scripts, change nothing
    std::string partition, time;
    int cpus = 0;                     ///< per task; 0: as the cluster has it
    int array_limit = 0;              ///< tasks at the same time; 0: as many as the cluster gives
    std::vector<std::string> sbatch;  ///< any other of sbatch's options, as they are
};

/// What the command line says; commands read the parts that concern them.
struct Options {
    std::vector<std::string> words;             ///< the command line itself, from the command's name on
    std::vector<std::filesystem::path> scenes;  ///< run, simulate: all that were named
    std::filesystem::path scene;                ///< SCENE or RUN_DIR
    std::filesystem::path output;               ///< -o; empty: output/<scene name>
    std::vector<std::string> overrides;         ///< --set
    std::string frames;                         ///< --frames A-B
    int threads = 0;                            ///< 0: one per processor
    bool resume = false, force = false, quiet = false, json = false;
    bool compare_whole = false;
    std::string device = "auto";
    std::string style = "both";  ///< views, separated by commas
    std::string size;            ///< --size WxH
    std::string camera;          ///< names of the scene's, separated by commas, or all; empty: its first
    std::string video;           ///< mp4, webm, mkv, gif, none; empty: mp4, or mkv where frames have an alpha
    std::string show;            ///< what wires' colours tell; empty: as the scene says
    bool legend = false, transparent = false;
    int motion_blur = 0, subdivide = -1;  ///< as the scene says
    int still = -1;                       ///< this frame alone, without a video; −1: no
    double turntable = 0;                 ///< s of one turn about a frame that stands still; 0: none
    std::string codec, preset;
    int crf = -1;
    int samples = 0, supersample = 1;
    bool pictures = true;
    double budget = 10;                       ///< --budget, minutes
    double error = 1e-3;                      ///< --error, of the cloth's diagonal
    double stiffer = 0;                       ///< accuracy: also a cloth so many times stiffer; 0: not
    bool allow_unstable = false;              ///< run although explicit springs are beyond their limit
    std::vector<std::string> runs;            ///< sheet: RUN_DIR[:FRAME]
    std::vector<std::string> cases;           ///< stability: these only
    bool map = false;                         ///< stability: the (stiffness, step) map
    int frame = 0, step = 0;                  ///< inspect: --frame, and --step within it (0: its last)
    std::int64_t particle = -1, spring = -1;  ///< inspect; −1: none asked for
    std::string format = "obj";               ///< export
    bool quick = false;                       ///< reproduce
    std::string sizes;                        ///< bench: numbers of particles, separated by commas
    std::string what;                         ///< schema: scene, run or stats
    ClusterOptions cluster;
    int point = -1;          ///< --point: this piece of the work only, counted from 0; −1: all
    int parts = 0;           ///< render: --parts, ranges of frames that the work is cut into; 0: chosen
    bool collect = false;    ///< --collect: conclude from the pieces that lie there, compute none
    bool reference = false;  ///< accuracy: --reference, compute nothing else
};

// The commands. Each returns an exit code and throws what main() turns into one.
int command_run(const Options& options);
int command_simulate(const Options& options);
int command_render(const Options& options);
int command_sheet(const Options& options);
int command_export(const Options& options);
int command_accuracy(const Options& options);
int command_inspect(const Options& options);
int command_reproduce(const Options& options);
int command_schema(const Options& options);
int command_check(const Options& options);
int command_stability(const Options& options);
int command_doctor(const Options& options);

}  // namespace unravel::tool
