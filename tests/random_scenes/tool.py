"""The tool as a process with limits, and what it leaves of a run."""

import csv
import json
import os
import pathlib
import resource
import shutil
import signal
import struct
import subprocess

TOOL = ""
CPU_LIMIT = 60  # s; a scene here is small enough to take a fraction of one

DONE, SCENE_ERROR, STOPPED = 0, 3, 5


class Ended:
    """How a command ended."""

    def __init__(self, code, text, seconds):
        self.code, self.text, self.seconds = code, text, seconds

    def how(self):
        if self.code < 0:
            name = signal.Signals(-self.code).name
            return f"ended by {name}" + (f" after {CPU_LIMIT} s of work" if name == "SIGXCPU" else "")
        return f"exit code {self.code}"


def limit():
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT, CPU_LIMIT + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def call(arguments):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([TOOL, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          preexec_fn=limit, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Ended(done.returncode, done.stdout.decode(errors="replace"), seconds)


class Run:
    """A scene simulated into a folder."""

    def __init__(self, scene_file, folder, threads, *more):
        self.folder = folder
        self.ended = call(["simulate", scene_file, "-o", folder, "--threads", threads, *more])
        self.json = json.loads((folder / "run.json").read_text()) if (folder / "run.json").exists() else {}

    @property
    def hashes(self):
        return self.json.get("state_hashes", [])

    def result(self):
        """What must not depend on threads."""
        return self.ended.code, self.hashes

    def steps(self):
        """Rows of stats.csv as dictionaries of numbers; what a row leaves empty is not in it."""
        with open(self.folder / "stats.csv", newline="") as file:
            return [{name: float(value) for name, value in row.items() if value} for row in csv.DictReader(file)]

    def frames(self, cloths):
        """Positions (cloths, frames, particles) as an export for other programs has them [m]."""
        out = self.folder / "export"
        ended = call(["export", self.folder, "--format", "pc2", "-o", out, "--json"])
        if ended.code != DONE:
            raise RuntimeError(f"export: {ended.how()}: {ended.text.strip()}")
        caches = [file for file in json.loads(ended.text)["files"] if file.endswith(".pc2")]
        return [read_pc2(pathlib.Path(file)) for file in caches[:cloths]]


def read_pc2(file):
    data = file.read_bytes()
    _, points, _, _, frames = struct.unpack_from("<iiffi", data, 12)
    numbers = struct.unpack_from(f"<{3 * points * frames}f", data, 32)
    return [[numbers[3 * (frame * points + p):3 * (frame * points + p) + 3] for p in range(points)]
            for frame in range(frames)]


def remove(folder):
    shutil.rmtree(folder, ignore_errors=True)


def cpu_seconds():
    use = resource.getrusage(resource.RUSAGE_CHILDREN)
    mine = os.times()
    return use.ru_utime + use.ru_stime + mine.user + mine.system
