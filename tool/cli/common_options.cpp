#include "tool/cli/common_options.hpp"

#include <algorithm>
#include <thread>

namespace unravel::tool {

namespace {

constexpr const char* cluster_group = "On a cluster";

}  // namespace

void add_output_options(CLI::App& command, OutputOptions& o) {
    command.add_flag("--quiet", o.quiet, "print errors only");
    command.add_flag("--json", o.json, "print the result as JSON");
}

void add_overrides(CLI::App& command, std::vector<std::string>& overrides, const std::string& meaning) {
    command.add_option("--set", overrides, meaning)->allow_extra_args(false);
}

void add_threads(CLI::App& command, int& threads) {
    command.add_option("--threads", threads, "threads of the simulation (default: one per processor)")
        ->check(CLI::Range(1, 1024));
}

int thread_count(int threads) {
    return threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

CLI::Option* add_device(CLI::App& command, std::string& device) {
    return command.add_option("--device", device, "auto, gpu, software or the number of an EGL device")
        ->capture_default_str();
}

CLI::Option* add_submission_options(CLI::App& command, ClusterOptions& o) {
    const auto add = [&](CLI::Option* option) { return option->group(cluster_group); };
    CLI::Option* slurm = add(
        command.add_flag("--slurm", o.submit,
                         "send what is missing to Slurm as an array job, and a job after it that concludes"));
    const auto with = [&](CLI::Option* option) { add(option)->needs(slurm); };
    with(command.add_flag("--wait", o.wait, "show progress until all is done"));
    with(command.add_flag("--dry-run", o.dry_run, "print the job scripts, change nothing"));
    with(command.add_option("--partition", o.partition, "of the cluster"));
    with(command.add_option("--time", o.time, "limit for each task, as sbatch takes it"));
    with(command.add_option("--cpus", o.cpus, "processors for each task")->check(CLI::Range(1, 1024)));
    with(command.add_option("--array-limit", o.array_limit, "tasks at the same time")
             ->check(CLI::Range(1, 1000000)));
    with(
        command.add_option("--sbatch", o.sbatch, "any other option of sbatch: --sbatch=--mem=8G; repeatable")
            ->allow_extra_args(false));
    return slurm;
}

void add_piece_options(CLI::App& command, PieceOptions& o) {
    CLI::Option* slurm = add_submission_options(command, o.cluster);
    CLI::Option* point =
        command.add_option("--point", o.point, "what a task does: this piece only, from 0 on")
            ->check(CLI::Range(0, 1000000))
            ->group(cluster_group);
    CLI::Option* collect =
        command
            .add_flag("--collect", o.collect,
                      "conclude from the pieces that lie there, name those that are missing")
            ->group(cluster_group);
    slurm->excludes(point)->excludes(collect);
    point->excludes(collect);
}

}  // namespace unravel::tool
