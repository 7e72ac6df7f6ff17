#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "base/whole_file.hpp"
#include "tests/base/temporary_folder.hpp"
#include "tool/cli/frame_ranges.hpp"
#include "tool/cluster/cluster.hpp"
#include "tool/cluster/job_script.hpp"
#include "tool/study/accuracy/accuracy_verdict.hpp"
#include "tool/study/stability/stability_points.hpp"

using namespace unravel;
using namespace unravel::tool;
namespace fs = std::filesystem;

TEST_CASE("indices are written as sbatch takes them", "[cluster]") {
    CHECK(index_ranges({}).empty());
    CHECK(index_ranges({4}) == "4");
    CHECK(index_ranges({0, 1, 2, 3}) == "0-3");
    CHECK(index_ranges({0, 2, 3, 7, 9, 10}) == "0,2-3,7,9-10");
}

TEST_CASE("quoted words are single words to a shell", "[cluster]") {
    CHECK(shell_quoted(std::string("scenes/a.toml")) == "scenes/a.toml");
    CHECK(shell_quoted(std::string("")) == "''");
    CHECK(shell_quoted(std::string("a b")) == "'a b'");
    CHECK(shell_quoted(std::string("it's $HOME")) == "'it'\\''s $HOME'");
    CHECK(shell_quoted(std::vector<std::string>{"--set", "look.background=\"#fff\""}) ==
          "--set 'look.background=\"#fff\"'");
}

TEST_CASE("words about the cluster go, with their values, however they are written", "[cluster]") {
    const std::vector<std::string> words{
        "run",    "a.toml", "--slurm",           "--time",     "2:00",  "--cpus=4",
        "--size", "64x48",  "--sbatch=--mem=8G", "--timeless", "--wait"};
    CHECK(piece_words(words) == std::vector<std::string>{"run", "a.toml", "--size", "64x48", "--timeless"});
    CHECK(words_without({"-o", "x", "-oy", "z"}, {}, {"-o"}) == std::vector<std::string>{"z"});
}

TEST_CASE("ranges hold every frame once, in order, and are alike in length", "[cluster]") {
    for (const int parts : {0, 1, 2, 7, 8, 64, 1000}) {
        for (const int frames : {1, 2, 15, 90, 5000}) {
            const std::vector<FrameRange> ranges = cut_frames(3, 2 + frames, parts);
            REQUIRE(!ranges.empty());
            if (parts > 0) CHECK(ranges.size() == static_cast<std::size_t>(std::min(parts, frames)));
            int next = 3, shortest = frames, longest = 0;
            for (const FrameRange& range : ranges) {
                CHECK(range.first == next);
                next = range.last + 1;
                shortest = std::min(shortest, next - range.first);
                longest = std::max(longest, next - range.first);
            }
            CHECK(next == 3 + frames);
            CHECK(longest - shortest <= 1);
        }
    }
}

TEST_CASE("a job script says what its options ask for, and no more", "[cluster]") {
    ClusterOptions options;
    const JobScript one{"render_collect", "Puts it together.", "render output/a --collect", {}, false};
    const std::string plain = job_script_text(one, "/shared/unravel", "/shared/output/a", "/shared", options);
    CHECK(plain.starts_with("#!/bin/bash\n"));
    for (const char* absent : {"--array=", "--partition", "--time", "--cpus-per-task", "--exclusive"})
        CHECK(plain.find(absent) == plain.npos);
    options.partition = "long";
    options.time = "1-00";
    options.cpus = 3;
    options.array_limit = 5;
    options.sbatch = {"--mem=8G"};
    const JobScript many{
        "accuracy", "Points.", "accuracy a.toml --point \"$SLURM_ARRAY_TASK_ID\"", {0, 1, 4}, true};
    const std::string full =
        job_script_text(many, "/shared/my unravel", "/shared/output/a", "/shared", options);
    for (const char* present :
         {"#SBATCH --array=0-1,4%5\n", "#SBATCH --partition=long\n", "#SBATCH --time=1-00\n",
          "#SBATCH --cpus-per-task=3\n", "#SBATCH --exclusive\n", "#SBATCH --mem=8G\n",
          "#SBATCH --output=/shared/output/a/slurm/accuracy_%a.log\n",
          "'/shared/my unravel' accuracy a.toml --point"})
        CHECK(full.find(present) != full.npos);
}

