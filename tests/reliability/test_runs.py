#!/usr/bin/env python3
"""Nothing is lost: runs of the tool that are stopped in every way a run can be, then gone on with.

    test_runs.py TOOL [NAME ...]      UNRAVEL_KILLS=200 for the long version of the random kills
"""

import contextlib
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from run_files import check_same, check_whole, content, leftovers, video_frames

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE / "tiny.toml"
TOOL = ""
FRAMES = 15  # of tiny.toml
DONE, USAGE, SIMULATION, OUTPUT, INTERRUPTED = 0, 2, 5, 6, 130
PATIENCE = 120  # s, for anything that waits; only ever reached where something hangs


def start(arguments, **options):
    options.setdefault("stdout", subprocess.PIPE)
    options.setdefault("stderr", subprocess.PIPE)
    return subprocess.Popen([TOOL, *map(str, arguments)], **options)


def finish(process, expected):
    out, err = process.communicate(timeout=PATIENCE)
    out, err = (out or b"").decode(), (err or b"").decode()
    assert process.returncode == expected, f"exit {process.returncode}, not {expected}\n{out}{err}"
    return out + err


def run(arguments, expected=DONE, **options):
    return finish(start(arguments, **options), expected)


def job(folder, *more, command="run", scene=SCENE):
    # Drawn by software, so that the pictures are the same wherever this runs; two threads, so that it is quick.
    drawn = ["--device", "software"] if command == "run" else []
    return [command, scene, "-o", folder, "--threads", "2", *drawn, *more]


def wait_for_frames(process, folder, count):
    deadline = time.monotonic() + PATIENCE
    while process.poll() is None and time.monotonic() < deadline:
        if len(list(folder.glob("cache/frame_*.state"))) >= count:
            return
        time.sleep(0.002)


class Reference:
    """The uninterrupted run that every other is compared with, made once."""

    def __init__(self, folder):
        self.folder = folder / "reference"
        begin = time.monotonic()
        run(job(self.folder))
        self.seconds = time.monotonic() - begin
        self.content = content(self.folder)
        assert len([name for name in self.content if name.startswith("cache/")]) == FRAMES
        assert video_frames(self.folder / "textured.mp4") == FRAMES
        assert not leftovers(self.folder)

    def check(self, folder, what, videos=True):
        check_whole(folder)
        assert not leftovers(folder), leftovers(folder)
        expected = self.content
        if not videos:
            expected = {k: v for k, v in expected.items() if not k.startswith("frames/") and not k.endswith(".mp4")}
        check_same(expected, content(folder, videos), what)


def test_signals_finish_the_videos_and_resume_ends_with_the_same_bytes(reference, folder):
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        out = folder / signal.Signals(number).name
        process = start(job(out))
        wait_for_frames(process, out, 4)
        process.send_signal(number)
        finish(process, INTERRUPTED)
        check_whole(out)
        assert not leftovers(out), leftovers(out)
        made = json.loads((out / "run.json").read_text())
        assert made["status"] == "interrupted"
        for style in ("textured", "components"):
            assert video_frames(out / f"{style}.mp4") == len(list(out.glob(f"frames/{style}_*.png")))
        run(job(out, "--resume"))
        reference.check(out, f"after {signal.Signals(number).name}")
        made, whole = (json.loads((f / "run.json").read_text()) for f in (out, reference.folder))
        assert made["status"] == "complete" and made["state_hashes"] == whole["state_hashes"]


def test_an_early_signal_leaves_a_folder_that_resumes(reference, folder):
    out = folder / "early"
    process = start(job(out, command="simulate"))
    deadline = time.monotonic() + PATIENCE
    while not out.exists() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.0005)
    process.send_signal(signal.SIGTERM)
    finish(process, INTERRUPTED)
    run(job(out, "--resume", command="simulate"))
    reference.check(out, "after an early signal", videos=False)


