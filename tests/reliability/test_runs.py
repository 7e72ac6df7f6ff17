#!/usr/bin/env python3
"""Nothing is lost: runs of the tool that are stopped in every way a run can be, then gone on with.

    test_runs.py TOOL [NAME ...]      UNRAVEL_KILLS=200 for the long version of the random kills,
                                      UNRAVEL_FRAMES=2000 for that of the memory test
"""

import contextlib
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

from run_files import check_same, check_whole, content, leftovers, video_frames

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE / "tiny.toml"
TOOL = ""
FRAMES = 15  # of tiny.toml
DONE, USAGE, SCENE_ERROR, NO_ENCODER, SIMULATION, OUTPUT, INTERRUPTED = 0, 2, 3, 4, 5, 6, 130
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


def test_a_folder_that_cannot_be_written_is_named(reference, folder):
    place = folder / "disk"
    with small_disk(place, "1m") as remount:
        if remount is None:
            return
        out = place / "out"
        run(job(out, "--set", "clip.duration=0.2"))
        kept = content(out)
        subprocess.run(["mount", "-o", "remount,ro", str(place)], check=True, capture_output=True)
        text = run(job(out, "--resume"), OUTPUT)
        assert "Read-only" in text and str(place) in text, text
        assert "Read-only" in run(job(place / "new"), OUTPUT)
        check_same(kept, content(out), "a folder that turned read-only")


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