TEST_CASE("what collects comes after tasks that were killed and queued again", "[cluster]") {
    const TemporaryFolder folder;
    JobScript script{"run_collect", "", "run --collect", {}, false, true};
    // Commands that say that they were called; squeue has a task of job 12 until the file `queued` is gone.
    const auto command = [&](const char* name, const std::string& text) {
        write_whole_file(folder / name, "#!/bin/sh\n" + text + "\n");
        fs::permissions(folder / name, fs::perms::owner_all);
    };
    command("squeue", "[ \"$2\" = --jobs=12 ] && cat '" + (folder / "queued").string() + "' 2>/dev/null");
    command("scontrol", "echo \"$@\" >> '" + (folder / "called").string() + "'");
    command("tool", "echo tool \"$@\" >> '" + (folder / "called").string() + "'");
    write_whole_file(folder / "collect.sh",
                     job_script_text(script, folder / "tool", folder / "out", folder / ".", {}));
    const auto run = [&](const std::string& argument) {
        fs::remove(folder / "called");
        const std::string line = "PATH='" + (folder / ".").string() + "':\"$PATH\" SLURM_JOB_ID=13 bash '" +
                                 (folder / "collect.sh").string() + "' " + argument;
        CHECK(std::system(line.c_str()) == 0);
        return read_whole_text(folder / "called", 1 << 10);
    };
    write_whole_file(folder / "queued", "12_1 COMPLETING\n");
    CHECK(run("12") == "requeue 13\n");
    CHECK(run("") == "tool run --collect\n");  // by hand
    fs::remove(folder / "queued");
    CHECK(run("12") == "tool run --collect\n");
}

TEST_CASE("a missing piece is explained by what its task said last", "[cluster]") {
    const TemporaryFolder folder;
    CHECK(why_missing(folder / "out", "run", 3) == "was not done");
    std::filesystem::create_directories(job_folder(folder / "out"));
    const std::filesystem::path log = job_log(folder / "out", "run", 3);
    write_whole_file(log, "");
    CHECK(why_missing(folder / "out", "run", 3).starts_with("was killed"));
    write_whole_file(log, "a: frame 1 of 9\nunravel: the disk is full\nslurmstepd: something\n");
    CHECK(why_missing(folder / "out", "run", 3).starts_with("the disk is full ("));
}

TEST_CASE("times of different processors make no front", "[cluster][accuracy]") {
    std::vector<AccuracyPoint> points(4);
    for (std::size_t k = 0; k < points.size(); ++k) {
        points[k].setting.steps_per_frame = 1 << k;
        points[k].seconds = {1.0};
        points[k].node = "n" + std::to_string(k);
        points[k].processor = k == 1 ? "slow" : "quick";
    }
    points[3].broke = true;
    points[3].processor = "slow";
    std::vector<AccuracyPoint> kept = points;
    const std::string said = leave_out_other_processors(kept);
    CHECK(kept.size() == 3);  // a broken one has no time to be compared
    CHECK(said.find("1 of 4") != said.npos);
    CHECK(said.find("'slow': n1") != said.npos);
    points[1].processor = "quick";
    CHECK(leave_out_other_processors(points).empty());
    CHECK(points.size() == 4);
}

TEST_CASE("a hard case done apart comes back as it was, and only for the scene it was made from",
          "[cluster][stability]") {
    const TemporaryFolder folder;
    HardLine line;
    line.hard.name = "case";
    line.hard.what = "a case";
    line.hard.scene = folder / "case.toml";
    write_whole_file(line.hard.scene, "a scene\n");
    line.outcome.steps = 12;
    line.outcome.max_strain = 0.1 + 0.2;
    line.outcome.energy_rise = std::numeric_limits<double>::infinity();
    line.outcome.hash = 0xfedcba9876543210u;
    line.outcome.failures = {"energy rose"};
    write_hard_line(folder / "out", line, false);
    const auto back = read_hard_line(folder / "out", line.hard, false);
    REQUIRE(back);
    CHECK(stability_json(*back) == stability_json(line));
    CHECK(back->outcome.energy_rise == line.outcome.energy_rise);
    CHECK(back->outcome.kind == line.outcome.kind);
    CHECK_FALSE(read_hard_line(folder / "out", line.hard, true));
    HardCase other = line.hard;
    other.strain *= 2;
    CHECK_FALSE(read_hard_line(folder / "out", other, false));
    write_whole_file(line.hard.scene, "another scene\n");
    CHECK_FALSE(read_hard_line(folder / "out", line.hard, false));
}
