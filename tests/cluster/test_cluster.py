#!/usr/bin/env python3
"""On a cluster as on one machine: the same bytes, whatever is killed on the way.

    test_cluster.py TOOL [NAME ...]      Runs on a Slurm cluster of its own on the loopback; skipped where there is none.
"""

import csv
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "reliability"))

import loopback  # noqa: E402
from run_files import check_same, check_whole, content, leftovers, video_frames  # noqa: E402

TINY = HERE.parent / "reliability/tiny.toml"
TOOL = ""
PATIENCE = 240  # s, for anything that waits; only ever reached where something hangs
DONE, USAGE, SIMULATION = 0, 2, 5
SKIPPED = 77
SOFTWARE = ["--device", "software"]


class Cluster:
    def __init__(self, environment):
        self.environment = environment

    def ask(self, *words):
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True, check=False, timeout=PATIENCE)
        return done.stdout

    def tool(self, words, expected=DONE, place=None):
        done = subprocess.run([TOOL, *map(str, words)], env=self.environment, capture_output=True, text=True,
                              check=False, timeout=PATIENCE, cwd=place)
        text = done.stdout + done.stderr
        assert done.returncode == expected, f"exit {done.returncode}, not {expected}\n{text}"
        return text

    def hurry(self):
        """A task that goes back into the queue waits there for two minutes; a test need not."""
        for line in self.ask("squeue", "--noheader", "--array", "--format=%i|%r").splitlines():
            job, reason = line.split("|")
            if reason == "BeginTime":
                self.ask("scontrol", "update", f"jobid={job}", "StartTime=now")

    def wait(self):
        deadline = time.monotonic() + PATIENCE
        while self.ask("squeue", "--noheader").strip():
            assert time.monotonic() < deadline, self.ask("squeue")
            self.hurry()
            time.sleep(0.3)

    def restarts(self, job):
        return [int(n) for n in re.findall(r"Restarts=(\d+)", self.ask("scontrol", "show", "job", "-o", job))]


def jobs_in(text):
    return re.findall(r"^job (\d+)", text, re.MULTILINE)


