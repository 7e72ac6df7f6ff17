"""Runs that are stopped: by signals, by kills at random moments, by each other, by their own failure."""

import json
import os
import signal
import time

from kills import kill_at_random
from run_files import check_same, check_whole, content, leftovers, video_frames
from tool_runs import (DONE, HERE, PATIENCE, SIMULATION, USAGE, finish, job, run, start, stopped_by,
                       wait_for_frames)


def test_signals_finish_the_videos_and_resume_ends_with_the_same_bytes(reference, folder):
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        out = folder / signal.Signals(number).name
        process = start(job(out))
        wait_for_frames(process, out, 4)
        process.send_signal(number)
        finish(process, stopped_by(number))
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


def test_a_signal_is_heard_within_a_long_step(reference, folder):
    out = folder / "long_step"
    process = start(job(out, "--set", "solver.integrator=explicit", "--set", "solver.step=1/25",
                        "--set", "solver.substeps=1000000", command="simulate"))
    wait_for_frames(process, out, 1)
    time.sleep(0.3)
    process.send_signal(signal.SIGTERM)
    finish(process, stopped_by(signal.SIGTERM))
    states = [file.name for file in out.glob("cache/*.state")]
    assert states == ["frame_0000.state"], states  # it did not wait for the step's end
    assert json.loads((out / "run.json").read_text())["status"] == "interrupted"


def test_an_early_signal_leaves_a_folder_that_resumes(reference, folder):
    out = folder / "early"
    process = start(job(out, command="simulate"))
    deadline = time.monotonic() + PATIENCE
    while not out.exists() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.0005)
    process.send_signal(signal.SIGTERM)
    # Before it has begun with anything there is nothing to finish, and the signal itself ends it.
    process.communicate(timeout=PATIENCE)
    assert process.returncode in (stopped_by(signal.SIGTERM), -signal.SIGTERM), process.returncode
    run(job(out, "--resume", command="simulate"))
    reference.check(out, "after an early signal", videos=False)


def test_signals_that_the_caller_ignores_do_not_stop_a_run(reference, folder):
    for number in (signal.SIGHUP, signal.SIGINT):  # as nohup and a shell's & start it
        out = folder / signal.Signals(number).name
        process = start(job(out), preexec_fn=lambda: signal.signal(number, signal.SIG_IGN))
        wait_for_frames(process, out, 4)
        process.send_signal(number)
        finish(process, DONE)
        reference.check(out, f"with {signal.Signals(number).name} ignored")


def test_kills_at_random_leave_whole_files_and_resume_ends_with_the_same_bytes(reference, folder):
    kill_at_random(reference, folder, int(os.environ.get("UNRAVEL_KILLS", "12")), 20040829)


def test_two_runs_do_not_share_a_folder(reference, folder):
    out = folder / "shared"
    first = start(job(out, "--set", "clip.duration=40", command="simulate"))
    wait_for_frames(first, out, 2)
    text = run(job(out, "--resume", "--set", "clip.duration=40", command="simulate"), USAGE)
    assert "another" in text, text
    first.send_signal(signal.SIGINT)
    finish(first, stopped_by(signal.SIGINT))


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
