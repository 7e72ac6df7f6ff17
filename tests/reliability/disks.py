"""Disks that are full, folders that can't be written, pipes that nobody reads."""

import contextlib
import os
import resource
import shutil
import signal
import subprocess

from run_files import check_same, check_whole, content, leftovers
from tool_runs import DONE, FRAMES, OUTPUT, SCENE, USAGE, job, run


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


def test_a_full_disk_behind_standard_output_is_an_error(reference, folder):
    for words in (["--help"], ["--version"], ["schema", "keys"], ["check", SCENE], ["run", "--help"]):
        with open("/dev/full", "wb") as full:
            text = run(words, OUTPUT, stdout=full)
        assert "standard output" in text and len(text.splitlines()) == 1, f"{words}: {text}"