def test_broken_caches_are_named_where_only_they_tell(reference, folder):
    def broken(name, break_it):
        out = folder / name
        shutil.copytree(reference.folder, out)
        break_it(out)
        for command in (["render", out, "--device", "software"], ["inspect", out, "--frame", "7", "--device", "software"]):
            text = finish(start(command), OUTPUT)
            assert "frame_0006.state" in text or "frame_0007.state" in text, text
        shutil.rmtree(out)

    def replace(data, number=None):
        def break_it(out):
            for k in (6, 7) if number is None else (number,):
                file = out / f"cache/frame_{k:04d}.state"
                file.write_bytes(data(file.read_bytes()))
        return break_it

    broken("empty", replace(lambda data: b""))
    broken("cut", replace(lambda data: data[: len(data) // 2]))
    broken("flipped", replace(lambda data: data[:200] + bytes([data[200] ^ 4]) + data[201:]))
    broken("nonsense", replace(lambda data: b"nonsense" * 1000))
    broken("longer", replace(lambda data: data + b"more"))
    broken("foreign", replace(lambda data: data[:8] + struct.pack("<Q", 1) + data[16:]))

    def folder_in_its_place(out):
        for k in (6, 7):
            (out / f"cache/frame_{k:04d}.state").unlink()
            (out / f"cache/frame_{k:04d}.state").mkdir()

    broken("a_folder", folder_in_its_place)


# What a hand can mistype or a program can get wrong: the command line, its exit code, a part of the message.
COMMAND_LINES = [
    ([], USAGE, "subcommand"),
    (["bogus"], USAGE, "subcommand"),
    (["run"], USAGE, "SCENE"),
    (["run", "no_such.toml"], OUTPUT, "no_such.toml can't be read: No such file"),
    (["run", "."], OUTPUT, "Is a directory"),
    (["run", "/dev/null"], SCENE_ERROR, "cloth"),
    (["run", "/dev/zero"], SCENE_ERROR, "/dev/zero"),
    (["run", "/proc/self/mem"], OUTPUT, "can't be read"),
    (["check", "{scene}", "--set"], USAGE, "--set"),
    (["check", "{scene}", "--set", "x"], SCENE_ERROR, "x"),
    (["check", "{scene}", "--set", "cloth.densty=1"], SCENE_ERROR, "density"),
    (["check", "{scene}", "--set", "cloth.density=nan"], SCENE_ERROR, "density"),
    (["check", "{scene}", "--set", "cloth.density=1e999"], SCENE_ERROR, "density"),
    (["check", "{scene}", "--set", "gravity=[0,-inf,0]"], SCENE_ERROR, "gravity"),
    (["check", "{scene}", "--set", "cloth.particles=[99999999,99999999]"], SCENE_ERROR, "particles"),
    (["check", "{scene}", "--set", "clip.duration=1e30"], SCENE_ERROR, "duration"),
    (["run", "{scene}", "--threads", "0"], USAGE, "--threads"),
    (["run", "{scene}", "--threads", "99999999999999999999"], USAGE, "--threads"),
    (["run", "{scene}", "--frames", "9-2"], USAGE, "--frames"),
    (["run", "{scene}", "--frames", "0-99999999999999999999"], USAGE, "--frames"),
    (["run", "{scene}", "--size", "big"], USAGE, "--size"),
    (["run", "{scene}", "--size", "1x1"], USAGE, "1 × 1"),
    (["run", "{scene}", "--size", "65x64"], USAGE, "even"),
    (["run", "{scene}", "--video", "avi"], USAGE, "avi"),
    (["run", "{scene}", "--video", "mp4", "--transparent"], USAGE, ".mkv"),
    (["run", "{scene}", "--codec", "nosuch"], NO_ENCODER, "nosuch"),
    (["run", "{scene}", "--samples", "-1"], USAGE, "--samples"),
    (["run", "{scene}", "--device", "moon"], USAGE, "moon"),
    (["run", "{scene}", "--device", "99"], NO_ENCODER, "99"),
    (["run", "{scene}", "--style", "neon"], USAGE, "--style"),
    (["run", "{scene}", "--camera", "nobody"], USAGE, "--camera"),
    (["run", "{scene}", "--crf", "99"], USAGE, "--crf"),
    (["run", "{scene}", "--no-such-option"], USAGE, "--no-such-option"),
    (["run", "{scene}", "--resume", "--force"], None, ""),
    (["render", "no_such_run"], USAGE, "no_such_run"),
    (["render", "{here}"], USAGE, "holds no run"),
    (["inspect", "{run}", "--frame", "0"], USAGE, "--frame"),
    (["inspect", "{run}", "--frame", "99999"], USAGE, "99999"),
    (["inspect", "{run}", "--frame", "3", "--particle", "99999999"], USAGE, "--particle"),
    (["inspect", "{run}", "--frame", "3", "--step", "77"], USAGE, "--step"),
    (["stability", "no_such_case"], USAGE, "cases.toml"),
    (["stability", "--scenes", "no_such_folder"], OUTPUT, "no_such_folder"),
    (["accuracy", "{scene}", "--budget", "-1"], USAGE, "--budget"),
    (["schema", "nothing"], USAGE, "nothing"),
]


def test_broken_command_lines_end_in_a_message_and_their_exit_code(reference, folder):
    names = {"{scene}": str(SCENE), "{run}": str(reference.folder), "{here}": str(folder)}
    for line, code, says in COMMAND_LINES:
        process = start([names.get(word, word) for word in line], cwd=folder if "stability" not in line else HERE.parents[1])
        out, err = process.communicate(timeout=PATIENCE)
        text = (out + err).decode()
        if code is None:
            assert process.returncode in (DONE, USAGE), f"{line}: exit {process.returncode}\n{text}"
            continue
        assert process.returncode == code, f"{line}: exit {process.returncode}, not {code}\n{text}"
        assert says in text, f"{line}: nothing about '{says}'\n{text}"
    reference.check(reference.folder, "a run that broken command lines named")


def resident(process):
    """Memory that a process holds [MiB], or None once it has ended."""
    try:
        for line in open(f"/proc/{process.pid}/status", encoding="ascii"):
            if line.startswith("VmRSS:"):
                return int(line.split()[1]) / 1024
    except OSError:
        pass
    return None


def test_memory_stays_flat(reference, folder):
    frames = int(os.environ.get("UNRAVEL_FRAMES", "100"))
    out = folder / "long"
    process = start(job(out, "--quiet", "--set", f"clip.duration={frames / 25}", "--size", "160x120"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    held = []  # at a quarter of the frames, half, three quarters
    for share in (0.25, 0.5, 0.75, 0.97):
        wait_for_frames(process, out, int(share * frames))
        held.append(resident(process))
    assert process.wait(timeout=PATIENCE) == DONE
    assert None not in held, "it had ended before it was looked at"
    print(f"    {frames} frames, MiB at a quarter, half, three quarters, the end: "
          + ", ".join(f"{m:.1f}" for m in held), flush=True)
    # A report row, a hash and an inspector's line per frame are kept: some kB. A texture would be 75 kB.
    grown = 1024 * (held[-1] - held[0]) / (0.72 * frames)
    assert held[-1] - held[0] < max(8, 0.016 * frames), f"{grown:.0f} kB a frame"


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
