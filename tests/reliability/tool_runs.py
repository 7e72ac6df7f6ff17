"""Starting the tool, waiting for what it does, and the run that every other is compared with."""

import pathlib
import subprocess
import time

from run_files import check_same, check_whole, content, leftovers, video_frames

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE / "tiny.toml"
TOOL = ""
FRAMES = 15  # of tiny.toml
DONE, USAGE, SCENE_ERROR, NO_ENCODER, SIMULATION, OUTPUT = 0, 2, 3, 4, 5, 6
PATIENCE = 120  # s, for anything that waits; only ever reached where something hangs


def stopped_by(number):
    """Exit code of a run that a signal asked to stop."""
    return 128 + number


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
