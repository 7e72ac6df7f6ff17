#!/usr/bin/env python3
"""Nothing is lost: runs of the tool that are stopped in every way a run can be, then gone on with.

    test_runs.py TOOL [NAME ...]      UNRAVEL_KILLS=200 for the long version of the random kills,
                                      UNRAVEL_FRAMES=2000 for that of the memory test, 0 for none
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import clips
import command_lines
import disks
import folders
import limits
import memory
import stops
import tool_runs


def main():
    tool_runs.TOOL = os.path.abspath(sys.argv[1])
    tests = [(name, test) for stage in (stops, clips, disks, limits, folders, command_lines, memory)
             for name, test in vars(stage).items() if name.startswith("test_")]
    if sys.argv[2:]:
        tests = [(n, f) for n, f in tests if any(part in n for part in sys.argv[2:])]
    failed = 0
    with tempfile.TemporaryDirectory(prefix="unravel-runs-") as temporary:
        folder = pathlib.Path(temporary)
        reference = tool_runs.Reference(folder)
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