def test_kills_at_random_leave_whole_files_and_resume_ends_with_the_same_bytes(reference, folder):
    kills = int(os.environ.get("UNRAVEL_KILLS", "12"))
    dice = random.Random(20040829)
    done = finished = 0
    while done < kills:
        out = folder / f"killed_{finished}"
        command = "run" if finished % 2 == 0 else "simulate"
        while done < kills:
            # A random number of frames on, then a random moment: spread over the run however loaded the machine is.
            there = len(list(out.glob("cache/frame_*.state")))
            process = start(job(out, *(["--resume"] if out.exists() else []), command=command))
            wait_for_frames(process, out, there + dice.randint(0, 4))
            time.sleep(dice.uniform(0, 0.1 * reference.seconds))
            process.kill()
            process.communicate(timeout=PATIENCE)
            ended = process.returncode != -signal.SIGKILL
            if out.exists():
                check_whole(out)
            if ended:
                assert process.returncode == DONE, process.returncode
                break
            done += 1
        run(job(out, *(["--resume"] if out.exists() else []), command=command))
        reference.check(out, f"after {done} kills", videos=command == "run")
        finished += 1
        shutil.rmtree(out)
    print(f"    {done} kills over {finished} runs, nothing lost", flush=True)


@contextlib.contextmanager
def small_disk(folder, size):
    """A file system of its own where the tests may mount one; yields None elsewhere."""
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True, check=False).returncode != 0:
        yield None
        return
    try:
        yield lambda new: subprocess.run(
            ["mount", "-o", f"remount,size={new}", str(folder)], check=True, capture_output=True)
    finally:
        subprocess.run(["umount", str(folder)], check=False, capture_output=True)


def test_a_full_disk_stops_the_run_and_room_lets_it_go_on(reference, folder):
    place = folder / "disk"
    with small_disk(place, "160k") as grow:
        if grow is None:
            print("    no disk of its own here: only the limit on a file's size is tested", flush=True)
            return
        out = place / "out"
        text = run(job(out), OUTPUT)
        assert "No space left" in text, text
        assert 0 < len(list(out.glob("cache/*.state"))) < FRAMES, "the disk was not full in the middle of the run"
        check_whole(out)
        assert not leftovers(out), leftovers(out)
        grow("64m")
        run(job(out, "--resume"))
        reference.check(out, "after a full disk")


def test_a_file_that_cannot_grow_stops_the_run(reference, folder):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (6000, resource.RLIM_INFINITY))

    out = folder / "limited"
    text = run(job(out), OUTPUT, preexec_fn=limit)
    assert "can't write" in text, text
    check_whole(out)
    assert not leftovers(out), leftovers(out)
    run(job(out, "--resume"))
    reference.check(out, "after a limit on file sizes")


def test_a_folder_that_cannot_be_made_is_named(reference, folder):
    blocked = folder / "a_file"
    blocked.write_text("not a folder\n")
    text = run(job(blocked / "out"), OUTPUT)
    assert str(blocked) in text, text
    assert blocked.read_text() == "not a folder\n"
    # A folder where a file of the run belongs.
    out = folder / "taken"
    (out / "stats.csv").mkdir(parents=True)
    assert "stats.csv" in run(job(out, command="simulate"), OUTPUT)


def closed_pipe():
    reading, writing = os.pipe()
    os.close(reading)
    return os.fdopen(writing, "wb")


def test_closed_pipes_lose_nothing(reference, folder):
    out = folder / "stdout"
    with closed_pipe() as pipe:
        run(job(out, "--json"), OUTPUT, stdout=pipe)
    reference.check(out, "with a closed standard output")
    # Progress is a courtesy: nobody listening is no reason to stop.
    out = folder / "stderr"
    with closed_pipe() as pipe:
        run(job(out), DONE, stderr=pipe)
    reference.check(out, "with a closed standard error")
    # An error that nobody can read still has its exit code.
    with closed_pipe() as pipe:
        run(job(out), USAGE, stderr=pipe)


def test_a_changed_scene_is_refused_with_what_changed(reference, folder):
    out = folder / "changed"
    shutil.copytree(reference.folder, out)
    text = run(job(out, "--resume", "--set", "cloth.density=0.3"), USAGE)
    assert "density = 0.2" in text and "density = 0.3" in text, text
    text = run(job(out, "--resume", "--set", "gravity=[0,-1.6,0]"), USAGE)
    assert "gravity" in text and "nothing" not in text, text
    text = run(job(out), USAGE)
    assert "--resume" in text and "--force" in text, text
    reference.check(out, "refused runs")