def processes(*words):
    """Numbers of the processes whose command line holds all these words, one after another."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                line = (entry / "cmdline").read_bytes().decode(errors="replace").split("\0")
            except OSError:
                continue
            if line[0] == TOOL and " ".join(map(str, words)) in " ".join(line):
                found.append(int(entry.name))
    return found


def make_scenes(folder, count, particles):
    text = TINY.read_text().replace("[11, 11]", f"[{particles}, {particles}]")
    scenes = []
    for k in range(count):
        scenes.append(folder / f"clip_{k}.toml")
        scenes[-1].write_text(text.replace("density = 0.2", f"density = {0.2 + 0.02 * k:g}"))
    return scenes


def test_clips_killed_on_the_way_are_as_on_one_machine(cluster, folder):
    scenes = make_scenes(folder, 4, 31)
    here, there = folder / "here", folder / "there"
    look = [*SOFTWARE, "--size", "96x64", "--frames", "0-12"]  # other than the scene says
    cluster.tool(["run", *scenes, *look, "-o", here])
    sent = cluster.tool(["run", *scenes, *look, "-o", there, "--slurm", "--cpus", "1", "--time", "10"])
    job = jobs_in(sent)[0]
    killed = 0
    deadline = time.monotonic() + PATIENCE
    while killed < 2 and cluster.ask("squeue", "--noheader").strip() and time.monotonic() < deadline:
        for k in range(4):
            states = len(list(there.glob(f"clip_{k}/cache/*.state")))
            # One by the system's hand, one by Slurm's: both go back into the queue.
            if k == killed and states >= 3:
                for process in processes("--point", k):
                    if killed == 0:
                        os.kill(process, signal.SIGKILL)
                    else:
                        cluster.ask("scancel", f"{job}_{k}")
                    killed += 1
                    break
        time.sleep(0.05)
    assert killed == 2, "the clips were done before they could be killed: make them longer"
    cluster.wait()
    assert sum(cluster.restarts(job)) >= 2, "the killed tasks were not queued again"
    log = (there / "slurm/run_collect.log").read_text()
    assert "4 of 4 clips are complete" in log, log
    for scene in scenes:
        check_whole(there / scene.stem)
        check_same(content(here / scene.stem), content(there / scene.stem), f"{scene.stem} on the cluster")
        assert not leftovers(there / scene.stem)
    # All is there: nothing but the conclusion is sent.
    again = cluster.tool(["run", *scenes, *look, "-o", there, "--slurm", "--wait"])
    assert "task" not in again.split("slurm\n")[0] and "4 of 4" in again, again


def test_a_scene_that_fails_is_named_and_the_others_are_kept(cluster, folder):
    shutil.copy(HERE.parents[1] / "scenes/hard/torn.toml", folder)
    scenes = [*make_scenes(folder, 1, 11), folder / "torn.toml"]
    text = cluster.tool(["run", *scenes, *SOFTWARE, "--size", "64x48", "-o", folder / "out", "--slurm", "--wait"],
                        SIMULATION)
    assert re.search(r"torn +MISSING: .*step", text) and "1 of 2 clips" in text, text
    check_whole(folder / "out/clip_0")
    assert video_frames(folder / "out/clip_0/textured.mp4") == 15


def test_a_render_in_eight_ranges_is_as_in_one(cluster, folder):
    (scene,) = make_scenes(folder, 1, 11)
    run = folder / "run"
    cluster.tool(["run", scene, *SOFTWARE, "-o", run])
    look = [*SOFTWARE, "--size", "128x96", "--set", 'look.background="#203040"']
    whole, ranges = folder / "whole", folder / "ranges"
    cluster.tool(["render", run, "-o", whole, *look])
    work = ["render", run, "-o", ranges, *look, "--parts", "8", "--slurm"]
    sent = cluster.tool([*work, "--array-limit", "1"])
    job = jobs_in(sent)[0]
    assert "render, 8 tasks" in sent, sent
    cluster.ask("scancel", f"{job}_6")
    assert "scancel" in cluster.tool(work, USAGE), "the work was sent twice"
    cluster.wait()
    log = (ranges / "slurm/render_collect.log").read_text()
    assert "frames 11-12: was not done" in log and log.count("frames ") == 2, log
    assert not list(ranges.glob("*.mp4")), "a video with a hole was made"
    again = cluster.tool([*work, "--wait"])
    assert "render, 1 task\n" in again, again
    for name in [f"{style}_{k:04}.png" for style in ("textured", "components") for k in range(15)]:
        assert (whole / "frames" / name).read_bytes() == (ranges / "frames" / name).read_bytes(), name
    for style in ("textured", "components"):
        assert (whole / f"{style}.mp4").read_bytes() == (ranges / f"{style}.mp4").read_bytes(), f"{style}.mp4"
    check_whole(ranges / "frames")
    assert not leftovers(ranges) and (ranges / "report.html").exists()
    # Another look takes nothing over from this one.
    other = [*SOFTWARE, "--size", "64x48"]
    cluster.tool(["render", run, "-o", whole, *other])
    assert "render, 8 tasks" in cluster.tool(["render", run, "-o", ranges, *other, "--parts", "8", "--slurm", "--wait"])
    assert (whole / "textured.mp4").read_bytes() == (ranges / "textured.mp4").read_bytes()


def study(file):
    cases = json.loads(file.read_text())["cases"]
    return [{k: v for k, v in case.items() if k != "seconds"} for case in cases]


def test_hard_cases_are_as_on_one_machine_and_a_failed_one_is_named(cluster, folder):
    cases = ["one_particle", "ribbon", "coincident", "inside"]
    cluster.tool(["stability", *cases, *SOFTWARE, "-o", folder / "here"], place=HERE.parents[1])
    expected = study(folder / "here/stability.json")
    there = folder / "there"
    blocked = there / f"points/{expected[0]['name']}.json"
    blocked.mkdir(parents=True)
    work = ["stability", *cases, *SOFTWARE, "-o", there, "--slurm", "--wait"]
    text = cluster.tool(work, SIMULATION, place=HERE.parents[1])
    assert f"{expected[0]['name']}: can't write" in text, text
    assert study(there / "stability.json") == expected[1:], "the rest was not kept"
    blocked.rmdir()
    text = cluster.tool(work, place=HERE.parents[1])
    assert "stability, 1 task\n" in text, text
    assert study(there / "stability.json") == expected
    for case in expected:
        if case["picture"]:
            assert (folder / "here" / case["picture"]).read_bytes() == (there / case["picture"]).read_bytes()


def accuracy_rows(file):
    times = ("seconds", "runs", "node", "processor")
    with open(file, newline="") as lines:
        return [{k: v for k, v in row.items() if not any(part in k for part in times)} for row in csv.DictReader(lines)]


def test_points_of_an_accuracy_study_are_as_on_one_machine(cluster, folder):
    (scene,) = make_scenes(folder, 1, 11)
    here, there = folder / "here", folder / "there"
    cluster.tool(["accuracy", scene, "-o", here, "--budget", os.environ.get("UNRAVEL_BUDGET", "0.3")])
    there.mkdir()
    for name in ("scene.toml", "reference.bin"):
        shutil.copy(here / name, there)
    # A few of its points, by the script that --dry-run prints.
    work = ["accuracy", scene, "-o", there]
    scripts = cluster.tool([*work, "--slurm", "--dry-run"]).split("# ---- ")[1:]
    assert [script.split("\n")[0].split("/")[-1] for script in scripts] == ["accuracy.sh", "accuracy_collect.sh"]
    assert not (there / "slurm").exists(), "--dry-run changed something"
    (there / "slurm").mkdir()
    script = folder / "points.sh"
    script.write_text(scripts[0].split("\n", 1)[1])
    # Long implicit steps, which no study leaves out.
    cluster.ask("sbatch", "--array=10-12", str(script))
    cluster.wait()
    text = cluster.tool([*work, "--collect"], SIMULATION)
    assert "points are missing" in text and "was not done" in text, text
    rows = accuracy_rows(there / "accuracy.csv")
    assert len(rows) == 3 and all(row in accuracy_rows(here / "accuracy.csv") for row in rows), rows
    # Times of two processors make no front.
    points = sorted((there / "points").glob("*.csv"))
    lines = points[0].read_text().splitlines()
    with open(points[0], newline="") as file:
        processor = next(csv.DictReader(file))["processor"]
    points[0].write_text("\n".join(line.replace(processor, "Another Processor") for line in lines) + "\n")
    (there / "accuracy.csv").unlink()
    text = cluster.tool([*work, "--collect"], SIMULATION)
    assert "1 of 3 points" in text and "'Another Processor'" in text, text
    with open(there / "accuracy.csv", newline="") as file:
        assert {row["processor"] for row in csv.DictReader(file)} == {processor, "Another Processor"}


def test_a_bench_has_one_node_for_itself(cluster, folder):
    (scene,) = make_scenes(folder, 1, 11)
    work = ["bench", "--frames", scene, *SOFTWARE, "--slurm"]
    script = cluster.tool([*work, "--dry-run"], place=folder)
    assert script.count("# ---- ") == 1 and "#SBATCH --exclusive\n" in script and "--array" not in script, script
    text = cluster.tool([*work, "--wait"], place=folder)
    assert len(jobs_in(text)) == 1 and "ms" in text.split("slurm\n", 1)[1], text


def test_dry_runs_print_scripts_that_a_shell_reads(cluster, folder):
    (scene,) = make_scenes(folder, 1, 11)
    scene = scene.rename(folder / "it's a scene.toml")
    text = cluster.tool(["run", scene, TINY, "--slurm", "--dry-run", "--partition", "long", "--time", "2:00:00",
                         "--cpus", "4", "--array-limit", "8", "--sbatch=--mem=8G"], place=folder)
    for line in ("--partition=long", "--time=2:00:00", "--cpus-per-task=4", "--array=0-1%8", "--mem=8G"):
        assert f"#SBATCH {line}\n" in text, text
    subprocess.run(["bash", "-n"], input=text, text=True, check=True)
    assert not (folder / "output").exists(), "--dry-run changed something"


def main():
    global TOOL
    TOOL = os.path.realpath(sys.argv[1])
    if loopback.missing():
        print(f"SKIPPED: needs {' '.join(loopback.missing())} (apt-get install --no-install-recommends ...)", flush=True)
        return SKIPPED
    tests = [(n, f) for n, f in globals().items() if n.startswith("test_")]
    if sys.argv[2:]:
        tests = [(n, f) for n, f in tests if any(part in n for part in sys.argv[2:])]
    failed = 0
    with tempfile.TemporaryDirectory(prefix="unravel-cluster-") as temporary:
        place = pathlib.Path(temporary)
        (place / "slurm").mkdir()
        with loopback.cluster(place / "slurm") as environment:
            for name, test in tests:
                folder = place / name
                folder.mkdir()
                begin = time.monotonic()
                try:
                    test(Cluster(environment), folder)
                    verdict = "ok"
                except (AssertionError, subprocess.SubprocessError, OSError, KeyError, ValueError) as error:
                    failed += 1
                    verdict = f"FAILED: {type(error).__name__} {error}"
                print(f"{name[5:].replace('_', ' ')}: {verdict} ({time.monotonic() - begin:.1f} s)", flush=True)
                subprocess.run(["scancel", "--me"], env=environment, check=False, capture_output=True)
    return 1 if failed or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
