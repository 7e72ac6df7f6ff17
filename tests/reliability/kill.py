"""Kills a small run with videos at random moments, and lets it go on.

    tests/kill 200                 as many kills; the same seed has the same dice
    tests/kill 200 --seed 7
"""

import argparse
import pathlib
import sys
import tempfile

import tool_runs
from kills import kill_at_random


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kills", type=int, metavar="N")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tool", default=tool_runs.HERE.parents[1] / "build/release/unravel", metavar="FILE")
    options = parser.parse_args()
    tool_runs.TOOL = str(pathlib.Path(options.tool).resolve())
    with tempfile.TemporaryDirectory(prefix="unravel-kills-") as temporary:
        folder = pathlib.Path(temporary)
        try:
            kill_at_random(tool_runs.Reference(folder), folder, options.kills, options.seed)
        except AssertionError as error:
            print(f"FAILED: {error}")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