def test_a_complete_run_resumed_stays_as_it_is(reference, folder):
    out = folder / "complete"
    shutil.copytree(reference.folder, out)
    before = {file: file.stat().st_mtime_ns for part in ("cache", "frames") for file in (out / part).glob("*.*")}
    run(job(out, "--resume"))
    reference.check(out, "resumed when complete")
    after = {file: file.stat().st_mtime_ns for file in before}
    assert before == after, "frames and states that were there were written again"


def test_damaged_states_are_simulated_again(reference, folder):
    out = folder / "damaged"
    shutil.copytree(reference.folder, out)
    damaged = bytearray((out / "cache/frame_0006.state").read_bytes())
    damaged[len(damaged) // 2] ^= 1
    (out / "cache/frame_0006.state").write_bytes(damaged)
    (out / "cache/frame_0009.state").write_bytes(b"")
    (out / "frames/textured_0003.png").write_bytes((out / "frames/textured_0003.png").read_bytes()[:-20])
    (out / "stats.csv").write_text("nonsense\n")
    run(job(out, "--resume"))
    reference.check(out, "after damage")


def test_pictures_of_another_look_are_not_taken_for_this_one(reference, folder):
    look = ["--set", 'look.background="#203040"', "--size", "80x64"]
    fresh, out = folder / "fresh_look", folder / "other_look"
    run(job(fresh, *look))
    shutil.copytree(reference.folder, out)
    run(job(out, "--resume", *look))
    check_same(content(fresh), content(out), "a resumed run with another look")


def test_a_longer_clip_goes_on_from_a_shorter_one(reference, folder):
    out = folder / "longer"
    run(job(out, "--set", "clip.duration=0.2"))
    run(job(out, "--resume"))
    reference.check(out, "made longer")


def test_two_runs_do_not_share_a_folder(reference, folder):
    out = folder / "shared"
    first = start(job(out, "--set", "clip.duration=40", command="simulate"))
    wait_for_frames(first, out, 2)
    text = run(job(out, "--resume", "--set", "clip.duration=40", command="simulate"), USAGE)
    assert "another" in text, text
    first.send_signal(signal.SIGINT)
    finish(first, INTERRUPTED)


def test_a_run_that_cannot_go_on_keeps_its_frames_and_says_why(reference, folder):
    out = folder / "unstable"
    text = run(job(out, "--size", "64x48", scene=HERE.parents[1] / "scenes/hard/torn.toml"), SIMULATION)
    made = json.loads((out / "failure/failure.json").read_text())
    assert made["criterion"] == "strain" and made["value"] > made["limit"], made
    assert f"step {made['step']}" in text and made["advice"] in text, text
    assert made["particles"] and made["spring"]["rest"] > 0
    check_whole(out)
    records = len(list(out.glob("cache/*.state")))
    assert records > 1 and (out / "failure/last_good.state").exists()
    assert (out / "failure/scene.toml").read_bytes() == (out / "scene.toml").read_bytes()
    assert video_frames(out / "textured.mp4") == records == len(list(out.glob("frames/textured_*.png")))
    assert (out / "failure/worst.png").exists()
    assert json.loads((out / "run.json").read_text())["status"] == "failed"
    first = content(out)
    run(job(out, "--resume", "--size", "64x48", scene=HERE.parents[1] / "scenes/hard/torn.toml"), SIMULATION)
    check_same(first, content(out), "a failed run resumed")


def main():
    global TOOL
    TOOL = os.path.abspath(sys.argv[1])
    tests = [(n, f) for n, f in globals().items() if n.startswith("test_")]
    if sys.argv[2:]:
        tests = [(n, f) for n, f in tests if any(part in n for part in sys.argv[2:])]
    failed = 0
    with tempfile.TemporaryDirectory(prefix="unravel-runs-") as temporary:
        folder = pathlib.Path(temporary)
        reference = Reference(folder)
        for name, test in tests:
            place = folder / name
            place.mkdir()
            begin = time.monotonic()
            try:
                test(reference, place)
                verdict = "ok"
            except (AssertionError, subprocess.TimeoutExpired, OSError, KeyError, ValueError) as error:
                failed += 1
                verdict = f"FAILED: {type(error).__name__} {error}"
            print(f"{name[5:].replace('_', ' ')}: {verdict} ({time.monotonic() - begin:.1f} s)", flush=True)
            shutil.rmtree(place, ignore_errors=True)
    return 1 if failed or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
